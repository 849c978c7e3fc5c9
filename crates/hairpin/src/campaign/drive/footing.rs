//! What stands under a vehicle: the map, and the body settled on it.

use super::DriveSetup;
use crate::campaign::kind::Footing;
use crate::robot::rover::{Settled, Suspension};
use crate::world::terrain::Terrain;

/// A rest as near as this to the last one begins from it, m.
const NEAR_M: f64 = 0.2;
/// Newton's last step begins from gaps of this at most, m: what it leaves is rounding.
const COARSE_M: f64 = 1e-6;

impl Footing for DriveSetup {
    fn ground(&self, x: f64, y: f64) -> Option<f64> {
        Some(self.map.patch(x, y).ok()?.height)
    }

    fn resting(&self, way: &[[f64; 3]]) -> Vec<Option<f64>> {
        let suspension = &self.rover.suspension;
        let mut before: Option<([f64; 3], Settled)> = None;
        let mut rest = |at: &[f64; 3]| {
            // A point without wheels lies on the ground.
            if *suspension == Suspension::Level {
                return self.ground(at[0], at[1]);
            }
            let near = before.filter(|(last, _)| libm::hypot(at[0] - last[0], at[1] - last[1]) < NEAR_M);
            let found = match near {
                Some((_, guess)) => suspension
                    .settle(&*self.map, *at, &guess, COARSE_M)
                    .or_else(|_| suspension.settle_cold(&*self.map, *at)),
                None => suspension.settle_cold(&*self.map, *at),
            };
            before = found.ok().map(|(settled, _)| (*at, settled));
            Some(before?.1.z)
        };
        way.iter().map(&mut rest).collect()
    }
}
