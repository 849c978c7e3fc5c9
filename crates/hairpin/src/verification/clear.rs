//! Whether a planned path keeps its distance from solids, between samples too.
//!
//! A solid S is convex. From its point nearest to a place p, outside it by the distance d, the unit vector n points to
//! p, and S lies behind the plane there: every place q is outside S by n·(q − p) + d at least. Of a piece of a leg
//! about its middle p(m), h being half its duration, that leaves d − Σ_k |n·p⁽ᵏ⁾(m)|/k! hᵏ: the Taylor sum of a
//! polynomial is exact. Where that does not decide, the piece is halved. Inside S, where there is no such plane, a
//! place is deeper than another by no more than the way between them.

use super::claim::Leg;
use super::clear_solid::{ClearSolid, norm, winds_around};
use super::finding::{Collector, Finding};

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
/// The nearest place is told to this, m.
const RESOLUTION: f64 = 1e-4;

/// All solids that the path comes too near to, with the place where it is nearest to them.
///
/// Doubles with 1 nm of room, not intervals. A path that touches a solid at exactly the clearance is decided by that
/// room.
///
/// One finding a solid, field `environment.obstacles[k].clearance`, value the least distance found (to 0.1 mm), bound
/// the clearance, m. Halving stops after 40 levels, which counts as too near.
///
/// ```
/// use hairpin::verification::{ClearClaim, ClearSolid, Leg, verify_clear};
///
/// // Along x past a ball of 1 m whose centre is 3 m aside: 2 m are left.
/// let along = [[0.0, 5.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0], [0.0; 8], [0.0; 8]];
/// let legs = [Leg { duration: 2.0, coefficients: along }];
/// let solids = [ClearSolid::Ball([5.0, 3.0, 0.0], 1.0)];
/// let claim = |clearance| ClearClaim { legs: &legs, solids: &solids, clearance };
/// assert!(verify_clear(&claim(1.9)).is_empty());
/// assert_eq!(verify_clear(&claim(2.1)).len(), 1);
/// ```
pub fn verify_clear(claim: &ClearClaim) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (number, solid) in claim.solids.iter().enumerate() {
        if let Some(Near { distance, leg, at }) = nearest(claim.legs, std::iter::once(*solid), claim.clearance) {
            let mut found = Collector::about(&mut findings, "environment").at(leg, at);
            found.unless(false, format_args!("obstacles[{number}].clearance"), distance, claim.clearance, "m");
        }
    }
    findings
}

/// Whether a path comes too near to a closed surface of `triangles`, or begins within it: the place where it is
/// nearest, as `field`.
///
/// As [`verify_clear`], each triangle being a solid; a path that begins outside comes inside only through one. A path
/// without a leg keeps away from everything.
pub fn verify_clear_of_surface(
    legs: &[Leg],
    triangles: &[[[f64; 3]; 3]],
    clearance: f64,
    field: &str,
) -> Option<Finding> {
    let start = legs.first()?.coefficients.map(|c| c[0]);
    let solids = || triangles.iter().map(|corners| ClearSolid::Triangle(*corners));
    let inside = winds_around(triangles, &start).abs() > 0.5;
    let near = if inside {
        let depth = solids().map(|solid| solid.distance(&start)).fold(f64::INFINITY, f64::min);
        Near { distance: -depth, leg: 0, at: 0.0 }
    } else {
        nearest(legs, solids(), clearance)?
    };
    let Near { distance, leg, at } = near;
    Some(Finding { field: field.into(), value: distance, bound: clearance, unit: "m", leg, at })
}

/// Where a path is nearest to any of `solids`, where that is nearer than `clearance`, or not shown not to be.
fn nearest(legs: &[Leg], solids: impl Iterator<Item = ClearSolid>, clearance: f64) -> Option<Near> {
    let mut nearest: Option<Near> = None;
    for solid in solids {
        let mut began = 0.0;
        for (place, leg) in legs.iter().enumerate() {
            let here = Near { distance: f64::NAN, leg: place, at: began };
            if !(leg.is_finite() && solid.is_finite()) {
                return Some(here);
            }
            approach(leg, &solid, clearance - ROUNDING, [0.0, leg.duration], here, &mut nearest, DEPTH);
            began += leg.duration;
        }
    }
    nearest
}

/// A place that is too near.
#[derive(Clone, Copy)]
struct Near {
    /// How near, m.
    distance: f64,
    leg: usize,
    /// When, s.
    at: f64,
}

/// Puts the nearest place of a piece into `nearest` where it is nearer than `least`, or not shown not to be, and nearer
/// than what is there. `here`: the leg, and when it begins.
fn approach(
    leg: &Leg,
    solid: &ClearSolid,
    least: f64,
    [from, to]: [f64; 2],
    here: Near,
    nearest: &mut Option<Near>,
    depth: u32,
) {
    let middle = 0.5 * (from + to);
    let around = taylor(leg, middle);
    let p = around.map(|c| c[0]);
    let distance = solid.distance(&p);
    let reach = approaches(&around, solid.away(&p), 0.5 * (to - from));
    let beats = nearest.map_or(least, |near| (near.distance - RESOLUTION).min(least));
    if distance - reach >= beats {
        return;
    }
    if (distance < least || depth == 0) && nearest.is_none_or(|near| distance < near.distance) {
        *nearest = Some(Near { distance, at: here.at + middle, ..here });
    }
    if depth > 0 {
        approach(leg, solid, least, [from, middle], here, nearest, depth - 1);
        approach(leg, solid, least, [middle, to], here, nearest, depth - 1);
    }
}

