//! What the numbers of jobs may be, whoever hands them over: what is typed and what Python passes is refused alike.

use std::ops::RangeInclusive;

/// Threads: at most more than any machine has cores for; each takes memory, and graphs that are searched ahead.
pub const THREADS: RangeInclusive<i64> = 1..=1024;

/// Graphs that are sampled and searched to explain.
pub const GRAPHS: RangeInclusive<u64> = 1..=10_000;

/// How often a point of a heaviest path may come.
pub const VISITS: RangeInclusive<i64> = 1..=16;

/// Heaviest paths of one graph.
pub const PROGRAMS: RangeInclusive<i64> = 1..=1000;

/// Whole numbers of TOML end here, and the seed is written to scenario.toml.
pub const LARGEST_SEED: u64 = i64::MAX as u64;

/// Longest time, of a whole campaign in s (32 years), of a question to `steer` in ms (eleven days).
pub const LONGEST: f64 = 1e9;
