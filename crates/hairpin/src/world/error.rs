//! Why numbers make no world.

use thiserror::Error;

/// Why numbers make no world. `field` is the key below `[world]`.
///
/// The one error of everything that stands in a world: keep-outs and regions of cells raise it with their own keys.
#[derive(Debug, Clone, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct WorldError {
    /// Key below `world`, such as `obstacles[2].box.size_m`.
    pub field: String,
    /// The offending value as it was given.
    pub value: String,
    /// What it must be.
    pub bound: String,
}

impl WorldError {
    /// A mistake in `field`.
    pub(crate) fn new(field: impl Into<String>, value: impl Into<String>, bound: impl Into<String>) -> Self {
        Self { field: field.into(), value: value.into(), bound: bound.into() }
    }

    /// The same mistake in the table `prefix`: `box.size_m` becomes `obstacles[2].box.size_m`.
    pub fn within(mut self, prefix: &str) -> Self {
        self.field = format!("{prefix}.{}", self.field);
        self
    }
}
