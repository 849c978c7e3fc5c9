//! Learned scores: the stress of executed legs, as a polynomial of what a search sees of them.
//!
//! Data flow: executed legs ([`LegSample`]) → own part and part of the leg before ([`ScoreModel::learn`]: degree and
//! penalty by cross-validation over trajectories) → a model file → `AnyScore`, by which any search ranks legs.
//! Resampled models (bootstrap) say how far to trust it.
//!
//! A model ranks; it does not predict what a controller will do elsewhere: it is checked against robot, controller
//! and world that it was learned on ([`ScoreModel::check`]).

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
