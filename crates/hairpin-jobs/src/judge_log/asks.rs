//! What a log leaves to its user to say, and how each command takes it.

/// How a command is told what no log tells.
pub(crate) struct Asks {
    /// Which of several topics is meant.
    pub(crate) topic: &'static str,
    /// Which of several cases was flown.
    pub(crate) case: &'static str,
}

impl Asks {
    /// `judge LOG`.
    pub(crate) const JUDGE: Self = Self { topic: "--source TOPIC says which", case: "--case ID says which" };
    /// `fit LOGS`, which has no flag for either.
    pub(crate) const FIT: Self = Self {
        topic: "`fit` reads logs in which no other is",
        case: "a log that is called after its case, as 0001-0.csv or 0001.mcap, is of that one",
    };
}
