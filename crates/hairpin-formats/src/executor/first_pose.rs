//! The first pose lies at the start, or the program has another frame than ours: which, is told where it shows.

use std::fmt;

use nalgebra::Point3;
use thiserror::Error;

/// Nearer than this to the image of the start in another frame, m, a pose is that image and no coincidence.
const EXACT_M: f64 = 1e-3;
/// Where the start and its image are nearer to each other than this, m, which of the two it is does not matter.
const APART_M: f64 = 0.1;

/// A first pose that is not at the start.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("its first pose is at {}, the start at {}: must be within {within} m{slip}", at(.place), at(.start))]
pub struct Elsewhere {
    /// Where it is, m.
    pub place: [f64; 3],
    /// The first waypoint, m.
    pub start: [f64; 3],
    /// How far it may be away, m.
    pub within: f64,
    /// What has become of the start, where that shows.
    pub slip: Slip,
}

/// What a program takes the start for.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slip {
    /// x north, y east, z down.
    Ned,
    /// z down alone.
    Down,
    /// x and y changed places.
    Swapped,
    /// Its own origin.
    Origin,
    /// Something else.
    Unknown,
}

impl fmt::Display for Slip {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Ned => {
                "; it is the start as NED has it (x and y change places, z points down): here x is east, y north, z up"
            }
            Self::Down => "; it is the start with z pointing down, as NED has it: here z points up",
            Self::Swapped => "; it is the start with x and y in each other's place",
            Self::Origin => {
                "; it is the program's own origin: places are in the world's frame, the flight begins at waypoint 0"
            }
            Self::Unknown => "",
        })
    }
}

/// Where `place` lies, if not at `start`; `is_at` says whether it is near enough.
pub(super) fn elsewhere(place: [f64; 3], start: &Point3<f64>, (within, is_at): (f64, bool)) -> Option<Elsewhere> {
    let [x, y, z]: [f64; 3] = start.coords.into();
    let far = |image: [f64; 3]| (Point3::from(place) - Point3::from(image)).norm();
    let images =
        [(Slip::Ned, [y, x, -z]), (Slip::Down, [x, y, -z]), (Slip::Swapped, [y, x, z]), (Slip::Origin, [0.0; 3])];
    let nearest = images.into_iter().min_by(|a, b| far(a.1).total_cmp(&far(b.1)));
    let (slip, away) = nearest.map_or((Slip::Unknown, f64::INFINITY), |(slip, image)| (slip, far(image)));
    let is_image = slip != Slip::Origin && away < EXACT_M && far([x, y, z]) > APART_M;
    if is_at && !is_image {
        return None;
    }
    let slip = if away <= within { slip } else { Slip::Unknown };
    Some(Elsewhere { place, start: [x, y, z], within, slip })
}

fn at([x, y, z]: &[f64; 3]) -> String {
    format!("({x:.2}, {y:.2}, {z:.2})")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn slip(place: [f64; 3], start: [f64; 3]) -> Option<Slip> {
        let start = Point3::from(start);
        let is_at = (Point3::from(place) - start).norm() <= 1.0;
        elsewhere(place, &start, (1.0, is_at)).map(|found| found.slip)
    }

    #[test]
    fn frames_of_others_are_named() {
        let start = [3.0, 7.0, 5.0];
        assert_eq!(slip(start, start), None);
        assert_eq!(slip([3.4, 7.4, 4.6], start), None);
        assert_eq!(slip([7.0, 3.0, -5.0], start), Some(Slip::Ned));
        assert_eq!(slip([3.0, 7.0, -5.0], start), Some(Slip::Down));
        assert_eq!(slip([7.0, 3.2, 5.0], start), Some(Slip::Swapped));
        assert_eq!(slip([0.0, 0.0, 0.1], start), Some(Slip::Origin));
        assert_eq!(slip([9.0, 9.0, 9.0], start), Some(Slip::Unknown));
        // Near the floor both are near enough; which it is shows all the same.
        assert_eq!(slip([3.0, 3.5, -0.3], [3.5, 3.0, 0.3]), Some(Slip::Ned));
        assert_eq!(slip([3.0, 3.0, -0.3], [3.0, 3.0, 0.3]), Some(Slip::Ned));
        assert_eq!(slip([0.0, 0.0, 0.0], [0.0, 0.0, 0.5]), None);
        // Where it makes no difference it is none.
        assert_eq!(slip([5.0, 5.0, -0.0], [5.0, 5.0, 0.0]), None);
        let sentence = elsewhere([7.0, 3.0, -5.0], &Point3::from(start), (1.0, false)).unwrap().to_string();
        assert!(sentence.starts_with("its first pose is at (7.00, 3.00, -5.00), the start at (3.00, 7.00, 5.00): must be within 1 m; it is the start as NED"), "{sentence}");
    }
}
