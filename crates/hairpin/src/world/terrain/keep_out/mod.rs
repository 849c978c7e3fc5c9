//! Places on the ground that no vehicle may enter: circles and polygons seen from above, by signed distances.
//!
//! In plan: heights play no part, and a bridge cannot be passed under. Vehicles keep the circle around all wheels and
//! the underside out of them (floor 5); here a vehicle is a point and a distance.

mod index;
mod shape;

pub use shape::KeepOutShape;

use self::index::Index;
use crate::world::WorldError;

/// A named place to keep out of.
#[derive(Debug, Clone, PartialEq)]
pub struct KeepOut {
    /// Name for reports.
    pub name: String,
    /// The place, world frame.
    pub shape: KeepOutShape,
}

/// Places to keep out of, checked, with a tree of boxes over them, so that hundreds cost little more than one.
///
/// Found by descending the tree only into boxes that can hold something nearer: about log n shapes a query.
///
/// ```
/// use hairpin::world::terrain::{KeepOut, KeepOutShape, KeepOuts};
///
/// let circle = |name: &str, x| KeepOut {
///     name: name.into(),
///     shape: KeepOutShape::Circle { center_m: [x, 0.0], radius_m: 1.0 },
/// };
/// let places = KeepOuts::new(vec![circle("west", -5.0), circle("east", 5.0)])?;
/// let nearest = places.nearest(3.0, 0.0).expect("there are two");
/// assert_eq!((nearest.keep_out.name.as_str(), nearest.distance), ("east", 1.0));
/// assert_eq!(places.segment_distance([0.0, -2.0], [0.0, 2.0]), 4.0);
/// # Ok::<(), hairpin::world::WorldError>(())
/// ```
#[derive(Debug, Clone, Default)]
pub struct KeepOuts {
    list: Vec<KeepOut>,
    index: Index,
}

/// The nearest of some places to keep out of.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Nearest<'a> {
    /// m; negative inside.
    pub distance: f64,
    /// Which one; the first of equals.
    pub keep_out: &'a KeepOut,
    /// Its place in the list.
    pub index: usize,
}

impl KeepOuts {
    /// Checks `list`.
    ///
    /// # Errors
    /// `keep_out[i].circle.center_m`, `.circle.radius_m`, `.polygon.points_m`: not finite or beyond 10⁷ m, no radius,
    /// fewer than three points, no area.
    pub fn new(list: Vec<KeepOut>) -> Result<Self, WorldError> {
        for (index, keep_out) in list.iter().enumerate() {
            keep_out.shape.check().map_err(|error| error.within(&format!("keep_out[{index}]")))?;
        }
        let index = Index::new(list.iter().map(|keep_out| keep_out.shape.bounds()).collect());
        Ok(Self { list, index })
    }

    /// All of them, in their order.
    pub fn list(&self) -> &[KeepOut] {
        &self.list
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.list.is_empty()
    }

    /// Signed distance from (`x`, `y`) to the nearest, m: negative inside one, +∞ without any.
    pub fn distance(&self, x: f64, y: f64) -> f64 {
        self.nearest(x, y).map_or(f64::INFINITY, |nearest| nearest.distance)
    }

