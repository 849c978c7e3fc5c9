//! Replay of a drive on the ground: what was written, integrated again with suspension, slip and lag.

use super::course::{Angles, Course};
use super::crest::Followed;
use super::drive::DrivePiece;
use super::ground_claim::{GroundClaim, GroundVehicle};
use super::stand::{NoRest, Rest};
use super::stride::Stretch;
use super::wheels::WheelExtremes;
use crate::world::terrain::{NoGround, Terrain};

/// What the drive does on the ground.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GroundReplay {
    /// Where it ends less where it should, in the world: x, y (m), yaw (rad, in (−π, π]).
    pub error: [f64; 3],
    /// Curvature of the steering at the end less what it should be, 1/m.
    pub error_curvature: f64,
    /// Largest angle of the body's z axis from the vertical, rad.
    ///
    /// acos(cos φ cos θ).
    pub max_tilt: f64,
    /// Largest |angle| of rocker and bogies where the body was looked at, rad; 0 without joints.
    pub max_joint: f64,
    /// Largest |torque| of each wheel while driving, N·m; 0 without a haul.
    pub max_torque: f64,
    /// What the wheels come to; zeros where nothing binds them.
    pub wheels: WheelExtremes,
    /// Strides of the integrator, each a panel of three looks at the ground and more.
    pub steps: usize,
    /// What the strides' errors add up to, m, by what halving each changes.
    pub left_out: f64,
}

/// Why a drive cannot be replayed to its end, and after how many metres.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stopped {
    /// Metres driven before.
    pub after_m: f64,
    /// The place without ground; `None` where the body finds no rest.
    pub no_ground: Option<NoGround>,
}

/// Steps in which the steering of a whole drive is followed.
const STEERED: f64 = 2000.0;

/// Integrates ẋ, ẏ and ψ̇ stride by stride, the body at rest on its wheels wherever it is looked at; an exact vehicle
/// is carried from rest to rest by the twist between them. With latency τ the vehicle first goes on for τ as it was,
/// and the last τ of the commands never act; before a drive that begins in reverse or in place it stands, and all of
/// them act. Where the speed is none and the direction changes, or after a turn in place, the wheels swing to what
/// comes.
///
/// Each stride is taken whole and as two halves by a method of second order, and the two are extrapolated. What they
/// differ by bounds the stride: it is halved until its share of 10⁻⁴ m and rad m of the whole drive holds. The
/// steering, which does not ask where the vehicle is, is followed before.
///
/// ẋ, ẏ, ψ̇ are Howard and Kelly's (IJRR 26(2), 2007) of the commanded twist after slip; with `exact` they are not
/// rates at all, but the rest whose screw from the last one has that twist.
///
/// Without `exact`, with body rates (vx, vy, ωz) per metre commanded, roll φ and pitch θ of the rest there:
///
/// ```text
/// ẋ = cos ψ (cos θ vx + sin θ sin φ vy) − sin ψ cos φ vy
/// ẏ = sin ψ (cos θ vx + sin θ sin φ vy) + cos ψ cos φ vy
/// ψ̇ = cos φ / cos θ · ωz,          δ̇ = clamp((atan(κ L) − δ)/T, ±δ̇_max)
/// ```
///
/// # Errors
/// [`Stopped`] where the ground ends or the body finds no rest.
pub fn replay_ground<T: Terrain>(
    pieces: &[DrivePiece],
    vehicle: &GroundVehicle,
    terrain: &T,
    claim: &GroundClaim,
) -> Result<GroundReplay, Stopped> {
    follow_ground(pieces, vehicle, terrain, claim, None)
}

