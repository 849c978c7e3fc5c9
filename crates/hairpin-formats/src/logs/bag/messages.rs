//! Messages of ROS 2 that tell a motion, by their definitions in `common_interfaces`.

use std::collections::HashSet;

use nalgebra::{Point3, Quaternion, UnitQuaternion, Vector3};

use super::super::accuracy::{both, known};
use super::cdr::{Cdr, NoMessage};
use crate::quote::shortened;

/// No robot is further from where it began, m.
const FARTHEST_M: f64 = 1e7;
/// How far from 1 the length of a quaternion may be.
const QUATERNION: f64 = 1e-2;
/// Bytes of a stamped pose at least: stamp, frame's length, seven numbers.
const POSE: usize = 4 + 4 + 4 + 56;

/// Types that are read.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Pose,
    Odometry,
    Path,
    Joints,
}

impl Kind {
    pub(super) fn of(name: &str) -> Option<Self> {
        Some(match name {
            "geometry_msgs/msg/PoseStamped" => Self::Pose,
            "nav_msgs/msg/Odometry" => Self::Odometry,
            "nav_msgs/msg/Path" => Self::Path,
            "sensor_msgs/msg/JointState" => Self::Joints,
            _ => return None,
        })
    }
}

/// Stamp in ns, and the frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Header<'a> {
    pub(super) stamp_ns: i64,
    pub(super) frame: &'a str,
}

/// A pose with its header; `attitude` where the quaternion is one, and how long that is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Pose<'a> {
    pub(super) header: Header<'a>,
    pub(super) p_m: Point3<f64>,
    pub(super) attitude: Option<UnitQuaternion<f64>>,
    pub(super) quaternion_length: f64,
    pub(super) v_m_s: Option<Vector3<f64>>,
    pub(super) accuracy_m: Option<[f64; 2]>,
    /// Whether it is told across or up alone.
    pub(super) is_half: bool,
}

fn header<'a>(cdr: &mut Cdr<'a>) -> Result<Header<'a>, NoMessage> {
    let (seconds, nanoseconds) = (cdr.i32()?, cdr.u32()?);
    let stamp_ns = i64::from(seconds) * 1_000_000_000 + i64::from(nanoseconds);
    Ok(Header { stamp_ns, frame: cdr.string()? })
}

/// Where, how it is turned if its quaternion is one, and that one's length.
type Place = (Point3<f64>, Option<UnitQuaternion<f64>>, f64);

fn place(cdr: &mut Cdr) -> Result<Place, NoMessage> {
    let p = cdr.numbers::<3>()?;
    let [x, y, z, w] = cdr.numbers()?;
    let q = Quaternion::new(w, x, y, z);
    let length = q.norm();
    if !p.iter().all(|p| p.is_finite() && p.abs() < FARTHEST_M) || !length.is_finite() {
        return Err(NoMessage::NotFinite);
    }
    let is_turn = (length - 1.0).abs() < QUATERNION;
    Ok((p.into(), is_turn.then(|| UnitQuaternion::from_quaternion(q)), length))
}

pub(super) fn pose<'a>(cdr: &mut Cdr<'a>) -> Result<Pose<'a>, NoMessage> {
    let header = header(cdr)?;
    let (p_m, attitude, quaternion_length) = place(cdr)?;
    Ok(Pose { header, p_m, attitude, quaternion_length, v_m_s: None, accuracy_m: None, is_half: false })
}

/// The twist of an odometry is in the child's frame, the body.
pub(super) fn odometry<'a>(cdr: &mut Cdr<'a>) -> Result<Pose<'a>, NoMessage> {
    let header = header(cdr)?;
    cdr.string()?;
    let (p_m, attitude, quaternion_length) = place(cdr)?;
    let covariance = cdr.numbers::<36>()?;
    let linear = Vector3::from(cdr.numbers::<3>()?);
    let v_m_s = attitude.filter(|_| linear.iter().all(|v| v.is_finite())).map(|turn| turn * linear);
    // All zeros is how publishers say that they do not know.
    let variances = [covariance[0].max(covariance[7]), covariance[14]];
    let (accuracy_m, is_half) = both(variances.map(|of| known(of.sqrt())));
    let accuracy_m = accuracy_m.filter(|deviations| *deviations != [0.0; 2]);
    Ok(Pose { header, p_m, attitude, quaternion_length, v_m_s, accuracy_m, is_half })
}

/// The poses of a path, with its own frame where a pose has none.
pub(super) fn path<'a>(cdr: &mut Cdr<'a>) -> Result<Vec<Pose<'a>>, NoMessage> {
    let Header { frame, .. } = header(cdr)?;
    let length = cdr.length(POSE)?;
    let one = |_| {
        let mut one = pose(cdr)?;
        if one.header.frame.is_empty() {
            one.header.frame = frame;
        }
        Ok(one)
    };
    (0..length).map(one).collect()
}

/// Names and positions of joints, with the header's stamp.
pub(super) fn joints<'a>(cdr: &mut Cdr<'a>) -> Result<(i64, Vec<&'a str>, Vec<f64>), NoMessage> {
    let Header { stamp_ns, .. } = header(cdr)?;
    let names = (0..cdr.length(4)?).map(|_| cdr.string()).collect::<Result<Vec<_>, _>>()?;
    let positions = (0..cdr.length(8)?).map(|_| cdr.f64()).collect::<Result<Vec<_>, _>>()?;
    // Of a joint that is named twice nobody knows which position is its own.
    let mut known = HashSet::new();
    if let Some(twice) = names.iter().find(|name| !known.insert(**name)) {
        return Err(NoMessage::Unfit(format!("with the joint {} twice", shortened(twice))));
    }
    if names.len() != positions.len() {
        let count =
            |count: usize, what: &str| if count == 1 { format!("1 {what}") } else { format!("{count} {what}s") };
        return Err(NoMessage::Unfit(match positions.len() {
            0 => "without positions".into(),
            some => format!("with {} for {}", count(some, "position"), count(names.len(), "joint")),
        }));
    }
    if !positions.iter().all(|q| q.is_finite()) {
        return Err(NoMessage::NotFinite);
    }
    Ok((stamp_ns, names, positions))
}
