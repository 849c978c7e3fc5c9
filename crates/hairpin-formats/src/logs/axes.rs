//! North, east, down into east, north, up, by the one module that converts them.

use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};

use crate::frames::{EnuFlu, NedFrd};

/// A vector of NED in ENU.
pub(super) fn enu_vector(ned: [f64; 3]) -> Vector3<f64> {
    let pose = Isometry3::from_parts(Vector3::from(ned).into(), UnitQuaternion::identity());
    EnuFlu::from(NedFrd(pose)).0.translation.vector
}

/// A point of NED in ENU.
pub(super) fn enu_point(ned: [f64; 3]) -> Point3<f64> {
    enu_vector(ned).into()
}

/// The attitude of a body of forward, left, up in ENU, of one of forward, right, down in NED.
pub(super) fn enu_attitude(ned: UnitQuaternion<f64>) -> UnitQuaternion<f64> {
    EnuFlu::from(NedFrd(Isometry3::from_parts(Vector3::zeros().into(), ned))).0.rotation
}
