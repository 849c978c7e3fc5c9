//! The gaps of a recording, in numbers and in words.

use std::fmt;

/// The longest time between two samples, and what of the plan it takes.
#[derive(Debug, Clone, PartialEq)]
pub struct Gap {
    /// Its first stamp, s.
    pub from: f64,
    /// How long it is, s.
    pub seconds: f64,
    /// Of how many times the median interval.
    pub ratio: f64,
    /// The first and the last move that it hides some of, from 0.
    pub moves: [usize; 2],
    /// Both by name.
    pub names: [String; 2],
    /// Share of the plan's time that it hides.
    pub share: f64,
}

/// What one recording does not show.
#[derive(Debug, Clone, PartialEq)]
pub struct Unseen {
    /// The longest gap.
    pub longest: Gap,
    /// Moves with a sample on them, of all.
    pub seen: [usize; 2],
    /// Why the recording decides nothing where it violates nothing; `None` where it does decide.
    pub open: Option<String>,
    /// The move whose arrival is the latest of those that are late wherever between two samples they were; `None`
    /// where none is proven to be late.
    pub late_proven: Option<usize>,
    /// Largest distance from the path that is not excluded between samples, where it is over the limit, m.
    pub not_excluded: Option<f64>,
}

impl fmt::Display for Gap {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let [first, last] = self.moves;
        write!(
            f,
            "a gap of {:.3} s from t = {:.3} s ({:.0} times the usual interval) hides ",
            self.seconds, self.from, self.ratio
        )?;
        if first == last {
            write!(f, "some of move {} ({})", first + 1, self.names[0])?;
        } else {
            write!(f, "moves {} ({}) to {} ({})", first + 1, self.names[0], last + 1, self.names[1])?;
        }
        write!(f, ", {:.0} % of the plan", 100.0 * self.share)
    }
}
