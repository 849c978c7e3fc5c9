//! The vehicle on the ground: every wheel of every settled pose is looked at on the map, by geometry of its own.

use std::f64::consts::PI;

use hairpin::math::random::{stream, unit};
use hairpin::robot::rover::{Settled, Suspension};
use hairpin::world::terrain::Terrain;
use hairpin_jobs::Problem;
use nalgebra::{Matrix3, Vector3};

use super::check::{Check, Test};
use super::subject::Subject;

/// Poses that are looked at.
const POSES: usize = 500;
/// Distance kept from the map's edge, m.
const MARGIN: f64 = 2.0;
/// Largest gap under a wheel, m.
const GAP: f64 = 1e-6;

/// R10.
pub(super) fn stands(subject: &Subject) -> Result<Test, Problem> {
    let suspension = &subject.rocky8.suspension;
    let Suspension::RockerBogie(body) = suspension else {
        return Err(Problem::input("rocky8 has no rocker-bogie"));
    };
    let (low, high) = subject.ground.extent();
    let mut random = stream(35);
    let (mut settled, mut worst, mut steepest) = (0, 0.0_f64, 0.0_f64);
    let mut asked = 0;
    for _ in 0..20 * POSES {
        if asked == POSES {
            break;
        }
        let [x, y] = [0, 1].map(|i| low[i] + MARGIN + unit(&mut random) * (high[i] - low[i] - 2.0 * MARGIN));
        let yaw = 2.0 * PI * unit(&mut random);
        // Places over the map's holes are no places to stand.
        if subject.ground.patch(x, y).is_err() {
            continue;
        }
        asked += 1;
        let Ok((pose, _)) = suspension.settle_cold(&subject.ground, [x, y, yaw]) else { continue };
        settled += 1;
        let world_from_body = attitude(&pose, yaw);
        let cosine = world_from_body[(2, 2)];
        steepest = steepest.max(libm::acos(cosine.clamp(-1.0, 1.0)));
        for wheel in body.wheels(&pose.joints) {
            let center = Vector3::new(x, y, pose.z) + world_from_body * wheel;
            let Ok(ground) = subject.ground.patch(center.x, center.y) else { continue };
            let [hx, hy] = ground.slope;
            let touching = ground.height + body.wheel_radius * (1.0 + hx * hx + hy * hy).sqrt();
            worst = worst.max((center.z - touching).abs());
        }
    }
    let check = Check::new(
        format!(
            "{settled} of {asked} poses settled, up to {:.0}° of tilt; largest gap under any of their wheels {worst:.1e} m",
            steepest.to_degrees()
        ),
        format!("≥ 99 % settled, gaps ≤ {GAP:e} m"),
        asked > 0 && 100 * settled >= 99 * asked && worst <= GAP,
    );
    let what = "rough ground: attitude, height and joints of rocky8 from the elevation map";
    Ok(Test::new("R10", "R-11", what, check))
}

/// Rz(ψ) Ry(θ) Rx(φ), one turn after the other.
fn attitude(pose: &Settled, yaw: f64) -> Matrix3<f64> {
    let ((sf, cf), (st, ct), (sp, cp)) = (libm::sincos(pose.roll), libm::sincos(pose.pitch), libm::sincos(yaw));
    let roll = Matrix3::new(1.0, 0.0, 0.0, 0.0, cf, -sf, 0.0, sf, cf);
    let pitch = Matrix3::new(ct, 0.0, st, 0.0, 1.0, 0.0, -st, 0.0, ct);
    let heading = Matrix3::new(cp, -sp, 0.0, sp, cp, 0.0, 0.0, 0.0, 1.0);
    heading * pitch * roll
}