    /// The one nearest to (`x`, `y`), or the one it is deepest in.
    ///
    /// Inside overlapping ones the deepest, that is the least signed distance.
    pub fn nearest(&self, x: f64, y: f64) -> Option<Nearest<'_>> {
        self.least([x, y], 0.0, |shape| shape.distance(x, y))
    }

    /// Smallest signed distance along the straight line from `from` to `to`, m; ≤ 0 if it meets one, +∞ without any.
    /// Where a polygon is met the value is an upper bound (the deeper end's, or 0).
    pub fn segment_distance(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        self.nearest_to_segment(from, to).map_or(f64::INFINITY, |nearest| nearest.distance)
    }

    /// The one nearest to the straight line from `from` to `to`.
    ///
    /// Its distance is that of [`KeepOuts::segment_distance`]: exact where nothing is met.
    pub fn nearest_to_segment(&self, from: [f64; 2], to: [f64; 2]) -> Option<Nearest<'_>> {
        let middle = [0.5 * (from[0] + to[0]), 0.5 * (from[1] + to[1])];
        let half = 0.5 * libm::hypot(to[0] - from[0], to[1] - from[1]);
        self.least(middle, half, |shape| shape.segment_distance(from, to))
    }

    fn least(&self, at: [f64; 2], reach: f64, distance: impl Fn(&KeepOutShape) -> f64) -> Option<Nearest<'_>> {
        let (index, distance) = self.index.least(at, reach, |index| distance(&self.list[index].shape))?;
        Some(Nearest { distance, keep_out: &self.list[index], index })
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::math::random::hashed_unit;

    fn circle(x: f64, y: f64, radius_m: f64) -> KeepOut {
        KeepOut { name: format!("circle {x} {y}"), shape: KeepOutShape::Circle { center_m: [x, y], radius_m } }
    }

    fn polygon(points: &[[f64; 2]]) -> KeepOut {
        KeepOut { name: "polygon".into(), shape: KeepOutShape::Polygon { points_m: points.to_vec() } }
    }

    /// A star around a place: neither convex nor in line with any axis.
    fn star(seed: u64) -> KeepOut {
        let unit = |i: u64| hashed_unit(seed, &[i]);
        let (x, y) = (40.0 * unit(0), 40.0 * unit(1));
        let points: Vec<[f64; 2]> = (0..9_u64)
            .map(|i| {
                let (sin, cos) = libm::sincos(0.698 * i as f64 + unit(2));
                let r = 0.3 + 1.5 * unit(3 + i);
                [x + r * cos, y + r * sin]
            })
            .collect();
        KeepOut { name: format!("star {seed}"), ..polygon(&points) }
    }

    fn many() -> KeepOuts {
        let unit = |i: u64| hashed_unit(7, &[i]);
        let circles = (0..150).map(|i| circle(40.0 * unit(3 * i), 40.0 * unit(3 * i + 1), 0.1 + unit(3 * i + 2)));
        KeepOuts::new(circles.chain((0..150).map(star)).collect()).expect("places")
    }

    #[test]
    fn the_tree_finds_what_asking_everyone_finds() {
        let places = many();
        for i in 0..3000_u64 {
            let unit = |k: u64| 60.0 * hashed_unit(8, &[i, k]) - 10.0;
            let (x, y) = (unit(0), unit(1));
            let all = places.list().iter().map(|k| k.shape.distance(x, y)).fold(f64::INFINITY, f64::min);
            let nearest = places.nearest(x, y).expect("places");
            assert_eq!((nearest.distance, nearest.keep_out.shape.distance(x, y)), (all, all), "at ({x}, {y})");
            let to = [x + 0.05 * unit(2), y + 0.05 * unit(3)];
            let all = places.list().iter().map(|k| k.shape.segment_distance([x, y], to)).fold(f64::INFINITY, f64::min);
            assert_eq!(places.segment_distance([x, y], to), all, "from ({x}, {y}) to {to:?}");
        }
    }

    #[test]
    fn segments_are_as_near_as_their_nearest_points() {
        let places = many();
        let mut met = 0;
        for i in 0..400_u64 {
            let unit = |k: u64| hashed_unit(9, &[i, k]);
            let from = [40.0 * unit(0), 40.0 * unit(1)];
            let to = [from[0] + 2.0 * unit(2) - 1.0, from[1] + 2.0 * unit(3) - 1.0];
            let sampled = (0..=2000)
                .map(|k| f64::from(k) / 2000.0)
                .map(|t| places.distance(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1])))
                .fold(f64::INFINITY, f64::min);
            let found = places.segment_distance(from, to);
            if sampled > 2e-3 {
                assert!(found <= sampled + 1e-12 && sampled - found < 1e-3, "{found}, not {sampled}");
            } else if sampled < -2e-3 {
                met += 1;
                assert!(found <= 0.0 && found >= sampled - 1e-3, "{found}, not ≤ 0 and ≥ {sampled}");
            }
        }
        assert!(met > 50, "{met} segments met something");
    }

    #[test]
    fn distances_of_a_square_and_of_a_crossed_polygon_are_known() {
        let square = KeepOuts::new(vec![polygon(&[[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]])]).expect("a place");
        for (x, y, distance) in
            [(1.0, 1.0, -1.0), (1.0, 1.75, -0.25), (3.0, 1.0, 1.0), (5.0, 6.0, 5.0), (2.0, 1.0, 0.0)]
        {
            assert!((square.distance(x, y) - distance).abs() < 1e-12, "({x}, {y})");
        }
        assert_eq!(square.segment_distance([-1.0, 1.0], [3.0, 1.0]), 0.0);
        assert_eq!(square.segment_distance([-1.0, 1.0], [1.0, 1.5]), -0.5);
        // Even-odd: a five-pointed star keeps nobody out of its middle.
        let tip = |i: i32| {
            let (sin, cos) = libm::sincos(2.0 * std::f64::consts::TAU / 5.0 * f64::from(i));
            [cos, sin]
        };
        let star = KeepOuts::new(vec![polygon(&[tip(0), tip(1), tip(2), tip(3), tip(4)])]).expect("a place");
        assert!(star.distance(0.0, 0.0) > 0.3 && star.distance(0.6, 0.0) < 0.0);
    }

    #[test]
    fn without_places_everything_is_far_and_wrong_ones_are_named() {
        let none = KeepOuts::default();
        assert!(none.is_empty() && none.distance(0.0, 0.0) == f64::INFINITY && none.nearest(0.0, 0.0).is_none());
        for (wrong, field) in [
            (circle(f64::NAN, 0.0, 1.0), "keep_out[1].circle.center_m = [NaN, 0.0]"),
            (circle(0.0, 0.0, 0.0), "keep_out[1].circle.radius_m = 0"),
            (circle(0.0, 0.0, f64::INFINITY), "keep_out[1].circle.radius_m = inf"),
            (polygon(&[[0.0, 0.0], [1.0, 0.0]]), "keep_out[1].polygon.points_m = 2 points"),
            (polygon(&[[0.0, 0.0], [1.0, 0.0], [0.0, f64::NAN]]), "keep_out[1].polygon.points_m[2]"),
            (polygon(&[[0.0, 0.0], [1.0, 1.0], [3.0, 3.0]]), "keep_out[1].polygon.points_m"),
        ] {
            let error = KeepOuts::new(vec![circle(0.0, 0.0, 1.0), wrong]).expect_err(field).to_string();
            assert!(error.starts_with(field), "{error}");
        }
    }
}
