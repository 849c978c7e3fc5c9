//! Inequations over x, y, z in the user's own words: `x^2 + y^2 < 190^2 and z < 480`.
//!
//! Data flow: text → tokens → a tree of terms and comparisons (once) → evaluated over numbers, intervals or centred
//! forms (often). Numbers are in the text's own unit; points come in m and are scaled.

mod condition;
mod parser;

use self::condition::Condition;
use crate::math::outward::{Interval, Real};

pub use parser::WordsError;

/// A condition on a point, understood once and evaluated often.
///
/// ```
/// use hairpin::world::cell::Words;
///
/// // Millimetres, as a cell's file has them; points are in m.
/// let words = Words::parse("x^2 + y^2 < 190^2 and z < 480", 1000.0)?;
/// assert!(words.holds([0.1, 0.1, 0.3]) && !words.holds([0.1, 0.1, 0.5]));
/// let mistake = Words::parse("x < < 3", 1000.0).unwrap_err();
/// assert_eq!(mistake.column, 5);
/// # Ok::<(), hairpin::world::cell::WordsError>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Words {
    text: String,
    /// How many of the text's units make a metre.
    per_metre: f64,
    condition: Condition,
}

impl Words {
    /// Understands `text`, whose x, y, z are in a unit of which `per_metre` make a metre (1000 for mm).
    ///
    /// At most 1000 tokens and 100 nested parentheses, exponents whole and up to 64. A chain a < b < c is (a < b) and
    /// (b < c).
    ///
    /// # Errors
    /// [`WordsError`] with the column.
    pub fn parse(text: &str, per_metre: f64) -> Result<Self, WordsError> {
        Ok(Self { text: text.to_owned(), per_metre, condition: parser::condition(text)? })
    }

    /// As it was written.
    pub fn text(&self) -> &str {
        &self.text
    }

    /// Whether the words are true at a point, m, in floating point.
    ///
    /// A comparison with a value that is no number (0/0) is undecided, and so is `not` of it: neither holds.
    pub fn holds(&self, p: [f64; 3]) -> bool {
        self.condition.at(&p.map(|c| c * self.per_metre), &|less: f64, or_equal| {
            (!less.is_nan()).then_some(if or_equal { less <= 0.0 } else { less < 0.0 })
        }) == Some(true)
    }

    /// Whether the words are true at every point (`Some(true)`) or at none (`Some(false)`) of the enclosed ones, m;
    /// proofs both.
    ///
    /// Kleene's three-valued logic over the bounds of each difference left − right: `None` is "not decided on this
    /// enclosure", and smaller ones may be. √ of what is below 0 counts as √0, as everywhere in
    /// [`crate::math::outward`].
    pub fn holds_on<N: Real + Bounded>(&self, p: [N; 3]) -> Option<bool> {
        self.condition.at(&p.map(|c| c * N::constant(self.per_metre)), &|less: N, or_equal| {
            let Interval { low, high } = less.bounds();
            if high < 0.0 || (or_equal && high <= 0.0) {
                Some(true)
            } else if low > 0.0 || (!or_equal && low >= 0.0) {
                Some(false)
            } else {
                None
            }
        })
    }
}

/// What has bounds.
pub trait Bounded {
    /// Lower and upper bound.
    fn bounds(&self) -> Interval;
}

impl Bounded for Interval {
    fn bounds(&self) -> Interval {
        *self
    }
}

impl Bounded for crate::math::outward::Centred {
    fn bounds(&self) -> Interval {
        self.bounds()
    }
}
