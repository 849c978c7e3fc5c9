//! The proof of the body's limits on many legs together: intervals of any of them, eight at a time.
//!
//! What [`super::halving`] looks at leg by leg, depth first, is looked at here width first, all legs at once. The
//! intervals of a leg are the same whatever the order, and so is the answer: a violation or an interval that is too
//! short to be halved refuses the leg in any order, and a leg of which all is proven within the budget is proven in
//! any. What comes near the budget is left to the order in which that is spent.

use super::eight_ends::{LANES, mask};
use super::flatness::Flatness;
use super::halving::{ProofSettings, WAITING};
use super::proof::BodyLimits;
use crate::math::interval::unrolled;
use crate::math::simd::at_every_level;
use crate::trajectory::ProfileLeg;

/// An interval of a leg that is to be decided.
#[derive(Debug, Clone, Copy)]
struct Interval {
    leg: u32,
    /// s.
    center: f64,
    /// Half of its width, s.
    half: f64,
}

/// What is known of a leg.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Fate {
    /// Nothing violates, of so many intervals.
    Open(usize),
    /// Something does, or cannot be decided.
    Refused,
    /// It takes so many intervals that their order may matter.
    Long,
}

/// Room for proofs, used again by each.
#[derive(Debug, Default)]
pub(super) struct Together {
    fates: Vec<Fate>,
    waiting: Vec<Interval>,
    /// Halves of what is not decided.
    halves: Vec<Interval>,
}

impl Together {
    /// Calls `proven` with the number of each of `legs` that [`BodyLimits::prove`] proves.
    pub(super) fn prove(
        &mut self,
        body: &BodyLimits,
        flatness: &Flatness,
        legs: &[ProfileLeg],
        mut proven: impl FnMut(usize),
    ) {
        self.begin(body.settings(), legs);
        while !self.waiting.is_empty() {
            let mut next = 0;
            while let Some((batch, count)) = self.batch(&mut next) {
                let same = batch.iter().all(|interval| interval.leg == batch[0].leg);
                let (proven, violated) = evaluate(body, flatness, legs, &batch, same);
                for (lane, interval) in batch.iter().enumerate().take(count) {
                    let (proven, violated) = (proven >> lane & 1 == 1, violated >> lane & 1 == 1);
                    self.decide(interval, (proven, violated), legs, body.settings());
                }
            }
            self.waiting.clear();
            std::mem::swap(&mut self.waiting, &mut self.halves);
        }
        for (number, (fate, leg)) in self.fates.iter().zip(legs).enumerate() {
            let is_proven = match fate {
                Fate::Open(_) => true,
                Fate::Refused => false,
                Fate::Long => body.prove(flatness, leg).is_ok(),
            };
            if is_proven {
                proven(number);
            }
        }
    }

    /// All legs are open, and their first intervals wait.
    fn begin(&mut self, settings: &ProofSettings, legs: &[ProfileLeg]) {
        self.fates.clear();
        self.fates.resize(legs.len(), Fate::Open(0));
        self.waiting.clear();
        for (leg, &ProfileLeg { duration, .. }) in (0u32..).zip(legs) {
            let intervals = settings.intervals(duration);
            self.waiting.extend(intervals.map(|(center, half)| Interval { leg, center, half }));
        }
    }

    /// The next intervals of open legs, and how many these are; lanes beyond them repeat the first.
    #[inline]
    fn batch(&self, next: &mut usize) -> Option<([Interval; LANES], usize)> {
        let mut open = self.waiting[*next..].iter().inspect(|_| *next += 1).filter(|interval| self.is_open(interval));
        let mut batch = [*open.next()?; LANES];
        let mut count = 1;
        for (place, interval) in batch[1..].iter_mut().zip(open) {
            *place = *interval;
            count += 1;
        }
        Some((batch, count))
    }

    fn is_open(&self, interval: &Interval) -> bool {
        matches!(self.fates[interval.leg as usize], Fate::Open(_))
    }

    /// What is `proven` or `violated` on an interval of one of `legs`.
    #[inline]
    fn decide(
        &mut self,
        interval: &Interval,
        (proven, violated): (bool, bool),
        legs: &[ProfileLeg],
        settings: &ProofSettings,
    ) {
        let Interval { leg, center, half } = *interval;
        let fate = &mut self.fates[leg as usize];
        let Fate::Open(looks) = *fate else { return };
        let is_short = half < 0.5 * settings.shortest * legs[leg as usize].duration;
        *fate = if violated || (is_short && !proven) {
            Fate::Refused
        } else if looks + 1 >= settings.budget.min(WAITING) {
            Fate::Long
        } else {
            Fate::Open(looks + 1)
        };
        if !proven && matches!(fate, Fate::Open(_)) {
            let half = 0.5 * half;
            self.halves.extend([center - half, center + half].map(|center| Interval { leg, center, half }));
        }
    }
}

