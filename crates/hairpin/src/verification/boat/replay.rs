//! Sailing a leg under the forces that it demands, step by halved step until the answer stands.

use super::claim::{BoatClaim, BoatHull, BoatLeg};
use super::demand::{damping, demand};
use super::series::Series;
use crate::math::power::square;
use crate::verification::gauss::{Gauss, STAGES};

/// x, y, ψ, and the momenta p_u, p_v, p_r of hull and water.
pub(super) type State = [f64; 6];

/// Everything that sailing needs.
pub(super) struct Sailor<'a> {
    pub(super) hull: &'a BoatHull,
    pub(super) claim: &'a BoatClaim<'a>,
    pub(super) gauss: Gauss,
    /// Largest error of any component of the state (SI), by the change on halving the step.
    pub(super) accuracy: f64,
}

/// A leg as sailed.
pub(super) struct Replay {
    /// State at the leg's end, from that at the beginning of its last stretch.
    pub(super) end: State,
    /// Largest distance between the path sailed and the polynomial, m, and when on the leg.
    pub(super) path: (f64, f64),
    /// Largest errors at the ends of stretches: speed, heading, rate of turn.
    pub(super) off: [f64; 3],
    /// Steps of the finest runs.
    pub(super) steps: usize,
}

/// A leg is sailed in stretches of this length, s, each from the state that the leg claims at its beginning: a hull
/// that does not keep its heading by itself loses all digits in a minute.
const STRETCH: f64 = 8.0;
/// Steps are about this long at first, s.
const FIRST_STEP: f64 = 1.0;
/// How much nearer to the truth the finer of two runs is than the two are to each other. Damping has a bend wherever a
/// speed passes zero.
const GAIN: f64 = 4.0;
/// Steps of a stretch at most, and length of those of a whole trip, s.
const MOST_STEPS: usize = 1 << 13;
const TRIP_STEP: f64 = 0.1;

