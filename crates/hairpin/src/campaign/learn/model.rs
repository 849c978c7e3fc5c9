//! Learned scores: a leg's stress in execution, predicted from what a search sees of the leg.

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::Feature;
use super::legs;
use super::moves::MoveFeatures;
use crate::campaign::scenario::{ARM_MOVES, Subject};
use crate::feasibility::reach::LegFeatures;
use crate::judgement::Stress;
use crate::math::ridge::{LANES, PolynomialRidge, Validation, monomials_of};

/// How well trajectories that the model has not seen are told.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct HeldOut {
    /// Trajectories that were held out.
    pub trajectories: usize,
    /// Share of the variance over their legs that is explained.
    ///
    /// 1 is exact; 0 is no better than the mean, and negative is worse.
    pub r2: f64,
    /// Root of the mean squared error over their legs, in units of the stress.
    pub rmse: f64,
    /// Spearman's ρ between told and measured largest stress of a trajectory: what a search makes use of.
    ///
    /// −1 to 1.
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
    /// Of the leg before, with the same inputs: what it leaves to the leg, beside the other one's value.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub before: Option<PolynomialRidge>,
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
    /// A polynomial is broken, or what is told of it.
    #[error("{part}.{field}: {found}; must be {bound}")]
    Polynomial {
        /// Which one, or what else.
        part: &'static str,
        /// The key.
        field: &'static str,
        /// What stands there.
        found: String,
        /// What must.
        bound: String,
    },
}

/// Largest number of a polynomial.
const LARGEST: f64 = 1e50;

impl ScoreModel {
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
        if self.unit != self.stress.unit() {
            let (found, wanted) = (self.unit.clone(), self.stress.unit().to_owned());
            return Err(ModelMistake::Subject { field: "unit", found, wanted });
        }
        let wanted = if subject.speeds == ARM_MOVES { MoveFeatures::named() } else { legs::named() };
        if self.features != wanted {
            let told = |features: &[Feature]| {
                features.iter().map(|f| format!("{} [{}]", f.name, f.unit)).collect::<Vec<_>>().join(", ")
            };
            return Err(ModelMistake::Features { found: told(&self.features), wanted: told(&wanted) });
        }
        self.check_quality()?;
        self.check_polynomial("polynomial", &self.polynomial)?;
        match &self.before {
            Some(_) if subject.speeds == ARM_MOVES => Err(ModelMistake::Polynomial {
                part: "before",
                field: "given",
                found: "a polynomial".into(),
                bound: "left out: a move leaves nothing to the next".into(),
            }),
            Some(before) => self.check_polynomial("before", before),
            None => Ok(()),
        }
    }

    /// What is said of its quality and origin can be true of a model.
    fn check_quality(&self) -> Result<(), ModelMistake> {
        let Self { validation, held_out, trajectories, legs, training_hash, .. } = self;
        let is_rank = |rank: f64| (-1.0..=1.0).contains(&rank);
        let error = |rmse: f64| ((0.0..=LARGEST).contains(&rmse), rmse.to_string());
        let share = |r2: f64| ((-LARGEST..=1.0).contains(&r2), r2.to_string());
        let is_hash = training_hash.len() == 64 && training_hash.bytes().all(|digit| digit.is_ascii_hexdigit());
        let of_rank = held_out.rank_correlation;
        let facts = [
            ("validation", "r2", share(validation.r2), "at most 1"),
            ("validation", "rmse", error(validation.rmse), "at least 0"),
            ("held_out", "r2", share(held_out.r2), "at most 1"),
            ("held_out", "rmse", error(held_out.rmse), "at least 0"),
            ("held_out", "rank_correlation", (of_rank.is_none_or(is_rank), format!("{of_rank:?}")), "-1 to 1"),
            (
                "held_out",
                "trajectories",
                (held_out.trajectories < *trajectories, held_out.trajectories.to_string()),
                "less than `trajectories`",
            ),
            ("model", "legs", (legs >= trajectories, legs.to_string()), "at least `trajectories`"),
            ("model", "training_hash", (is_hash, format!("`{training_hash}`")), "64 hexadecimal digits"),
        ];
        facts.into_iter().try_for_each(|(part, field, (holds, found), bound)| {
            let wrong = || ModelMistake::Polynomial { part, field, found, bound: bound.into() };
            if holds { Ok(()) } else { Err(wrong()) }
        })
    }

    /// Lengths of all lists, the monomials of the degree, ranges that rise, and numbers within ±10⁵⁰.
    fn check_polynomial(&self, part: &'static str, polynomial: &PolynomialRidge) -> Result<(), ModelMistake> {
        let wrong = |field, found: String, bound: &str| {
            Err(ModelMistake::Polynomial { part, field, found, bound: bound.to_owned() })
        };
        let PolynomialRidge { degree, centre, scale, range, powers, weights, intercept, .. } = polynomial;
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
        // Products of as many as the degree, and sums over a trajectory, stay finite.
        let numbers = || centre.iter().chain(scale).chain(weights).chain([intercept]).chain(range.iter().flatten());
        if let Some(number) = numbers().find(|number| !(-LARGEST..=LARGEST).contains(*number)) {
            return wrong("numbers", number.to_string(), &format!("within ±{LARGEST:e}"));
        }
        Ok(())
    }

    /// The stress expected of a leg, in [`Self::unit`], but for what the leg before leaves to it.
    ///
    /// `duration` in s. Beyond the range of what was learned from, inputs count as its nearest end.
    pub fn own(&self, leg: &LegFeatures, duration: f64) -> f64 {
        self.polynomial.value(&legs::inputs(leg, duration))
    }

    /// What a leg leaves to the stress of the one after it, in [`Self::unit`].
    ///
    /// 0 where no such part was learned.
    pub fn left(&self, leg: &LegFeatures, duration: f64) -> f64 {
        self.before.as_ref().map_or(0.0, |before| before.value(&legs::inputs(leg, duration)))
    }

    /// [`Self::own`] and [`Self::left`] of many legs with their durations.
    ///
    /// [own, left] of each, to the last bit as one by one.
    pub(in crate::campaign) fn own_and_left<'l>(
        &self,
        legs: impl Iterator<Item = (&'l LegFeatures, f64)>,
    ) -> Vec<[f64; 2]> {
        let inputs: Vec<_> = legs.map(|(leg, duration)| legs::inputs(leg, duration)).collect();
        let mut parts = Vec::with_capacity(inputs.len());
        for some in inputs.chunks(LANES) {
            // The last ones are told once more where there are fewer.
            let rows = std::array::from_fn(|lane| some[lane.min(some.len() - 1)].as_slice());
            let own = self.polynomial.values(rows);
            let left = self.before.as_ref().map_or([0.0; LANES], |before| before.values(rows));
            parts.extend(own.into_iter().zip(left).take(some.len()).map(|(own, left)| [own, left]));
        }
        parts
    }

    /// The stress expected of a move of an arm, in [`Self::unit`].
    pub fn expected_of_move(&self, features: &MoveFeatures) -> f64 {
        self.polynomial.value(&features.inputs())
    }
}
