//! Whether a robot can do what a mission made elsewhere asks of it.

use super::Setup;
use super::passage::{Demands, Passage};

/// What the claim of the robot of `setup` says of what is asked: a witness, or what breaks, leg by leg.
///
/// # Errors
/// A kind of robot that is not asked for missions, or numbers that nothing can be claimed of, in a sentence's part.
pub fn passes(setup: &Setup, asked: &Demands) -> Result<Passage, String> {
    setup.kind().passes(asked)
}
