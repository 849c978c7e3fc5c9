//! A program with the digits that controllers are told: what is planned, executed and kept is what is written.
//!
//! A time law decides by comparing: with one span more, a limit that is just met, it is another one. Programs that
//! differ by what their text rounds are therefore planned differently, by more than they differ.

use nalgebra::{Isometry3, Translation3, UnitQuaternion, Vector3};

use super::{Motion, PoseTarget, Program, unit_quaternion};

/// Decimals of mm, degrees, kg: a controller keeps about seven digits.
pub const DECIMALS: usize = 6;
/// Decimals of quaternions.
pub const QUATERNION_DECIMALS: usize = 9;

impl Program {
    /// The same with targets and declared frames as a module says them, to the bit: to millionths of a millimetre and
    /// of a degree, quaternions to nine decimals. Speeds and zones are those of controllers and stay.
    pub fn in_digits(mut self) -> Self {
        for one in &mut self.moves {
            match &mut one.motion {
                Motion::AbsoluteJoint(to) => {
                    to.joints = to.joints.map(|q| digits(q.to_degrees(), DECIMALS).to_radians());
                }
                Motion::Joint(to) | Motion::Linear(to) => target(to),
                Motion::Circular { via, to } => [via, to].into_iter().for_each(target),
            }
        }
        for tool in self.tools.iter_mut().filter(|tool| tool.declare) {
            tool.tcp = pose(&tool.tcp);
            tool.mass = digits(tool.mass, DECIMALS);
            tool.centre_of_gravity = millimetres(&tool.centre_of_gravity);
            tool.axes_of_inertia = turn(&tool.axes_of_inertia);
            tool.inertia = tool.inertia.map(|moment| digits(moment, DECIMALS));
        }
        for object in self.work_objects.iter_mut().filter(|object| object.declare) {
            (object.user, object.object) = (pose(&object.user), pose(&object.object));
        }
        self
    }
}

/// What is read where so many decimals are written.
fn digits(value: f64, decimals: usize) -> f64 {
    // Zeros are written without a sign.
    format!("{value:.decimals$}").parse().unwrap_or(value) + 0.0
}

fn millimetres(vector: &Vector3<f64>) -> Vector3<f64> {
    vector.map(|m| digits(m * 1000.0, DECIMALS) / 1000.0)
}

/// What nine decimals cannot be read as stays.
fn turn(q: &UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    unit_quaternion([q.w, q.i, q.j, q.k].map(|component| digits(component, QUATERNION_DECIMALS))).unwrap_or(*q)
}

fn pose(pose: &Isometry3<f64>) -> Isometry3<f64> {
    Isometry3::from_parts(Translation3::from(millimetres(&pose.translation.vector)), turn(&pose.rotation))
}

fn target(to: &mut PoseTarget) {
    to.pose = pose(&to.pose);
}
