//! What came of a check.

use hairpin::judgement::Verdict;
use hairpin_formats::executor::Greeting;

use super::compared::Difference;
use super::speed::Speed;
use super::step::Step;

/// What came of it.
#[derive(Debug)]
pub struct Checked {
    /// What the program says of itself, if it has.
    pub greeting: Option<Greeting>,
    /// In the order in which they were taken.
    pub steps: Vec<Step>,
    /// How far flights of the same mission are from the first one: by the same process, by another.
    pub again: [Option<Difference>; 2],
    /// How fast it is, where it flew.
    pub speed: Option<Speed>,
    /// PASS, or EXECUTOR FAILED with the first mistake.
    pub verdict: Verdict,
}
