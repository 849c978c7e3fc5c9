//! What the flange carries and what the points are given in.
//!
//! base_from_target = base_from_object · object_from_target, and the flange goes to base_from_target ·
//! (flange_from_tcp)⁻¹. As RAPID's tooldata and wobjdata have them; a stationary tool is not known.

use nalgebra::{Isometry3, Point3, Quaternion, Translation3, UnitQuaternion};

use super::description::{ArmError, place, within, wrong};

/// A tool on the flange.
///
/// Its solid is the capsule of `radius` from the flange's origin to the tool's point.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool {
    /// Name in programs.
    pub name: String,
    /// `flange_from_tcp`.
    pub tcp: Isometry3<f64>,
    /// The tool is taken for all points this near (m) to the line from the flange to its point.
    pub radius: f64,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of mass on the flange, m.
    pub centre_of_mass: Point3<f64>,
}

impl Tool {
    /// No tool: the flange itself, a point without mass.
    pub fn flange() -> Self {
        Self {
            name: "tool0".into(),
            tcp: Isometry3::identity(),
            radius: 0.0,
            mass: 0.0,
            centre_of_mass: Point3::origin(),
        }
    }

    /// A tool from the numbers of a door: mm, kg, quaternion w first.
    ///
    /// # Errors
    /// `tcp_mm`, `q1_q4`, `radius_mm`, `mass_kg`, `cog_mm` out of bounds.
    pub fn new(
        name: &str,
        tcp_mm: [f64; 3],
        q1_q4: [f64; 4],
        radius_mm: f64,
        mass_kg: f64,
        cog_mm: [f64; 3],
    ) -> Result<Self, ArmError> {
        Ok(Self {
            name: name.to_owned(),
            tcp: frame(["tcp_mm", "q1_q4"], tcp_mm, q1_q4)?,
            radius: within("radius_mm", radius_mm, 0.0, 1e4)? * 1e-3,
            mass: within("mass_kg", mass_kg, 0.0, 1e4)?,
            centre_of_mass: (place("cog_mm", &cog_mm)? * 1e-3).into(),
        })
    }
}

/// A work object: base_from_object = user frame · object frame.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkObject {
    /// Name in programs.
    pub name: String,
    /// `base_from_user`.
    pub user: Isometry3<f64>,
    /// `user_from_object`.
    pub object: Isometry3<f64>,
}

impl WorkObject {
    /// The base itself.
    pub fn base() -> Self {
        Self { name: "wobj0".into(), user: Isometry3::identity(), object: Isometry3::identity() }
    }

    /// A work object from the numbers of a door: (mm, quaternion w first) of its user and its object frame.
    ///
    /// # Errors
    /// `uframe_mm`, `uframe_q1_q4`, `oframe_mm`, `oframe_q1_q4` out of bounds.
    pub fn new(name: &str, user: ([f64; 3], [f64; 4]), object: ([f64; 3], [f64; 4])) -> Result<Self, ArmError> {
        Ok(Self {
            name: name.to_owned(),
            user: frame(["uframe_mm", "uframe_q1_q4"], user.0, user.1)?,
            object: frame(["oframe_mm", "oframe_q1_q4"], object.0, object.1)?,
        })
    }

    /// `base_from_object`.
    pub fn base_from_object(&self) -> Isometry3<f64> {
        self.user * self.object
    }
}

/// How far from 1 the length of a quaternion of a door may be.
const UNIT: f64 = 1e-3;

/// The unit quaternion of the numbers (w, x, y, z) of a door.
///
/// Within the tolerance it is normalised: four written decimals are enough, a mistyped component is not.
///
/// # Errors
/// `field` where their length is not 1 within 0.001: rotations are never guessed.
pub fn unit_quaternion_of(field: &str, q1_q4: [f64; 4]) -> Result<UnitQuaternion<f64>, ArmError> {
    let quaternion = Quaternion::new(q1_q4[0], q1_q4[1], q1_q4[2], q1_q4[3]);
    let norm = quaternion.norm();
    if (norm - 1.0).abs() <= UNIT {
        Ok(UnitQuaternion::from_quaternion(quaternion))
    } else {
        Err(wrong(field, format!("{q1_q4:?}"), format!("of length 1 within {UNIT}, not {norm:.6}")))
    }
}

/// mm become m; `at` and `turned` are the keys that errors name.
fn frame([at, turned]: [&str; 2], mm: [f64; 3], q1_q4: [f64; 4]) -> Result<Isometry3<f64>, ArmError> {
    let shift = place(at, &mm)? * 1e-3;
    Ok(Isometry3::from_parts(Translation3::from(shift), unit_quaternion_of(turned, q1_q4)?))
}
