//! Whether a polynomial path stays in the world and clear of obstacles everywhere, not just at samples.
//!
//! p(τ) = Σ b_i B_i(τ/T): the path is a convex combination of its control points, so it stays in their box; and it
//! stays within max ‖b_i − chord_i‖ of its chord, which a segment's distance to a solid then decides. Both gaps fall
//! with the square of a piece's length. At most 2¹² pieces.
//!
//! ```text
//! p(τ) = Σ_{i=0}^{7} b_i B_i(τ/T),  B_i ≥ 0,  Σ B_i = 1
//! ‖p(τ) − chord(τ/T)‖ ≤ max_i ‖b_i − (b₀ + i/7 (b₇ − b₀))‖
//! ```
//!
//! The second line holds since a linear function has the control points i/7. Obstacles are grown by the clearance,
//! which makes of the robot a ball; its attitude plays no part.

use nalgebra::{Point3, Vector3};

use super::limits::{Infeasible, Limit};
use crate::math::polynomial::{control_points, halve};
use crate::trajectory::ProfileLeg;
use crate::world::{Bounds, Shape, World};

/// Halvings after which a path that is neither clear nor in violation counts as unproven: 1/4096 of the leg.
const DEPTH: u32 = 12;
/// Touching a wall's margin is allowed; this is what rounding may make of touching, m.
const TOUCH: f64 = 1e-9;

/// The space that a robot's centre may use: `keep_in_margin` inside the walls and `clearance` away from obstacles.
///
/// ```
/// use hairpin::feasibility::FreeSpace;
/// use hairpin::math::polynomial::septic;
/// use hairpin::trajectory::ProfileLeg;
/// use hairpin::world::{Obstacle, Shape, World};
/// use nalgebra::Vector3;
///
/// let ball = Obstacle { name: "ball".into(), shape: Shape::sphere([5.0, 5.0, 2.0], 1.0)? };
/// let world = World::new(Vector3::new(10.0, 10.0, 4.0), 0.2, vec![ball])?;
/// let across = |y: f64| {
///     let axis = |from: f64, to: f64| septic(&[from, 0.0, 0.0, 0.0], &[to, 0.0, 0.0, 0.0], 3.0);
///     ProfileLeg { duration: 3.0, coefficients: [axis(1.0, 9.0), axis(y, y), axis(2.0, 2.0)] }
/// };
/// let free = FreeSpace::new(&world, 0.3);
/// assert!(free.contains(&across(2.0)).is_ok());
/// assert!(free.contains(&across(5.5)).is_err()); // 0.5 m beside the centre
/// # Ok::<(), hairpin::world::WorldError>(())
/// ```
#[derive(Debug, Clone)]
pub struct FreeSpace {
    /// Corners of the allowed box, m.
    low: Point3<f64>,
    high: Point3<f64>,
    /// From the centre to any obstacle, m, ≥ 0.
    clearance: f64,
    /// With their boxes, which most questions end at.
    obstacles: Vec<(Bounds, Shape)>,
}

/// Control points of a piece of path and the times at which it begins and ends.
///
/// `points` by axis, m; times in s since the leg began.
struct Piece {
    points: [[f64; 8]; 3],
    from: f64,
    to: f64,
}

impl Piece {
    fn point(&self, i: usize) -> Point3<f64> {
        Point3::new(self.points[0][i], self.points[1][i], self.points[2][i])
    }

    fn bounds(&self) -> Bounds {
        let least = |c: &[f64; 8]| c.iter().copied().fold(f64::INFINITY, f64::min);
        let most = |c: &[f64; 8]| c.iter().copied().fold(f64::NEG_INFINITY, f64::max);
        Bounds {
            min: Point3::from(Vector3::from_fn(|i, _| least(&self.points[i]))),
            max: Point3::from(Vector3::from_fn(|i, _| most(&self.points[i]))),
        }
    }

    /// Bound of the distance between the path and its chord: that of the control points from the chord's own, since
    /// both are sums over the same Bernstein polynomials, which sum to 1.
    ///
    /// m; 0 for a straight piece at even speed.
    fn bulge(&self) -> f64 {
        let (a, b) = (self.point(0), self.point(7));
        (1..7).map(|i| (self.point(i) - (a + (b - a) * (i as f64 / 7.0))).norm()).fold(0.0, f64::max)
    }

