//! Whether a log shows when its mission began: how long it took is not measured by a part of it.

use hairpin::campaign::{Doubt, Flown, Why};
use hairpin::judgement::Violation;
use hairpin_formats::logs::{LoggedMotion, Sample};
use nalgebra::Point3;

use super::legs::Mission;

/// Within this of waypoint 0 it is there, m.
const THERE_M: f64 = 0.1;
/// What goes away from it more slowly stands, m/s …
const STANDS_M_S: f64 = 0.05;
/// … over this time, s.
const LOOK_S: f64 = 0.5;

/// What of a log lies before its judged part.
pub(super) struct Before<'a> {
    /// All of its motion.
    pub(super) motion: &'a LoggedMotion,
    /// The part in which it may have been at its mission, as the log alone tells it.
    pub(super) told: &'a Mission,
    /// From when on it is judged by name, s.
    pub(super) from_s: Option<f64>,
    /// Where the mission begins, and within how much of that a log may, m.
    pub(super) start: (Point3<f64>, f64),
}

impl Before<'_> {
    /// The limit of duration that `own`, the judged samples, keep, where they may not be all of the mission.
    ///
    /// What lies before them in the log, and was left out because the mission had not begun by then, shows that it
    /// began there; what `--from` leaves out does not.
    pub(super) fn doubt(&self, flown: &Flown, own: &[Sample]) -> Option<Doubt> {
        let value = within(flown, own)?;
        let first = own.first()?;
        let span = self.told.from_s..=self.told.to_s;
        let told_first = self.motion.samples.iter().map(|sample| sample.t_s).find(|t| span.contains(t));
        let left_out = self.from_s.zip(told_first).map(|(from, first)| from - first).filter(|s| *s > 0.0);
        let from = left_out.and(self.from_s).unwrap_or(f64::NEG_INFINITY);
        let shown = self.motion.samples.iter().any(|sample| sample.t_s >= from && sample.t_s < first.t_s);
        if shown || (left_out.is_none() && !self.is_amid(own, first)) {
            return None;
        }
        Some(Doubt { value, why: Why::Begin { before: left_out } })
    }

    /// The same where `--to`, `to_s`, left out the end of it.
    pub(super) fn end(&self, flown: &Flown, own: &[Sample], to_s: Option<f64>) -> Option<Doubt> {
        let (value, to_s) = (within(flown, own)?, to_s?);
        let mut told = self.motion.samples.iter().map(|sample| sample.t_s).filter(|t| *t <= self.told.to_s);
        let left_out = told.next_back().map(|end| end - value.at.max(to_s)).filter(|s| *s > 0.0)?;
        Some(Doubt { value, why: Why::End(left_out) })
    }

    /// Whether it moves away from waypoint 0 when the log begins, and is not there, or is nowhere near it.
    fn is_amid(&self, own: &[Sample], first: &Sample) -> bool {
        let (start, accept) = &self.start;
        let far = |sample: &Sample| (sample.p_m - start).norm();
        let later = own.iter().find(|sample| sample.t_s >= first.t_s + LOOK_S).or(own.last()).unwrap_or(first);
        let away = far(later) - far(first) > STANDS_M_S * (later.t_s - first.t_s);
        far(first) > *accept || (far(first) > THERE_M && away)
    }
}

/// How long the samples of `own` took, beside a limit that they keep; nothing where there is none, or they break it.
fn within(flown: &Flown, own: &[Sample]) -> Option<Violation> {
    let (value, limit) = (flown.measures.total_time, flown.limits.total_time?);
    let at = own.last().filter(|_| value <= limit)?.t_s;
    let leg = flown.measures.legs.len().saturating_sub(1);
    Some(Violation { what: "total-time".into(), value, limit, unit: "s".into(), at, leg })
}
