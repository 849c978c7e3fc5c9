//! Round keep-outs placed where a drive leaves its plan: clear of all of the planned drive, and in the executed one's
//! way.

use nalgebra::{Point3, Unit, Vector3};

use super::DriveSetup;
use super::solve::settings;
use crate::campaign::placement::{Placed, Placement, Placing, name};
use crate::campaign::scenario::{CircleSection, KeepOutSection, PlacedDiscsSection};
use crate::campaign::{Case, Environment};
use crate::feasibility::reach::drive::{ClearanceSamples, DriveSite};
use crate::trajectory::Track;
use crate::world::Shape;
use crate::world::terrain::{KeepOut, KeepOutShape, KeepOuts};

/// Chords of the planned way, at most.
const CHORDS: usize = 600;
/// What keep-outs keep from the plan beyond the vehicle's radius and what its looks need, m: a little at first, more
/// where chords hide what is nearer.
///
/// They are tried in turn, beginning with the smaller.
const GAPS: [f64; 2] = [0.002, 0.05];

/// What keep-outs have to be clear of.
///
/// Claims know the plan alone: that an executed drive comes there is what the keep-out shows.
///
/// Looks and chords lie at height 0: keep-outs have no height.
enum Claimed<'a> {
    /// The predicted motion of a drive.
    Drive(ClearanceSamples),
    /// The straight legs between waypoints, where that is all.
    Straight(&'a [Point3<f64>]),
}

/// Up to `asked.count` discs in the way of `track`, the drive of `case` without them. `None` where there is no room for
/// any.
///
/// Each disc is as near to the executed way as the plan lets it be; the plan keeps the vehicle's radius from all of
/// them by the reach set's own test.
///
/// A disc stands where all of it lies on the map and the claim keeps out of it; it may give way in the directions of
/// [`directions`]. Discs are named by their number. The case's own keep-outs of an earlier placement are replaced.
pub(super) fn place(setup: &DriveSetup, case: &Case, track: &Track, asked: PlacedDiscsSection) -> Option<Placement> {
    let claimed = Claimed::by(setup, case)?;
    let beyond = claimed.beyond();
    let placing = Placing {
        way: &claimed.way(),
        count: asked.count as usize,
        radius: setup.radius(),
        gaps: &GAPS.map(|gap| beyond + gap),
        // In the plane, a disc is a ball.
        shape: &|center| Shape::sphere(center.coords.into(), asked.radius_m).ok(),
        directions,
        stands: &|center, _| {
            let circle = circle(asked, center);
            on_map(setup, &circle) && claimed.keeps_out(&circle, setup.radius())
        },
    };
    let places: Vec<Point3<f64>> = (0..track.len()).map(|index| flat(&track.position(index))).collect();
    let Placed { centers, clearance, leg } = placing.in_the_way_of(track, &places)?;
    let section =
        |(number, center)| KeepOutSection { name: name(number), circle: Some(circle(asked, center)), polygon: None };
    let keep_out = centers.iter().enumerate().map(section).collect();
    let among = Environment { keep_out, ..case.environment.clone().unwrap_or_default() };
    Some(Placement { among, clearance, leg })
}

impl<'a> Claimed<'a> {
    /// What stands behind `case`; `None` for a drive that the ground does not carry.
    fn by(setup: &DriveSetup, case: &'a Case) -> Option<Self> {
        let Some(drive) = case.commands() else { return Some(Self::Straight(&case.waypoints)) };
        let site = DriveSite::new(&setup.planner, &setup.map, &setup.keep_out);
        ClearanceSamples::along(&site, &settings(setup).ok()?, drive).map(Self::Drive)
    }

    /// The plan as a chain of segments at height 0.
    ///
    /// At most 600 chords; what they cut off is what the larger gap is for.
    fn way(&self) -> Vec<Point3<f64>> {
        match self {
            Self::Straight(waypoints) => waypoints.iter().map(flat).collect(),
            Self::Drive(looks) => {
                let places = looks.places();
                let stride = places.len().div_ceil(CHORDS).max(1);
                let last = looks.places().last();
                places.step_by(stride).chain(last).map(|[x, y]| Point3::new(x, y, 0.0)).collect()
            }
        }
    }

    /// What must be kept beyond the vehicle's radius for the claim to see that the radius is, m.
    ///
    /// A look vouches for the metres of the step around it, and so must be that much farther away than the radius.
    fn beyond(&self) -> f64 {
        match self {
            Self::Straight(_) => 0.0,
            Self::Drive(looks) => looks.longest_step(),
        }
    }

    /// Whether all of it keeps `radius` from `circle`, by the test that the reach set holds its legs to.
    ///
    /// False for a disc that is no shape, as of radius 0.
    fn keeps_out(&self, circle: &CircleSection, radius: f64) -> bool {
        let shape = KeepOutShape::Circle { center_m: circle.center_m, radius_m: circle.radius_m };
        let Ok(alone) = KeepOuts::new(vec![KeepOut { name: String::new(), shape }]) else { return false };
        match self {
            Self::Drive(looks) => looks.keep_out_of(&alone, radius),
            Self::Straight(waypoints) => waypoints
                .windows(2)
                .all(|leg| alone.segment_distance([leg[0].x, leg[0].y], [leg[1].x, leg[1].y]) >= radius),
        }
    }
}

/// Directions in which a disc may give way: away from the plan, and along it.
///
/// Horizontal unit vectors.
fn directions(away: &Vector3<f64>) -> Vec<Unit<Vector3<f64>>> {
    let away = Unit::new_normalize(*away);
    let along = Unit::new_normalize(Vector3::new(-away.y, away.x, 0.0));
    vec![away, along, -along]
}

fn circle(asked: PlacedDiscsSection, center: &Point3<f64>) -> CircleSection {
    CircleSection { center_m: [center.x, center.y], radius_m: asked.radius_m }
}

/// All of the disc, by the map's extent.
///
/// Cells without data inside the extent are not asked for: a keep-out may cover them.
fn on_map(setup: &DriveSetup, circle: &CircleSection) -> bool {
    let (low, high) = setup.map.extent();
    let (center, radius) = (circle.center_m, circle.radius_m);
    (0..2).all(|axis| center[axis] - radius >= low[axis] && center[axis] + radius <= high[axis])
}

fn flat(p: &Point3<f64>) -> Point3<f64> {
    Point3::new(p.x, p.y, 0.0)
}
