//! Scores that are learned from executions, and searches with executions in the loop.

use std::fs;
use std::path::Path;

use crate::commands::{json, refused, small_hull};
use hairpin_formats::folder::CampaignFolder;

/// What is searched.
const SEARCH: &str = r#"{ method = "uniform", waypoints = 90, cases = 20, per_graph = 4 }
score = "high-velocity-90""#;

fn begin(folder: &Path) {
    fs::write(folder.join("q.toml"), small_hull(SEARCH)).unwrap();
    json(folder, &["stress", "q.toml", "--out", "flown"]);
}

#[test]
fn a_learned_score_is_written_applied_and_refused_elsewhere() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    begin(here);
    let told = json(here, &["learn", "flown", "--out", "m.json"]);
    // Runs that crash leave legs out.
    assert!(told["trajectories"] == 20 && (60..=80).contains(&told["legs"].as_u64().unwrap()), "{told}");
    assert!(told["validation"]["r2"].as_f64().unwrap() < 1.0 && told["held_out"]["trajectories"] == 4, "{told}");
    let again = json(here, &["learn", "flown", "--out", "again.json"]);
    assert_eq!(again["training_hash"], told["training_hash"]);
    assert_eq!(fs::read(here.join("m.json")).unwrap(), fs::read(here.join("again.json")).unwrap());

    let learned = |out: &str, more: &[&str]| {
        let mut typed = vec!["generate", "q.toml", "--out", out, "--set", "generate.score=\"learned:m.json\""];
        typed.extend(["--set", "generate.search.method=\"exact\"", "--set", "generate.search.cases=3"]);
        typed.extend(more);
        json(here, &typed)
    };
    learned("exact", &["--set", "generate.search.aggregate=\"max\""]);
    learned("beam", &["--set", "generate.search.method=\"beam\""]);
    // A folder stands alone: its model is in it.
    fs::rename(here.join("m.json"), here.join("moved.json")).unwrap();
    assert_eq!(fs::read(here.join("exact/score-model.json")).unwrap(), fs::read(here.join("moved.json")).unwrap());
    json(here, &["execute", "exact"]);
    json(here, &["judge", "exact"]);

    fs::rename(here.join("moved.json"), here.join("m.json")).unwrap();
    let apply = |more: &[&'static str]| {
        let mut typed = vec!["generate", "q.toml", "--out", "other", "--set", "generate.score=\"learned:m.json\""];
        typed.extend(more);
        typed
    };
    refused(
        here,
        &apply(&["--set", "robot=\"crazyflie\""]),
        &["`generate.score` = \"learned:m.json\"", "flightgoggles", "crazyflie"],
    );
    refused(here, &apply(&["--set", "robot.mass_kg=1.1"]), &["generate.score", "robot_hash"]);
    // What varies between runs is not what is searched.
    learned("varied", &["--set", "vary={\"robot.mass_kg\"={uniform=[0.9,1.1]}}"]);
    refused(here, &apply(&["--set", "generate.reach=\"witness\""]), &["leg over step", "at the leg's ends"]);
    let text = fs::read_to_string(here.join("m.json")).unwrap();
    fs::write(here.join("m.json"), text.replace("\"score_model\": 1", "\"score_model\": 2")).unwrap();
    refused(here, &apply(&[]), &["score_model = 2"]);
    fs::write(here.join("m.json"), &text[..text.len() / 2]).unwrap();
    refused(here, &apply(&[]), &["m.json", "generate.score"]);
    fs::remove_file(here.join("m.json")).unwrap();
    refused(here, &apply(&[]), &["m.json", "cannot be read"]);
    json(here, &["generate", "q.toml", "--out", "unflown"]);
    refused(here, &["learn", "unflown"], &["no leg to learn from"]);
    json(here, &["select", "flown", "--cases", "11", "--out", "eleven"]);
    refused(here, &["learn", "eleven"], &["11 trajectories", "12 are needed in all"]);
}

/// Graph, score, deviation of every case of a campaign.
fn came_to(folder: &Path) -> Vec<(u64, f64, f64)> {
    let kept = CampaignFolder::open(folder).unwrap();
    let (cases, results) = (kept.read_cases().unwrap(), kept.read_results().unwrap());
    let both = cases.iter().zip(&results);
    both.map(|(case, result)| (case.graph, case.score, result.measures.as_ref().unwrap().max_deviation)).collect()
}

