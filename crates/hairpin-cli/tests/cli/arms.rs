//! Arms from a scenario file to a verdict, and from a cloud of points to a RAPID module.

use std::fs;
use std::path::Path;
use std::process::Output;

use assert_cmd::Command;
use serde_json::Value;
use tempfile::TempDir;

fn hairpin(folder: &Path, arguments: &[&str]) -> Output {
    Command::cargo_bin("hairpin").unwrap().current_dir(folder).args(arguments).output().unwrap()
}

fn code(output: &Output) -> i32 {
    output.status.code().unwrap_or_else(|| panic!("{}", String::from_utf8_lossy(&output.stderr)))
}

fn json(output: &Output) -> Value {
    serde_json::from_slice(&output.stdout).unwrap_or_else(|error| {
        panic!("{error}: {} {}", String::from_utf8_lossy(&output.stdout), String::from_utf8_lossy(&output.stderr))
    })
}

const SMALL: [&str; 6] =
    ["--set", "task.points.count=8", "--set", "generate.search.programs=2", "--set", "execute.repeat=2"];

#[test]
fn what_new_writes_runs_and_can_be_verified_and_exported() {
    let place = TempDir::new().unwrap();
    assert_eq!(code(&hairpin(place.path(), &["new", "arm"])), 0);
    let mut arguments = vec!["stress", "arm.toml", "--json"];
    arguments.extend(SMALL);
    let stress = hairpin(place.path(), &arguments);
    assert_eq!(code(&stress), 0, "{}", String::from_utf8_lossy(&stress.stderr));
    let verdict = json(&stress)["verdict"].as_str().unwrap().to_owned();
    assert!(verdict.starts_with("PASS 2/2 (simulated, irb120 stand-in, virtual controller, 2 runs each)"), "{verdict}");
    assert!(verdict.contains(" mm ≤ 15.00 mm") && verdict.ends_with("all 2 clear: all links"), "{verdict}");
    assert!(verdict.contains("; keep-outs in words hold for the tool alone; "), "{verdict}");
    let verified = hairpin(place.path(), &["verify", "out/arm", "--json"]);
    assert_eq!((code(&verified), json(&verified)["checked"].as_u64()), (0, Some(2)));
    // Every move of the graph is followed again, those to and from home as well.
    let graph = &json(&verified)["graph"];
    assert!(graph["moves"].as_u64().unwrap() > 30 && graph["findings"] == serde_json::json!([]), "{graph}");
    let exported = hairpin(place.path(), &["export", "out/arm", "--to", "rapid,urscript,krl,csv", "--json"]);
    assert_eq!(code(&exported), 0, "{}", String::from_utf8_lossy(&exported.stderr));
    for name in ["0000.mod", "0000_slow.mod", "0001.pgf", "0000.script", "0001.src", "0001.dat", "0000-1.csv"] {
        assert!(place.path().join("out/arm/export").join(name).is_file(), "{name}");
    }
    // The planned joints, for ROS.
    assert_eq!(code(&hairpin(place.path(), &["export", "out/arm", "--to", "joint-trajectory"])), 0);
    let text = fs::read_to_string(place.path().join("out/arm/export/0001.joint_trajectory.json")).unwrap();
    let message: Value = serde_json::from_str(&text).unwrap();
    let points = message["points"].as_array().unwrap();
    assert_eq!((&message["joint_names"][5], points[0]["positions"].as_array().unwrap().len()), (&"joint_6".into(), 6));
    let fifth = |point: &Value| point["positions"][4].as_f64().unwrap();
    // Both ends are home.
    assert!(
        (fifth(&points[0]) - 30f64.to_radians()).abs() < 1e-6
            && (fifth(points.last().unwrap()) - 30f64.to_radians()).abs() < 1e-3
    );
    // The module that was written is one that the check of modules has nothing against.
    let module = place.path().join("out/arm/export/0000.mod");
    assert!(fs::read_to_string(&module).unwrap().contains("PROC stress()"));
    let check = hairpin(place.path(), &["import", "out/arm/export/0000.mod", "--check", "--robot", "irb120"]);
    assert_eq!(code(&check), 0, "{}", String::from_utf8_lossy(&check.stdout));
}

