//! The nearest goal that can be reached, told where the one asked for cannot.
//!
//! ```text
//! min ‖m‖   such that goal + (r m₁, r m₂, m₃, m₄/r) can be reached,   r = 1/κ_max
//! ```
//!
//! with reachability as a black box that says yes or no: no derivative, so bisection and a pattern search. What is
//! found is an upper bound of the least move; between two directions a nearer goal may stay unseen.

use super::query::{Curvatures, Goal, Query};
use super::solve::{Choices, least_length, single_arc};
use crate::trajectory::drive::{Segment, SegmentList};

/// A goal that can be reached, near one that cannot.
///
/// The metric is in metres: a heading counts as the arc that it turns on the tightest circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest {
    /// The goal.
    ///
    /// Its yaw is not wrapped; moved from the one asked for, not from another turn of it.
    pub goal: Goal,
    /// √(δx² + δy² + (r δψ)² + (r² δκ)²), r the radius of the tightest circle: how far it is moved, m.
    pub moved: f64,
    /// Goals that were tried.
    pub tried: u32,
}

/// Goals that are tried, at most.
const MOST: u32 = 600;
/// First and last steps along a direction, and the last of the search around the best, in radii.
///
/// Steps along a direction double from the first to below the last.
const FIRST: f64 = 0.02;
const FARTHEST: f64 = 6.0;
const FINE: f64 = 2e-3;
/// Halvings between a goal that cannot be reached and one that can.
const HALVINGS: u32 = 8;
/// What is driven at most, by what any drive would have to: longer arcs lead there by a loop.
const DIRECT: f64 = 1.5;

/// The single arc of `choices` that keeps `bounds` and reaches the goal of `query` without a loop, if there is one.
///
/// `None` also where only a chain or a reversal does.
///
/// Asked where a detour is no answer: at most one and a half times the longer of the straight way and the arc that the
/// heading takes on the tightest circle.
pub fn direct_arc(query: &Query, bounds: &Curvatures, choices: &Choices) -> Option<SegmentList> {
    let answer = single_arc(query, bounds, choices.gear, &choices.flat);
    let driven: f64 = answer.segments.iter().map(Segment::length_m).sum();
    let solved = answer.status == super::flat::Status::Ok && driven <= DIRECT * least_length(query, bounds);
    solved.then_some(answer.segments)
}

/// Moves the goal of `query`, which is not `reachable`, as little as it finds need to until it is: along sixteen
/// directions by bisection, then around the best of them in ever smaller steps. `None` if nothing near is; a local
/// search, not a proof.
///
/// At most 600 goals. `reachable` is asked about checked queries only; `stop` between them.
///
/// Directions come in a fixed order and each is followed only as far as the best so far, so that later ones cost less.
/// The bracket of a bisection is the last doubling, cut to 2⁻⁸ of it; the pattern search ends at steps of 0.002 radii
/// and takes only steps that shorten the move by a thousandth or more. Goals that are no questions ([`Query::new`])
/// count as unreachable and as tried.
pub fn nearest(
    query: &Query,
    bounds: &Curvatures,
    mut reachable: impl FnMut(&Query) -> bool,
    stop: impl Fn() -> bool,
) -> Option<Nearest> {
    let radius = 1.0 / bounds.most;
    let mut tried = 0;
    let goal_at = |move_by: &[f64; 4]| {
        let [dx, dy, dyaw, dk] = move_by.map(|part| part * radius);
        let Goal { x, y, yaw, curvature } = query.goal;
        Goal {
            x: x + dx,
            y: y + dy,
            yaw: yaw + dyaw * bounds.most,
            curvature: curvature + dk * bounds.most * bounds.most,
        }
    };
    let mut good = |move_by: &[f64; 4]| {
        tried += 1;
        let asked = Query::new(query.start_curvature, goal_at(move_by), bounds);
        tried <= MOST && !stop() && asked.is_ok_and(|asked| reachable(&asked))
    };
    let along = |direction: &[f64; 4], t: f64| direction.map(|part| t * part);
    let mut best: Option<([f64; 4], f64)> = None;
    for direction in directions() {
        let mut t = FIRST;
        while t < FARTHEST && best.is_none_or(|(_, least)| t < least) {
            if good(&along(&direction, t)) {
                let (mut low, mut high) = (if t == FIRST { 0.0 } else { 0.5 * t }, t);
                for _ in 0..HALVINGS {
                    let middle = 0.5 * (low + high);
                    if good(&along(&direction, middle)) { high = middle } else { low = middle }
                }
                if best.is_none_or(|(_, least)| high < least) {
                    best = Some((along(&direction, high), high));
                }
                break;
            }
            t *= 2.0;
        }
    }
    let (mut here, mut size) = best?;
    let mut step = 0.3 * size;
    while step > FINE {
        let neighbours = (0..8).map(|i| {
            let mut next = here;
            next[i / 2] += if i % 2 == 0 { step } else { -step };
            next
        });
        let back = here.map(|part| part * (1.0 - step / size).max(0.0));
        let next = std::iter::once(back).chain(neighbours).find(|next| norm(next) < size * (1.0 - 1e-3) && good(next));
        match next {
            Some(next) => (here, size) = (next, norm(&next)),
            None => step *= 0.5,
        }
    }
    Some(Nearest { goal: goal_at(&here), moved: size * radius, tried: tried.min(MOST) })
}

