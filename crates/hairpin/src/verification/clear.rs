//! Whether a planned path keeps its distance from solids, between samples too.
//!
//! A piece of a leg lies within Σ_k |p⁽ᵏ⁾(m)|/k! hᵏ of its middle p(m), h being half its duration: the Taylor sum of a polynomial is exact. Where
//! that does not decide, the piece is halved.

use super::claim::Leg;
use super::finding::Finding;

/// A solid.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClearSolid {
    /// A ball: centre and radius, m.
    Ball([f64; 3], f64),
    /// A box along the axes: centre and edge lengths, m.
    Box([f64; 3], [f64; 3]),
}

/// What is claimed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearClaim<'a> {
    /// The path; straight legs are polynomials of the first degree.
    pub legs: &'a [Leg],
    /// What it keeps away from.
    pub solids: &'a [ClearSolid],
    /// How far, m.
    pub clearance: f64,
}

/// Halvings after which a piece that is not decided counts as too near.
const DEPTH: u32 = 40;
/// What rounding may take, m.
const ROUNDING: f64 = 1e-9;

/// All solids that a leg comes too near to, at their first such place.
pub fn verify_clear(claim: &ClearClaim) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (number, solid) in claim.solids.iter().enumerate() {
        let mut began = 0.0;
        for (place, leg) in claim.legs.iter().enumerate() {
            let near = if leg.is_finite() && solid.is_finite() {
                first_near(leg, solid, claim.clearance - ROUNDING, [0.0, leg.duration], DEPTH)
            } else {
                Some((f64::NAN, 0.0))
            };
            if let Some((value, tau)) = near {
                findings.push(Finding {
                    field: format!("environment.obstacles[{number}].clearance"),
                    value,
                    bound: claim.clearance,
                    unit: "m",
                    leg: place,
                    at: began + tau,
                });
                break;
            }
            began += leg.duration;
        }
    }
    findings
}

/// Distance and time of the first place of a piece that is nearer than `least`, or not shown not to be.
fn first_near(leg: &Leg, solid: &ClearSolid, least: f64, [from, to]: [f64; 2], depth: u32) -> Option<(f64, f64)> {
    let middle = 0.5 * (from + to);
    let (p, reach) = around(leg, middle, 0.5 * (to - from));
    let distance = solid.distance(&p);
    if distance - reach >= least {
        return None;
    }
    if depth == 0 || distance + reach < least {
        return Some((distance, middle));
    }
    first_near(leg, solid, least, [from, middle], depth - 1)
        .or_else(|| first_near(leg, solid, least, [middle, to], depth - 1))
}

/// The place at `tau`, and how far from it the path gets within `h` s.
fn around(leg: &Leg, tau: f64, h: f64) -> ([f64; 3], f64) {
    let mut reach = [0.0; 3];
    let mut place = [0.0; 3];
    for (axis, coefficients) in leg.coefficients.iter().enumerate() {
        let mut c = *coefficients;
        // Taylor coefficients at tau by repeated synthetic division.
        for k in 0..8 {
            for i in (k..7).rev() {
                c[i] += tau * c[i + 1];
            }
        }
        place[axis] = c[0];
        reach[axis] = c[1..].iter().rev().fold(0.0, |sum, c| (sum + c.abs()) * h);
    }
    (place, reach.iter().map(|r| r * r).sum::<f64>().sqrt())
}

impl ClearSolid {
    fn is_finite(&self) -> bool {
        let finite = |numbers: &[f64]| numbers.iter().all(|x| x.is_finite());
        match self {
            Self::Ball(centre, radius) => finite(centre) && radius.is_finite(),
            Self::Box(centre, size) => finite(centre) && finite(size),
        }
    }

    /// Distance of `p`, m; negative inside.
    fn distance(&self, p: &[f64; 3]) -> f64 {
        let norm = |v: [f64; 3]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        match self {
            Self::Ball(centre, radius) => norm(std::array::from_fn(|i| p[i] - centre[i])) - radius,
            Self::Box(centre, size) => {
                let beyond: [f64; 3] = std::array::from_fn(|i| (p[i] - centre[i]).abs() - 0.5 * size[i]);
                norm(beyond.map(|x| x.max(0.0))) + beyond.into_iter().fold(f64::NEG_INFINITY, f64::max).min(0.0)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Along x at 2 m/s, rising to 1 m and falling again: z = t (2 − t).
    fn arch() -> Leg {
        let mut coefficients = [[0.0; 8]; 3];
        (coefficients[0][1], coefficients[2][1], coefficients[2][2]) = (2.0, 2.0, -1.0);
        Leg { duration: 2.0, coefficients }
    }

    fn found(solid: ClearSolid, clearance: f64) -> Vec<Finding> {
        verify_clear(&ClearClaim { legs: &[arch(), arch()], solids: &[solid], clearance })
    }

    #[test]
    fn a_millimetre_is_told_from_its_other_side() {
        // The arch's top is (2, 0, 1) at t = 1.
        let ball = |gap: f64| ClearSolid::Ball([2.0, 0.0, 1.7 + gap], 0.5);
        assert!(found(ball(0.001), 0.2).is_empty());
        let near = &found(ball(-0.001), 0.2)[..];
        assert!(near.len() == 1 && near[0].leg == 0 && (near[0].at - 1.0).abs() < 0.1, "{near:?}");
        assert!((0.1989..0.2).contains(&near[0].value) && near[0].field == "environment.obstacles[0].clearance");
        let cuboid = |gap: f64| ClearSolid::Box([2.0, 0.0, 1.7 + gap], [3.0, 1.0, 1.0]);
        assert!(found(cuboid(0.001), 0.2).is_empty());
        assert_eq!(found(cuboid(-0.001), 0.2).len(), 1);
        // Through the middle, and what is no number.
        assert_eq!(found(ClearSolid::Box([2.0, 0.0, 1.0], [0.1; 3]), 0.0).len(), 1);
        assert!(found(ClearSolid::Ball([f64::NAN, 0.0, 0.0], 1.0), 0.2)[0].value.is_nan());
    }
}
