//! From executed legs and moves to a model: what is chosen, what it is fitted to, and what it is tested on.

use super::leg_stress::{LegStress, Pairs};
use super::legs::{self, LegSample};
use super::moves::{MoveFeatures, MoveSample};
use super::{Feature, HeldOut, ScoreModel};
use crate::campaign::case::SeenLeg;
use crate::campaign::scenario::Subject;
use crate::judgement::{Stress, rank_correlation};
use crate::math::ridge::{NoFit, Rows};

/// Every so many trajectories one is held out.
const HELD_OUT: usize = 5;
/// Trajectories that a model needs at least: as many as leave one for every fold when some are held out, which of these
/// are the fifth and the tenth.
const LEAST_TRAJECTORIES: usize = 12;

impl ScoreModel {
    /// Learns the stress of legs.
    ///
    /// Degree (1 to 4) and penalty have the least error in 10-fold cross-validation over trajectories. The same choice
    /// made on four fifths of the trajectories is tested on the last fifth.
    ///
    /// Samples of one trajectory follow each other: a trajectory ends where the number changes.
    ///
    /// # Errors
    /// [`NoFit`]: fewer than 12 trajectories, numbers that are none, legs that are all the same.
    pub fn learn(stress: Stress, subject: Subject, samples: &[LegSample]) -> Result<Self, NoFit> {
        Self::fit(stress, subject, legs::named(), &pairs(samples))
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
        let before = vec![None; samples.len()];
        Self::fit(stress, subject, MoveFeatures::named(), &Pairs { rows, before })
    }

    /// The model of all rows, its cross-validation, and the test on every fifth trajectory, for which the choice is
    /// made again without those.
    fn fit(stress: Stress, subject: Subject, features: Vec<Feature>, all: &Pairs) -> Result<Self, NoFit> {
        let mut trajectories = all.rows.groups.clone();
        trajectories.dedup();
        if trajectories.len() < LEAST_TRAJECTORIES {
            return Err(NoFit::Groups { groups: trajectories.len(), needed: LEAST_TRAJECTORIES });
        }
        let (seen, unseen) = all.split(HELD_OUT, HELD_OUT - 1);
        let (tested, _) = LegStress::choose(&seen)?;
        let held_out = held_out(&tested, &unseen);
        let (LegStress { own, before }, validation) = LegStress::choose(all)?;
        Ok(Self {
            score_model: 1,
            stress,
            unit: stress.unit().into(),
            subject,
            features,
            validation,
            held_out,
            trajectories: trajectories.len(),
            legs: all.rows.values.len(),
            training_hash: hash(&all.rows),
            polynomial: own,
            before,
        })
    }
}

/// One row per leg, in their order.
pub(super) fn pairs(samples: &[LegSample]) -> Pairs {
    let inputs = |leg: &SeenLeg| legs::inputs(&leg.features, leg.duration).to_vec();
    let rows = Rows {
        inputs: samples.iter().map(|sample| inputs(&sample.seen)).collect(),
        values: samples.iter().map(|sample| sample.stress).collect(),
        groups: samples.iter().map(|sample| sample.trajectory).collect(),
    };
    Pairs { rows, before: samples.iter().map(|sample| sample.before.as_ref().map(inputs)).collect() }
}

