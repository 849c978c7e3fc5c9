//! Rows in the order of their times, one for each.

use super::super::log::Clock;

/// Stamps are told in milliseconds or finer, s; twice that, for what moves may go faster in between.
const COARSE_S: f64 = 2e-3;
/// A recorder that was held up takes what came in as much time with one stamp, s.
const HELD_UP_S: f64 = 0.5;

/// Rows whose stamp was there before.
pub(super) struct Twice<T> {
    /// How many.
    count: usize,
    /// The first that says something else than the row before it: both.
    other: Option<((f64, T), T)>,
}

impl<T> Twice<T> {
    /// Tells of them, and gives what is wrong with them.
    pub(super) fn tell(
        self,
        name: &str,
        notes: &mut Vec<String>,
        words: impl Fn(&(f64, T), &T) -> String,
    ) -> Option<String> {
        if self.count > 0 {
            notes.push(format!("{name}: {} messages with a stamp that was there before", self.count));
        }
        // A stamp of zero is none.
        let other = self.other.filter(|((t_s, _), _)| *t_s != 0.0);
        let why = other.map(|(one, other)| words(&one, &other));
        notes.extend(why.iter().map(|why| format!("{name}: {why}")));
        why
    }
}

/// Rows in the order of their times, one each, and those that were left out for it; `far` says how far two are apart.
///
/// Of one stamp are also messages that follow each other faster than stamps are told, or that a recorder took together.
/// So those that are no farther apart than what moves moves around that time within [`COARSE_S`], by the recorder's
/// clock within [`HELD_UP_S`], say nothing else.
pub(super) fn rising<T: Clone>(
    mut rows: Vec<(f64, T)>,
    clock: Clock,
    far: &dyn Fn(&T, &T) -> f64,
) -> (Vec<(f64, T)>, Twice<T>) {
    rows.sort_by(|a, b| a.0.total_cmp(&b.0));
    let mut kept: Vec<(f64, T)> = Vec::with_capacity(rows.len());
    let mut again: Vec<(usize, T)> = Vec::new();
    for (t_s, row) in rows {
        match kept.last() {
            Some((last, _)) if t_s <= *last => again.push((kept.len() - 1, row)),
            _ => kept.push((t_s, row)),
        }
    }
    let speed = |from: usize| {
        let (Some(one), Some(other)) = (kept.get(from), kept.get(from + 1)) else { return 0.0 };
        far(&one.1, &other.1) / (other.0 - one.0)
    };
    let coarse = if clock == Clock::Receive { HELD_UP_S } else { COARSE_S };
    let is_other = |(place, row): &&(usize, T)| {
        let speed = place.checked_sub(1).map_or(0.0, speed).max(speed(*place));
        far(&kept[*place].1, row) > speed * coarse
    };
    let other = again.iter().find(is_other).map(|(place, row)| (kept[*place].clone(), row.clone()));
    (kept, Twice { count: again.len(), other })
}
