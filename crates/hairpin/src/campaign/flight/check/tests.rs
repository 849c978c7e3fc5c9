//! One line a bound: the value that is refused, and the key and the words it is refused with.

use serde_json::{Value, json};

use crate::campaign::scenario::KeyPath;
use crate::campaign::testing::quadrotor;
use crate::campaign::{Mistake, Scenario, Setup};

fn scenario() -> Value {
    json!({
        "hairpin": 1,
        "robot": quadrotor(),
        "world": { "size_m": [30.0, 30.0, 30.0], "keep_in_margin_m": 2.0, "obstacles": [
            { "name": "mast", "box": { "center_m": [12.0, 8.0, 5.0], "size_m": [2.0, 2.0, 10.0] } }] },
        "task": { "start_m": [3.0, 3.0, 3.0], "end_m": [15.0, 15.0, 15.0], "length": 10 },
    })
}

/// An obstacle with one corner at `from`, its edges along the axes.
fn tetrahedron(from: [f64; 3], edge: f64) -> Value {
    let [x, y, z] = from;
    json!({ "mesh": { "vertices_m": [from, [x + edge, y, z], [x, y + edge, z], [x, y, z + edge]],
        "triangles": [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]] } })
}

fn built(changes: &[(&str, Value)]) -> Result<Setup, Vec<Mistake>> {
    let mut value = scenario();
    for (key, new) in changes {
        KeyPath::parse(key).unwrap().put(&mut value, new.clone()).unwrap();
    }
    let scenario: Scenario = serde_json::from_value(value).unwrap();
    Setup::build(scenario.into())
}

fn mistakes(changes: &[(&str, Value)]) -> Vec<String> {
    built(changes).err().unwrap_or_default().iter().map(ToString::to_string).collect()
}

#[test]
fn the_scenario_itself_is_fine() {
    assert_eq!(mistakes(&[]), Vec::<String>::new());
    assert_eq!(mistakes(&[("task.length", json!(2)), ("generate.search.waypoints", json!(1))]), Vec::<String>::new());
}