/// The graphs whose case did not come to its end, which stands before all that strays farther.
fn cut_off(folder: &Path) -> Vec<u64> {
    let kept = CampaignFolder::open(folder).unwrap();
    let (cases, results) = (kept.read_cases().unwrap(), kept.read_results().unwrap());
    let both = cases.iter().zip(&results);
    both.filter(|(_, result)| result.ended != "done").map(|(case, _)| case.graph).collect()
}

#[test]
fn partial_trajectories_that_are_executed_lead_the_beam_to_more_stress_than_random_scores() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("q.toml"), small_hull(r#"{ method = "beam", waypoints = 90, cases = 5, executions = 25 }"#))
        .unwrap();
    let stress = |out: &str, controller: &str, score: &str, more: &[&str]| {
        let (controller, score) =
            (format!("execute.controller=\"{controller}\""), format!("generate.score=\"{score}\""));
        let mut typed = vec!["stress", "q.toml", "--out", out, "--set", &controller, "--set", &score];
        typed.extend(more);
        json(here, &typed);
        came_to(&here.join(out))
    };
    // Flown on from each waypoint; the last one plans over all waypoints, and is flown anew each time.
    for controller in ["stable-waypoint", "fixed-velocity", "minimum-snap"] {
        let (executed, drawn) = (format!("{controller}-executed"), format!("{controller}-random"));
        let found = stress(&executed, controller, "executed", &[]);
        let random = stress(&drawn, controller, "random", &[]);
        assert_eq!((found.len(), random.len()), (5, 5), "{controller}");
        for (_, score, deviation) in &found {
            assert_eq!(score, deviation, "{controller}: the score is the judge's own number");
        }
        let mean = |all: &[(u64, f64, f64)]| all.iter().map(|(.., deviation)| deviation).sum::<f64>() / 5.0;
        assert!(mean(&found) > 1.1 * mean(&random), "{controller}: {found:?} {random:?}");
        let curves = fs::read_to_string(here.join(&executed).join("best-so-far.tsv")).unwrap();
        for (graph, score, _) in &found {
            let rows: Vec<Vec<f64>> = curves
                .lines()
                .skip(1)
                .map(|row| row.split('\t').map(|cell| cell.parse().unwrap()).collect())
                .filter(|row: &Vec<f64>| row[0] == *graph as f64)
                .collect();
            assert!(rows.iter().all(|row| row[1] <= 25.0), "{controller}: {curves}");
            assert_eq!(rows.last().unwrap()[2], *score, "{controller}: {curves}");
        }
        if controller == "stable-waypoint" {
            assert_eq!(
                stress("one-thread", controller, "executed", &["--threads", "1"]),
                found,
                "threads change nothing"
            );
            let least = ["--set", "generate.search.executions=1"];
            assert_eq!(stress("least", controller, "executed", &least).len(), 5, "one execution is enough for one");
        }
    }

    let no = |more: &[&str], words: &[&str]| {
        let mut typed = vec!["generate", "q.toml", "--out", "no", "--set", "generate.score=\"executed\""];
        more.iter().for_each(|set| typed.extend(["--set", set]));
        refused(here, &typed, words);
    };
    for method in ["exact", "uniform", "in-loop"] {
        let method = format!("generate.search.method=\"{method}\"");
        no(&[&method], &["generate.score", "\"executed\"", "generate.search.method = \"beam\""]);
    }
    no(&["generate.search.per_graph=30"], &["generate.search.executions", "25", "30 … 1 000 000", "per_graph"]);
    no(&["generate.search.stress=\"clearance\""], &["generate.search.stress", "nothing to be near to"]);
}

