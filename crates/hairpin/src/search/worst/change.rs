//! How a plan becomes another: waypoints moved, put elsewhere, drawn together, taken from other plans; and what only
//! the field knows to change.
//!
//! Most changes lie around the leg that a plan owes its stress to: what is stressful there stays, and is made more so.
//!
//! Each change gives waypoints, never a plan: feasibility is [`Field::over`]'s. A child that is not feasible is tried
//! again up to eight times with a step 0.6 times as long, so that σ adapts to how much room there is.
//!
//! | change | waypoints | source |
//! | --- | --- | --- |
//! | step | x + σ n, σ inherited and mutated by e^(0.4 n) | evolution strategies with self-adaptation |
//! | place | neighbour + f · longest leg · a uniform direction, f = 0.05^u | log-uniform distances |
//! | together | neighbour + f (x − neighbour) | the same |
//! | difference | x + f (a − b), f ≤ 0.8 | Storn and Price 1997 |
//! | motif, cross | stretches of other plans | recombination |

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::archive::Member;
use super::field::Field;
use crate::math::random::{Stream, standard_normals, unit};

/// Share of changes around the worst leg.
/// The others keep the search from missing that the stress has moved to another leg.
const AROUND_WORST: f64 = 0.7;
/// Smallest factor of a distance: of the longest leg where a waypoint is put anew, of the present one where waypoints
/// are drawn towards another.
const LEAST_FACTOR: f64 = 0.05;
/// A step is multiplied by e^(this · a normal number) from parent to child …
const STEPS_VARY: f64 = 0.4;
/// … within these shares of the mean leg.
/// Below the first a step is no other trajectory, above the second it is a new draw.
const STEPS: [f64; 2] = [0.003, 0.5];
/// Step of what was drawn.
/// As a share of the mean leg.
pub(super) const FIRST_STEP: f64 = 0.15;
/// Tries for one child; each but the first with smaller steps.
/// None costs an execution, each a question of feasibility.
const TRIES: i32 = 8;

/// A way to come to a new plan.
///
/// Which of them is tried is the portfolio's business, so that none has to be tuned for a robot.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Change {
    /// Drawn at random.
    Draw,
    /// One to three waypoints in a row moved by a normal step that children inherit.
    Step,
    /// One waypoint put anew about a neighbour, in any direction.
    Place,
    /// One to three waypoints drawn towards a neighbour.
    Together,
    /// A stretch of waypoints moved by a share of the difference of two other plans.
    Difference,
    /// The waypoints around the worst leg of another plan, turned about the vertical, put into this one.
    Motif,
    /// One waypoint put to another place that the plan was drawn from.
    Elsewhere,
    /// The beginning of one plan and the rest of another.
    Cross,
    /// Something else than waypoints changed.
    Alter,
}

impl Change {
    /// Where waypoints may be put anywhere.
    pub(super) const ALL: [Change; 9] = [
        Change::Draw,
        Change::Step,
        Change::Place,
        Change::Together,
        Change::Difference,
        Change::Motif,
        Change::Elsewhere,
        Change::Cross,
        Change::Alter,
    ];
    /// Where they are taken from those that plans are drawn from.
    pub(super) const OF_GRAPHS: [Change; 4] = [Change::Draw, Change::Elsewhere, Change::Cross, Change::Alter];
}

/// A plan to be executed.
///
/// Feasible, not executed yet, and maybe known already.
pub(super) struct Child<P> {
    pub(super) plan: P,
    /// Step of its own children.
    /// A share of the mean leg, within [`STEPS`]: that at which a try was feasible.
    pub(super) step: f64,
}

