//! What was found out, in words for people and as an object for machines.

use serde_json::Value;

/// What a measurement comes to.
#[derive(Debug, Clone, PartialEq)]
pub struct Findings {
    /// For people, in their order.
    pub words: Vec<Words>,
    /// The same for machines.
    pub object: Value,
    /// Whether everything that had to be met was; where nothing has to be, it was.
    pub met: bool,
}

/// A piece of what people read.
#[derive(Debug, Clone, PartialEq)]
pub enum Words {
    /// A line, or several.
    Text(String),
    /// Rows of cells, the first row is the header.
    Table(Vec<Vec<String>>),
}

impl Findings {
    /// What was measured without a bound.
    pub(crate) fn new(words: Vec<Words>, object: Value) -> Self {
        Self { words, object, met: true }
    }
}

impl Words {
    /// `lines`, each by itself.
    pub(crate) fn lines(lines: impl IntoIterator<Item = String>) -> impl Iterator<Item = Self> {
        lines.into_iter().map(Self::Text)
    }
}
