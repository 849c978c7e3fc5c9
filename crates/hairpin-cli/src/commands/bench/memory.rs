//! Memory of a long beam campaign: the peak of the whole process after `--minutes` of search.

use std::time::{Duration, Instant};

use hairpin::campaign::Stop;

use super::search::{on_one_thread, scenario};
use super::{Row, Target};
use crate::args::Bench;
use crate::problem::Problem;

pub(super) fn rows() -> Vec<Row> {
    let target = Some(Target::AtMost(300.0));
    vec![
        Row { name: "memory-peak", unit: "MB", target, measure: peak },
        Row { name: "memory-growth-in-second-half", unit: "MB", target: None, measure: growth },
    ]
}

/// Searches for `--minutes`; returns the resident memory half-way and at the end, and the peak, MB.
fn campaign(bench: &Bench) -> Result<[f64; 3], Problem> {
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

fn peak(bench: &Bench) -> Result<f64, Problem> {
    Ok(campaign(bench)?[2])
}

fn growth(bench: &Bench) -> Result<f64, Problem> {
    let [half, end, _] = campaign(bench)?;
    Ok(end - half)
}

/// A figure of the process's memory, MB; NaN where the system does not tell.
pub(in crate::commands) fn resident(which: &str) -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(which));
    line.and_then(|line| line.trim().trim_end_matches(" kB").trim().parse::<f64>().ok()).map_or(f64::NAN, |kb| kb / 1e3)
}
