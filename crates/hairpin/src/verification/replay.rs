//! Flying a leg under the rotor speeds that it demands, step by halved step until the answer stands.
//!
//! ```text
//! leg (coefficients) ─ demand(τ) ─▶ squared rotor speeds at Gauss nodes ─▶ 18 states integrated ─▶ end, path
//! steps halved until |coarse − fine| ≤ 64 accuracy in every component
//! ```

use super::body::{Body, Mixer, State};
use super::claim::Leg;
use super::demand::{Singular, demand};
use super::gauss::{Gauss, STAGES};
use crate::math::power::square;

/// Everything that flying needs.
pub(super) struct Flyer<'a> {
    /// Numbers of the robot.
    pub(super) body: &'a Body,
    /// Rotor speeds to forces and back.
    pub(super) mixer: Mixer,
    /// The integrator.
    pub(super) gauss: Gauss,
    /// Largest error of any component of the state (SI), by the change on halving the step.
    pub(super) accuracy: f64,
}

/// A leg as flown.
///
/// `end` is what the leg is held to; `chained` tells how errors add up over the flight.
pub(super) struct Replay {
    /// From the leg's own start.
    pub(super) end: State,
    /// From where the flight so far had come.
    pub(super) chained: State,
    /// Largest distance between the path flown and the polynomial, m, and when on the leg.
    pub(super) path: (f64, f64),
    /// Steps of the finest run.
    pub(super) steps: usize,
}

/// Why a leg could not be flown.
///
/// Both make a finding, never a pass.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Trouble {
    /// The demand is undefined at this time of the leg.
    Singular(f64, Singular),
    /// So many steps were not enough; the last change by halving.
    Steps(usize, f64),
}

/// Steps are about this long at first, s.
const FIRST_STEP: f64 = 0.2;
/// How much nearer to the truth the finer of two runs is than the two are to each other: 4096 for a smooth motion; drag
/// and aerodynamic moment have a bend where speed or rates vanish, so less is assumed.
///
/// Accepted is a change of 64 times the accuracy asked for: with order 12 a halving brings the error down by 2¹².
const GAIN: f64 = 64.0;
/// Steps per leg at most.
/// From 0.2 s on a leg of 800 s still has one halving.
const MOST_STEPS: usize = 8192;
/// Places of a leg between which its speed is taken to have one minimum at most.
const PLACES: usize = 64;
/// Slower than this share of the fastest place is a standstill.
const STANDSTILL: f64 = 1e-3;

