//! The requirements of a generator of boundary-value drives: the source's test plan as its two tables, requirements and
//! tests.

mod answer;
mod anytime;
mod check;
mod dynamics;
mod example;
mod footprint;
mod interfaces;
mod plan;
mod regression;
mod reliability;
mod store;
mod subject;
mod suspension;

pub use answer::check;
pub(crate) use check::Check;
pub(crate) use plan::Measured;
pub(crate) use regression::{MEAN_MS, Times};
pub use store::write_regression;
pub use subject::{RequirementsSettings, TerrainSettings};
