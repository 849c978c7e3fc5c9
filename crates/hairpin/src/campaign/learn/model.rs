//! Learned scores: a leg's stress in execution, predicted from what a search sees of the leg.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::moves::{ARM_MOVES, MoveFeatures, MoveSample};
use crate::feasibility::reach::LegFeatures;
use crate::judgement::{Stress, rank_correlation};
use crate::math::ridge::{NoFit, PolynomialRidge, Rows, Validation, monomials_of};

/// Number of features of a leg.
const FEATURES: usize = 8;
/// Folds of the cross-validation.
const FOLDS: usize = 10;
/// Degrees tried.
const MOST_DEGREE: u32 = 4;
/// Every so many trajectories one is held out.
const HELD_OUT: usize = 5;
/// Trajectories that a model needs at least: as many as leave one for every fold when some are held out.
pub(in crate::campaign) const LEAST_TRAJECTORIES: usize = 13;

/// A feature of legs that models are made of.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Feature {
    /// Its name.
    pub name: String,
    /// Its unit.
    pub unit: String,
}

/// The features in their order: speeds at both ends, turn from the leg before, length, sines of elevation of the leg and of the one
/// before, planned duration, and what the reach set knows of the ground.
fn features() -> Vec<Feature> {
    let named: [(&str, &str); FEATURES] = [
        ("v_in", "m/s"),
        ("v_out", "m/s"),
        ("turn", "rad"),
        ("length", "m"),
        ("slope", ""),
        ("slope_in", ""),
        ("duration", "s"),
        ("ground", ""),
    ];
    named.into_iter().map(|(name, unit)| Feature { name: name.into(), unit: unit.into() }).collect()
}

fn inputs(leg: &LegFeatures, duration: f64) -> [f64; FEATURES] {
    let slope = if leg.length > 0.0 { leg.climb / leg.length } else { 0.0 };
    [leg.v_in, leg.v_out, leg.turn, leg.length, slope, leg.slope_in, duration, leg.ground]
}

/// A leg that was executed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LegSample {
    /// Number of its trajectory: legs of one trajectory are never on both sides of a fold.
    pub trajectory: usize,
    /// What a search sees of it.
    pub features: LegFeatures,
    /// Its planned duration, s.
    pub duration: f64,
    /// Its stress.
    pub stress: f64,
}

/// Whose legs a model is about. A model serves no other's.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Subject {
    /// The robot's name.
    pub robot: String,
    /// BLAKE3 of the robot's numbers, hexadecimal.
    pub robot_hash: String,
    /// What speeds at a leg's ends mean: `leg over step` or `at the leg's ends`.
    pub speeds: String,
    /// Who executed.
    pub controller: String,
}

/// How well trajectories that the model has not seen are told.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeldOut {
    /// Trajectories that were held out.
    pub trajectories: usize,
    /// Share of the variance over their legs that is explained.
    pub r2: f64,
    /// Root of the mean squared error over their legs, in units of the stress.
    pub rmse: f64,
    /// Spearman's ρ between told and measured largest stress of a trajectory: what a search makes use of.
    pub rank_correlation: Option<f64>,
}

/// A learned score, as it is written.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct ScoreModel {
    /// Version of the format: 1.
    pub score_model: u32,
    /// What is predicted of each leg.
    pub stress: Stress,
    /// Its unit.
    pub unit: String,
    /// Whose legs.
    pub subject: Subject,
    /// Inputs, in their order.
    pub features: Vec<Feature>,
    /// Cross-validation of what was chosen.
    pub validation: Validation,
    /// A test on trajectories that took no part in choosing or fitting; the polynomial written is fitted to all.
    pub held_out: HeldOut,
    /// Trajectories learned from.
    pub trajectories: usize,
    /// Legs learned from.
    pub legs: usize,
    /// BLAKE3 of the legs learned from, hexadecimal.
    pub training_hash: String,
    /// The polynomial.
    pub polynomial: PolynomialRidge,
}

