//! What was measured, and what it is held to.

/// A measured value in words, its bound, and whether it keeps it.
#[derive(Debug, Clone)]
pub(crate) struct Check {
    pub(crate) measured: String,
    pub(crate) bound: String,
    pub(crate) passed: bool,
}

/// A test of the results document.
#[derive(Debug, Clone)]
pub(crate) struct Test {
    pub(crate) id: &'static str,
    /// The requirement that it covers.
    pub(crate) requirement: &'static str,
    pub(crate) what: String,
    pub(crate) check: Check,
}

impl Test {
    /// A test by its name in the document.
    pub(super) fn new(id: &'static str, requirement: &'static str, what: impl Into<String>, check: Check) -> Self {
        Self { id, requirement, what: what.into(), check }
    }
}

impl Check {
    pub(super) fn new(measured: String, bound: impl Into<String>, passed: bool) -> Self {
        Self { measured, bound: bound.into(), passed }
    }

    /// What the tests named `ids` found together.
    pub(super) fn of(ids: &[&str], tests: &[Test]) -> Self {
        let found: Vec<&Check> =
            ids.iter().filter_map(|id| tests.iter().find(|test| test.id == *id)).map(|test| &test.check).collect();
        let joined = |text: fn(&Check) -> &str| found.iter().map(|check| text(check)).collect::<Vec<_>>().join("; ");
        Self {
            measured: joined(|check| &check.measured),
            bound: joined(|check| &check.bound),
            passed: found.len() == ids.len() && found.iter().all(|check| check.passed),
        }
    }
}

/// Share in per cent.
pub(super) fn percent(part: usize, of: usize) -> f64 {
    100.0 * part as f64 / of.max(1) as f64
}