#[test]
fn every_move_can_be_clocked_on_the_controller() {
    let place = TempDir::new().unwrap();
    let points = "x_mm,y_mm,z_mm\n300,100,400\n350,-100,300\n400,50,350\n250,200,450\n";
    fs::write(place.path().join("p.csv"), points).unwrap();
    assert_eq!(code(&hairpin(place.path(), &["max-load", "--cloud", "p.csv", "irb120", "--out", "ml"])), 0);
    let exported = hairpin(place.path(), &["export", "ml", "--to", "arc-clock"]);
    assert_eq!(code(&exported), 0, "{}", String::from_utf8_lossy(&exported.stderr));
    let module = fs::read_to_string(place.path().join("ml/export/arc_clock.mod")).unwrap();
    let driven: Vec<&str> = module.lines().filter(|line| line.trim_start().starts_with("clock_arc ")).collect();
    assert!(driven.len() >= 12 && module.contains("MODULE hairpin_clock"), "{module}");
    // What it would log, with 100 ms and one more for each next reading.
    let mut log = String::from("arc_ms;4\n");
    for (i, line) in driven.iter().enumerate() {
        let mut numbers = line.trim_start().trim_start_matches("clock_arc ").split(',');
        log += &format!("{};{};{}\n", numbers.next().unwrap(), numbers.next().unwrap(), 100 + i);
    }
    fs::write(place.path().join("arc_ms.log"), &log).unwrap();
    let read = json(&hairpin(place.path(), &["import", "arc_ms.log", "--json"]));
    assert_eq!(
        (read["points"].as_u64(), read["arcs"].as_u64(), read["readings"].as_u64()),
        (Some(4), Some(12), Some(driven.len() as u64))
    );
    let table =
        ["max-load", "--cloud", "p.csv", "irb120", "--set", "generate.cost={ table = \"arc_ms.csv\" }", "--json"];
    let found = json(&hairpin(place.path(), &table));
    assert!(found["proven"] == true && found["cost"].as_f64().unwrap() >= 300.0, "{found}");
    fs::write(place.path().join("bad.log"), "arc_ms;4\n0;9;100\n").unwrap();
    let refused = hairpin(place.path(), &["import", "bad.log"]);
    let told = String::from_utf8_lossy(&refused.stderr).into_owned();
    assert!(code(&refused) == 2 && told.contains("bad.log: line 2"), "{told}");
}

#[test]
fn the_proof_of_the_heaviest_program_is_kept_and_checked() {
    let place = TempDir::new().unwrap();
    for (out, more) in [("once", &[][..]), ("often", &["--set", "generate.search.visits=2"][..])] {
        let generate =
            ["generate", "arm", "--out", out, "--set", "task.points.count=8", "--set", "generate.search.programs=2"];
        assert_eq!(code(&hairpin(place.path(), &[&generate[..], more].concat())), 0);
        let verify = ["verify", out, "--json"];
        let good = json(&hairpin(place.path(), &verify));
        assert_eq!((&good["optimum"]["verified"], good["exit_code"].as_u64()), (&Value::Bool(true), Some(0)), "{good}");
        // A choice of its programs has the proof as well.
        let chosen = format!("{out}-chosen");
        assert_eq!(
            code(&hairpin(place.path(), &["select", out, "--cases", "1", "--by", "stress", "--out", &chosen])),
            0
        );
        let of_choice = json(&hairpin(place.path(), &["verify", &chosen, "--json"]));
        assert_eq!(
            (&of_choice["optimum"]["verified"], of_choice["exit_code"].as_u64()),
            (&Value::Bool(true), Some(0)),
            "{of_choice}"
        );
        // A move that costs more than was searched for.
        let graph = place.path().join(out).join("graph.csv");
        let text = fs::read_to_string(&graph).unwrap();
        let cost = text.lines().next().unwrap().split(',').find(|cell| !cell.is_empty()).unwrap();
        fs::write(&graph, text.replacen(cost, "9000.000", 1)).unwrap();
        let dearer = json(&hairpin(place.path(), &verify));
        assert_eq!(
            (&dearer["optimum"]["verified"], dearer["exit_code"].as_u64()),
            (&Value::Bool(false), Some(1)),
            "{dearer}"
        );
        fs::write(&graph, text).unwrap();
        fs::remove_file(place.path().join(out).join("optimum.json")).unwrap();
        let refused = hairpin(place.path(), &["verify", out]);
        let told = String::from_utf8_lossy(&refused.stdout).into_owned();
        assert!(code(&refused) == 1 && told.contains("optimum.json is missing"), "{told}");
    }
}

