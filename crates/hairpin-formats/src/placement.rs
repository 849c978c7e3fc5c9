//! Where on Earth a scenario's world stands: by its origin, or by the plane that its map lies in.

use hairpin::campaign::Scenario;
use hairpin::campaign::scenario::{Origin, Projected};
use nalgebra::Point3;
use proj4rs::Proj;
use proj4rs::transform::transform;

use crate::epsg::definition;
use crate::frames::{Cage, Geodetic};

const WGS_84: &str = "+proj=longlat +datum=WGS84 +no_defs";

/// A world on Earth.
#[derive(Debug)]
pub enum Placement {
    /// By `world.origin`.
    Cage(Cage),
    /// By the EPSG code of its map.
    Plane(Box<Plane>),
}

/// A plane of the Earth's, in metres from a point of it.
#[derive(Debug)]
pub struct Plane {
    plane: Proj,
    wgs_84: Proj,
    projected: Projected,
    /// One of its units, m.
    metres: f64,
}

impl Placement {
    /// The place of a scenario's world: its origin where it has one, else its map's plane; `None` where nothing tells.
    ///
    /// # Errors
    /// A plane that cannot be computed here.
    pub fn of(scenario: &Scenario) -> Result<Option<Self>, String> {
        if let Some(origin) = scenario.origin() {
            return Ok(Some(Self::by_origin(&origin)));
        }
        let plane = scenario.projected().map(Plane::new).transpose()?;
        Ok(plane.map(|plane| Self::Plane(Box::new(plane))))
    }

    /// By an origin.
    pub fn by_origin(origin: &Origin) -> Self {
        Self::Cage(Cage::new(origin))
    }

    /// East, north, up about a place.
    pub fn about(place: &Geodetic) -> Self {
        let Geodetic { lat_deg, lon_deg, alt_amsl_m } = *place;
        Self::by_origin(&Origin { lat_deg, lon_deg, alt_amsl_m, x_axis_heading_deg: 90.0 })
    }

    /// Where on Earth a point of the world is.
    ///
    /// # Errors
    /// A point outside all that the plane can show.
    pub fn geodetic(&self, point: &Point3<f64>) -> Result<Geodetic, String> {
        match self {
            Self::Cage(cage) => Ok(cage.geodetic(point)),
            Self::Plane(plane) => plane.geodetic(point),
        }
    }

    /// The reverse of [`Placement::geodetic`].
    ///
    /// # Errors
    /// Likewise.
    pub fn from_geodetic(&self, place: &Geodetic) -> Result<Point3<f64>, String> {
        match self {
            Self::Cage(cage) => Ok(cage.from_geodetic(place)),
            Self::Plane(plane) => plane.point(place),
        }
    }

    /// Altitude above the world's origin, m.
    pub fn relative_altitude(&self, place: &Geodetic) -> f64 {
        match self {
            Self::Cage(cage) => cage.relative_altitude(place),
            // Heights of maps are above the sea themselves.
            Self::Plane(_) => place.alt_amsl_m,
        }
    }
}

impl Plane {
    /// The plane of an EPSG code.
    ///
    /// # Errors
    /// A code that stands for no plane, or for one that is not computed here.
    pub fn new(projected: Projected) -> Result<Self, String> {
        let Projected { epsg, .. } = projected;
        let cannot = |why: &str| {
            format!(
                "EPSG:{epsg}: {why}; a UTM plane can be placed: gdalwarp -t_srs EPSG:326… (327… in the south, with the zone's \
                 number) -r bilinear MAP OUT.tif, or give world.origin"
            )
        };
        let text = definition(epsg).ok_or_else(|| cannot("this code is not known here"))?;
        if text.contains("+axis=") {
            return Err(cannot("its axes are not east and north"));
        }
        let plane =
            Proj::from_proj_string(text).map_err(|error| cannot(&format!("it is not computed here ({error})")))?;
        let wgs_84 = Proj::from_proj_string(WGS_84).map_err(|error| cannot(&error.to_string()))?;
        if plane.is_latlong() || plane.is_geocent() || !plane.has_inverse() || !plane.has_forward() {
            return Err(cannot("it is no plane"));
        }
        let metres = plane.to_meter();
        Ok(Self { plane, wgs_84, projected, metres })
    }

