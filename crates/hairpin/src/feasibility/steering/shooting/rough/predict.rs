//! Motion prediction: where commands take a rover on the ground.
//!
//! dx/ds = f(x, y, ψ; κ(s)) with roll and pitch from the suspension at (x, y, ψ). One settled pose a step: the rates
//! are taken at the step's middle, whose pose is extrapolated from the step before; second order, as the midpoint rule.
//! Exact kinematics need the gradient of the pose as well, which jumps at the borders of the map's cells: what it
//! foresaw wrongly is made good at the next look.

use super::course::Course;
use super::outcome::{Blocked, Cause, Driven, Prediction};
use super::steering_lag::SteeringLag;
use crate::robot::rover::{Gradient, Rates, Rover, Settled, Unsettled};
use crate::trajectory::Timing;
use crate::trajectory::drive::{Motion, Planar, Segment};
use crate::world::terrain::Terrain;

/// Pitch from which yaw rates lose their meaning, rad.
const ON_END: f64 = 1.396;

/// Difference of roll or pitch from what was foreseen from which the body falls, rad, and parts in which such a step is
/// looked along.
const FALL: f64 = 0.2;
const PARTS: u32 = 30;

/// Gaps from which Newton's last step is taken, m: what it leaves moves no end point by a tenth of a millimetre.
const COARSE: f64 = 2e-3;

/// Follows `segments` from `start`; `observe` sees every step's middle. Where the speeds come to rest, to change gear
/// or to turn in place, the wheels swing to what comes before the vehicle goes on; at a constant speed they follow with
/// their lag.
///
/// Steps of 6 cm agree with steps of 2 mm within a millimetre (test). One settled pose a step, on the stack.
///
/// `start` in the world: x, y in m, yaw in rad, κ of the wheels as they stand. Memory is constant whatever the drive's
/// length; work is one settled pose a step, by default for each 6 cm (2 cm with exact kinematics) and at least 8 a
/// segment. Deterministic.
///
/// ```
/// use hairpin::feasibility::steering::shooting::rough::{Course, Steps, predict};
/// use hairpin::robot::rover::RoverDescription;
/// use hairpin::trajectory::drive::{Gear, Planar, Segment};
/// use hairpin::trajectory::{Direction, SpeedProfile};
/// use hairpin::world::terrain::Flat;
///
/// let file = serde_json::json!({ "kind": "rover", "name": "point", "limits": { "curvature_1_m": 1.0 } });
/// let rover = serde_json::from_value::<RoverDescription>(file)?.build()?;
/// let course = Course {
///     rover: &rover,
///     terrain: &Flat,
///     speed: SpeedProfile::from(1.0),
///     direction: Direction::default(),
///     steps: Steps::default(),
/// };
/// let commands = [Segment::straight(3.0, Gear::Forward), Segment::straight(1.0, Gear::Reverse)];
/// let end = predict(&course, &Planar::default(), &commands, |_| {})?.end;
/// assert!((end.x - 2.0).abs() < 1e-9 && end.y.abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
///
/// # Errors
/// [`Blocked`]: the ground ends, or the suspension finds no rest.
pub fn predict<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    segments: &[Segment],
    mut observe: impl FnMut(&Driven),
) -> Result<Prediction, Blocked> {
    let all = |driven: &Driven| {
        observe(driven);
        true
    };
    predict_while(course, start, segments, all).map(|(prediction, _)| prediction)
}

