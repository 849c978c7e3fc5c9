//! How far a standing body is from tipping over, and from resting on its belly.
//!
//! Source: the force-angle measure of Papadopoulos & Rey (ICRA 1996) for gravity alone.
//!
//! Both are about a body at rest: what driving adds is given as a pull, what the ground gives way by is not known here.

use nalgebra::Vector3;

use super::rest::Attitude;
use super::{Rover, Settled, Suspension};
use crate::world::terrain::{NoGround, Terrain};

/// Distance of neighbouring places at which the height of the underside is looked at, m, at most.
const SPACING: f64 = 0.1;
/// Places along one side of the underside at most; very large vehicles are looked at more coarsely.
const MOST_PLACES: usize = 24;
/// Wheels that lie on a face of the cone but for rounding errors lie on it.
const ON_FACE: f64 = 1e-9;

impl Rover {
    /// Smallest angle by which the body must lean further until gravity through the centre of mass leaves the outline
    /// of the wheels' contacts, rad; negative once it has.
    ///
    /// The contacts cᵢ seen from the centre of mass span a cone; with n the inward normal of the face over the edge
    /// (cᵢ, cⱼ) and g the direction of gravity the margin is min asin(n · g). Over a level edge this is the force-angle
    /// of Papadopoulos & Rey; over a tilted one, where they turn the body about the edge itself, it is the shorter turn
    /// about any axis, and it does not jump when a middle wheel comes into the outline. A vehicle of track w whose
    /// centre of mass is h over the ground has atan(w / 2h) − φ on a side slope φ. Quasi-static: no inertial forces.
    /// Without wheels nothing tips: π/2.
    ///
    /// O(n³) in the n ≤ 6 contacts: every pair that all others lie on one side of is an edge of the cone.
    ///
    /// # Errors
    /// [`NoGround`] below a wheel.
    pub fn tip_over_margin<T: Terrain>(&self, terrain: &T, at: [f64; 3], pose: &Settled) -> Result<f64, NoGround> {
        self.tip_over_margin_under(terrain, at, pose, &Vector3::zeros())
    }

    /// [`Self::tip_over_margin`] while a force pulls at the centre of mass by `pull` (world axes, as a share of the
    /// weight): gravity and it together must stay within the outline.
    ///
    /// # Errors
    /// [`NoGround`] below a wheel.
    pub fn tip_over_margin_under<T: Terrain>(
        &self,
        terrain: &T,
        at: [f64; 3],
        pose: &Settled,
        pull: &Vector3<f64>,
    ) -> Result<f64, NoGround> {
        let (wheels, count, radius) = self.suspension.wheels(&pose.joints);
        let body_from_world = Attitude::new(pose.roll, pose.pitch, at[2]).world_from_body.transpose();
        let origin = Vector3::new(at[0], at[1], pose.z);
        let mut contacts = [Vector3::zeros(); 6];
        for (contact, wheel) in contacts.iter_mut().zip(&wheels[..count]) {
            let center = origin + body_from_world.transpose() * wheel;
            let [hx, hy] = terrain.patch(center.x, center.y)?.slope;
            let down = body_from_world * Vector3::new(hx, hy, -1.0).normalize();
            *contact = wheel + radius * down - self.body.centre_of_mass;
        }
        let mut gravity = -Vector3::z();
        if *pull != Vector3::zeros() {
            gravity = (gravity + pull).try_normalize(1e-12).unwrap_or(gravity);
        }
        Ok(margin(&contacts[..count], &(body_from_world * gravity)))
    }

    /// Smallest height of the body's underside over the ground below it, measured along the vertical, m; negative where
    /// ground is higher. Infinite without wheels.
    ///
    /// The underside is looked at on a grid of 0.1 m or finer, its rim included; what is narrower can be missed.
    ///
    /// At most 25 × 25 places of the underside, each one height of the map.
    ///
    /// `at` = x, y, ψ. Along the vertical, not along the body's own axis: on a slope the true gap is smaller by its
    /// cosine.
    ///
    /// # Errors
    /// [`NoGround`] below the body.
    pub fn belly_clearance<T: Terrain>(&self, terrain: &T, at: [f64; 3], pose: &Settled) -> Result<f64, NoGround> {
        if self.suspension == Suspension::Level {
            return Ok(f64::INFINITY);
        }
        let belly = &self.body.belly;
        let world_from_body = Attitude::new(pose.roll, pose.pitch, at[2]).world_from_body;
        let origin = Vector3::new(at[0], at[1], pose.z);
        let places = |length: f64| ((length / SPACING).ceil() as usize).clamp(1, MOST_PLACES);
        let (along, across) = (places(belly.front - belly.rear), places(2.0 * belly.half_width));
        let mut least = f64::INFINITY;
        for i in 0..=along {
            let x = belly.rear + (belly.front - belly.rear) * i as f64 / along as f64;
            for j in 0..=across {
                let y = belly.half_width * (2.0 * j as f64 / across as f64 - 1.0);
                let place = origin + world_from_body * Vector3::new(x, y, belly.height);
                least = least.min(place.z - terrain.height(place.x, place.y)?);
            }
        }
        Ok(least)
    }
}

