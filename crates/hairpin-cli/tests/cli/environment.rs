//! Wind, gusts, forces and obstacles searched beside the waypoints: what was found is part of the case, wherever the
//! case goes.

use std::fs;
use std::path::Path;

use crate::commands::{assert_same, copy, json, refused, run, small_hull};
use hairpin::campaign::scenario::DiscreteGustSection;
use hairpin::campaign::{Case, Environment};
use hairpin_formats::folder::CampaignFolder;
use nalgebra::Vector3;
use serde_json::Value;

/// What is searched.
const SEARCH: &str = r#"{ method = "in-loop", waypoints = 90, cases = 2, executions = 60 }"#;

fn looped(here: &Path, command: &str, out: &str, sets: &[&str]) -> Value {
    fs::write(here.join("q.toml"), small_hull(SEARCH)).unwrap();
    let sets = sets.iter().flat_map(|set| ["--set", set]);
    json(here, &[command, "q.toml", "--out", out].into_iter().chain(sets).collect::<Vec<_>>())
}

fn cases(folder: &Path) -> Vec<Case> {
    CampaignFolder::open(folder).unwrap().read_cases().unwrap()
}

/// Score and largest deviation of every case.
fn came_to(folder: &Path) -> Vec<(f64, f64, Option<f64>)> {
    let results = CampaignFolder::open(folder).unwrap().read_results().unwrap();
    let both = cases(folder).into_iter().zip(results);
    let of = |(case, result): (Case, hairpin::campaign::CaseResult)| {
        let measures = result.measures.unwrap();
        (case.score, measures.max_deviation, measures.min_clearance)
    };
    both.map(of).collect()
}

#[test]
fn wind_and_a_gust_are_found_and_go_with_their_cases() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    looped(here, "generate", "calm", &[]);
    let air = ["generate.environment.wind_m_s=4.0", "generate.environment.gust_m_s=3.0"];
    looped(here, "stress", "air", &air);
    let (calm, found) = (cases(&here.join("calm")), cases(&here.join("air")));
    for (case, calm) in found.iter().zip(&calm) {
        let Environment { wind_m_s, discrete_gust, obstacles, .. } = case.environment.clone().unwrap();
        let gust = discrete_gust.unwrap();
        assert!(Vector3::from(wind_m_s.unwrap()).norm() < 4.0 + 1e-9 && obstacles.is_empty());
        assert!(Vector3::from(gust.velocity_m_s).norm() < 3.0 + 1e-9 && gust.duration_s == 2.0);
        assert!(case.score > 1.05 * calm.score, "{} {}: half the executions went to the air", case.score, calm.score);
    }
    for (score, deviation, _) in came_to(&here.join("air")) {
        assert!((score - deviation).abs() < 1e-12, "{score} {deviation}: judged as it was found");
    }
    // The other parts of a campaign meet the same air.
    assert_eq!(json(here, &["execute", "air"])["exit_code"], 0);
    json(here, &["judge", "air"]);
    assert!(came_to(&here.join("air")).iter().all(|(score, deviation, _)| (score - deviation).abs() < 1e-12));
    let again = json(here, &["replay", "air/repro/0000.json"]);
    assert!(again["reproduces"] == true, "{again}");
    let shrunk = json(here, &["shrink", "air", "--case", "0", "--budget", "20"]);
    assert_eq!(shrunk["what"], "deviation");
    assert!(json(here, &["replay", "air/repro/0000-shrunk.json"])["violates"] == true);
    // Programs of other people execute what was found in the loop, and are told of the air.
    copy(&here.join("air"), &here.join("elsewhere"));
    let ready = r#"{"type":"ready","protocol":1,"name":"scribe"}"#;
    let scribe = format!("read -r hello\necho '{ready}'\nread -r mission\nprintf '%s\\n' \"$mission\" >> got.json\n");
    fs::write(here.join("scribe.sh"), scribe).unwrap();
    // It flies nothing.
    let (code, out, error) =
        run(here, &["execute", "elsewhere", "--executor", "sh scribe.sh", "--set", "execute.workers=1"]);
    assert_eq!(code, 4, "{out}{error}");
    let got = fs::read_to_string(here.join("got.json")).unwrap();
    let wind = serde_json::to_string(&found[1].environment.as_ref().unwrap().wind_m_s).unwrap();
    assert!(got.contains(&format!("\"wind_m_s\":{wind}")) && got.contains("\"discrete_gust\""), "{got}");
    json(here, &["select", "air", "--cases", "1", "--out", "one"]);
    assert!(cases(&here.join("one"))[0].environment.is_some());
    json(here, &["report", "air"]);
    let page = fs::read_to_string(here.join("air/report.html")).unwrap();
    assert!(page.contains("wind (") && page.contains("a gust of up to 3 m/s"));
    // In other air it is another test.
    looped(here, "stress", "other", &[air[0], "generate.environment.gust_m_s=2.5"]);
    let (_, _, error) = run(here, &["compare", "air", "other"]);
    assert!(error.contains("0000, 0001 (another environment)"), "{error}");
}

