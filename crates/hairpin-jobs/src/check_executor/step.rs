//! One step of a check: what was said, and what is to be said of it.

use hairpin_formats::executor::{Failed, Transcript};

/// A sentence about a step.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Finding {
    /// What came of it.
    Fact(String),
    /// What works and could be better.
    Remark(String),
    /// What is against the protocol, or would cost runs.
    Mistake(String),
}

impl Finding {
    /// The word in files: `fact`, `remark`, `mistake`.
    pub fn word(&self) -> &'static str {
        match self {
            Self::Fact(_) => "fact",
            Self::Remark(_) => "remark",
            Self::Mistake(_) => "mistake",
        }
    }

    /// The sentence.
    pub fn sentence(&self) -> &str {
        match self {
            Self::Fact(sentence) | Self::Remark(sentence) | Self::Mistake(sentence) => sentence,
        }
    }
}

/// One step.
#[derive(Debug)]
pub struct Step {
    /// `handshake`, `mission`, `again`, `refusal`, `cancelled`, `speed`, `bye`.
    pub name: &'static str,
    /// What was found; nothing where it was not taken, for what came before.
    pub findings: Vec<Finding>,
    /// What was sent and received.
    pub transcript: Transcript,
    /// The end of what the program wrote to stderr.
    pub stderr: String,
}

impl Step {
    /// One in which nothing was found yet.
    pub(super) fn new(name: &'static str) -> Self {
        Self { name, findings: Vec::new(), transcript: Transcript::default(), stderr: String::new() }
    }

    /// The mistakes in it.
    pub fn mistakes(&self) -> impl Iterator<Item = &str> {
        self.findings.iter().filter(|finding| matches!(finding, Finding::Mistake(_))).map(Finding::sentence)
    }

    /// The word in files: `sound`, `mistake`, `not-checked`.
    pub fn word(&self) -> &'static str {
        match self.mistakes().next() {
            Some(_) => "mistake",
            None if self.findings.is_empty() => "not-checked",
            None => "sound",
        }
    }

    pub(super) fn fact(&mut self, sentence: impl Into<String>) {
        self.findings.push(Finding::Fact(sentence.into()));
    }

    pub(super) fn remark(&mut self, sentence: impl Into<String>) {
        self.findings.push(Finding::Remark(sentence.into()));
    }

    /// The same mistake is told once.
    pub(super) fn mistake(&mut self, sentence: impl Into<String>) {
        let mistake = Finding::Mistake(sentence.into());
        if !self.findings.contains(&mistake) {
            self.findings.push(mistake);
        }
    }

    /// A mission that was not flown.
    pub(super) fn failed(&mut self, failed: &Failed) {
        self.mistake(failed.in_full());
        self.stderr.clone_from(&failed.stderr);
    }
}
