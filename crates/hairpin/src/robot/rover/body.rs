//! What a rover's wheels carry: centre of mass and underside, given or estimated.
//!
//! Margins need more of a body than its wheels. Where a file says nothing the guess is the one that flatters least
//! among simple ones, and is named in `estimated`.

use nalgebra::Vector3;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Suspension;
use super::error::{RoverError, place, within, wrong};

/// The rigid body on the suspension, in its own frame.
///
/// Body frame; the centre of mass is rigid with it, whatever the joints do.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Body {
    /// Centre of mass of the whole vehicle, m.
    pub centre_of_mass: Vector3<f64>,
    /// The underside.
    pub belly: Belly,
}

/// A level rectangle below the body, m.
///
/// Front ≥ rear. Its plane is z = height in the body frame; what hangs lower is not looked at.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Belly {
    /// Its front edge, x.
    pub front: f64,
    /// Its rear edge, x.
    pub rear: f64,
    /// Half of its width.
    pub half_width: f64,
    /// Its height, z.
    pub height: f64,
}

/// The underside, a rectangle in the body frame.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct BellyDescription {
    /// Its front edge, x.
    pub front_m: f64,
    /// Its rear edge, x.
    pub rear_m: f64,
    /// Half of its width.
    pub half_width_m: f64,
    /// Its height, z.
    pub height_m: f64,
}

impl Body {
    /// Checked numbers, or estimates: the centre of mass over the middle of the wheels, the underside between the
    /// outermost wheels, both at the height of the body's origin, or of the wheels' centres if that is higher.
    ///
    /// A centre of mass must lie above the level ground below the wheels and strictly between them as seen from above;
    /// the underside at or above that ground. Names of what was guessed are added to `estimated`.
    pub(super) fn build(
        suspension: &Suspension,
        centre_of_mass: Option<&[f64; 3]>,
        belly: Option<&BellyDescription>,
        estimated: &mut Vec<&'static str>,
    ) -> Result<Self, RoverError> {
        let (wheels, count, _) = suspension.wheels(&[0.0; 3]);
        let wheels = &wheels[..count];
        let mean = |of: fn(&Vector3<f64>) -> f64| wheels.iter().map(of).sum::<f64>() / wheels.len().max(1) as f64;
        let height = mean(|w| w.z).max(0.0);
        let ground = -suspension.ride_height();
        let centre_of_mass = match centre_of_mass {
            Some(at) => {
                let at = place("centre_of_mass_m", at)?;
                if at.z - ground < 1e-3 && count > 0 {
                    let bound = format!("over the ground below the wheels: z ≥ {:.4} m", ground + 1e-3);
                    return Err(wrong("centre_of_mass_m", format!("{:?}", at.as_slice()), bound));
                }
                let extent = |of: fn(&Vector3<f64>) -> f64| {
                    wheels.iter().map(of).fold((f64::MAX, f64::MIN), |(a, b), v| (a.min(v), b.max(v)))
                };
                let ((rear, front), (right, left)) = (extent(|w| w.x), extent(|w| w.y));
                if count > 0 && !(at.x > rear && at.x < front && at.y > right && at.y < left) {
                    return Err(wrong("centre_of_mass_m", format!("{:?}", at.as_slice()), "between the wheels"));
                }
                at
            }
            None => {
                if count > 0 {
                    estimated.push("centre_of_mass_m");
                }
                Vector3::new(mean(|w| w.x), 0.0, height)
            }
        };
        let belly = match belly {
            Some(given) => {
                let front = within("belly.front_m", given.front_m, -100.0, 100.0)?;
                Belly {
                    front,
                    rear: within("belly.rear_m", given.rear_m, -100.0, front)?,
                    half_width: within("belly.half_width_m", given.half_width_m, 0.0, 100.0)?,
                    height: within("belly.height_m", given.height_m, if count > 0 { ground } else { -100.0 }, 100.0)?,
                }
            }
            None if count > 0 => {
                estimated.push("belly");
                let x = || wheels.iter().map(|w| w.x);
                Belly {
                    front: x().fold(f64::MIN, f64::max),
                    rear: x().fold(f64::MAX, f64::min),
                    half_width: wheels.iter().map(|w| w.y.abs()).fold(f64::MAX, f64::min),
                    height,
                }
            }
            None => Belly::default(),
        };
        Ok(Self { centre_of_mass, belly })
    }
}
