//! How the largest stress that was executed grew with the number of executions.

use serde::{Deserialize, Serialize};

/// The largest stress executed so far, of one graph.
///
/// A step function, kept by its steps: a hundred thousand executions have a few dozen.
#[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
pub struct Curve {
    /// Number of the graph.
    pub graph: u64,
    /// Executions in it.
    pub executions: u64,
    /// Where it rose: number of the execution, counted from 1, and the stress that it came to.
    /// Both rise strictly.
    pub rises: Vec<(u64, f64)>,
}

impl Curve {
    /// The curve of graph number `graph`, whose largest stress after execution number i + 1 was `best_so_far[i]`; −∞
    /// where none had succeeded yet.
    pub fn of(graph: u64, best_so_far: &[f64]) -> Self {
        let mut curve = Self { graph, ..Self::default() };
        for &stress in best_so_far {
            curve.push(Some(stress));
        }
        curve
    }

    /// Adds an execution; `None` for one that failed.
    ///
    /// What is not finite counts as a failed one. Every call counts one execution.
    pub fn push(&mut self, stress: Option<f64>) {
        self.executions += 1;
        let Some(stress) = stress.filter(|stress| stress.is_finite()) else { return };
        if self.rises.last().is_none_or(|(_, most)| stress > *most) {
            self.rises.push((self.executions, stress));
        }
    }

    /// The largest stress after so many executions; `None` before the first that succeeded, and beyond the last.
    pub fn after(&self, executions: u64) -> Option<f64> {
        let rises = self.rises.partition_point(|(at, _)| *at <= executions);
        let (_, stress) = self.rises.get(rises.checked_sub(1)?)?;
        (executions <= self.executions).then_some(*stress)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn only_rises_are_kept_and_tell_the_whole_curve() {
        let so_far = [f64::NEG_INFINITY, 1.5, 1.5, 2.0, 2.0];
        let curve = Curve::of(7, &so_far);
        assert_eq!(curve, Curve { graph: 7, executions: 5, rises: vec![(2, 1.5), (4, 2.0)] });
        for (place, stress) in so_far.iter().enumerate().skip(1) {
            assert_eq!(curve.after(place as u64 + 1), Some(*stress));
        }
        assert_eq!((curve.after(0), curve.after(1), curve.after(6)), (None, None, None));
        let mut failed = Curve::default();
        failed.push(None);
        assert_eq!((failed.executions, failed.after(1)), (1, None));
    }
}
