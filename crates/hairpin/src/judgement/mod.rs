//! Floor 5, the verdict: metrics on tracks, specs, statistics. It knows poses in time and nothing of robots or
//! planners.
//!
//! Data flow, the same for a simulation, an executor of the user's and a real log:
//!
//! ```text
//! Track + waypoints + Settings ─ measure ─▶ Measures ─ violations(Limits) ─▶ Violation, gravest first
//!                                              │
//!                                              └ Stress: the one number that a search or a model is about
//! cases of a campaign ─ share (as they were chosen), statistics ─▶ verdict: one sentence, one exit code
//! two sets of runs ─ paired: signed rank, medians, Holm ─▶ whether one is worse than chance has it
//! a log, and the robot's bounds ─ look_closely ─▶ what no moment between samples exceeds
//! an arm's recordings + PlannedPath ─ moves ─▶ each move: deviation, lateness, trend, regression
//! ```
//!
//! Nothing here asks how a motion came about: the judge gets obstacles as a distance function and a reference as
//! points, so that what judges our simulator judges hardware. Larger is worse, but for clearances and margins. Maxima
//! are over samples; what may hide between them is bounded by how fast the robot can be (`between`, `swiftness`), which
//! a log needs and a simulation does not.

mod apart;
mod assign;
pub mod between;
mod carried_on;
mod chosen;
mod deviation;
pub mod measure;
pub mod measures;
pub mod moves;
mod narrow;
pub mod paired;
mod quantile;
mod repeats;
mod resolution;
pub mod settings;
pub mod spec;
pub mod statistics;
mod stress;
mod swiftness;
mod unmeasured;
pub mod verdict;

#[cfg(feature = "unit-tests")]
mod tests;

pub use apart::{decimals_of, told, told_outward};
pub(crate) use between::where_least;
pub use between::{Around, Close, beyond, longest_mean, look_closely, most_anywhere, most_between};
pub use chosen::Chosen;
pub use measure::{deviation_of_samples, legs_of_samples, measure};
pub use measures::{Late, LegMeasures, LegSource, Measures, Missing};
pub use paired::{Median, SignedRank, holm, median, signed_rank};
pub use quantile::{Quantile, exceeded_by};
pub use repeats::repeats;
pub use resolution::{AccelerationSource, Resolution, SEEN_WITHIN_S, Step, TELLING, Unresolved, is_seen};
pub use settings::{Clearance, JudgementError, Reference, Settings};
pub use spec::{Limits, Violation, exceeded, nearest, still_since, violations};
pub use statistics::{
    SIGMA_95, Share, Statistics, cases_needed, mean_interval, rank_correlation, rule_of_three, share, skewness,
    student_quantile,
};
pub use stress::Stress;
pub use swiftness::Swiftness;
pub use verdict::{
    Beside, Claim, Judged, Verdict, Worst, finding, inconclusive, invalid, is_command, nothing_feasible,
    search_in_vain, unjudged, verdict, violated, within_spec,
};
