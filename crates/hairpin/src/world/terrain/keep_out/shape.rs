//! Shapes in the plane and their signed distances to points and straight lines.

use crate::world::WorldError;

/// A place seen from above, world frame, m.
///
/// The border belongs to it. A polygon's inside is by the even-odd rule, so that the order of its corners does not
/// matter.
///
/// Checked where a list is made of it: finite corners within ±10 000 km, radii above 0.
#[derive(Debug, Clone, PartialEq)]
pub enum KeepOutShape {
    /// All points within `radius_m` of `center_m`.
    Circle {
        /// x, y.
        center_m: [f64; 2],
        /// Radius, > 0.
        radius_m: f64,
    },
    /// The inside of a closed polygon, either way round; where edges cross, what a ray leaves through an odd number of
    /// edges.
    Polygon {
        /// Corners, at least three, the last joined to the first.
        points_m: Vec<[f64; 2]>,
    },
}

/// Coordinates beyond this (m) are refused: their squares would lose the centimetres.
const LARGEST: f64 = 1e7;

impl KeepOutShape {
    /// Distance of (`x`, `y`) to the border, m; negative inside.
    ///
    /// Polygons: the nearest edge, and the number of edges that a ray to the east crosses. Linear in the corners.
    pub fn distance(&self, x: f64, y: f64) -> f64 {
        match self {
            Self::Circle { center_m, radius_m } => libm::hypot(x - center_m[0], y - center_m[1]) - radius_m,
            Self::Polygon { points_m } => {
                let mut square = f64::INFINITY;
                let mut inside = false;
                for (a, b) in edges(points_m) {
                    square = square.min(square_to_line([x, y], a, b));
                    // Does the edge cross the ray to the east?
                    if (a[1] > y) != (b[1] > y) && x < a[0] + (y - a[1]) / (b[1] - a[1]) * (b[0] - a[0]) {
                        inside = !inside;
                    }
                }
                if inside { -square.sqrt() } else { square.sqrt() }
            }
        }
    }

    /// Smallest signed distance along a straight line, m; where a polygon is met, an upper bound: the deeper end's, or
    /// 0.
    ///
    /// Of a circle it is exact even where the line meets it.
    pub fn segment_distance(&self, from: [f64; 2], to: [f64; 2]) -> f64 {
        match self {
            Self::Circle { center_m, radius_m } => square_to_line(*center_m, from, to).sqrt() - radius_m,
            Self::Polygon { points_m } => {
                let ends = self.distance(from[0], from[1]).min(self.distance(to[0], to[1]));
                if ends <= 0.0 {
                    return ends;
                }
                let mut square = ends * ends;
                for (a, b) in edges(points_m) {
                    if cross(from, to, a, b) {
                        return 0.0;
                    }
                    square = square.min(square_to_line(a, from, to));
                }
                square.sqrt()
            }
        }
    }

    /// Whether some of it lies within `low` … `high`, borders included; of a polygon the box around it counts.
    pub fn reaches(&self, low: [f64; 2], high: [f64; 2]) -> bool {
        match self {
            Self::Circle { center_m, radius_m } => {
                let gap = [0, 1].map(|axis| (low[axis] - center_m[axis]).max(center_m[axis] - high[axis]).max(0.0));
                libm::hypot(gap[0], gap[1]) <= *radius_m
            }
            Self::Polygon { .. } => {
                let [least, most] = self.bounds();
                (0..2).all(|axis| most[axis] >= low[axis] && least[axis] <= high[axis])
            }
        }
    }

    /// Least and largest x and y.
    pub fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Circle { center_m: [x, y], radius_m: r } => [[x - r, y - r], [x + r, y + r]],
            Self::Polygon { points_m } => {
                let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
                for point in points_m {
                    for axis in 0..2 {
                        (low[axis], high[axis]) = (low[axis].min(point[axis]), high[axis].max(point[axis]));
                    }
                }
                [low, high]
            }
        }
    }

    /// Whether the numbers are a place's.
    pub(super) fn check(&self) -> Result<(), WorldError> {
        let place = |field: String, point: &[f64; 2]| {
            if point.iter().all(|c| c.abs() < LARGEST) {
                return Ok(());
            }
            Err(WorldError::new(field, format!("{point:?}"), format!("two numbers between ±{LARGEST}")))
        };
        match self {
            Self::Circle { center_m, radius_m } => {
                place("circle.center_m".into(), center_m)?;
                if *radius_m > 0.0 && *radius_m < LARGEST {
                    return Ok(());
                }
                Err(WorldError::new("circle.radius_m", radius_m.to_string(), format!("> 0 and < {LARGEST}")))
            }
            Self::Polygon { points_m } => {
                let field = "polygon.points_m";
                if points_m.len() < 3 {
                    return Err(WorldError::new(field, format!("{} points", points_m.len()), "three or more"));
                }
                for (index, point) in points_m.iter().enumerate() {
                    place(format!("{field}[{index}]"), point)?;
                }
                let first = points_m[0];
                let flat = edges(points_m).all(|(a, b)| side(first, a, b) == 0.0);
                if flat {
                    return Err(WorldError::new(field, format!("{points_m:?}"), "not all on one line"));
                }
                Ok(())
            }
        }
    }
}

fn edges(points: &[[f64; 2]]) -> impl Iterator<Item = ([f64; 2], [f64; 2])> + '_ {
    points.iter().zip(points.iter().cycle().skip(1)).map(|(a, b)| (*a, *b))
}

/// Square of the distance from `p` to the straight line from `a` to `b`.
fn square_to_line(p: [f64; 2], a: [f64; 2], b: [f64; 2]) -> f64 {
    let (u, v) = (b[0] - a[0], b[1] - a[1]);
    let square = u * u + v * v;
    let along = (p[0] - a[0]) * u + (p[1] - a[1]) * v;
    let t = if square > 0.0 { (along / square).clamp(0.0, 1.0) } else { 0.0 };
    let (dx, dy) = (p[0] - a[0] - t * u, p[1] - a[1] - t * v);
    dx * dx + dy * dy
}

/// Twice the area of the triangle, positive if it is left-handed around.
///
/// Positive where a, b, c turn left; m².
fn side(a: [f64; 2], b: [f64; 2], c: [f64; 2]) -> f64 {
    (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
}

/// Whether two straight lines cross; where they only touch, a distance between ends and lines is 0 already.
fn cross(a: [f64; 2], b: [f64; 2], c: [f64; 2], d: [f64; 2]) -> bool {
    side(a, b, c) * side(a, b, d) < 0.0 && side(c, d, a) * side(c, d, b) < 0.0
}
