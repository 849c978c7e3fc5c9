//! How the caller's clock and Ctrl-C reach into jobs of a library that has neither.

/// A stop condition and a place to tell progress, both the caller's.
///
/// Plain borrowed closures, so that a library caller, a terminal and Python each have their own. A job that is
/// cancelled returns what it has, with a word that says so; nothing is an error because of it.
///
/// ```
/// use hairpin::campaign::Stop;
/// use std::sync::atomic::{AtomicBool, Ordering};
///
/// let ctrl_c = AtomicBool::new(false);
/// let stop = Stop { cancelled: &|| ctrl_c.load(Ordering::Relaxed), ..Stop::never() };
/// assert!(!(stop.cancelled)());
/// ctrl_c.store(true, Ordering::Relaxed);
/// assert!((stop.cancelled)());
/// ```
#[derive(Clone, Copy)]
pub struct Stop<'a> {
    /// Asked often and from any thread: whether to stop now and keep what is done.
    /// Once it has said yes it should go on saying so; it must be quick, and must not call back into the job.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Told now and then: how much is done, and of how much.
    /// What is counted is the job's: cases, runs or executions. It may come out of order from several threads.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
    /// The caller's clock, s from any moment on, for limits that a scenario gives in seconds.
    /// Only differences are used. A result that depends on it says so: the search was stopped.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
}

impl Stop<'static> {
    /// Never stops, tells nobody.
    ///
    /// Its clock stands at one moment, so that a limit in seconds is never come to.
    pub fn never() -> Self {
        Self { cancelled: &|| false, progress: &|_, _| {}, clock: &|| 0.0 }
    }
}