#[test]
fn executions_in_the_loop_tell_the_stress_that_is_judged_and_beat_uniform_draws() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    begin(here);
    let looped = |out: &str, more: &[&str]| {
        let mut typed = vec!["stress", "q.toml", "--out", out, "--set", "generate.search.method=\"in-loop\""];
        typed.extend(["--set", "generate.search.cases=3", "--set", "generate.search.per_graph=1"]);
        typed.extend(["--set", "generate.search.executions=40"]);
        typed.extend(more);
        json(here, &typed)
    };
    let came_to = |out: &str| came_to(&here.join(out));
    looped("looped", &[]);
    looped("one-thread", &["--threads", "1"]);
    looped("moved", &["--set", "generate.search.move_waypoints=true"]);
    let (found, moved, uniform) = (came_to("looped"), came_to("moved"), came_to("flown"));
    assert_eq!(found.len(), 3);
    assert_eq!(came_to("one-thread"), found, "threads change nothing");
    let cut_off = ["looped", "moved"].map(|out| cut_off(&here.join(out)));
    assert!(cut_off.concat().len() <= 3, "{cut_off:?}");
    let mut better = 0;
    let [in_graphs, with_moves] = &cut_off;
    let all = found.iter().map(|one| (one, in_graphs)).chain(moved.iter().map(|one| (one, with_moves)));
    for ((graph, score, deviation), cut_off) in all {
        assert!((score - deviation).abs() < 1e-12, "{score} {deviation}: the score is the judge's own number");
        // The uniform draws of the same graph are among those that were executed first.
        let drawn = uniform.iter().filter(|(other, ..)| other == graph).map(|(.., drawn)| *drawn);
        let worst = drawn.fold(0.0, f64::max);
        let is_cut_off = cut_off.contains(graph);
        assert!(*deviation >= worst || is_cut_off, "graph {graph}: {deviation} {worst}");
        better += usize::from(*deviation > 1.05 * worst || is_cut_off);
    }
    assert!(better >= 3, "{found:?} {moved:?} {uniform:?}");
    looped("confirmed", &["--set", "generate.search.confirm=2"]);
    for (_, score, deviation) in came_to("confirmed") {
        assert!(
            score != deviation && (score - deviation).abs() < 0.5 * deviation,
            "{score} {deviation}: a mean of three"
        );
    }
    let curves = fs::read_to_string(here.join("confirmed/best-so-far.tsv")).unwrap();
    let executions = curves.lines().skip(1).map(|row| row.split('\t').nth(1).unwrap().parse::<u64>().unwrap());
    assert!(executions.max().is_some_and(|most| most <= 40), "{curves}");
    let mut typed = vec!["generate", "q.toml", "--out", "no", "--set", "generate.search.method=\"in-loop\""];
    typed.extend(["--set", "generate.search.executions=3", "--set", "generate.search.confirm=3"]);
    refused(here, &typed, &["generate.search.confirm", "0 … 2"]);
}

/// Moves of an arm: what its programs took is told by a model, which then is what programs are searched for.
#[test]
fn an_arm_learns_what_its_moves_take() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let small = ["--set", "task.points.count=7", "--set", "generate.search.programs=14", "--set", "execute.repeat=1"];
    json(here, &[&["stress", "arm", "--out", "ran"][..], &small].concat());
    let told = json(here, &["learn", "ran", "--stress", "time", "--out", "m.json"]);
    // Seven points have six moves between them; those from and to home are not between points.
    assert!(told["trajectories"] == 14 && told["unit"] == "s", "{told}");
    assert!((70..=84).contains(&told["legs"].as_u64().unwrap()), "{told}");
    assert!(told["validation"]["r2"].as_f64().unwrap() > 0.5, "{told}");
    let effort = json(here, &["learn", "ran", "--stress", "joint-effort", "--out", "effort.json"]);
    assert!(effort["trajectories"] == 14 && effort["unit"] == "rad²/s³", "{effort}");
    assert!(effort["validation"]["r2"].as_f64().unwrap() > 0.3, "{effort}");
    let learned = ["--set", "generate.cost=\"learned:m.json\"", "--set", "task.points.count=7"];
    let found =
        |out: &str, more: &[&str]| json(here, &[&["generate", "arm", "--out", out][..], &learned, more].concat());
    found("slow", &["--set", "generate.search.programs=1"]);
    // The folder stands alone, and its proof is of the model's costs.
    fs::rename(here.join("m.json"), here.join("moved.json")).unwrap();
    let verified = json(here, &["verify", "slow"]);
    assert!(verified["optimum"]["verified"] == true && verified["exit_code"] == 0, "{verified}");
    let scenario = fs::read_to_string(here.join("slow/scenario.toml")).unwrap();
    assert!(scenario.contains("learned:score-model.json"), "{scenario}");
    fs::rename(here.join("moved.json"), here.join("m.json")).unwrap();
    let other = [&["generate", "arm", "--out", "other", "--set", "robot=\"irb1200\""][..], &learned].concat();
    refused(here, &other, &["learned on robot `irb120`"]);
    let blind = [&["generate", "arm", "--out", "blind", "--set", "generate.mode=\"cartesian\""][..], &learned].concat();
    refused(here, &blind, &["`generate.cost` = \"learned:m.json\"", "cartesian", "need joints"]);
    for cost in ["\"joint-effort\"", "{ distance = 1.0 }"] {
        let (mode, cost) = ("generate.mode=\"cartesian\"", format!("generate.cost={cost}"));
        refused(
            here,
            &["explain", "arm", "--set", mode, "--set", &cost],
            &["generate.cost", "cartesian", "distance or a table"],
        );
    }
}
