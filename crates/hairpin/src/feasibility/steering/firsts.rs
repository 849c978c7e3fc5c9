//! To which of many states there is a leg, and in which of the durations of a ladder first.
//!
//! Duration by duration: all states are asked before the next duration is, so that what the first tests leave is proven
//! together, with no lane of the proof empty.

use std::ops::Range;

use super::eight_ends::{Ends, LANES, Open};
use super::leg::LegJudge;
use super::leg_end::LegEnd;
use super::together::Together;
use crate::trajectory::ProfileLeg;

/// States of one waypoint to which legs are asked for.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Asked {
    pub(crate) waypoint: usize,
    /// Number of its first state.
    pub(crate) begin: usize,
    /// Which of its states.
    pub(crate) states: Range<usize>,
    /// Number of the first duration that is asked.
    pub(crate) first: usize,
}

/// One to eight of them.
struct Few {
    /// Number of the first of the eight.
    begin: usize,
    /// Which of the eight: bit i for number i.
    states: u32,
    /// Number of the first duration that is asked.
    first: usize,
    /// Number of the first duration in which there is a leg to a state that is no longer open.
    firsts: [u32; LANES],
}

/// States as they are looked at together.
pub(crate) fn in_lanes(states: &[LegEnd]) -> Vec<Ends> {
    states.chunks(LANES).map(Ends::new).collect()
}

impl LegJudge {
    /// Calls `found` with the number of each state of `to` that is `asked` for and to which there is a leg by
    /// [`Self::judge`], and the number of the first of `durations` (s) in which there is one; `lanes` are the states of
    /// every waypoint.
    ///
    /// Most are refused eight at a time, for what the body would have to do at the ends and at nine instants.
    ///
    /// Same answer as judging them one after the other: what refuses several at once refuses only what the judge would,
    /// and what proves several at once proves the same. In the order of `asked`.
    pub(crate) fn firsts(
        &self,
        from: &LegEnd,
        to: (&[LegEnd], &[Vec<Ends>]),
        asked: &[Asked],
        durations: &[f64],
        found: impl FnMut(usize, usize),
    ) {
        let mut together = Together::default();
        let prove = |legs: &[ProfileLeg], proven: &mut dyn FnMut(usize)| {
            together.prove(self.body(), self.flatness(), legs, proven);
        };
        self.firsts_by(prove, from, to, asked, durations, found);
    }

    /// The same of legs that may be: of which all is settled but the proof of the body's limits.
    ///
    /// All legs are among these, and none is shorter.
    pub(crate) fn possible(
        &self,
        from: &LegEnd,
        to: (&[LegEnd], &[Vec<Ends>]),
        asked: &[Asked],
        durations: &[f64],
        found: impl FnMut(usize, usize),
    ) {
        let all = |legs: &[ProfileLeg], each: &mut dyn FnMut(usize)| (0..legs.len()).for_each(each);
        self.firsts_by(all, from, to, asked, durations, found);
    }

