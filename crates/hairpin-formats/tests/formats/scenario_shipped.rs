//! Every shipped file can be used by its name; robots, worlds and meshes of the user's own by their paths.

use std::path::Path;

use hairpin::campaign::drive::DriveSetup;
use hairpin::campaign::scenario::{FlightScenario, RobotSource};
use hairpin::campaign::{Scenario, Setup};
use hairpin_formats::scenario::{Report, read_setup, setup_for, to_toml};
use hairpin_formats::{library, template};

fn setup(name: &str, sets: &[(&str, &str)]) -> Result<Setup, Report> {
    let sets: Vec<_> = sets.iter().map(|(key, value)| (key.to_string(), value.to_string())).collect();
    setup_for(name, &sets)
}

fn scenario(name: &str, sets: &[(&str, &str)]) -> Result<Scenario, Report> {
    setup(name, sets).map(|setup| setup.scenario)
}

fn fine(name: &str, sets: &[(&str, &str)]) -> Scenario {
    scenario(name, sets).unwrap_or_else(|report| panic!("{name}:\n{report}"))
}

fn flight(scenario: &Scenario) -> &FlightScenario {
    scenario.own::<FlightScenario>().expect("a scenario of flights")
}

fn robot_name(scenario: &Scenario) -> &str {
    match &flight(scenario).robot {
        RobotSource::Inline(robot) => &robot.name,
        RobotSource::Name(name) => panic!("`{name}` is not resolved"),
    }
}

#[test]
fn every_shipped_scenario_is_fine_and_survives_its_own_writing() {
    let names: Vec<_> = library::scenarios().map(|shipped| shipped.name).collect();
    for expected in
        ["quadrotor", "demo-quadrotor", "corridor", "paper-unstable", "paper-stable", "paper-random", "paper-anafi"]
    {
        assert!(names.contains(&expected), "{names:?}");
    }
    for name in names {
        let read = fine(name, &[]);
        let text = to_toml(&read, None).unwrap();
        let again = read_setup(&text, "scenario.toml", Path::new(""), &[]).unwrap_or_else(|r| panic!("{name}: {r}"));
        assert_eq!(again.scenario, read, "{name}");
        Setup::new(read).unwrap_or_else(|mistake| panic!("{name}: {mistake}"));
    }
}

#[test]
fn every_shipped_robot_and_world_serves() {
    for robot in library::rovers().chain(library::cars()).chain(library::differential_drives()) {
        let setup = setup(robot.name, &[]).unwrap_or_else(|report| panic!("{}: {report}", robot.name));
        assert_eq!(setup.robot_name(), robot.name);
        assert!(setup.own::<DriveSetup>().is_some());
    }
    for robot in library::quadrotors() {
        assert_eq!(robot_name(&fine(robot.name, &[])), robot.name);
    }
    for (world, start, end) in [
        ("cage-30m", "[3, 3, 3]", "[15, 15, 15]"),
        ("straight-corridor", "[2, 6, 2.5]", "[28, 6, 2.5]"),
        ("winding-corridor", "[2, 3, 2.5]", "[28, 3, 2.5]"),
    ] {
        let text = format!(
            "hairpin = 1\nrobot = \"flightgoggles\"\n[world]\nbase = \"{world}\"\nkeep_in_margin_m = 0.75\n\
             [task]\nstart_m = {start}\nend_m = {end}\nlength = 4\n"
        );
        let read = read_setup(&text, "w.toml", Path::new(""), &[]).unwrap_or_else(|report| panic!("{report}"));
        let read = flight(&read.scenario).clone();
        assert_eq!((read.world.base, read.world.keep_in_margin_m), (None, Some(0.75)), "its own key wins");
        assert!(read.world.size_m.is_some());
    }
}

#[test]
fn the_template_is_the_designs_example() {
    let read = fine("quadrotor", &[]);
    assert_eq!(robot_name(&read), "anafi");
    let read = flight(&read);
    assert_eq!((read.seed, read.task.length, read.execute.repeat), (10, 10, Some(5)));
    let search = &read.generate.search;
    assert_eq!((search.waypoints, search.width, search.cases, search.revisits), (250, 5, 20, false));
    assert_eq!(read.generate.limits.max_tilt_deg, Some(35.0));
    assert_eq!(read.world.origin.unwrap().x_axis_heading_deg, 73.5);
    assert_eq!(read.spec.deviation.unwrap().corner_m, 1.0);
    assert!(read.vary.contains_key("world.wind_m_s"));
    assert_eq!(template::template("quadrotor"), library::scenarios().find(|s| s.name == "quadrotor").map(|s| s.text));
    assert_eq!(template::template("submarine"), None);
}

