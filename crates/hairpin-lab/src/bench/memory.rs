//! Memory of a long beam campaign: the peak of the whole process after `--minutes` of search.

use std::time::{Duration, Instant};

use hairpin::campaign::Stop;
use hairpin_jobs::Problem;

use super::row::{BenchSettings, Row};
use super::search::{on_one_thread, scenario};
use crate::memory::resident;

pub(super) fn rows() -> Vec<Row> {
    vec![Row::at_most("memory-peak", "MB", 300.0, peak), Row::unbound("memory-growth-in-second-half", "MB", growth)]
}

/// Searches for `--minutes`; returns the resident memory half-way and at the end, and the peak, MB.
fn campaign(bench: &BenchSettings) -> Result<[f64; 3], Problem> {
    if !(bench.minutes > 0.0 && bench.minutes <= 1440.0) {
        return Err(Problem::input(format!("--minutes {}: must be above 0 and at most 1440", bench.minutes)));
    }
    // The longest trajectories: with shorter ones a million cases would be full too soon.
    let setup = scenario(50, false, 1_000_000)?;
    let (begun, whole) = (Instant::now(), Duration::from_secs_f64(60.0 * bench.minutes));
    let half = std::sync::OnceLock::new();
    let cancelled = || {
        if begun.elapsed() > whole / 2 {
            half.get_or_init(|| resident("VmRSS:"));
        }
        begun.elapsed() > whole
    };
    on_one_thread(&setup, &Stop { cancelled: &cancelled, progress: &|_, _| (), clock: &|| 0.0 });
    Ok([half.get().copied().unwrap_or(f64::NAN), resident("VmRSS:"), resident("VmHWM:")])
}

fn peak(bench: &BenchSettings) -> Result<f64, Problem> {
    Ok(campaign(bench)?[2])
}

fn growth(bench: &BenchSettings) -> Result<f64, Problem> {
    let [half, end, _] = campaign(bench)?;
    Ok(end - half)
}
