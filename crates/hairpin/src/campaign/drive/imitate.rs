//! Drives again and again what logs are of, for fits.
//!
//! The parameters θ in their order: latency (s), steering lag (s), speed lag (s), scale of speed, scale of turn, and of
//! rovers slip and side slip at 20°. Plans are laid out once, by the nominal vehicle, and driven by every θ.

use super::DriveSetup;
use super::signs::{self, LAYOUT, Looked, Part};
use crate::campaign::Case;
use crate::campaign::kind::{GroundLog, Imitator, Order, Same};
use crate::simulation::SimulationError;
use crate::simulation::ground::{GroundConditions, Rehearsal};
use crate::trajectory::Flight;

/// Latencies that a fit begins at, s.
///
/// 12 starts in all, each with each lag below.
const LATENCIES: [f64; 4] = [0.03, 0.12, 0.22, 0.34];
/// And with each these steering lags, s. A lag and a latency of the same sum differ by the lag's square: at none of it
/// D is level along that sum, and a descent that begins there stays.
const LAGS: [f64; 3] = [0.08, 0.18, 0.34];
/// And the speed lag, s.
const SPEED_LAG: f64 = 0.15;

/// The plans of all missions.
pub(super) struct DriveImitator<'a> {
    nominal: &'a DriveSetup,
    /// In the order of the logs that signs are taken of.
    missions: Vec<(&'a Case, Rehearsal)>,
}

impl<'a> DriveImitator<'a> {
    /// # Errors
    /// A plan along which the nominal vehicle cannot stand.
    pub(super) fn new(nominal: &'a DriveSetup, cases: &[&'a Case]) -> Result<Self, SimulationError> {
        let plan = |case: &&'a Case| {
            nominal.on_its_way(nominal, case, |sortie, _, _| Rehearsal::new(sortie)).map(|plan| (*case, plan))
        };
        Ok(Self { nominal, missions: cases.iter().map(plan).collect::<Result<_, _>>()? })
    }

    /// What the nominal controller would have said along the log's own motion, and what the log then did. `None` of a
    /// log that is too short.
    fn part(&self, log: &GroundLog, (case, plan): &(&Case, Rehearsal)) -> Option<Part> {
        let looked = Looked::at(log)?;
        let said = self.nominal.on_its_way(self.nominal, case, |sortie, _, ours| {
            plan.commands_along(sortie, ours, |t| looked.moment(t), looked.end())
        });
        looked.part(log, &said, &self.nominal.map)
    }
}

impl Imitator for DriveImitator<'_> {
    fn run(&self, vehicle: Same, at: usize, order: &Order, noise: f64) -> Result<Flight, SimulationError> {
        let (case, plan) = &self.missions[at];
        vehicle.setup::<DriveSetup>().on_its_way(self.nominal, case, |sortie, conditions, ours| {
            let conditions = GroundConditions { noise, ..*conditions };
            plan.drive(sortie, ours, &conditions, &DriveSetup::settings(order), order.seed)
        })
    }

    fn signs(&self, logs: &[GroundLog]) -> Option<Vec<f64>> {
        let parts = logs.iter().zip(&self.missions).map(|(log, mission)| self.part(log, mission));
        signs::signs(&parts.collect::<Option<Vec<_>>>()?)
    }

    /// Scales begin at the sums of the coefficients of speeds and of turns, which are their estimates but for the bias
    /// of a closed loop; slips begin at what is given.
    fn starts(&self, signs: &[f64], given: &[f64]) -> Vec<Vec<f64>> {
        let [turn, speed] = [0, 1].map(|k| signs[LAYOUT[k].clone()].iter().sum::<f64>());
        let start = |latency: f64, lag: f64| {
            let mut start = given.to_vec();
            start[..5].copy_from_slice(&[latency, lag, SPEED_LAG, speed, turn]);
            start
        };
        LATENCIES.iter().flat_map(|latency| LAGS.map(|lag| start(*latency, lag))).collect()
    }

    fn scatter(&self, signs: &[f64]) -> [f64; 2] {
        signs::scatter(signs)
    }
}
