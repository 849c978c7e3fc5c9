//! Spans in which a source says that it is not valid, as its samples come.

use super::log::Span;

/// Spans from the first sample that is not valid to the next one that is.
#[derive(Debug, Default)]
pub(super) struct Invalid {
    spans: Vec<Span>,
    /// Since when it has not been, s.
    since: Option<f64>,
}

impl Invalid {
    /// Begins or ends a span at a sample of `t_s`, which is `lost` or valid.
    pub(super) fn settle(&mut self, t_s: f64, lost: bool) {
        match (self.since, lost) {
            (None, true) => self.since = Some(t_s),
            (Some(from_s), false) => {
                self.spans.push(Span { from_s, to_s: t_s });
                self.since = None;
            }
            _ => {}
        }
    }

    /// All of them; one that is open ends with the last sample, at `last_s`.
    pub(super) fn until(mut self, last_s: Option<f64>) -> Vec<Span> {
        if let (Some(from_s), Some(last_s)) = (self.since, last_s) {
            self.spans.push(Span { from_s, to_s: last_s.max(from_s) });
        }
        self.spans
    }
}
