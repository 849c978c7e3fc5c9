//! The rigid body under four rotors: numbers, and equations with a rotation matrix for the attitude.
//!
//! ```text
//! u₁ = kf Σ w²,  τ_x = kf Σ y w²,  τ_y = −kf Σ x w²,  τ_z = km Σ spin · w²
//! ```
//!
//! World z up, body x forward, y left, z up. The attitude is a rotation matrix and not a quaternion, which the robot's
//! own equations have.

use nalgebra::{Matrix3, Matrix4, Vector3, Vector4};

/// Where a rotor sits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RotorPlace {
    /// Forward of the centre of mass, m.
    pub x: f64,
    /// Left of the centre of mass, m.
    pub y: f64,
    /// +1: clockwise seen from above, reaction moment about +z.
    pub spin: f64,
}

/// A quadrotor's numbers, SI.
///
/// Numbers of the robot's file again, not the robot: nothing here can call its equations.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Body {
    /// Mass, kg.
    pub mass: f64,
    /// Gravity, m/s².
    pub gravity: f64,
    /// Principal moments of inertia, kg·m².
    pub inertia: [f64; 3],
    /// The rotors.
    pub rotors: [RotorPlace; 4],
    /// kf, N/(rad/s)².
    pub thrust_coefficient: f64,
    /// km, N·m/(rad/s)².
    pub moment_coefficient: f64,
    /// Smallest and largest rotor speed, rad/s.
    pub rotor_speed: (f64, f64),
    /// Drag force −c v, N·s/m.
    pub drag_linear: f64,
    /// Drag force −c |v| v, N·s²/m².
    pub drag_quadratic: f64,
    /// Aerodynamic moment −c |ω| ω, N·m·s².
    pub aerodynamic_moment: f64,
    /// Time constant of the rotors' first-order lag, s: only for [`super::open_loop_with_lag`].
    pub rotor_time_constant: f64,
}

/// Position, velocity, rotation matrix (column by column, world from body), angular velocity in the body frame.
pub(super) type State = [f64; 18];

/// Body z force and moments from squared rotor speeds and back.
#[derive(Debug, Clone, Copy)]
pub(super) struct Mixer {
    wrench_from_squares: Matrix4<f64>,
    squares_from_wrench: Matrix4<f64>,
}

impl Body {
    /// Thrust along body z at (x, y): total force, moments y·f, −x·f, and the reaction spin·km·w². `None` where the
    /// rotors cannot exert every force and moment.
    ///
    /// Each row of the matrix is divided by its largest entry before the determinant is looked at: thrust in N and yaw
    /// moments in N·m differ by orders of magnitude. Rotors whose scaled determinant is below 10⁻⁹, as of four on one
    /// line, count as unable.
    pub(super) fn mixer(&self) -> Option<Mixer> {
        let (kf, km) = (self.thrust_coefficient, self.moment_coefficient);
        let columns = self.rotors.map(|r| Vector4::new(kf, kf * r.y, -kf * r.x, km * r.spin));
        let wrench_from_squares = Matrix4::from_columns(&columns);
        // Rows of very different size: scaled before the inversion decides what is singular.
        let scale = Vector4::from_fn(|row, _| wrench_from_squares.row(row).amax().recip());
        let scaled = Matrix4::from_fn(|row, column| wrench_from_squares[(row, column)] * scale[row]);
        if !scaled.iter().all(|c| c.is_finite()) || scaled.determinant().abs() < 1e-9 {
            return None;
        }
        let inverse = scaled.try_inverse()?;
        let squares_from_wrench = Matrix4::from_fn(|row, column| inverse[(row, column)] * scale[column]);
        Some(Mixer { wrench_from_squares, squares_from_wrench })
    }

    /// Whether mass and inertia are a body's.
    ///
    /// Finite, mass and inertia above 0; that the inertia is one a body can have is the robot's file's to say.
    pub(super) fn is_physical(&self) -> bool {
        let numbers = [self.gravity, self.drag_linear, self.drag_quadratic, self.aerodynamic_moment];
        self.mass > 0.0
            && self.inertia.iter().all(|i| *i > 0.0 && i.is_finite())
            && self.mass.is_finite()
            && numbers.iter().all(|c| c.is_finite())
    }
}

impl Mixer {
    /// Squared rotor speeds that exert `wrench` (force along body z, moments).
    pub(super) fn squares(&self, wrench: &Vector4<f64>) -> [f64; 4] {
        (self.squares_from_wrench * wrench).into()
    }

    /// ẋ of the rigid body under squared rotor speeds:
    /// ṗ = v;  m v̇ = R e₃ u₁ − m g e₃ − (c₁ + c₂|v|) v;  Ṙ = R [ω]×;  I ω̇ = τ − ω × Iω − c_a |ω| ω.
    ///
    /// Squares may be negative (a rotor that pulls): what cannot be flown is told elsewhere, and integrates all the
    /// same.
    pub(super) fn derivative(&self, body: &Body, state: &State, squares: &[f64; 4]) -> State {
        let wrench = self.wrench_from_squares * Vector4::from(*squares);
        let velocity = Vector3::new(state[3], state[4], state[5]);
        let rotation = Matrix3::from_column_slice(&state[6..15]);
        let rates = Vector3::new(state[15], state[16], state[17]);
        let drag = velocity * (body.drag_linear + body.drag_quadratic * velocity.norm());
        let mut acceleration = (rotation.column(2) * wrench[0] - drag) / body.mass;
        acceleration.z -= body.gravity;
        let turning = rotation * rates.cross_matrix();
        let inertia = Vector3::from(body.inertia);
        let moments = wrench.fixed_rows::<3>(1)
            - rates.cross(&inertia.component_mul(&rates))
            - rates * (body.aerodynamic_moment * rates.norm());
        let mut out = [0.0; 18];
        out[..3].copy_from_slice(velocity.as_slice());
        out[3..6].copy_from_slice(acceleration.as_slice());
        out[6..15].copy_from_slice(turning.as_slice());
        out[15..].copy_from_slice(moments.component_div(&inertia).as_slice());
        out
    }
}

/// The state at `position` with `velocity`, level, yaw 0, without rates.
pub(super) fn level(position: [f64; 3], velocity: [f64; 3]) -> State {
    let mut state = [0.0; 18];
    state[..3].copy_from_slice(&position);
    state[3..6].copy_from_slice(&velocity);
    state[6..15].copy_from_slice(Matrix3::<f64>::identity().as_slice());
    state
}

/// Angle between the state's attitude and level with yaw 0, rad.
///
/// ```text
/// atan2(½ |(R₃₂ − R₂₃, R₁₃ − R₃₁, R₂₁ − R₁₂)|, ½ (tr R − 1))
/// ```
///
/// From sine and cosine both, so that small angles keep their digits; from 0 to π. R need not be quite orthonormal
/// after an integration.
pub(super) fn attitude_error(state: &State) -> f64 {
    let r = Matrix3::from_column_slice(&state[6..15]);
    let sine = 0.5 * Vector3::new(r.m32 - r.m23, r.m13 - r.m31, r.m21 - r.m12).norm();
    libm::atan2(sine, 0.5 * (r.trace() - 1.0))
}