#[test]
fn obstacles_stand_clear_of_plans_and_in_the_way_of_flights() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let near = "generate.search.stress=\"clearance\"";
    let balls = "generate.environment.obstacles={count=2,radius_m=0.5}";
    looped(here, "stress", "balls", &[near, balls]);
    looped(here, "stress", "one-thread", &[near, balls]);
    let boxes = "generate.environment.obstacles={count=1,size_m=[0.6,0.4,2.0]}";
    let wind = "generate.environment.wind_m_s=2.0";
    looped(here, "stress", "boxes", &[near, boxes, wind, "generate.search.executions=30"]);
    assert_same(&here.join("balls"), &here.join("one-thread"));
    for (name, count) in [("balls", 2), ("boxes", 1)] {
        let kept = CampaignFolder::open(&here.join(name)).unwrap();
        for ((case, result), (score, _, clearance)) in
            cases(&here.join(name)).iter().zip(kept.read_results().unwrap()).zip(came_to(&here.join(name)))
        {
            assert_eq!(case.environment.as_ref().unwrap().obstacles.len(), count);
            assert!((score + clearance.unwrap()).abs() < 1e-12, "{score} {clearance:?}");
            assert!(score > -1e-3, "{score}");
            assert_eq!(result.ended, "obstacle", "{result:?}");
        }
        let verified = json(here, &["verify", name]);
        assert_eq!((&verified["checked"], &verified["failed"]), (&2.into(), &0.into()), "{verified}");
        let again = json(here, &["replay", &format!("{name}/repro/0001.json")]);
        assert!(again["reproduces"] == true, "{again}");
    }
    let (_, out, _) = run(here, &["verify", "balls"]);
    assert!(out.contains("the plans of 2/2 cases are clear"), "{out}");
    json(here, &["export", "balls", "--to", "waypoints"]);
    let exported = fs::read_to_string(here.join("balls/export/0000.environment.json")).unwrap();
    let exported: Environment = serde_json::from_str(&exported).unwrap();
    assert_eq!(Some(&exported), cases(&here.join("balls"))[0].environment.as_ref());

    // Missions are flown among what was exported with them, in another campaign as well.
    looped(here, "generate", "others", &["generate.search.cases=1"]);
    json(here, &["execute", "others", "--missions", "balls/export"]);
    json(here, &["judge", "others"]);
    assert_eq!(cases(&here.join("others"))[0].environment.as_ref(), Some(&exported));
    let ended = |folder: &str| {
        let results = CampaignFolder::open(&here.join(folder)).unwrap().read_results().unwrap();
        results.into_iter().map(|result| result.ended).collect::<Vec<_>>()
    };
    assert_eq!(ended("others"), ended("balls"));
    fs::write(here.join("balls/export/0001.environment.json"), "{\"wind_m_s\":[1e9,0,0]}").unwrap();
    refused(here, &["execute", "others", "--missions", "balls/export"], &["0001.environment.json", "wind_m_s"]);

    // Moved to three centimetres less than the robot's radius from the plan, an obstacle is no longer clear of it.
    let kept = CampaignFolder::open_to_write(&here.join("balls")).unwrap();
    let mut moved = kept.read_cases().unwrap();
    let case = &mut moved[0];
    let ball = case.environment.as_mut().unwrap().obstacles[0].sphere.as_mut().unwrap();
    let center = nalgebra::Point3::from(ball.center_m);
    let foot = |leg: &[nalgebra::Point3<f64>]| hairpin::math::segment::nearest_point(&center, &leg[0], &leg[1]);
    let nearest =
        case.waypoints.windows(2).map(foot).min_by(|a, b| (a - center).norm().total_cmp(&(b - center).norm()));
    let nearest = nearest.unwrap();
    ball.center_m = (nearest + (center - nearest).normalize() * (ball.radius_m + 0.2)).coords.into();
    kept.write_results(&moved, &[]).unwrap();
    drop(kept);
    let (code, out, _) = run(here, &["verify", "balls"]);
    assert!(code == 1 && out.contains("case 0000: environment.obstacles[0].clearance"), "{out}");

    // Neither a box a little higher than was asked for, nor one of no size, nor a gust beside the wind is one of those
    // that were.
    let gust = DiscreteGustSection { velocity_m_s: [1.0, 0.0, 0.0], start_s: -1.0, duration_s: 2.0 };
    type Change<'a> = &'a dyn Fn(&mut Environment);
    let changes: [(&str, Change); 4] = [
        ("obstacles[0].size_m[2]", &|there| there.obstacles[0].cuboid.as_mut().unwrap().size_m[2] = 2.000_001),
        ("obstacles[0].size_m", &|there| there.obstacles[0].cuboid.as_mut().unwrap().size_m[0] = -0.6),
        ("discrete_gust.velocity_m_s", &|there| there.discrete_gust = Some(gust)),
        ("discrete_gust.start_s", &|there| there.discrete_gust = Some(gust)),
    ];
    let found = cases(&here.join("boxes"));
    for (field, change) in changes {
        let mut changed = found.clone();
        change(changed[0].environment.as_mut().unwrap());
        let kept = CampaignFolder::open_to_write(&here.join("boxes")).unwrap();
        kept.write_results(&changed, &[]).unwrap();
        drop(kept);
        let (code, out, _) = run(here, &["verify", "boxes"]);
        assert!(code == 1 && out.contains(&format!("environment.{field} = ")), "{field}: {out}");
    }
}