/// Of a move in radii.
fn norm(of: &[f64; 4]) -> f64 {
    of.iter().map(|part| part * part).sum::<f64>().sqrt()
}

/// Along each of (x, y, ψ, κ) and between x and y, y and ψ, both ways, of length 1.
fn directions() -> impl Iterator<Item = [f64; 4]> {
    let single = (0..8).map(|i| {
        let mut direction = [0.0; 4];
        direction[i / 2] = if i % 2 == 0 { 1.0 } else { -1.0 };
        direction
    });
    let half = std::f64::consts::FRAC_1_SQRT_2;
    let pairs = [(0, 1), (1, 2)].into_iter().flat_map(move |(a, b)| {
        [(half, half), (half, -half), (-half, half), (-half, -half)].map(|(first, second)| {
            let mut direction = [0.0; 4];
            (direction[a], direction[b]) = (first, second);
            direction
        })
    });
    single.chain(pairs)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

    fn query(x: f64, y: f64, yaw: f64) -> Query {
        Query { start_curvature: 0.0, goal: Goal { x, y, yaw, curvature: 0.0 } }
    }

    fn near(query: &Query, choices: &Choices) -> Option<Nearest> {
        nearest(query, &BOUNDS, |query| direct_arc(query, &BOUNDS, choices).is_some(), || false)
    }

    #[test]
    fn goals_beside_the_start_move_to_where_an_arc_leads() {
        let choices = Choices::default();
        let mut told = 0;
        for seed in 0..40 {
            let unit = |i: u64| hashed_unit(seed, &[i]);
            let asked = query(0.3 + unit(0), 0.5 + unit(1), unit(2) - 0.5);
            if direct_arc(&asked, &BOUNDS, &choices).is_some() {
                continue;
            }
            let found = near(&asked, &choices).expect("somewhere");
            let there = Query { goal: found.goal, ..asked };
            assert!(direct_arc(&there, &BOUNDS, &choices).is_some(), "seed {seed}: {found:?}");
            assert!(found.moved > 0.0 && found.moved < 4.0 && found.tried <= 600, "seed {seed}: {found:?}");
            // Half of the way is not enough, or the search had found it.
            let half = |a: f64, b: f64| a + 0.5 * (b - a);
            let Goal { x, y, yaw, curvature } = asked.goal;
            let goal = Goal {
                x: half(x, found.goal.x),
                y: half(y, found.goal.y),
                yaw: half(yaw, found.goal.yaw),
                curvature: half(curvature, found.goal.curvature),
            };
            told += usize::from(direct_arc(&Query { goal, ..asked }, &BOUNDS, &choices).is_none());
        }
        assert!(told >= 15, "{told}");
    }

    #[test]
    fn where_nothing_can_be_reached_nothing_is_told() {
        let asked = query(0.5, 1.0, 0.0);
        assert_eq!(nearest(&asked, &BOUNDS, |_| false, || false), None);
        assert_eq!(nearest(&asked, &BOUNDS, |_| true, || true), None);
        // The least step is told where everything can be reached.
        let found = nearest(&asked, &BOUNDS, |_| true, || false).expect("anything");
        assert!(found.moved < 1e-3, "{found:?}");
    }
}
