//! A mistake in a scenario is told with file, line, column, key, value, bound, and the nearest valid key.

use std::path::Path;

use hairpin::campaign::Scenario;
use hairpin::campaign::scenario::FlightScenario;
use hairpin_formats::scenario::{Report, read_setup, setup_for};

const FINE: &str = include_str!("../fixtures/fine.toml");

fn read(text: &str, sets: &[(&str, &str)]) -> Result<Scenario, Report> {
    let sets: Vec<_> = sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    read_setup(text, "my.toml", Path::new("tests/fixtures"), &sets).map(|setup| setup.scenario)
}

/// The fixture with one line changed.
fn with(from: &str, to: &str) -> Report {
    assert_eq!(FINE.matches(from).count(), 1, "`{from}` must stand once in the fixture");
    read(&FINE.replace(from, to), &[]).expect_err(to)
}

fn lines(report: &Report) -> String {
    let line =
        |c: &hairpin_formats::scenario::Complaint| format!("{}:{}:{}: {}\n", c.file, c.line, c.column, c.message);
    report.complaints().iter().map(line).collect()
}

#[test]
fn the_fixture_is_fine() {
    let scenario = read(FINE, &[]).unwrap_or_else(|report| panic!("{report}"));
    assert_eq!(scenario.length(), Some(10));
    assert_eq!(scenario.search().cases, 200);
}

#[test]
fn a_robot_without_a_kind_is_told_so_alone() {
    let place = tempfile::tempdir().expect("a folder of our own");
    let file = place.path().join("five.toml");
    std::fs::write(&file, "name = \"five\"\nmass_kg = 1.2\n").expect("a file of our own");
    let report = setup_for(&file.to_string_lossy(), &[]).expect_err("no kind");
    let told = report.to_string();
    assert!(told.contains("has no `kind`") && told.contains("\"boat\"") && !told.contains("task"), "{told}");
}

/// A table was made of it, of a type that nobody had given.
#[test]
fn an_element_of_what_is_not_given_is_told_as_such() {
    let report = read(FINE, &[("world.wind_m_s[0]", "3")]).expect_err("no wind is given");
    let [one] = report.complaints() else { panic!("{report}") };
    assert_eq!((&*one.field, &*one.value, &*one.file), ("world.wind_m_s[0]", "0", "--set"));
    assert!(one.bound.starts_with("there is no `world.wind_m_s` to take an element of"), "{report}");
    let whole = "\"world.wind_m_s\" = { uniform = [[-3, -3, 0], [3, 3, 0]] }";
    let report = with(whole, "\"world.wind_m_s[0]\" = { uniform = [-3, 3] }");
    let [one] = report.complaints() else { panic!("{report}") };
    assert!(one.message.contains("it has no `world.wind_m_s[0]`: there is no `world.wind_m_s`"), "{report}");
}

