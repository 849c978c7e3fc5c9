//! Floor 5, the claim: limits, collision, reach sets, steering. Nothing of objectives, controllers or the judge.

pub mod certify;
pub mod collision;
pub mod limits;
pub mod program;
pub mod reach;
pub mod reachability;
pub mod steering;

pub use certify::{Certificate, Impossible, certify};
pub use collision::FreeSpace;
pub use limits::{Infeasible, Limit, Limits};
