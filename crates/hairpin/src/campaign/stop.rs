//! How the caller's clock and Ctrl-C reach into jobs of a library that has neither.

/// A stop condition and a place to tell progress, both the caller's.
#[derive(Clone, Copy)]
pub struct Stop<'a> {
    /// Asked often and from any thread: whether to stop now and keep what is done.
    pub cancelled: &'a (dyn Fn() -> bool + Sync),
    /// Told now and then: how much is done, and of how much.
    pub progress: &'a (dyn Fn(usize, usize) + Sync),
    /// The caller's clock, s from any moment on, for limits that a scenario gives in seconds.
    pub clock: &'a (dyn Fn() -> f64 + Sync),
}

impl Stop<'static> {
    /// Never stops, tells nobody.
    pub fn never() -> Self {
        Self { cancelled: &|| false, progress: &|_, _| {}, clock: &|| 0.0 }
    }
}
