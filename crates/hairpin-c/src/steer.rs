//! A drive between two states: the source's `SolveTrajectory`. Once the handle is there nothing is taken from the heap.

use std::sync::Arc;

use hairpin::campaign::drive::steerable;
use hairpin::feasibility::steering::shooting::{Control, Curvatures};
use hairpin::robot::rover::{Rims, Rover};
use hairpin::world::terrain::{ElevationMap, KeepOuts};

use crate::drive::{Drive, State};
use crate::map::MapHandle;
use crate::memory::{free, given, handle, put, result};
use crate::refusal::{Code, Error, HAIRPIN_INVALID, Refused, enter};
use crate::rover::RoverHandle;
use crate::settings::SteerSettings;

/// A vehicle, what it drives on, and how its drives are looked for. Nothing changes it, so that any number of threads
/// may ask it at once.
pub struct SteerHandle {
    pub(crate) rover: Arc<Rover>,
    pub(crate) map: Option<Arc<ElevationMap>>,
    pub(crate) settings: SteerSettings,
    /// What curvature is a function of.
    pub(crate) control: Control,
    /// The vehicle's own bounds.
    pub(crate) bounds: Curvatures,
    /// With what steering leaves of them at the speed.
    pub(crate) shaping: Curvatures,
    /// Speed, m/s.
    pub(crate) speed: f64,
    /// What drives keep out of that are not told of any place.
    pub(crate) nothing: KeepOuts,
}

/// Makes what hairpin_steer is asked with. Vehicle and map may be given back before it.
///
/// @param rover the vehicle
/// @param map what it drives on; NULL: the plane
/// @param settings how drives are looked for; NULL: hairpin_steer_defaults
/// @param steer what was made, to be given back to hairpin_steer_free
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_steer_new(
    rover: *const RoverHandle,
    map: *const MapHandle,
    settings: *const SteerSettings,
    steer: *mut *mut SteerHandle,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, as the header has it.
    unsafe {
        enter(error, || {
            let (rover, place) = (Arc::clone(&given(rover, "rover")?.rover), result(steer, "steer")?);
            let map = if map.is_null() { None } else { Some(Arc::clone(&given(map, "map")?.map)) };
            let usual = crate::settings::hairpin_steer_defaults();
            let settings = if settings.is_null() { usual } else { *given(settings, "settings")? };
            handle(place, SteerHandle::new(rover, map, settings)?)
        })
    }
}

/// Gives it back. NULL is nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_steer_free(steer: *mut SteerHandle) {
    // SAFETY: it came from hairpin_steer_new and is used no more, as the header has it.
    unsafe { free(steer) }
}

/// Looks for a drive from one state to another. Takes no memory, starts no thread, reads no clock.
///
/// What a drive lacks is an answer, in `drive`; a code other than HAIRPIN_OK is about the question. In the plane what
/// is called solved was integrated again by other equations; on a map it rests on the prediction, and hairpin_confirm
/// does so.
///
/// @param steer what is asked
/// @param start where the vehicle is, on the map or anywhere in the plane
/// @param goal where it is to be, in the same frame
/// @param drive the answer
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_steer(
    steer: *const SteerHandle,
    start: *const State,
    goal: *const State,
    drive: *mut Drive,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, as the header has it.
    unsafe {
        enter(error, || {
            let (steer, start, goal) = (given(steer, "steer")?, given(start, "start")?, given(goal, "goal")?);
            let place = result(drive, "drive")?;
            put(place, steer.answer(&start.planar(), &goal.planar())?)
        })
    }
}

/// Drives what hairpin_steer found again, by an integration of its own in finer steps, and writes what that comes to
/// into `drive`: misses, largest tilt, and the status where it is not what it was said to be. Takes memory.
///
/// @param steer what was asked
/// @param start as it was asked
/// @param goal as it was asked
/// @param drive the answer of hairpin_steer, held to what its replay comes to
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_confirm(
    steer: *const SteerHandle,
    start: *const State,
    goal: *const State,
    drive: *mut Drive,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, and `drive` holds an answer, as the header has it.
    unsafe {
        enter(error, || {
            let (steer, start, goal) = (given(steer, "steer")?, given(start, "start")?, given(goal, "goal")?);
            let found = *given(drive, "drive")?;
            let held = steer.confirm(&start.planar(), &goal.planar(), found)?;
            put(result(drive, "drive")?, held)
        })
    }
}

impl SteerHandle {
    fn new(rover: Arc<Rover>, map: Option<Arc<ElevationMap>>, settings: SteerSettings) -> Result<Self, Refused> {
        settings.check()?;
        let limits = &rover.limits;
        let control = settings.control()?;
        let turning = [("turns", settings.turns != 0), ("control", control == Control::TurnDriveTurn)];
        if let Some((field, _)) = turning.into_iter().find(|(_, asked)| *asked && !limits.turns_in_place) {
            return Err(Refused::new(
                HAIRPIN_INVALID,
                format_args!("`{field}`: `{}` cannot turn in place", rover.name),
            ));
        }
        let speed = if settings.speed_m_s > 0.0 { settings.speed_m_s } else { rover.default_speed };
        // A driven wheel at its limit leaves nothing to turn with.
        let most = rover.rims.map_or(limits.speed, |rims| Rims::MOST_SHARE * rims.speed);
        if speed > most {
            let sentence = format_args!("`speed_m_s` = {speed}: must be at most {most} of `{}`", rover.name);
            return Err(Refused::new(HAIRPIN_INVALID, sentence));
        }
        let limits = if rover.rims.is_some() { rover.limits_at(speed, 0.0) } else { *limits };
        let bounds = Curvatures { most: limits.curvature, most_rate: limits.curvature_rate };
        let shaping = steerable(&bounds, &rover, speed);
        Ok(Self { rover, map, settings, control, bounds, shaping, speed, nothing: KeepOuts::default() })
    }
}