#[test]
fn every_bound_holds() {
    let table = [
        ("hairpin", json!(2), "hairpin = 2: must be 1"),
        ("world.size_m", json!([30.0, 0.0, 30.0]), "world.size_m[1] = 0: must be > 0"),
        ("world.keep_in_margin_m", json!(15.0), "world.keep_in_margin_m = 15: must be ≥ 0 and < 15"),
        ("world.base", json!("cage-30m"), "world.base = \"cage-30m\": must be merged"),
        ("world.wind_m_s", json!([0.0, 0.0, 200.0]), "world.wind_m_s[2] = 200: must be between"),
        ("world.gusts", json!({ "std_m_s": 1.0, "correlation_s": 0.0 }), "world.gusts.correlation_s = 0: must be > 0"),
        (
            "world.origin",
            json!({ "lat_deg": 91.0, "lon_deg": 0.0, "alt_amsl_m": 0.0, "x_axis_heading_deg": 0.0 }),
            "world.origin.lat_deg = 91: must be ≥ -90",
        ),
        (
            "world.obstacles[0].sphere",
            json!({ "center_m": [1.0, 1.0, 1.0], "radius_m": 1.0 }),
            "box and sphere: must be",
        ),
        ("world.obstacles[0]", json!({ "name": "x" }), "world.obstacles[0] = no shape: must be exactly one of"),
        ("world.obstacles[0].box.size_m", json!([2.0, -2.0, 1.0]), "box.size_m[1] = -2: must be > 0"),
        ("world.obstacles[0]", json!({ "mesh": { "file": "a.stl" } }), "mesh.file = \"a.stl\": must be resolved"),
        (
            "world.obstacles[0]",
            json!({ "mesh": { "vertices_m": [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]],
                "triangles": [[0, 1, 2], [0, 1, 3], [0, 2, 3], [1, 2, 4]] } }),
            "mesh.triangles[3] = [1, 2, 4]: must be three indices below 4",
        ),
        (
            "world.obstacles[0].box.center_m",
            json!([120.0, 8.0, 5.0]),
            "world.obstacles[0] = `mast`, x 119.0 … 121.0, y 7.00 … 9.00, z 0.00 … 10.00 m: must be at least in part \
             inside the world, x 0.00 … 30.00, y 0.00 … 30.00, z 0.00 … 30.00 m, or left out; mm? its keys are in m",
        ),
        (
            "world.obstacles[0]",
            json!({ "sphere": { "center_m": [31.0, 31.0, 5.0], "radius_m": 1.4 } }),
            "world.obstacles[0] = `obstacle 0`, x 29.60 … 32.40",
        ),
        ("world.obstacles[0]", tetrahedron([9000.0; 3], 2000.0), "m, or left out; mm? `scale = 0.001` beside its file"),
        ("world.obstacles[0]", tetrahedron([0.0; 3], 9000.0), "must be cut to the world, x 0.00 … 30.00"),
        ("world.obstacles[0].mesh", json!({ "scale": 2.0, "vertices_m": [], "triangles": [] }), "mesh.scale = 2: must"),
        ("task.length", json!(1), "task.length = 1: must be 2 … 10 000"),
        ("task.length", json!(1_000_000), "task.length = 1000000: must be 2 … 10 000"),
        ("task.start_m", json!([12.0, 8.0, 5.0]), "must be outside obstacle `mast`; it is 1.00 m inside"),
        ("task.start_m", json!([13.1, 8.0, 5.0]), "at least 0.23 m, the robot's radius, from obstacle `mast`"),
        ("task.end_m", json!([15.0, 15.0, 31.0]), "task.end_m[2] = 31: must be inside the world: 2 … 28 m"),
        ("generate.timing", json!({ "leg_time_s": [4.0, 0.8] }), "must be rising"),
        ("generate.timing", json!({}), "must be exactly one of leg_time_s and step_s"),
        ("generate.timing", json!({ "step_s": 0.0 }), "step_s = 0: must be > 0"),
        ("generate.resolution", json!(1), "generate.resolution = 1: must be 2 … 12"),
        ("generate.velocities", json!(0), "generate.velocities = 0: must be 1 … 64"),
        ("generate.search.waypoints", json!(0), "generate.search.waypoints = 0: must be 1 … 100 000"),
        ("generate.search.waypoints", json!(1_000_000_000), "waypoints = 1000000000: must be 1 … 100 000"),
        ("generate.search.width", json!(0), "generate.search.width = 0"),
        ("generate.search.cases", json!(0), "generate.search.cases = 0"),
        ("generate.search.frontier", json!(0), "generate.search.frontier = 0"),
        ("generate.score", json!("fast"), "generate.score = \"fast\": must be one of random, "),
        ("generate.score", json!("learned:m.json"), "read with its scenario"),
        ("generate.limits.max_tilt_deg", json!(0.0), "max_tilt_deg = 0: must be > 0"),
        ("execute.logs", json!("*.ulg"), "`hairpin judge LOGS --campaign OUT` judges logs of flights"),
        ("execute.step_s", json!(0.01), "execute.step_s = 0.01: must be ≥ 0.00001 and ≤ 0.001"),
        ("execute.command", json!(" "), "must be a program and its arguments"),
        ("execute.repeat", json!(0), "execute.repeat = 0: must be 1"),
        ("spec.deviation", json!({ "max_m": -0.5 }), "spec.deviation.max_m = -0.5: must be > 0"),
        ("spec.violation_share", json!(1.0), "spec.violation_share = 1: must be ≥ 0 and < 1"),
    ];
    for (key, value, words) in table {
        let found = mistakes(&[(key, value.clone())]);
        assert!(found.iter().any(|m| m.contains(words)), "{key} = {value}: {found:?} should say {words:?}");
    }
}

