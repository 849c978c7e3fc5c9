//! Whoever sits at the terminal, as jobs know them: Ctrl-C stops, bars and warnings stand on stderr.

use std::io::{self, IsTerminal};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

use hairpin::campaign::digits;
use hairpin_jobs::{Seen, Watch};
use indicatif::ProgressBar;

use crate::{console, interrupt};

/// The terminal that a command runs in.
#[derive(Default)]
pub(crate) struct Terminal {
    /// The bar that is seen, and what of.
    bar: Mutex<Option<(&'static str, ProgressBar)>>,
    /// What the runs came to that have landed.
    runs: Mutex<Runs>,
    /// When what is under way was begun and, where nobody sees a bar, told of last.
    lines: Mutex<Option<Lines>>,
}

/// Between two lines where stderr is no terminal.
const EVERY: Duration = Duration::from_secs(30);

/// Runs that have landed.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
struct Runs {
    flown: usize,
    violations: usize,
    /// The largest deviation, m.
    worst: Option<f64>,
    /// Whether it is told in millimetres.
    in_mm: bool,
}

impl Runs {
    fn add(&mut self, Seen { deviation, violates, in_mm }: Seen) {
        self.in_mm = in_mm;
        self.flown += 1;
        self.violations += usize::from(violates);
        self.worst = self.worst.into_iter().chain(deviation).reduce(f64::max);
    }

    /// `, 37 flown, 2 violations, worst 4.65 m`; nothing before the first has landed.
    fn in_words(self) -> String {
        if self.flown == 0 {
            return String::new();
        }
        let worst = self.worst.map_or(String::new(), |worst| match self.in_mm {
            true => format!(", worst {} mm", digits::number(Some(1e3 * worst))),
            false => format!(", worst {} m", digits::number(Some(worst))),
        });
        let violations = if self.violations == 1 { "violation" } else { "violations" };
        format!(", {} flown, {} {violations}{worst}", self.flown, self.violations)
    }
}

/// What is told line by line.
struct Lines {
    what: &'static str,
    /// How much was done when it was begun.
    before: usize,
    begun: Instant,
    told: Instant,
}

/// `execute: 37/100, 37 flown, 2 violations, worst 4.65 m, about 50 s left`.
fn line(what: &str, (before, done, of): (usize, usize, usize), runs: Runs, elapsed: Duration) -> String {
    let left = elapsed.as_secs_f64() * of.saturating_sub(done) as f64 / done.saturating_sub(before).max(1) as f64;
    let left = if done > before { format!(", about {left:.0} s left") } else { String::new() };
    format!("{what}: {done}/{of}{}{left}", runs.in_words())
}

impl Terminal {
    fn bar(&self) -> MutexGuard<'_, Option<(&'static str, ProgressBar)>> {
        self.bar.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn landed(&self) -> Runs {
        *self.runs.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// A line for whoever reads along in a log, `every` so often.
    fn tell(&self, what: &'static str, done: usize, of: usize, every: Duration) {
        let mut lines = self.lines.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        if lines.as_ref().is_none_or(|lines| lines.what != what) {
            *lines = Some(Lines { what, before: done, begun: now, told: now });
        }
        if let Some(lines) = lines.as_mut().filter(|lines| now - lines.told >= every) {
            lines.told = now;
            console::warn(&line(what, (lines.before, done, of), self.landed(), now - lines.begun));
        }
    }
}

impl Watch for Terminal {
    fn stopped(&self) -> bool {
        interrupt::asked()
    }

    fn seen(&self, run: Seen) {
        self.runs.lock().unwrap_or_else(PoisonError::into_inner).add(run);
    }

    fn progress(&self, what: &'static str, done: usize, of: usize) {
        if !io::stderr().is_terminal() {
            return self.tell(what, done, of, EVERY);
        }
        let mut seen = self.bar();
        if seen.as_ref().is_none_or(|(of_what, _)| *of_what != what) {
            *seen = Some((what, console::progress(what, of)));
        }
        if let Some((_, bar)) = seen.as_ref() {
            bar.set_length(of as u64);
            bar.set_prefix(self.landed().in_words());
            // Threads tell out of order.
            bar.set_position(bar.position().max(done as u64));
        }
    }

    fn finished(&self, _: &'static str) {
        // What comes next has runs of its own.
        *self.runs.lock().unwrap_or_else(PoisonError::into_inner) = Runs::default();
        if let Some((_, bar)) = self.bar().take() {
            bar.finish_and_clear();
        }
    }

    fn warn(&self, line: &str) {
        console::warn(line);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_says_how_far_it_is_and_what_was_seen() {
        let mut runs = Runs::default();
        assert_eq!(line("generate", (0, 0, 20), runs, Duration::ZERO), "generate: 0/20");
        runs.add(Seen { deviation: Some(0.3), violates: false, in_mm: false });
        runs.add(Seen { deviation: Some(4.651), violates: true, in_mm: false });
        runs.add(Seen { deviation: None, violates: false, in_mm: false });
        // 3 of 7 in 6 s: the other 4 take 8 s.
        assert_eq!(
            line("execute", (2, 5, 9), runs, Duration::from_secs(6)),
            "execute: 5/9, 3 flown, 1 violation, worst 4.65 m, about 8 s left"
        );
        // The unit is that of the verdict, however little it is.
        for (in_mm, words) in [(false, "worst 0.00120 m"), (true, "worst 1.20 mm")] {
            let mut runs = Runs::default();
            runs.add(Seen { deviation: Some(0.0012), violates: false, in_mm });
            assert!(runs.in_words().ends_with(words), "{}", runs.in_words());
        }
    }
}
