//! What a case is called.

use std::fmt;
use std::num::ParseIntError;
use std::str::FromStr;

use serde::{Deserialize, Serialize};

/// Number of a case in its campaign, counted from 0; in words and names of files `0117`, at least four digits.
///
/// ```
/// use hairpin::campaign::CaseNumber;
///
/// assert_eq!(CaseNumber(117).to_string(), "0117");
/// assert_eq!("0117".parse(), Ok(CaseNumber(117)));
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash, Default, Serialize, Deserialize)]
#[serde(transparent)]
pub struct CaseNumber(pub usize);

impl CaseNumber {
    /// What the program of an arm's case is called: a controller loads no two of one name.
    pub(super) fn of_program(self) -> String {
        format!("hairpin_{self}")
    }
}

impl fmt::Display for CaseNumber {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:04}", self.0)
    }
}

impl FromStr for CaseNumber {
    type Err = ParseIntError;

    fn from_str(text: &str) -> Result<Self, ParseIntError> {
        text.parse().map(Self)
    }
}