/// A child by `change` of `parents`, the most stressful first, of which the first `cases` would be the answer; `None`
/// where none of eight tries is feasible. `draw` is the number of the plan that is drawn.
///
/// Draws nothing beside `random`. Where there are no parents every change is a draw.
pub(super) fn child<F: Field>(
    field: &F,
    change: Change,
    (parents, cases): (&[&Member<F::Plan>], usize),
    draw: u64,
    random: &mut Stream,
) -> Option<Child<F::Plan>> {
    if change == Change::Draw || parents.is_empty() {
        return field.draw(draw).ok().map(|plan| Child { plan, step: FIRST_STEP });
    }
    let parent = parents[own(parents.len(), cases, random)];
    let step = (parent.step * libm::exp(STEPS_VARY * standard_normals::<1>(random)[0])).clamp(STEPS[0], STEPS[1]);
    (0..TRIES).find_map(|retry| {
        let shrunk = step * libm::pow(0.6, f64::from(retry));
        let plan = changed(field, change, parent, parents, shrunk, random)?;
        Some(Child { plan, step: shrunk.max(STEPS[0]) })
    })
}

/// `step` is a share of the mean leg of `parent`.
fn changed<F: Field>(
    field: &F,
    change: Change,
    parent: &Member<F::Plan>,
    parents: &[&Member<F::Plan>],
    step: f64,
    random: &mut Stream,
) -> Option<F::Plan> {
    let points = field.points(&parent.plan);
    let worst = parent.trial.worst_leg;
    match change {
        Change::Draw => None,
        Change::Alter => field.altered(&parent.plan, leg(points, worst, random), random),
        Change::Cross => {
            let other = parents[among(parents.len(), random)];
            field.crossed(&parent.plan, &other.plan, random.random_range(0..legs(points)), random)
        }
        Change::Elsewhere => {
            let at = inner(points, worst, 1, random)?;
            let mut moved = points.to_vec();
            moved[at] = field.elsewhere(&parent.plan, random)?;
            field.over(&parent.plan, &moved)
        }
        Change::Difference => {
            let [a, b] = [0, 1].map(|_| field.points(&parents[random.random_range(0..parents.len())].plan));
            field.over(&parent.plan, &by_difference(points, worst, [a, b], step, random)?)
        }
        Change::Motif => {
            let donor = parents[among(parents.len(), random)];
            field.over(&parent.plan, &with_motif(points, field.points(&donor.plan), donor.trial.worst_leg, random)?)
        }
        Change::Step | Change::Place | Change::Together => {
            field.over(&parent.plan, &moved(change, points, worst, step, random)?)
        }
    }
}

/// Who is changed: every second time one of those that would be the answer, all of them alike, so that each of their
/// places is searched; else one of all, the first more often.
///
/// An index into parents. `count` is at least 1.
fn own(count: usize, cases: usize, random: &mut Stream) -> usize {
    if unit(random) < 0.5 { random.random_range(0..count.min(cases.max(1))) } else { among(count, random) }
}

/// One of `count`, the first more often: u^1.5 of them.
///
/// P(first tenth) = 0.1^(2/3) = 22 %, for a `count` that is large.
fn among(count: usize, random: &mut Stream) -> usize {
    let u = unit(random);
    ((u * u.sqrt()) * count as f64) as usize
}

/// Legs of a plan, at least 1 so that it may be divided by.
fn legs(points: &[Point3<f64>]) -> usize {
    points.len().saturating_sub(1).max(1)
}

/// A leg, mostly the worst or one beside it.
///
/// 7 of 10 times one of `worst` − 1 … `worst` + 1, kept within the plan.
fn leg(points: &[Point3<f64>], worst: usize, random: &mut Stream) -> usize {
    if unit(random) < AROUND_WORST {
        (worst + random.random_range(0..3usize)).saturating_sub(1).min(legs(points) - 1)
    } else {
        random.random_range(0..legs(points))
    }
}

/// The first of `count` waypoints in a row between both ends, mostly at the worst leg; `None` where there are not as
/// many.
///
/// An index in 1 … n − 1 − `count`: start and end are the task's and stay.
fn inner(points: &[Point3<f64>], worst: usize, count: usize, random: &mut Stream) -> Option<usize> {
    let last = points.len().checked_sub(1 + count).filter(|last| *last >= 1)?;
    Some(if unit(random) < AROUND_WORST {
        (worst + random.random_range(0..=3usize)).saturating_sub(2).clamp(1, last)
    } else {
        random.random_range(1..=last)
    })
}

/// m.
///
/// Mean length of a leg; 0 for a single point.
fn mean_leg(points: &[Point3<f64>]) -> f64 {
    points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).sum::<f64>() / legs(points) as f64
}

