//! From the executed cases of a campaign to a model.
//!
//! Samples pair what a search saw of a leg before any execution with the stress that a run put on it; only what a
//! search can know goes in.

use super::judge::measures_of;
use super::learn::{LegSample, MoveFeatures, MoveSample, ScoreModel};
use super::scenario::Subject;
use super::{Case, Run, Setup};
use crate::judgement::{LegMeasures, Measures, Stress};
use crate::math::ridge::NoFit;

/// The legs of `case` with the stress that each of `runs` put on them. Legs that a run did not come to, and cases whose
/// legs no search saw (missions made elsewhere), give none.
///
/// A leg's stress is in the unit of `stress`. One sample a leg and run, in the order of runs, then of legs.
pub fn leg_samples(setup: &Setup, case: &Case, runs: &[Run], stress: Stress) -> Vec<LegSample> {
    let mut samples = Vec::new();
    for run in runs {
        let Some(measures) = measures_of(setup, case, run) else { continue };
        samples.extend(samples_of(case, &stresses_of(&measures, stress)));
    }
    samples
}

/// The stress of each leg; NaN where there is none to learn from.
pub(super) fn stresses_of(measures: &Measures, stress: Stress) -> Vec<f64> {
    let of_leg = |leg: &LegMeasures| stress.of_leg(leg).filter(|value| value.is_finite() && leg.time > 0.0);
    measures.legs.iter().map(|leg| of_leg(leg).unwrap_or(f64::NAN)).collect()
}

/// The legs of `case` with the stress that was measured on them.
pub(super) fn samples_of(case: &Case, stresses: &[f64]) -> Vec<LegSample> {
    let before = std::iter::once(None).chain(case.seen.iter().copied().map(Some));
    let legs = case.seen.iter().zip(before).zip(stresses).filter(|(_, stress)| stress.is_finite());
    legs.map(|((seen, before), stress)| LegSample { trajectory: case.number.0, seen: *seen, before, stress: *stress })
        .collect()
}

/// Learns the stress of `samples`, which executions of `setup` gave.
///
/// # Errors
/// [`NoFit`].
pub fn learn(setup: &Setup, stress: Stress, samples: &[LegSample]) -> Result<ScoreModel, NoFit> {
    ScoreModel::learn(stress, executed(setup), samples)
}

/// The moves of `case` between points of the cloud with the stress that each of `runs` put on them, and what the graph
/// knew of them; of moves whose angles are not known (Cartesian mode), on arcs, and of those that a run did not come to
/// there are none.
pub fn move_samples(setup: &Setup, case: &Case, runs: &[Run], stress: Stress) -> Vec<MoveSample> {
    let Some(features) = setup.kind().programs().map(|programs| programs.moves_seen(case)) else { return Vec::new() };
    let measured = runs.iter().filter_map(|run| measures_of(setup, case, run));
    let of_run = |measures: Measures| -> Vec<MoveSample> {
        let pairs = features.iter().zip(&measures.legs);
        let sample = |(features, leg): (&Option<MoveFeatures>, &LegMeasures)| {
            let stress = stress.of_leg(leg).filter(|value| value.is_finite() && leg.time > 0.0)?;
            Some(MoveSample { program: case.number.0, features: (*features)?, stress })
        };
        pairs.filter_map(sample).collect()
    };
    measured.flat_map(of_run).collect()
}

/// Learns the stress of moves, which executions of `setup` gave.
///
/// # Errors
/// [`NoFit`].
pub fn learn_moves(setup: &Setup, stress: Stress, samples: &[MoveSample]) -> Result<ScoreModel, NoFit> {
    ScoreModel::learn_moves(stress, executed(setup), samples)
}

/// Whose legs they are, and who executed them.
fn executed(setup: &Setup) -> Subject {
    let subject = setup.scenario.subject();
    match setup.own_controller() {
        Some(own) => Subject { controller: own.name().into(), ..subject },
        None => subject,
    }
}
