//! The replay on the ground as it was before it had strides, against which they are held: a fixed number of steps, the
//! body looked at twice in each.
//!
//! Second order in the step, and dear: 2000 steps of two looks. It stays because nothing of the strides is in it.

use super::course::{Angles, Course};
use super::drive::DrivePiece;
use super::ground_claim::{GroundClaim, GroundVehicle};
use super::stand::{EXACTLY, NoRest, Rest, tilt};
use super::stride::turned;
use super::twist::{Place, carry};
use crate::world::terrain::Terrain;

/// Where `piece`, all of a drive, leads without latency by the midpoint rule in `steps`, and the largest tilt on the
/// way.
///
/// The end is (x, y, ψ) in m and rad, the tilt in rad.
///
/// ```text
/// y_(n+½) = y_n + ½ h f(y_n, s_n),   y_(n+1) = y_n + h f(y_(n+½), s_n + ½ h),   y = (x, y, ψ)
/// ```
///
/// Exact vehicles are carried as rigid bodies instead (`carry`), which has its own midpoint.
///
/// # Errors
/// [`NoRest`]: where the body finds none on the way.
pub(super) fn by_midpoints<T: Terrain>(
    piece: &DrivePiece,
    vehicle: &GroundVehicle,
    terrain: &T,
    claim: &GroundClaim,
    steps: usize,
) -> Result<([f64; 3], f64), NoRest> {
    let length = piece.length();
    let mut course = Course { piece, vehicle, claim, begun: 0.0, drive: length, angles: None };
    if vehicle.lags() {
        let angle = libm::atan(claim.start_curvature * vehicle.steered_axle_m);
        course.angles = Some(Angles::new(&course, angle, length, steps));
    }
    let stand = &vehicle.stand;
    let mut rest = Rest::find(stand, terrain, claim.start)?;
    let (mut pose, mut most, h) = (claim.start, 0.0_f64, length / steps as f64);
    let moved =
        |pose: [f64; 3], rates: [f64; 3], h: f64| -> [f64; 3] { std::array::from_fn(|i| pose[i] + h * rates[i]) };
    for step in 0..steps {
        let s = length * step as f64 / steps as f64;
        if vehicle.exact {
            let body = |place: &Place| course.body_rates(place, s + 0.5 * h);
            pose = carry(stand, terrain, &mut rest, [pose; 2], h, body)?;
        } else {
            rest.carry_on(stand, terrain, pose, &EXACTLY)?;
            most = most.max(tilt(&rest));
            let middle = moved(pose, turned(&course.rates(&rest, s), pose[2]), 0.5 * h);
            rest.carry_on(stand, terrain, middle, &EXACTLY)?;
            pose = moved(pose, turned(&course.rates(&rest, s + 0.5 * h), middle[2]), h);
        }
        most = most.max(tilt(&rest));
    }
    Ok((pose, most))
}

mod tests {
    use nalgebra::Vector3;

    use super::super::ground::replay_ground;
    use super::super::posed::Stand;
    use super::*;
    use crate::math::random::hashed_unit;
    use crate::world::terrain::generate::{Recipe, generate};

    const BOGIES: Stand = Stand::RockerBogie {
        pivot: Vector3::new(0.2415, 0.4, 0.21),
        rocker_wheel: Vector3::new(0.576, 0.0, -0.25),
        bogie_joint: Vector3::new(-0.2416, 0.0, -0.21),
        bogie_wheels: [Vector3::new(0.138, 0.0, -0.04), Vector3::new(-0.138, 0.0, -0.04)],
        radius: 0.13,
    };

    /// Claims to end where midpoints in `steps` lead; by how much strides differ, in place (m), heading (rad) and
    /// largest tilt (rad), their number, and what they say they may leave out.
    fn compared<T: Terrain>(
        vehicle: &GroundVehicle,
        terrain: &T,
        seed: u64,
        steps: usize,
    ) -> Option<([f64; 3], usize, f64)> {
        let unit = |i: u64| 2.0 * hashed_unit(seed, &[i]) - 1.0;
        let length_m = 2.5 + 1.5 * unit(0);
        let curvature =
            std::array::from_fn(|i| if i < 3 { 0.4 * unit(1 + i as u64) / length_m.powi(i as i32) } else { 0.0 });
        let piece = DrivePiece::Arc { length_m, curvature, direction: if seed % 4 == 3 { -1.0 } else { 1.0 } };
        let start = [10.0 + 4.0 * unit(5), 10.0 + 4.0 * unit(6), 3.0 * unit(7)];
        let speed = vec![[0.0, 0.3], [0.5 * length_m, 0.6], [length_m, 0.2]];
        let (crab, crab_rate) = (0.1 * unit(8), 0.05 * unit(9));
        let mut claim = GroundClaim {
            start,
            start_curvature: curvature[0],
            crab,
            crab_rate,
            speed,
            end: [0.0; 3],
            end_curvature: 0.0,
        };
        let (end, tilt) = by_midpoints(&piece, vehicle, terrain, &claim, steps).ok()?;
        claim.end = end;
        let found = replay_ground(&[piece], vehicle, terrain, &claim).ok()?;
        let [x, y, yaw] = found.error;
        Some(([x.hypot(y), yaw.abs(), (found.max_tilt - tilt).abs()], found.steps, found.left_out))
    }

    /// Vehicles that stand in their own ways, slip, lag and are carried as rigid bodies.
    fn vehicles() -> [(&'static str, GroundVehicle, usize); 4] {
        let plain = GroundVehicle { stand: BOGIES, ..GroundVehicle::LEVEL };
        let slips = GroundVehicle { slip_at_20_deg: 0.1, side_slip_at_20_deg: 0.05, ..plain };
        let lags = GroundVehicle { steering_time_constant_s: 0.3, steering_rate_rad_s: 0.6, ..slips };
        [
            ("plain", plain, 4),
            ("slips and lags", lags, 4),
            ("at a rate", GroundVehicle { steering_rate_rad_s: 0.3, ..plain }, 2),
            ("exact", GroundVehicle { exact: true, ..slips }, 2),
        ]
    }

    #[test]
    fn strides_end_where_two_thousand_midpoints_do() {
        let hills = Recipe { size_m: 20.0, cell_m: 0.1, relief_m: 0.5, hurst: 0.9, ..Recipe::default() };
        let hills = generate(&hills).unwrap();
        for (name, vehicle, drives) in vehicles() {
            let mut compared_drives = 0;
            for seed in 0..drives {
                let Some((off, strides, told)) = compared(&vehicle, &hills, seed as u64, 2000) else { continue };
                compared_drives += 1;
                assert!(off[0] < 1.5e-4 && off[1] < 1.5e-4 && off[2] < 2e-3, "{name} {seed}: {off:?} {told}");
                assert!((10..200).contains(&strides) && told <= 1e-4, "{name} {seed}: {strides} strides, {told}");
            }
            assert!(2 * compared_drives > drives, "{name}");
        }
    }
}
