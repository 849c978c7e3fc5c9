//! Programs of arms in the languages of their controllers.

use std::path::{Path, PathBuf};

use hairpin::campaign::arm::{ArmSetup, graph_of};
use hairpin::campaign::scenario::ArmMode;
use hairpin::campaign::{Case, Evidence};
use hairpin::robot::arm::{AXES, Coupling, Joints};
use hairpin::trajectory::program::{JointTarget, Program, Speed};
use hairpin_formats::{atomic, capped, joint_trajectory, krl, rapid, urscript};

use super::written::Written;
use crate::Problem;
use crate::work::Work;

/// A language of arms' controllers.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Language {
    /// CASE.mod, CASE_slow.mod for the first run, and CASE.pgf, which names the module.
    Rapid,
    /// CASE.script for Universal Robots.
    Urscript,
    /// CASE.src and CASE.dat for KUKA.
    Krl,
    /// CASE.joint_trajectory.json: the planned joints every 10 ms as a ROS 2 message.
    JointTrajectory,
}

impl Language {
    /// The most that straight moves are written with, m/s, where that is bounded.
    fn most_speed(self) -> Option<f64> {
        match self {
            Language::Urscript => Some(urscript::Settings::default().most_speed),
            Language::Krl => Some(krl::Settings::default().most_speed),
            Language::Rapid | Language::JointTrajectory => None,
        }
    }

    /// Names of the speeds of `program` that are written slower than they are.
    fn slower(self, program: &Program) -> Vec<String> {
        match self {
            Language::Urscript => urscript::slower(program, &urscript::Settings::default()),
            Language::Krl => krl::slower(program, &krl::Settings::default()),
            Language::Rapid | Language::JointTrajectory => Vec::new(),
        }
    }

    /// What is said of those.
    fn capped(self, names: &[String]) -> Option<String> {
        capped::sentence(names, self.most_speed()?)
    }
}

/// What modules of arms say whose configurations no controller knows.
const UNCONFIGURED: &str = "The arm has no opw: its configurations are not known, moves in joints go to joint angles, \
    ConfL and ConfJ are Off";

/// What modules of arms say whose controller tells axis 3 against the base.
const COUPLED: &str = "Joint targets have axis 3 as the controller tells it, rax_3 = axis 3 + axis 2 \
    (joints.j23_coupled); the bounds of axis 3 were held for its own angle";
/// Why no module is written of an arm of which nobody says how its controller tells axis 3.
const UNSAID: &str = "of this type of arm, which has a parallel rod, controllers tell axis 3 against the base, \
    rax_3 = axis 3 + axis 2, and nothing says whether this one does: joints.j23_coupled = true, or false, of the \
    robot's file or the scenario's robot";

/// Time between the points of joint trajectories, s.
const SAMPLE: f64 = 0.01;

/// Writes the program of every case; a case without one, or one that the language cannot hold, is told as missing.
///
/// # Errors
/// Modules that would move by another tool or work object than they were planned with; a file cannot be written.
pub(super) fn write(work: &Work, place: &Path, cases: &[&Case], language: Language) -> Result<Written, Problem> {
    if language == Language::Rapid {
        may_run(work).map_err(|why| Problem::input(format!("--to rapid: {why}")))?;
    }
    let (mut written, mut fast) = (Written::default(), Vec::new());
    for case in cases {
        let mut case = Case::clone(case);
        work.folder.read_witness(&mut case)?;
        let Some(program) = case.program() else {
            written.missing.push(format!("case {} has no program: it is no arm's", case.id()));
            continue;
        };
        fast.extend(language.slower(program).into_iter().filter(|name| !fast.contains(name)).collect::<Vec<_>>());
        match texts(work, &case, program, language) {
            Ok(texts) => {
                for (name, text) in texts {
                    let path: PathBuf = place.join(&name);
                    atomic::write(&path, text.as_bytes())?;
                    written.files.push(path);
                }
            }
            Err(why) => written.missing.push(format!("case {}: {why}", case.id())),
        }
    }
    let unconfigured = arm_of(work).is_ok_and(|arm| !arm.tells_configurations());
    let coupled = arm_of(work).is_ok_and(is_coupled);
    written.told.extend((coupled && language == Language::Rapid).then(|| COUPLED.into()));
    written.told.extend(language.capped(&fast));
    written.told.extend((unconfigured && language == Language::Rapid).then(|| UNCONFIGURED.into()));
    written.or_refused()
}

