//! Attitudes that are logged beside positions, at the positions' stamps.

use hairpin::math::rotation::between;
use nalgebra::UnitQuaternion;

/// An attitude farther away in time than this says nothing of a position's, s.
const NEAR: f64 = 0.1;

/// Attitudes over time.
#[derive(Debug, Default)]
pub(super) struct Attitudes {
    times: Vec<f64>,
    turns: Vec<UnitQuaternion<f64>>,
}

impl Attitudes {
    /// One more; a stamp that does not rise is left out.
    pub(super) fn push(&mut self, t_s: f64, turn: UnitQuaternion<f64>) {
        if self.times.last().is_none_or(|last| *last < t_s) {
            self.times.push(t_s);
            self.turns.push(turn);
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// Those at rising stamps: between two near ones on the shortest way from one to the other, else the one that is
    /// near.
    pub(super) fn at(&self, stamps: impl IntoIterator<Item = f64>) -> Vec<Option<UnitQuaternion<f64>>> {
        let mut after = 0;
        let one = |t_s: f64| {
            while self.times.get(after).is_some_and(|time| *time <= t_s) {
                after += 1;
            }
            let near = |place: usize| Some((*self.times.get(place)?, *self.turns.get(place)?));
            let before = after.checked_sub(1).and_then(near).filter(|(time, _)| t_s - time <= NEAR);
            let behind = near(after).filter(|(time, _)| time - t_s <= NEAR);
            match (before, behind) {
                (Some((from, a)), Some((to, b))) => Some(between(&a, &b, (t_s - from) / (to - from))),
                (one, other) => one.or(other).map(|(_, turn)| turn),
            }
        };
        stamps.into_iter().map(one).collect()
    }
}

#[cfg(test)]
mod tests {
    use nalgebra::Vector3;

    use super::*;

    #[test]
    fn attitudes_stand_at_others_stamps() {
        let turn = |angle: f64| UnitQuaternion::from_axis_angle(&Vector3::x_axis(), angle);
        let mut attitudes = Attitudes::default();
        for (t_s, angle) in [(1.0, 0.0), (1.1, 0.4), (1.1, 9.0), (5.0, 1.0)] {
            attitudes.push(t_s, turn(angle));
        }
        let read = attitudes.at([0.95, 1.025, 1.1, 1.15, 3.0, 4.95, 6.0]);
        let angles: Vec<_> = read.iter().map(|turn| turn.map(|turn| (turn.angle() * 1e6).round() / 1e6)).collect();
        assert_eq!(angles, [Some(0.0), Some(0.1), Some(0.4), Some(0.4), None, Some(1.0), None]);
    }
}
