//! Turns of continuous curvature: how the vehicle gets onto a circle, how far it stays, how it gets off.
//!
//! A turn from zero curvature onto a circle and back deflects by κ²/κ′ at least; its centre lies at (R sin μ, R cos μ)
//! of its start, with R and μ the circle's alone (Fraichard and Scheuer 2004), so that words of such turns are
//! spelt like Dubins' with another radius.
//!
//! ```text
//! turning of one clothoid   β = κ²/(2κ′)                centre seen from the end   (x_c − sin β/κ, y_c + cos β/κ)
//! (x_c, y_c) = the clothoid's end   deflection δ ≥ 2β: arc of (δ − 2β)/κ m between; less: elementary path
//! ```
//!
//! Signs: heading changes by sense · gear · angle; in reverse a turn is the mirror image, about the y axis, of one
//! forward.

use std::f64::consts::{PI, TAU};

use crate::math::fresnel::{clothoid, fresnel};
use crate::math::power::square;
use crate::trajectory::drive::{Gear, Segment};

use super::super::query::Curvatures;

/// Angles this close below a full turn are a turn of nothing: rounding, not a loop. rad
const NOTHING: f64 = 1e-10;

/// Bounds are kept with this factor to spare, so that rounding never exceeds them.
const UNDER: f64 = 1.0 - 1e-12;

/// Which way a turn goes, as signs: `sense` +1 left, −1 right; `gear` +1 forward, −1 in reverse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Way {
    /// 1 left, −1 right.
    pub(super) sense: f64,
    /// 1 forward, −1 in reverse.
    pub(super) gear: f64,
}

/// The four of them.
pub(super) const WAYS: [Way; 4] = [
    Way { sense: 1.0, gear: 1.0 },
    Way { sense: -1.0, gear: 1.0 },
    Way { sense: 1.0, gear: -1.0 },
    Way { sense: -1.0, gear: -1.0 },
];

/// Index of `way` in [`WAYS`].
pub(super) fn index(way: Way) -> usize {
    usize::from(way.sense < 0.0) + 2 * usize::from(way.gear < 0.0)
}

/// One end of a turn: the clothoid between the curvature there and that of the circle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Lead {
    /// Curvature at the turn's end, 1/m.
    pub(super) curvature: f64,
    /// Centre of the circle in the frame of the turn's end, m.
    ///
    /// x forward, y left.
    pub(super) center: (f64, f64),
    /// Change of heading over the clothoid as it is driven, rad.
    pub(super) turning: f64,
    /// Length of the clothoid, m.
    pub(super) length: f64,
}

/// A turn's shape between its ends.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Body {
    /// Lead, arc of this angle (rad, ≥ 0), lead.
    Arc(f64),
    /// Two clothoids of this sharpness (1/m²) and length (m), for deflections that a circle's leads overshoot: the
    /// elementary path of Scheuer and Fraichard (1997), whose ends lie on the same circle at the same angle.
    ///
    /// Peak curvature sharpness · length, deflection sharpness · length².
    Elementary { sharpness: f64, length: f64 },
}

/// A turn as it is driven.
///
/// Deflection = lead turning + sense · gear · arc + lead turning.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Turn {
    /// Constant over a turn.
    pub(super) way: Way,
    /// In the order driven: onto the circle.
    pub(super) entry: Lead,
    /// Off the circle.
    pub(super) exit: Lead,
    pub(super) body: Body,
}

/// What all turns at one curvature have in common.
#[derive(Debug, Clone, Copy)]
pub(super) struct Circle {
    /// Curvature of the arc, 1/m.
    pub(super) curvature: f64,
    /// |κ′| of the clothoids, 1/m².
    pub(super) rate: f64,
    /// Centre ahead of, and beside, a left turn's beginning at zero curvature: R sin μ and R cos μ, m.
    pub(super) ahead: f64,
    pub(super) aside: f64,
    /// Deflection below which no room is left for an arc between the two clothoids: κ²/κ′, rad.
    pub(super) shortest: f64,
    /// Half the shortest chord of a turn, m.
    least: f64,
    /// By way: onto the circle from zero curvature, off it to zero curvature, and neither.
    entries: [Lead; 4],
    exits: [Lead; 4],
    standing: [Lead; 4],
}

