//! Whether a mission is one of the robot's class of vehicles.

use hairpin::campaign::Setup;
use hairpin_formats::missions::Mission;

use crate::Problem;

/// What `MAV_TYPE`s are called.
const NAMES: [(u64, &str); 6] = [
    (1, " (fixed wing)"),
    (2, " (multirotor)"),
    (10, " (rover or boat)"),
    (11, " (boat)"),
    (12, " (submarine)"),
    (20, " (take-off upright, flight on wings)"),
];

/// Refuses a mission that says that it is another class of vehicle's than the robot of `setup` is of: it would be
/// followed otherwise.
///
/// # Errors
/// The class, with those that it may be.
pub(crate) fn same_vehicle(setup: &Setup, mission: &Mission) -> Result<(), Problem> {
    let Some(vehicle) = mission.whose.vehicle else { return Ok(()) };
    let Some(room) = setup.room() else { return Ok(()) };
    let fitting = room.vehicles;
    if fitting.contains(&vehicle) {
        return Ok(());
    }
    let name = NAMES.iter().find(|(number, _)| *number == vehicle).map_or("", |(_, name)| name);
    let must = fitting.iter().map(u64::to_string).collect::<Vec<_>>().join(", ");
    let robot = setup.robot_name();
    Err(Problem::of_file(
        &mission.path,
        format!("mission.vehicleType: {vehicle}{name}, must be one of {must} (or left out) for {robot}"),
    ))
}
