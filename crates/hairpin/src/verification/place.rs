//! Places seen from above that a vehicle on the ground or the water keeps away from, by signed distances.

/// A place.
///
/// Numbers that are none have no distance: what is held to it is too near.
#[derive(Debug, Clone, PartialEq)]
pub enum FlatPlace {
    /// A disc: centre and radius, m.
    Disc([f64; 2], f64),
    /// The inside of a polygon by the even-odd rule: corners, m.
    Polygon(Vec<[f64; 2]>),
}

impl FlatPlace {
    /// Distance of a point, m; negative inside.
    pub(super) fn distance(&self, p: [f64; 2]) -> f64 {
        match self {
            Self::Disc(centre, radius) => libm::hypot(p[0] - centre[0], p[1] - centre[1]) - radius,
            Self::Polygon(corners) => {
                let nearest = edges(corners).map(|edge| from_segment(&p, &edge)).fold(f64::INFINITY, least);
                // Crossings of a ray to the north.
                let crosses = |[a, b]: &[[f64; 2]; 2]| {
                    let (west, east) = if a[0] <= b[0] { (a, b) } else { (b, a) };
                    let spans = west[0] <= p[0] && p[0] < east[0];
                    spans && (east[0] - west[0]) * (p[1] - west[1]) < (east[1] - west[1]) * (p[0] - west[0])
                };
                let inside = edges(corners).filter(crosses).count() % 2 == 1;
                if inside { -nearest } else { nearest }
            }
        }
    }

    /// Distance of the straight line between both ends of `chord`, m; of one that meets it 0 or less, no more than the
    /// deeper end's.
    pub(super) fn distance_of_line(&self, chord: &[[f64; 2]; 2]) -> f64 {
        match self {
            Self::Disc(centre, radius) => from_segment(centre, chord) - radius,
            Self::Polygon(corners) => {
                let ends = chord.map(|end| self.distance(end));
                let beside = corners.iter().map(|corner| from_segment(corner, chord));
                let met = edges(corners).any(|edge| cross(chord, &edge)).then_some(0.0);
                beside.chain(ends).chain(met).fold(f64::INFINITY, least)
            }
        }
    }

    /// Least and largest x and y, m.
    pub(super) fn bounds(&self) -> [[f64; 2]; 2] {
        match self {
            Self::Disc(centre, radius) => [centre.map(|x| x - radius), centre.map(|x| x + radius)],
            Self::Polygon(corners) => around(corners.iter()),
        }
    }
}

/// Least and largest x and y of `points`, m; NaN where one is.
pub(super) fn around<'a>(points: impl Iterator<Item = &'a [f64; 2]>) -> [[f64; 2]; 2] {
    points.fold([[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]], |[low, high], p| {
        [[0, 1].map(|i| least(low[i], p[i])), [0, 1].map(|i| -least(-high[i], -p[i]))]
    })
}

fn edges(corners: &[[f64; 2]]) -> impl Iterator<Item = [[f64; 2]; 2]> + '_ {
    corners.iter().zip(corners.iter().cycle().skip(1)).map(|(a, b)| [*a, *b])
}

/// The lesser; what is no number is less than any.
fn least(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.min(b) }
}

/// Whether the inner parts of two lines cross: the ends of each lie on both sides of the other.
fn cross(a: &[[f64; 2]; 2], b: &[[f64; 2]; 2]) -> bool {
    let side = |[from, to]: &[[f64; 2]; 2], p: &[f64; 2]| {
        (to[0] - from[0]) * (p[1] - from[1]) - (to[1] - from[1]) * (p[0] - from[0])
    };
    side(a, &b[0]) * side(a, &b[1]) < 0.0 && side(b, &a[0]) * side(b, &a[1]) < 0.0
}

/// Distance of `p` from the straight line between `a` and `b`, m.
fn from_segment(p: &[f64; 2], [a, b]: &[[f64; 2]; 2]) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let squared = along[0] * along[0] + along[1] * along[1];
    let share = if squared > 0.0 { (along[0] * to[0] + along[1] * to[1]) / squared } else { 0.0 };
    let share = share.clamp(0.0, 1.0);
    libm::hypot(to[0] - share * along[0], to[1] - share * along[1])
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn lines_are_as_far_as_their_nearest_place() {
        let square = FlatPlace::Polygon(vec![[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]]);
        let of = |from: [f64; 2], to: [f64; 2]| square.distance_of_line(&[from, to]);
        assert_eq!(of([-1.0, 3.0], [3.0, 3.0]), 1.0, "beside a face");
        assert_eq!(of([3.0, -1.0], [3.0, -1.0]), libm::hypot(1.0, 1.0), "a point off a corner");
        assert_eq!(of([2.5, -5.0], [2.5, 7.0]), 0.5, "corners beside the middle of it");
        assert_eq!(of([-1.0, 1.0], [3.0, 1.0]), 0.0, "all the way through");
        assert_eq!(of([1.0, 1.0], [3.0, 1.0]), -1.0, "from inside");
        assert!(of([f64::NAN, 1.0], [3.0, 1.0]).is_nan());
        assert_eq!(square.bounds(), [[0.0; 2], [2.0; 2]]);
    }
}
