//! Axis-aligned bounding boxes: cheap lower bounds that keep queries over many obstacles fast.

use nalgebra::{Point3, Vector3};

/// The box min ≤ p ≤ max, m.
///
/// Closed, min ≤ max in each axis; a single point is a box.
///
/// ```
/// use hairpin::world::Bounds;
/// use nalgebra::Point3;
///
/// let bounds = Bounds::around(&[Point3::new(0.0, 2.0, 0.0), Point3::new(1.0, 0.0, 1.0)]).expect("two points");
/// assert_eq!((bounds.min, bounds.max), (Point3::origin(), Point3::new(1.0, 2.0, 1.0)));
/// assert_eq!(bounds.distance(&Point3::new(4.0, 6.0, 0.5)), 5.0);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bounds {
    /// Smallest corner.
    pub min: Point3<f64>,
    /// Largest corner.
    pub max: Point3<f64>,
}

impl Bounds {
    /// The smallest box around `points`; `None` without points.
    pub fn around<'a>(points: impl IntoIterator<Item = &'a Point3<f64>>) -> Option<Self> {
        points.into_iter().fold(None, |bounds, p| {
            Some(bounds.map_or(Self { min: *p, max: *p }, |b| Self { min: b.min.inf(p), max: b.max.sup(p) }))
        })
    }

    /// The box grown by `margin` on every side.
    pub fn grown(&self, margin: f64) -> Self {
        Self { min: self.min.map(|c| c - margin), max: self.max.map(|c| c + margin) }
    }

    /// Distance of `p` to the box, m; 0 inside.
    pub fn distance(&self, p: &Point3<f64>) -> f64 {
        gap(self.min - p, p - self.max)
    }

    /// Distance between two boxes, m; 0 where they meet.
    ///
    /// A lower bound of the distance between anything in the one and anything in the other.
    pub fn distance_to(&self, other: &Bounds) -> f64 {
        gap(self.min - other.max, other.min - self.max)
    }
}

/// Length of the componentwise positive part of two one-sided gaps, of which at most one is positive per axis.
fn gap(below: Vector3<f64>, above: Vector3<f64>) -> f64 {
    below.sup(&above).sup(&Vector3::zeros()).norm()
}
