//! Time that this thread was on a processor: what others do on the machine does not count.

use std::hint::black_box;
use std::sync::OnceLock;
use std::time::Instant;

use hairpin_jobs::Watch;

/// What is told, for the table.
pub(crate) const NAME: &str = if cfg!(target_os = "linux") { "processor time" } else { "wall-clock time" };

pub(crate) fn warn_of_debug_build(watch: &dyn Watch) {
    if cfg!(debug_assertions) {
        watch.warn("Warning: this is no release build; its speeds mean nothing");
    }
}

/// Seconds on a processor since the thread began; where the system does not tell, since `origin`.
fn now(origin: Instant) -> f64 {
    let told = std::fs::read_to_string("/proc/thread-self/schedstat").ok();
    let nanoseconds = told.and_then(|text| text.split_whitespace().next()?.parse::<u64>().ok());
    nanoseconds.map_or_else(|| origin.elapsed().as_secs_f64(), |ns| ns as f64 * 1e-9)
}

/// The system tells this clock in ticks of some milliseconds: a run shorter than this many seconds is repeated.
const SHORTEST_RUN: f64 = 0.1;

/// Median over `times` runs of `work` of its time, s.
pub(crate) fn median_time<T>(times: usize, mut work: impl FnMut() -> T) -> f64 {
    1.0 / median_rate(times, || {
        black_box(work());
        1
    })
}

/// Median over `times` runs of `work`, which returns how many items it made, of items per second.
pub(crate) fn median_rate(times: usize, mut work: impl FnMut() -> u64) -> f64 {
    let origin = Instant::now();
    median((0..times).map(|_| {
        let (begun, mut items) = (now(origin), 0);
        loop {
            items += black_box(work());
            let spent = now(origin) - begun;
            if spent > SHORTEST_RUN {
                return items as f64 / spent;
            }
        }
    }))
}

/// Time on a processor since it was made.
pub(crate) struct Stopwatch {
    origin: Instant,
    begun: f64,
}

impl Stopwatch {
    pub(crate) fn start() -> Self {
        let origin = Instant::now();
        Self { origin, begun: now(origin) }
    }

    /// Seconds that are spent.
    pub(crate) fn spent(&self) -> f64 {
        now(self.origin) - self.begun
    }

    /// Whether more than `limit` seconds are spent. Asking often is cheap until so much has passed on the wall.
    pub(crate) fn passed(&self, limit: f64) -> bool {
        self.origin.elapsed().as_secs_f64() > limit && now(self.origin) - self.begun > limit
    }
}

/// Runs on this thread alone, so that its clock sees all of it.
pub(crate) fn alone<T: Send>(run: impl FnOnce() -> T + Send) -> T {
    match rayon::ThreadPoolBuilder::new().num_threads(1).use_current_thread().build() {
        Ok(pool) => pool.install(run),
        // The thread is in a pool already, that of an earlier bench.
        Err(_) => run(),
    }
}

/// The middle value, the upper one of two.
pub(crate) fn median(values: impl Iterator<Item = f64>) -> f64 {
    let mut values: Vec<f64> = values.collect();
    values.sort_by(f64::total_cmp);
    values[values.len() / 2]
}

/// Ticks of the system's clock of processes in a second, the same on every Linux.
const TICKS: f64 = 100.0;

/// Seconds on processors of all threads of this process, those that ended included; where the system does not tell, on
/// the wall.
pub(crate) fn process_time() -> f64 {
    static ORIGIN: OnceLock<Instant> = OnceLock::new();
    let told = std::fs::read_to_string("/proc/self/stat").ok().and_then(|text| {
        // The name, in brackets, may hold anything; user and system time are the 12th and 13th word behind it.
        let (_, behind) = text.rsplit_once(')')?;
        let mut words = behind.split_whitespace().skip(11);
        let mut ticks = || words.next()?.parse::<f64>().ok();
        Some((ticks()? + ticks()?) / TICKS)
    });
    told.unwrap_or_else(|| ORIGIN.get_or_init(Instant::now).elapsed().as_secs_f64())
}

/// Seconds on processors of all processes that this one started, and theirs, that have ended; `None` where the system
/// does not tell.
#[cfg(unix)]
pub(crate) fn children_time() -> Option<f64> {
    use nix::sys::resource::{UsageWho, getrusage};
    use nix::sys::time::TimeValLike;
    let usage = getrusage(UsageWho::RUSAGE_CHILDREN).ok()?;
    Some((usage.user_time() + usage.system_time()).num_microseconds() as f64 * 1e-6)
}

/// Seconds on processors of all processes that this one started, and theirs, that have ended; `None` where the system
/// does not tell.
#[cfg(not(unix))]
pub(crate) fn children_time() -> Option<f64> {
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    #[cfg(unix)]
    fn time_of_children_counts_when_they_end() {
        let before = children_time().unwrap();
        let work = "i=0; while [ $i -lt 100000 ]; do i=$((i+1)); done";
        std::process::Command::new("sh").args(["-c", work]).status().unwrap();
        assert!((0.01..20.0).contains(&(children_time().unwrap() - before)));
    }

    #[test]
    fn work_takes_time_of_the_process() {
        let (begun, origin) = (process_time(), Instant::now());
        // Longer than a tick, however fast the machine is.
        while process_time() - begun < 0.03 && origin.elapsed().as_secs() < 20 {
            black_box((0..100_000u64).fold(0, |sum, i| sum ^ black_box(i)));
        }
        assert!((0.03..5.0).contains(&(process_time() - begun)));
    }
}
