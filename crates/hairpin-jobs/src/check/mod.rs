//! A mission made elsewhere against the claim of a robot: a witness, or the first limit that breaks.

mod fences;
mod ground;
mod settings;
mod vehicle;
mod world;

use hairpin::campaign::{Broken, Certainty, Demands, Passage, Setup, passes};
use hairpin::judgement::Verdict;
use hairpin_formats::missions::{Frame, Mission};

use crate::{Problem, Watch};

pub(crate) use fences::{ARDUPILOT, PX4};
pub use settings::CheckSettings;
pub(crate) use vehicle::same_vehicle;
pub(crate) use world::open_around;
pub(crate) use world::{read_about_home, read_anywhere};

/// What came of it.
#[derive(Debug)]
pub struct Checked {
    /// The mission, in the world that it was checked in.
    pub mission: Mission,
    /// What the claim says, leg by leg.
    pub passage: Passage,
    /// The answer: `None` where it was not found out.
    pub feasible: Option<bool>,
    /// The limit that decides it.
    pub broken: Option<Broken>,
    /// The robot's name.
    pub robot: String,
    /// The world in words.
    pub world: String,
    /// What is to be said of the mission's heights, where they are not looked at.
    pub heights: Option<String>,
    /// The sentence and its exit code: 0, 1 or 5.
    pub verdict: Verdict,
}

/// Checks a mission. Nothing is written.
///
/// # Errors
/// A robot, world or mission that is none, or a robot whose missions are not checked.
pub fn check(settings: &CheckSettings, watch: &dyn Watch) -> Result<Checked, Problem> {
    let (setup, mission, world, above_home) = world::read(settings, watch)?;
    let of = setup.with_simd(settings.simd);
    check_over(&of, mission, world, &above_home)
}

/// Checks `mission` in the world of `setup`, in words `world`.
///
/// # Errors
/// A robot whose missions are not checked.
pub(crate) fn check_in(setup: &Setup, mission: Mission, world: String) -> Result<Checked, Problem> {
    check_over(setup, mission, world, &[])
}

/// The same where no ground is known but that under the mission's home, which its waypoints are so much above (m).
fn check_over(setup: &Setup, mission: Mission, world: String, above_home: &[f64]) -> Result<Checked, Problem> {
    let stops: Vec<usize> = mission.stops.iter().map(|stop| stop.waypoint).collect();
    let Mission { waypoints, speeds, .. } = &mission;
    let asked = Demands { waypoints, speeds, stops: &stops, hold: mission.hold() };
    let mut passage = passes(setup, &asked).map_err(|why| Problem::of_file(&mission.path, why))?;
    fences::hold(&mission, &mut passage);
    ground::hold(above_home, &mut passage);
    let (feasible, broken) = answer(&mission, &passage);
    let heights = heights(&mission, &passage);
    let verdict = verdict(setup, &mission, &passage, (feasible, broken.as_ref(), heights.as_deref()));
    Ok(Checked { mission, passage, feasible, broken, robot: setup.robot_name().to_owned(), world, heights, verdict })
}

/// Whether it is feasible, and the limit that decides: what is proven to break goes first, unless it comes after what
/// is not followed.
fn answer(mission: &Mission, passage: &Passage) -> (Option<bool>, Option<Broken>) {
    let certain = mission.uncertain.iter().map(|one| one.waypoint).min().unwrap_or(usize::MAX);
    if let Some(broken) = passage.proven().filter(|broken| broken.waypoint <= certain) {
        return (Some(false), Some(broken.clone()));
    }
    let broken = passage.first().cloned();
    match broken {
        None if mission.uncertain.is_empty() => (Some(true), None),
        broken => (None, broken),
    }
}

/// A leg that is held at a speed comes to so many times it within its time without a word.
const FASTER: f64 = 1.05;

