//! The states along a drive: the source's `GetPath`.

use hairpin::campaign::states::{Followed, VehicleState};
use hairpin::trajectory::drive::Segment;

use crate::drive::{Drive, State};
use crate::memory::{Room, given, put, result};
use crate::refusal::{Code, Error, HAIRPIN_INVALID, Refused, enter};
use crate::steer::SteerHandle;

/// One moment of a drive.
#[repr(C)]
#[derive(Clone, Copy)]
pub struct Moment {
    /// Since the drive began, s.
    pub t_s: f64,
    /// Metres driven.
    pub s_m: f64,
    /// Over the ground.
    pub state: State,
    /// Height of the body, m.
    pub z_m: f64,
    /// Roll, rad, to the right positive.
    pub roll_rad: f64,
    /// Pitch, rad, nose down positive.
    pub pitch_rad: f64,
    /// Speed along the path, m/s; negative in reverse, 0 in turns in place.
    pub speed_m_s: f64,
}

/// Moments of a drive that is followed, at most.
pub const HAIRPIN_MOST_MOMENTS: usize = 1_000_000;

/// Follows a drive in steps of time: on the map with suspension, slip and lag, in the plane as it is commanded. Takes
/// memory.
///
/// @param steer what was asked
/// @param start where the drive begins, as it was asked
/// @param drive the drive
/// @param time_step_s time between the moments, s, > 0; a drive has HAIRPIN_MOST_MOMENTS of them at most
/// @param moments where they are written
/// @param room how many there is room for
/// @param count how many there are; with too little room none is written, and this is how many it takes
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_follow(
    steer: *const SteerHandle,
    start: *const State,
    drive: *const Drive,
    time_step_s: f64,
    moments: *mut Moment,
    room: usize,
    count: *mut usize,
    error: *mut Error,
) -> Code {
    // SAFETY: all are NULL or what their types say, with room for as many moments, as the header has it.
    unsafe {
        enter(error, || {
            let (steer, start, drive) = (given(steer, "steer")?, given(start, "start")?, given(drive, "drive")?);
            let mut places = Room::new(moments, room, "moments")?;
            let count = result(count, "count")?;
            let all = follow(steer, start, drive, time_step_s)?;
            put(count, all.len())?;
            places.fill(all.iter().map(moment))
        })
    }
}

fn follow(steer: &SteerHandle, start: &State, drive: &Drive, time_step: f64) -> Result<Vec<VehicleState>, Refused> {
    if !(time_step > 0.0 && time_step.is_finite()) {
        let sentence = format_args!("`time_step_s` = {time_step}: must be finite and > 0");
        return Err(Refused::new(HAIRPIN_INVALID, sentence));
    }
    let (segments, rover) = (drive.list()?, &steer.rover);
    // In place the outermost wheel goes as fast as the vehicle would ahead.
    let arm = rover.suspension.outer_radius();
    let turn_rate = steer.speed / if arm > 0.0 { arm } else { 1.0 };
    let direction = steer.settings.direction();
    let most_steps = HAIRPIN_MOST_MOMENTS;
    let turns: f64 = segments.iter().map(|segment| segment.turn_rad().abs()).sum();
    let length: f64 = segments.iter().map(Segment::length_m).sum();
    let least = (length / steer.speed + turns / turn_rate) / most_steps as f64;
    if time_step < least {
        let sentence = format_args!(
            "`time_step_s` = {time_step:e}: must be at least {least:e} for this drive, which has {most_steps} moments then"
        );
        return Err(Refused::new(HAIRPIN_INVALID, sentence));
    }
    let followed = Followed { rover, speed: steer.speed.into(), turn_rate, direction, time_step, most_steps };
    let start = start.planar();
    let states = match &steer.map {
        Some(map) => followed.on(&**map, &start, &segments),
        None => followed.in_the_plane(&start, &segments),
    };
    Ok(states.map_err(Refused::invalid)?.states)
}

fn moment(state: &VehicleState) -> Moment {
    let VehicleState { time, s, at, settled, speed, .. } = *state;
    Moment {
        t_s: time,
        s_m: s,
        state: State { x_m: at.x, y_m: at.y, yaw_rad: at.yaw, curvature_1_m: at.curvature },
        z_m: settled.z,
        roll_rad: settled.roll,
        pitch_rad: settled.pitch,
        speed_m_s: speed,
    }
}