/// r² = 1 − Σ (y − ŷ)² / Σ (y − ȳ)² over the legs, 0 where all y are equal; the rank correlation is of the
/// trajectories' largest y and ŷ, which need not be of the same leg.
fn held_out(fitted: &LegStress, unseen: &Pairs) -> HeldOut {
    let Pairs { rows: unseen, before } = unseen;
    let n = unseen.values.len().max(1) as f64;
    let mean = unseen.values.iter().sum::<f64>() / n;
    let (mut squares, mut spread) = (0.0, 0.0);
    let mut largest: Vec<(usize, f64, f64)> = Vec::new();
    let inputs = unseen.inputs.iter().zip(before);
    for (((inputs, before), value), group) in inputs.zip(&unseen.values).zip(&unseen.groups) {
        let told = fitted.value(inputs, before.as_deref());
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

/// Over trajectory number (u64), inputs and stress (f64) of each row, little-endian, in the order of the rows.
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

#[cfg(feature = "unit-tests")]
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
                let seen = SeenLeg { features, duration: 1.0 };
                LegSample { trajectory: leg / 9, seen, before: None, stress }
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
        assert!((model.own(&leg, 1.0) - 3.25).abs() < 0.1, "{}", model.own(&leg, 1.0));
        assert_eq!((&model.before, model.left(&leg, 1.0)), (&None, 0.0));
        let again = ScoreModel::learn(Stress::MaxDeviation, subject(), &samples(60)).unwrap();
        assert_eq!(model, again);
        let text = serde_json::to_string(&model).unwrap();
        assert_eq!(serde_json::from_str::<ScoreModel>(&text).unwrap(), model);
    }

    #[test]
    fn what_the_leg_before_leaves_is_learned_where_it_helps() {
        let alone = samples(60);
        let mut behind = alone.clone();
        for (k, sample) in behind.iter_mut().enumerate() {
            sample.before = (k % 9 > 0).then(|| alone[k - 1].seen);
            if k % 9 == 0 {
                sample.seen.features.v_in = 0.0; // from rest, as every trajectory begins
            }
        }
        // Legs that leave nothing are told better without.
        let model = ScoreModel::learn(Stress::MaxDeviation, subject(), &behind).unwrap();
        assert!(model.before.is_none() && model.validation.r2 > 0.99);
        for sample in &mut behind {
            sample.stress += sample.before.map_or(0.0, |before| 0.3 * before.features.v_out * before.features.turn);
        }
        let model = ScoreModel::learn(Stress::MaxDeviation, subject(), &behind).unwrap();
        assert!(model.validation.r2 > 0.98 && model.held_out.r2 > 0.98, "{model:?}");
        let left = |v_out: f64, turn: f64| {
            model.left(&LegFeatures { v_in: 2.0, v_out, turn, length: v_out, ..LegFeatures::default() }, 1.0)
        };
        assert!((left(8.0, 2.5) - left(2.0, 0.5) - 5.7).abs() < 0.3, "{}", left(8.0, 2.5) - left(2.0, 0.5));
        let text = serde_json::to_string(&model).unwrap();
        assert_eq!(serde_json::from_str::<ScoreModel>(&text).unwrap(), model);
        let mut broken = model;
        broken.before.as_mut().unwrap().weights.pop();
        let told = broken.check(&subject()).unwrap_err().to_string();
        assert!(told.starts_with("before.weights: "), "{told}");
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
        let mut broken = model.clone();
        broken.polynomial.intercept = f64::NAN;
        assert!(matches!(broken.check(&subject()), Err(ModelMistake::Polynomial { .. })));
        // What is told of it is told to whoever reads it.
        type Break = fn(&mut ScoreModel);
        let breaks: [(Break, &str); 7] = [
            (|model| model.validation.r2 = 7.0, "validation.r2: 7; must be at most 1"),
            (|model| model.validation.rmse = -1.0, "validation.rmse: -1; must be at least 0"),
            (|model| model.held_out.r2 = -1e99, "held_out.r2: "),
            (|model| model.held_out.rank_correlation = Some(1.5), "held_out.rank_correlation: "),
            (|model| model.held_out.trajectories = 20, "held_out.trajectories: 20; must be less than `trajectories`"),
            (|model| model.legs = 3, "model.legs: 3; must be at least `trajectories`"),
            (|model| model.training_hash = "xx".into(), "model.training_hash: `xx`; must be 64 hexadecimal digits"),
        ];
        for (spoil, told) in breaks {
            let mut broken = model.clone();
            spoil(&mut broken);
            let found = broken.check(&subject()).unwrap_err().to_string();
            assert!(found.starts_with(told), "{found}");
        }
    }

    #[test]
    fn too_few_trajectories_are_told() {
        // All of them are counted, those that would be held out too.
        let told = ScoreModel::learn(Stress::Time, subject(), &samples(11)).unwrap_err();
        assert_eq!(told, NoFit::Groups { groups: 11, needed: 12 });
        assert_eq!(ScoreModel::learn(Stress::Time, subject(), &samples(12)).unwrap().trajectories, 12);
        assert!(ScoreModel::learn(Stress::Time, subject(), &[]).is_err());
    }
}
