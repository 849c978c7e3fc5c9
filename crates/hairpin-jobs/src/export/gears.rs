//! In which gear the legs of a drive are planned, and what a mission says of it.

use hairpin::trajectory::Track;
use hairpin_formats::qgc::mission::Autopilot;
use nalgebra::Vector3;

/// Slower than this nothing is told of the direction, m/s.
const STANDS: f64 = 0.01;

/// Of each leg whether it is planned backwards; `None` where both occur on it. Empty where the plan has no velocities.
pub(super) fn backwards(planned: &Track, legs: usize) -> Vec<Option<bool>> {
    let mut seen = vec![[false; 2]; legs];
    let columns = ["leg", "vx_m_s", "vy_m_s", "vz_m_s"].map(|name| planned.channel(name));
    let [Some(leg), Some(vx), Some(vy), Some(vz)] = columns else { return Vec::new() };
    for (i, pose) in planned.poses().iter().enumerate() {
        let ahead = Vector3::new(vx[i], vy[i], vz[i]).dot(&(pose.rotation * Vector3::x()));
        if let Some(seen) = seen.get_mut(leg[i] as usize).filter(|_| ahead.abs() > STANDS) {
            seen[usize::from(ahead < 0.0)] = true;
        }
    }
    let one = |[ahead, back]: [bool; 2]| (!(ahead && back)).then_some(back);
    seen.into_iter().map(one).collect()
}

/// What the user has to know of legs that are not driven forwards; `None` where there are none.
pub(super) fn told(backwards: &[Option<bool>], autopilot: Autopilot) -> Option<String> {
    let of = |gear: Option<bool>| -> Vec<String> {
        let legs = backwards.iter().enumerate().filter(|(_, leg)| **leg == gear);
        legs.map(|(leg, _)| format!("{leg}→{}", leg + 1)).collect()
    };
    let (back, both) = (of(Some(true)), of(None));
    let planned = [(&back, "backwards"), (&both, "in both gears")];
    let words: Vec<String> = planned
        .iter()
        .filter(|(legs, _)| !legs.is_empty())
        .map(|(legs, gear)| format!("{} {gear}", legs.join(", ")))
        .collect();
    let says = match autopilot {
        Autopilot::Px4 => "missions of PX4 have no gear: the vehicle turns as its mode has it",
        Autopilot::ArduPilot if both.is_empty() => "DO_SET_REVERSE says so",
        Autopilot::ArduPilot => "DO_SET_REVERSE says so of whole legs; where both occur on one, no mission can",
    };
    (!words.is_empty()).then(|| format!("legs planned {}: {says}", words.join("; ")))
}

#[cfg(test)]
mod tests {
    use hairpin::trajectory::Channel;
    use nalgebra::Isometry3;

    use super::*;

    #[test]
    fn legs_have_the_gear_that_they_are_driven_in() {
        // Heads along x all the time: forwards, backwards, both, and standing.
        let (legs, vx) = ([0.0, 0.0, 1.0, 1.0, 2.0, 2.0, 3.0], [1.0, 0.0, -1.0, -0.5, 1.0, -1.0, 0.001]);
        let channel = |name: &str, values: Vec<f64>| Channel { name: name.into(), values };
        let still = vec![0.0; legs.len()];
        let columns = vec![
            channel("leg", legs.to_vec()),
            channel("vx_m_s", vx.to_vec()),
            channel("vy_m_s", still.clone()),
            channel("vz_m_s", still),
        ];
        let times = (0..legs.len()).map(|i| i as f64).collect();
        let track = Track::new(times, vec![Isometry3::identity(); legs.len()], columns).expect("a track");
        let gears = backwards(&track, 4);
        assert_eq!(gears, [Some(false), Some(true), None, Some(false)]);
        let words = told(&gears[..3], Autopilot::ArduPilot).expect("backwards");
        assert!(words.starts_with("legs planned 1→2 backwards; 2→3 in both gears: DO_SET_REVERSE"), "{words}");
        assert_eq!(told(&gears[..1], Autopilot::Px4), None);
    }
}
