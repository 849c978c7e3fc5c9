//! Floor 5, the verdict: metrics on tracks, specs, statistics. It knows poses in time and nothing of robots or planners.

mod apart;
mod assign;
mod deviation;
pub mod measure;
pub mod measures;
pub mod moves;
pub mod paired;
pub mod settings;
pub mod spec;
pub mod statistics;
mod stress;
pub mod verdict;

#[cfg(test)]
mod tests;

pub use measure::{deviation_of_samples, measure};
pub use measures::{AccelerationSource, Late, LegMeasures, LegSource, Measures};
pub use paired::{Median, SignedRank, holm, median, signed_rank};
pub use settings::{Clearance, JudgementError, Reference, Settings};
pub use spec::{Limits, Violation, violations};
pub use statistics::{Share, Statistics, rank_correlation, rule_of_three, share, skewness};
pub use stress::Stress;
pub use verdict::{Claim, Judged, Verdict, Worst, inconclusive, invalid, nothing_feasible, verdict};