    /// De Casteljau at ½: both halves' control points, exactly those of the same path.
    fn halves(&self) -> (Piece, Piece) {
        let (mut left, mut right) = ([[0.0; 8]; 3], [[0.0; 8]; 3]);
        for axis in 0..3 {
            (left[axis], right[axis]) = halve(&self.points[axis]);
        }
        let middle = 0.5 * (self.from + self.to);
        (Piece { points: left, from: self.from, to: middle }, Piece { points: right, from: middle, to: self.to })
    }
}

impl FreeSpace {
    /// The free space of `world` for a robot that needs `clearance` (m) to obstacles.
    pub fn new(world: &World, clearance: f64) -> Self {
        let margin = Vector3::repeat(world.keep_in_margin());
        Self {
            low: Point3::from(margin),
            high: Point3::from(world.size() - margin),
            clearance,
            obstacles: world.obstacles().iter().map(|o| (o.shape.bounds(), o.shape.clone())).collect(),
        }
    }

    /// The corners of the box that the walls leave.
    ///
    /// Lowest and highest, m: the margin inside of the world's own.
    pub fn walls(&self) -> (Point3<f64>, Point3<f64>) {
        (self.low, self.high)
    }

    /// Proves that the whole leg lies in the free space.
    ///
    /// A path lies in the hull of its Bernstein control points, and no farther from its chord than they do; pieces that
    /// this does not decide are halved. A wall may be touched (to 1e-9 m).
    ///
    /// Ends are asked exactly, what lies between them by the hull of the control points; a leg that keeps well clear
    /// costs one look at 8 points an axis and a box test for each obstacle.
    ///
    /// # Errors
    /// The wall or obstacle that is violated, or that is nearer than 1/4096 of the leg can resolve.
    pub fn contains(&self, leg: &ProfileLeg) -> Result<(), Infeasible> {
        let points = std::array::from_fn(|axis| control_points(&leg.coefficients[axis], leg.duration));
        self.check(&Piece { points, from: 0.0, to: leg.duration }, DEPTH)
    }

    /// Depth first, earlier half first. An undecided piece is told by the time and the margin at its beginning.
    fn check(&self, piece: &Piece, depth: u32) -> Result<(), Infeasible> {
        self.allows(&piece.point(0), piece.from)?;
        self.allows(&piece.point(7), piece.to)?;
        let Some((limit, part)) = self.undecided(piece) else { return Ok(()) };
        if depth == 0 {
            let margin = match limit {
                Limit::World => self.wall_margin(&piece.point(0), part),
                _ => self.obstacles[part].1.signed_distance(&piece.point(0)) - self.clearance,
            };
            return Err(Infeasible::Unproven { limit, part: part as u16, at: piece.from, margin });
        }
        let (left, right) = piece.halves();
        self.check(&left, depth - 1)?;
        self.check(&right, depth - 1)
    }

    /// Whether `p`, where the path is `at` seconds after it began, lies in the free space.
    ///
    /// `at` is only told. A NaN coordinate violates a wall.
    ///
    /// # Errors
    /// The wall or obstacle that is too near.
    pub fn allows(&self, p: &Point3<f64>, at: f64) -> Result<(), Infeasible> {
        for axis in 0..3 {
            let margin = self.wall_margin(p, axis);
            if margin.is_nan() || margin < -TOUCH {
                return Err(Infeasible::Violates { limit: Limit::World, part: axis as u16, at, margin });
            }
        }
        for (index, (bounds, shape)) in self.obstacles.iter().enumerate() {
            if bounds.distance(p) < self.clearance.max(f64::MIN_POSITIVE) {
                let margin = shape.signed_distance(p) - self.clearance;
                if margin < 0.0 {
                    return Err(Infeasible::Violates { limit: Limit::Obstacle, part: index as u16, at, margin });
                }
            }
        }
        Ok(())
    }

    /// The first limit that the control points do not show to hold.
    ///
    /// Limits in the order of the axes, then of the obstacles. Bounds err towards undecided: a box of control points is
    /// larger than the path's.
    fn undecided(&self, piece: &Piece) -> Option<(Limit, usize)> {
        let bounds = piece.bounds();
        for axis in 0..3 {
            if bounds.min[axis] < self.low[axis] - TOUCH || bounds.max[axis] > self.high[axis] + TOUCH {
                return Some((Limit::World, axis));
            }
        }
        self.obstacles.iter().enumerate().find_map(|(index, (around, shape))| {
            let far = around.distance_to(&bounds) >= self.clearance.max(f64::MIN_POSITIVE);
            let clear = far
                || shape.segment_distance(&piece.point(0), &piece.point(7)) - piece.bulge() >= self.clearance + TOUCH;
            (!clear).then_some((Limit::Obstacle, index))
        })
    }