#[test]
fn every_kind_of_mistake_is_told_where_it_stands() {
    let table = [
        // Not finite.
        ("keep_in_margin_m = 2.0", "keep_in_margin_m = nan"),
        ("start_m = [3, 3, 3]", "start_m = [3, inf, -inf]"),
        ("mass_kg = 1.0", "mass_kg = +nan"),
        ("max_speed_m_s = 8.0", "max_speed_m_s = 1e999"),
        // Out of bounds.
        ("hairpin = 1", "hairpin = 2"),
        ("size_m = [30, 30, 30]", "size_m = [30, -30, 30]"),
        ("start_m = [3, 3, 3]", "start_m = [12, 8, 5]"),
        ("end_m = [15, 15, 15]", "end_m = [15, 15, 31]"),
        ("length = 10", "length = 1"),
        ("length = 10", "length = 1_000_000"),
        ("waypoints = 250", "waypoints = 0"),
        ("waypoints = 250", "waypoints = 1_000_000_000"),
        ("width = 5", "width = 0"),
        ("cases = 200", "cases = 0"),
        ("leg_time_s = [0.8, 4.0]", "leg_time_s = [4.0, 0.8]"),
        ("leg_time_s = [0.8, 4.0]", "leg_time_s = [0.8, 4.0], step_s = 1.0"),
        ("reach = \"witness\"", "reach = \"hull\""),
        ("max_m = 0.50", "max_m = -0.50"),
        ("uniform = [[-3, -3, 0], [3, 3, 0]]", "uniform = [[3, 3, 0], [-3, -3, 0]]"),
        ("\"world.wind_m_s\" =", "\"world.wind\" ="),
        // Unknown keys.
        ("search = {", "serch = {"),
        ("width = 5", "widht = 5"),
        ("score =", "waypoints = 3\nscore ="),
        ("[spec]", "[specs]\n[spec]"),
        ("mass_kg = 1.0", "mass_kg = 1.0\nweight_kg = 1.0"),
        // Wrong types and words.
        ("width = 5", "width = \"five\""),
        ("width = 5", "width = 5.5"),
        ("width = 5", "width = -5"),
        ("start_m = [3, 3, 3]", "start_m = [3, 3]"),
        ("start_m = [3, 3, 3]", "start_m = 3"),
        ("start_m = [3, 3, 3]", "start_m = [3, 3, \"3\"]"),
        ("length = 10", "length = 2026-01-01"),
        ("reach = \"witness\"", "reach = \"witnes\""),
        ("method = \"beam\"", "method = \"annealing\""),
        ("controller = \"minimum-snap\"", "controller = 3"),
        ("score = \"high-velocity-90\"", "score = \"learned:model.json\""),
        ("controller = \"minimum-snap\"", "logs = \"flights/*.ulg\""),
        ("seed = 10", "seed = 99999999999999999999999999999999999999999999"),
        ("seed = 10", "seed = 18446744073709551615"),
        ("[robot]", "[robots]"),
        // Missing keys.
        ("length = 10\n", "\n"),
        ("center_m = [12, 8, 5], ", ""),
        ("size_m = [30, 30, 30]", ""),
        // No TOML.
        ("length = 10", "length = "),
        ("length = 10", "length = 10\nlength = 11"),
    ];
    let mut told = String::new();
    for (from, to) in table {
        told += &format!(
            "{}\n",
            if to.trim().is_empty() { format!("without {from}") } else { to.to_owned() }.trim_end().replace('\n', "⏎")
        );
        for line in lines(&with(from, to)).lines() {
            told += &format!("    {line}\n");
        }
    }
    insta::assert_snapshot!(told);
}

#[test]
fn a_caret_stands_under_the_value() {
    let report = with("width = 5", "width = \"five\"");
    insta::assert_snapshot!(report.render(false));
    let coloured = report.render(true);
    assert!(coloured.contains("\u{1b}["), "{coloured}");
    assert!(!report.render(false).contains('\u{1b}'));
}

#[test]
fn several_mistakes_are_told_at_once() {
    let text =
        FINE.replace("width = 5", "widht = 5").replace("length = 10", "length = true").replace("seed = 10", "sed = 1");
    assert_eq!(read(&text, &[]).unwrap_err().complaints().len(), 3);
}

#[test]
fn keys_that_vary_are_told_the_nearest_one_too() {
    for (around, key, words) in [
        ("quadrotor", "robot.mas_kg", "no `robot.mas_kg`: did you mean `mass_kg`? valid in `robot`: "),
        ("quadrotor", "world.obstacles[0].box.sise_m", "did you mean `size_m`? valid in `world.obstacles[0].box`: "),
        ("quadrotor", "exeute.controller", "no `exeute`: did you mean `execute`? valid: hairpin, "),
        // Of several kinds of robots the keys of the one that there is.
        ("car", "robot.max_speed_m_s", "did you mean `speed_m_s`? valid in `robot`: "),
        ("car", "robot.wheelbas_m", "did you mean `wheelbase_m`? valid in `robot`: "),
        ("differential-drive", "robot.wheelbase_m", "no `robot.wheelbase_m`: "),
        // A key of another kind under the same name is no hint.
        ("car", "robot.slip_at_20_deg", "no `robot.slip_at_20_deg`: valid in `robot`: "),
        ("car", "execute.latncy_s", "did you mean `latency_s`? valid in `execute`: "),
        ("arm", "generate.moves.clearance", "did you mean `clearance_mm`? valid in `generate.moves`: "),
    ] {
        let wall = ("world.obstacles", "[{ name = \"wall\", box = { center_m = [9, 5, 5], size_m = [1, 1, 1] } }]");
        let drawn = (format!("vary.\"{key}\""), "{ uniform = [1, 2] }");
        let walled = key.starts_with("world").then_some((wall.0.to_owned(), wall.1));
        let sets: Vec<_> = walled.into_iter().chain([drawn]).map(|(key, value)| (key, value.to_owned())).collect();
        let told = hairpin_formats::scenario::setup_for(around, &sets).unwrap_err();
        let [one] = told.complaints() else { panic!("{told}") };
        assert!(one.field == format!("vary.\"{key}\"") && one.message.contains(words), "{told}");
        assert!(!one.message.contains("untagged"), "{told}");
    }
}

