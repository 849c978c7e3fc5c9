//! From when to when the positions of a log are due: while it says that its mission was flown.

use hairpin_formats::logs::{Logged, Span};

use super::legs::{Course, Mission, mission};

/// What a log says of when its mission was flown, s: endless where it does not say.
///
/// It begins where the first leg does, else where its mode says so; and ends where it goes on behind the last waypoint
/// or is told to end, else where the last item is told, for it was still flown then.
pub(super) fn due(logged: &Logged, span: &Mission, course: Option<&Course>) -> Span {
    let begins = course.and_then(Course::begins_s).or(span.begins_s);
    let from_s = begins.map_or(f64::NEG_INFINITY, |begins| begins.max(span.from_s));
    let ended = span.ended.as_ref().map(|_| span.to_s);
    let done = course.and_then(Course::done_s).filter(|done| *done <= span.to_s);
    let last = logged.progress.iter().map(|step| step.t_s).rfind(|t| *t <= span.to_s);
    let to_s = done.or(ended).or(last).unwrap_or(f64::NEG_INFINITY);
    Span { from_s, to_s }
}

/// The same of a log that is held against no mission.
pub(crate) fn due_alone(logged: &Logged) -> Span {
    due(logged, &mission(logged, [None; 2]), None)
}