    /// Distance to the nearer of two opposite walls' margins, m; negative beyond.
    fn wall_margin(&self, p: &Point3<f64>, axis: usize) -> f64 {
        (p[axis] - self.low[axis]).min(self.high[axis] - p[axis])
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::polynomial::septic;
    use crate::math::random::stream;
    use crate::world::Obstacle;
    use rand::RngExt;

    fn space() -> (World, FreeSpace) {
        let obstacles = vec![
            Obstacle {
                name: "mast".into(),
                shape: Shape::Box { center: Point3::new(5.0, 5.0, 5.0), half_extents: Vector3::new(1.0, 1.0, 5.0) },
            },
            Obstacle { name: "ball".into(), shape: Shape::Sphere { center: Point3::new(2.0, 8.0, 4.0), radius: 0.7 } },
        ];
        let world = World::new(Vector3::repeat(10.0), 0.5, obstacles).unwrap();
        let space = FreeSpace::new(&world, 0.3);
        (world, space)
    }

    fn random_leg(seed: u64) -> ProfileLeg {
        let mut random = stream(seed);
        let duration = random.random_range(0.8..3.0);
        let coefficients = std::array::from_fn(|_| {
            let mut end = || [random.random_range(0.6..9.4), random.random_range(-3.0..3.0), 0.0, 0.0];
            septic(&end(), &end(), duration)
        });
        ProfileLeg { duration, coefficients }
    }

    #[test]
    fn agrees_with_dense_sampling() {
        let (world, space) = space();
        let (mut accepted, mut unproven, mut refused) = (0, 0, 0);
        for seed in 0..3000 {
            let leg = random_leg(seed);
            let free = |t: f64, clearance: f64| {
                let p = leg.position(t);
                world.wall_distance(&p) >= world.keep_in_margin() - 2.0 * TOUCH
                    && world.obstacle_distance(&p) >= clearance
            };
            let samples = 1000;
            match space.contains(&leg) {
                Ok(()) => {
                    accepted += 1;
                    for k in 0..=samples {
                        assert!(free(leg.duration * k as f64 / samples as f64, 0.3), "seed {seed}, sample {k}");
                    }
                }
                Err(Infeasible::Violates { at, .. }) => {
                    refused += 1;
                    assert!(!free(at, 0.3), "seed {seed}: no violation at {at}");
                }
                Err(Infeasible::Unproven { .. }) => unproven += 1,
            }
        }
        assert!(accepted > 150 && refused > 150, "{accepted} accepted, {refused} refused");
        assert!(unproven <= 1, "{unproven} of 3000 not decided");
    }

    #[test]
    fn a_needle_between_samples_is_seen_and_a_wall_may_be_touched() {
        let (_, space) = space();
        // Up and down again through the margin of the ceiling: 9.5 m is overstepped by 1 µm for about 1 ms.
        let mut leg = ProfileLeg { duration: 1.0, coefficients: [[0.0; 8]; 3] };
        leg.coefficients[0][0] = 1.0;
        leg.coefficients[1][0] = 1.0;
        let touch = |height: f64| [height - 4.0 * 0.3141f64.powi(2), 8.0 * 0.3141, -4.0, 0.0, 0.0, 0.0, 0.0, 0.0];
        leg.coefficients[2] = touch(9.5 + 1e-6);
        assert!(matches!(
            space.contains(&leg),
            Err(Infeasible::Violates { limit: Limit::World, part: 2, .. })
                | Err(Infeasible::Unproven { limit: Limit::World, part: 2, .. })
        ));
        leg.coefficients[2] = touch(9.5 - 1e-6);
        assert_eq!(space.contains(&leg), Ok(()));
        // At rest exactly on the margin.
        leg.coefficients[2] = septic(&[0.5, 0.0, 0.0, 0.0], &[3.0, 0.0, 0.0, 0.0], 1.0);
        assert_eq!(space.contains(&leg), Ok(()));
        leg.coefficients[2][0] = f64::NAN;
        assert!(space.contains(&leg).is_err());
    }
}