impl Flyer<'_> {
    /// Flies `leg` from `start` and from `chained`.
    ///
    /// Begins with steps of 0.2 s or so and halves until two runs differ by at most [`GAIN`] · accuracy; the finer
    /// run's error is then below the accuracy. Steps end at standstills, so that none straddles the turn of the drag.
    pub(super) fn replay(&self, leg: &Leg, start: &State, chained: &State) -> Result<Replay, Trouble> {
        let mut steps = (leg.duration / FIRST_STEP).ceil().clamp(2.0, MOST_STEPS as f64) as usize;
        let standstills = standstills(leg);
        let times = times(leg, steps, &standstills);
        let mut coarse = self.fly(start, &times, &self.commands(leg, &times)?, |_, _| {});
        let mut change = f64::INFINITY;
        while steps <= MOST_STEPS / 2 {
            steps *= 2;
            let times = self::times(leg, steps, &standstills);
            let commands = self.commands(leg, &times)?;
            let mut path = (0.0, 0.0);
            let observe = |tau: f64, state: &State| {
                let claimed = leg.taylor(tau);
                let distance = (0..3).map(|axis| square(state[axis] - claimed[axis][0])).sum::<f64>().sqrt();
                if distance > path.0 {
                    path = (distance, tau);
                }
            };
            let fine = self.fly(start, &times, &commands, observe);
            if let (Some(coarse), Some(fine)) = (&coarse, &fine) {
                change = coarse.iter().zip(fine).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                if change <= GAIN * self.accuracy {
                    let chained = self.fly(chained, &times, &commands, |_, _| {});
                    let chained = chained.ok_or(Trouble::Steps(steps, change))?;
                    return Ok(Replay { end: *fine, chained, path, steps });
                }
            }
            coarse = fine;
        }
        Err(Trouble::Steps(steps, change))
    }

    /// Squared rotor speeds at every stage of the steps between `times`.
    ///
    /// Once for each grid of steps; both starts fly under the same.
    fn commands(&self, leg: &Leg, times: &[f64]) -> Result<Vec<[[f64; 4]; STAGES]>, Trouble> {
        let of_step = |step: &[f64]| {
            let mut stages = [[0.0; 4]; STAGES];
            for (squares, node) in stages.iter_mut().zip(&self.gauss.nodes) {
                *squares = self.squares(leg, step[0] + node * (step[1] - step[0]))?;
            }
            Ok(stages)
        };
        times.windows(2).map(of_step).collect()
    }

    /// `commands` are squared rotor speeds at the stages of each step; `observe` is shown each step's end. `None` where
    /// a step does not converge.
    fn fly(
        &self,
        start: &State,
        times: &[f64],
        commands: &[[[f64; 4]; STAGES]],
        mut observe: impl FnMut(f64, &State),
    ) -> Option<State> {
        let (mut state, mut slopes) = (*start, None);
        for (step, stages) in times.windows(2).zip(commands) {
            let derivative = |stage: usize, x: &State| self.mixer.derivative(self.body, x, &stages[stage]);
            state = self.gauss.step(&state, step[1] - step[0], &mut slopes, derivative)?;
            observe(step[1], &state);
        }
        Some(state)
    }

    /// Flies `leg` with rotors that follow what it demands with a first-order lag: ẇ = (demand − w)/τ_m. `speeds` are
    /// the rotors' own, carried from leg to leg.
    ///
    /// Steps of at most half the time constant, and not halved further: an estimate, no proof.
    pub(super) fn replay_with_lag(&self, leg: &Leg, start: &State, speeds: &mut [f64; 4]) -> Result<State, Trouble> {
        let lag = self.body.rotor_time_constant;
        let steps = (leg.duration / (0.5 * lag)).ceil().clamp(2.0, MOST_STEPS as f64) as usize;
        let times = times(leg, steps, &standstills(leg));
        let commands = self.commands(leg, &times)?;
        let (mut state, mut slopes) = ([0.0; 22], None);
        state[..18].copy_from_slice(start);
        state[18..].copy_from_slice(speeds);
        for (step, stages) in times.windows(2).zip(&commands) {
            let derivative = |stage: usize, x: &[f64; 22]| {
                let mut out = [0.0; 22];
                let squares: [f64; 4] = std::array::from_fn(|rotor| square(x[18 + rotor]));
                let mut body = [0.0; 18];
                body.copy_from_slice(&x[..18]);
                out[..18].copy_from_slice(&self.mixer.derivative(self.body, &body, &squares));
                for rotor in 0..4 {
                    out[18 + rotor] = (stages[stage][rotor].max(0.0).sqrt() - x[18 + rotor]) / lag;
                }
                out
            };
            let next = self.gauss.step(&state, step[1] - step[0], &mut slopes, derivative);
            state = next.ok_or(Trouble::Steps(steps, f64::INFINITY))?;
        }
        speeds.copy_from_slice(&state[18..]);
        let mut end = [0.0; 18];
        end.copy_from_slice(&state[..18]);
        Ok(end)
    }

    /// Squared rotor speeds that `leg` demands at τ.
    ///
    /// rad²/s²; negative where no speed gives what is demanded.
    pub(super) fn squares(&self, leg: &Leg, tau: f64) -> Result<[f64; 4], Trouble> {
        let found = demand(self.body, &self.mixer, leg, tau).map_err(|singular| Trouble::Singular(tau, singular))?;
        Ok(found.squares)
    }
}

/// Where `leg` stands still between its ends: a leg along a line that sets out backwards does. Drag turns round there
/// at once, and with it, by a jump, the torque that the demand asks for, which no step may straddle.
///
/// Times on the leg, s, rising; where ½ d|v|²/dt changes from falling to rising and the speed there is nothing.
fn standstills(leg: &Leg) -> Vec<f64> {
    let part = |tau: f64| {
        let taylor = leg.taylor(tau);
        // The second Taylor coefficient is half the acceleration: only the sign is used.
        let speed = taylor.iter().map(|axis| square(axis[1])).sum::<f64>().sqrt();
        (speed, taylor.iter().map(|axis| axis[1] * axis[2]).sum::<f64>())
    };
    let place = |k: usize| leg.duration * k as f64 / PLACES as f64;
    let fastest = (0..=PLACES).map(|k| part(place(k)).0).fold(0.0, f64::max);
    let mut found = Vec::new();
    for k in 0..PLACES {
        let (mut low, mut high) = (place(k), place(k + 1));
        if part(low).1 < 0.0 && part(high).1 >= 0.0 {
            for _ in 0..60 {
                let middle = 0.5 * (low + high);
                if part(middle).1 < 0.0 { low = middle } else { high = middle }
            }
            if part(high).0 < STANDSTILL * fastest && high < leg.duration {
                found.push(high);
            }
        }
    }
    found
}

/// The ends of `steps` steps over `leg`: even, but for those that are nearest to a standstill, which lie there.
///
/// A step's end is moved, so that the two beside it become longer and shorter: with two standstills nearer to one end
/// than to any other, the later one has it.
fn times(leg: &Leg, steps: usize, standstills: &[f64]) -> Vec<f64> {
    let mut times: Vec<f64> = (0..=steps).map(|step| leg.duration * step as f64 / steps as f64).collect();
    for at in standstills {
        let nearest = (at / leg.duration * steps as f64).round().clamp(1.0, steps as f64 - 1.0);
        times[nearest as usize] = *at;
    }
    times
}
