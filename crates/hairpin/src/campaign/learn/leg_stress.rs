//! The stress of a leg as a part that is its own and a part that the leg before it leaves to it.
//!
//! A robot that cuts a corner strays from the leg after it: what a leg comes to is decided on the one before. As the
//! parts are added, an exact search still proves its optimum ([`crate::search::Additive`]).

use rayon::prelude::*;

use crate::math::ridge::{NoFit, PolynomialRidge, Rows, Validation};

/// Folds of the cross-validation.
const FOLDS: usize = 10;
/// How often each part is fitted again to what the other leaves: more often changes nothing that can be seen.
const PASSES: usize = 2;
/// Degrees tried.
const MOST_DEGREE: u32 = 4;

/// Rows to learn from, and for each the inputs of the leg before it, if there was one.
#[derive(Debug, Clone, Default)]
pub(super) struct Pairs {
    pub(super) rows: Rows,
    /// As many as rows; `None` for the first leg of a trajectory.
    pub(super) before: Vec<Option<Vec<f64>>>,
}

/// ```text
/// stress of leg k ≈ own(leg k) + before(leg k − 1)
/// ```
#[derive(Debug, Clone)]
pub(super) struct LegStress {
    pub(super) own: PolynomialRidge,
    /// `None` where it does not help to tell the stress of trajectories not seen.
    pub(super) before: Option<PolynomialRidge>,
}

impl LegStress {
    /// Fits both parts in turn (backfitting: Friedman and Stuetzle, Journal of the American Statistical Association 76,
    /// 1981): the own part, the part before to what that leaves unexplained, and the own part again. Each has the
    /// degree (1 to 4) and the penalty of the least error in cross-validation; the part before is kept where it lessens
    /// the error of both together.
    ///
    /// Costs three cross-validations over degrees and penalties, and one of both parts together.
    ///
    /// # Errors
    /// [`NoFit`].
    pub(super) fn choose(pairs: &Pairs) -> Result<(Self, Validation), NoFit> {
        let (own, alone) = PolynomialRidge::choose(&pairs.rows, MOST_DEGREE, FOLDS)?;
        // Where hardly a leg has another before it there is nothing to learn of those.
        let Ok((before, _)) = PolynomialRidge::choose(&pairs.unexplained(&own), MOST_DEGREE, FOLDS) else {
            return Ok((Self { own, before: None }, alone));
        };
        // What a leg's own part was to explain alone asked for another penalty than what is left to it.
        let (again, _) = PolynomialRidge::choose(&pairs.without(&before), MOST_DEGREE, FOLDS)?;
        let both = Self { own: again, before: Some(before) };
        let validation = both.validated(pairs)?;
        if validation.rmse < alone.rmse {
            Ok((both.refitted(pairs)?, validation))
        } else {
            Ok((Self { own, before: None }, alone))
        }
    }

    /// The same degrees and penalties, fitted to other rows.
    ///
    /// # Errors
    /// [`NoFit`].
    pub(super) fn refitted(&self, pairs: &Pairs) -> Result<Self, NoFit> {
        let of = |like: &PolynomialRidge, rows: &Rows| PolynomialRidge::of(rows, like.degree, like.penalty);
        let mut own = of(&self.own, &pairs.rows)?;
        let Some(before) = &self.before else { return Ok(Self { own, before: None }) };
        let mut fitted = before.clone();
        for _ in 0..PASSES {
            fitted = of(before, &pairs.unexplained(&own))?;
            own = of(&self.own, &pairs.without(&fitted))?;
        }
        Ok(Self { own, before: Some(fitted) })
    }

    /// The stress of a leg with `inputs` after one with those `before`.
    pub(super) fn value(&self, inputs: &[f64], before: Option<&[f64]>) -> f64 {
        let left = self.before.as_ref().zip(before).map_or(0.0, |(part, before)| part.value(before));
        self.own.value(inputs) + left
    }

    /// How well the same degrees and penalties tell the rows of each fold when fitted to those of all others.
    fn validated(&self, pairs: &Pairs) -> Result<Validation, NoFit> {
        let errors: Result<Vec<f64>, NoFit> = (0..FOLDS)
            .into_par_iter()
            .map(|fold| {
                let (seen, unseen) = pairs.split(FOLDS, fold);
                let fitted = self.refitted(&seen)?;
                let told = unseen.rows.inputs.iter().zip(&unseen.before);
                let errors = told.zip(&unseen.rows.values).map(|((inputs, before), value)| {
                    let error = value - fitted.value(inputs, before.as_deref());
                    error * error
                });
                Ok(errors.sum())
            })
            .collect();
        let values = &pairs.rows.values;
        Ok(Validation::of(FOLDS, errors?.iter().sum::<f64>() / values.len() as f64, values))
    }
}

impl Pairs {
    /// All trajectories but one in so many, the first of which is number `first`; and those.
    ///
    /// Trajectories are counted where the group changes from one row to the next.
    pub(super) fn split(&self, every: usize, first: usize) -> (Self, Self) {
        let (mut seen, mut unseen) = (Self::default(), Self::default());
        let (mut place, mut last) = (0, None);
        for (row, group) in self.rows.groups.iter().enumerate() {
            if last.is_some_and(|last| last != *group) {
                place += 1;
            }
            last = Some(*group);
            let part = if place % every == first { &mut unseen } else { &mut seen };
            part.rows.inputs.push(self.rows.inputs[row].clone());
            part.rows.values.push(self.rows.values[row]);
            part.rows.groups.push(*group);
            part.before.push(self.before[row].clone());
        }
        (seen, unseen)
    }

    /// All legs, and of their values what `before` does not explain.
    fn without(&self, before: &PolynomialRidge) -> Rows {
        let told = |leg: &Option<Vec<f64>>| leg.as_ref().map_or(0.0, |leg| before.value(leg));
        let values = self.rows.values.iter().zip(&self.before).map(|(value, leg)| value - told(leg)).collect();
        Rows { values, ..self.rows.clone() }
    }

    /// Of legs that have one before them: its inputs, and what `own` does not explain.
    fn unexplained(&self, own: &PolynomialRidge) -> Rows {
        let mut rows = Rows::default();
        for (row, before) in self.before.iter().enumerate() {
            let Some(before) = before else { continue };
            rows.inputs.push(before.clone());
            rows.values.push(self.rows.values[row] - own.value(&self.rows.inputs[row]));
            rows.groups.push(self.rows.groups[row]);
        }
        rows
    }
}
