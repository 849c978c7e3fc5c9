//! Where a vehicle may be that an autopilot of the user's carries: what files for it say, and are held to.

use nalgebra::Point3;

/// The space of what flies, drives or sails, and how it goes in it.
///
/// What QGroundControl plans, geofences and simulators' worlds are written from. An axis-aligned box in the world
/// frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Room {
    /// Whether it flies: what does not stays on its ground, and its heights have no bound.
    pub flies: bool,
    /// Least coordinates, m.
    pub low: Point3<f64>,
    /// Greatest coordinates, m.
    pub high: Point3<f64>,
    /// How far inside its way stays, m.
    pub margin: f64,
    /// Largest curvature of its way, 1/m; infinite where it turns where it stands.
    pub curvature: f64,
    /// Speed that whoever executed goes at on every leg, m/s; `None`: the plan's.
    pub speed: Option<f64>,
    /// Speed that plans are held to, m/s; infinite where nothing bounds it.
    pub fastest: f64,
    /// Whether whoever executed keeps to the plan's times where there is a plan, or is at least handed them.
    pub timed: bool,
    /// `MAV_TYPE`s of missions that are its own, by MAVLink's numbers: those of its class, and 0, which is of none.
    pub vehicles: &'static [u64],
}

/// A wall of a room, and how far from it a place is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Wall {
    /// Its name.
    pub name: &'static str,
    /// How far inside the place is, m; negative beyond.
    pub inside: f64,
}

impl Room {
    /// The wall that is nearest to `place`, or farthest behind it. Who rises from the ground or comes down to it is not
    /// held to the `floor`.
    ///
    /// `place` in m, world frame. Of equally near walls the first in the order x, y, z, least before greatest. NaN is
    /// behind the wall of its axis.
    pub fn nearest_wall(&self, place: &Point3<f64>, floor: bool) -> Wall {
        let names = [["x least", "x greatest"], ["y least", "y greatest"], ["the floor", "the ceiling"]];
        let axes = if self.flies { 3 } else { 2 };
        let mut nearest = Wall { name: names[0][0], inside: place.x - self.low.x };
        for (axis, [low, high]) in names.into_iter().enumerate().take(axes) {
            let below = Wall { name: low, inside: place[axis] - self.low[axis] };
            let above = Wall { name: high, inside: self.high[axis] - place[axis] };
            for wall in [below, above] {
                let counts = floor || axis != 2 || wall != below;
                // What is not a number is nowhere inside.
                if counts && (wall.inside < nearest.inside || wall.inside.is_nan()) {
                    nearest = wall;
                }
            }
        }
        nearest
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn the_nearest_wall_is_named() {
        let cage = Room {
            flies: true,
            low: Point3::origin(),
            high: Point3::new(10.0, 8.0, 4.0),
            margin: 0.5,
            curvature: f64::INFINITY,
            speed: None,
            fastest: f64::INFINITY,
            timed: true,
            vehicles: &[0],
        };
        let wall = |x, y, z, floor| cage.nearest_wall(&Point3::new(x, y, z), floor);
        assert_eq!(wall(9.0, 4.0, 2.5, true), Wall { name: "x greatest", inside: 1.0 });
        assert_eq!(wall(5.0, -0.5, 0.1, true), Wall { name: "y least", inside: -0.5 });
        assert_eq!(wall(5.0, 4.0, 0.25, true), Wall { name: "the floor", inside: 0.25 });
        assert_eq!(wall(5.0, 4.0, 0.25, false), Wall { name: "the ceiling", inside: 3.75 });
        let ground = Room { flies: false, ..cage };
        assert_eq!(ground.nearest_wall(&Point3::new(5.0, 5.0, 99.0), true), Wall { name: "y greatest", inside: 3.0 });
        assert!(wall(1.0, f64::NAN, 1.0, true).inside.is_nan());
    }
}
