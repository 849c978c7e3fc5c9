//! How fast a mission for hardware goes: what its plan demands, leg by leg.

use hairpin::campaign::Case;
use hairpin::campaign::kind::Room;
use hairpin::trajectory::DriveLeg;

use crate::Problem;
use crate::work::Work;

/// Speed of the way home at most, m/s.
pub(super) const HOMEWARD: f64 = 2.0;

/// The speed of each leg, m/s: that of who executed, where he has one of his own, else the plan's largest on it.
///
/// Of a witnessed drive that of its commands; else the largest of the planned motion, over ground of what does not fly,
/// as limits have it, and no more than these.
pub(super) fn of_legs(work: &Work, room: &Room, case: &Case) -> Result<Vec<Option<f64>>, Problem> {
    let legs = case.waypoints.len() - 1;
    if room.speed.is_some() || case.leg_times.is_empty() {
        return Ok(vec![room.speed; legs]);
    }
    if let Some(drive) = case.commands() {
        let of_leg = |leg: &DriveLeg| Some(leg.timing().fastest()).filter(|speed| *speed > 0.0);
        return Ok(drive.legs.iter().map(of_leg).collect());
    }
    let planned = work.folder.read_planned(case.number)?;
    let mut speeds = vec![None; legs];
    let columns = ["leg", "vx_m_s", "vy_m_s", "vz_m_s"].map(|name| planned.channel(name));
    let [Some(leg), Some(vx), Some(vy), Some(vz)] = columns else { return Ok(speeds) };
    for (i, leg) in leg.iter().enumerate() {
        let rise = if room.flies { vz[i] } else { 0.0 };
        let speed = libm::hypot(libm::hypot(vx[i], vy[i]), rise).min(room.fastest);
        if let Some(most) = speeds.get_mut(*leg as usize).filter(|_| speed > 0.0) {
            *most = Some(most.map_or(speed, |known: f64| known.max(speed)));
        }
    }
    Ok(speeds)
}

/// Speeds are told in mm/s, slow ones by three digits down to the 0.01 mm/s that files have; down, so that none is more
/// than what was planned by more than a product's rounding, and none is nothing.
pub(super) fn rounded_down(speed: f64) -> f64 {
    let decimals = (2.0 - libm::log10(speed).floor()).clamp(3.0, 5.0) as u32;
    let steps_in_one = f64::from(10_u32.pow(decimals));
    let nearest = (speed * steps_in_one).round();
    let steps = if nearest / steps_in_one <= speed * (1.0 + 1e-12) { nearest } else { nearest - 1.0 };
    steps.max(1.0) / steps_in_one
}

#[cfg(test)]
mod tests {
    use hairpin_formats::scenario::setup_for;

    use super::rounded_down;

    #[test]
    fn speeds_are_rounded_down_with_digits_for_slow_robots() {
        for (speed, told) in [
            (1.5, 1.5),
            (1.499_999, 1.499),
            (1.5006, 1.5),
            (12.345_6, 12.345),
            (0.29, 0.29),
            (0.3 * 0.06, 0.018),
            (0.06, 0.06),
            (0.059_97, 0.0599),
            (0.006_258, 0.006_25),
            (1e-9, 1e-5),
        ] {
            assert_eq!(rounded_down(speed), told, "{speed}");
        }
    }

    #[test]
    fn speeds_are_the_robots_at_most() {
        let setup = setup_for("quadrotor", &[("execute.controller".into(), "\"px4-mission\"".into())]).unwrap();
        let speed = |most: f64| {
            let drawn = setup.drawn(&[("robot.max_speed_m_s".into(), most.into())]).unwrap();
            drawn.room().unwrap().speed
        };
        assert_eq!((speed(18.0), speed(3.0)), (Some(5.0), Some(3.0)));
    }
}