#[test]
fn a_robot_file_of_the_users_own() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    let anafi = library::robots().find(|robot| robot.name == "anafi").unwrap().text;
    std::fs::write(path("mine.toml"), anafi.replace("name = \"anafi\"", "name = \"mine\"")).unwrap();
    assert_eq!(robot_name(&fine(path("mine.toml").to_str().unwrap(), &[])), "mine");
    let text = template::template("quadrotor").unwrap().replace("robot = \"anafi\"", "robot = \"mine.toml\"");
    std::fs::write(path("mission.toml"), text).unwrap();
    assert_eq!(robot_name(&fine(path("mission.toml").to_str().unwrap(), &[])), "mine");
    // A mistake in the robot's file is told in the robot's file.
    let broken = format!("# one line more\n{}", anafi.replace("mass_kg = ", "mass_kg = -"));
    std::fs::write(path("mine.toml"), broken).unwrap();
    let report = scenario(path("mission.toml").to_str().unwrap(), &[]).unwrap_err();
    let complaint = &report.complaints()[0];
    assert!(complaint.file.ends_with("mine.toml"), "{report}");
    assert_eq!(complaint.field, "robot.mass_kg");
    let line = anafi.lines().position(|line| line.starts_with("mass_kg")).unwrap() + 2;
    assert_eq!(complaint.line, line, "{report}");
}

#[test]
fn numbers_that_are_no_robot() {
    for (key, value, field) in [
        ("robot.mass_kg", "-0.8", "robot.mass_kg"),
        ("robot.mass_kg", "0", "robot.mass_kg"),
        ("robot.rotor_speed_rad_s", "[2000, 0]", "robot.rotor_speed_rad_s"),
        ("robot.rotors[1].spin", "0.5", "robot.rotors[1].spin"),
        ("robot.rotors", "[]", "robot.rotors"),
        ("robot.mass_kg", "nan", "robot.mass_kg"),
        ("robot.mas_kg", "1", "robot.mas_kg"),
    ] {
        let report = scenario("quadrotor", &[(key, value)]).expect_err(key);
        assert!(report.complaints()[0].field.starts_with(field), "{key} = {value}: {report}");
    }
}

#[test]
fn meshes_are_read_and_end_up_in_the_scenario() {
    let folder = tempfile::tempdir().unwrap();
    let obj = "v 9 9 9\nv 11 9 9\nv 9 11 9\nv 9 9 11\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";
    std::fs::write(folder.path().join("rock.obj"), obj).unwrap();
    let text = template::template("quadrotor").unwrap();
    let read_scaled = |file: &str, scale: &str| {
        let mesh = format!("{{ file = \"{file}\"{scale} }}");
        let set = ("world.obstacles".to_owned(), format!("[{{ name = \"rock\", mesh = {mesh} }}]"));
        read_setup(text, "quadrotor.toml", folder.path(), &[set]).map(|setup| setup.scenario)
    };
    let read = |file: &str| read_scaled(file, "");
    let scenario = read("rock.obj").unwrap_or_else(|report| panic!("{report}"));
    let mesh = flight(&scenario).world.obstacles[0].mesh.as_ref().unwrap();
    assert_eq!((mesh.vertices_m.len(), mesh.triangles.len(), &mesh.file), (4, 4, &None));
    let again = read_setup(&to_toml(&scenario, None).unwrap(), "s.toml", Path::new(""), &[]);
    assert_eq!(again.map(|setup| setup.scenario), Ok(scenario));
    assert_eq!(read("stone.obj").unwrap_err().complaints()[0].field, "world.obstacles[0].mesh.file");
    let in_mm = obj.replace('9', "9000").replace("11", "11000");
    std::fs::write(folder.path().join("mm.obj"), in_mm).unwrap();
    let said = read_scaled("mm.obj", ", scale = 0.001").unwrap();
    let said = flight(&said).world.obstacles[0].mesh.as_ref().unwrap();
    assert!((said.vertices_m[1][0] - 11.0).abs() < 1e-9 && said.scale.is_none(), "{said:?}");
    for scale in ["0", "-1", "nan"] {
        let wrong = read_scaled("mm.obj", &format!(", scale = {scale}")).unwrap_err();
        assert_eq!(wrong.complaints()[0].field, "world.obstacles[0].mesh.scale", "{wrong}");
    }
    let unsaid = read("mm.obj").unwrap_err();
    assert!(unsaid.to_string().contains("`scale = 0.001` beside its file"), "{unsaid}");
    std::fs::write(folder.path().join("open.obj"), &obj[..obj.len() - 8]).unwrap();
    assert!(read("open.obj").unwrap_err().complaints()[0].field.starts_with("world.obstacles[0].mesh"));
}

#[test]
fn names_that_mean_nothing() {
    let told = |name: &str, sets: &[(&str, &str)]| scenario(name, sets).unwrap_err().to_string();
    assert!(told("quadrotr", &[]).contains("did you mean `quadrotor`?"));
    assert!(told("no/such/file.toml", &[]).contains("no file and no shipped name"));
    assert!(told("quadrotor", &[("robot", "anaffi")]).contains("did you mean `anafi`?"));
    assert!(told("quadrotor", &[("robot", "mine.toml")]).contains("cannot be read"));
    assert!(told("corridor", &[("world.base", "winding")]).contains("did you mean `winding-corridor`?"));
}