/// [`predict`] for as long as `go_on` says, and whether that was to the end: what it did not see is not in the
/// prediction.
///
/// # Errors
/// As [`predict`].
pub fn predict_while<T: Terrain>(
    course: &Course<'_, T>,
    start: &Planar,
    segments: &[Segment],
    mut go_on: impl FnMut(&Driven) -> bool,
) -> Result<(Prediction, bool), Blocked> {
    let rover = course.rover;
    let (settled, gradient) = rover
        .suspension
        .settle_cold(course.terrain, [start.x, start.y, start.yaw])
        .map_err(|cause| Blocked { after_m: 0.0, cause: cause.into() })?;
    let mut walk = Walk {
        at: *start,
        travelled: 0.0,
        turned: 0.0,
        settled,
        gradient,
        looked_at: *start,
        foreseen: [settled.z, settled.pitch],
        lag: SteeringLag::new(&rover.response, start.curvature),
        before: None,
        timing: Timing::new(&course.speed, segments),
        prediction: Prediction {
            end: *start,
            tilt: (tilt(&settled), 0.0),
            joint: (joint(&settled), 0.0),
            surprise: 0.0,
            steps: 1,
        },
    };
    let mut whole = true;
    for segment in segments {
        whole = whole && walk.drive(course, segment, &mut go_on)?;
    }
    walk.prediction.end = walk.at;
    Ok((walk.prediction, whole))
}

/// A prediction under way.
struct Walk {
    /// End of the last step.
    at: Planar,
    /// Metres of commanded travel, both gears counted up.
    travelled: f64,
    /// rad in place, whichever way.
    turned: f64,
    /// How the body stood at the last look, and how that changes with its place.
    settled: Settled,
    gradient: Gradient,
    /// Where the last look was.
    looked_at: Planar,
    /// Height and pitch at the end of the last step, as its gradient foresaw them.
    foreseen: [f64; 2],
    lag: SteeringLag,
    /// The segment before.
    before: Option<Segment>,
    timing: Timing,
    prediction: Prediction,
}

impl Walk {
    /// One segment by the midpoint rule, in equal steps no longer than the course's: rates at the last rest lead half a
    /// step ahead, the vehicle is settled there, and the rates at that rest lead over the whole step. `go_on` sees each
    /// middle and may end the drive (`Ok(false)`); `Blocked` is where no rest was found. Turns in place end with
    /// straight wheels, changes of gear with wheels that have swung to what comes, where speeds are not constant.
    fn drive<T: Terrain>(
        &mut self,
        course: &Course<'_, T>,
        segment: &Segment,
        go_on: &mut impl FnMut(&Driven) -> bool,
    ) -> Result<bool, Blocked> {
        let sign = segment.gear.sign();
        match segment.motion {
            Motion::Turn { angle_rad } => {
                let count = steps(angle_rad.abs() / course.steps.angle, course.steps.least);
                let h = angle_rad / f64::from(count);
                for _ in 0..count {
                    let here = course.rover.turning((&self.settled, &self.gradient), self.at.yaw);
                    let middle = moved(&self.at, &here, 0.5 * h, self.at.yaw + 0.25 * h * here.yaw);
                    self.look(course, &middle)?;
                    self.turned += h.abs();
                    let driven = Driven {
                        s: self.travelled,
                        turned: self.turned - 0.5 * h.abs(),
                        step: h,
                        in_place: true,
                        at: middle,
                        settled: self.settled,
                        gradient: self.gradient,
                    };
                    if !go_on(&driven) {
                        return Ok(false);
                    }
                    let there = course.rover.turning((&self.settled, &self.gradient), middle.yaw);
                    self.advance(course.rover, &there, h, middle.yaw);
                }
                // The wheels stand straight again afterwards.
                self.at.curvature = 0.0;
                self.lag = SteeringLag::new(&course.rover.response, 0.0);
            }
            Motion::Arc { length_m, .. } => {
                let goes_on =
                    |before: &Segment| matches!(before.motion, Motion::Arc { .. }) && before.gear == segment.gear;
                if !self.timing.is_constant() && self.before.as_ref().is_some_and(|before| !goes_on(before)) {
                    // Where the vehicle stands its wheels swing to what comes.
                    self.lag = SteeringLag::new(&course.rover.response, segment.curvature_at(0.0));
                }
                let count = steps(length_m / course.step(), course.steps.least);
                let h = length_m / f64::from(count);
                let constant = libm::sincos(course.direction.start);
                for step in 0..count {
                    let direction = if course.direction.swing() == 0.0 {
                        constant
                    } else {
                        libm::sincos(course.direction.at(self.travelled + 0.5 * h, self.timing.length()))
                    };
                    let s = f64::from(step) * h;
                    // The curvature at the step's middle, half a step after the last one's end.
                    let begun = self.travelled;
                    let curvature = self.steered(segment, s, begun, 0.5 * h);
                    let stands = (&self.carried(&self.at), &self.gradient);
                    let here = course.rover.rates(stands, self.at.yaw, direction, sign, curvature);
                    let mut middle = moved(&self.at, &here, 0.5 * h, self.at.yaw + 0.25 * h * here.yaw);
                    middle.curvature = curvature;
                    self.look(course, &middle)?;
                    self.travelled += h;
                    let driven = Driven {
                        s: self.travelled - 0.5 * h,
                        turned: self.turned,
                        step: sign * h,
                        in_place: false,
                        at: middle,
                        settled: self.settled,
                        gradient: self.gradient,
                    };
                    if !go_on(&driven) {
                        return Ok(false);
                    }
                    let stands = (&self.settled, &self.gradient);
                    let there = course.rover.rates(stands, middle.yaw, direction, sign, curvature);
                    self.advance(course.rover, &there, h, middle.yaw);
                    self.at.curvature = self.steered(segment, s + 0.5 * h, begun + 0.5 * h, 0.5 * h);
                }
            }
        }
        self.before = Some(*segment);
        Ok(true)
    }

