//! The world that a mission is checked in: the one that was named, the scenario's, or none at all.

use std::path::Path;

use hairpin::campaign::{Mistake, Setup};
use hairpin_formats::missions::{self, Mission};
use hairpin_formats::scenario::{is_map, is_scenario, means_scenario, setup_for, setup_for_missions, shadowed};
use nalgebra::{Point3, Vector3};
use serde_json::json;

use super::ground::above_home;
use super::settings::CheckSettings;
use super::vehicle::same_vehicle;
use crate::sets::Set;
use crate::{Problem, Watch};

/// Room around a mission in the open, m.
const ROOM_M: f64 = 30.0;
/// A shipped robot: what a mission says does not depend on which.
const ANYBODY: &str = "flightgoggles";
/// The robot in its world, the mission there, the world in words, and, of a flight in none, altitudes of the mission's
/// waypoints above its home, m.
type Read = (Setup, Mission, String, Vec<f64>);

/// What `settings` name.
pub(super) fn read(settings: &CheckSettings, watch: &dyn Watch) -> Result<Read, Problem> {
    let CheckSettings { mission, robot, world, sets, .. } = settings;
    shadowed(robot).iter().for_each(|note| watch.warn(note));
    let (setup, name) = match world {
        Some(world) if is_scenario(world) => {
            if means_scenario(robot) {
                return Err(Problem::input(format!(
                    "--robot {robot} and --world {world} are both scenarios: give a robot's name or file, or one scenario as --robot"
                )));
            }
            let all: Vec<Set> =
                std::iter::once(("robot".to_owned(), quoted(robot))).chain(sets.iter().cloned()).collect();
            (setup_for_missions(world, &all)?, world.clone())
        }
        Some(world) => {
            let value = match is_map(world) {
                true => format!("{{ terrain = {{ file = {} }} }}", quoted(world)),
                false => format!("{{ base = {} }}", quoted(world)),
            };
            let all: Vec<Set> = std::iter::once(("world".to_owned(), value)).chain(sets.iter().cloned()).collect();
            (setup_for_missions(robot, &all)?, world.clone())
        }
        None => (setup_for_missions(robot, sets)?, robot.clone()),
    };
    let given = world.is_some() || means_scenario(robot) || sets.iter().any(|(key, _)| key.trim().starts_with("world"));
    if given {
        let read = missions::read(mission, &setup.scenario, setup.handed().farthest).map_err(Problem::input)?;
        same_vehicle(&setup, &read)?;
        return Ok((setup, read, format!("world of {name}"), Vec::new()));
    }
    in_the_open((&setup, sets), mission)
}

/// The mission in `file` by itself, for whoever asks what it is: of no robot, and nothing is around it.
///
/// # Errors
/// As of [`missions::read`].
pub(crate) fn read_anywhere(file: &Path) -> Result<Mission, Problem> {
    let anybody = setup_for(ANYBODY, &[])?;
    let (somewhere, _) = open_around(&anybody, &[Point3::origin()]).map_err(|why| not_open(&anybody, file, why))?;
    missions::read(file, &somewhere.scenario, somewhere.handed().farthest).map_err(Problem::input)
}

/// The mission in `file` for the robot of `setup`, wherever it is: places on Earth are about the mission's own home. A
/// table in degrees has none, and is placed by the scenario's world.
///
/// # Errors
/// As of [`missions::read`].
pub(crate) fn read_about_home(setup: &Setup, file: &Path) -> Result<Mission, Problem> {
    let (somewhere, _) = open_around(setup, &[Point3::origin()]).map_err(|why| not_open(setup, file, why))?;
    let read = |there: &Setup| missions::read(file, &there.scenario, there.handed().farthest);
    read(&somewhere).or_else(|_| read(setup)).map_err(Problem::input)
}

/// Why `mission` cannot be read for the robot of `setup` in the open.
fn not_open(setup: &Setup, mission: &Path, mistake: Option<Mistake>) -> Problem {
    match mistake {
        Some(mistake) => Problem::of_file(mission, mistake),
        None => Problem::input(format!("missions of {} are not checked", setup.robot_name())),
    }
}

/// A robot alone: nothing is around it, and where the mission begins does not matter.
fn in_the_open((setup, sets): (&Setup, &[Set]), mission: &Path) -> Result<Read, Problem> {
    let setup = &with_its_own_limits(setup, sets)?;
    let refuse = |mistake| not_open(setup, mission, mistake);
    let (somewhere, _) = open_around(setup, &[Point3::origin()]).map_err(refuse)?;
    let mut read = missions::read(mission, &somewhere.scenario, somewhere.handed().farthest).map_err(Problem::input)?;
    same_vehicle(setup, &read)?;
    let flies = setup.room().is_some_and(|room| room.flies);
    let above_home = if flies { above_home(&read, &read.waypoints)? } else { Vec::new() };
    let (there, shift) = open_around(setup, &read.waypoints).map_err(refuse)?;
    for point in &mut read.waypoints {
        *point += shift;
    }
    for fence in &mut read.fences {
        fence.outline.shift(&shift.xy());
    }
    let ground = match (flies, setup.footing()) {
        (true, _) if above_home.is_empty() => "no ground (none is looked at)",
        (true, _) => "no ground (waypoints alone are held to the height of its home)",
        (false, Some(_)) => "level ground",
        (false, None) => "open water",
    };
    Ok((there, read, format!("no world given: no walls, no obstacles, {ground}, the robot's own limits"), above_home))
}

/// The robot of `setup` in an open world with room around `places`, and how far they lie from where they are in it.
///
/// # Errors
/// A size that no world has; nothing, where such a robot has no open world.
pub(crate) fn open_around(setup: &Setup, places: &[Point3<f64>]) -> Result<(Setup, Vector3<f64>), Option<Mistake>> {
    let (mut low, mut high) = (Vector3::repeat(f64::INFINITY), Vector3::repeat(f64::NEG_INFINITY));
    for place in places {
        (low, high) = (low.inf(&place.coords), high.sup(&place.coords));
    }
    let open = setup.in_the_open(&(high - low + Vector3::repeat(2.0 * ROOM_M))).map_err(Some)?.ok_or(None)?;
    Ok((open, Vector3::repeat(ROOM_M) - low))
}

/// The limits of the example that a robot is put into are none of its own; what was set stays.
fn with_its_own_limits(setup: &Setup, sets: &[Set]) -> Result<Setup, Problem> {
    if setup.has_programs() || sets.iter().any(|(key, _)| key.trim().starts_with("generate")) {
        return Ok(setup.clone());
    }
    Ok(setup.drawn(&[("generate.limits".into(), json!({}))])?)
}

/// A text as TOML has it; of a file where it lies, wherever the scenario does.
fn quoted(name: &str) -> String {
    let path = Path::new(name);
    let file = if path.is_file() { std::path::absolute(path).ok() } else { None };
    let name = file.map_or_else(|| name.to_owned(), |file| file.to_string_lossy().into_owned());
    serde_json::Value::from(name).to_string()
}
