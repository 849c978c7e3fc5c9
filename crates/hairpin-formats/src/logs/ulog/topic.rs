//! Topics of a ULog that are read, by name.

use super::formats::{Formats, Slot};

/// A sample's stamp may lie this far before the message's; else it is none, s.
const LONGEST_DELAY: f64 = 1.0;

/// Looks for a topic's fields.
pub(super) struct Finder<'f> {
    pub(super) formats: &'f Formats,
    pub(super) name: &'f str,
}

impl Finder<'_> {
    pub(super) fn slot(&self, path: &str) -> Option<Slot> {
        self.element(path, 0)
    }

    pub(super) fn element(&self, path: &str, element: usize) -> Option<Slot> {
        self.formats.slot(self.name, path, element)
    }

    pub(super) fn needed(&self, path: &str) -> Result<Slot, String> {
        self.slot(path).ok_or_else(|| format!("`{}` has no field `{path}`", self.name))
    }

    /// All of them, or none.
    pub(super) fn slots<const N: usize>(&self, paths: [&str; N]) -> Option<[Slot; N]> {
        let found: Vec<Slot> = paths.iter().filter_map(|path| self.slot(path)).collect();
        found.try_into().ok()
    }

    /// The elements of an array, or the fields of these names where there is none.
    pub(super) fn array<const N: usize>(&self, path: &str, paths: [&str; N]) -> Option<[Slot; N]> {
        let found: Vec<Slot> = (0..N).filter_map(|place| self.element(path, place)).collect();
        found.try_into().ok().or_else(|| self.slots(paths))
    }
}

/// Seconds of microseconds: when the raw data was taken, where that is told and could be, else when it was published.
pub(super) fn seconds(stamp: f64, sample: Option<f64>) -> f64 {
    let near = |sample: &f64| *sample > 0.0 && *sample <= stamp && stamp - sample <= LONGEST_DELAY * 1e6;
    sample.filter(near).unwrap_or(stamp) * 1e-6
}
