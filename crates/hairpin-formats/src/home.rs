//! A world about a stated home: where autopilots and ground stations have their local origin.

use hairpin::campaign::scenario::Origin;
use nalgebra::{Isometry3, Matrix3, Point3, Vector3};

use crate::frames::{Cage, EnuFlu, Geodetic, NedFrd, ned_of_enu, other_yaw, turned};
use crate::placement::Placement;

/// A world with a home in it. East, north and up are those at home, on the plane that touches the Earth there.
#[derive(Debug)]
pub struct Home<'a> {
    world: &'a Placement,
    place: Geodetic,
    tangent: Cage,
    /// What becomes of a step along each of the world's axes, east, north, up.
    steps: Matrix3<f64>,
}

impl<'a> Home<'a> {
    /// The home at a point of the world, m.
    ///
    /// # Errors
    /// A point that the world's plane cannot show.
    pub fn new(world: &'a Placement, point: &Point3<f64>) -> Result<Self, String> {
        let place = world.geodetic(point)?;
        let Geodetic { lat_deg, lon_deg, alt_amsl_m } = place;
        // With its x to the east a cage is east, north, up.
        let tangent = Cage::new(&Origin { lat_deg, lon_deg, alt_amsl_m, x_axis_heading_deg: 90.0 });
        let mut home = Self { world, place, tangent, steps: Matrix3::identity() };
        for axis in 0..3 {
            let step = Vector3::ith(axis, 1.0);
            let step = home.enu(&(point + step))? - home.enu(&(point - step))?;
            home.steps.set_column(axis, &(0.5 * step));
        }
        Ok(home)
    }

    /// Where on Earth it is.
    pub fn place(&self) -> &Geodetic {
        &self.place
    }

    /// Where on Earth a point of the world is.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn geodetic(&self, point: &Point3<f64>) -> Result<Geodetic, String> {
        self.world.geodetic(point)
    }

    /// A point of the world, east, north and up of home.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn enu(&self, point: &Point3<f64>) -> Result<Point3<f64>, String> {
        Ok(self.tangent.from_geodetic(&self.world.geodetic(point)?))
    }

    /// A pose of the world, north, east and down of home.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn ned(&self, pose: &Isometry3<f64>) -> Result<NedFrd, String> {
        let point = self.enu(&Point3::from(pose.translation.vector))?;
        let rotation = turned(self.turn()) * pose.rotation;
        Ok(EnuFlu(Isometry3::from_parts(point.into(), rotation)).into())
    }

    /// A velocity or an acceleration of the world, north, east, down.
    pub fn ned_vector(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        ned_of_enu(&(self.steps * vector))
    }

    /// Heading, rad from north, clockwise, of a yaw from the world's x, counter-clockwise.
    pub fn heading(&self, yaw: f64) -> f64 {
        other_yaw(yaw + self.turn())
    }

    /// From east to the world's x, counter-clockwise, rad.
    fn turn(&self) -> f64 {
        libm::atan2(self.steps[(1, 0)], self.steps[(0, 0)])
    }
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::scenario::Projected;
    use nalgebra::UnitQuaternion;

    use super::*;
    use crate::placement::Plane;

    fn cage() -> Placement {
        Placement::by_origin(&Origin { lat_deg: 47.3977, lon_deg: 8.5456, alt_amsl_m: 488.0, x_axis_heading_deg: 73.5 })
    }

    /// Climbing, turning and tilted: nothing about it is zero, equal or symmetric.
    #[test]
    fn a_pose_of_a_turned_cage_is_where_trigonometry_has_it() {
        let world = cage();
        let base = Point3::new(2.0, -3.0, 0.0);
        let home = Home::new(&world, &base).unwrap();
        let (roll, pitch, yaw) = (0.3, -0.45, 2.1);
        let pose = Isometry3::from_parts(
            Point3::new(8.0, 4.5, 11.0).into(),
            UnitQuaternion::from_euler_angles(roll, pitch, yaw),
        );
        let NedFrd(ned) = home.ned(&pose).unwrap();
        // x heads 73.5° and y is 90° to its left.
        let (ahead, left) = (73.5_f64.to_radians(), (73.5_f64 - 90.0).to_radians());
        let (dx, dy) = (6.0, 7.5);
        let north = dx * ahead.cos() + dy * left.cos();
        let east = dx * ahead.sin() + dy * left.sin();
        assert!((ned.translation.vector - Vector3::new(north, east, -11.0)).norm() < 1e-4, "{ned}");
        let (ned_roll, ned_pitch, ned_yaw) = ned.rotation.euler_angles();
        let heading = (73.5 - yaw.to_degrees()).to_radians();
        assert!((ned_roll - roll).abs() < 1e-6 && (ned_pitch + pitch).abs() < 1e-6, "{ned_roll} {ned_pitch}");
        assert!((ned_yaw - heading).sin().abs() < 1e-6 && (ned_yaw - home.heading(yaw)).sin().abs() < 1e-6);
        // A climb to the left is one to the north-north-west, upwards.
        let velocity = home.ned_vector(&Vector3::new(0.0, 2.0, 1.0));
        let expected = Vector3::new(2.0 * left.cos(), 2.0 * left.sin(), -1.0);
        assert!((velocity - expected).norm() < 1e-5, "{velocity}");
    }

    #[test]
    fn a_plane_of_the_earth_leans_by_its_convergence() {
        let plane = Plane::new(Projected { epsg: 32632, offset: [465_000.0, 5_248_000.0] }).unwrap();
        let world = Placement::Plane(Box::new(plane));
        let home = Home::new(&world, &Point3::new(100.0, 200.0, 3.0)).unwrap();
        // Transverse Mercator: convergence (λ − λ₀) sin φ, here 0.46° west of 9° E at 47.4°.
        let place = home.place();
        let convergence = (place.lon_deg - 9.0).to_radians() * place.lat_deg.to_radians().sin();
        let heading = home.heading(std::f64::consts::FRAC_PI_2);
        assert!((heading - convergence).abs() < 1e-5, "{heading} {convergence}");
        assert!(home.enu(&Point3::new(100.0, 200.0, 3.0)).unwrap().coords.norm() < 1e-6);
    }
}
