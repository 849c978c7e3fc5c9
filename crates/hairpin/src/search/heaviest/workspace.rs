//! Questions of the published kind: points that an arm reaches, and arcs that keep clear of its base.

use nalgebra::{Point3, Vector3};

use super::problem::{Arcs, ArcsMistake};
use crate::math::random::{Stream, named_seed, standard_normals, stream, unit};

/// What an arm reaches: a ball around its shoulder, above the floor, without a core around the same centre.
///
/// Source: Collet, Gotlieb, Lazaar & Mossige, "Stress testing of single-arm robots through constraint-based generation
/// of continuous trajectories" (2019).
///
/// ```
/// use hairpin::search::heaviest::Workspace;
///
/// let points = Workspace::PUBLISHED.points(40, 1);
/// let arcs = Workspace::PUBLISHED.arcs(&points)?;
/// assert!(arcs.symmetric() && (0.6..0.9).contains(&arcs.density()));
/// # Ok::<(), hairpin::search::heaviest::ArcsMistake>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Workspace {
    /// Height of the centre above the floor, m.
    height: f64,
    /// Radius of the ball, m.
    reach: f64,
    /// Radius of the core, m; below `reach`.
    core: f64,
}

impl Workspace {
    /// The published one, 580 mm and 190 mm around (0, 0, 290) mm: three arcs of four are left.
    pub const PUBLISHED: Self = Self { height: 0.29, reach: 0.58, core: 0.19 };
    /// The same with a core of 430 mm: three arcs of ten are left.
    pub const HOLLOW: Self = Self { core: 0.43, ..Self::PUBLISHED };

    /// `count` points, uniform in the workspace, m; the same seed gives the same points.
    ///
    /// By rejection from the cube around the ball: 2.4 draws a point in the published one.
    pub fn points(&self, count: usize, seed: u64) -> Vec<Point3<f64>> {
        let mut random = stream(seed);
        let mut draws = std::iter::repeat_with(|| self.in_the_cube(&mut random));
        draws.by_ref().filter(|point| self.contains(point)).take(count).collect()
    }

    /// `count` points in `clusters` clusters, as people teach them: normal with a deviation of `spread` m in each
    /// coordinate about centres that are uniform in the workspace; the same seed gives the same points.
    ///
    /// Points take turns among the clusters; those outside the workspace are drawn again. `clusters` of 0 is taken as
    /// 1.
    pub fn clustered(&self, count: usize, clusters: usize, spread: f64, seed: u64) -> Vec<Point3<f64>> {
        let centres = self.points(clusters.max(1), named_seed(seed, "centres", 0));
        let mut random = stream(named_seed(seed, "clusters", 0));
        let mut near = |index: usize| loop {
            let shift = Vector3::from(standard_normals::<3>(&mut random)) * spread;
            let point = centres[index % centres.len()] + shift;
            if self.contains(&point) {
                return point;
            }
        };
        (0..count).map(&mut near).collect()
    }

    /// The arcs between `points` in both directions, where the segment keeps clear of the core; costs are distances in
    /// whole micrometres. Ball and half space are convex: segments between points in them need no look.
    ///
    /// Symmetric to the bit. O(n²) segments.
    ///
    /// # Errors
    /// No point, or too many.
    pub fn arcs(&self, points: &[Point3<f64>]) -> Result<Arcs, ArcsMistake> {
        let cost = |from: usize, to: usize| {
            // In one order, so that both directions have the same bits.
            let (from, to) = (points[from.min(to)], points[from.max(to)]);
            self.clear(&from, &to).then(|| ((to - from).norm() * 1e6).round() as i64)
        };
        let n = points.len();
        let costs: Vec<Option<i64>> = (0..n * n).map(|index| cost(index / n, index % n)).collect();
        Arcs::new(n, &costs)
    }

    /// Where ball and core have their centre, m.
    pub fn centre(&self) -> Point3<f64> {
        Point3::new(0.0, 0.0, self.height)
    }

