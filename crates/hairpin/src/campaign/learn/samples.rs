//! From the executed cases of a campaign to a model.

use super::{LegSample, ScoreModel, subject};
use crate::campaign::judge::measures_of;
use crate::campaign::{Case, Run, Setup};
use crate::judgement::{Measures, Stress};
use crate::math::ridge::NoFit;

/// The legs of `case` with the stress that each of `runs` put on them. Legs that a run did not come to, and cases whose legs no search
/// saw (missions made elsewhere), give none.
pub fn leg_samples(setup: &Setup, case: &Case, runs: &[Run], stress: Stress) -> Vec<LegSample> {
    let mut samples = Vec::new();
    for run in runs {
        let Some(measures) = measures_of(setup, case, run) else { continue };
        samples.extend(samples_of(case, &measures, stress));
    }
    samples
}

/// The legs of `case` with the stress that was measured on them.
pub(in crate::campaign) fn samples_of(case: &Case, measures: &Measures, stress: Stress) -> Vec<LegSample> {
    let mut samples = Vec::new();
    for (seen, leg) in case.seen.iter().zip(&measures.legs) {
        let stress = stress.of_leg(leg).filter(|value| value.is_finite() && leg.time > 0.0);
        samples.extend(stress.map(|stress| LegSample {
            trajectory: case.number,
            features: seen.features,
            duration: seen.duration,
            stress,
        }));
    }
    samples
}

/// Learns the stress of `samples`, which executions of `setup` gave.
///
/// # Errors
/// [`NoFit`].
pub fn learn(setup: &Setup, stress: Stress, samples: &[LegSample]) -> Result<ScoreModel, NoFit> {
    ScoreModel::learn(stress, subject(&setup.scenario), samples)
}
