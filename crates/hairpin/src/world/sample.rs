//! Points drawn from the free space of a world: independent and uniform, in clusters, or a scrambled Sobol sequence.
//!
//! Waypoints of a graph are drawn here once, and what a search can find lies among them. One graph is one seed; the
//! same seed draws the same points whatever the machine.

use nalgebra::{Point3, Vector3};
use rand::RngExt;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::World;
use crate::math::random::{Stream, standard_normals, stream, unit};

/// How points are spread.
///
/// Clusters: distance d = spacing · 10^(−u), u uniform in [0, 1), so that every decade-share of lengths is equally
/// frequent; the direction is that of a normal vector. Sobol: low discrepancy in x, y, z, the first three of four
/// Owen-scrambled dimensions (Burley, "Practical Hash-based Owen Scrambling", JCGT 9(4), 2020).
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Independent and uniform.
    #[default]
    Uniform,
    /// Every other one uniform, the others about one of those before: in any direction, at a distance that is even in
    /// its logarithm from a tenth of the mean spacing, (free room ÷ points)^(1/dimensions), to all of it. Short legs,
    /// which uniform points hardly have.
    Clustered,
    /// An Owen-scrambled Sobol sequence (Burley 2020), at most 65 536 draws long.
    Sobol,
}

/// Why there are not enough points.
///
/// `share` tells what is wrong better than the count: at 0.1 % the space is too tight for the clearance, not the draws
/// too few.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
pub enum SamplingError {
    /// The free space is too small a part of the volume.
    #[error(
        "{found} of {wanted} points found in {draws} draws: {:.2} % of the volume inside the margin is free; \
         must be enough space that keeps the clearance from obstacles", 100.0 * share
    )]
    NoSpace {
        /// Points asked for.
        wanted: usize,
        /// Points found.
        found: usize,
        /// Draws made.
        draws: usize,
        /// Free share of the volume inside the margin, 0 … 1.
        share: f64,
    },
    /// The Sobol sequence ends.
    #[error(
        "{found} of {wanted} points found: the Sobol sequence ends after {draws} draws, of which {:.2} % were free; \
         must be fewer points, or `uniform` sampling", 100.0 * share
    )]
    SobolEnds {
        /// Points asked for.
        wanted: usize,
        /// Points found.
        found: usize,
        /// Draws made.
        draws: usize,
        /// Free share of the volume inside the margin, 0 … 1.
        share: f64,
    },
}

/// Length of the Sobol sequence that `sobol_burley` has.
const SOBOL_LENGTH: usize = 1 << 16;

/// `count` points at least the keep-in margin inside the walls and at least `clearance` (m) from every obstacle, by
/// rejection from at most 1 000 `count` + 10 000 draws. A pure function of its arguments.
///
/// The law is that of [`Sampling`] restricted to {p : wall distance ≥ margin, obstacle distance ≥ clearance}. Points in
/// order of the draws, world frame, m; expected cost is `count` over the free share, each draw one [`World::is_free`].
///
/// # Errors
/// [`SamplingError`], with the share of the volume that was found free.
pub fn sample_free(
    world: &World,
    count: usize,
    clearance: f64,
    sampling: Sampling,
    seed: u64,
) -> Result<Vec<Point3<f64>>, SamplingError> {
    let most = count.saturating_mul(1000).saturating_add(10_000);
    let margin = world.keep_in_margin();
    let room = world.size() - Vector3::repeat(2.0 * margin);
    let inside = |shares: Vector3<f64>| Point3::from(shares.component_mul(&room) + Vector3::repeat(margin));
    match sampling {
        Sampling::Uniform | Sampling::Clustered => {
            let mut random = stream(seed);
            let spacing = libm::cbrt(room.product() / count as f64);
            let draw = |index: usize, points: &[Point3<f64>]| match sampling.beside(index, points.len(), &mut random) {
                Some(other) => points[other] + Vector3::from(short_way(spacing, &mut random)),
                None => inside(Vector3::new(random.random(), random.random(), random.random())),
            };
            reject(world, count, clearance, most, draw).map_err(|(found, share)| SamplingError::NoSpace {
                wanted: count,
                found,
                draws: most,
                share,
            })
        }
        Sampling::Sobol => {
            let draws = most.min(SOBOL_LENGTH);
            let scramble = (seed ^ (seed >> 32)) as u32;
            let draw = |index: usize, _: &[Point3<f64>]| {
                let [x, y, z, _] = sobol_burley::sample_4d(index as u32, 0, scramble);
                inside(Vector3::new(x, y, z).map(f64::from))
            };
            reject(world, count, clearance, draws, draw).map_err(|(found, share)| {
                if draws < most {
                    SamplingError::SobolEnds { wanted: count, found, draws, share }
                } else {
                    SamplingError::NoSpace { wanted: count, found, draws, share }
                }
            })
        }
    }
}

impl Sampling {
    /// Beside which of the `found` points draw number `index` lies, if beside one.
    pub(crate) fn beside(self, index: usize, found: usize, random: &mut Stream) -> Option<usize> {
        (self == Self::Clustered && index % 2 == 1 && found > 0).then(|| random.random_range(0..found))
    }
}

/// From a point to one beside it in a cluster, m.
pub(crate) fn short_way<const D: usize>(spacing: f64, random: &mut Stream) -> [f64; D] {
    const NEAREST: f64 = 0.1;
    let distance = spacing * libm::pow(NEAREST, unit(random));
    let way = standard_normals::<D>(random);
    let norm = libm::sqrt(way.iter().map(|part| part * part).sum()).max(f64::MIN_POSITIVE);
    way.map(|part| part * (distance / norm))
}

/// The first `count` free points among the first `draws`, or how many there were and their share. A draw is told its
/// number and the points found before it.
fn reject(
    world: &World,
    count: usize,
    clearance: f64,
    draws: usize,
    mut draw: impl FnMut(usize, &[Point3<f64>]) -> Point3<f64>,
) -> Result<Vec<Point3<f64>>, (usize, f64)> {
    let margin = world.keep_in_margin();
    let open = world.obstacles().is_empty();
    let mut points = Vec::with_capacity(count.min(draws));
    for index in 0..draws {
        if points.len() == count {
            break;
        }
        let p = draw(index, &points);
        // Rounding can put a point a hair over the far margin.
        if world.wall_distance(&p) >= margin && (open || world.is_free(&p, clearance)) {
            points.push(p);
        }
    }
    if points.len() == count { Ok(points) } else { Err((points.len(), points.len() as f64 / draws as f64)) }
}