#[test]
fn machines_get_fields() {
    let told = with("length = 10", "length = 1").to_json();
    let length = &told[0];
    assert_eq!(length["file"], "my.toml");
    assert_eq!(length["field"], "task.length");
    assert_eq!(length["value"], "1");
    assert_eq!(length["bound"], "must be 2 … 10 000");
    let line = FINE.lines().position(|line| line.starts_with("length")).unwrap() + 1;
    assert_eq!((length["line"].as_u64(), length["column"].as_u64()), (Some(line as u64), Some(10)));
}

#[test]
fn overrides() {
    let set = |key: &str, value: &str| {
        let read = read(FINE, &[(key, value)]).unwrap_or_else(|report| panic!("{report}"));
        read.own::<FlightScenario>().expect("a flight").clone()
    };
    assert_eq!(set("generate.search.width", "7").generate.search.width, 7);
    assert_eq!(set("world.obstacles[0].box.size_m", "[1, 1, 1]").world.obstacles[0].cuboid.unwrap().size_m, [1.0; 3]);
    assert_eq!(set("world.obstacles.0.box.size_m[2]", "4").world.obstacles[0].cuboid.unwrap().size_m, [2.0, 2.0, 4.0]);
    assert_eq!(
        set("robot.mass_kg", "1.2").robot,
        read(&FINE.replace("mass_kg = 1.0", "mass_kg = 1.2"), &[]).unwrap().own::<FlightScenario>().unwrap().robot
    );
    assert_eq!(set("spec.overshoot", "{ max_m = 2 }").spec.overshoot.unwrap().max_m, 2.0);
    assert!(set("vary", "{}").vary.is_empty());
    assert_eq!(set("vary.\"robot.mass_kg\"", "{ choice = [1, 2] }").vary.len(), 2);
    // Of keys that exclude each other, the one that is set takes the place of the file's.
    let stepped = set("generate.timing.step_s", "1.0").generate.timing.unwrap();
    assert_eq!((stepped.step_s, stepped.leg_time_s), (Some(1.0), None));
    let hull = set("generate.reach", "hull").generate.timing.unwrap();
    assert_eq!((hull.step_s, hull.leg_time_s), (Some(1.0), None));
    let command = set("execute.command", "python my_simulator.py").execute;
    assert_eq!((command.controller, command.command.as_deref()), (None, Some("python my_simulator.py")));
    let mut told = String::new();
    for (key, value) in [
        ("generate.serch.width", "7"),
        ("generate.search.width", "0"),
        ("generate.search.width", "nan"),
        ("world.obstacles[3].name", "x"),
        ("task.length.x", "1"),
        ("generate..reach", "hull"),
        ("task.start_m", "[1, 2"),
        ("generate.reach", "hul"),
        ("task.length", ""),
    ] {
        told += &lines(&read(FINE, &[(key, value)]).unwrap_err());
    }
    insta::assert_snapshot!(told);
}

#[test]
fn axes_of_an_arm_may_count_the_other_way() {
    const ARM: &str = include_str!("../../../../data/scenarios/arm.toml");
    let turned = |signs: &str| {
        let sets = [("robot.opw.signs".to_owned(), signs.to_owned())];
        read_setup(ARM, "arm.toml", Path::new("."), &sets).map(|_| ())
    };
    turned("[1, 1, 1, 1, 1, -1]").unwrap_or_else(|report| panic!("{report}"));
    for (signs, bound) in [("[1, 1, 1, 1, 1, -2]", "1 or -1"), ("[1, 1, 1, 1, 1, -200]", "-128 … 127")] {
        let told = turned(signs).expect_err(signs);
        assert!(lines(&told).contains(bound) && lines(&told).lines().count() == 1, "{}", lines(&told));
    }
}

/// The rest was held to a quadrotor's keys, with some twenty mistakes that were none.
#[test]
fn a_robot_that_cannot_be_read_is_told_alone() {
    let told = |kind: &str, robot: &str| {
        let line =
            |line: &str| if line.starts_with("robot = ") { format!("robot = {robot}\n") } else { format!("{line}\n") };
        let text: String = hairpin_formats::template::template(kind).expect(kind).lines().map(line).collect();
        let report = read(&text, &[]).expect_err(kind);
        let [one] = report.complaints() else { panic!("{kind}, {robot}: {report}") };
        one.field.clone()
    };
    for kind in ["quadrotor", "rover", "car", "differential-drive", "arm", "boat"] {
        for robot in ["\"nix.toml\"", "\"nix.urdf\"", "\"irb12\""] {
            assert_eq!(told(kind, robot), "robot", "{kind}: {robot}");
        }
    }
    assert_eq!(told("arm", "{ kind = \"arm\", urdf = \"nix.urdf\" }"), "robot.urdf");
}