/// Writes `arc_clock.mod`, whose procedure clocks every move of the graph from standstill to standstill.
pub(super) fn write_clock(work: &Work, place: &Path) -> Result<Written, Problem> {
    let Some(arm) = work.setup.own::<ArmSetup>() else {
        return Err(Problem::input("--to arc-clock: the campaign is no arm's"));
    };
    let refuse = |why: String| Problem::input(format!("--to arc-clock: {why}"));
    may_run(work).map_err(refuse)?;
    let graph = graph_of(arm).map_err(refuse)?;
    let clock = arm.arc_clock(&graph).map_err(refuse)?;
    let evidence = match arm.scenario.generate.mode {
        ArmMode::Joint => Evidence::ClearAllLinks,
        ArmMode::Cartesian => Evidence::ClearToolSphere,
    };
    let mut header = vec![format!("Evidence of every move: {}", evidence.word())];
    header.extend((!clock.configured).then(|| UNCONFIGURED.into()));
    header.extend(is_coupled(arm).then(|| COUPLED.into()));
    let told =
        |target: &JointTarget| JointTarget { joints: arm.station.arm.coupling.told(&target.joints), ..target.clone() };
    let (home, at_start) = (told(&clock.home), clock.at_start.as_ref().map(told));
    let clocked = rapid::arc_clock(&rapid::Clocking {
        name: "hairpin_clock",
        tool: &clock.tool,
        work_object: &clock.work_object,
        points: &clock.points,
        arcs: &clock.arcs,
        home: &home,
        start: clock.start,
        configured: clock.configured,
        at_start: at_start.as_ref(),
        speed: &clock.speed,
        header: &header,
    });
    let clocked = clocked.map_err(|error| refuse(error.to_string()))?;
    let path = place.join("arc_clock.mod");
    atomic::write(&path, clocked.text.as_bytes())?;
    let mut written = Written::all(vec![path]);
    written.told.extend((!clock.configured).then(|| UNCONFIGURED.into()));
    written.told.extend(is_coupled(arm).then(|| COUPLED.into()));
    if !clocked.left_out.is_empty() {
        let count = clocked.left_out.len();
        written.missing.push(format!(
            "{count} of {} moves are not clocked: no way along moves leads there and back",
            clock.arcs.len()
        ));
    }
    Ok(written)
}

/// Names and texts of a program's files.
fn texts(work: &Work, case: &Case, program: &Program, language: Language) -> Result<Vec<(String, String)>, String> {
    let id = case.id();
    let mut header = vec![format!("Evidence: {}", case.claim())];
    header.extend(language.capped(&language.slower(program)));
    let arm = arm_of(work)?;
    Ok(match language {
        Language::Urscript => {
            let (settings, known) = (urscript::Settings::default(), Some(&arm.station.arm));
            let text = urscript::text(&arm.with_angles(program)?, &settings, known, &header);
            vec![(format!("{id}.script"), text.map_err(|error| error.to_string())?)]
        }
        Language::JointTrajectory => {
            let PlannedJoints { names, times_s, rows } = planned_joints(work, case)?;
            let text =
                joint_trajectory::text("base_link", &names, &times_s, &rows).map_err(|error| error.to_string())?;
            vec![(format!("{id}.joint_trajectory.json"), text)]
        }
        Language::Krl => {
            let program = Program { moves: arm.with_angles(program)?.moves, ..arm.for_controller(program) };
            let files = krl::files(&program, &krl::Settings::default(), &header).map_err(|error| error.to_string())?;
            vec![(format!("{id}.src"), files.src), (format!("{id}.dat"), files.dat)]
        }
        Language::Rapid => {
            let program = arm.in_wobj0(&arm.for_controller(program));
            let program = &program.with_joints(|q| arm.station.arm.coupling.told(q));
            header.extend((!arm.tells_configurations()).then(|| UNCONFIGURED.into()));
            header.extend(is_coupled(arm).then(|| COUPLED.into()));
            let module = rapid::module(program, &header).map_err(|error| error.to_string())?;
            let cap = Speed::predefined(rapid::FIRST_RUN).ok_or("no speed for the first run")?;
            let slow = rapid::module(&rapid::slow(program, &cap), &header).map_err(|error| error.to_string())?;
            vec![
                (format!("{id}.mod"), module),
                (format!("{id}_slow.mod"), slow),
                (format!("{id}.pgf"), rapid::program_file(&format!("{id}.mod"))),
            ]
        }
    })
}

/// A module that names `tool0` or `wobj0` moves by those of the controller; its joint targets are the controller's.
fn may_run(work: &Work) -> Result<(), String> {
    if arm_of(work).is_ok_and(|arm| arm.station.arm.coupling == Coupling::Unsaid) {
        return Err(UNSAID.into());
    }
    work.setup.misnamed().map_or(Ok(()), Err)
}

fn is_coupled(arm: &ArmSetup) -> bool {
    arm.station.arm.coupling == Coupling::Coupled
}

/// What an arm's joints are to do.
pub(super) struct PlannedJoints {
    pub(super) names: [String; AXES],
    pub(super) times_s: Vec<f64>,
    /// Angles at these times, rad.
    pub(super) rows: Vec<Joints>,
}

fn arm_of(work: &Work) -> Result<&ArmSetup, &'static str> {
    work.setup.own::<ArmSetup>().ok_or("it is no arm's")
}

/// Whether an arm's base stands elsewhere than at the origin of its world.
pub(super) fn stands_aside(work: &Work) -> bool {
    arm_of(work).is_ok_and(|arm| arm.stands_aside().is_some())
}