    /// Drives a step of `h` at the rates of its middle, the last look. What the body rose and pitched beyond what
    /// gradients foresaw since the step before is made good with exact kinematics.
    ///
    /// With exact kinematics the settled height and pitch of the middle are compared with what the step before foresaw
    /// for there, and the difference moves the body as if it had risen and pitched on the spot.
    fn advance(&mut self, rover: &Rover, rates: &Rates, h: f64, yaw: f64) {
        let next = moved(&self.at, rates, h, self.at.yaw + 0.5 * h * rates.yaw);
        let over = self.gradient.over([next.x - self.at.x, next.y - self.at.y, next.yaw - self.at.yaw]);
        let (now, half) = ([self.settled.z, self.settled.pitch], [0.5 * over[0], 0.5 * over[2]]);
        let beyond = [now[0] - half[0] - self.foreseen[0], now[1] - half[1] - self.foreseen[1]];
        self.foreseen = [now[0] + half[0], now[1] + half[1]];
        let made_good = rover.moved_beyond((&self.settled, &self.gradient), yaw, beyond);
        self.at = made_good.map_or(next, |moves| moved(&next, &moves, 1.0, yaw));
    }

    /// The steering's curvature after the `h` metres of `segment` from its `s` on, `begun` metres after the drive's
    /// beginning.
    ///
    /// κ in 1/m at the end of the `h` metres. `begun` counts from the drive's beginning and tells the speed profile's
    /// time.
    fn steered(&mut self, segment: &Segment, s: f64, begun: f64, h: f64) -> f64 {
        let time = self.timing.time_over(begun, h);
        // From rest a step takes long; at one speed all take the same.
        let parts = if self.timing.is_constant() { 1 } else { self.lag.substeps(time) };
        if parts == 1 {
            return self.lag.follow(|share| segment.curvature_at(s + h * share), time);
        }
        let (step, mut curvature) = (h / f64::from(parts), 0.0);
        for part in 0..parts {
            let done = step * f64::from(part);
            let time = self.timing.time_over(begun + done, step);
            curvature = self.lag.follow(|share| segment.curvature_at(s + done + step * share), time);
        }
        curvature
    }

    /// How the body would stand at `place`, to first order from the last look.
    fn carried(&self, place: &Planar) -> Settled {
        let from = &self.looked_at;
        self.settled.moved(&self.gradient.over([place.x - from.x, place.y - from.y, place.yaw - from.yaw]))
    }

