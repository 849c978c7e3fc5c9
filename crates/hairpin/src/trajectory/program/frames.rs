//! What the flange carries and what poses are given in, as programs declare them.
//!
//! base_from_tcp = base_from_user · user_from_object · object_from_tcp for a tool that is held; flange = that ·
//! (flange_from_tcp)⁻¹. A tool that stands in the cell with a held work object is read and written, and told as such;
//! arms here do not execute it.

use nalgebra::{Isometry3, Matrix3, Quaternion, UnitQuaternion, Vector3};

/// A tool.
#[derive(Debug, Clone, PartialEq)]
pub struct Tool {
    /// Its name.
    pub name: String,
    /// Whether the program declares it, or finds it on the controller.
    pub declare: bool,
    /// Whether the arm holds it; else it stands in the cell.
    pub held: bool,
    /// `flange_from_tcp`, m.
    pub tcp: Isometry3<f64>,
    /// Mass, kg.
    pub mass: f64,
    /// Centre of gravity on the flange, m.
    pub centre_of_gravity: Vector3<f64>,
    /// `flange_from_axes` of the moments of inertia.
    pub axes_of_inertia: UnitQuaternion<f64>,
    /// Moments of inertia about the centre of gravity, kg m².
    pub inertia: [f64; 3],
}

/// A work object: base_from_object = base_from_user · user_from_object.
#[derive(Debug, Clone, PartialEq)]
pub struct WorkObject {
    /// Its name.
    pub name: String,
    /// Whether the program declares it, or finds it on the controller.
    pub declare: bool,
    /// Whether the arm holds it.
    pub held: bool,
    /// `None`: the user frame stands still. Else the mechanical unit that moves it, as the controller calls it.
    pub moved_by: Option<String>,
    /// `base_from_user`, m.
    pub user: Isometry3<f64>,
    /// `user_from_object`, m.
    pub object: Isometry3<f64>,
}

impl Tool {
    /// The flange itself, `tool0`.
    pub fn flange() -> Self {
        Self {
            name: "tool0".into(),
            declare: false,
            held: true,
            tcp: Isometry3::identity(),
            mass: 0.001,
            centre_of_gravity: Vector3::new(0.0, 0.0, 0.001),
            axes_of_inertia: UnitQuaternion::identity(),
            inertia: [0.0; 3],
        }
    }

    /// Tensor of inertia about the centre of gravity in the flange's axes, kg m²: R diag(I₁, I₂, I₃) Rᵀ.
    pub fn tensor_of_inertia(&self) -> Matrix3<f64> {
        let turn = self.axes_of_inertia.to_rotation_matrix();
        turn * Matrix3::from_diagonal(&Vector3::from(self.inertia)) * turn.inverse()
    }
}

impl WorkObject {
    /// The base itself, `wobj0`.
    pub fn base() -> Self {
        Self {
            name: "wobj0".into(),
            declare: false,
            held: false,
            moved_by: None,
            user: Isometry3::identity(),
            object: Isometry3::identity(),
        }
    }

    /// `base_from_object`, m.
    pub fn base_from_object(&self) -> Isometry3<f64> {
        self.user * self.object
    }
}

/// How far |q|² may be from 1 for controllers to take q. (ABB, Technical reference manual, RAPID, `NOrient`.)
///
/// Quaternions that were rounded where they were written are scaled; coarser ones are refused.
const NORMALISED: f64 = 1e-5;
/// Below it, in |q|² − 1, the components are kept as they are: they were rounded to nine decimals, and would not read
/// back.
const AS_WRITTEN: f64 = 1e-8;

/// `(w, x, y, z)` as a rotation; what is slightly off is scaled.
///
/// # Errors
/// |q|² where it is not 1 within 0.00001, beyond which controllers do not take it.
pub fn unit_quaternion(wxyz: [f64; 4]) -> Result<UnitQuaternion<f64>, f64> {
    let quaternion = Quaternion::new(wxyz[0], wxyz[1], wxyz[2], wxyz[3]);
    let square = quaternion.norm_squared();
    match (square - 1.0).abs() {
        off if off <= AS_WRITTEN => Ok(UnitQuaternion::new_unchecked(quaternion)),
        off if off <= NORMALISED => Ok(UnitQuaternion::new_normalize(quaternion)),
        _ => Err(square),
    }
}