/// The least angle between the direction `gravity` and the faces of the cone that `contacts`, seen from the centre of
/// mass, span; negative outside, π/2 where they span none.
///
/// `contacts` in m, `gravity` a unit vector, both in one frame. Unsorted contacts are fine.
fn margin(contacts: &[Vector3<f64>], gravity: &Vector3<f64>) -> f64 {
    let mut least = std::f64::consts::FRAC_PI_2;
    for (i, a) in contacts.iter().enumerate() {
        for b in &contacts[i + 1..] {
            let Some(normal) = a.cross(b).try_normalize(1e-12) else { continue };
            for inward in [normal, -normal] {
                if contacts.iter().all(|c| inward.dot(c) >= -ON_FACE) {
                    least = least.min(libm::asin(inward.dot(gravity).clamp(-1.0, 1.0)));
                }
            }
        }
    }
    least
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::super::RoverDescription;
    use super::*;
    use crate::world::terrain::{Flat, Function, Patch};

    /// Track 0.5 m, wheelbase 0.6 m, centre of mass 0.2 m over the wheels' contacts.
    const BOX: &str = r#"
        kind = "rover"
        name = "box"
        centre_of_mass_m = [0.0, 0.0, 0.03]
        belly = { front_m = 0.4, rear_m = -0.3, half_width_m = 0.2, height_m = -0.04 }
        suspension = { kind = "four-wheel", wheel_radius_m = 0.12, front_m = [0.3, 0.25, -0.05], rear_m = [-0.3, 0.25, -0.05] }
        limits = { curvature_1_m = 1.0 }
    "#;

    fn rover(text: &str) -> Rover {
        toml::from_str::<RoverDescription>(text).expect("its keys").build().expect("its numbers")
    }

    fn shipped(name: &str) -> String {
        let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
        std::fs::read_to_string(path).expect("a shipped rover")
    }

    fn slope(a: f64, b: f64) -> impl Terrain {
        Function(move |x: f64, y: f64| Patch { height: a * x + b * y, slope: [a, b], bend: [0.0; 3] })
    }

    fn stand<T: Terrain>(rover: &Rover, terrain: &T, at: [f64; 3]) -> (f64, f64) {
        let pose = rover.suspension.settle_cold(terrain, at).expect("rest").0;
        let margin = rover.tip_over_margin(terrain, at, &pose).expect("ground");
        (margin, rover.belly_clearance(terrain, at, &pose).expect("ground"))
    }

    #[test]
    fn on_side_slopes_the_margin_is_that_of_the_track_less_the_slope() {
        let rover = rover(BOX);
        let full = (0.25_f64 / 0.2).atan();
        for degrees in [-60.0_f64, -30.0, 0.0, 10.0, 45.0, 51.0, 52.0, 60.0] {
            let phi = degrees.to_radians();
            let (margin, _) = stand(&rover, &slope(0.0, phi.tan()), [1.0, 2.0, 0.0]);
            assert!((margin - (full - phi.abs())).abs() < 1e-9, "{degrees}: {margin}");
            assert_eq!(margin < 0.0, degrees.abs() > full.to_degrees());
        }
        // Driving up or down, and with any heading on it: the wheels' nearest edge.
        let (margin, _) = stand(&rover, &slope(0.4, 0.0), [0.0; 3]);
        let up = (0.3_f64 / 0.2).atan() - 0.4_f64.atan();
        assert!((margin - up.min((full.sin() * 0.4_f64.atan().cos()).asin())).abs() < 1e-9, "{margin} {up}");
        let turned = stand(&rover, &slope(0.4 * 0.6, 0.4 * 0.8), [0.0, 0.0, 0.8_f64.atan2(0.6)]).0;
        assert!((turned - margin).abs() < 1e-9);
    }

    #[test]
    fn six_wheels_in_two_lines_stand_as_their_corners_do() {
        let text = shipped("rocky8");
        let (h, x) = (0.3_f64, 0.2_f64);
        let rover = rover(&format!("centre_of_mass_m = [{x}, 0.0, {}]\n{text}", h - 0.17));
        for side in [0.0, 0.2, -0.5] {
            let (margin, _) = stand(&rover, &slope(0.0, side), [0.0; 3]);
            // Corners at x = 0.8175 and −0.1381, 0.4 to each side; joints bring the six wheels onto one plane.
            let level = rover.suspension.settle_cold(&Flat, [0.0; 3]).unwrap().0;
            assert!(level.pitch.abs() < 1e-9, "{level:?}");
            let across = (0.4_f64 / h).atan() - f64::atan(side).abs();
            let lengthwise = ((x + 0.1381).atan2(h).sin() * f64::atan(side).cos()).asin();
            assert!((margin - across.min(lengthwise)).abs() < 2e-3, "{side}: {margin} {across} {lengthwise}");
        }
    }

    #[test]
    fn the_belly_is_as_high_as_what_is_below_it_leaves() {
        let rover = rover(BOX);
        let ride = 0.12 + 0.05 - 0.04;
        assert!((stand(&rover, &Flat, [0.3, 0.2, 1.0]).1 - ride).abs() < 1e-9);
        // On a plane the underside is parallel to it, and the vertical through the gap longer by 1/cos.
        let (_, clearance) = stand(&rover, &slope(0.3, 0.4), [0.0, 0.0, 0.4]);
        assert!((clearance - ride * 1.25_f64.sqrt()).abs() < 1e-9, "{clearance}");
        // A rock below the overhang in front, between the wheels: level where they stand.
        let rock = Function(|x: f64, y: f64| {
            let height = if (x - 0.4).abs() < 0.02 && y.abs() < 0.06 { 0.15 } else { 0.0 };
            Patch { height, ..Patch::default() }
        });
        let (margin, clearance) = stand(&rover, &rock, [0.0; 3]);
        assert!((clearance - (ride - 0.15)).abs() < 1e-9 && margin > 0.8, "{clearance}");
    }

    #[test]
    fn what_is_not_given_is_estimated_and_a_point_never_tips() {
        let four_wheel = rover(&shipped("four-wheel"));
        assert!(four_wheel.estimated.contains(&"centre_of_mass_m") && four_wheel.estimated.contains(&"belly"));
        assert_eq!(four_wheel.body.centre_of_mass, Vector3::zeros());
        let (margin, clearance) = stand(&four_wheel, &Flat, [0.0; 3]);
        assert!((margin - (0.25_f64 / 0.17).atan()).abs() < 1e-9 && (clearance - 0.17).abs() < 1e-9);
        assert!(!rover(BOX).estimated.contains(&"belly"));
        let point = rover(&shipped("generic"));
        assert!(!point.estimated.contains(&"belly"));
        assert_eq!(stand(&point, &slope(2.0, 0.0), [0.0; 3]), (std::f64::consts::FRAC_PI_2, f64::INFINITY));
    }

    #[test]
    fn bodies_that_cannot_stand_are_refused_by_key() {
        for (from, to, key) in [
            ("[0.0, 0.0, 0.03]", "[0.31, 0.0, 0.03]", "centre_of_mass_m"),
            ("[0.0, 0.0, 0.03]", "[0.0, 0.0, -0.18]", "centre_of_mass_m"),
            ("[0.0, 0.0, 0.03]", "[0.0, nan, 0.03]", "centre_of_mass_m"),
            ("rear_m = -0.3, half", "rear_m = 0.5, half", "belly.rear_m"),
            ("half_width_m = 0.2", "half_width_m = -0.2", "belly.half_width_m"),
            ("height_m = -0.04", "height_m = -0.2", "belly.height_m"),
        ] {
            let broken = BOX.replace(from, to);
            assert_ne!(broken, BOX, "{from}");
            let error = toml::from_str::<RoverDescription>(&broken).expect("its keys").build().expect_err(key);
            assert_eq!(error.field, key, "{error}");
        }
    }
}
