//! The quadrotor as it flies: the 12-state model with what the claim leaves out, rotor lag, moving air and noise.

use nalgebra::{Isometry3, SVector, Translation3, Vector3, Vector4};

use crate::math::rotation::unit_quaternion;
use crate::robot::quadrotor::Quadrotor;

/// [x y z, qw qx qy qz, vx vy vz, p q r, w1 w2 w3 w4]: position and velocity in the world, `world_from_body`, body
/// rates, rotor speeds; m, m/s, rad/s.
///
/// The first thirteen are a [`crate::robot::quadrotor::QuadrotorState`].
pub type PlantState = SVector<f64, 17>;

/// Index of the position in a [`PlantState`].
pub(super) const POSITION: usize = 0;
/// Index of the quaternion's scalar part.
pub(super) const ATTITUDE: usize = 3;
/// Index of the velocity.
pub(super) const VELOCITY: usize = 7;
/// Index of the body rates.
pub(super) const RATES: usize = 10;
/// Index of the rotor speeds.
pub(super) const ROTORS: usize = 13;

/// m v̇ = Σ kf w² R e₃ − m g e₃ − (c₁ + c₂‖v−a‖)(v−a) + F;  I ω̇ = τ(w²) − ω × Iω − c_ω‖ω‖ω + M;  T ẇ = u − w.
///
/// u are the rotor speeds asked for, w the actual ones, T the lag, a the velocity of the air, F and M the force (world)
/// and moment (body) disturbing it. Without lag w = u and the rotor states stay as they are.
///
/// The claim's equations ([`Quadrotor`]) with three terms more, none of which a planner knows. Commands beyond the
/// rotors' limits are the controller's to avoid; [`Stepper`](super::Stepper) takes them as they are.
///
/// ```
/// use hairpin::robot::quadrotor::QuadrotorDescription;
/// use hairpin::simulation::{Motion, Plant, Stepper};
/// use nalgebra::{Vector3, Vector4};
///
/// let file = serde_json::json!({
///     "kind": "quadrotor", "name": "toy", "mass_kg": 0.5, "thrust_to_weight": 2.0, "rotor_time_constant_s": 0.05,
///     "rotors": [{ "x_m": 0.1, "y_m": 0.1, "spin": 1.0 }, { "x_m": -0.1, "y_m": 0.1, "spin": -1.0 },
///                { "x_m": -0.1, "y_m": -0.1, "spin": 1.0 }, { "x_m": 0.1, "y_m": -0.1, "spin": -1.0 }],
/// });
/// let robot = serde_json::from_value::<QuadrotorDescription>(file)?.build()?;
/// let plant = Plant::new(&robot);
/// // Rotors at rest, hover asked for: after one time constant they turn at 1 − 1/e of it, and the robot has dropped.
/// let hover = Vector4::repeat(robot.hover_speed());
/// let start = Plant::at_rest(&Vector3::new(0.0, 0.0, 5.0), &Vector4::zeros());
/// let (stepper, mut motion) = (Stepper::new(&plant, 0.001), Motion::new(&plant, &start));
/// (0..50).for_each(|_| stepper.advance(&plant, &mut motion, &hover));
/// let end = motion.state();
/// assert!((end[13] / hover[0] - (1.0 - (-1f64).exp())).abs() < 1e-6 && end[2] < 5.0);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Plant {
    pub(super) inverse_mass: f64,
    pub(super) gravity: f64,
    /// Rows: thrust, roll, pitch and yaw moment per w².
    pub(super) allocation: [[f64; 4]; 4],
    pub(super) inverse_inertia: Vector3<f64>,
    /// (Izz − Iyy)/Ixx and its cyclic kin.
    pub(super) gyroscopic: Vector3<f64>,
    pub(super) drag_linear: f64,
    pub(super) drag_quadratic: f64,
    pub(super) aerodynamic_moment: f64,
    pub(super) time_constant: f64,
    /// Velocity of the air, m/s.
    pub air: Vector3<f64>,
    /// Disturbing force, N, world frame.
    pub force: Vector3<f64>,
    /// Disturbing moment, N·m, body frame.
    pub moment: Vector3<f64>,
}

impl Plant {
    /// Names of a [`PlantState`]'s components after the pose, as of columns in files.
    pub const CHANNELS: [&str; 10] = [
        "vx_m_s",
        "vy_m_s",
        "vz_m_s",
        "p_rad_s",
        "q_rad_s",
        "r_rad_s",
        "rotor1_rad_s",
        "rotor2_rad_s",
        "rotor3_rad_s",
        "rotor4_rad_s",
    ];

    /// The plant of a robot in still air, undisturbed.
    pub fn new(robot: &Quadrotor) -> Self {
        let i = robot.inertia;
        Self {
            inverse_mass: 1.0 / robot.mass,
            gravity: robot.gravity,
            allocation: robot.mixing().transpose().into(),
            inverse_inertia: i.map(f64::recip),
            gyroscopic: Vector3::new((i.z - i.y) / i.x, (i.x - i.z) / i.y, (i.y - i.x) / i.z),
            drag_linear: robot.drag_linear,
            drag_quadratic: robot.drag_quadratic,
            aerodynamic_moment: robot.aerodynamic_moment,
            time_constant: robot.rotor_time_constant,
            air: Vector3::zeros(),
            force: Vector3::zeros(),
            moment: Vector3::zeros(),
        }
    }

    /// Level and at rest at `position` (m), the rotors turning at `rotors` (rad/s).
    pub fn at_rest(position: &Vector3<f64>, rotors: &Vector4<f64>) -> PlantState {
        let mut state = PlantState::zeros();
        state.fixed_rows_mut::<3>(POSITION).copy_from(position);
        state[ATTITUDE] = 1.0;
        state.fixed_rows_mut::<4>(ROTORS).copy_from(rotors);
        state
    }

    /// `world_from_body` of a state.
    pub fn pose(state: &PlantState) -> Isometry3<f64> {
        let position: Vector3<f64> = state.fixed_rows::<3>(POSITION).into_owned();
        let q = &state.as_slice()[ATTITUDE..ATTITUDE + 4];
        Isometry3::from_parts(Translation3::from(position), unit_quaternion(q))
    }

    /// Drag force over the velocity through the air, N s/m, at a speed through it.
    ///
    /// c₁ + c₂ |v|.
    pub(super) fn drag_per_speed(&self, speed: f64) -> f64 {
        self.drag_linear + self.drag_quadratic * speed
    }

    /// Angular acceleration under the moment `m` (N·m) at body rates `w`, rad/s².
    ///
    /// I⁻¹ (m − c_ω |ω| ω − ω × Iω), for principal axes.
    pub(super) fn angular(&self, w: &Vector3<f64>, m: &Vector3<f64>) -> Vector3<f64> {
        let m = m - w * (self.aerodynamic_moment * w.norm());
        let coupled = Vector3::new(w.y * w.z, w.x * w.z, w.x * w.y);
        m.component_mul(&self.inverse_inertia) - coupled.component_mul(&self.gyroscopic)
    }
}
