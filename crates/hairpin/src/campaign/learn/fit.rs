//! From executed legs and moves to a model: what is chosen, what it is fitted to, and what it is tested on.

use super::legs::{self, LegSample};
use super::moves::{MoveFeatures, MoveSample};
use super::{Feature, HeldOut, ScoreModel, Subject};
use crate::judgement::{Stress, rank_correlation};
use crate::math::ridge::{NoFit, PolynomialRidge, Rows};

/// Folds of the cross-validation.
const FOLDS: usize = 10;
/// Degrees tried.
const MOST_DEGREE: u32 = 4;
/// Every so many trajectories one is held out.
const HELD_OUT: usize = 5;
/// Trajectories that a model needs at least: as many as leave one for every fold when some are held out.
pub(in crate::campaign) const LEAST_TRAJECTORIES: usize = 13;

impl ScoreModel {
    /// Learns the stress of legs.
    ///
    /// Degree (1 to 4) and penalty have the least error in 10-fold cross-validation over trajectories. The same choice made on four
    /// fifths of the trajectories is tested on the last fifth.
    ///
    /// # Errors
    /// [`NoFit`]: fewer than 13 trajectories, numbers that are none, legs that are all the same.
    pub fn learn(stress: Stress, subject: Subject, samples: &[LegSample]) -> Result<Self, NoFit> {
        Self::fit(stress, subject, legs::named(), &rows(samples))
    }

    /// Learns the stress of an arm's moves in the same way; its trajectories are programs.
    ///
    /// # Errors
    /// As [`Self::learn`].
    pub fn learn_moves(stress: Stress, subject: Subject, samples: &[MoveSample]) -> Result<Self, NoFit> {
        let rows = Rows {
            inputs: samples.iter().map(|sample| sample.features.inputs().to_vec()).collect(),
            values: samples.iter().map(|sample| sample.stress).collect(),
            groups: samples.iter().map(|sample| sample.program).collect(),
        };
        Self::fit(stress, subject, MoveFeatures::named(), &rows)
    }

    fn fit(stress: Stress, subject: Subject, features: Vec<Feature>, all: &Rows) -> Result<Self, NoFit> {
        let (seen, unseen) = split(all);
        let (tested, _) = PolynomialRidge::choose(&seen, MOST_DEGREE, FOLDS)?;
        let held_out = held_out(&tested, &unseen);
        let (polynomial, validation) = PolynomialRidge::choose(all, MOST_DEGREE, FOLDS)?;
        let mut trajectories = all.groups.clone();
        trajectories.dedup();
        Ok(Self {
            score_model: 1,
            stress,
            unit: stress.unit().into(),
            subject,
            features,
            validation,
            held_out,
            trajectories: trajectories.len(),
            legs: all.values.len(),
            training_hash: hash(all),
            polynomial,
        })
    }
}

pub(super) fn rows(samples: &[LegSample]) -> Rows {
    Rows {
        inputs: samples.iter().map(|sample| legs::inputs(&sample.features, sample.duration).to_vec()).collect(),
        values: samples.iter().map(|sample| sample.stress).collect(),
        groups: samples.iter().map(|sample| sample.trajectory).collect(),
    }
}

/// Trajectories that are seen, and every fifth, which is not.
fn split(all: &Rows) -> (Rows, Rows) {
    let mut place = 0;
    let mut last = None;
    let (mut seen, mut unseen) = (Rows::default(), Rows::default());
    for ((inputs, value), group) in all.inputs.iter().zip(&all.values).zip(&all.groups) {
        if last.is_some_and(|last| last != *group) {
            place += 1;
        }
        last = Some(*group);
        let part = if place % HELD_OUT == HELD_OUT - 1 { &mut unseen } else { &mut seen };
        part.inputs.push(inputs.clone());
        part.values.push(*value);
        part.groups.push(*group);
    }
    (seen, unseen)
}

fn held_out(fitted: &PolynomialRidge, unseen: &Rows) -> HeldOut {
    let n = unseen.values.len().max(1) as f64;
    let mean = unseen.values.iter().sum::<f64>() / n;
    let (mut squares, mut spread) = (0.0, 0.0);
    let mut largest: Vec<(usize, f64, f64)> = Vec::new();
    for ((inputs, value), group) in unseen.inputs.iter().zip(&unseen.values).zip(&unseen.groups) {
        let told = fitted.value(inputs);
        squares += (value - told) * (value - told);
        spread += (value - mean) * (value - mean);
        match largest.last_mut() {
            Some((trajectory, expected, measured)) if trajectory == group => {
                (*expected, *measured) = (expected.max(told), measured.max(*value));
            }
            _ => largest.push((*group, told, *value)),
        }
    }
    let (told, measured): (Vec<f64>, Vec<f64>) = largest.iter().map(|(_, told, measured)| (told, measured)).unzip();
    HeldOut {
        trajectories: largest.len(),
        r2: if spread > 0.0 { 1.0 - squares / spread } else { 0.0 },
        rmse: libm::sqrt(squares / n),
        rank_correlation: rank_correlation(&told, &measured),
    }
}

