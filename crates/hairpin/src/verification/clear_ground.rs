//! Whether a planned drive keeps its distance from discs on the ground, between the steps of its replay too, and
//! whether these lie on the map.

use super::drives::DriveLegClaim;
use super::finding::{Collector, Finding};
use super::ground::follow_ground;
use super::ground_claim::GroundVehicle;
use super::place::FlatPlace;
use super::way::Way;
use crate::world::terrain::Terrain;

/// A disc on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearDisc {
    /// x and y, m.
    pub center: [f64; 2],
    /// m, > 0.
    pub radius: f64,
}

/// What is planned.
///
/// `Straight` is for reach sets that claim no more than straight legs.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ClearDrive<'a> {
    /// Commands, each leg from its own start.
    Legs(&'a [DriveLegClaim]),
    /// Straight legs between waypoints, x and y, m.
    Straight(&'a [[f64; 2]]),
}

/// What is claimed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ClearGroundClaim<'a> {
    /// The planned drive.
    pub drive: ClearDrive<'a>,
    /// What it keeps away from.
    pub discs: &'a [ClearDisc],
    /// How far, m.
    pub clearance: f64,
    /// Least and largest x and y of the map, m.
    pub extent: ([f64; 2], [f64; 2]),
}

/// What rounding may take, m.
const ROUNDING: f64 = 1e-9;

/// All discs that are none, that are not all on the map, or that a leg comes too near to, with the leg that comes
/// nearest.
///
/// A leg that cannot be replayed is as near as can be.
///
/// Distances are those of the body's origin in the plane. Fields `environment.keep_out[k].radius`, `.outside`,
/// `.clearance`, in m. One replay a leg, and O(steps) for each disc.
pub fn verify_clear_ground<T: Terrain>(vehicle: &GroundVehicle, terrain: &T, claim: &ClearGroundClaim) -> Vec<Finding> {
    let mut findings = Vec::new();
    let legs = claim.drive.legs(vehicle, terrain);
    for (number, disc) in claim.discs.iter().enumerate() {
        let ClearDisc { center, radius } = *disc;
        let mut found = Collector::about(&mut findings, &format!("environment.keep_out[{number}]"));
        let sound = center.iter().all(|x| x.is_finite()) && radius.is_finite() && radius > 0.0;
        found.unless(sound, "radius", radius, 0.0, "m");
        if !sound {
            continue;
        }
        let (low, high) = claim.extent;
        let outside = |i: usize| (low[i] + radius - center[i]).max(center[i] + radius - high[i]);
        let outside = outside(0).max(outside(1));
        found.unless(outside <= ROUNDING, "outside", outside, 0.0, "m");
        let place = FlatPlace::Disc(center, radius);
        let wanted = claim.clearance - ROUNDING;
        let away = |way: &Option<Way>| way.as_ref().map_or(f64::NEG_INFINITY, |way| way.distance(&place, wanted));
        let nearest = legs.iter().enumerate().map(|(leg, (began, way))| (away(way), leg, *began));
        let Some((distance, leg, at)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let clear = distance >= wanted;
        found.at(leg, at).unless(clear, "clearance", distance, claim.clearance, "m");
    }
    findings
}

impl ClearDrive<'_> {
    /// When each leg begins, s, and its way; straight legs have no clock. `None` for one that cannot be replayed.
    fn legs<T: Terrain>(&self, vehicle: &GroundVehicle, terrain: &T) -> Vec<(f64, Option<Way>)> {
        match self {
            Self::Straight(waypoints) => {
                waypoints.windows(2).map(|leg| (0.0, Some(Way::straight([leg[0], leg[1]])))).collect()
            }
            Self::Legs(legs) => {
                let began = legs.iter().scan(0.0, |sum, leg| {
                    let began = *sum;
                    *sum += leg.duration;
                    Some(began)
                });
                began.zip(*legs).map(|(began, leg)| (began, replayed(vehicle, terrain, leg))).collect()
            }
        }
    }
}

