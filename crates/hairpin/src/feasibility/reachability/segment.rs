//! One segment against one region, proven: intervals in the segment's parameter alone, halved until they decide.
//!
//! Why halving in t alone decides: on a piece of width w the enclosure of the region's formula is too wide by O(w²) in
//! centred form, so that only pieces near contact are halved far, and only contact itself does not end.

use nalgebra::Point3;

use super::surface;
use super::verdict::{Verdict, point};
use crate::math::outward::{Centred, Interval};
use crate::world::Shape;
use crate::world::cell::{Region, Surface, Words, directions};

/// A region with what is worked out about it once.
///
/// Made once for each region: a mesh's triangles are laid out here.
#[derive(Debug)]
pub struct Obstacle {
    /// The region.
    pub region: Region,
    /// Triangles, of hulls and meshes.
    ///
    /// `None` of regions with a formula or in words.
    surface: Option<Surface>,
}

/// Intervals of t below this width are not halved.
const LEAST_WIDTH: f64 = 1.0 / (1u64 << 36) as f64;
/// Intervals looked at before a segment is given up as undecided.
const MOST_PIECES: usize = 4000;

impl Obstacle {
    /// Prepares a region.
    ///
    /// O(triangles) for hulls and meshes.
    pub fn new(region: Region) -> Self {
        let surface = match &region {
            Region::Shape(Shape::Hull(solid) | Shape::Mesh(solid)) => Some(Surface::of(solid)),
            _ => None,
        };
        Self { region, surface }
    }

    /// Whether the segment a–b grown by `radius` (m, ≥ 0) meets the region: proofs, or undecided.
    ///
    /// The region counts with its border. Intervals are computed with outward rounding on the numbers given, so that
    /// only what is true of the real numbers is said.
    ///
    /// Cost: a nearest point and one inequality mostly; else at most 4000 intervals.
    ///
    /// For parts of the cell without a surface the first of: nearest point proven inside, direction proven separating,
    /// intervals of t halved down to 2⁻³⁶.
    ///
    /// `Hit` comes with a parameter whose point is proven within the radius.
    pub fn certify(&self, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Verdict {
        match (&self.surface, &self.region) {
            (Some(surface), _) => surface::certify(surface, a, b, radius),
            (None, Region::Words(words)) => of_words(words, a, b, radius),
            (None, region) => at_nearest(region, a, b, radius).unwrap_or_else(|| {
                halve(LEAST_WIDTH, |t| {
                    let value = region.formula(point(a, b, Centred::parameter(t)), radius)?.bounds();
                    if value.low > 0.0 {
                        return Some(Piece::Clear);
                    }
                    let middle = t.middle();
                    let there = region.formula(point(a, b, Interval::point(middle)), radius)?;
                    Some(if there.high <= 0.0 { Piece::Hit(middle) } else { Piece::Unknown })
                })
            }),
        }
    }
}

/// Where the segment is nearest to a convex region, found in floating point, most is decided: the point there is proven
/// within the radius, or the direction to it is proven to separate: n·p > h(n) + r|n| at both ends, with the region's
/// support function h.
///
/// `None` leaves the question to halving: regions without a core, or a distance within rounding of the radius.
fn at_nearest(region: &Region, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Option<Verdict> {
    let (t, n) = region.nearest(a, b)?;
    let i = Interval::point;
    let (support, own) = region.support(&n)?;
    let length = (i(n.x).square() + i(n.y).square() + i(n.z).square()).sqrt();
    let least = support + (i(own) + i(radius)) * length;
    let beyond = |p: &Point3<f64>| (i(n.x) * i(p.x) + i(n.y) * i(p.y) + i(n.z) * i(p.z)).low > least.high;
    if beyond(a) && beyond(b) {
        return Some(Verdict::Clear);
    }
    let there = region.formula(point(a, b, i(t)), radius)?;
    (there.high <= 0.0).then_some(Verdict::Hit { at: t })
}

/// What is known of an interval of t.
enum Piece {
    Clear,
    Hit(f64),
    Unknown,
}

/// Halves [0, 1] until every piece is clear, one is hit, or one is as narrow as `least` and neither. `None` from `look`
/// ends as undecided.
///
/// Depth first from t = 0. Effort is bounded by 4000 pieces.
fn halve(least: f64, mut look: impl FnMut(Interval) -> Option<Piece>) -> Verdict {
    let mut open = vec![Interval { low: 0.0, high: 1.0 }];
    let mut undecided: Option<Verdict> = None;
    for looked in 0.. {
        let Some(t) = open.pop() else { break };
        let width = t.high - t.low;
        let unsure = Verdict::Undecided { at: t.middle(), width };
        match look(t) {
            Some(Piece::Clear) => {}
            Some(Piece::Hit(at)) => return Verdict::Hit { at },
            Some(Piece::Unknown) if width > least && looked < MOST_PIECES => {
                let middle = t.middle();
                open.push(Interval { low: middle, high: t.high });
                open.push(Interval { low: t.low, high: middle });
            }
            // Elsewhere a hit may still be proven.
            Some(Piece::Unknown) if looked < MOST_PIECES => undecided = undecided.or(Some(unsure)),
            Some(Piece::Unknown) | None => return undecided.unwrap_or(unsure),
        }
    }
    undecided.unwrap_or(Verdict::Clear)
}

/// Words grown by the cube around a ball: what is clear is so for the ball; what only the cube's corners meet stays
/// undecided.
///
/// A hit is one of 27 points of the ball around a piece's middle; `radius` 0 looks at the middle alone.
fn of_words(words: &Words, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> Verdict {
    let ball = Interval { low: -radius, high: radius };
    // Pieces much shorter than the ball say nothing new.
    let least = LEAST_WIDTH.max((radius / (64.0 * (b - a).norm())).min(1.0));
    halve(if least.is_nan() { LEAST_WIDTH } else { least }, |t| {
        let grown = point(a, b, Centred::parameter(t)).map(|c| c + Centred::anywhere_in(ball));
        if words.holds_on(grown) == Some(false) {
            return Some(Piece::Clear);
        }
        let middle = t.middle();
        let centre = point(a, b, Interval::point(middle));
        let hit = directions(radius).any(|shift| {
            let there: [Interval; 3] = std::array::from_fn(|k| centre[k] + Interval::point(shift[k]));
            words.holds_on(there) == Some(true)
        });
        Some(if hit { Piece::Hit(middle) } else { Piece::Unknown })
    })
}