#[test]
fn combinations_that_contradict_each_other() {
    let both = mistakes(&[("execute.controller", json!("geometric")), ("execute.command", json!("sim"))]);
    assert!(both[0].contains("one of the two"), "{both:?}");
    let hull = mistakes(&[("generate.reach", json!("hull")), ("generate.timing", json!({ "leg_time_s": [0.8, 4.0] }))]);
    assert!(hull[0].contains("only the reach `witness`"), "{hull:?}");
    let exact = mistakes(&[
        ("generate.reach", json!("hull")),
        ("generate.search", json!({ "method": "exact", "waypoints": 5000 })),
    ]);
    assert_eq!(exact, ["generate.search.waypoints = 5000: must be 1 … 2 000"]);
    let several = mistakes(&[("task.length", json!(1)), ("spec.confidence", json!(2.0))]);
    assert_eq!(several.len(), 2, "{several:?}");
}

/// What no execution is measured by is not what nothing is feasible of.
#[test]
fn what_is_never_measured_is_not_searched_for() {
    let open = ("world.obstacles", json!([]));
    let worst = |target: &str| ("generate.search", json!({ "method": "worst", "target": target }));
    let by_limits = ("generate.search", json!({ "method": "worst" }));
    let in_loop = |stress: &str| ("generate.search", json!({ "method": "in-loop", "stress": stress }));
    let near = "must be another one, or obstacles given: there is nothing to be near to";
    let flown = "must be a stress that a flight is measured by";
    let program = ("execute.command", json!("sim"));
    let clear = ("spec", json!({ "clearance": { "min_m": 0.5 } }));
    let both = ("spec", json!({ "clearance": { "min_m": 0.5 }, "deviation": { "max_m": 0.5 } }));
    for (changes, told) in [
        (vec![worst("lateness")], format!("generate.search.target = \"lateness\": {flown}")),
        (vec![in_loop("lateness")], format!("generate.search.stress = \"lateness\": {flown}")),
        (vec![in_loop("saturation"), program], format!("generate.search.stress = \"saturation\": {flown}")),
        (vec![worst("clearance"), open.clone()], format!("generate.search.target = \"clearance\": {near}")),
        (
            vec![by_limits.clone(), clear.clone(), open.clone()],
            "spec.clearance.min_m = 0.5: must be beside another limit, or obstacles given: there is nothing to be near to"
                .to_owned(),
        ),
    ] {
        assert_eq!(mistakes(&changes), [told]);
    }
    for changes in [
        vec![worst("clearance")],
        vec![worst("tip-over"), open.clone()],
        vec![in_loop("saturation")],
        vec![by_limits.clone(), clear.clone()],
        vec![by_limits, both, open.clone()],
        vec![clear, open],
    ] {
        assert_eq!(mistakes(&changes), Vec::<String>::new());
    }
}