#[test]
fn a_program_that_was_changed_is_found() {
    let place = TempDir::new().unwrap();
    let mut arguments = vec!["generate", "arm", "--out", "arm"];
    arguments.extend(SMALL);
    assert_eq!(code(&hairpin(place.path(), &arguments)), 0);
    // A module of its own, as earlier versions kept them, stands for the one of the table.
    assert_eq!(code(&hairpin(place.path(), &["export", "arm", "--to", "rapid"])), 0);
    let path = place.path().join("arm/programs/0000.mod");
    let text = fs::read_to_string(place.path().join("arm/export/0000.mod")).unwrap();
    fs::write(&path, &text).unwrap();
    assert_eq!(code(&hairpin(place.path(), &["verify", "arm"])), 0);
    let target = text.lines().find(|line| line.contains("robtarget")).unwrap();
    let (before, after) = target.split_once(":= [[").unwrap();
    fs::write(&path, text.replace(target, &format!("{before}:= [[1{after}"))).unwrap();
    let verified = hairpin(place.path(), &["verify", "arm"]);
    assert_eq!(code(&verified), 1, "{}", String::from_utf8_lossy(&verified.stdout));
}

#[test]
fn faults_are_seen_by_the_judge() {
    let place = TempDir::new().unwrap();
    for (fault, limit) in [
        ("execute.faults={ tool_offset_mm = [0, 0, 20] }", "spec.path.max_mm=5.0"),
        ("execute.faults={ start_delay_s = 0.5 }", "spec.arrival.max_late_ms=100"),
    ] {
        let mut arguments = vec!["stress", "arm", "--force", "--set", fault, "--set", limit];
        arguments.extend(SMALL);
        let stress = hairpin(place.path(), &arguments);
        let told = String::from_utf8_lossy(&stress.stdout).into_owned();
        assert_eq!(code(&stress), 1, "{fault}: {told}");
        assert!(told.contains("FAIL 2/2") && (told.contains(" mm > ") || told.contains(" ms > ")), "{told}");
    }
}

#[test]
fn clouds_need_nothing_but_an_arm() {
    let place = TempDir::new().unwrap();
    let points = "x_mm,y_mm,z_mm\n300,100,400\n350,-100,300\n400,50,350\n250,200,450\n300,-200,500\n320,0,250\n";
    fs::write(place.path().join("p.csv"), points).unwrap();
    let found = hairpin(place.path(), &["max-load", "--cloud", "p.csv", "irb120", "--out", "ml", "--json"]);
    assert_eq!(code(&found), 0, "{}", String::from_utf8_lossy(&found.stderr));
    let answer = json(&found);
    let path: Vec<u64> = answer["path"].as_array().unwrap().iter().map(|row| row.as_u64().unwrap()).collect();
    let mut sorted = path.clone();
    sorted.sort_unstable();
    assert_eq!(sorted, [0, 1, 2, 3, 4, 5]);
    assert_eq!((answer["proven"].as_bool(), answer["gap_percent"].as_f64()), (Some(true), Some(0.0)));
    // The cost is the way between the rows of the file, mm.
    let rows: Vec<[f64; 3]> = points.lines().skip(1).map(row).collect();
    let way: f64 = path.windows(2).map(|pair| distance(&rows[pair[0] as usize], &rows[pair[1] as usize])).sum();
    assert!((answer["cost"].as_f64().unwrap() - way).abs() < 0.01, "{answer} {way}");
    assert_eq!(code(&hairpin(place.path(), &["export", "ml", "--to", "rapid"])), 0);
    let module = fs::read_to_string(place.path().join("ml/export/0000.mod")).unwrap();
    assert!(module.contains(&format!("MoveJ p{:02}", path[0])) && module.contains(&format!("MoveL p{:02}", path[5])));
    // Where points may come twice, programs come back to them and load the arm more.
    let twice = ["max-load", "--cloud", "p.csv", "irb120", "--visits", "2", "--out", "twice", "--json"];
    let twice = json(&hairpin(place.path(), &twice));
    let often = twice["path"].as_array().unwrap();
    assert!(often.len() > 6 && twice["proven"] == true && twice["cost"].as_f64() > answer["cost"].as_f64(), "{twice}");
    assert_eq!(code(&hairpin(place.path(), &["execute", "twice"])), 0);
    assert_eq!(code(&hairpin(place.path(), &["verify", "twice"])), 0);
    // The graph that was searched is one that can be searched again.
    let again = hairpin(place.path(), &["max-load", "--graph", "ml/graph.csv", "--json"]);
    assert_eq!(json(&again)["cost"], answer["cost"]);
    for (arguments, wanted) in [
        (&["max-load", "--cloud", "p.csv", "irb121"][..], "irb120"),
        (&["max-load", "--cloud", "p.csv", "generic"][..], "arm"),
        (&["max-load", "--cloud", "none.csv", "irb120"][..], "none.csv"),
        (&["max-load", "--cloud", "p.csv"][..], "CELL"),
        (&["max-load"][..], "--graph"),
    ] {
        let refused = hairpin(place.path(), arguments);
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(code(&refused) == 2 && told.contains(wanted), "{arguments:?}: {told}");
    }
    // Costs that all end in zeros are proven and checked in one scale.
    fs::write(place.path().join("line.csv"), "x_mm,y_mm,z_mm\n300,0,400\n350,0,400\n400,0,400\n").unwrap();
    let line = ["max-load", "--cloud", "line.csv", "irb120", "--out", "line", "--json"];
    assert_eq!(json(&hairpin(place.path(), &line))["cost"], 150.0);
    assert_eq!(code(&hairpin(place.path(), &["verify", "line"])), 0);
    fs::write(place.path().join("far.csv"), "x_mm,y_mm,z_mm\n3000,100,400\n3500,-100,300\n").unwrap();
    let nothing = hairpin(place.path(), &["max-load", "--cloud", "far.csv", "irb120", "--json"]);
    assert_eq!((code(&nothing), &json(&nothing)["path"]), (3, &Value::Null));
}

