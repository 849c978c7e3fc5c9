//! Drives that stay clear of places to keep out of: the shortest of the ways around, and detours where none is clear.
//!
//! Clear means: the circle of [`footprint`] about the body's origin meets no place, at no point of the drive. Between
//! looks that is proven by what a curve of a given length may leave its chord by; on the ground it is the predicted
//! motion that is looked along.
//!
//! Order of attempts: the plain answer, every other known way around, detours over poses beside what is in the way.
//! What comes least near is the answer where none is clear, with the depth and the place.
//!
//! Neglected: the true outline of the vehicle. A circle that holds it whichever way it turns makes the question one of
//! a point and a distance, exact for turns in place and cautious for everything long and narrow. What is refused for
//! places may therefore still be drivable; what is called clear is so for the plane's motion, and on the ground for the
//! predicted one. Heights play no part.

mod detour;
mod generate;
mod ground;
mod hazards;
mod solve;
mod ways;

#[cfg(feature = "unit-tests")]
mod tests;

pub use generate::generate;
pub use ground::{Around, ClearedOnGround, motion, solve_on_ground};
pub use hazards::{Hazards, Intrusion, MotionCheck, footprint};
pub use solve::{Cleared, solve};
