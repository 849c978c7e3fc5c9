//! Follows a drive once more, closely: does it keep its limits, and what does it demand?

use nalgebra::Vector3;

use super::settings::{DriveSettings, DriveSite};
use super::tally::LegRefusal;
use super::wheels::WheelWatch;
use crate::feasibility::steering::shooting::rough::{Blocked, Cause, Driven, Steps, predict_while};
use crate::robot::rover::{Settled, Slip, Suspension, Unsettled};
use crate::trajectory::drive::{Motion, Planar, Segment};
use crate::trajectory::{Direction, SpeedProfile};
use crate::world::terrain::{ElevationMap, KeepOuts, NoGround, Terrain};

/// Limits are asked for at least this often, and the second time on drives that came within [`NEAR`] (rad) of one of
/// tilt or joints, for on rough ground the body leans by up to a degree more between two of the first looks, or within
/// a step of a keep-out.
const STEPS: Steps = Steps { length: 0.03, angle: 0.03, least: 8 };
/// Looks at a tenth of the distance.
pub(super) const CLOSER: Steps = Steps { length: 0.003, angle: 0.003, least: 8 };
/// rad: some three degrees.
const NEAR: f64 = 0.05;
/// Room left below the limits of tilt and joints for what lies between two looks, rad.
const ROOM: f64 = 2e-3;
/// A bound of curvature counts as kept up to this share: the solver's own rounding.
const KEPT: f64 = 1.0 + 1e-6;
/// The underside is looked at after so many metres or radians; it is itself looked at every 10 cm.
const BELLY_STEP: f64 = 0.09;
/// sin 20°.
const SIN_20: f64 = 0.342_020_143_325_668_7;
/// Samples of a segment's curvature.
const SAMPLES: u32 = 32;

/// What was met on the way.
///
/// Over the whole drive, lean and slip as predicted.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Met {
    /// Largest |climb angle| along the direction of travel, rad.
    pub(super) slope: f64,
    /// Largest |φ|, rad.
    pub(super) roll: f64,
    /// Mean share of slip.
    pub(super) slip: f64,
}

/// Follows `motion` from `start` at `speed`, travelling in `direction` of the body, and looks at every limit on the
/// way.
///
/// `Err` is the first limit that is broken on the way. Twice over where something came near: the second look's numbers
/// are only for the limits.
///
/// Cost: one prediction in steps of 3 cm or 0.03 rad, and where something came near a second one in a tenth of that. A
/// leg that passes keeps its limits at all looks, and between them as far as the room reaches.
pub(super) fn watch(
    site: &DriveSite,
    settings: &DriveSettings,
    start: &Planar,
    motion: &[Segment],
    speed: &SpeedProfile,
    direction: Direction,
) -> Result<Met, LegRefusal> {
    let length = motion.iter().map(Segment::length_m).sum();
    let look = |steps: Steps| {
        let course = settings.course(site, steps, *speed, direction);
        let mut watcher = Watcher {
            site,
            settings,
            level: matches!(site.rover.suspension, Suspension::Level),
            direction,
            length,
            slip: slip_in_force(&site.rover.slip),
            met: Met::default(),
            way: 0.0,
            unlooked: f64::INFINITY,
            turned: steps.angle,
            room: f64::INFINITY,
            last_look: steps == CLOSER,
            beside: false,
            wheels: WheelWatch::default(),
            refused: None,
        };
        predict_while(&course, start, motion, |driven| watcher.look(driven)).map_err(|blocked| refusal(&blocked))?;
        let Watcher { mut met, way, refused, room, beside, .. } = watcher;
        met.slip = if way > 0.0 { met.slip / way } else { 0.0 };
        refused.map_or(Ok((met, room < NEAR || beside)), Err)
    };
    let (met, near) = look(STEPS)?;
    if near {
        look(CLOSER)?;
    }
    Ok(met)
}

/// Whether the body stands within the limits at a place.
///
/// At rest from a cold start. Torque is not asked: nothing moves.
///
/// # Errors
/// The first limit that is broken: keep-out, ground, rest, tilt, joints, height of the underside.
pub fn stands(site: &DriveSite, settings: &DriveSettings, at: &Planar) -> Result<(), LegRefusal> {
    if !keeps_out(site.keep_outs, site.radius, [at.x, at.y], 0.0) {
        return Err(LegRefusal::KeepOut);
    }
    if matches!(site.rover.suspension, Suspension::Level) {
        return on_map(site.map, at);
    }
    let rest = site.rover.suspension.settle_cold(site.map, [at.x, at.y, at.yaw]);
    let (settled, _) = rest.map_err(|unsettled| refusal(&Blocked { after_m: 0.0, cause: unsettled.into() }))?;
    within(settings, libm::cos(settled.roll) * libm::cos(settled.pitch), &settled.joints)?;
    clear(site, settings, at, &settled)
}

