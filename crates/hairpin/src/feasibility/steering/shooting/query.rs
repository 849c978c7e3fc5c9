//! What is asked of the generator, checked where it is built.
//!
//! Refused here, so that no solver needs to ask again: numbers that are no numbers, lengths that are a mistake of unit,
//! end curvatures that no curve within the bounds has. A question that passes may still have no answer of a given
//! family.

use thiserror::Error;

/// Pose and curvature to end in, in the frame of the start: x forward, y left.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Goal {
    /// Forward of the start, m.
    pub x: f64,
    /// Left of the start, m.
    pub y: f64,
    /// Heading, rad, left positive; equal modulo 2π.
    pub yaw: f64,
    /// κ at the end, 1/m.
    pub curvature: f64,
}

/// A boundary-value problem on flat ground: from the origin, heading along x, to a goal.
///
/// In the frame of the start: x forward, y left. What [`Query::new`] passed every solver here takes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Query {
    /// κ at the start, 1/m.
    pub start_curvature: f64,
    /// Where to end.
    pub goal: Goal,
}

/// What the path may bend: |κ| ≤ `most`, |κ′| ≤ `most_rate` along it.
///
/// The vehicle's, or tighter. most_rate/most² says how fast it steers in units of its tightest circle.
///
/// Both > 0 and finite; [`Query::new`] does not check them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Curvatures {
    /// Largest |κ|, 1/m.
    pub most: f64,
    /// Largest |dκ/ds|, 1/m².
    pub most_rate: f64,
}

/// The errors within which a goal counts as met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Precision {
    /// Distance in the plane, m.
    pub position: f64,
    /// Heading, rad.
    pub yaw: f64,
    /// Curvature, 1/m.
    pub curvature: f64,
}

impl Default for Precision {
    /// 1 cm, 0.01 rad, 0.01 1/m.
    fn default() -> Self {
        Self { position: 0.01, yaw: 0.01, curvature: 0.01 }
    }
}

impl Precision {
    /// `share` of each error.
    ///
    /// `share` > 0: 10⁻³ of it is what descents aim at, so that what is answered can be judged by the whole.
    pub fn share(&self, share: f64) -> Self {
        Self { position: share * self.position, yaw: share * self.yaw, curvature: share * self.curvature }
    }
}

/// Why numbers make no question.
#[derive(Debug, Clone, Copy, PartialEq, Error)]
#[error("{field} = {value}: must be {bound}")]
pub struct Refusal {
    /// The field's name, as in query files: `kf`.
    pub field: &'static str,
    /// The offending value.
    pub value: f64,
    /// What it must be.
    pub bound: &'static str,
}

/// Farther goals are mistakes of unit: |x| and |y| stay below, m.
pub const FARTHEST: f64 = 1e6;

impl Query {
    /// Checks a question against the vehicle's curvature bounds.
    ///
    /// # Errors
    /// Values that are not finite, a goal farther than [`FARTHEST`], end curvatures beyond `bounds`.
    pub fn new(start_curvature: f64, goal: Goal, bounds: &Curvatures) -> Result<Self, Refusal> {
        let far = |field, value: f64| Refusal { field, value, bound: "finite and within ±1e6 m" };
        for (field, value) in [("x", goal.x), ("y", goal.y)] {
            if !value.is_finite() || value.abs() > FARTHEST {
                return Err(far(field, value));
            }
        }
        // A yaw beyond this has lost its precision to the turns in it.
        if !goal.yaw.is_finite() || goal.yaw.abs() > 1e6 {
            return Err(Refusal { field: "yaw", value: goal.yaw, bound: "finite and within ±1e6 rad" });
        }
        for (field, value) in [("k0", start_curvature), ("kf", goal.curvature)] {
            if !value.is_finite() || value.abs() > bounds.most {
                return Err(Refusal { field, value, bound: "finite and within ± the largest curvature" });
            }
        }
        Ok(Self { start_curvature, goal })
    }
}