#[test]
fn vary_is_tried_before_anything_flies() {
    let table = [
        ("robot.mas_kg", json!({ "uniform": [1, 2] }), "unknown field `mas_kg`"),
        ("robot.mass_kg", json!({ "uniform": [2, 1] }), "low ≤ high"),
        ("robot.mass_kg", json!({ "uniform": [[1, 1], [2, 2]] }), "invalid type"),
        ("robot.mass_kg", json!({ "uniform": [1, 2], "normal": [1, 2] }), "exactly one of"),
        ("robot.mass_kg", json!({}), "exactly one of"),
        ("robot.mass_kg", json!({ "normal": [1, -1] }), "deviation ≥ 0"),
        ("robot.mass_kg", json!({ "normal": [1, 0.1], "min": 2, "max": 3 }), "at least 1 % of the draws"),
        ("world.wind_m_s", json!({ "uniform": [[0, 0], [1, 1]] }), "invalid length 2"),
        ("world.wind_m_s", json!({ "uniform": [[0, 0, 0], [1, 1]] }), "arrays of one shape"),
        ("world.wind_m_s", json!({ "uniform": [[0, 0, 0], [1, 1, 1000]] }), "world.wind_m_s[2] = 1000"),
        ("world.obstacles[0].box.center_m", json!({ "choice": [[3, 3, 3]] }), "must be outside obstacle `mast`"),
        ("world.obstacles[1].box.center_m", json!({ "choice": [[3, 3, 3]] }), "no `world.obstacles[1]`"),
        ("execute.controller", json!({ "choice": [] }), "1 … 1000 values"),
        ("execute.controller", json!({ "choice": ["geometrical"] }), "unknown variant `geometrical`"),
        ("task.length", json!({ "uniform": [2.5, 5] }), "between whole numbers"),
        ("task.length", json!({ "uniform": [1, 5] }), "task.length = 1"),
        ("generate.search.width", json!({ "choice": [0] }), "generate.search.width = 0"),
        ("seed", json!({ "uniform": [1, 5] }), "this one may not"),
        ("hairpin", json!({ "uniform": [1, 5] }), "this one may not"),
        ("spec.deviation.max_m", json!({ "uniform": [-1.0, 5.0] }), "within bounds: spec.deviation.max_m = -1"),
        ("spec.confidence", json!({ "uniform": [0.9, 0.95] }), "this one may not: it judges all cases together"),
        ("vary.x", json!({ "uniform": [1, 5] }), "this one may not: it says what varies"),
        ("robot.name", json!({ "choice": ["a", "b"] }), "this one may not: it is a word, which no run reads"),
        ("world.origin.lat_deg", json!({ "uniform": [1, 5] }), "this one may not: it is where all cases lie on Earth"),
        ("execute.flaky.reruns", json!({ "uniform": [1, 5] }), "it is how often violations are run again"),
        ("world.keep_in_margin_m", json!({ "uniform": [1, 2] }), "a key that runs read: plans keep the margin"),
        ("robot.battery.endurance_s", json!({ "uniform": [60, 90] }), "a key that runs read: no run drains a battery"),
        ("execute.noise", json!({ "choice": [true, false] }), "a key that runs read: the robot has no noise"),
        ("execute.fixed_velocity_m_s", json!({ "uniform": [1, 5] }), "`stable-waypoint` has no use for it"),
        ("execute.segment_times", json!({ "choice": ["length"] }), "`stable-waypoint` has no use for it"),
        ("execute.goto_speed_m_s", json!({ "uniform": [1, 5] }), "`stable-waypoint` has no use for it"),
        ("a b", json!({ "uniform": [1, 5] }), "a dotted key"),
    ];
    for (key, distribution, words) in table {
        let mut entry = serde_json::Map::new();
        entry.insert(key.into(), distribution.clone());
        let found = mistakes(&[("vary", Value::Object(entry))]);
        assert!(found.iter().any(|m| m.contains(words)), "{key} = {distribution}: {found:?} should say {words:?}");
    }
    let margin = ("vary", json!({ "world.keep_in_margin_m": { "uniform": [1, 2] } }));
    let found = mistakes(&[margin, ("execute.controller", json!("python:mine.py"))]);
    assert!(found.iter().any(|m| m.contains("plans keep the margin")), "it is not told to who steers: {found:?}");
    let fine = json!({ "world.wind_m_s": { "uniform": [[-3, -3, 0], [3, 3, 0]] },
        "robot.mass_kg": { "normal": [1, 0.1], "min": 0.8 }, "world.obstacles.0.box.size_m[2]": { "choice": [4, 8] },
        "generate.limits.max_speed_m_s": { "uniform": [5, 8] } });
    assert_eq!(mistakes(&[("vary", fine)]), Vec::<String>::new());
}

