//! A campaign on several machines: it is planned, each machine makes a share of its parts, and they are merged into the
//! folder that one machine would have made.
//!
//! | file | does |
//! | --- | --- |
//! | `plan` | divides the work of a search into parts, once and for all |
//! | `shard` | which parts a machine makes, as it was told or as its scheduler says |
//! | `part` | makes one part, a small campaign folder, and tells whether one is whole |
//! | `merge` | takes the parts over in their order, and does what is left to do |
//!
//! Parts are fixed by the plan, so that neither the number of shards nor their order has a say; a shard only chooses
//! which it makes. They are put in place whole by one rename.

mod merge;
mod part;
mod plan;
mod run;
mod shard;
#[cfg(test)]
mod tests;

pub use merge::{Merged, merge};
pub use plan::{Plan, PlanSettings, Unit, plan};
pub use run::{Ran, run_shard};
pub use shard::{Shard, shard_from_env};