impl Sailor<'_> {
    /// The state that `leg` has at τ.
    pub(super) fn state(&self, leg: &BoatLeg, tau: f64) -> State {
        let [x, y, psi] = leg.taylor(tau);
        let (sin, cos) = libm::sincos(psi[0]);
        let flow = [x[1] - self.claim.current[0], y[1] - self.claim.current[1]];
        let [u, v, r] = [cos * flow[0] + sin * flow[1], cos * flow[1] - sin * flow[0], psi[1]];
        let [a, b, c, d] = self.hull.mass;
        [x[0], y[0], psi[0], a * u, b * v + c * r, c * v + d * r]
    }

    /// Velocity over ground and rate of turn of a state.
    pub(super) fn velocity(&self, state: &State) -> [f64; 3] {
        let [u, v, r] = self.nu(state);
        let (sin, cos) = libm::sincos(state[2]);
        [cos * u - sin * v + self.claim.current[0], sin * u + cos * v + self.claim.current[1], r]
    }

    /// M⁻¹ p.
    ///
    /// u = p_u/m11, and v, r from the two by two block (m22 m23; m23 m33), whose determinant `is_physical` keeps
    /// above 0.
    fn nu(&self, state: &State) -> [f64; 3] {
        let [a, b, c, d] = self.hull.mass;
        let determinant = b * d - c * c;
        [state[3] / a, (d * state[4] - c * state[5]) / determinant, (b * state[5] - c * state[4]) / determinant]
    }

    /// In the order of [`State`]: m/s, m/s, rad/s, N, N, N·m. Kirchhoff's equations of the room's head with the
    /// water's damping.
    fn derivative(&self, state: &State, [x, y, n]: [f64; 3]) -> State {
        let [u, v, r] = self.nu(state);
        let [over_x, over_y, _] = self.velocity(state);
        let [d_x, d_y, d_n]: [f64; 3] = damping(self.hull, [u, v, r].map(Series::constant)).map(|series| series.0[0]);
        let [p_u, p_v] = [state[3], state[4]];
        [over_x, over_y, r, x + r * p_v - d_x, y - r * p_u - d_y, n - u * p_v + v * p_u - d_n]
    }

    /// X, Y, N that `leg` demands at τ.
    pub(super) fn forces(&self, leg: &BoatLeg, tau: f64) -> [f64; 3] {
        demand(self.hull, self.claim, &leg.taylor(tau)).forces.map(|[value, _]| value)
    }

    /// Sails `leg` stretch by stretch; the last change by halving where that does not settle.
    pub(super) fn replay(&self, leg: &BoatLeg) -> Result<Replay, f64> {
        let stretches = (leg.duration / STRETCH).ceil().clamp(1.0, 1e6) as usize;
        let at = |k: usize| leg.duration * k as f64 / stretches as f64;
        let mut replay = Replay { end: self.state(leg, 0.0), path: (0.0, 0.0), off: [0.0; 3], steps: 0 };
        for k in 0..stretches {
            self.stretch(leg, [at(k), at(k + 1)], &mut replay)?;
        }
        Ok(replay)
    }

    /// Sails one stretch at halved steps until two runs agree, and notes what it is off by.
    fn stretch(&self, leg: &BoatLeg, time: [f64; 2], replay: &mut Replay) -> Result<(), f64> {
        let start = self.state(leg, time[0]);
        let mut steps = ((time[1] - time[0]) / FIRST_STEP).ceil().clamp(2.0, 64.0) as usize;
        let mut coarse = self.sail(leg, time, &start, steps, |_, _| {});
        let mut change = f64::INFINITY;
        while steps <= MOST_STEPS / 2 {
            steps *= 2;
            let mut path = replay.path;
            let fine = self.sail(leg, time, &start, steps, |tau, state| {
                let [x, y, _] = leg.taylor(tau);
                let distance = (square(state[0] - x[0]) + square(state[1] - y[0])).sqrt();
                if distance > path.0 {
                    path = (distance, tau);
                }
            });
            if let (Some(coarse), Some(fine)) = (&coarse, &fine) {
                change = coarse.iter().zip(fine).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                if change <= GAIN * self.accuracy {
                    (replay.end, replay.path) = (*fine, path);
                    replay.steps += steps;
                    let off = self.off(leg, time[1], fine);
                    replay.off = std::array::from_fn(|i| replay.off[i].max(off[i]));
                    return Ok(());
                }
            }
            coarse = fine;
        }
        Err(change)
    }

    /// What `state` is off by from what `leg` claims at τ: speed, heading, rate of turn.
    fn off(&self, leg: &BoatLeg, tau: f64, state: &State) -> [f64; 3] {
        let claimed = self.state(leg, tau);
        let (sailed, wanted) = (self.velocity(state), self.velocity(&claimed));
        let speed = (square(sailed[0] - wanted[0]) + square(sailed[1] - wanted[1])).sqrt();
        [speed, (state[2] - claimed[2]).abs(), (sailed[2] - wanted[2]).abs()]
    }

    /// Sails all of `leg` from `start`, without correction. `None` where that leads nowhere.
    ///
    /// In steps of 0.1 s, not halved: an estimate of what becomes of small errors, which only the hull's own stability
    /// bounds.
    pub(super) fn sail_on(&self, leg: &BoatLeg, start: &State) -> Option<State> {
        let steps = (leg.duration / TRIP_STEP).ceil().clamp(4.0, 1e6) as usize;
        self.sail(leg, [0.0, leg.duration], start, steps, |_, _| {}).filter(|end| end.iter().all(|x| x.is_finite()))
    }

    /// Gauss collocation in equal steps under the forces demanded at its nodes; `None` where a step does not converge.
    fn sail(
        &self,
        leg: &BoatLeg,
        [from, to]: [f64; 2],
        start: &State,
        steps: usize,
        mut observe: impl FnMut(f64, &State),
    ) -> Option<State> {
        let h = (to - from) / steps as f64;
        let (mut state, mut slopes) = (*start, None);
        for step in 0..steps {
            let forces = self.stages(leg, from + step as f64 * h, h);
            state = self.gauss.step(&state, h, &mut slopes, |stage, x: &State| self.derivative(x, forces[stage]))?;
            observe(from + (step + 1) as f64 * h, &state);
        }
        Some(state)
    }

    fn stages(&self, leg: &BoatLeg, from: f64, h: f64) -> [[f64; 3]; STAGES] {
        std::array::from_fn(|stage| self.forces(leg, from + h * self.gauss.nodes[stage]))
    }

    /// Sails `leg` with thrusters that follow what it demands with a first-order lag; `thrust` is their own, carried
    /// from leg to leg.
    pub(super) fn sail_with_lag(&self, leg: &BoatLeg, start: &State, thrust: &mut [f64; 3]) -> Option<State> {
        let lag = self.hull.time_constant;
        let steps = (leg.duration / TRIP_STEP.min(0.5 * lag)).ceil().clamp(4.0, 1e6) as usize;
        let h = leg.duration / steps as f64;
        let mut state: [f64; 9] = std::array::from_fn(|i| if i < 6 { start[i] } else { thrust[i - 6] });
        let mut slopes = None;
        for step in 0..steps {
            let asked = self.stages(leg, step as f64 * h, h);
            state = self.gauss.step(&state, h, &mut slopes, |stage, x: &[f64; 9]| {
                let [px, py, psi, u, v, r, surge, sway, yaw] = *x;
                let moved = self.derivative(&[px, py, psi, u, v, r], [surge, sway, yaw]);
                std::array::from_fn(|i| if i < 6 { moved[i] } else { (asked[stage][i - 6] - x[i]) / lag })
            })?;
        }
        *thrust = [state[6], state[7], state[8]];
        Some(std::array::from_fn(|i| state[i]))
    }
}
