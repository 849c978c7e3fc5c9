//! The boat as it sails: the claim's equations with thrusters that lag and end, and a steady force from outside.

use nalgebra::{SVector, Vector2, Vector3};

use super::command::{BoatCommand, turned};
use crate::math::integrate::rk4_step;
use crate::robot::boat::Boat;

/// Longest step of the physics, s: halving it moves no end of a run by a tenth of a millimetre (tests).
const STEP: f64 = 0.02;

/// x, y, ψ, u, v, r through the water, and the time since the command was given.
type State = SVector<f64, 7>;

/// ẋ = R(ψ) ν + c,  M ν̇ = τ + R(ψ)ᵀ F − C(ν) ν − D(ν) ν,  T τ̇ = τ_asked − τ.
///
/// Fixed steps of the classical fourth order; the lag, which may be stiff, is exact.
///
/// ```
/// use hairpin::robot::boat::BoatDescription;
/// use hairpin::simulation::boat::{BoatCommand, BoatPlant};
/// use nalgebra::Vector2;
///
/// let file = serde_json::json!({
///     "kind": "boat", "name": "toy", "mass_kg": 20.0, "yaw_inertia_kg_m2": 2.0, "length_m": 1.2, "beam_m": 0.3,
///     "hydrodynamics": { "x_u_kg_s": -2.0, "y_v_kg_s": -7.0, "n_r_kg_m2_s": -0.5 },
///     "thrust": { "ahead_n": 2.0, "sway_n": 1.0, "yaw_n_m": 1.0 },
/// });
/// let boat = serde_json::from_value::<BoatDescription>(file)?.build()?;
/// // Adrift for a minute, then under way: it is carried north, and pushes itself east.
/// let mut plant = BoatPlant::new(&boat, Vector2::zeros(), 0.0, Vector2::new(0.0, 0.1));
/// plant.advance(&BoatCommand::default(), 60.0);
/// assert!((plant.position() - Vector2::new(0.0, 6.0)).norm() < 1e-9);
/// plant.advance(&BoatCommand { surge: 5.0, ..BoatCommand::default() }, 60.0);
/// assert!(plant.through_water().x > 0.99 && plant.through_water().x < boat.top_speed); // no more than 2 N
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct BoatPlant {
    boat: Boat,
    /// Of the water, m/s, world frame.
    current: Vector2<f64>,
    /// From outside, N, world frame.
    pub push: Vector2<f64>,
    step: f64,
    state: State,
    thrust: Vector3<f64>,
    /// Forces at their limit since this was last asked, of so many.
    at_limit: [u64; 2],
}

impl BoatPlant {
    /// Afloat at `position` with `heading`, carried by `current`: the water does not move past it, thrusters are off.
    pub fn new(boat: &Boat, position: Vector2<f64>, heading: f64, current: Vector2<f64>) -> Self {
        let mut state = State::zeros();
        (state[0], state[1], state[2]) = (position.x, position.y, heading);
        let (boat, push, thrust) = (boat.clone(), Vector2::zeros(), Vector3::zeros());
        Self { boat, current, push, step: STEP, state, thrust, at_limit: [0; 2] }
    }

    /// The same lying still over ground, with the thrust that holds it there.
    pub fn held(mut self) -> Self {
        let nu = turned(&-self.current, -self.state[2]);
        (self.state[3], self.state[4]) = (nu.x, nu.y);
        let nu = self.through_water();
        let against = self.boat.inertia.coriolis(&nu) + self.boat.damping.force(&nu) - self.pushed(self.state[2]);
        self.thrust = self.within(&against);
        self
    }

    /// In steps of `step` s at most.
    #[cfg(feature = "unit-tests")]
    pub(super) fn with_step(self, step: f64) -> Self {
        Self { step, ..self }
    }

    /// Sails on for `time` (s) as `command` asks.
    pub fn advance(&mut self, command: &BoatCommand, time: f64) {
        let asked = Vector3::new(command.surge, command.sway, command.yaw);
        let wanted = self.within(&asked);
        self.at_limit[0] += (0..3).filter(|i| wanted[*i] != asked[*i]).count() as u64;
        self.at_limit[1] += 3;
        let begun = self.thrust;
        let lag = self.boat.thrust_time_constant;
        let thrust = |t: f64| if lag > 0.0 { wanted + (begun - wanted) * libm::exp(-t / lag) } else { wanted };
        let steps = (time / self.step - 1e-9).ceil().max(1.0) as usize;
        let h = time / steps as f64;
        self.state[6] = 0.0;
        for _ in 0..steps {
            self.state = rk4_step(|x| self.derivative(x, &thrust(x[6])), &self.state, h);
        }
        self.thrust = thrust(time);
    }

    fn derivative(&self, x: &State, thrust: &Vector3<f64>) -> State {
        let nu = Vector3::new(x[3], x[4], x[5]);
        let over_ground = turned(&Vector2::new(x[3], x[4]), x[2]) + self.current;
        let acceleration = self.boat.acceleration(&nu, &(thrust + self.pushed(x[2])));
        State::from([over_ground.x, over_ground.y, x[5], acceleration.x, acceleration.y, acceleration.z, 1.0])
    }

    /// The force from outside in the body's frame.
    fn pushed(&self, heading: f64) -> Vector3<f64> {
        if self.push == Vector2::zeros() {
            return Vector3::zeros();
        }
        let force = turned(&self.push, -heading);
        Vector3::new(force.x, force.y, 0.0)
    }

    fn within(&self, asked: &Vector3<f64>) -> Vector3<f64> {
        let bounds = self.boat.thrust.bounds();
        Vector3::from_fn(|i, _| asked[i].clamp(bounds[i][0], bounds[i][1]))
    }

    /// m, world frame.
    pub fn position(&self) -> Vector2<f64> {
        Vector2::new(self.state[0], self.state[1])
    }

    /// ψ, rad, not wrapped.
    pub fn heading(&self) -> f64 {
        self.state[2]
    }

    /// u, v, r through the water.
    pub fn through_water(&self) -> Vector3<f64> {
        Vector3::new(self.state[3], self.state[4], self.state[5])
    }

    /// Velocity over ground, m/s, world frame.
    pub fn over_ground(&self) -> Vector2<f64> {
        turned(&Vector2::new(self.state[3], self.state[4]), self.state[2]) + self.current
    }

    /// X, Y, N that the thrusters give.
    pub fn thrust(&self) -> Vector3<f64> {
        self.thrust
    }

    /// Whether every number is finite.
    pub(super) fn is_finite(&self) -> bool {
        self.state.iter().all(|x| x.is_finite())
    }

    /// Share of the forces asked for since the last time that were beyond their limits.
    pub(super) fn take_saturated(&mut self) -> f64 {
        let [at_limit, of] = std::mem::take(&mut self.at_limit);
        if of > 0 { at_limit as f64 / of as f64 } else { 0.0 }
    }
}