    /// `prove` calls with the number of each of the legs that it takes.
    fn firsts_by(
        &self,
        mut prove: impl FnMut(&[ProfileLeg], &mut dyn FnMut(usize)),
        from: &LegEnd,
        (to, lanes): (&[LegEnd], &[Vec<Ends>]),
        asked: &[Asked],
        durations: &[f64],
        mut found: impl FnMut(usize, usize),
    ) {
        let (mut few, mut open) = (Vec::with_capacity(asked.len()), Vec::with_capacity(asked.len()));
        for Asked { waypoint, begin, states, first } in asked {
            for (number, ends) in lanes[*waypoint].iter().enumerate() {
                let bit = |lane: usize| u32::from(states.contains(&(number * LANES + lane))) << lane;
                let states = (0..LANES).map(bit).sum();
                few.push(Few { begin: begin + number * LANES, states, first: *first, firsts: [0; LANES] });
                open.push(Open { ends, open: 0 });
            }
        }
        let mut left = vec![0; few.len()];
        let (mut legs, mut places) = (Vec::new(), Vec::new());
        for (number, &duration) in durations.iter().enumerate() {
            let begun = open.iter_mut().zip(&few).filter(|(_, few)| few.first == number);
            begun.for_each(|(open, few)| open.open = few.states);
            self.refuse(from, &open, duration, &mut left);
            legs.clear();
            places.clear();
            for (place, (few, left)) in few.iter().zip(&left).enumerate().filter(|(_, (_, left))| **left != 0) {
                for lane in (0..LANES).filter(|lane| left >> lane & 1 == 1) {
                    if let Ok(leg) = self.unproven(from, &to[few.begin + lane], duration) {
                        legs.push(leg);
                        places.push((place, lane));
                    }
                }
            }
            prove(&legs, &mut |leg| {
                let (place, lane): (usize, usize) = places[leg];
                open[place].open &= !(1 << lane);
                few[place].firsts[lane] = number as u32;
            });
        }
        for (few, open) in few.iter().zip(&open) {
            let begun = if few.first < durations.len() { few.states } else { 0 };
            let legs = (0..LANES).filter(|lane| (begun & !open.open) >> lane & 1 == 1);
            legs.for_each(|lane| found(few.begin + lane, few.firsts[lane] as usize));
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use rand::RngExt;

    use super::super::leg_end::LegEnd;
    use super::super::tests::{flightgoggles, judge_of, plus, random_ends};
    use super::{Asked, in_lanes};
    use crate::feasibility::limits::Limits;
    use crate::feasibility::steering::LegTiming;
    use crate::math::random::stream;

    #[test]
    fn legs_are_those_that_are_judged_one_by_one() {
        let limits = |max_speed, max_tilt| Limits { max_speed, max_tilt };
        for (seed, robot) in [flightgoggles(), plus()].iter().enumerate() {
            let mut legs = 0;
            for limits in [limits(18.0, 1.2), limits(5.0, 0.6), limits(f64::INFINITY, 1.5)] {
                let judge = judge_of(robot, limits);
                let mut random = stream(seed as u64);
                for draw in 0..60 {
                    let from = random_ends(&judge, &mut random, 4.0, 4.0).0;
                    let to: Vec<LegEnd> = (0..40).map(|_| random_ends(&judge, &mut random, 4.0, 4.0).1).collect();
                    let shortest = random.random_range(0.2..1.0);
                    let durations = LegTiming::ladder(shortest, 5.0 * shortest).rungs();
                    // None, fewer and more than there are lanes; not all, and not all durations.
                    let waypoints = [0..3, 3..22, 22..24, 24..32, 32..40];
                    let lanes: Vec<_> = waypoints.iter().map(|states| in_lanes(&to[states.clone()])).collect();
                    let asked =
                        [(0, 0..0, 0), (0, 0..3, 0), (1, 1..18, draw % 3), (3, 0..8, 1), (4, 0..8, durations.len())];
                    let asked = asked.map(|(waypoint, states, first)| Asked {
                        waypoint,
                        begin: waypoints[waypoint].start,
                        states,
                        first,
                    });
                    let mut found = Vec::new();
                    judge.firsts(&from, (&to, &lanes), &asked, &durations, |to, duration| found.push((to, duration)));
                    let first = |first: usize, to: &LegEnd| {
                        (first..durations.len()).find(|&number| judge.judge(&from, to, durations[number]).is_ok())
                    };
                    let one_by_one = asked
                        .iter()
                        .flat_map(|asked| asked.states.clone().map(|state| (asked.begin + state, asked.first)));
                    let expected = one_by_one.filter_map(|(state, begin)| Some((state, first(begin, &to[state])?)));
                    assert!(found.iter().copied().eq(expected), "{limits:?} draw {draw}");
                    legs += found.len();
                }
            }
            assert!(legs > 100, "{legs} of {}", robot.name);
        }
    }
}