impl Circle {
    /// The circle of `share` of the largest curvature. Where the rate is so small that a clothoid pair would turn by
    /// more than half a turn, the curvature is less.
    ///
    /// `share` in (0, 1]. Curvature is at most √(0.999 π κ′), so that 2β < π.
    pub(super) fn new(bounds: &Curvatures, share: f64) -> Self {
        let rate = bounds.most_rate * UNDER;
        let curvature = (bounds.most * share * UNDER).min((0.999 * PI * rate).sqrt());
        let (x, y) = clothoid(0.0, curvature, rate);
        let half = curvature * curvature / (2.0 * rate);
        let (sin, cos) = libm::sincos(half);
        let (ahead, aside) = (x - sin / curvature, y + cos / curvature);
        let lead = |along: f64| {
            WAYS.map(|Way { sense, gear }| Lead {
                curvature: 0.0,
                center: (along * gear * ahead, sense * aside),
                turning: sense * gear * half,
                length: curvature / rate,
            })
        };
        let standing = WAYS.map(|Way { sense, .. }| {
            let full = sense * curvature;
            Lead { curvature: full, center: (0.0, 1.0 / full), turning: 0.0, length: 0.0 }
        });
        // The chord 2 R sin(δ/2 + μ) is concave in δ: least at one end of what elementary paths deflect by.
        let least = ahead.min(aside * sin + ahead * cos);
        let (entries, exits) = (lead(1.0), lead(-1.0));
        Self { curvature, rate, ahead, aside, shortest: 2.0 * half, least, entries, exits, standing }
    }

    /// Onto the circle from zero curvature.
    pub(super) fn entry(&self, way: Way) -> &Lead {
        &self.entries[index(way)]
    }

    /// Off the circle to zero curvature.
    pub(super) fn exit(&self, way: Way) -> &Lead {
        &self.exits[index(way)]
    }

    /// An end at full curvature: no clothoid; the wheels are swung over where the vehicle stands.
    pub(super) fn standing(&self, way: Way) -> &Lead {
        &self.standing[index(way)]
    }

    /// Onto the circle from `curvature`.
    ///
    /// `curvature` as the vehicle drives it, left positive in both gears; any within ± the circle's. Turning is gear ·
    /// (κ + κ_full)/2 · length.
    pub(super) fn entry_from(&self, way: Way, curvature: f64) -> Lead {
        if curvature == 0.0 {
            return *self.entry(way);
        }
        let Way { sense, gear } = way;
        let full = sense * self.curvature;
        let (x, y) = clothoid(curvature, full, self.rate);
        let length = (full - curvature).abs() / self.rate;
        // In reverse the path is the forward one's mirror image about the y axis.
        let turning = gear * 0.5 * (curvature + full) * length;
        let (sin, cos) = libm::sincos(turning);
        let center = (gear * x - sin / full, y + cos / full);
        Lead { curvature, center, turning, length }
    }

    /// Off the circle to `curvature`: on it in the other gear, backwards in time.
    ///
    /// Centre and turning in the frame of the turn's end.
    pub(super) fn exit_to(&self, way: Way, curvature: f64) -> Lead {
        let on = self.entry_from(Way { gear: -way.gear, ..way }, curvature);
        Lead { turning: -on.turning, ..on }
    }

    /// Length (m) of these ends without any arc between them, or of the shortest elementary path.
    ///
    /// A lower bound of the turn's length, cheaper than [`Self::at_least`]: no angle is needed.
    pub(super) fn leads(&self, entry: &Lead, exit: &Lead) -> f64 {
        if entry.curvature == 0.0 && exit.curvature == 0.0 { 2.0 * self.least } else { entry.length + exit.length }
    }

    /// Length (m) below which no turn between these ends changes the heading by `angle` (rad, modulo 2π): exact for
    /// arcs.
    ///
    /// For elementary paths a bound only: sharper ones than they are would be shorter. `angle` of any number of turns.
    pub(super) fn at_least(&self, way: Way, entry: &Lead, exit: &Lead, angle: f64) -> f64 {
        let towards = way.sense * way.gear;
        if entry.curvature == 0.0 && exit.curvature == 0.0 {
            let deflection = positive(towards * angle);
            // Two clothoids of the largest sharpness turn the most.
            return if deflection < self.shortest {
                2.0 * (deflection / self.rate).sqrt().max(self.least)
            } else {
                entry.length + exit.length + (deflection - self.shortest) / self.curvature
            };
        }
        let arc = positive(towards * (angle - entry.turning - exit.turning));
        entry.length + exit.length + arc / self.curvature
    }

