//! What came of one case.

use hairpin::campaign::CaseNumber;

/// What came of one case.
#[derive(Debug, Clone, PartialEq)]
pub enum Answer {
    /// It claims no witness.
    NothingClaimed,
    /// It was checked.
    Checked {
        /// Number of the case.
        case: CaseNumber,
        /// Whether it has a witness.
        witness: bool,
        /// Whether the rows of its planned motion were held to the witness: where the folder has them, and the witness
        /// holds.
        planned: bool,
        /// The largest end error over its legs, m; `None` where no witness could be read.
        position_m: Option<f64>,
        /// What does not hold.
        findings: Vec<String>,
    },
}

impl Answer {
    /// Whether all that was checked holds.
    pub(super) fn fine(&self) -> bool {
        matches!(self, Self::Checked { findings, .. } if findings.is_empty())
    }

    pub(super) fn is_checked(&self) -> bool {
        matches!(self, Self::Checked { .. })
    }

    /// Whether it was checked and has a witness.
    pub fn is_witnessed(&self) -> bool {
        matches!(self, Self::Checked { witness: true, .. })
    }
}
