//! Flying a leg under the rotor speeds that it demands, step by halved step until the answer stands.

use super::body::{Body, Mixer, State};
use super::claim::Leg;
use super::demand::{Singular, demand};
use super::gauss::{Gauss, STAGES};
use crate::math::power::square;

/// Everything that flying needs.
pub(super) struct Flyer<'a> {
    pub(super) body: &'a Body,
    pub(super) mixer: Mixer,
    pub(super) gauss: Gauss,
    /// Largest error of any component of the state (SI), by the change on halving the step.
    pub(super) accuracy: f64,
}

/// A leg as flown.
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
const GAIN: f64 = 64.0;
/// Steps per leg at most.
const MOST_STEPS: usize = 8192;

impl Flyer<'_> {
    /// Flies `leg` from `start` and from `chained`.
    pub(super) fn replay(&self, leg: &Leg, start: &State, chained: &State) -> Result<Replay, Trouble> {
        let mut steps = (leg.duration / FIRST_STEP).ceil().clamp(2.0, MOST_STEPS as f64) as usize;
        let mut coarse = self.fly(leg, start, &self.commands(leg, steps)?, |_, _| {});
        let mut change = f64::INFINITY;
        while steps <= MOST_STEPS / 2 {
            steps *= 2;
            let commands = self.commands(leg, steps)?;
            let mut path = (0.0, 0.0);
            let observe = |tau: f64, state: &State| {
                let claimed = leg.taylor(tau);
                let distance = (0..3).map(|axis| square(state[axis] - claimed[axis][0])).sum::<f64>().sqrt();
                if distance > path.0 {
                    path = (distance, tau);
                }
            };
            let fine = self.fly(leg, start, &commands, observe);
            if let (Some(coarse), Some(fine)) = (&coarse, &fine) {
                change = coarse.iter().zip(fine).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
                if change <= GAIN * self.accuracy {
                    let chained = self.fly(leg, chained, &commands, |_, _| {});
                    let chained = chained.ok_or(Trouble::Steps(steps, change))?;
                    return Ok(Replay { end: *fine, chained, path, steps });
                }
            }
            coarse = fine;
        }
        Err(Trouble::Steps(steps, change))
    }

    /// Squared rotor speeds at every stage of every step.
    fn commands(&self, leg: &Leg, steps: usize) -> Result<Vec<[[f64; 4]; STAGES]>, Trouble> {
        let h = leg.duration / steps as f64;
        let mut commands = vec![[[0.0; 4]; STAGES]; steps];
        for (step, stages) in commands.iter_mut().enumerate() {
            for (squares, node) in stages.iter_mut().zip(&self.gauss.nodes) {
                let tau = (step as f64 + node) * h;
                *squares = self.squares(leg, tau)?;
            }
        }
        Ok(commands)
    }

    fn fly(
        &self,
        leg: &Leg,
        start: &State,
        commands: &[[[f64; 4]; STAGES]],
        mut observe: impl FnMut(f64, &State),
    ) -> Option<State> {
        let h = leg.duration / commands.len() as f64;
        let (mut state, mut slopes) = (*start, None);
        for (step, stages) in commands.iter().enumerate() {
            let derivative = |stage: usize, x: &State| self.mixer.derivative(self.body, x, &stages[stage]);
            state = self.gauss.step(&state, h, &mut slopes, derivative)?;
            observe((step + 1) as f64 * h, &state);
        }
        Some(state)
    }

    /// Flies `leg` with rotors that follow what it demands with a first-order lag: ẇ = (demand − w)/τ_m. `speeds` are
    /// the rotors' own, carried from leg to leg.
    pub(super) fn replay_with_lag(&self, leg: &Leg, start: &State, speeds: &mut [f64; 4]) -> Result<State, Trouble> {
        let lag = self.body.rotor_time_constant;
        let steps = (leg.duration / (0.5 * lag)).ceil().clamp(2.0, MOST_STEPS as f64) as usize;
        let h = leg.duration / steps as f64;
        let commands = self.commands(leg, steps)?;
        let (mut state, mut slopes) = ([0.0; 22], None);
        state[..18].copy_from_slice(start);
        state[18..].copy_from_slice(speeds);
        for stages in &commands {
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
            state = self.gauss.step(&state, h, &mut slopes, derivative).ok_or(Trouble::Steps(steps, f64::INFINITY))?;
        }
        speeds.copy_from_slice(&state[18..]);
        let mut end = [0.0; 18];
        end.copy_from_slice(&state[..18]);
        Ok(end)
    }

    /// Squared rotor speeds that `leg` demands at τ.
    pub(super) fn squares(&self, leg: &Leg, tau: f64) -> Result<[f64; 4], Trouble> {
        let found = demand(self.body, &self.mixer, leg, tau).map_err(|singular| Trouble::Singular(tau, singular))?;
        Ok(found.squares)
    }
}