    /// The turn that changes the heading by `angle` (rad, modulo 2π), and its length in m.
    ///
    /// Below the least deflection the elementary path is taken where it keeps both bounds, else the arc of nearly a
    /// full turn.
    pub(super) fn turn(&self, way: Way, entry: &Lead, exit: &Lead, angle: f64) -> (Turn, f64) {
        let (towards, entry, exit) = (way.sense * way.gear, *entry, *exit);
        if entry.curvature == 0.0 && exit.curvature == 0.0 {
            let deflection = positive(towards * angle);
            if deflection < self.shortest
                && let Some((sharpness, length)) = self.elementary(deflection)
            {
                return (Turn { way, entry, exit, body: Body::Elementary { sharpness, length } }, 2.0 * length);
            }
        }
        let arc = positive(towards * (angle - entry.turning - exit.turning));
        let length = entry.length + exit.length + arc / self.curvature;
        (Turn { way, entry, exit, body: Body::Arc(arc) }, length)
    }

    /// Sharpness and half length of the elementary path of this deflection whose ends lie where this circle's turn of
    /// the same deflection has them: chord 2 R sin(δ/2 + μ) = 2 √(π/q) (cos(δ/2) C(√(δ/π)) + sin(δ/2) S(√(δ/π))).
    ///
    /// `None` where it would be sharper than the rate or bend more than the circle. δ in (0, 2β) rad; below 10⁻¹⁰ it is
    /// the straight of both halves. The sharpness follows from the chord, q = π (unit/half chord)², and length =
    /// √(δ/q), m.
    fn elementary(&self, deflection: f64) -> Option<(f64, f64)> {
        let (sin, cos) = libm::sincos(0.5 * deflection);
        let half_chord = self.aside * sin + self.ahead * cos;
        if deflection < NOTHING {
            return Some((0.0, half_chord));
        }
        let (c, s) = fresnel((deflection / PI).sqrt());
        let unit = cos * c + sin * s;
        let sharpness = PI * square(unit / half_chord);
        let fits = sharpness <= self.rate && deflection * sharpness <= self.curvature * self.curvature;
        (fits && unit > 0.0 && half_chord > 0.0).then(|| (sharpness, (deflection / sharpness).sqrt()))
    }
}

impl Turn {
    /// Hands over its segments, on a circle of the curvature `most` (1/m).
    ///
    /// Segments of no length are handed over as well; who takes them leaves them out.
    pub(super) fn segments(&self, most: f64, push: &mut impl FnMut(Segment)) {
        let gear = gear_of(self.way.gear);
        let full = self.way.sense * most;
        match self.body {
            Body::Elementary { sharpness, length } => {
                let peak = self.way.sense * sharpness * length;
                push(Segment::clothoid(length, 0.0, peak, gear));
                push(Segment::clothoid(length, peak, 0.0, gear));
            }
            Body::Arc(angle) => {
                push(Segment::clothoid(self.entry.length, self.entry.curvature, full, gear));
                push(Segment::clothoid(angle / most, full, full, gear));
                push(Segment::clothoid(self.exit.length, full, self.exit.curvature, gear));
            }
        }
    }
}

/// The gear of a sign.
pub(super) fn gear_of(sign: f64) -> Gear {
    if sign > 0.0 { Gear::Forward } else { Gear::Reverse }
}

/// `angle` in [0, 2π), rounding errors below a full turn being zero.
///
/// In one step of truncation for any `angle` within ±2⁶³ turns; NaN stays NaN.
fn positive(angle: f64) -> f64 {
    // Truncation and a step: many times as fast as a call of `floor` where the processor has no instruction for it.
    let wrapped = angle - TAU * ((angle / TAU) as i64 as f64);
    let wrapped = if wrapped < 0.0 { wrapped + TAU } else { wrapped };
    if wrapped > TAU - NOTHING { 0.0 } else { wrapped }
}
