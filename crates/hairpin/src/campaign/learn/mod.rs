//! Learned scores: the stress of executed legs, as a polynomial of what a search sees of them.

mod fit;
mod kept;
mod legs;
mod model;
mod moves;
mod parts;
mod resample;
mod samples;
mod score;

pub use kept::{KeptModel, NAME};
pub(super) use kept::{of_arm, of_drive, of_flight, subject};
pub use legs::LegSample;
pub use model::{Feature, HeldOut, ModelMistake, ScoreModel, Subject};
pub use moves::{MoveFeatures, MoveSample};
pub(super) use samples::samples_of;
pub use samples::{learn, learn_moves, leg_samples, move_samples};
pub(super) use score::AnyScore;
