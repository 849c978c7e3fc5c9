//! Sampled motions of an arm's joints as JSON of ROS 2's `trajectory_msgs/JointTrajectory`.

use serde_json::json;
use thiserror::Error;

/// Why samples are no trajectory.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum JointTrajectoryError {
    /// Fewer names, more samples, and the like.
    #[error("{field}: {found}, must be {expected}")]
    Length {
        /// What has the wrong length.
        field: &'static str,
        /// How many there are.
        found: usize,
        /// How many there must be.
        expected: usize,
    },
    /// A number that is none.
    #[error("sample {index}: joint `{joint}` at {value} rad: must be finite")]
    NotFinite {
        /// Which sample.
        index: usize,
        /// Name of the joint.
        joint: String,
        /// The value.
        value: f64,
    },
    /// Times that do not rise by a nanosecond at least, or are no times.
    #[error("sample {index}: time {value} s: must rise strictly, in whole nanoseconds, from 0 or later")]
    Time {
        /// Which sample.
        index: usize,
        /// The value.
        value: f64,
    },
}

/// Longest time that fits the message's seconds.
const LONGEST: f64 = 2_147_483_647.0;

/// The message as JSON: `joint_names`, and points with `positions` (rad) and `time_from_start`. `times` in s; `samples`
/// holds as many rows of as many angles as there are names; `frame` is the base's `frame_id`.
///
/// # Errors
/// [`JointTrajectoryError`].
pub fn text<const N: usize>(
    frame: &str,
    names: &[String; N],
    times: &[f64],
    samples: &[[f64; N]],
) -> Result<String, JointTrajectoryError> {
    if times.len() != samples.len() {
        return Err(JointTrajectoryError::Length { field: "times", found: times.len(), expected: samples.len() });
    }
    if samples.is_empty() {
        return Err(JointTrajectoryError::Length { field: "samples", found: 0, expected: 1 });
    }
    let mut points = Vec::with_capacity(samples.len());
    let mut before = None;
    for (index, (time, positions)) in times.iter().zip(samples).enumerate() {
        if let Some((joint, value)) = names.iter().zip(positions).find(|(_, value)| !value.is_finite()) {
            return Err(JointTrajectoryError::NotFinite { index, joint: joint.clone(), value: *value });
        }
        let nanoseconds = if (0.0..LONGEST).contains(time) { Some((time * 1e9).round() as i64) } else { None };
        let nanoseconds = nanoseconds.filter(|now| before.is_none_or(|before| before < *now));
        let nanoseconds = nanoseconds.ok_or(JointTrajectoryError::Time { index, value: *time })?;
        before = Some(nanoseconds);
        points.push(json!({
            "positions": positions.as_slice(),
            "velocities": [],
            "accelerations": [],
            "effort": [],
            "time_from_start": { "sec": nanoseconds / 1_000_000_000, "nanosec": nanoseconds % 1_000_000_000 },
        }));
    }
    // No comment: strict readers refuse fields that the message has not.
    let message = json!({
        "header": { "stamp": { "sec": 0, "nanosec": 0 }, "frame_id": frame },
        "joint_names": names.as_slice(),
        "points": points,
    });
    Ok(format!("{message:#}\n"))
}

#[cfg(test)]
mod tests {
    use serde_json::Value;

    use super::*;

    fn names() -> [String; 2] {
        ["joint_1".into(), "joint_2".into()]
    }

    #[test]
    fn a_message_has_names_angles_and_rising_times() {
        let text =
            text("base_link", &names(), &[0.0, 0.5, 2.000_000_001], &[[0.0, 1.0], [0.1, -1.0], [0.2, 3.5]]).unwrap();
        let message: Value = serde_json::from_str(&text).unwrap();
        assert_eq!(message["joint_names"], json!(["joint_1", "joint_2"]));
        assert_eq!(message["header"]["frame_id"], "base_link");
        assert_eq!(message["points"][1]["positions"], json!([0.1, -1.0]));
        assert_eq!(message["points"][1]["time_from_start"], json!({ "sec": 0, "nanosec": 500_000_000 }));
        assert_eq!(message["points"][2]["time_from_start"], json!({ "sec": 2, "nanosec": 1 }));
    }

    #[test]
    fn samples_that_are_no_trajectory_are_refused() {
        let good = [[0.0, 1.0], [0.1, 2.0]];
        for times in [[0.5, 0.5], [0.5, 0.500_000_000_1], [-1.0, 0.0], [f64::NAN, 1.0], [0.0, 1e10]] {
            assert!(matches!(text("b", &names(), &times, &good), Err(JointTrajectoryError::Time { .. })), "{times:?}");
        }
        let wrong = text("b", &names(), &[0.0], &[[0.0, f64::INFINITY]]);
        assert_eq!(
            wrong,
            Err(JointTrajectoryError::NotFinite { index: 0, joint: "joint_2".into(), value: f64::INFINITY })
        );
        assert!(matches!(text("b", &names(), &[0.0], &good), Err(JointTrajectoryError::Length { field: "times", .. })));
        assert!(matches!(
            text::<2>("b", &names(), &[], &[]),
            Err(JointTrajectoryError::Length { field: "samples", .. })
        ));
    }
}
