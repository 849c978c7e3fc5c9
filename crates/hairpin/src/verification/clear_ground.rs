//! Whether a planned drive keeps its distance from discs on the ground, between the steps of its replay too, and
//! whether these lie on the map.

use super::drives::DriveLegClaim;
use super::finding::{Collector, Finding};
use super::ground::follow_ground;
use super::ground_claim::GroundVehicle;
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
/// A step of the replay that turns the body by Δψ, and its direction of travel by Δδ, leaves its chord c by no more
/// than c (|Δψ| + |Δδ|)/4, as a curve does whose direction changes by so much. A leg that cannot be replayed is as near
/// as can be.
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
        let nearest = legs.iter().enumerate().map(|(leg, (began, steps))| (steps.distance(disc), leg, *began));
        let Some((distance, leg, at)) = nearest.min_by(|a, b| a.0.total_cmp(&b.0)) else { continue };
        let clear = distance >= claim.clearance - ROUNDING;
        found.at(leg, at).unless(clear, "clearance", distance, claim.clearance, "m");
    }
    findings
}

/// A leg as chords with what its way leaves each by, m; `None` where it cannot be replayed.
struct Steps(Option<Vec<([[f64; 2]; 2], f64)>>);

impl ClearDrive<'_> {
    /// When each leg begins, s, and its steps; straight legs have no clock.
    ///
    /// Straight legs are one chord each that nothing leaves.
    fn legs<T: Terrain>(&self, vehicle: &GroundVehicle, terrain: &T) -> Vec<(f64, Steps)> {
        match self {
            Self::Straight(waypoints) => {
                waypoints.windows(2).map(|leg| (0.0, Steps(Some(vec![([leg[0], leg[1]], 0.0)])))).collect()
            }
            Self::Legs(legs) => {
                let began = legs.iter().scan(0.0, |sum, leg| {
                    let began = *sum;
                    *sum += leg.duration;
                    Some(began)
                });
                began.zip(*legs).map(|(began, leg)| (began, Steps::of(vehicle, terrain, leg))).collect()
            }
        }
    }
}

impl Steps {
    /// Replays one leg from its own start; the first entry is the start itself.
    fn of<T: Terrain>(vehicle: &GroundVehicle, terrain: &T, leg: &DriveLegClaim) -> Self {
        let claim = leg.ground();
        let mut last = claim.start;
        let mut steps = vec![([[last[0], last[1]]; 2], 0.0)];
        let mut pass = |here: [f64; 3]| {
            let chord = libm::hypot(here[0] - last[0], here[1] - last[1]);
            let turned = (here[2] - last[2]).abs() + claim.crab_rate.abs() * chord;
            steps.push(([[last[0], last[1]], [here[0], here[1]]], 0.25 * chord * turned));
            last = here;
        };
        let followed = follow_ground(&leg.pieces, vehicle, terrain, &claim, Some(&mut pass)).is_ok();
        Self(followed.then_some(steps))
    }

    /// Distance of the disc from the nearest of them, m; −∞ where there are none.
    fn distance(&self, disc: &ClearDisc) -> f64 {
        let Some(steps) = &self.0 else { return f64::NEG_INFINITY };
        let distances = steps.iter().map(|(chord, leaves)| from_segment(&disc.center, chord) - disc.radius - leaves);
        // A place that is no number is as near as can be.
        distances.fold(f64::INFINITY, |least, d| if d.is_nan() { f64::NEG_INFINITY } else { least.min(d) })
    }
}

/// Distance of `p` from the segment from `a` to `b`, m.
fn from_segment(p: &[f64; 2], [a, b]: &[[f64; 2]; 2]) -> f64 {
    let (along, to) = ([b[0] - a[0], b[1] - a[1]], [p[0] - a[0], p[1] - a[1]]);
    let squared = along[0] * along[0] + along[1] * along[1];
    let share = if squared > 0.0 { (along[0] * to[0] + along[1] * to[1]) / squared } else { 0.0 };
    let share = share.clamp(0.0, 1.0);
    libm::hypot(to[0] - share * along[0], to[1] - share * along[1])
}

#[cfg(test)]
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