    /// Radii of the ball and of the core, m.
    pub fn radii(&self) -> [f64; 2] {
        [self.reach, self.core]
    }

    fn in_the_cube(&self, random: &mut Stream) -> Point3<f64> {
        let [x, y, z] = [0; 3].map(|_: i32| (2.0 * unit(random) - 1.0) * self.reach);
        Point3::new(x, y, z + self.height)
    }

    /// Whether the point is in the ball, above the floor, and outside the core.
    pub fn contains(&self, point: &Point3<f64>) -> bool {
        let distance = (point - self.centre()).norm();
        distance <= self.reach && distance > self.core && point.z >= 0.0
    }

    /// Whether the point of the segment that is nearest to the centre is outside the core.
    fn clear(&self, from: &Point3<f64>, to: &Point3<f64>) -> bool {
        let leg = to - from;
        let squares = leg.norm_squared();
        let along = if squares > 0.0 { (self.centre() - from).dot(&leg) / squares } else { 0.0 };
        (from + leg * along.clamp(0.0, 1.0) - self.centre()).norm() > self.core
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn arcs_are_those_whose_samples_are_all_in_the_workspace() {
        for workspace in [Workspace::PUBLISHED, Workspace::HOLLOW] {
            let points = workspace.points(60, 5);
            let arcs = workspace.arcs(&points).unwrap();
            for i in 0..60 {
                for j in (0..60).filter(|j| *j != i) {
                    let leg = points[j] - points[i];
                    let mut samples = (0..=1000).map(|k| points[i] + leg * (f64::from(k) / 1000.0));
                    let inside = samples.all(|sample| workspace.contains(&sample));
                    // A thousand samples can miss a chord of the core of a thousandth of the leg, not more.
                    let grazes = !workspace.clear(&points[i], &points[j]) && inside;
                    assert!(!grazes || almost_clear(workspace, &points[i], &points[j]), "{i}→{j}");
                    assert_eq!(arcs.cost(i, j).is_some(), inside && !grazes, "{i}→{j}");
                    let micrometres = arcs.cost(i, j).map_or(leg.norm() * 1e6, |cost| cost as f64);
                    assert!((micrometres - leg.norm() * 1e6).abs() <= 0.5, "{i}→{j}");
                }
            }
        }
    }

    /// Clear of a core that is a micrometre smaller.
    fn almost_clear(workspace: Workspace, from: &Point3<f64>, to: &Point3<f64>) -> bool {
        Workspace { core: workspace.core - 1e-6, ..workspace }.clear(from, to)
    }

    #[test]
    fn clusters_are_as_wide_as_was_asked() {
        let workspace = Workspace::PUBLISHED;
        let points = workspace.clustered(300, 3, 0.02, 5);
        let centres = workspace.points(3, named_seed(5, "centres", 0));
        for (cluster, centre) in centres.iter().enumerate() {
            let own: Vec<_> = points.iter().skip(cluster).step_by(3).collect();
            assert_eq!(own.len(), 100);
            let square: f64 = own.iter().map(|p| (*p - centre).norm_squared()).sum::<f64>() / 300.0;
            assert!((0.015..0.025).contains(&square.sqrt()), "{square}");
            assert!(own.iter().all(|p| workspace.contains(p)));
        }
    }

    #[test]
    fn densities_are_as_told_and_points_come_again() {
        for (workspace, density) in [(Workspace::PUBLISHED, 0.77), (Workspace::HOLLOW, 0.3)] {
            let points = workspace.points(300, 1);
            assert_eq!(points, workspace.points(300, 1));
            assert_ne!(points, workspace.points(300, 2));
            assert!(points.iter().all(|point| workspace.contains(point)));
            let arcs = workspace.arcs(&points).unwrap();
            assert!(arcs.symmetric());
            assert!((arcs.density() - density).abs() < 0.04, "{}", arcs.density());
        }
        assert_eq!(Workspace::PUBLISHED.arcs(&[]), Err(ArcsMistake::Empty));
    }
}