/// The way of one leg from its own start.
fn replayed<T: Terrain>(vehicle: &GroundVehicle, terrain: &T, leg: &DriveLegClaim) -> Option<Way> {
    let claim = leg.ground();
    let mut way = Way::begun(claim.start, claim.crab_rate);
    follow_ground(&leg.pieces, vehicle, terrain, &claim, Some(&mut |here| way.pass(here))).ok()?;
    Some(way)
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::verification::DrivePiece;
    use crate::world::terrain::Flat;

    /// From (0, 0) half round (0, 2) to (0, 4), in one leg.
    fn half_circle() -> DriveLegClaim {
        let half = std::f64::consts::PI;
        let curvature = [0.5, 0.0, 0.0, 0.0, 0.0, 0.0];
        DriveLegClaim {
            from: [0.0, 0.0, 0.0, 0.5],
            to: [0.0, 4.0, half, 0.5],
            pieces: vec![DrivePiece::Arc { length_m: 2.0 * half, curvature, direction: 1.0 }],
            speed: vec![[0.0, 1.0]],
            duration: 2.0 * half,
            direction: [0.0; 2],
        }
    }

    fn told(drive: ClearDrive, center: [f64; 2], radius: f64) -> String {
        let discs = &[ClearDisc { center, radius }];
        let extent = ([-5.0, -5.0], [5.0, 8.0]);
        let found = verify_clear_ground(
            &GroundVehicle::LEVEL,
            &Flat,
            &ClearGroundClaim { drive, discs, clearance: 0.2, extent },
        );
        found.iter().map(|f| format!("{} {:.4} leg {}", f.field, f.value, f.leg)).collect::<Vec<_>>().join("; ")
    }

    #[test]
    fn a_millimetre_is_told_from_its_other_side_on_both_sides_of_a_bend() {
        let legs = [half_circle()];
        let drive = ClearDrive::Legs(&legs);
        // The bend's far point is (2, 2); a disc of 0.5 m stands outside and inside of it.
        for side in [1.0, -1.0] {
            assert_eq!(told(drive, [2.0 + side * 0.701, 2.0], 0.5), "");
            assert_eq!(told(drive, [2.0 + side * 0.699, 2.0], 0.5), "environment.keep_out[0].clearance 0.1990 leg 0");
        }
        // At the very ends of it, and of straight legs.
        assert_eq!(told(drive, [-0.701, 0.0], 0.5), "");
        assert_eq!(told(drive, [-0.699, 4.0], 0.5), "environment.keep_out[0].clearance 0.1990 leg 0");
        let straight = ClearDrive::Straight(&[[0.0, 0.0], [2.0, 0.0], [2.0, 3.0]]);
        assert_eq!(told(straight, [2.701, 1.0], 0.5), "");
        assert_eq!(told(straight, [2.699, 1.0], 0.5), "environment.keep_out[0].clearance 0.1990 leg 1");
    }

    #[test]
    fn discs_off_the_map_or_none_at_all_and_drives_that_are_none_are_found() {
        let legs = [half_circle()];
        let drive = ClearDrive::Legs(&legs);
        assert_eq!(told(drive, [4.6, 4.0], 0.5), "environment.keep_out[0].outside 0.1000 leg 0");
        assert_eq!(told(drive, [4.0, -4.7], 0.5), "environment.keep_out[0].outside 0.2000 leg 0");
        assert_eq!(told(drive, [4.0, 4.0], -1.0), "environment.keep_out[0].radius -1.0000 leg 0");
        assert!(told(drive, [f64::NAN, 4.0], 0.5).contains("radius"));
        let mut broken = [half_circle()];
        broken[0].from[0] = f64::NAN;
        assert!(told(ClearDrive::Legs(&broken), [4.0, 4.0], 0.5).contains("clearance -inf leg 0"));
    }
}