    fn geodetic(&self, point: &Point3<f64>) -> Result<Geodetic, String> {
        let [east, north] = self.projected.offset;
        let mut place = ((point.x + east) / self.metres, (point.y + north) / self.metres, 0.0);
        let moved = transform(&self.plane, &self.wgs_84, &mut place);
        let (lon_deg, lat_deg) = (place.0.to_degrees(), place.1.to_degrees());
        match moved {
            // Datums differ in their heights too; the map's own is above the sea as it stands.
            Ok(()) if lon_deg.is_finite() && lat_deg.is_finite() => {
                Ok(Geodetic { lat_deg, lon_deg, alt_amsl_m: point.z })
            }
            _ => Err(self.outside(&format!("({} m, {} m)", point.x + east, point.y + north))),
        }
    }

    fn point(&self, place: &Geodetic) -> Result<Point3<f64>, String> {
        let [east, north] = self.projected.offset;
        let mut at = (place.lon_deg.to_radians(), place.lat_deg.to_radians(), 0.0);
        let moved = transform(&self.wgs_84, &self.plane, &mut at);
        let (x, y) = (at.0 * self.metres - east, at.1 * self.metres - north);
        match moved {
            Ok(()) if x.is_finite() && y.is_finite() => Ok(Point3::new(x, y, place.alt_amsl_m)),
            _ => Err(self.outside(&format!("({}°, {}°)", place.lat_deg, place.lon_deg))),
        }
    }

    fn outside(&self, what: &str) -> String {
        format!("{what} is outside what EPSG:{} can show", self.projected.epsg)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn plane(epsg: u32, offset: [f64; 2]) -> Placement {
        Placement::Plane(Box::new(Plane::new(Projected { epsg, offset }).unwrap()))
    }

    /// Latitudes and longitudes as PROJ 9 has them.
    #[test]
    fn planes_lie_where_proj_says() {
        for (epsg, offset, x, y, lat, lon) in [
            (32632, [465_000.0, 5_248_000.0], 123.5, 456.5, 47.388_633_282_675_16, 8.537_891_186_204_497),
            (32719, [365_000.0, 7_348_000.0], 123.5, 456.5, -23.970_039_611_770_45, -70.325_688_326_526_57),
            (3035, [4_321_000.0, 3_209_000.0], 3000.25, 999.75, 51.999_989_673_366_706, 10.043_685_733_646_27),
            (
                2263,
                [0.0; 2],
                987_654.5 * 1200.0 / 3937.0,
                198_764.5 * 1200.0 / 3937.0,
                40.712_238_690_403_31,
                -73.987_719_579_669_37,
            ),
        ] {
            let plane = plane(epsg, offset);
            let point = Point3::new(x, y, 12.5);
            let place = plane.geodetic(&point).unwrap();
            // 1e-8 degrees are a millimetre.
            assert!((place.lat_deg - lat).abs() < 1e-8 && (place.lon_deg - lon).abs() < 1e-8, "{epsg}: {place:?}");
            assert_eq!((place.alt_amsl_m, plane.relative_altitude(&place)), (12.5, 12.5));
            assert!((plane.from_geodetic(&place).unwrap() - point).norm() < 1e-6, "{epsg}");
        }
        // Datums are shifted to within what seven parameters do, metres.
        for (epsg, x, y, lat, lon) in [
            (2056, 2_672_000.0, 1_203_000.0, 46.974_167_892_659_636, 8.384_862_493_493_783),
            (27700, 530_000.0, 180_000.0, 51.503_990_827_633_78, -0.128_353_940_479_469_35),
        ] {
            let place = plane(epsg, [0.0; 2]).geodetic(&Point3::new(x, y, 0.0)).unwrap();
            assert!((place.lat_deg - lat).abs() < 3e-5 && (place.lon_deg - lon).abs() < 5e-5, "{epsg}: {place:?}");
        }
    }

    #[test]
    fn what_is_no_plane_is_refused_with_a_way_out() {
        for epsg in [4326, 4978, 1, 70_000] {
            let refused = Plane::new(Projected { epsg, offset: [0.0; 2] }).unwrap_err();
            assert!(refused.contains("gdalwarp") && refused.contains(&epsg.to_string()), "{refused}");
        }
    }
}
