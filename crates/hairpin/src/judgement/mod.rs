//! Floor 5, the verdict: metrics on tracks, specs, statistics. It knows poses in time and nothing of robots or planners.

pub mod measures;

pub use measures::{AccelerationSource, LegMeasures, LegSource, Measures};