fn verdict(
    setup: &Setup,
    mission: &Mission,
    passage: &Passage,
    (feasible, broken, heights): (Option<bool>, Option<&Broken>, Option<&str>),
) -> Verdict {
    let robot = match setup.caveat() {
        "" => setup.robot_name().to_owned(),
        _ => format!("{} stand-in", setup.robot_name()),
    };
    let file = mission.path.display();
    let count = mission.waypoints.len();
    let at = |broken: &Broken| {
        let leg = broken.leg.map_or(String::new(), |leg| format!(", leg {leg}→{}", leg + 1));
        format!("{}{leg}: {}: {}", mission.told(broken.waypoint), broken.limit, broken.words)
    };
    match (feasible, broken) {
        (Some(true), _) => {
            let length: f64 = passage.legs.iter().map(|leg| leg.length).sum();
            let time = passage.witness.as_ref().map(|witness| witness.leg_times.iter().sum::<f64>());
            let time = time.map_or(", leg by leg".into(), |time| format!(" in {time:.1} s")) + &waits(mission);
            let demanded = demanded(mission, passage);
            let heights = heights.map_or(String::new(), |words| format!("; {words}"));
            Verdict::of(
                &format!(
                    "FEASIBLE {file} (witnessed, {robot}): {count} waypoints, {length:.1} m{time}{demanded}{heights}"
                ),
                0,
            )
        }
        (Some(false), Some(broken)) => Verdict::of(&format!("INFEASIBLE {file} (proven, {robot}): {}", at(broken)), 1),
        (_, broken) => {
            let uncertain = mission.uncertain.first().map(|one| one.words.clone());
            let why = broken.map(at).into_iter().chain(uncertain).collect::<Vec<_>>().join("; ");
            Verdict::of(&format!("INCONCLUSIVE {file} (not found out, {robot}): {why}"), 5)
        }
    }
}

/// How the witness keeps the speeds that are demanded: a leg takes the time of its speed, and what it comes to within
/// it is told where that is another.
fn demanded(mission: &Mission, passage: &Passage) -> String {
    if mission.speeds.iter().all(Option::is_none) {
        return String::new();
    }
    let beyond = passage.legs.iter().enumerate().filter_map(|(leg, seen)| {
        let (top, demanded) = (seen.top_speed?, mission.speeds.get(leg).copied().flatten()?);
        (top > FASTER * demanded).then_some((leg, top, demanded))
    });
    match beyond.max_by(|a, b| (a.1 / a.2).total_cmp(&(b.1 / b.2))) {
        None => ", at the speeds that it demands".into(),
        Some((leg, top, demanded)) => format!(
            ", in the times of the speeds that it demands, at up to {top:.2} m/s where {demanded:.2} are (leg {leg}→{})",
            leg + 1
        ),
    }
}

/// How long it waits beside what its flight takes.
fn waits(mission: &Mission) -> String {
    match mission.hold() {
        0.0 => String::new(),
        hold if hold.is_finite() => format!(" beside {hold} s of waits"),
        _ => " beside waits without an end".into(),
    }
}

/// What is to be said of heights that the way has not: of what drives they are the ground's, which in the open is level
/// wherever the mission begins, and of what sails the water's.
fn heights(mission: &Mission, passage: &Passage) -> Option<String> {
    let asked = mission.waypoints.iter().map(|place| place.z);
    let (whose, off): (_, Vec<f64>) = match &passage.witness {
        _ if passage.afloat => ("water", asked.collect()),
        Some(witness) => ("ground", asked.zip(&witness.waypoints).map(|(z, there)| z - there.z).collect()),
        None => return None,
    };
    let (least, most) = off.iter().fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), off| (off.min(a), off.max(b)));
    (most - least > HEIGHT).then(|| {
        format!(
            "heights are the {whose}'s: those of the mission, which leave it by {:.2} m, are not looked at",
            most - least
        )
    })
}

/// Heights that differ by this are not the same, m.
const HEIGHT: f64 = 0.1;

/// How the mission's places became metres, in words.
pub fn frame_in_words(mission: &Mission) -> String {
    match mission.frame {
        Frame::World => "metres of the world".into(),
        Frame::Placed => "placed by where on Earth the world stands".into(),
        Frame::Home(home) => format!(
            "east, north, up about the mission's own home ({:.7}°, {:.7}°, {:.2} m), as the world is nowhere on Earth",
            home.lat_deg, home.lon_deg, home.alt_amsl_m
        ),
    }
}

