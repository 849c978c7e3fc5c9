//! The memory of processes, by the system's account.

/// A figure of this process's memory, such as `VmRSS:`, MB; NaN where the system does not tell.
pub(crate) fn resident(which: &str) -> f64 {
    resident_of("self", which)
}

/// The same of another process by its number; NaN as well where it has ended.
pub(crate) fn resident_of(process: &str, which: &str) -> f64 {
    let status = std::fs::read_to_string(format!("/proc/{process}/status")).unwrap_or_default();
    let line = status.lines().find_map(|line| line.strip_prefix(which));
    line.and_then(|line| line.trim().trim_end_matches(" kB").trim().parse::<f64>().ok()).map_or(f64::NAN, |kb| kb / 1e3)
}