fn row(line: &str) -> [f64; 3] {
    let numbers: Vec<f64> = line.split(',').map(|cell| cell.parse().unwrap()).collect();
    [numbers[0], numbers[1], numbers[2]]
}

fn distance(a: &[f64; 3], b: &[f64; 3]) -> f64 {
    (0..3).map(|i| (a[i] - b[i]).powi(2)).sum::<f64>().sqrt()
}

#[test]
fn what_is_not_there_is_refused_by_name() {
    let place = TempDir::new().unwrap();
    for (set, wanted) in [
        ("generate.moves.speeds=[\"v123\"]", "generate.moves.speeds[0]"),
        ("generate.moves.zones=[\"z11\"]", "generate.moves.zones[0]"),
        ("generate.search.visits=17", "generate.search.visits"),
        ("world.keep_out_mm=[\"x^2 <\"]", "world.keep_out_mm[0]"),
        ("task.points=[[300,0,400],[350,0,400],[300,0,400]]", "task.points[2]"),
        ("world.tool.q1_q4=[1, 1, 0, 0]", "world.tool.q1_q4"),
        ("task.home_deg=[0, 0, 0, 0, 300, 0]", "task.home_deg"),
        ("spec.regression={ baseline = \"7.14\" }", "there is no such folder"),
        ("execute.logs=\"nightly\"", "execute.logs"),
        ("execute.log_clock=\"offset-removed\"", "execute.log_clock"),
        ("generate.moves.speed=[]", "speeds"),
    ] {
        let refused = hairpin(place.path(), &["generate", "arm", "--set", set]);
        let told = String::from_utf8_lossy(&refused.stderr).into_owned();
        assert!(code(&refused) == 2 && told.contains(wanted), "{set}: {told}");
    }
}

#[test]
fn an_arm_may_come_as_urdf() {
    let place = TempDir::new().unwrap();
    let joints = [
        ("0 0 0.29", "0 0 1"),
        ("0 0 0", "0 1 0"),
        ("0 0 0.27", "0 1 0"),
        ("0 0 0.07", "1 0 0"),
        ("0.302 0 0", "0 1 0"),
        ("0 0 0", "1 0 0"),
    ];
    let mut urdf = String::from("<robot name=\"own\">\n<link name=\"l0\"/>\n");
    for (i, (origin, axis)) in joints.iter().enumerate() {
        urdf += &format!(
            "<link name=\"l{0}\"/><joint name=\"j{0}\" type=\"revolute\"><parent link=\"l{i}\"/><child link=\"l{0}\"/>\
             <origin xyz=\"{origin}\"/><axis xyz=\"{axis}\"/><limit lower=\"-2.5\" upper=\"2.5\" velocity=\"3\" effort=\"1\"/></joint>\n",
            i + 1
        );
    }
    fs::write(place.path().join("own.urdf"), urdf + "</robot>\n").unwrap();
    fs::write(place.path().join("p.csv"), "x_mm,y_mm,z_mm\n300,100,400\n350,-100,300\n300,50,350\n").unwrap();
    let found = hairpin(place.path(), &["max-load", "--cloud", "p.csv", "own.urdf", "--json"]);
    assert_eq!(
        code(&found),
        0,
        "{} {}",
        String::from_utf8_lossy(&found.stdout),
        String::from_utf8_lossy(&found.stderr)
    );
    fs::write(place.path().join("bad.urdf"), "<robot name=\"own\"/>").unwrap();
    let refused = hairpin(place.path(), &["max-load", "--cloud", "p.csv", "bad.urdf", "--json"]);
    assert_eq!(code(&refused), 2, "{}", String::from_utf8_lossy(&refused.stdout));
}