/// Whether a look at (x, y) shows that `radius` is kept from `keep_outs`: on the way to the next look, `metres`
/// farther, the vehicle comes no nearer than by those.
pub(super) fn keeps_out(keep_outs: &KeepOuts, radius: f64, [x, y]: [f64; 2], metres: f64) -> bool {
    keep_outs.distance(x, y) >= radius + metres
}

/// Why the ground let nothing pass.
pub(super) fn refusal(blocked: &Blocked) -> LegRefusal {
    match blocked.cause {
        Cause::Unsettled(Unsettled::NoGround(place)) => no_ground(&place),
        Cause::Unsettled(_) => LegRefusal::NoRest,
        Cause::Overturned => LegRefusal::Tilt,
    }
}

/// ∫ |κ′| ds of a drive that begins at curvature `start`, jumps where it stops included, 1/m.
///
/// Sampled at 33 places of a segment: less than it is by what turns back between two of them. A turn in place begins
/// and ends with straight wheels.
pub(super) fn curvature_change(start: f64, segments: &[Segment]) -> f64 {
    let (mut at, mut sum) = (start, 0.0);
    let mut to = |curvature: f64| {
        sum += (curvature - at).abs();
        at = curvature;
    };
    for segment in segments {
        match segment.motion {
            Motion::Turn { .. } => to(0.0),
            Motion::Arc { length_m, .. } => {
                let step = length_m / f64::from(SAMPLES);
                (0..=SAMPLES).for_each(|i| to(segment.curvature_at(step * f64::from(i))));
            }
        }
    }
    sum
}

/// One pass over a drive.
struct Watcher<'a> {
    site: &'a DriveSite<'a>,
    settings: &'a DriveSettings,
    level: bool,
    /// Of travel in the body, over so many metres.
    direction: Direction,
    length: f64,
    slip: Slip,
    /// Its slip is summed over the way until the end.
    met: Met,
    /// Metres behind the last look's step.
    way: f64,
    /// Metres and radians since the underside was looked at.
    unlooked: f64,
    /// Radians of a step in place.
    turned: f64,
    /// Least room below the limits of tilt and joints so far, rad.
    room: f64,
    /// Whether nobody looks more closely.
    last_look: bool,
    /// Whether it came within a step of a keep-out.
    beside: bool,
    wheels: WheelWatch,
    refused: Option<LegRefusal>,
}