fn hash(rows: &Rows) -> String {
    let mut hasher = blake3::Hasher::new();
    for ((inputs, value), group) in rows.inputs.iter().zip(&rows.values).zip(&rows.groups) {
        hasher.update(&(*group as u64).to_le_bytes());
        for number in inputs.iter().chain([value]) {
            hasher.update(&number.to_le_bytes());
        }
    }
    hasher.finalize().to_hex().to_string()
}

#[cfg(test)]
mod tests {
    use super::super::ModelMistake;
    use super::*;
    use crate::feasibility::reach::LegFeatures;
    use crate::math::random::{stream, unit};

    fn subject() -> Subject {
        Subject {
            robot: "r".into(),
            robot_hash: "00".into(),
            speeds: "leg over step".into(),
            controller: "minimum-snap".into(),
        }
    }

    fn samples(trajectories: usize) -> Vec<LegSample> {
        let mut rng = stream(8);
        (0..9 * trajectories)
            .map(|leg| {
                let v = 10.0 * unit(&mut rng);
                let turn = 3.0 * unit(&mut rng);
                let climb = v * (unit(&mut rng) - 0.5);
                let features = LegFeatures { v_in: 2.0, v_out: v, turn, length: v, climb, ..LegFeatures::default() };
                let stress = 0.2 * v * turn + 0.1 * unit(&mut rng);
                LegSample { trajectory: leg / 9, features, duration: 1.0, stress }
            })
            .collect()
    }

    #[test]
    fn what_legs_do_is_learned_and_told_of_trajectories_not_seen() {
        let model = ScoreModel::learn(Stress::MaxDeviation, subject(), &samples(60)).unwrap();
        assert_eq!((model.trajectories, model.legs, model.held_out.trajectories), (60, 540, 12));
        assert!(model.validation.r2 > 0.99 && model.held_out.r2 > 0.99, "{model:?}");
        assert!(model.held_out.rank_correlation.unwrap() > 0.9);
        let leg = LegFeatures { v_in: 2.0, v_out: 8.0, turn: 2.0, length: 8.0, climb: 0.1, ..LegFeatures::default() };
        assert!((model.expected(&leg, 1.0) - 3.25).abs() < 0.1, "{}", model.expected(&leg, 1.0));
        let again = ScoreModel::learn(Stress::MaxDeviation, subject(), &samples(60)).unwrap();
        assert_eq!(model, again);
        let text = serde_json::to_string(&model).unwrap();
        assert_eq!(serde_json::from_str::<ScoreModel>(&text).unwrap(), model);
    }

    #[test]
    fn a_model_serves_its_own_robot_only() {
        let model = ScoreModel::learn(Stress::Time, subject(), &samples(20)).unwrap();
        model.check(&subject()).unwrap();
        model.check(&Subject { controller: "geometric".into(), ..subject() }).unwrap();
        let other = Subject { robot_hash: "01".into(), ..subject() };
        assert!(model.check(&other).unwrap_err().to_string().contains("robot_hash `00`"));
        let mut broken = model.clone();
        broken.features.swap(0, 1);
        assert!(matches!(broken.check(&subject()), Err(ModelMistake::Features { .. })));
        let mut broken = model.clone();
        broken.polynomial.weights.pop();
        assert!(matches!(broken.check(&subject()), Err(ModelMistake::Polynomial { field: "weights", .. })));
        let mut broken = model;
        broken.polynomial.intercept = f64::NAN;
        assert!(matches!(broken.check(&subject()), Err(ModelMistake::Polynomial { .. })));
    }

    #[test]
    fn too_few_trajectories_are_told() {
        let told = ScoreModel::learn(Stress::Time, subject(), &samples(9)).unwrap_err();
        assert!(matches!(told, NoFit::Groups { .. }), "{told}");
        assert!(ScoreModel::learn(Stress::Time, subject(), &[]).is_err());
    }
}