/// Each varies once somebody reads it.
#[test]
fn what_somebody_reads_may_vary() {
    let speeds = json!({ "execute.fixed_velocity_m_s": { "uniform": [1, 5] } });
    assert_eq!(mistakes(&[("vary", speeds), ("execute.controller", json!("fixed-velocity"))]), Vec::<String>::new());
    let either = json!({ "execute.segment_times": { "choice": ["length", "sqrt-length"] },
        "execute.controller": { "choice": ["geometric", "anafi"] } });
    assert_eq!(mistakes(&[("vary", either)]), Vec::<String>::new());
    let noise = json!({ "execute.noise": { "choice": [true, false] } });
    let noisy = ("robot.moment_noise_n2_m2_s", json!(1e-7));
    assert_eq!(mistakes(&[("vary", noise), noisy]), Vec::<String>::new());
}

#[test]
fn what_nobody_reads_is_told() {
    let told = |changes: &[(&str, Value)]| -> Vec<String> {
        let found = built(changes).expect("a scenario").passed_over();
        found.into_iter().map(|one| format!("{} = {}: {}", one.key, one.value, one.why)).collect()
    };
    let noise = ("execute.noise", json!(true));
    let noisy = ("robot.force_noise_n2_s", json!(5e-4));
    let no_noise = "execute.noise = true: the robot has no noise (force_noise_n2_s, moment_noise_n2_m2_s)";
    assert_eq!(told(std::slice::from_ref(&noise)), [no_noise]);
    assert_eq!(told(&[noise, noisy]), Vec::<String>::new());
    let speed = ("execute.fixed_velocity_m_s", json!(3.0));
    assert_eq!(
        told(std::slice::from_ref(&speed)),
        ["execute.fixed_velocity_m_s = 3.0: `stable-waypoint` has no use for it"]
    );
    assert_eq!(told(&[speed, ("execute.controller", json!("fixed-velocity"))]), Vec::<String>::new());
    let ways = [("execute.segment_times", json!("length")), ("execute.goto_speed_m_s", json!(1.0))];
    assert_eq!(told(&ways).len(), 2);
}

/// Of all that a robot could be drawn beside air alone is told and not refused: the template draws it for any robot.
#[test]
fn air_that_a_robot_without_drag_does_not_feel_is_told() {
    let dragless = ("robot.drag_linear_n_s_m", json!(0.0));
    let air =
        [("world.wind_m_s", json!([8.0, 0.0, 0.0])), ("world.gusts", json!({ "std_m_s": 0.5, "correlation_s": 1.0 }))];
    let told = |changes: &[(&str, Value)]| -> Vec<String> {
        let found = built(changes).expect("a scenario").passed_over();
        found.into_iter().map(|one| format!("{}: {}", one.key, one.why)).collect()
    };
    let why = "the robot has no drag (drag_linear_n_s_m, drag_quadratic_n_s2_m2), and feels no air";
    let all = [&air[..], std::slice::from_ref(&dragless)].concat();
    assert_eq!(told(&all), [format!("world.wind_m_s: {why}"), format!("world.gusts: {why}")]);
    assert_eq!(told(&air), Vec::<String>::new());
    let program = ("execute.command", json!("python3 sim.py"));
    assert_eq!(told(&[&all[..], std::slice::from_ref(&program)].concat()), Vec::<String>::new());
    let wind = ("vary", json!({ "world.wind_m_s": { "uniform": [[-3, -3, 0], [3, 3, 0]] } }));
    // A draw that no run feels is no draw of any.
    let unfelt = |changes: &[(&str, Value)]| built(changes).expect("a scenario").unfelt_draws();
    let beside =
        json!({ "world.wind_m_s": { "uniform": [[-3, -3, 0], [3, 3, 0]] }, "robot.mass_kg": { "choice": [1] } });
    let of_plan =
        json!({ "world.wind_m_s": { "uniform": [[-3, -3, 0], [3, 3, 0]] }, "task.length": { "choice": [5] } });
    assert_eq!(unfelt(&[wind.clone(), dragless.clone()]), Some(why));
    assert_eq!(unfelt(&[("vary", of_plan), dragless.clone()]), Some(why));
    assert_eq!(unfelt(&[("vary", beside), dragless.clone()]), None);
    assert_eq!((unfelt(std::slice::from_ref(&wind)), unfelt(std::slice::from_ref(&dragless))), (None, None));
    let drawn = [wind, dragless];
    assert_eq!(told(&drawn), [format!("vary.\"world.wind_m_s\": {why}")]);
    assert_eq!(told(&drawn[..1]), Vec::<String>::new());
    assert_eq!(told(&[&drawn[..], &[program]].concat()), Vec::<String>::new());
}