/// The planned joints of an arm's case every 10 ms.
pub(super) fn planned_joints(work: &Work, case: &Case) -> Result<PlannedJoints, String> {
    let arm = arm_of(work)?;
    let (times_s, rows) = arm.planned_joints(case, SAMPLE).map_err(|error| error.to_string())?;
    Ok(PlannedJoints { names: arm.station.arm.joint_names.clone(), times_s, rows })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;
    use crate::export::{Export, ExportSettings, Format};
    use crate::max_load::{CloudAnswer, CloudSettings, search_cloud};
    use crate::work::IfThere;

    /// Of arms with a parallel rod controllers tell axis 3 against the base.
    #[test]
    fn joint_targets_have_axis_3_as_the_controller_tells_it() {
        let place = tempfile::tempdir().unwrap();
        let shipped = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/robots/arm/irb120.toml");
        let arm = std::fs::read_to_string(shipped).unwrap().replace("name = \"irb120\"", "name = \"IRB 2400\"");
        let exported = |keys: &str, out: &str| {
            std::fs::write(place.path().join("arm.toml"), arm.replace("[joints]\n", &format!("[joints]\n{keys}\n")))
                .unwrap();
            let file = place.path().join("cell.toml");
            let text = "hairpin = 1\nrobot = \"arm.toml\"\nspec = \"none\"\n[world]\n\
                        tool = { name = \"t1\", radius_mm = 5 }\n[task]\nhome_deg = [0, 20, -15, 0, 30, 0]\npoints = [[300, 0, 300], [300, 100, 300]]\n";
            std::fs::write(&file, text).unwrap();
            let settings = CloudSettings { cell: file.to_string_lossy().into_owned(), ..CloudSettings::default() };
            let CloudAnswer::Searched(found) = search_cloud(&settings, &Unwatched).unwrap() else {
                panic!("these points can be met")
            };
            let folder = place.path().join(out);
            found.keep(&folder, IfThere::Refuse, &Unwatched).unwrap();
            Export::open(&ExportSettings { folder, ..ExportSettings::default() }).unwrap()
        };
        let home = |keys: &str, out: &str| {
            let written = exported(keys, out).write(Format::Program(Language::Rapid)).unwrap();
            let module = written.files.iter().find(|file| file.extension().is_some_and(|ending| ending == "mod"));
            let text = std::fs::read_to_string(module.unwrap()).unwrap();
            (text.contains("[[0,20,5,0,30,0],"), text.contains("[[0,20,-15,0,30,0],"), text.contains("rax_3"))
        };
        assert_eq!(home("j23_coupled = true", "coupled"), (true, false, true));
        assert_eq!(home("j23_coupled = false", "serial"), (false, true, false));
        for format in [Format::Program(Language::Rapid), Format::ArcClock] {
            let refused = exported("", if format == Format::ArcClock { "clock" } else { "unsaid" });
            let refused = refused.write(format).map(|_| ()).unwrap_err().to_string();
            assert!(refused.contains("joints.j23_coupled = true, or false"), "{refused}");
        }
    }

    /// Through `tool0` a controller moves the flange to where the tool's point was to go.
    #[test]
    fn no_module_names_what_a_controller_has_otherwise() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("cell.toml");
        for (number, (key, given, named)) in [
            ("tool", "tcp_mm = [0, 0, 50]", "name = \"tA\", tcp_mm = [0, 0, 50]"),
            ("wobj", "uframe_mm = [100, 0, 0]", "name = \"wA\", uframe_mm = [100, 0, 0]"),
        ]
        .into_iter()
        .enumerate()
        {
            let exported = |table: &str, out: &str| {
                let text = format!(
                    "hairpin = 1\nrobot = \"irb120\"\nspec = \"none\"\n[world]\n{key} = {{ {table} }}\n[task]\n\
                     points = [[300, 0, 300], [300, 100, 300]]\n"
                );
                std::fs::write(&file, text).unwrap();
                let cell = file.to_string_lossy().into_owned();
                let settings = CloudSettings { cell, ..CloudSettings::default() };
                let CloudAnswer::Searched(found) = search_cloud(&settings, &Unwatched).unwrap() else {
                    panic!("these points can be met")
                };
                let folder = place.path().join(format!("{out}{number}"));
                found.keep(&folder, IfThere::Refuse, &Unwatched).unwrap();
                Export::open(&ExportSettings { folder, ..ExportSettings::default() }).unwrap()
            };
            let own = exported(given, "own");
            for format in [Format::Program(Language::Rapid), Format::ArcClock] {
                let refused = own.write(format).map(|_| ()).unwrap_err().to_string();
                assert!(refused.contains(&format!("give `world.{key}.name` another name")), "{refused}");
            }
            // KRL says the frames themselves.
            assert_eq!(own.write(Format::Program(Language::Krl)).unwrap().files.len(), 2);
            assert_eq!(exported(named, "named").write(Format::Program(Language::Rapid)).unwrap().files.len(), 3);
        }
    }
}
