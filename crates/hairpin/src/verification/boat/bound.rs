//! Whether forces and speed keep their limits on a whole leg: f(T) ⊆ f(m) + f′(T)(T − m) with outward rounding, halved
//! until it decides.

use super::claim::{BoatClaim, BoatHull, BoatLeg};
use super::demand::{Demand, demand, taylor_over};
use crate::math::outward::Interval;
use crate::math::power::square;

/// Stretches that a leg is cut into first, and halvings after which a limit counts as broken.
const FIRST: usize = 32;
const DEPTH: u32 = 26;

/// A limit that is not kept, or not shown to be.
#[derive(Debug, Clone, Copy)]
pub(super) struct Broken {
    /// Which: `speed`, `surge`, `sway`, `yaw`.
    pub(super) what: &'static str,
    /// The farthest that it may come there, and its limit.
    pub(super) value: f64,
    pub(super) bound: f64,
    pub(super) unit: &'static str,
    /// s since the leg began.
    pub(super) at: f64,
}

/// Least and largest value of something that is bounded.
///
/// Forces in N and N m; the speed as its square, whose root is taken for what is told.
struct Limit {
    what: &'static str,
    unit: &'static str,
    low: f64,
    high: f64,
}

/// Every limit that `leg` breaks, where it does first.
pub(super) fn broken(hull: &BoatHull, claim: &BoatClaim, leg: &BoatLeg) -> Vec<Broken> {
    let [surge, sway, yaw] = hull.forces;
    let force = |what, unit, [low, high]: [f64; 2]| Limit { what, unit, low, high };
    let fastest = square(claim.max_speed);
    let limits = [
        force("surge", "N", surge),
        force("sway", "N", sway),
        force("yaw", "N m", yaw),
        Limit { what: "speed", unit: "m/s", low: f64::NEG_INFINITY, high: fastest },
    ];
    let mut found: Vec<Broken> = Vec::new();
    let part = |k: usize| leg.duration * k as f64 / FIRST as f64;
    for k in 0..FIRST {
        let open: Vec<usize> = (0..4).filter(|i| found.iter().all(|broken| broken.what != limits[*i].what)).collect();
        let time = Interval { low: part(k), high: part(k + 1) };
        search(&|time| demand(hull, claim, &taylor_over(leg, time)), &limits, &open, time, DEPTH, &mut found);
    }
    for broken in found.iter_mut().filter(|broken| broken.what == "speed") {
        (broken.value, broken.bound) = (broken.value.max(0.0).sqrt(), claim.max_speed);
    }
    found
}

/// Looks at the limits `open` on `time`, and on its halves where that does not decide them.
///
/// ```text
/// f(T) ∩ (f(m) + f′(T)(T − m)):   kept where all of it is within the limit, broken where f(m) is beyond for certain
/// ```
///
/// Both forms are enclosures, so is what they have in common. Undecided after 26 halvings of a thirty-second of the
/// leg counts as broken, as does an interval that is not finite: errs towards a finding. Limits that are decided are
/// not looked at in the halves.
fn search(
    demand: &impl Fn(Interval) -> Demand<Interval>,
    limits: &[Limit; 4],
    open: &[usize],
    time: Interval,
    depth: u32,
    found: &mut Vec<Broken>,
) {
    let middle = Interval::point(time.middle());
    let (whole, at_middle) = (demand(time), demand(middle));
    let of = |demand: &Demand<Interval>, i: usize| if i < 3 { demand.forces[i] } else { demand.speed_squared };
    let mut undecided = Vec::new();
    for &i in open {
        let limit = &limits[i];
        let ([range, slope], [value, _]) = (of(&whole, i), of(&at_middle, i));
        let line = value + slope * (time - middle);
        let (low, high) = (range.low.max(line.low), range.high.min(line.high));
        if low >= limit.low && high <= limit.high {
            continue;
        }
        let broken = value.low > limit.high || value.high < limit.low;
        if broken || depth == 0 || !(low.is_finite() && high.is_finite()) {
            if found.iter().all(|known| known.what != limit.what) {
                let above = high > limit.high;
                let (value, bound) = if above { (high, limit.high) } else { (-low, -limit.low) };
                found.push(Broken { what: limit.what, value, bound, unit: limit.unit, at: middle.low });
            }
        } else {
            undecided.push(i);
        }
    }
    if !undecided.is_empty() {
        for half in [Interval { high: middle.low, ..time }, Interval { low: middle.low, ..time }] {
            search(demand, limits, &undecided, half, depth - 1, found);
        }
    }
}