    /// Settles the body at `middle`, starting from the last look carried on.
    ///
    /// Counts one look, and updates the largest tilt, joint angle and surprise. A surprise above 0.2 rad is looked
    /// along again in 30 parts before it is believed; a pitch of 80° or more ends the prediction.
    fn look<T: Terrain>(&mut self, course: &Course<'_, T>, middle: &Planar) -> Result<(), Blocked> {
        let place = [middle.x, middle.y, middle.yaw];
        let blocked = |cause: Cause| Blocked { after_m: self.travelled, cause };
        let suspension = &course.rover.suspension;
        let foreseen = self.carried(middle);
        let surprise = |found: &Settled| (found.roll - foreseen.roll).abs().max((found.pitch - foreseen.pitch).abs());
        let (mut settled, mut gradient) =
            suspension.carry_on(course.terrain, place, &foreseen, COARSE).map_err(|cause| blocked(cause.into()))?;
        if surprise(&settled) > FALL {
            (settled, gradient) = self.fall(course, middle).map_err(|cause| blocked(cause.into()))?;
        }
        if settled.pitch.abs() >= ON_END {
            return Err(blocked(Cause::Overturned));
        }
        (self.settled, self.gradient, self.looked_at) = (settled, gradient, *middle);
        let prediction = &mut self.prediction;
        prediction.steps += 1;
        prediction.surprise = prediction.surprise.max(surprise(&settled));
        let worse = |worst: &mut (f64, f64), value: f64, at: f64| {
            if value > worst.0 {
                *worst = (value, at);
            }
        };
        worse(&mut prediction.tilt, tilt(&settled), self.travelled);
        worse(&mut prediction.joint, joint(&settled), self.travelled);
        Ok(())
    }
}

impl Walk {
    /// The rest at `there`, come to in small parts of the way from the last look: a step may lead over a gap in which
    /// there is none.
    ///
    /// Costs up to 30 settlings. Linear in place and yaw between the two looks.
    fn fall<T: Terrain>(&self, course: &Course<'_, T>, there: &Planar) -> Result<(Settled, Gradient), Unsettled> {
        let from = &self.looked_at;
        let part = [there.x - from.x, there.y - from.y, there.yaw - from.yaw].map(|way| way / f64::from(PARTS));
        let (mut settled, mut gradient) = (self.settled, self.gradient);
        for done in 1..=PARTS {
            let share = f64::from(done);
            let place = [from.x + share * part[0], from.y + share * part[1], from.yaw + share * part[2]];
            let guess = settled.moved(&gradient.over(part));
            (settled, gradient) = course.rover.suspension.carry_on(course.terrain, place, &guess, COARSE)?;
        }
        Ok((settled, gradient))
    }
}

/// `from` driven on by `h` metres at constant rates; `heading` is the yaw at their middle.
///
/// The chord of a turned step is shorter than its arc by sin(Δ/2)/(Δ/2), Δ the turn.
///
/// Second order in the turn: sin(Δ/2)/(Δ/2) ≈ 1 − Δ²/24.
fn moved(from: &Planar, rates: &Rates, h: f64, heading: f64) -> Planar {
    let (sin, cos) = libm::sincos(heading);
    let turn = h * rates.yaw;
    let chord = h * (1.0 - turn * turn / 24.0);
    Planar {
        x: from.x + chord * (cos * rates.ahead - sin * rates.left),
        y: from.y + chord * (sin * rates.ahead + cos * rates.left),
        yaw: from.yaw + turn,
        curvature: from.curvature,
    }
}

/// Angle of the body's z axis from the vertical, rad.
///
/// cos α = cos φ cos θ; in 0 … π.
pub fn tilt(settled: &Settled) -> f64 {
    libm::acos((libm::cos(settled.roll) * libm::cos(settled.pitch)).clamp(-1.0, 1.0))
}

/// rad; 0 without joints.
fn joint(settled: &Settled) -> f64 {
    settled.joints.iter().fold(0.0, |most, angle| most.max(angle.abs()))
}

/// Steps of a segment of `wanted` step lengths.
fn steps(wanted: f64, least: u32) -> u32 {
    (wanted.ceil() as u32).max(least)
}
