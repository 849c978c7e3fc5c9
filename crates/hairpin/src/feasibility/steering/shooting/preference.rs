//! Which of two drives to one goal is the better one: the shorter; of equals the one that turns less in place, then the
//! one that stands less often.

use std::cmp::Ordering;

use crate::trajectory::drive::{Motion, Segment};

/// Lengths that differ by less, m and as a share, are the same, as are turns, rad: rounding.
const SAME: f64 = 1e-9;

/// What a drive is compared by.
#[derive(Debug, Clone, Copy)]
pub(in crate::feasibility::steering) struct Effort {
    /// Metres driven.
    length: f64,
    /// Turned in place, rad.
    turned: f64,
    /// Turns in place and changes of gear.
    stops: usize,
}

impl Effort {
    /// Of a drive.
    pub(in crate::feasibility::steering) fn of(segments: &[Segment]) -> Self {
        let mut effort = Self { length: 0.0, turned: 0.0, stops: 0 };
        let mut gear = None;
        for segment in segments {
            if let Motion::Turn { angle_rad } = segment.motion {
                effort.turned += angle_rad.abs();
                effort.stops += 1;
            } else if segment.length_m() > 0.0 {
                effort.length += segment.length_m();
                effort.stops += usize::from(gear.is_some_and(|gear| gear != segment.gear));
                gear = Some(segment.gear);
            }
        }
        effort
    }

    /// Less of it is better. As lengths are the same within rounding, three drives need not be in one order.
    pub(in crate::feasibility::steering) fn against(&self, other: &Self) -> Ordering {
        match self.is_as_long_as(other) {
            true => self.against_in_turns(other),
            false => self.length.total_cmp(&other.length),
        }
    }

    /// Whether lengths differ by rounding alone.
    pub(in crate::feasibility::steering) fn is_as_long_as(&self, other: &Self) -> bool {
        same(self.length, other.length)
    }

    /// What it is compared by beside its length.
    pub(in crate::feasibility::steering) fn against_in_turns(&self, other: &Self) -> Ordering {
        match same(self.turned, other.turned) {
            true => self.stops.cmp(&other.stops),
            false => self.turned.total_cmp(&other.turned),
        }
    }
}

fn same(a: f64, b: f64) -> bool {
    (a - b).abs() <= SAME * a.max(b).max(1.0)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::trajectory::drive::Gear;

    #[test]
    fn of_equal_lengths_less_turning_then_fewer_stops_win() {
        let turn = |angle_rad| Segment { motion: Motion::Turn { angle_rad }, gear: Gear::Forward };
        let on = |metres| Segment::straight(metres, Gear::Forward);
        let back = |metres| Segment::straight(metres, Gear::Reverse);
        let order = [
            vec![back(1.9)],
            vec![back(2.0)],
            vec![back(1.0), on(1.0)],
            vec![turn(0.5), on(2.0 + 1e-12)],
            vec![turn(0.25), on(2.0), turn(-0.25)],
            vec![turn(3.0), on(2.0), turn(3.0)],
            vec![on(2.1)],
        ];
        for (i, a) in order.iter().enumerate() {
            for (k, b) in order.iter().enumerate() {
                assert_eq!(Effort::of(a).against(&Effort::of(b)), i.cmp(&k), "{i} {k}");
            }
        }
    }
}