at_every_level! {
    /// Bit masks of the intervals on which every limit is proven, and of those whose centre violates one; all of the
    /// `same` leg, or of any.
    ///
    /// The numbers are those of the proof of one leg, to the bit.
    #[expect(clippy::needless_range_loop, reason = "lanes of several arrays, which become one vector each")]
    fn evaluate(
        body: &BodyLimits,
        flatness: &Flatness,
        legs: &[ProfileLeg],
        batch: &[Interval; LANES],
        same: bool,
    ) -> (u32, u32) {
        const FACTORIAL: [f64; 8] = [1.0, 1.0, 2.0, 6.0, 24.0, 120.0, 720.0, 5040.0];
        let mut d = [[[0.0; LANES]; 8]; 3];
        if same {
            let leg = &legs[batch[0].leg as usize];
            for (axis, d) in d.iter_mut().enumerate() {
                for (order, d) in d.iter_mut().enumerate() {
                    *d = [leg.coefficients[axis][order]; LANES];
                }
            }
        } else {
            for (lane, interval) in batch.iter().enumerate() {
                let leg = &legs[interval.leg as usize];
                for (axis, d) in d.iter_mut().enumerate() {
                    for (order, d) in d.iter_mut().enumerate() {
                        d[lane] = leg.coefficients[axis][order];
                    }
                }
            }
        }
        let (mut tau, mut half) = ([0.0; LANES], [0.0; LANES]);
        for lane in 0..LANES {
            (tau[lane], half[lane]) = (batch[lane].center, batch[lane].half);
        }
        // As `polynomial::derivatives`.
        for d in &mut d {
            for order in 0..7 {
                for i in (order..7).rev() {
                    for lane in 0..LANES {
                        d[i][lane] += d[i + 1][lane] * tau[lane];
                    }
                }
            }
            for order in 0..8 {
                for lane in 0..LANES {
                    d[order][lane] *= FACTORIAL[order];
                }
            }
        }
        let (mut proven, mut violated) = ([0; LANES], [0; LANES]);
        for lane in 0..LANES {
            let d = unrolled!(|axis| unrolled!([0, 1, 2, 3, 4, 5, 6, 7], |order| d[axis][order][lane]));
            (proven[lane], violated[lane]) = body.decide(flatness, &d, half[lane]);
        }
        (mask(&proven), mask(&violated))
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use rand::RngExt;

    use super::super::leg::LegJudge;
    use super::super::tests::{flightgoggles, judge_of, plus, random_ends};
    use super::*;
    use crate::feasibility::limits::Limits;
    use crate::math::random::stream;

    /// Budgets that run out, and intervals that are not halved, are those of one proof.
    #[test]
    fn legs_together_are_proven_as_each_is() {
        let [mut yes, mut no] = [0; 2];
        for (seed, robot) in [flightgoggles(), plus()].iter().enumerate() {
            let limits = Limits { max_speed: 6.0, max_tilt: 0.7 };
            let judge = judge_of(robot, limits);
            let mut random = stream(seed as u64);
            let mut together = Together::default();
            for (first, shortest, budget) in
                [(8, 1.0 / 16384.0, 1024), (8, 1.0 / 16384.0, 12), (4, 0.05, 64), (64, 1e-3, 80), (5, 1e-9, 100_000)]
            {
                let body = BodyLimits::new(robot, limits, ProofSettings { first, shortest, budget });
                for count in 0..60 {
                    let leg = |_| {
                        let (from, to) = random_ends(&judge, &mut random, 2.0, 3.0);
                        LegJudge::connect(&from, &to, random.random_range(0.7..3.0))
                    };
                    let legs: Vec<ProfileLeg> = (0..count).map(leg).collect();
                    let mut proven = Vec::new();
                    together.prove(&body, judge.flatness(), &legs, |leg| proven.push(leg));
                    let expected = (0..count).filter(|&leg| body.prove(judge.flatness(), &legs[leg]).is_ok());
                    assert!(proven.iter().copied().eq(expected), "{first} {shortest} {budget}");
                    (yes, no) = (yes + proven.len(), no + count - proven.len());
                }
            }
        }
        assert!(yes > 1_000 && no > 1_000, "{yes} {no}");
    }
}
