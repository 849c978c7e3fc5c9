//! Places on a map where a vehicle can stand.

use std::f64::consts::TAU;

use nalgebra::Point3;
use thiserror::Error;

use super::settings::{DriveSettings, DriveSite};
use super::tally::LegRefusal;
use super::watch::stands;
use crate::math::random::{stream, unit};
use crate::trajectory::drive::Planar;
use crate::world::terrain::Terrain;
use crate::world::{Sampling, short_way};

/// How places are spread.
///
/// Draws are of x and y; z is the map's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundSampling {
    /// How many.
    pub count: usize,
    /// Least distance from the map's edge, m.
    pub margin: f64,
    /// Centre (x, y) and radius, m, of the disc they are spread over; `None`: the whole map. Waypoints that lie many
    /// legs apart have few legs between them.
    pub around: Option<([f64; 2], f64)>,
    /// Independent, in clusters, or a Sobol sequence.
    pub sampling: Sampling,
    /// Seed.
    pub seed: u64,
}

/// Why there are not enough places.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Error)]
#[error(
    "{found} of {wanted} waypoints found in {draws} draws: {blocked} lay in keep-outs, {without_ground} had no ground below \
     every wheel, at {steep} the body stands beyond its limits in every heading"
)]
pub struct TooFewPlaces {
    /// Places asked for.
    pub wanted: usize,
    /// Places found.
    pub found: usize,
    /// Draws inside the area.
    pub draws: usize,
    /// Of those: in keep-outs.
    pub blocked: usize,
    /// At the map's edge, at cells without data, or without rest.
    pub without_ground: usize,
    /// Beyond the limits of tilt, joints or clearance.
    pub steep: usize,
}

/// Length of the Sobol sequence that `sobol_burley` has.
const SOBOL_LENGTH: usize = 1 << 16;
/// Headings in which a place is tried.
const HEADINGS: u32 = 8;

/// `asked.count` places of the map with their heights: away from its edge, outside keep-outs, and such that the body
/// stands within the limits of `settings` in some heading. A pure function of its arguments.
///
/// By rejection from at most 1 000 draws a place + 10 000. Where the body stands nowhere they take minutes: `over` is
/// asked at each, and ends them.
///
/// # Errors
/// [`TooFewPlaces`], with what refused the others.
pub fn sample_ground(
    site: &DriveSite,
    settings: &DriveSettings,
    asked: &GroundSampling,
    over: &dyn Fn() -> bool,
) -> Result<Vec<Point3<f64>>, TooFewPlaces> {
    let (low, high) = area(site, asked);
    let most = asked.count.saturating_mul(1000).saturating_add(10_000);
    let most = if asked.sampling == Sampling::Sobol { most.min(SOBOL_LENGTH) } else { most };
    let mut random = stream(asked.seed);
    let spacing = libm::sqrt((high[0] - low[0]) * (high[1] - low[1]) / asked.count as f64);
    let scramble = (asked.seed ^ (asked.seed >> 32)) as u32;
    let mut told = TooFewPlaces { wanted: asked.count, found: 0, draws: 0, blocked: 0, without_ground: 0, steep: 0 };
    let mut places = Vec::new();
    for index in 0..most {
        if places.len() == asked.count || over() {
            break;
        }
        let inside = |shares: [f64; 2]| [0, 1].map(|i| low[i] + shares[i] * (high[i] - low[i]));
        let [x, y] = match (asked.sampling, asked.sampling.beside(index, places.len(), &mut random)) {
            (_, Some(other)) => {
                let other: &Point3<f64> = &places[other];
                let [along, across] = short_way(spacing, &mut random);
                [other.x + along, other.y + across]
            }
            (Sampling::Uniform | Sampling::Clustered, None) => inside([unit(&mut random), unit(&mut random)]),
            (Sampling::Sobol, None) => {
                let [x, y, ..] = sobol_burley::sample_4d(index as u32, 0, scramble);
                inside([f64::from(x), f64::from(y)])
            }
        };
        let outside = |(center, radius): ([f64; 2], f64)| libm::hypot(x - center[0], y - center[1]) > radius;
        if asked.around.is_some_and(outside)
            || [x, y].iter().zip(low.iter().zip(&high)).any(|(at, (low, high))| at < low || at > high)
        {
            continue;
        }
        told.draws += 1;
        match stands_somehow(site, settings, x, y) {
            Ok(z) => places.push(Point3::new(x, y, z)),
            Err(LegRefusal::KeepOut) => told.blocked += 1,
            Err(LegRefusal::Tilt | LegRefusal::Joint | LegRefusal::Belly) => told.steep += 1,
            Err(_) => told.without_ground += 1,
        }
    }
    told.found = places.len();
    if places.len() == asked.count { Ok(places) } else { Err(told) }
}

/// Least and greatest x and y; empty areas have low = high.
fn area(site: &DriveSite, asked: &GroundSampling) -> ([f64; 2], [f64; 2]) {
    let (mut low, mut high) = site.map.extent();
    for i in 0..2 {
        low[i] += asked.margin;
        high[i] -= asked.margin;
        if let Some((center, radius)) = asked.around {
            low[i] = low[i].max(center[i] - radius);
            high[i] = high[i].min(center[i] + radius);
        }
        high[i] = high[i].max(low[i]);
    }
    (low, high)
}

/// Height of the ground at (x, y) if the body stands there in some heading.
fn stands_somehow(site: &DriveSite, settings: &DriveSettings, x: f64, y: f64) -> Result<f64, LegRefusal> {
    let mut refused = LegRefusal::Tilt;
    for k in 0..HEADINGS {
        let yaw = TAU * f64::from(k) / f64::from(HEADINGS);
        match stands(site, settings, &Planar { x, y, yaw, curvature: 0.0 }) {
            Ok(()) => return site.map.patch(x, y).map(|patch| patch.height).map_err(|_| LegRefusal::NoData),
            Err(LegRefusal::KeepOut) => return Err(LegRefusal::KeepOut),
            Err(reason) => refused = reason,
        }
    }
    Err(refused)
}
