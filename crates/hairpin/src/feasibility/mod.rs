//! Floor 5, the claim: limits, collision, reach sets, steering. Nothing of objectives, controllers or the judge.

pub mod reach;