impl Watcher<'_> {
    /// Looks at a step; `false` where nothing more need be looked at.
    fn look(&mut self, driven: &Driven) -> bool {
        // A step of h metres is seen at its middle; turns in place have none.
        let metres = 2.0 * (driven.s - self.way);
        self.way += metres;
        let (at, settled) = (&driven.at, &driven.settled);
        let ((sin_roll, cos_roll), (sin_pitch, cos_pitch)) = (libm::sincos(settled.roll), libm::sincos(settled.pitch));
        self.refused = self.kept(at, metres, cos_roll * cos_pitch, settled).err();
        self.met.roll = self.met.roll.max(settled.roll.abs());
        if self.refused.is_none() && self.settings.limits.wheels {
            let direction = self.direction.at(driven.s, self.length);
            self.refused = self.wheels.keep(self.site.rover, self.settings, direction, driven).err();
        }
        if metres > 0.0 {
            if self.refused.is_none() && !self.pulls(driven) {
                self.refused = Some(LegRefusal::Torque);
            }
            let (rise_x, rise_y) = (-sin_pitch, cos_pitch * sin_roll);
            let (sin, cos) = libm::sincos(self.direction.at(driven.s, self.length));
            let climb = cos * rise_x + sin * rise_y;
            let side = cos * rise_y - sin * rise_x;
            let slip = libm::hypot(self.slip.at_20_deg * climb, self.slip.side_at_20_deg * side) / SIN_20;
            self.met.slope = self.met.slope.max(libm::asin(climb.abs().min(1.0)));
            self.met.slip += metres * slip;
        }
        self.refused.is_none()
    }

    /// Whether the wheels have the torque that a step takes, whichever way the speed changes.
    fn pulls(&self, driven: &Driven) -> bool {
        let rover = self.site.rover;
        let most = rover.most_traction();
        if most.is_infinite() {
            return true;
        }
        let direction = libm::sincos(self.direction.at(driven.s, self.length));
        let hardest = self.settings.pace.acceleration();
        // Room for slopes between two looks, as for the tilt.
        let room = rover.weight.map_or(0.0, |weight| weight.newtons() * ROOM);
        [-hardest, hardest].into_iter().all(|acceleration| {
            let (sign, none) = (driven.step.signum(), Vector3::zeros());
            let effort = rover.effort(&driven.settled, direction, sign, acceleration, &none);
            effort.is_none_or(|effort| effort.traction.abs() + room <= most)
        })
    }

    /// One look: curvature, keep-outs, map or rest of the wheels, and every [`BELLY_STEP`] metres the belly. `metres`
    /// is what was driven since the look before: a keep-out within that of the vehicle asks for shorter steps, and
    /// refuses in the last look.
    fn kept(&mut self, at: &Planar, metres: f64, upright: f64, settled: &Settled) -> Result<(), LegRefusal> {
        let (site, settings) = (self.site, self.settings);
        if at.curvature.abs() > settings.bounds.most * KEPT {
            return Err(LegRefusal::Curvature);
        }
        let keeps_out = |metres: f64| keeps_out(site.keep_outs, site.radius, [at.x, at.y], metres);
        if !keeps_out(metres) {
            if self.last_look || !keeps_out(0.0) {
                return Err(LegRefusal::KeepOut);
            }
            self.beside = true;
        }
        if self.level {
            return on_map(site.map, at);
        }
        self.room = self.room.min(within(settings, upright, &settled.joints)?);
        self.unlooked += if metres > 0.0 { metres } else { self.turned };
        if self.unlooked >= BELLY_STEP {
            self.unlooked = 0.0;
            clear(site, settings, at, settled)?;
        }
        Ok(())
    }
}

/// A rover that does not slip is taken to slip in full: slopes differ all the same.
fn slip_in_force(slip: &Slip) -> Slip {
    let none = slip.at_20_deg == 0.0 && slip.side_at_20_deg == 0.0;
    if none { Slip { at_20_deg: 1.0, side_at_20_deg: 1.0 } } else { *slip }
}

/// Holds cos(tilt) and joint angles against the limits: the room that is left, rad.
///
/// ```text
/// acos(cos φ cos θ) ≤ tilt − 0.002,   max |joint| ≤ joint − 0.002      rad
/// ```
fn within(settings: &DriveSettings, upright: f64, joints: &[f64; 3]) -> Result<f64, LegRefusal> {
    let limits = &settings.limits;
    let tilt = limits.tilt - ROOM - libm::acos(upright.clamp(-1.0, 1.0));
    if tilt < 0.0 {
        return Err(LegRefusal::Tilt);
    }
    let joint = limits.joint - ROOM - joints.iter().fold(0.0, |most, angle| angle.abs().max(most));
    if joint < 0.0 {
        return Err(LegRefusal::Joint);
    }
    Ok(tilt.min(joint))
}

/// Holds the underside's height over the ground against its limit.
fn clear(site: &DriveSite, settings: &DriveSettings, at: &Planar, settled: &Settled) -> Result<(), LegRefusal> {
    if settings.limits.clearance == f64::NEG_INFINITY {
        return Ok(());
    }
    let clearance = site.rover.belly_clearance(site.map, [at.x, at.y, at.yaw], settled);
    match clearance.map_err(|place| no_ground(&place))? {
        clearance if clearance < settings.limits.clearance => Err(LegRefusal::Belly),
        _ => Ok(()),
    }
}

/// What has no wheels must have ground all the same.
fn on_map(map: &ElevationMap, at: &Planar) -> Result<(), LegRefusal> {
    map.patch(at.x, at.y).map(|_| ()).map_err(|place| no_ground(&place))
}

/// Off the map, or a cell without data.
fn no_ground(place: &NoGround) -> LegRefusal {
    match place {
        NoGround::OffMap { .. } => LegRefusal::MapEdge,
        NoGround::Hole { .. } => LegRefusal::NoData,
    }
}