/// What a bound varies to is what the case's wind was searched within.
#[test]
fn bounds_that_vary_are_those_of_the_case() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let varied = "vary.\"generate.environment.wind_m_s\"={choice=[8.0]}";
    let sets = ["generate.environment.wind_m_s=1.0", varied];
    looped(here, "generate", "varied", &sets);
    let winds: Vec<f64> = cases(&here.join("varied"))
        .iter()
        .map(|case| Vector3::from(case.environment.as_ref().unwrap().wind_m_s.unwrap()).norm())
        .collect();
    assert!(winds[0] <= 1.0 + 1e-9 && winds[1] > 1.0, "{winds:?}");
    assert_eq!(json(here, &["verify", "varied"])["failed"], 0);
}

/// A witness that `certify` finds leaves the straight legs: what is placed has to be clear of it.
#[test]
fn obstacles_are_clear_of_the_witness_that_is_certified() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    let balls = "generate.environment.obstacles={count=2,radius_m=0.5}";
    let sets = ["generate.search.stress=\"clearance\"", balls, "generate.certify=true"];
    looped(here, "generate", "certified", &sets);
    let found = cases(&here.join("certified"));
    assert!(found.iter().all(|case| case.profile().is_some() && case.environment.is_some()));
    let verified = json(here, &["verify", "certified"]);
    assert_eq!((&verified["checked"], &verified["failed"]), (&2.into(), &0.into()), "{verified}");
}

#[test]
fn what_cannot_be_searched_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("q.toml"), small_hull(SEARCH)).unwrap();
    let wind = "generate.environment.wind_m_s=4.0";
    let near = "generate.search.stress=\"clearance\"";
    let balls = "generate.environment.obstacles={count=2,radius_m=0.5}";
    let table: [(&[&str], &[&str]); 10] = [
        (&[near, balls, "generate.search.executions=2"], &["generate.search.executions", "≥ 3 with obstacles"]),
        (&["generate.search.stress=\"joint-effort\""], &["joint-effort", "a flight is measured by"]),
        (&[wind, "generate.search.method=\"exact\""], &["generate.environment", "only the method `in-loop`"]),
        (&[wind, "world.wind_m_s=[1,0,0]"], &["generate.environment.wind_m_s", "takes the place"]),
        (&["generate.environment.wind_m_s=-1.0"], &["generate.environment.wind_m_s", "> 0 and ≤ 100 m/s"]),
        (&["generate.environment={}"], &["wind_m_s, gust_m_s or obstacles"]),
        (&[balls], &["generate.environment.obstacles", "stress = \"clearance\""]),
        (&[near], &["nothing to be near to"]),
        (&[near, "generate.environment.obstacles={count=2}"], &["exactly one of radius_m and size_m"]),
        (&[near, "generate.environment.obstacles={count=2,radius_m=30.0}"], &["less than the world's size"]),
    ];
    for (sets, words) in table {
        let mut typed = vec!["generate", "q.toml", "--out", "no"];
        typed.extend(sets.iter().flat_map(|set| ["--set", set]));
        refused(here, &typed, words);
    }
}

