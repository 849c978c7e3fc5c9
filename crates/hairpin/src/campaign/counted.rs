//! Who executes for a unit of a search, with what of it failed.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Mutex, PoisonError};

use super::answers::Answer;
use super::failures::Failures;
use super::{Batch, Case, Executor, Mission, Setup};
use crate::judgement::Measures;
use crate::trajectory::Flight;

/// An executor whose failures are counted, those of whoever was stopped left out: who is not waited for has failed at
/// nothing.
pub(super) struct Counted<'a> {
    executor: &'a dyn Executor,
    cancelled: &'a (dyn Fn() -> bool + Sync),
    failures: Mutex<Failures>,
    /// Whether one came to a flight.
    flown: AtomicBool,
}

impl<'a> Counted<'a> {
    pub(super) fn new(executor: &'a dyn Executor, cancelled: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { executor, cancelled, failures: Mutex::default(), flown: AtomicBool::new(false) }
    }

    /// What failed since it was last asked.
    pub(super) fn take(&self) -> Failures {
        std::mem::take(&mut *self.failures.lock().unwrap_or_else(PoisonError::into_inner))
    }

    /// Whether any execution came to a flight.
    pub(super) fn any_flown(&self) -> bool {
        self.flown.load(Ordering::Relaxed)
    }

    fn count(&self, why: Option<&str>) {
        let one = Failures { failed: 1, why: why.map(Into::into), ..Failures::default() };
        self.failures.lock().unwrap_or_else(PoisonError::into_inner).add(one);
    }

    /// [`Executor::carry_out`], of which what others executed counts as well, but for what `is_known` from before.
    pub(super) fn carry_out_but(&self, batch: &Batch, is_known: &dyn Fn(&[u8; 16]) -> bool) -> Vec<Option<Answer>> {
        let here: Vec<AtomicBool> = batch.names.iter().map(|_| AtomicBool::new(false)).collect();
        let execute = |place: usize| {
            here[place].store(true, Ordering::Relaxed);
            (batch.execute)(place)
        };
        let answers = self.executor.carry_out(&Batch { execute: &execute, ..*batch });
        for ((answer, here), name) in answers.iter().zip(&here).zip(batch.names) {
            if matches!(answer, Some(None)) && !here.load(Ordering::Relaxed) && !is_known(name) {
                self.count(None);
            }
        }
        answers
    }
}

impl Executor for Counted<'_> {
    fn fly(&self, nominal: &Setup, case: &Case, mission: &Mission) -> Result<Flight, String> {
        self.executor.fly(nominal, case, mission)
    }

    fn carry_out(&self, batch: &Batch) -> Vec<Option<Answer>> {
        self.carry_out_but(batch, &|_| false)
    }

    fn measured(&self, measures: &Measures, violates: bool) {
        self.executor.measured(measures, violates);
    }

    fn ended(&self, outcome: Result<(), &str>) {
        match outcome {
            Ok(()) => self.flown.store(true, Ordering::Relaxed),
            Err(_) if (self.cancelled)() => {}
            Err(why) => self.count(Some(why)),
        }
        self.executor.ended(outcome);
    }

    fn is_ours(&self) -> bool {
        self.executor.is_ours()
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::campaign::OwnSimulator;

    #[test]
    fn what_failed_is_counted_in_any_order_and_once() {
        let stopped = AtomicBool::new(false);
        let cancelled = || stopped.load(Ordering::Relaxed);
        let counted = Counted::new(&OwnSimulator, &cancelled);
        for outcome in [Ok(()), Err("b"), Err("a"), Err("c")] {
            counted.ended(outcome);
        }
        assert_eq!(counted.take(), Failures { failed: 3, why: Some("a".into()), ..Failures::default() });
        stopped.store(true, Ordering::Relaxed);
        counted.ended(Err("stopped"));
        assert!(counted.take().is_none());
    }

    /// Who has a batch carried out by others, and what is known of it from before.
    struct Elsewhere;

    impl Executor for Elsewhere {
        fn fly(&self, _nominal: &Setup, _case: &Case, _mission: &Mission) -> Result<Flight, String> {
            Err("not here".into())
        }

        fn carry_out(&self, batch: &Batch) -> Vec<Option<Answer>> {
            batch
                .names
                .iter()
                .enumerate()
                .map(|(place, _)| if place == 0 { (batch.execute)(0) } else { Some(None) })
                .collect()
        }
    }

    #[test]
    fn what_failed_elsewhere_counts_without_words() {
        let counted = Counted::new(&Elsewhere, &|| false);
        let batch = Batch { names: &[[0; 16], [1; 16], [2; 16]], execute: &|_| Some(None) };
        assert_eq!(counted.carry_out_but(&batch, &|name| *name == [2; 16]).len(), 3);
        assert_eq!(counted.take(), Failures { failed: 1, ..Failures::default() });
    }
}
