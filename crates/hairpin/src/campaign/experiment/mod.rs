//! What experiments are made of that is no scenario: families of questions, drawn by seed.

pub mod lift;
pub mod robtest;