/// Two draws of one value: which of them a run saw, its row could not tell.
#[test]
fn a_key_varies_once() {
    let wind = json!({ "uniform": [[-1, -1, 0], [1, 1, 0]] });
    let across = json!({ "uniform": [2, 3] });
    for (key, draw) in [("world.wind_m_s[0]", &across), ("world.wind_m_s.0", &across), ("world.wind_m_s ", &wind)] {
        let vary = ("vary", json!({ "world.wind_m_s": wind, key: draw }));
        let told = mistakes(&[vary, ("world.wind_m_s", json!([0.0, 0.0, 0.0]))]);
        assert!(
            told.len() == 1 && told[0].contains("a key that is drawn once: `world.wind_m_s` is drawn too"),
            "{told:?}"
        );
    }
}

/// Flights of other seeds differ by noise and gusts alone.
#[test]
fn flights_without_chance_repeat() {
    let repeats = |changes: &[(&str, Value)]| built(changes).expect("a scenario").repeats().is_some();
    assert!(repeats(&[]) && repeats(&[("world.wind_m_s", json!([1.0, 0.0, 0.0]))]));
    for chance in [
        ("world.gusts", json!({ "std_m_s": 0.5, "correlation_s": 1.0 })),
        ("robot.force_noise_n2_s", json!(5e-4)),
        ("execute.command", json!("python3 sim.py")),
        ("vary", json!({ "robot.moment_noise_n2_m2_s": { "uniform": [0, 1e-7] } })),
    ] {
        assert!(!repeats(std::slice::from_ref(&chance)), "{chance:?}");
    }
}

/// A body that is larger than the room at the world's edge leaves was told by nobody.
#[test]
fn a_body_that_may_reach_through_the_edges_is_named() {
    let words = |margin: f64| {
        let changes = [("world.keep_in_margin_m", json!(margin)), ("robot.clearance_radius_m", json!(2.0))];
        let setup = built(&changes).expect("a scenario");
        let mut said = Vec::new();
        crate::campaign::flight::assumptions::claim(setup.own().expect("a flight"), &[], &mut said);
        let told = said.iter().any(|sentence| sentence.contains("so that it may reach through them"));
        assert_eq!(told, setup.unknown_shapes().is_some(), "{said:?}");
        setup.unknown_shapes().map(|words| words.into_owned())
    };
    assert_eq!(words(2.0), None);
    let told = "the body may reach through the world's edges: clearance_radius_m 2 > keep_in_margin_m 1.5";
    assert_eq!(words(1.5).as_deref(), Some(told));
}

/// `[vary]` was drawn for no run where nobody said how many there are.
#[test]
fn what_is_drawn_for_runs_needs_two() {
    let repeat = |changes: &[(&str, Value)]| built(changes).expect("a scenario").scenario.executor().repeat;
    let drawn = |key: &str, range: Value| ("vary", json!({ key: { "uniform": range } }));
    let (wind, plan) = (drawn("robot.mass_kg", json!([0.8, 0.9])), drawn("task.length", json!([9, 10])));
    assert_eq!((repeat(&[]), repeat(std::slice::from_ref(&wind)), repeat(&[plan])), (1, 2, 1));
    assert_eq!(repeat(&[wind, ("execute.repeat", json!(1))]), 1);
}
