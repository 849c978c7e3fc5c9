//! Learned scores: the stress of executed legs, as a polynomial of what a search sees of them.

mod feature;
mod fit;
mod leg_stress;
mod legs;
mod model;
mod moves;
mod resample;
mod score;

pub use feature::Feature;
pub use legs::LegSample;
pub use model::{HeldOut, ModelMistake, ScoreModel};
pub use moves::{MoveFeatures, MoveSample};
pub(super) use score::AnyScore;

/// Name of the model's file in a campaign folder.
pub const NAME: &str = "score-model.json";
