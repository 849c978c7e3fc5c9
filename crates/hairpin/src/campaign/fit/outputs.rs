//! What a track says of each output at a moment: by a line through the samples around it.

use std::ops::Range;

use nalgebra::Vector3;

use crate::campaign::kind::Output;
use crate::trajectory::Track;

const VELOCITY: [&str; 3] = ["vx_m_s", "vy_m_s", "vz_m_s"];
const ROTORS: [&str; 4] = ["rotor1_rad_s", "rotor2_rad_s", "rotor3_rad_s", "rotor4_rad_s"];
const JOINTS: [&str; 6] = ["q1_rad", "q2_rad", "q3_rad", "q4_rad", "q5_rad", "q6_rad"];

/// Whether `track` has an output.
pub(super) fn has(track: &Track, output: Output) -> bool {
    let all = |names: &[&str]| names.iter().all(|name| track.channel(name).is_some());
    match output {
        Output::Position(_) => true,
        Output::Velocity(_) => all(&VELOCITY),
        Output::Axis(..) => track.channel(crate::trajectory::ATTITUDE_UNKNOWN).is_none(),
        Output::Thrust => all(&ROTORS),
        Output::Joint(_) => all(&JOINTS),
    }
}

/// The outputs at `t`, each by a line through the samples within half a period of it, or between the two around it
/// where these are few; as at its end where the track is over.
///
/// Times within half a period and four samples at least: a moving least-squares line, which takes out noise that is
/// faster than the period. Positions in m, velocities in m/s, axes as unit vectors' parts, thrust as the mean of the
/// rotors' squared speeds in (rad/s)², joints in rad.
///
/// O(samples in the window · outputs). `t` is cut to the track's time. Axes of a line through unit vectors are a little
/// shorter than 1.
pub(super) fn outputs_at(track: &Track, which: &[Output], t: f64, period: f64) -> Vec<f64> {
    let Window { range, weights } = Window::at(track.times(), t, period);
    let through =
        |value: &dyn Fn(usize) -> f64| range.clone().zip(&weights).map(|(i, weight)| weight * value(i)).sum::<f64>();
    let channel = |name: &str| {
        let values = track.channel(name).unwrap_or_default();
        through(&|i| values[i])
    };
    let output = |output: &Output| match *output {
        Output::Position(axis) => through(&|i| track.position(i)[axis]),
        Output::Velocity(axis) => channel(VELOCITY[axis]),
        Output::Axis(own, axis) => through(&|i| (track.poses()[i].rotation * Vector3::ith(own, 1.0))[axis]),
        Output::Thrust => {
            let speeds = ROTORS.map(|name| track.channel(name).unwrap_or_default());
            through(&|i| 0.25 * speeds.iter().map(|speed| speed[i] * speed[i]).sum::<f64>())
        }
        Output::Joint(axis) => channel(JOINTS[axis]),
    };
    which.iter().map(output).collect()
}

/// Samples, and what each weighs in the least-squares line through them at one time.
///
/// wᵢ = 1/n + (t − t̄)(tᵢ − t̄)/Σ(tⱼ − t̄)².
///
/// Weights add up to 1; at the middle of the samples all are 1/n.
pub(super) struct Window {
    pub(super) range: Range<usize>,
    pub(super) weights: Vec<f64>,
}

impl Window {
    /// At the ends of a track the window is one-sided, and the line leads out to `t`.
    pub(super) fn at(times: &[f64], t: f64, period: f64) -> Self {
        let t = t.clamp(times[0], times[times.len() - 1]);
        let (from, to) = (t - 0.5 * period, t + 0.5 * period);
        let near = times.partition_point(|time| *time < from)..times.partition_point(|time| *time <= to);
        let range = if near.len() >= 4 {
            near
        } else {
            let after = times.partition_point(|time| *time < t).clamp(1, times.len() - 1);
            after - 1..after + 1
        };
        let times = &times[range.clone()];
        let n = times.len() as f64;
        let mean = times.iter().sum::<f64>() / n;
        let spread: f64 = times.iter().map(|time| (time - mean) * (time - mean)).sum();
        let weight = |time: &f64| 1.0 / n + (t - mean) * (time - mean) / spread;
        Self { range, weights: times.iter().map(weight).collect() }
    }
}