/// Arcs are moves of the graph like others: searched with it, proven heaviest with it, in the program, and held to all
/// that by those who follow them again.
#[test]
fn arcs_are_searched_with_straight_moves_and_load_the_arm_more() {
    let place = TempDir::new().unwrap();
    let run = |out: &str| {
        let arcs = format!("generate.moves.arcs={out}");
        let few = ["--set", "task.points.count=8", "--set", "generate.search.programs=2", "--set", "execute.repeat=1"];
        let stress = [&["stress", "arm", "--json", "--out", out, "--set", &arcs][..], &few].concat();
        let stress = hairpin(place.path(), &stress);
        assert_eq!(code(&stress), 0, "{}", String::from_utf8_lossy(&stress.stderr));
        let exported = hairpin(place.path(), &["export", out, "--to", "rapid"]);
        assert_eq!(code(&exported), 0, "{}", String::from_utf8_lossy(&exported.stderr));
        let module = place.path().join(out).join("export/0000.mod");
        let check = hairpin(place.path(), &["import", module.to_str().unwrap(), "--check", "--robot", "irb120"]);
        assert_eq!(code(&check), 0, "{}", String::from_utf8_lossy(&check.stdout));
        let proof: Value =
            serde_json::from_str(&fs::read_to_string(place.path().join(out).join("optimum.json")).unwrap()).unwrap();
        (fs::read_to_string(&module).unwrap(), proof)
    };
    let verify = || {
        let verified = hairpin(place.path(), &["verify", "true", "--json"]);
        (code(&verified), serde_json::from_slice::<Value>(&verified.stdout).unwrap())
    };
    let ((_, straight), (module, with_arcs)) = (run("false"), run("true"));
    assert!(with_arcs["cost"].as_i64() > straight["cost"].as_i64(), "{straight} {with_arcs}");
    let passed = with_arcs["passed"].as_array().unwrap();
    assert!(!passed.is_empty() && module.matches("MoveC ").count() == passed.len(), "{module}");
    assert!(!place.path().join("false/arcs.csv").exists());
    let (fine, told) = verify();
    assert!(fine == 0 && told["optimum"]["verified"] == true && told["checked"] == 2, "{told}");
    // Every ordered triple is told of, with a cost or a reason; the graph that is followed again has the arcs in it.
    let table = place.path().join("true/arcs.csv");
    let arcs = fs::read_to_string(&table).unwrap();
    let (free, refused): (Vec<&str>, Vec<&str>) = arcs.lines().skip(1).partition(|line| line.ends_with(','));
    assert_eq!(free.len() + refused.len(), 8 * 7 * 6);
    assert!(free.len() > 10 && refused.iter().all(|line| line.contains(",,")), "{arcs}");
    let pairs = fs::read_to_string(place.path().join("true/graph.csv")).unwrap();
    let pairs = pairs.lines().flat_map(|line| line.split(',')).filter(|cell| !cell.is_empty()).count();
    assert!(told["graph"]["moves"].as_u64().unwrap() >= (free.len() + pairs) as u64, "{told}");
    // An arc that costs more than was searched makes another path the heaviest.
    let dearer = free[0].split(',').take(3).collect::<Vec<_>>().join(",");
    fs::write(&table, arcs.replace(free[0], &format!("{dearer},99999.000,"))).unwrap();
    let (wrong, told) = verify();
    assert!(wrong == 1 && told["optimum"]["findings"][0].as_str().unwrap().contains("costs"), "{told}");
    // The command for programs alone tells what is passed.
    let few = ["--set", "task.points.count=8", "--set", "generate.moves.arcs=true"];
    fs::write(place.path().join("p.csv"), "x_mm,y_mm,z_mm\n300,100,400\n350,-100,300\n300,50,350\n250,-150,380\n")
        .unwrap();
    let asked = [&["max-load", "--cloud", "p.csv", "arm", "--json"][..], &few[2..]].concat();
    let found = hairpin(place.path(), &asked);
    let told: Value = serde_json::from_slice(&found.stdout).unwrap();
    assert!(code(&found) == 0 && told["proven"] == true && told["passed"].is_array(), "{told}");
    for without in ["generate.moves.kind=\"joint\"", "generate.mode=\"cartesian\"", "generate.search.visits=2"] {
        let arcs = ["--set", "generate.moves.arcs=true", "--set", without];
        let refused = hairpin(place.path(), &[&["generate", "arm", "--out", "no"][..], &arcs].concat());
        assert!(code(&refused) == 2 && String::from_utf8_lossy(&refused.stderr).contains("generate.moves.arcs"));
    }
}