/// A car in the middle of flat ground; `search` and what else stands in `[generate]`.
const CAR: &str = r#"
hairpin = 1
robot = "car"
seed = 7
spec = "none"
[world]
terrain = { generator = "flat", size_m = 30, cell_m = 0.5 }
[task]
start = { x_m = 15, y_m = 15 }
length = 4
leg_m = [2, 5]
[generate]
headings = 2
speed = { profile = "trapezoid" }
limits = { speed_m_s = 1.5, curvature_1_m = 1.0, curvature_rate_1_m2 = 1.5 }
search = { method = "in-loop", waypoints = 24, cases = 2, executions = 14, stress = "clearance" }
[execute]
controller = "stanley"
latency_s = 0.2
"#;

fn driven<'a>(command: &'a str, sets: &[&'a str]) -> Vec<&'a str> {
    [command, "car.toml"].into_iter().chain(sets.iter().flat_map(|set| ["--set", set])).collect()
}

#[test]
fn keep_outs_and_a_force_go_with_the_drives_that_they_were_found_for() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("car.toml"), CAR).unwrap();
    let rocks = "generate.environment.obstacles={count=2,radius_m=0.3}";
    json(here, &[&driven("stress", &[rocks])[..], &["--out", "rocks", "--threads", "2"]].concat());
    json(here, &[&driven("generate", &[rocks])[..], &["--out", "parts", "--threads", "1"]].concat());
    assert_eq!(json(here, &["execute", "parts"])["exit_code"], 0);
    json(here, &["judge", "parts"]);
    assert_same(&here.join("rocks"), &here.join("parts"));
    let found = cases(&here.join("rocks"));
    for (case, (score, _, clearance)) in found.iter().zip(came_to(&here.join("rocks"))) {
        assert_eq!(case.environment.as_ref().unwrap().keep_out.len(), 2);
        assert!((score + clearance.unwrap()).abs() < 1e-12, "{score} {clearance:?}");
        assert!(score > -1e-9, "{score}: all the way to the rock");
    }
    let (code, out, _) = run(here, &["verify", "rocks"]);
    assert!(code == 0 && out.contains("the plans of 2/2 cases are clear"), "{out}");
    let again = json(here, &["replay", "rocks/repro/0000.json"]);
    assert!(again["reproduces"] == true, "{again}");
    let shrunk = json(here, &["shrink", "rocks", "--case", "0", "--budget", "12"]);
    assert_eq!(shrunk["what"], "crash", "{shrunk}");
    let simplified = shrunk["simplified"].to_string();
    assert!(simplified.contains("1 of 2 keep-outs"), "{shrunk}");
    assert!(json(here, &["replay", "rocks/repro/0000-shrunk.json"])["violates"] == true);
    json(here, &["select", "rocks", "--cases", "1", "--out", "one"]);
    assert!(cases(&here.join("one"))[0].environment.is_some());
    json(here, &["export", "rocks", "--to", "waypoints"]);
    let exported = fs::read_to_string(here.join("rocks/export/0001.environment.json")).unwrap();
    let exported: Environment = serde_json::from_str(&exported).unwrap();
    assert_eq!(Some(&exported), found[1].environment.as_ref());
    let page = fs::read_to_string(here.join("rocks/report.html")).unwrap();
    assert!(page.contains("placed 0: disc of radius 0.30 m at (") && page.contains("up to 2 round keep-outs"));

    // Searched again at another radius it is another environment.
    json(
        here,
        &[&driven("stress", &["generate.environment.obstacles={count=1,radius_m=0.2}"])[..], &["--out", "small"]]
            .concat(),
    );
    let (_, _, error) = run(here, &["compare", "rocks", "small"]);
    assert!(error.contains("0000, 0001 (another environment)"), "{error}");

    // A disc put on the plan's first leg is no longer clear of it.
    let kept = CampaignFolder::open_to_write(&here.join("rocks")).unwrap();
    let mut moved = kept.read_cases().unwrap();
    let goal = moved[1].waypoints[1];
    let place = &mut moved[1].environment.as_mut().unwrap().keep_out[1];
    place.circle.as_mut().unwrap().center_m = [goal.x, goal.y];
    kept.write_results(&moved, &[]).unwrap();
    drop(kept);
    let (code, out, _) = run(here, &["verify", "rocks"]);
    assert!(code == 1 && out.contains("case 0001: environment.keep_out[1].clearance"), "{out}");
}

