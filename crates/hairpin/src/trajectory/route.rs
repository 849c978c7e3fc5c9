//! The way of a trajectory, whatever its waypoints are: places evenly along it, so that two ways can be compared.

use nalgebra::Point3;

/// Places along a way.
const PLACES: usize = 24;

/// 24 places along a way of waypoints, evenly by its length, m.
///
/// ```
/// use hairpin::trajectory::Route;
/// use nalgebra::Point3;
///
/// let along = |y: f64| Route::along(&[Point3::new(0.0, y, 0.0), Point3::new(3.0, y, 0.0)]);
/// assert!((along(0.0).apart(&along(2.0)) - 2.0).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Route([Point3<f64>; PLACES]);

impl Route {
    /// Along `waypoints`, in the plane or in space alike; there is at least one.
    pub fn along(waypoints: &[Point3<f64>]) -> Self {
        let lengths: Vec<f64> = waypoints.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
        let whole: f64 = lengths.iter().sum();
        let (mut leg, mut before) = (0, 0.0);
        Self(std::array::from_fn(|i| {
            let along = whole * i as f64 / (PLACES - 1) as f64;
            while leg + 1 < lengths.len() && before + lengths[leg] < along {
                before += lengths[leg];
                leg += 1;
            }
            let share = if lengths.is_empty() || lengths[leg] == 0.0 { 0.0 } else { (along - before) / lengths[leg] };
            let next = waypoints[(leg + 1).min(waypoints.len() - 1)];
            waypoints[leg] + (next - waypoints[leg]) * share.clamp(0.0, 1.0)
        }))
    }

    /// How many places ways are compared at.
    pub const PLACES: usize = PLACES;

    /// The coordinates of its places, m, place by place.
    pub fn coordinates(&self) -> impl Iterator<Item = f64> {
        self.0.iter().flat_map(|place| [place.x, place.y, place.z])
    }

    /// How far two ways are apart, m: √(Σ |pᵢ − qᵢ|² / n) over the n places of both. A metric.
    pub fn apart(&self, other: &Self) -> f64 {
        let squares: f64 = self.0.iter().zip(&other.0).map(|(p, q)| (p - q).norm_squared()).sum();
        (squares / PLACES as f64).sqrt()
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn places_are_even_along_the_way() {
        let way = [Point3::origin(), Point3::new(1.0, 0.0, 0.0), Point3::new(1.0, 3.0, 0.0)];
        let Route(places) = Route::along(&way);
        assert_eq!((places[0], places[PLACES - 1]), (way[0], way[2]));
        let steps: Vec<f64> = places.windows(2).map(|pair| (pair[1] - pair[0]).norm()).collect();
        // But for the one around the corner.
        assert!(steps.iter().filter(|step| (*step - 4.0 / 23.0).abs() < 1e-12).count() >= PLACES - 2, "{steps:?}");
        assert_eq!(Route::along(&[Point3::origin()]).apart(&Route::along(&[Point3::new(0.0, 2.0, 0.0)])), 2.0);
    }
}
