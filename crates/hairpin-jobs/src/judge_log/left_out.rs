//! What of a mission lies before the judged part of a log that tells when it was flown: `--from` may leave out legs,
//! and who did not look at them knows nothing of them.

use hairpin_formats::logs::{LoggedMotion, Sample};

use super::cut::STALE_S;
use super::legs::Course;

/// The beginning of a mission, of which nothing is judged.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LeftOut {
    /// The first leg of which something is judged.
    pub first_leg: usize,
    /// Whether not all of that leg is.
    pub cuts_leg: bool,
    /// When the mission left waypoint 0, s of the log.
    pub began_s: f64,
    /// How much of it is not judged, s.
    pub lost_s: f64,
    /// Whether `--from` asks for that; else positions begin late.
    pub is_asked: bool,
}

impl LeftOut {
    /// What of the mission over `course` lies before `own`, the judged samples of `motion`; nothing where all that
    /// `from_s` leaves out was before it.
    pub(super) fn of(course: &Course, own: &[Sample], motion: &LoggedMotion, from_s: Option<f64>) -> Option<Self> {
        let first = own.first()?;
        let (first_leg, began_s) = (course.leg_at(first.t_s)?, course.begins_s()?);
        let asked = from_s.filter(|from| *from > began_s);
        let lost_s = first.t_s - began_s;
        let seen = |from: f64| motion.samples.iter().any(|sample| (began_s..from).contains(&sample.t_s));
        // What is told between two samples cuts off neither; positions that begin late are a gap, `--from` or not.
        let is_cut = asked.is_some_and(|from| seen(from) || lost_s > STALE_S);
        let cuts_leg = is_cut && asked > course.flies_s(first_leg);
        (first_leg > 0 || is_cut).then_some(Self { first_leg, cuts_leg, began_s, lost_s, is_asked: asked.is_some() })
    }

    /// `--from leaves out legs 0→1 to 3→4 and a part of leg 4→5: 12.3 s since the mission left waypoint 0 at t = 28.00
    /// s are not judged`.
    pub fn in_words(&self) -> String {
        let Self { first_leg, began_s, lost_s, .. } = self;
        let leg = |leg: usize| format!("{leg}→{}", leg + 1);
        let whole = match first_leg {
            0 => None,
            1 => Some(format!("leg {}", leg(0))),
            more => Some(format!("legs {} to {}", leg(0), leg(more - 1))),
        };
        let part = (self.cuts_leg || whole.is_none()).then(|| format!("a part of leg {}", leg(*first_leg)));
        let which = whole.into_iter().chain(part).collect::<Vec<_>>().join(" and ");
        let who = if self.is_asked { "--from leaves out" } else { "the positions leave out" };
        format!("{who} {which}: {lost_s:.2} s since the mission left waypoint 0 at t = {began_s:.2} s are not judged")
    }
}