/// Why a model cannot serve.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ModelMistake {
    /// Of another version.
    #[error("score_model = {found}; must be 1")]
    Version {
        /// As written.
        found: u32,
    },
    /// It was learned elsewhere.
    #[error("learned on {field} `{found}`; the scenario's is `{wanted}`")]
    Subject {
        /// What differs.
        field: &'static str,
        /// The model's.
        found: String,
        /// The scenario's.
        wanted: String,
    },
    /// Its inputs are others.
    #[error("features {found}; must be {wanted}")]
    Features {
        /// The model's.
        found: String,
        /// Those of legs.
        wanted: String,
    },
    /// Its polynomial is broken.
    #[error("polynomial.{field}: {found}; must be {bound}")]
    Polynomial {
        /// The key.
        field: &'static str,
        /// What stands there.
        found: String,
        /// What must.
        bound: String,
    },
}

impl ScoreModel {
    /// Learns the stress of legs.
    ///
    /// Degree (1 to 4) and penalty have the least error in 10-fold cross-validation over trajectories. The same choice made on four
    /// fifths of the trajectories is tested on the last fifth.
    ///
    /// # Errors
    /// [`NoFit`]: fewer than 13 trajectories, numbers that are none, legs that are all the same.
    pub fn learn(stress: Stress, subject: Subject, samples: &[LegSample]) -> Result<Self, NoFit> {
        Self::fit(stress, subject, features(), &rows(samples))
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

    /// Whether the model can score legs of `subject`. Another controller is no obstacle: stress transfers badly between
    /// them, but it is the user's to say.
    ///
    /// # Errors
    /// [`ModelMistake`].
    pub fn check(&self, subject: &Subject) -> Result<(), ModelMistake> {
        if self.score_model != 1 {
            return Err(ModelMistake::Version { found: self.score_model });
        }
        let pairs = [
            ("robot", &self.subject.robot, &subject.robot),
            ("robot_hash", &self.subject.robot_hash, &subject.robot_hash),
            ("speeds", &self.subject.speeds, &subject.speeds),
        ];
        for (field, found, wanted) in pairs {
            if found != wanted {
                return Err(ModelMistake::Subject { field, found: found.clone(), wanted: wanted.clone() });
            }
        }
        let wanted = if subject.speeds == ARM_MOVES { MoveFeatures::named() } else { features() };
        if self.features != wanted {
            let told = |features: &[Feature]| {
                features.iter().map(|f| format!("{} [{}]", f.name, f.unit)).collect::<Vec<_>>().join(", ")
            };
            return Err(ModelMistake::Features { found: told(&self.features), wanted: told(&wanted) });
        }
        self.check_polynomial()
    }

    fn check_polynomial(&self) -> Result<(), ModelMistake> {
        let wrong =
            |field, found: String, bound: &str| Err(ModelMistake::Polynomial { field, found, bound: bound.to_owned() });
        let PolynomialRidge { degree, centre, scale, range, powers, weights, intercept, .. } = &self.polynomial;
        let inputs = self.features.len();
        let per_input = format!("{inputs} numbers");
        for (field, length) in [("centre", centre.len()), ("scale", scale.len()), ("range", range.len())] {
            if length != inputs {
                return wrong(field, format!("{length} numbers"), &per_input);
            }
        }
        if monomials_of(scale, *degree).as_ref() != Some(powers) {
            let found = format!("{} rows", powers.len());
            return wrong("powers", found, "those of all monomials of the degree in inputs with a scale");
        }
        if powers.len() != weights.len() {
            return wrong("weights", weights.len().to_string(), &format!("{}, one per monomial", powers.len()));
        }
        if let Some([least, greatest]) =
            range.iter().find(|[least, greatest]| least.is_nan() || greatest < least || greatest.is_nan())
        {
            return wrong("range", format!("[{least}, {greatest}]"), "rising");
        }
        let numbers = || centre.iter().chain(scale).chain(weights).chain([intercept]);
        if let Some(number) = numbers().find(|number| !number.is_finite()) {
            return wrong("weights", number.to_string(), "finite");
        }
        Ok(())
    }

    /// The stress expected of a leg, in [`Self::unit`].
    pub fn expected(&self, leg: &LegFeatures, duration: f64) -> f64 {
        self.polynomial.value(&inputs(leg, duration))
    }

    /// The stress expected of a move of an arm, in [`Self::unit`].
    pub fn expected_of_move(&self, features: &MoveFeatures) -> f64 {
        self.polynomial.value(&features.inputs())
    }
}

pub(super) fn rows(samples: &[LegSample]) -> Rows {
    Rows {
        inputs: samples.iter().map(|sample| inputs(&sample.features, sample.duration).to_vec()).collect(),
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
    use super::*;
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
