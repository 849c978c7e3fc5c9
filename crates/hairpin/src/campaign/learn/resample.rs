//! The same kind of model from other trajectories: how far a prediction may be trusted shows in how much such models
//! differ.

use std::collections::BTreeMap;

use rand::RngExt;

use super::fit::pairs;
use super::leg_stress::LegStress;
use super::{LegSample, ScoreModel};
use crate::math::random::stream;
use crate::math::ridge::NoFit;

impl ScoreModel {
    /// The model of `samples` resampled: as many trajectories drawn with replacement, degree and penalty as they are.
    ///
    /// The optimum under a model drawn so is one that may be the true one, as far as the data say: bootstrapped
    /// Thompson sampling. Sources: Efron 1979; Osband and Van Roy 2015.
    ///
    /// Each trajectory comes with all of its legs: legs of one trajectory are not independent. The same seed gives the
    /// same model.
    ///
    /// # Errors
    /// [`NoFit`]: no trajectory, or all that were drawn are the same.
    pub(in crate::campaign) fn resampled(&self, samples: &[LegSample], seed: u64) -> Result<Self, NoFit> {
        let mut legs: BTreeMap<usize, Vec<LegSample>> = BTreeMap::new();
        for sample in samples {
            legs.entry(sample.trajectory).or_default().push(*sample);
        }
        let trajectories: Vec<&Vec<LegSample>> = legs.values().collect();
        if trajectories.is_empty() {
            return Err(NoFit::Groups { groups: 0, needed: 1 });
        }
        let mut random = stream(seed);
        let draws = (0..trajectories.len()).map(|_| trajectories[random.random_range(0..trajectories.len())]);
        let drawn: Vec<LegSample> = draws.flatten().copied().collect();
        let like = LegStress { own: self.polynomial.clone(), before: self.before.clone() };
        let LegStress { own, before } = like.refitted(&pairs(&drawn))?;
        Ok(Self { polynomial: own, before, ..self.clone() })
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::case::SeenLeg;
    use crate::campaign::scenario::Subject;
    use crate::feasibility::reach::LegFeatures;
    use crate::judgement::Stress;
    use crate::math::random::unit;

    #[test]
    fn models_of_other_draws_agree_where_there_are_data_and_differ_elsewhere() {
        let mut random = stream(4);
        let samples: Vec<LegSample> = (0..200)
            .map(|leg| {
                let v_out = 6.0 * unit(&mut random);
                let features = LegFeatures { v_in: 1.0, v_out, turn: 0.5, length: 3.0, ..LegFeatures::default() };
                let stress = 0.3 * v_out * v_out + unit(&mut random);
                let seen = SeenLeg { features, duration: 1.0 };
                LegSample { trajectory: leg / 5, seen, before: None, stress }
            })
            .collect();
        let subject = Subject {
            robot: "r".into(),
            robot_hash: "00".into(),
            speeds: "leg over step".into(),
            controller: "minimum-snap".into(),
        };
        let model = ScoreModel::learn(Stress::MaxDeviation, subject, &samples).unwrap();
        let others: Vec<ScoreModel> = (0..20).map(|seed| model.resampled(&samples, seed).unwrap()).collect();
        assert_eq!(others[3], model.resampled(&samples, 3).unwrap());
        let leg = LegFeatures { v_out: 3.0, ..samples[0].seen.features };
        let told = |model: &ScoreModel| model.own(&leg, 1.0);
        let (mean, all) = (told(&model), others.iter().map(told).collect::<Vec<f64>>());
        assert!(all.iter().all(|one| (one - mean).abs() < 0.3), "{mean} {all:?}");
        assert!(all.iter().any(|one| *one != mean), "draws differ");
        assert!(model.resampled(&[], 1).is_err());
    }
}
