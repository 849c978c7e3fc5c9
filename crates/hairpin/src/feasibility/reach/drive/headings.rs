//! The headings in which waypoints are passed.

use std::f64::consts::{PI, TAU};

use nalgebra::Point3;

use super::settings::{DriveSettings, DriveSite};
use super::watch::stands;
use crate::math::random::{Stream, named_seed, stream, unit};
use crate::trajectory::drive::Planar;

/// Headings that are drawn for one that stands, at most.
///
/// With all of them refused the waypoint has one heading less.
const DRAWS: usize = 8;
/// One heading in so many points anywhere, the others at waypoints.
const ANYWHERE: usize = 4;

/// Appends up to M poses at waypoint `w`.
///
/// Draws are of a stream of the waypoint's own number, whatever other waypoints drew. Aimed in the direction of travel:
/// in reverse away from the target, and by the crab angle aside. Each draw asks whether the body stands.
pub(super) fn draw_headings(
    site: &DriveSite,
    settings: &DriveSettings,
    points: &[Point3<f64>],
    w: usize,
    states: &mut Vec<Planar>,
) {
    let mut random = stream(named_seed(settings.seed, "waypoint headings", w as u64));
    let here = &points[w];
    let near: Vec<&Point3<f64>> = points.iter().filter(|p| settings.is_a_leg(apart(here, p))).collect();
    let (way, direction) = (settings.gear().sign(), settings.direction_at(w));
    let aimed = |at: &Point3<f64>| {
        let bearing = libm::atan2(way * (at.y - here.y), way * (at.x - here.x));
        libm::remainder(bearing - direction, TAU)
    };
    for k in 0..settings.headings.max(1) {
        let drawn = (0..DRAWS)
            .map(|_| heading(&near, (k + 1) % ANYWHERE == 0, aimed, &mut random))
            .map(|yaw| Planar { x: here.x, y: here.y, yaw, curvature: 0.0 })
            .find(|at| stands(site, settings, at).is_ok());
        states.extend(drawn);
    }
}

/// A heading that is `aimed` at one of `near`, or anywhere; in [−π, π].
///
/// One number of the stream, whichever it is.
fn heading(near: &[&Point3<f64>], anywhere: bool, aimed: impl Fn(&Point3<f64>) -> f64, random: &mut Stream) -> f64 {
    let draw = unit(random);
    if anywhere || near.is_empty() {
        return TAU * draw - PI;
    }
    aimed(near[((draw * near.len() as f64) as usize).min(near.len() - 1)])
}

/// √(Δx² + Δy²).
pub(super) fn apart(a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    libm::hypot(b.x - a.x, b.y - a.y)
}