#[test]
fn a_steady_force_is_found_within_its_bound_and_acts_wherever_the_drive_goes() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("car.toml"), CAR.replace("\"car\"", "\"four-wheel\"")).unwrap();
    let own = [
        "robot.mass_kg=20",
        "robot.forces={gravity_m_s2=9.81,rolling_resistance=0.05}",
        "robot.slip_at_20_deg=0.3",
        "robot.side_slip_at_20_deg=0.3",
        "generate.speed={}",
        "generate.search={method=\"in-loop\",waypoints=16,cases=1,executions=30}",
    ];
    json(here, &[&driven("generate", &own)[..], &["--out", "calm"]].concat());
    let pulled = [&own[..], &["generate.environment.external_force_n=30"]].concat();
    json(here, &[&driven("stress", &pulled)[..], &["--out", "pulled"]].concat());
    let (calm, found) = (&cases(&here.join("calm"))[0], &cases(&here.join("pulled"))[0]);
    let force = found.environment.as_ref().unwrap().external_force_n.unwrap();
    assert!(force[0].hypot(force[1]) < 30.0 + 1e-9 && force[0].hypot(force[1]) > 1.0 && force[2] == 0.0, "{force:?}");
    let (score, deviation, _) = came_to(&here.join("pulled"))[0];
    assert!((score - deviation).abs() < 1e-12 && score > 1.05 * calm.score, "{score} {deviation} {}", calm.score);
    assert_eq!(json(here, &["verify", "pulled"])["failed"], 0);
    // A saved case is run again under the force that it was saved with.
    let limit = format!("spec.limits.path_deviation_m={}", 0.9 * deviation);
    let tight = [&pulled[..], &[&limit]].concat();
    json(here, &[&driven("stress", &tight)[..], &["--out", "tight"]].concat());
    let (_, _, error) = run(here, &["execute", "tight"]);
    assert!(error.contains("saved cases first: 1 of 1 violate"), "{error}");
    let ready = r#"{"type":"ready","protocol":1,"name":"scribe"}"#;
    let scribe = format!("read -r hello\necho '{ready}'\nread -r mission\nprintf '%s\\n' \"$mission\" >> got.json\n");
    fs::write(here.join("scribe.sh"), scribe).unwrap();
    let (code, out, error) = run(here, &["execute", "pulled", "--executor", "sh scribe.sh"]);
    assert_eq!(code, 4, "{out}{error}");
    let got = fs::read_to_string(here.join("got.json")).unwrap();
    let told = format!("\"external_force_n\":{}", serde_json::to_string(&force).unwrap());
    assert!(got.contains(&told), "{got}");
}

#[test]
fn what_cannot_be_searched_beside_drives_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let here = folder.path();
    fs::write(here.join("car.toml"), CAR).unwrap();
    let rocks = "generate.environment.obstacles={count=2,radius_m=0.3}";
    let force = "generate.environment.external_force_n=10";
    let far = "generate.search.stress=\"max-deviation\"";
    let table: [(&[&str], &[&str]); 10] = [
        (&[rocks, "generate.search.method=\"exact\""], &["generate.environment", "only the method `in-loop`"]),
        (&[rocks, far], &["generate.environment.obstacles", "stress = \"clearance\"", "to a drive"]),
        (&[], &["generate.search.stress", "nothing to be near to"]),
        (&[far, "generate.environment={}"], &["generate.environment", "obstacles or external_force_n"]),
        (
            &["generate.environment.obstacles={count=0,radius_m=0.3}"],
            &["generate.environment.obstacles.count", "1 … 100"],
        ),
        (&["generate.environment.obstacles={count=1,radius_m=15}"], &["obstacles.radius_m", "15", "29.5 m across"]),
        (&["generate.environment.obstacles={count=1,size_m=[1,1,1]}"], &["size_m"]),
        (&[far, "generate.environment.wind_m_s=3"], &["wind_m_s"]),
        (&[far, force], &["generate.environment.external_force_n", "robot.mass_kg and robot.forces"]),
        (&[far, force, "execute.external_force_n=[1,0,0]"], &["generate.environment.external_force_n", "[execute]"]),
    ];
    for (sets, words) in table {
        refused(here, &[&driven("generate", sets)[..], &["--out", "no"]].concat(), words);
    }
}
