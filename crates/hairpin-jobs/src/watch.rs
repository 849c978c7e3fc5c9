//! How whoever runs a job stops it and sees how far it is: Ctrl-C, progress bars and warnings are implementations of
//! the caller's.

use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::mpsc::{RecvTimeoutError, sync_channel};
use std::thread;
use std::time::{Duration, Instant};

use hairpin::campaign::UserCode;

/// Whoever runs a job. Asked and told from any thread.
pub trait Watch: Sync {
    /// Whether to stop now: what is done is kept. Asked often.
    fn stopped(&self) -> bool {
        false
    }

    /// `done` of `of` steps of `what` are done.
    fn progress(&self, what: &'static str, done: usize, of: usize) {
        let _ = (what, done, of);
    }

    /// A run has landed, before its step is told of as done.
    fn seen(&self, run: Seen) {
        let _ = run;
    }

    /// `what` goes no further, all of it done or not.
    fn finished(&self, what: &'static str) {
        let _ = what;
    }

    /// A line for the user beside the result.
    fn warn(&self, line: &str) {
        let _ = line;
    }
}

/// Nobody: nothing stops the job, and nobody is told anything.
#[derive(Debug, Clone, Copy, Default)]
pub struct Unwatched;

impl Watch for Unwatched {}

/// A watch that asks to stop at a deadline as well.
pub(crate) struct Until<'a> {
    pub(crate) watch: &'a dyn Watch,
    pub(crate) end: Deadline,
}

impl Watch for Until<'_> {
    fn stopped(&self) -> bool {
        self.watch.stopped() || self.end.passed()
    }

    fn progress(&self, what: &'static str, done: usize, of: usize) {
        self.watch.progress(what, done, of);
    }

    fn seen(&self, run: Seen) {
        self.watch.seen(run);
    }

    fn finished(&self, what: &'static str) {
        self.watch.finished(what);
    }

    fn warn(&self, line: &str) {
        self.watch.warn(line);
    }
}

/// What a run came to that has landed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seen {
    /// The largest deviation, m; `None` where it was not measured.
    pub deviation: Option<f64>,
    /// Whether it violates the specification.
    pub violates: bool,
    /// Whether its verdict is told in millimetres, as an arm's is.
    pub in_mm: bool,
}

/// The steps of a job as its watch is told of them, until this is dropped.
pub(crate) struct Steps<'a> {
    watch: &'a dyn Watch,
    what: &'static str,
    of: usize,
    done: AtomicUsize,
}

impl<'a> Steps<'a> {
    /// `done` of `of` steps are done already.
    pub(crate) fn new(watch: &'a dyn Watch, what: &'static str, done: usize, of: usize) -> Self {
        watch.progress(what, done, of);
        Self { watch, what, of, done: AtomicUsize::new(done) }
    }

    /// One more.
    pub(crate) fn step(&self) {
        let done = self.done.fetch_add(1, Ordering::Relaxed) + 1;
        self.watch.progress(self.what, done, self.of);
    }
}

impl Drop for Steps<'_> {
    fn drop(&mut self) {
        self.watch.finished(self.what);
    }
}

/// A time limit in wall-clock seconds.
#[derive(Debug, Clone, Copy)]
pub struct Deadline(Option<Instant>);

impl Deadline {
    /// `seconds` from now; never without.
    pub fn after(seconds: Option<f64>) -> Self {
        Self::since(Instant::now(), seconds)
    }

    /// `seconds` after `begun`; never without.
    pub(crate) fn since(begun: Instant, seconds: Option<f64>) -> Self {
        let duration = seconds.and_then(|s| Duration::try_from_secs_f64(s).ok());
        Self(duration.and_then(|duration| begun.checked_add(duration)))
    }

    /// The earlier of the two.
    pub(crate) fn or_before(self, other: Self) -> Self {
        match (self.0, other.0) {
            (Some(one), Some(other)) => Self(Some(one.min(other))),
            (one, other) => Self(one.or(other)),
        }
    }

    /// Whether it is over.
    pub fn passed(self) -> bool {
        self.0.is_some_and(|end| Instant::now() >= end)
    }
}

/// Between two questions whether an answer of the user's score is still wanted.
const POLL: Duration = Duration::from_millis(20);

/// Does `work`, which may ask `code`. What that takes for an answer is not up to us; what is waited for it is.
pub(crate) fn not_waiting_for<T>(
    code: &[(&str, &dyn UserCode)],
    watch: &dyn Watch,
    deadline: Deadline,
    work: impl FnOnce() -> T,
) -> T {
    if code.is_empty() {
        return work();
    }
    thread::scope(|scope| {
        // Closes with the work, however that ends.
        let (_at_work, done) = sync_channel::<()>(0);
        scope.spawn(move || {
            while done.recv_timeout(POLL) == Err(RecvTimeoutError::Timeout) {
                if watch.stopped() || deadline.passed() {
                    return code.iter().for_each(|(_, user)| user.stop());
                }
            }
        });
        work()
    })
}

#[cfg(test)]
mod tests {
    use std::sync::Mutex;

    use super::*;

    #[derive(Default)]
    struct Told(Mutex<Vec<String>>);

    impl Watch for Told {
        fn progress(&self, what: &'static str, done: usize, of: usize) {
            self.0.lock().unwrap().push(format!("{what} {done}/{of}"));
        }

        fn finished(&self, what: &'static str) {
            self.0.lock().unwrap().push(format!("{what} ends"));
        }
    }

    #[test]
    fn steps_are_told_from_the_first_to_the_end() {
        let told = Told::default();
        let steps = Steps::new(&told, "fly", 2, 4);
        steps.step();
        drop(steps);
        assert_eq!(told.0.into_inner().unwrap(), ["fly 2/4", "fly 3/4", "fly ends"]);
    }

    #[test]
    fn without_seconds_there_is_no_deadline() {
        assert!(!Deadline::after(None).passed());
        assert!(!Deadline::after(Some(1e300)).passed());
        assert!(Deadline::after(Some(0.0)).passed());
    }
}
