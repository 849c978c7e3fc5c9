//! The evolution strategy over the waypoints of a trajectory: what is not feasible is taken back towards the middle of
//! its generation until it is.

use hairpin::campaign::Case;
use hairpin::campaign::generate::Space;
use nalgebra::{DVector, Point3};
use rayon::prelude::*;

use super::cmaes::{Cmaes, candidates};

/// The first standard deviation, as a share of the mean leg of the trajectory that it starts from.
const FIRST_STEP: f64 = 0.3;
/// Times that a candidate is taken back, each time to this share of the way.
const TIMES: i32 = 10;
const SHARE: f64 = 0.7;
/// Generations in a row without a feasible candidate.
const FRUITLESS: u32 = 20;

/// Which coordinates are searched.
#[derive(Debug, Clone, Copy)]
pub(super) struct Free {
    /// Of each waypoint, the first ones.
    pub(super) coordinates: usize,
    /// Whether the last waypoint may lie elsewhere.
    pub(super) end: bool,
}

impl Free {
    fn waypoints(self, count: usize) -> std::ops::Range<usize> {
        1..count - usize::from(!self.end)
    }

    fn vector(self, points: &[Point3<f64>]) -> DVector<f64> {
        let free = points[self.waypoints(points.len())].iter();
        DVector::from_iterator(
            self.waypoints(points.len()).len() * self.coordinates,
            free.flat_map(|point| point.iter().copied().take(self.coordinates)),
        )
    }

    fn put(self, points: &[Point3<f64>], vector: &DVector<f64>) -> Vec<Point3<f64>> {
        let mut put = points.to_vec();
        let free = self.waypoints(points.len());
        for (point, own) in put[free].iter_mut().zip(vector.as_slice().chunks(self.coordinates)) {
            own.iter().enumerate().for_each(|(axis, value)| point[axis] = *value);
        }
        put
    }
}

/// The most stressful trajectory of `executions`, the first of which are those of `starts`; with how many were made.
///
/// The first generation is drawn at random: its best one is where the strategy begins.
pub(super) fn evolve(
    space: &Space,
    starts: Vec<Case>,
    free: Free,
    (executions, seed): (u64, u64),
    stress: &(dyn Fn(&Case) -> Option<f64> + Sync),
    stopped: &(dyn Fn() -> bool + Sync),
) -> (Option<Case>, u64) {
    let mut made = starts.len() as u64;
    let flown: Vec<_> =
        starts.into_par_iter().filter_map(|case| stress(&case).map(|came_to| (came_to, case))).collect();
    let Some(mut best) = flown.into_iter().reduce(|a, b| if b.0 > a.0 { b } else { a }) else { return (None, made) };
    let start = free.vector(&best.1.waypoints);
    if start.is_empty() {
        return (Some(best.1), made);
    }
    let mut strategy = Cmaes::new(start, FIRST_STEP * mean_leg(&best.1.waypoints), seed);
    let mut middle = best.1.clone();
    let (size, mut fruitless) = (candidates(strategy.mean().len()), 0);
    while made < executions && fruitless < FRUITLESS && !stopped() {
        let asked = strategy.ask(size.min((executions - made) as usize));
        let tried: Vec<_> = asked
            .into_par_iter()
            .filter_map(|x| towards(space, &middle, &free.put(&middle.waypoints, &x)))
            .map(|case| (stress(&case), case))
            .collect();
        made += tried.len() as u64;
        fruitless = if tried.is_empty() { fruitless + 1 } else { 0 };
        let mut ranked: Vec<(f64, Case)> =
            tried.into_iter().filter_map(|(stress, case)| stress.map(|stress| (stress, case))).collect();
        ranked.sort_by(|a, b| b.0.total_cmp(&a.0));
        let vectors: Vec<_> = ranked.iter().map(|(_, case)| free.vector(&case.waypoints)).collect();
        strategy.tell(&vectors);
        if let Some((stress, case)) = ranked.into_iter().next() {
            // The middle of a generation may not be feasible: then the nearest to it that is, from its best one on.
            let mean = free.put(&case.waypoints, strategy.mean());
            middle = towards(space, &case, &mean).unwrap_or_else(|| case.clone());
            if stress > best.0 {
                best = (stress, case);
            }
        }
    }
    (Some(best.1), made)
}

/// `from` over `points`, or as near to them on the way there as is feasible.
fn towards(space: &Space, from: &Case, points: &[Point3<f64>]) -> Option<Case> {
    (0..TIMES).find_map(|time| {
        let share = libm::pow(SHARE, f64::from(time));
        let between: Vec<Point3<f64>> =
            from.waypoints.iter().zip(points).map(|(old, new)| old + (new - old) * share).collect();
        space.over(from, &between)
    })
}

/// m.
fn mean_leg(points: &[Point3<f64>]) -> f64 {
    let legs = points.windows(2).map(|pair| (pair[1] - pair[0]).norm());
    legs.sum::<f64>() / (points.len() - 1).max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ends_stay_and_heights_where_they_are_the_grounds() {
        let points: Vec<Point3<f64>> = (0..4).map(|i| Point3::new(f64::from(i), 10.0, 20.0)).collect();
        let free = Free { coordinates: 2, end: false };
        let vector = free.vector(&points);
        assert_eq!(vector.as_slice(), [1.0, 10.0, 2.0, 10.0]);
        let put = free.put(&points, &DVector::from_vec(vec![5.0, 6.0, 7.0, 8.0]));
        assert_eq!(put, [points[0], Point3::new(5.0, 6.0, 20.0), Point3::new(7.0, 8.0, 20.0), points[3]]);
        assert_eq!(Free { coordinates: 3, end: true }.vector(&points).len(), 9);
        assert_eq!(mean_leg(&points), 1.0);
    }
}
