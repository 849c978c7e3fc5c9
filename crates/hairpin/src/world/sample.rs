//! Points drawn from the free space of a world: independent and uniform, or a scrambled Sobol sequence.

use nalgebra::{Point3, Vector3};
use rand::RngExt;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::World;
use crate::math::random::stream;

/// How points are spread.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "kebab-case")]
pub enum Sampling {
    /// Independent and uniform.
    #[default]
    Uniform,
    /// An Owen-scrambled Sobol sequence (Burley 2020), at most 65 536 draws long.
    Sobol,
}

/// Why there are not enough points.
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
    match sampling {
        Sampling::Uniform => {
            let mut random = stream(seed);
            let draw = |_| Vector3::new(random.random(), random.random(), random.random());
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
            let draw = |index: usize| {
                let [x, y, z, _] = sobol_burley::sample_4d(index as u32, 0, scramble);
                Vector3::new(x, y, z).map(f64::from)
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

/// The first `count` free points among the first `draws` of the unit cube, or how many there were and their share.
fn reject(
    world: &World,
    count: usize,
    clearance: f64,
    draws: usize,
    mut draw: impl FnMut(usize) -> Vector3<f64>,
) -> Result<Vec<Point3<f64>>, (usize, f64)> {
    let margin = world.keep_in_margin();
    let room = world.size() - Vector3::repeat(2.0 * margin);
    let open = world.obstacles().is_empty();
    let mut points = Vec::with_capacity(count.min(draws));
    for index in 0..draws {
        if points.len() == count {
            break;
        }
        let unit = draw(index);
        let p = Point3::from(unit.component_mul(&room) + Vector3::repeat(margin));
        // Rounding can put a point a hair over the far margin.
        if world.wall_distance(&p) >= margin && (open || world.is_free(&p, clearance)) {
            points.push(p);
        }
    }
    if points.len() == count { Ok(points) } else { Err((points.len(), points.len() as f64 / draws as f64)) }
}
