//! Continuous-curvature steering on flat ground, in closed form: the reference for lengths, and an answer to every query.

mod path;
mod turn;
mod words;

#[cfg(test)]
mod tests;

pub use path::{Gears, Path, every, steer};