/// `points` with one to three waypoints stepped, placed anew or drawn together.
///
/// Both ends stay. `step` is a share of the mean leg; distances of the other two are log-uniform between 0.05 and 1
/// of the longest leg or of the present distance. `None` where there is no waypoint between the ends.
fn moved(
    change: Change,
    points: &[Point3<f64>],
    worst: usize,
    step: f64,
    random: &mut Stream,
) -> Option<Vec<Point3<f64>>> {
    let most = points.len().checked_sub(2).filter(|most| *most > 0)?.min(3);
    let count = if change == Change::Place { 1 } else { random.random_range(1..=most) };
    let begin = inner(points, worst, count, random)?;
    let mut moved = points.to_vec();
    let changed = &mut moved[begin..begin + count];
    if change == Change::Step {
        let sigma = step * mean_leg(points);
        changed.iter_mut().for_each(|point| *point += Vector3::from(standard_normals::<3>(random)) * sigma);
        return Some(moved);
    }
    let neighbour = points[if unit(random) < 0.5 { begin + count } else { begin - 1 }];
    let factor = libm::pow(LEAST_FACTOR, unit(random));
    if change == Change::Place {
        let longest = points.windows(2).map(|pair| (pair[1] - pair[0]).norm()).fold(0.0, f64::max);
        let way = Vector3::from(standard_normals::<3>(random));
        changed[0] = neighbour + way * (factor * longest / way.norm().max(f64::MIN_POSITIVE));
    } else {
        changed.iter_mut().for_each(|point| *point = neighbour + (*point - neighbour) * factor);
    }
    Some(moved)
}

/// x + f (a − b) over a stretch, f up to 0.8, with a small step beside it. Source: Storn and Price, Differential
/// evolution, 1997.
///
/// Differences of parents span the directions in which good plans differ, and shrink as these become alike: the step
/// needs no scale of its own. The small normal step keeps equal parents from changing nothing. `None` where one of
/// the plans has no inner waypoint.
fn by_difference(
    points: &[Point3<f64>],
    worst: usize,
    [a, b]: [&[Point3<f64>]; 2],
    step: f64,
    random: &mut Stream,
) -> Option<Vec<Point3<f64>>> {
    let most = points.len().min(a.len()).min(b.len()).checked_sub(2).filter(|most| *most > 0)?;
    let count = random.random_range(1..=most);
    let begin = inner(points, worst, count, random)?;
    let (factor, sigma) = (0.8 * unit(random), 0.1 * step * mean_leg(points));
    let mut moved = points.to_vec();
    for k in begin..begin + count {
        moved[k] += (a[k] - b[k]) * factor + Vector3::from(standard_normals::<3>(random)) * sigma;
    }
    Some(moved)
}

/// `points` with two to four waypoints around the worst leg of `donor` in the place of as many, turned about the
/// vertical by any angle and hung up at the waypoint before them.
///
/// The motif keeps its climb and the lengths of its legs; the waypoint behind it stays, so that one leg takes up what
/// is left over. `None` where either plan has less than two inner waypoints.
fn with_motif(
    points: &[Point3<f64>],
    donor: &[Point3<f64>],
    worst: usize,
    random: &mut Stream,
) -> Option<Vec<Point3<f64>>> {
    let most = points.len().min(donor.len()).checked_sub(2).filter(|most| *most >= 2)?.min(4);
    let count = random.random_range(2..=most);
    // What leads into the worst leg belongs to it: the waypoint after it is the last of the motif, or the last but one.
    let last = (worst + 1 + random.random_range(0..2usize)).min(donor.len() - 1);
    let first = (last + 1).saturating_sub(count).max(1);
    let at = random.random_range(1..=points.len() - 1 - count);
    let (sin, cos) = libm::sincos(std::f64::consts::TAU * unit(random));
    let turned = |v: Vector3<f64>| Vector3::new(cos * v.x - sin * v.y, sin * v.x + cos * v.y, v.z);
    let mut changed = points.to_vec();
    for k in 0..count.min(donor.len() - first) {
        changed[at + k] = changed[at - 1] + turned(donor[first + k] - donor[first + k - 1]);
    }
    Some(changed)
}