/// Taylor coefficients of the path at `tau`, of each axis.
fn taylor(leg: &Leg, tau: f64) -> [[f64; 8]; 3] {
    leg.coefficients.map(|mut c| {
        // By repeated synthetic division.
        for k in 0..8 {
            for i in (k..7).rev() {
                c[i] += tau * c[i + 1];
            }
        }
        c
    })
}

/// By how much a solid that lies in the direction −`away` is nearer within `h` s, at most; `None`: one in any
/// direction.
fn approaches(around: &[[f64; 8]; 3], away: Option<[f64; 3]>, h: f64) -> f64 {
    let sum = |c: &dyn Fn(usize) -> f64| (1..8).rev().fold(0.0, |sum, k| (sum + c(k).abs()) * h);
    match away {
        Some(n) => sum(&|k| (0..3).map(|axis| n[axis] * around[axis][k]).sum()),
        None => norm(std::array::from_fn(|axis| sum(&|k| around[axis][k]))),
    }
}

#[cfg(feature = "unit-tests")]
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
    fn along_a_face_at_just_the_clearance_is_clear() {
        let mut coefficients = [[0.0; 8]; 3];
        (coefficients[0][1], coefficients[1][0], coefficients[2][0]) = (3.0, 0.7, 0.7);
        let along = Leg { duration: 4.0, coefficients };
        let wall = ClearSolid::Box([6.0, 1.7, 0.0], [12.0, 1.0, 9.0]);
        let verify = |clearance| verify_clear(&ClearClaim { legs: &[along], solids: &[wall], clearance });
        assert!(verify(0.5).is_empty());
        assert_eq!(verify(0.501).len(), 1);
    }

    #[test]
    fn a_millimetre_is_told_from_its_other_side() {
        // The arch's top is (2, 0, 1) at t = 1.
        let ball = |gap: f64| ClearSolid::Ball([2.0, 0.0, 1.7 + gap], 0.5);
        assert!(found(ball(0.001), 0.2).is_empty());
        let near = &found(ball(-0.001), 0.2)[..];
        assert!(near.len() == 1 && near[0].leg == 0 && (near[0].at - 1.0).abs() < 0.1, "{near:?}");
        assert!((near[0].value - 0.199).abs() < 1e-4 && near[0].field == "environment.obstacles[0].clearance");
        let cuboid = |gap: f64| ClearSolid::Box([2.0, 0.0, 1.7 + gap], [3.0, 1.0, 1.0]);
        assert!(found(cuboid(0.001), 0.2).is_empty());
        assert_eq!(found(cuboid(-0.001), 0.2).len(), 1);
        // Through the middle, where it is the deepest inside, and what is no number.
        let through = &found(ClearSolid::Box([2.0, 0.0, 1.0], [0.1; 3]), 0.0)[..];
        assert!(
            through.len() == 1 && (through[0].value + 0.05).abs() < 1e-4 && (through[0].at - 1.0).abs() < 1e-3,
            "{through:?}"
        );
        assert!(found(ClearSolid::Ball([f64::NAN, 0.0, 0.0], 1.0), 0.2)[0].value.is_nan());
    }

    /// The surface of a cuboid of triangles is kept as the cuboid is, and nothing is inside of it unseen.
    #[test]
    fn a_surface_is_as_near_as_what_it_encloses() {
        let (centre, size) = ([2.0, 0.0, 1.9], [3.0, 1.0, 1.0]);
        let corner = |i: usize| std::array::from_fn(|k| centre[k] + size[k] * if i >> k & 1 == 1 { 0.5 } else { -0.5 });
        let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
        let triangles: Vec<[[f64; 3]; 3]> =
            faces.iter().flat_map(|f| [[f[0], f[1], f[2]], [f[0], f[2], f[3]]].map(|t| t.map(corner))).collect();
        let surface = |legs: &[Leg], clearance: f64| verify_clear_of_surface(legs, &triangles, clearance, "s");
        // Its underside is 0.4 m above the arch's top.
        assert!(surface(&[arch(), arch()], 0.399).is_none());
        let near = surface(&[arch(), arch()], 0.401).unwrap();
        let cuboid = &found(ClearSolid::Box(centre, size), 0.401)[0];
        assert!((near.value - cuboid.value).abs() < 2e-4 && near.field == "s", "{near:?} {cuboid:?}");
        // Wholly inside, touching no face.
        let still =
            |z: f64| Leg { duration: 1.0, coefficients: [2.0, 0.0, z].map(|x| [x, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0]) };
        assert!((surface(&[still(1.8)], 0.0).unwrap().value + 0.4).abs() < 1e-12);
        assert!(surface(&[still(1.0)], 0.2).is_none() && surface(&[], 0.2).is_none());
    }

    #[test]
    fn a_capsule_is_a_ball_along_its_axis() {
        let capsule = |gap: f64| ClearSolid::Capsule([2.0, -1.0, 1.7 + gap], [2.0, 1.0, 1.7 + gap], 0.5);
        assert!(found(capsule(0.001), 0.2).is_empty());
        assert!((found(capsule(-0.001), 0.2)[0].value - 0.199).abs() < 1e-4);
    }
}
