//! Whether the way stays in its waters and keeps its distance from places, everywhere: between samples it is no farther
//! from the middle of a stretch than the stretch is wide.

use super::claim::{BoatClaim, BoatHull, BoatLeg};
use super::demand::taylor_over;
use crate::math::outward::Interval;

/// What rounding may take from a distance that is kept exactly, m.
const ROUNDING: f64 = 1e-9;
/// Stretches that a leg is cut into first, and halvings after which a distance counts as too small.
const FIRST: usize = 16;
const DEPTH: u32 = 24;

/// Something that the way comes too near to: a place by its number, or `None` for the edge of the waters.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Near {
    pub(super) place: Option<usize>,
    /// The least that it is away there at least, and what it must be, m.
    pub(super) distance: f64,
    pub(super) wanted: f64,
    /// s since the leg began.
    pub(super) at: f64,
}

/// All that `leg` comes too near to, where it does first.
pub(super) fn near(hull: &BoatHull, claim: &BoatClaim, leg: &BoatLeg) -> Vec<Near> {
    let mut found = Vec::new();
    let all = std::iter::once(None).chain((0..claim.places.len()).map(Some));
    for place in all {
        let wanted = if place.is_some() { hull.radius } else { 0.0 };
        let away = |p: [f64; 2]| match place {
            Some(number) => claim.places[number].distance(p),
            None => inside(p, &claim.waters),
        };
        let part = |k: usize| leg.duration * k as f64 / FIRST as f64;
        let first =
            (0..FIRST).find_map(|k| too_near(leg, &away, wanted, Interval { low: part(k), high: part(k + 1) }, DEPTH));
        found.extend(first.map(|(distance, at)| Near { place, distance, wanted, at }));
    }
    found
}

/// Where it is not shown that the way stays `wanted` away, and how far it is there.
///
/// ```text
/// kept    where distance(m) − spread ≥ wanted − 10⁻⁹           broken    where distance(m) + spread < wanted − 10⁻⁹
/// ```
///
/// m is the middle of the box that holds the way in `time`, spread the half of its diagonal: distances are
/// 1-Lipschitz. Undecided after 24 halvings counts as broken; the distance told is that of the middle. The distance
/// itself is rounded to nearest, not outwards, hence the nanometre.
fn too_near(
    leg: &BoatLeg,
    away: &impl Fn([f64; 2]) -> f64,
    wanted: f64,
    time: Interval,
    depth: u32,
) -> Option<(f64, f64)> {
    let [x, y, _] = taylor_over(leg, time);
    let (x, y) = (x[0], y[0]);
    let middle = [x.middle(), y.middle()];
    let reach = |of: Interval, m: f64| (of.high - m).max(m - of.low);
    let spread = Interval::point(reach(x, middle[0])).square() + Interval::point(reach(y, middle[1])).square();
    let distance = away(middle);
    if distance - spread.sqrt().high >= wanted - ROUNDING {
        return None;
    }
    // A distance grows by no more than the way: here it is too small for certain.
    if distance.is_nan() || distance + spread.sqrt().high < wanted - ROUNDING || depth == 0 {
        return Some((distance, time.middle()));
    }
    let m = time.middle();
    let [early, late] = [Interval { high: m, ..time }, Interval { low: m, ..time }];
    too_near(leg, away, wanted, early, depth - 1).or_else(|| too_near(leg, away, wanted, late, depth - 1))
}

/// How far inside the waters, m.
fn inside([x, y]: [f64; 2], (low, high): &([f64; 2], [f64; 2])) -> f64 {
    (x - low[0]).min(high[0] - x).min(y - low[1]).min(high[1] - y)
}
