//! Code of the user's own that a search asks, wherever it runs.

/// What is asked for numbers. The same question gets the same answer whenever, and in whatever company, it is asked.
pub trait UserCode: Send + Sync {
    /// Why there are no answers, if that has happened.
    fn trouble(&self) -> Option<String>;

    /// Sees whether there will be answers at all, before any is asked for.
    ///
    /// # Errors
    /// As [trouble](Self::trouble); it was [stopped](Self::stop).
    fn try_out(&self) -> Result<(), String>;

    /// Waits for no answer any more: what is being asked, and what is asked from now on, gets NaN.
    /// For good: nothing starts it again.
    fn stop(&self);
}
