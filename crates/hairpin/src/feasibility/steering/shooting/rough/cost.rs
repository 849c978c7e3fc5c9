//! What a motion on the ground costs, and what may be asked to become small along it.
//!
//! ```text
//! rise of the body's axes   ρ = (−sin θ, cos θ sin φ)       along the way   climb = ±(ρ · d)    across   side = d × ρ
//! slip lost  a = s₂₀ climb/sin 20°                          drift  s′₂₀ side/sin 20°
//! ```
//!
//! Integrals are midpoint sums over the prediction's own steps, and per metre of commanded travel. Turns in place cost
//! nothing.

use super::course::Course;
use super::outcome::Driven;
use super::predict::predict;
use crate::robot::rover::{Settled, Slip};
use crate::trajectory::drive::{Motion, Planar, Segment};
use crate::world::terrain::Terrain;

/// What to minimise along the motion on the ground, once it meets its goal within the bounds.
///
/// Costs are of the motion, not of the drive's wish: slip lengthens the way that the wheels go.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum GroundCost {
    /// Nothing: the first drive that meets the goal.
    #[default]
    Any,
    /// ∫κ² ds of the commands, 1/m.
    Curvature,
    /// ∫κ′² ds of the commands, 1/m³.
    Rate,
    /// ∫α² ds, α the angle of the body's z axis from the vertical: rad² m.
    Tilt,
    /// ∫√(a² + d²) ds, a and d the shares of the speed that are lost climbing and drift downhill: m.
    Slip,
    /// ∫g max(0, μ + sin γ) / (1 − a) ds, γ the climb along the way, a the slip, μ = 0.15: J/kg.
    Energy,
}

impl GroundCost {
    /// As it is written.
    pub fn name(self) -> &'static str {
        match self {
            Self::Any => "any",
            Self::Curvature => "curvature",
            Self::Rate => "rate",
            Self::Tilt => "tilt",
            Self::Slip => "slip",
            Self::Energy => "energy",
        }
    }

    /// ∫κ² ds or ∫κ′² ds of `commands`; 0 for costs that depend on the ground.
    ///
    /// Exact: six Gauss points a segment for squares of fifth order. Turns in place count nothing.
    pub fn of_commands(self, commands: &[Segment]) -> f64 {
        match self {
            Self::Curvature | Self::Rate => commands.iter().map(|piece| squares(piece, self)).sum(),
            Self::Any | Self::Tilt | Self::Slip | Self::Energy => 0.0,
        }
    }
}

/// What `commands` from `start` cost along their predicted motion; `None` where they do not pass.
///
/// Costs one prediction.
pub fn cost_along<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    commands: &[Segment],
    cost: GroundCost,
) -> Option<f64> {
    let mut along = Along::new(course, cost, commands);
    predict(course, start, commands, |driven| along.add(driven)).ok()?;
    Some(along.total())
}

/// sin 20°, where slips are told.
const SIN_20: f64 = 0.342_020_143_325_668_7;
/// g, m/s².
const GRAVITY: f64 = 9.806_65;
/// μ: resistance of rigid wheels on dry sand by the load, within 0.1 to 0.3 of M. G. Bekker, Introduction to
/// Terrain-Vehicle Systems (1969).
const ROLLING: f64 = 0.15;
/// A wheel that slips more than this counts as one that does not.
const MOST_SLIP: f64 = 0.9;
/// Points of a piece for what depends on its commands alone: exact for squares of fifth order.
const POINTS: usize = 6;

/// A cost being added up along a prediction.
pub(super) struct Along {
    cost: GroundCost,
    /// Of the vehicle under its load.
    slip: Slip,
    /// Sine and cosine of the direction of travel in the body, that at the start: swings are left out.
    direction: (f64, f64),
    /// ±1, the gear of the first command.
    sign: f64,
    /// Metres of commanded travel so far.
    done: f64,
    total: f64,
}

impl Along {
    /// The cost of `commands` along a prediction of theirs on `course`.
    pub(super) fn new<T>(course: &Course<'_, T>, cost: GroundCost, commands: &[Segment]) -> Self {
        let total = cost.of_commands(commands);
        let sign = commands.first().map_or(1.0, |first| first.gear.sign());
        Self { cost, slip: course.rover.slip, direction: libm::sincos(course.direction.start), sign, done: 0.0, total }
    }

    /// Each call must see the next step's middle; its length follows from where the middle lies.
    pub(super) fn add(&mut self, driven: &Driven) {
        // Steps are seen at their middles.
        let h = 2.0 * (driven.s - self.done);
        self.done += h;
        self.total += h * self.density(&driven.settled);
    }

    /// The cost per metre driven at this rest: tilt² in rad², slip as a share of the way, or energy per mass,
    /// max(0, ρ + rise)·g / (1 − slip lost), in J/(kg m). `rise` is the sine of the climb along the way of
    /// driving, so that energy going down is not given back.
    fn density(&self, settled: &Settled) -> f64 {
        let ((sin_roll, cos_roll), (sin_pitch, cos_pitch)) = (libm::sincos(settled.roll), libm::sincos(settled.pitch));
        // How steeply the body's axes rise, and with them the way and what is left of it.
        let (ahead, left) = (-sin_pitch, cos_pitch * sin_roll);
        let (sin, cos) = self.direction;
        let (climb, across) = (self.sign * (cos * ahead + sin * left), cos * left - sin * ahead);
        let lost = self.slip.at_20_deg * climb / SIN_20;
        match self.cost {
            GroundCost::Any | GroundCost::Curvature | GroundCost::Rate => 0.0,
            GroundCost::Tilt => {
                let tilt = libm::acos((cos_roll * cos_pitch).clamp(-1.0, 1.0));
                tilt * tilt
            }
            GroundCost::Slip => libm::hypot(lost, self.slip.side_at_20_deg * across / SIN_20),
            GroundCost::Energy => GRAVITY * (ROLLING + climb).max(0.0) / (1.0 - lost.clamp(0.0, MOST_SLIP)),
        }
    }

    pub(super) fn total(&self) -> f64 {
        self.total
    }
}

/// ∫κ² or ∫κ′² along a piece.
///
/// Horner's scheme for κ and κ′ at once; 1/m or 1/m³.
fn squares(piece: &Segment, cost: GroundCost) -> f64 {
    let Motion::Arc { length_m, curvature } = piece.motion else { return 0.0 };
    let rule = crate::math::quadrature::Gauss::<POINTS>::RULE;
    let mut sum = 0.0;
    for (node, weight) in rule.nodes.iter().zip(&rule.weights) {
        let (mut value, mut rate) = (0.0, 0.0);
        for a in curvature.iter().rev() {
            rate = rate * node * length_m + value;
            value = value * node * length_m + a;
        }
        let asked = if cost == GroundCost::Rate { rate } else { value };
        sum += weight * length_m * asked * asked;
    }
    sum
}