/// `proven` or `not found`: how sure it is that a limit breaks.
pub fn certainty_word(certainty: Certainty) -> &'static str {
    match certainty {
        Certainty::Proven => "proven",
        Certainty::NotFound => "not found",
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Unwatched;

    fn checked(text: &str, robot: &str, world: Option<&str>) -> Checked {
        let place = tempfile::tempdir().unwrap();
        let mission = place.path().join("mine.csv");
        std::fs::write(&mission, text).unwrap();
        let (robot, world) = (robot.to_owned(), world.map(str::to_owned));
        check(&CheckSettings { mission, robot, world, ..CheckSettings::default() }, &Unwatched).unwrap()
    }

    const SQUARE: &str = "x_m,y_m,z_m\n3,3,3\n9,3,3\n9,9,4\n3,9,3\n";

    #[test]
    fn what_can_be_flown_has_a_witness() {
        let found = checked(SQUARE, "flightgoggles", None);
        assert_eq!((found.feasible, found.verdict.exit_code), (Some(true), 0), "{:?}", found.verdict);
        let witness = found.passage.witness.unwrap();
        assert_eq!((witness.leg_times.len(), witness.waypoints.len()), (3, 4));
        // Nothing is faster alone than its limits let it be.
        assert!(found.passage.legs.iter().all(|leg| leg.fastest.is_some() && leg.nearest.is_some()));
    }

    #[test]
    fn a_waypoint_outside_the_cage_is_told_with_its_excess() {
        let found = checked("x_m,y_m,z_m\n3,3,3\n9,3,3\n9,33.5,4\n", "flightgoggles", Some("cage-30m"));
        let broken = found.broken.unwrap();
        assert_eq!((found.feasible, broken.waypoint, broken.limit), (Some(false), 2, "cage"));
        // 30 m less a margin of 2 m.
        assert!((broken.excess.unwrap() - 5.5).abs() < 1e-9, "{broken:?}");
        assert_eq!(found.verdict.exit_code, 1);
    }

    #[test]
    fn drives_and_boats_are_checked_in_the_open() {
        for robot in ["car", "rocky8", "cybership-ii"] {
            let found = checked("x_m,y_m,z_m\n0,0,0\n6,0,0\n12,2,0\n18,2,0\n", robot, None);
            assert_eq!(found.feasible, Some(true), "{robot}: {:?}", found.verdict);
            assert!(found.passage.witness.is_some(), "{robot}");
        }
        // What drives stands on the ground, whatever height the mission has.
        let high = checked("x_m,y_m,z_m\n0,0,0\n6,0,3\n12,2,3\n", "car", None);
        let words = "heights are the ground's: those of the mission, which leave it by 3.00 m";
        assert!(high.verdict.sentence.contains(words), "{}", high.verdict.sentence);
        let high = checked("x_m,y_m,z_m\n0,0,5\n6,0,5\n12,2,8\n", "cybership-ii", None);
        let words = "heights are the water's: those of the mission, which leave it by 3.00 m, are not looked at";
        assert!(high.verdict.sentence.ends_with(words) && high.heights.as_deref() == Some(words), "{high:?}");
        let level = checked("x_m,y_m,z_m\n0,0,5\n6,0,5\n12,2,5\n", "cybership-ii", None);
        assert!(level.feasible == Some(true) && level.heights.is_none(), "{:?}", level.verdict);
        let arm = CheckSettings { mission: "a.csv".into(), robot: "irb120".into(), ..CheckSettings::default() };
        assert!(check(&arm, &Unwatched).is_err());
    }

    const PLAN: &str = include_str!("../../../hairpin-formats/tests/fixtures/missions/cage.plan");

    /// Of the mission of the fixture, changed.
    fn of_plan(text: &str, robot: &str, sets: &[(&str, &str)]) -> Result<Checked, Problem> {
        let place = tempfile::tempdir().unwrap();
        let mission = place.path().join("mine.plan");
        std::fs::write(&mission, text).unwrap();
        let sets = sets.iter().map(|(key, value)| ((*key).to_owned(), (*value).to_owned())).collect();
        check(&CheckSettings { mission, robot: robot.to_owned(), sets, ..CheckSettings::default() }, &Unwatched)
    }

    #[test]
    fn a_world_needs_no_room_for_the_task_of_the_shipped_scenario() {
        let along = |z: &str| {
            let text = format!("x_m,y_m,z_m\n2,6,2.5\n15,6,2.5\n28,6,{z}\n");
            checked(&text, "flightgoggles", Some("straight-corridor"))
        };
        assert_eq!(along("2.5").feasible, Some(true), "{:?}", along("2.5").verdict);
        let high = along("9");
        assert_eq!((high.feasible, high.broken.unwrap().limit), (Some(false), "cage"));
    }

    /// A mission of the robot's own class without a world: take-off to 10 m, and two waypoints at `altitudes`.
    fn at(altitudes: [&str; 2], robot: &str, world: Option<&str>) -> Checked {
        let place = tempfile::tempdir().unwrap();
        let mission = place.path().join("mine.waypoints");
        let home = "38.0335500\t-78.5079700";
        let [first, second] = altitudes;
        let text = format!(
            "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t{home}\t180\t1\n1\t0\t3\t22\t0\t0\t0\t0\t{home}\t10\t1\n\
             2\t0\t3\t16\t0\t0\t0\t0\t38.0336500\t-78.5079700\t{first}\t1\n\
             3\t0\t3\t16\t0\t0\t0\t0\t38.0336500\t-78.5077700\t{second}\t1\n"
        );
        std::fs::write(&mission, text).unwrap();
        let (robot, world) = (robot.to_owned(), world.map(str::to_owned));
        check(&CheckSettings { mission, robot, world, ..CheckSettings::default() }, &Unwatched).unwrap()
    }

    /// Two legs of 20 m straight on: the first comes to more than its speed within the time of that.
    #[test]
    fn what_a_witness_comes_to_beyond_a_demanded_speed_is_told() {
        let place = tempfile::tempdir().unwrap();
        let mission = place.path().join("line.waypoints");
        let item = |number: u32, command: u32, [first, second]: [u32; 2], lat: &str| {
            format!("{number}\t0\t3\t{command}\t{first}\t{second}\t0\t0\t{lat}\t8\t10\t1\n")
        };
        let text = format!(
            "QGC WPL 110\n0\t1\t0\t16\t0\t0\t0\t0\t47\t8\t500\t1\n{}{}{}{}",
            item(1, 22, [0, 0], "47"),
            item(2, 178, [1, 5], "0"),
            item(3, 16, [0, 0], "47.0001799"),
            item(4, 16, [0, 0], "47.0003598")
        );
        std::fs::write(&mission, text).unwrap();
        let asked = CheckSettings { mission, robot: "anafi".into(), ..CheckSettings::default() };
        let found = check(&asked, &Unwatched).unwrap();
        let top = found.passage.legs[0].top_speed.unwrap();
        let words = format!(
            "in 16.0 s, in the times of the speeds that it demands, at up to {top:.2} m/s where 5.00 are (leg 0→1)"
        );
        assert!(top > 5.5 && found.verdict.sentence.contains(&words), "{top} {}", found.verdict.sentence);
    }

    #[test]
    fn without_a_world_no_flight_below_its_home_is_called_feasible() {
        for robot in ["anafi", "x500"] {
            let low = at(["-5", "10"], robot, None);
            assert_eq!((low.feasible, low.verdict.exit_code), (None, 5), "{:?}", low.verdict);
            let broken = low.broken.unwrap();
            assert_eq!((broken.waypoint, broken.limit, broken.unit), (1, "ground", "m"));
            assert!((broken.excess.unwrap() - 5.0).abs() < 1e-6, "{broken:?}");
            let words = "waypoint 1 (item 2): ground: it lies 5.00 m below its home's ground, and no other is known without --world";
            assert!(low.verdict.sentence.contains(words), "{:?}", low.verdict);
            let on_it = at(["0", "10"], robot, None);
            assert_eq!((on_it.feasible, on_it.broken.unwrap().waypoint), (None, 1), "{:?}", on_it.verdict);
            // Who ends at rest on the ground stands on it, not below.
            assert_eq!(at(["10", "0"], robot, None).feasible, Some(true));
            assert_eq!(at(["10", "-1"], robot, None).feasible, None);
            let high = at(["10", "12"], robot, None);
            assert_eq!(high.feasible, Some(true), "{:?}", high.verdict);
            assert!(high.world.contains("no ground (waypoints alone are held to") && !high.world.contains("level"));
        }
        // Metres of a world have no home, and nobody says that a ground was looked at.
        let table = checked(SQUARE, "flightgoggles", None);
        assert!(
            table.feasible == Some(true) && table.world.contains("no ground (none is looked at)"),
            "{}",
            table.world
        );
        let drive = checked("x_m,y_m,z_m\n0,0,0\n6,0,0\n12,2,0\n", "car", None);
        assert!(drive.world.contains("level ground"), "{}", drive.world);
        let boat = checked("x_m,y_m,z_m\n0,0,5\n6,0,5\n12,2,5\n", "cybership-ii", None);
        assert!(boat.world.contains("open water"), "{}", boat.world);
    }

    #[test]
    fn what_is_estimated_proves_nothing() {
        let place = tempfile::tempdir().unwrap();
        let robot = place.path().join("five.toml");
        let corners = [(0.15, -0.15, -1), (-0.15, 0.15, -1), (0.15, 0.15, 1), (-0.15, -0.15, 1)];
        let rotors = corners.map(|(x, y, spin)| format!("{{ x_m = {x}, y_m = {y}, spin = {spin} }}")).join(", ");
        let text = "kind = \"quadrotor\"\nname = \"five\"\nmass_kg = 1.2\nthrust_to_weight = 2.2\n";
        std::fs::write(&robot, format!("{text}rotors = [{rotors}]\n")).unwrap();
        let fast = PLAN.replace("[1, 3, -1", "[1, 25, -1");
        let of_five = of_plan(&fast, &robot.to_string_lossy(), &[]).unwrap();
        assert_eq!((of_five.feasible, of_five.verdict.exit_code), (None, 5), "{:?}", of_five.verdict);
        assert_eq!(of_five.passage.estimated, ["max_speed_m_s"]);
        assert!(of_five.verdict.sentence.contains("is estimated of five, not given: max_speed_m_s"));
        let given = of_plan(&fast, "flightgoggles", &[]).unwrap();
        assert!(given.feasible == Some(false) && given.passage.estimated.is_empty(), "{:?}", given.verdict);
    }

    #[test]
    fn waits_count_for_the_time_of_a_flight() {
        let held = |hold: &str| {
            let text = PLAN.replace("[0, 1, 0, null, 38.03364", &format!("[{hold}, 1, 0, null, 38.03364"));
            of_plan(&text, "flightgoggles", &[("generate.limits.max_flight_time_s", "12")]).unwrap()
        };
        assert_eq!(held("0").feasible, Some(true), "{:?}", held("0").verdict);
        let open = held("6");
        assert_eq!((open.feasible, open.broken.as_ref().unwrap().limit), (None, "duration"), "{:?}", open.verdict);
        assert!(open.verdict.sentence.contains("waits 6.0 s"), "{:?}", open.verdict);
        // Waits alone are longer.
        assert_eq!(held("13").feasible, Some(false), "{:?}", held("13").verdict);
    }

    #[test]
    fn a_mission_of_another_class_of_vehicles_is_refused() {
        let of = |vehicle: u64, robot: &str| {
            let text = PLAN.replace("\"vehicleType\": 2", &format!("\"vehicleType\": {vehicle}"));
            of_plan(&text, robot, &[]).map(|_| ()).map_err(|problem| problem.to_string())
        };
        for vehicle in [0, 2, 13, 29] {
            assert_eq!(of(vehicle, "flightgoggles"), Ok(()), "{vehicle}");
        }
        for (vehicle, robot) in [(1, "flightgoggles"), (12, "x500"), (10, "x500"), (2, "rocky8"), (11, "rocky8")] {
            let told = of(vehicle, robot).unwrap_err();
            assert!(told.contains(&format!("mission.vehicleType: {vehicle} (")), "{vehicle} {robot}: {told}");
        }
        assert_eq!(of(10, "rocky8"), Ok(()));
    }
}