/// [`replay_ground`]; `pass`, where there is one, is shown x, y (m) and ψ (rad) along the way, two thousand places or
/// more.
///
/// # Errors
/// As [`replay_ground`].
pub(super) fn follow_ground<T: Terrain>(
    pieces: &[DrivePiece],
    vehicle: &GroundVehicle,
    terrain: &T,
    claim: &GroundClaim,
    mut pass: Option<&mut dyn FnMut([f64; 3])>,
) -> Result<GroundReplay, Stopped> {
    let commands = Commands::new(pieces, vehicle, claim);
    let stopped = |after_m: f64, no_rest: NoRest| Stopped {
        after_m,
        no_ground: match no_rest {
            NoRest::Ground(place) => Some(place),
            NoRest::NotFound => None,
        },
    };
    let rest = Rest::find(&vehicle.stand, terrain, claim.start).map_err(|no| stopped(0.0, no))?;
    let mut at = (claim.start, rest);
    let mut angle = libm::atan(claim.start_curvature * vehicle.steered_axle_m);
    let (mut driven, mut last_curvature) = (0.0, claim.start_curvature);
    let mut followed = Followed::default();
    // The direction of the piece before; a turn in place leaves none.
    let mut last: Option<Option<f64>> = None;
    for piece in &commands.pieces {
        let own = match piece {
            DrivePiece::Arc { direction, .. } => Some(*direction),
            DrivePiece::Turn { .. } => None,
        };
        if let DrivePiece::Arc { curvature, .. } = piece
            && last.is_some_and(|last| last != own)
            && claim.stands_at(driven - commands.wait)
        {
            angle = libm::atan(curvature[0] * vehicle.steered_axle_m);
        }
        last = Some(own);
        let length = match piece {
            // What would act after the end is not driven.
            DrivePiece::Arc { length_m, .. } => length_m.min((commands.total - driven).max(0.0)),
            DrivePiece::Turn { angle_rad } => *angle_rad,
        };
        let mut course =
            Course { piece, vehicle, claim, begun: driven - commands.wait, drive: commands.drive, angles: None };
        if vehicle.lags() {
            let steps = (STEERED * length.abs() / commands.total.max(f64::MIN_POSITIVE)).ceil().max(16.0) as usize;
            let angles = Angles::new(&course, angle, length, steps);
            angle = angles.last();
            course.angles = Some(angles);
        }
        let metres = if own.is_some() { 1.0 } else { 0.0 };
        let stretch =
            Stretch { course: &course, terrain, length, left: commands.total - driven, extent: commands.extent };
        let whole = stretch.follow(&mut at, &mut followed, &mut pass);
        whole.map_err(|(s, no)| stopped(driven + metres * s, no))?;
        if let DrivePiece::Arc { curvature, .. } = piece {
            driven += length;
            last_curvature = curvature.iter().rev().fold(0.0, |sum, a| sum * length + a);
        } else {
            last_curvature = 0.0;
        }
    }
    if vehicle.lags() {
        last_curvature = libm::tan(angle) / vehicle.steered_axle_m;
    }
    let [x, y, yaw] = [0, 1, 2].map(|i| at.0[i] - claim.end[i]);
    let Followed { max_tilt, max_joint, max_torque, wheels, strides, left_out } = followed;
    Ok(GroundReplay {
        error: [x, y, libm::atan2(libm::sin(yaw), libm::cos(yaw))],
        error_curvature: last_curvature - claim.end_curvature,
        max_tilt,
        max_joint,
        max_torque,
        wheels,
        steps: strides,
        left_out,
    })
}

/// What acts, latency and all.
struct Commands {
    pieces: Vec<DrivePiece>,
    /// Metres before the first command acts.
    wait: f64,
    /// The drive without what is only held while its last commands come to act, m.
    drive: f64,
    /// What is driven, m: the wait and that.
    total: f64,
    /// The same with what is turned in place, rad.
    extent: f64,
}

impl Commands {
    fn new(pieces: &[DrivePiece], vehicle: &GroundVehicle, claim: &GroundClaim) -> Self {
        let under_way = matches!(pieces.first(), Some(DrivePiece::Arc { direction, .. }) if *direction > 0.0);
        let [wait, held] = if under_way { claim.metres_of(vehicle.latency_s) } else { [0.0; 2] };
        let mut commands = Vec::with_capacity(pieces.len() + 1);
        if wait > 0.0 {
            let mut curvature = [0.0; 6];
            curvature[0] = claim.start_curvature;
            commands.push(DrivePiece::Arc { length_m: wait, curvature, direction: 1.0 });
        }
        commands.extend_from_slice(pieces);
        let written: f64 = pieces.iter().map(DrivePiece::length).sum();
        let drive = (written - held).max(0.0);
        let total = wait + drive;
        let turned =
            |piece: &DrivePiece| if let DrivePiece::Turn { angle_rad } = piece { angle_rad.abs() } else { 0.0 };
        let extent = total + pieces.iter().map(turned).sum::<f64>();
        Self { pieces: commands, wait, drive, total, extent }
    }
}
