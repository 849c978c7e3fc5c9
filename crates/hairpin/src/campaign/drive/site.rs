//! Boundary-value drives of rovers on elevation maps: solved, and replayed from what would be written.
//!
//! The room's bridge from numbers to the leg solver on one side and to the replay on the other. Nothing is shared
//! between the two: the replay gets segments as they are written ([`DrivePiece`]) and the vehicle as plain numbers
//! ([`GroundVehicle`]).

use crate::feasibility::steering::clear::{Around, ClearedOnGround, solve_on_ground};
use crate::feasibility::steering::shooting::rough::{self, Answer, Course, Driven, GroundCost, Settings, Steps};
use crate::feasibility::steering::shooting::{Curvatures, Precision, Query, flat};
use crate::robot::rover::{Kinematics, Limits, Rims, Rover, Steering, Suspension};
use crate::trajectory::drive::{Gear, MOST_SEGMENTS, Motion, Planar, Segment, SegmentList, shortened};
use crate::trajectory::{Direction, SpeedProfile, Timing};
use crate::verification::{
    DriveClaim, DrivePiece, DriveReplay, GroundClaim, GroundReplay, GroundVehicle, Haul, HeldWheels, Stand,
    SteeredWheels, Stopped, WheelRims, replay_drive, replay_ground,
};
use crate::world::terrain::{ElevationMap, Rationed};

/// A rover on a map, and how it travels.
///
/// Borrowed parts, cheap to make: one for each speed and direction that is asked about.
#[derive(Debug, Clone, Copy)]
pub struct Site<'a> {
    /// The vehicle.
    pub rover: &'a Rover,
    /// What it drives on.
    /// In its own frame, m, heights at cell centres, bicubic between.
    pub map: &'a ElevationMap,
    /// Speed along what is driven.
    pub speed: SpeedProfile,
    /// Direction of travel in the body.
    pub direction: Direction,
}

/// The flat answers that a search on the ground is made of are exact to this, m, rad, 1/m.
/// Finer than any precision that is asked for on the ground, so that Broyden's method sees no noise.
///
/// It stands for all three: m of position, rad of yaw, 1/m of curvature at the end.
const FLAT: f64 = 1e-5;

impl<'a> Site<'a> {
    /// `rover` on `map`, straight ahead at its default speed.
    ///
    /// Its default speed is in m/s, constant.
    pub fn straight(rover: &'a Rover, map: &'a ElevationMap) -> Self {
        Self { rover, map, speed: rover.default_speed.into(), direction: 0.0.into() }
    }
}

impl Site<'_> {
    /// The curvatures that the vehicle keeps at its highest speed here.
    ///
    /// With what the change of that speed takes of driven rims.
    pub fn bounds(&self) -> Curvatures {
        let top = self.speed.top();
        let acceleration = if self.speed.is_constant() { 0.0 } else { self.rover.planned_acceleration(top) };
        let Limits { curvature: most, curvature_rate: most_rate, .. } = self.rover.limits_at(top, acceleration);
        Curvatures { most, most_rate }
    }

    /// Commands that drive forward from `start` to `goal` within the vehicle's own bounds.
    ///
    /// `start` and `goal` in the map's frame; curvatures 1/m in the direction of travel.
    pub fn drive(&self, start: &Planar, goal: &Planar, settings: &Settings) -> Answer {
        let bounds = self.bounds();
        let precision = Precision { position: FLAT, yaw: FLAT, curvature: FLAT };
        let flat = flat::Settings { precision, ..flat::Settings::default() };
        let mut steer = |query: &Query| -> Option<SegmentList> {
            let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
            let answer = flat::forward(&query, &bounds, &flat);
            (answer.status == flat::Status::Ok).then_some(answer.segments)
        };
        self.solve(start, goal, &bounds, settings, &mut steer)
    }

    /// The question that the prediction of motion is asked: this vehicle on this map in steps of `steps`.
    fn course(&self, steps: Steps) -> Course<'_, ElevationMap> {
        Course { rover: self.rover, terrain: self.map, speed: self.speed, direction: self.direction, steps }
    }

    /// Commands that drive from `start` to `goal`, shaped within `bounds` by the flat solver `steer`.
    ///
    /// Sought is the flat goal g whose commands S(g) are predicted to end at `goal`, E(S(g)) = goal, by Broyden's
    /// method from g = goal, until that holds within the settings' precision or the iterations end: [`Answer::status`].
    ///
    /// Beginning and end are those of the wheels' commands; latency's waiting stretch is put before them.
    /// Deterministic. Cost: two or three predictions of the ground for most questions.
    pub fn solve(
        &self,
        start: &Planar,
        goal: &Planar,
        bounds: &Curvatures,
        settings: &Settings,
        steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
    ) -> Answer {
        rough::solve(&self.course(Steps::default().for_rate(bounds.most_rate)), start, goal, bounds, settings, steer)
    }

    /// What of `segments` the speeds are meant for: all but the stretch that is held while the last commands come to
    /// act.
    ///
    /// With L the metres that are held, v · latency at the end's speed where the vehicle goes on: the segments without
    /// their last L metres. A speed profile is of what is left.
    fn driven(&self, segments: &[Segment]) -> Vec<Segment> {
        let held = match rough::Waiting::before(segments) {
            rough::Waiting::GoesOn => self.rover.response.latency * self.speed.end(),
            rough::Waiting::Stands => 0.0,
        };
        shortened(segments, held)
    }

    /// What [`Self::solve`] finds until `over` says that the time is.
    ///
    /// `over` is asked between looks at the ground; what is found until then is the answer, with its error and
    /// status.
    pub fn solve_until(
        &self,
        start: &Planar,
        goal: &Planar,
        bounds: &Curvatures,
        settings: &Settings,
        steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
        over: &dyn Fn() -> bool,
    ) -> Answer {
        rough::solve_until(
            &self.course(Steps::default().for_rate(bounds.most_rate)),
            start,
            goal,
            bounds,
            settings,
            steer,
            over,
        )
    }

    /// What [`Self::solve`] finds with `looks` looks at the ground, at most, and how many of them are left: without any
    /// it stopped, and the answer is the best so far.
    ///
    /// A look is one question of height and slope: a budget that is the same on every machine.
    pub fn solve_within(
        &self,
        start: &Planar,
        goal: &Planar,
        bounds: &Curvatures,
        settings: &Settings,
        steer: &mut dyn FnMut(&Query) -> Option<SegmentList>,
        looks: u64,
    ) -> (Answer, u64) {
        let (rover, ground) = (self.rover, Rationed::new(self.map, looks));
        let steps = Steps::default().for_rate(bounds.most_rate);
        let course = Course { rover, terrain: &ground, speed: self.speed, direction: self.direction, steps };
        let over = || ground.left() == 0;
        let answer = rough::solve_until(&course, start, goal, bounds, settings, steer, &over);
        (answer, ground.left())
    }

    /// The places, with the metres driven to them, that `segments` lead to from `start` for as long as the body finds
    /// rest, looked at in `steps`: the middles of those.
    ///
    /// Empty where the vehicle finds no rest at the start.
    pub fn way(&self, start: &Planar, segments: &[Segment], steps: Steps) -> Vec<(f64, Planar)> {
        let mut way = Vec::new();
        let commands = self.after_waiting(start, &self.driven(segments));
        // Where the ground stops it is where the way ends.
        let _ = self.trace(start, &commands, steps, |driven| way.push((driven.s, driven.at)));
        way
    }

    /// `acting` with what is driven before: commands act late, and until then a vehicle under way goes on as it was at
    /// `start`.
    ///
    /// The stretch is an arc of v · latency metres at the curvature of `start`, v the speed at its beginning; there is
    /// none without latency, or where the segments begin with the vehicle standing.
    pub(in crate::campaign) fn after_waiting(&self, start: &Planar, acting: &[Segment]) -> Vec<Segment> {
        let wait_m = self.rover.response.latency * self.speed.start();
        let goes_on = wait_m > 0.0 && rough::Waiting::before(acting) == rough::Waiting::GoesOn;
        let held = Segment::clothoid(wait_m, start.curvature, start.curvature, Gear::Forward);
        goes_on.then_some(held).into_iter().chain(acting.iter().copied()).collect()
    }

    /// Commands that drive from `start` to `goal` and stay clear of places to keep out of.
    ///
    /// Around `around` by detours; as [`Self::solve`] where the direct way is clear.
    pub fn solve_clear(
        &self,
        start: &Planar,
        goal: &Planar,
        bounds: &Curvatures,
        settings: &Settings,
        around: &Around<'_>,
        over: &dyn Fn() -> bool,
    ) -> ClearedOnGround {
        solve_on_ground(
            &self.course(Steps::default().for_rate(bounds.most_rate)),
            start,
            goal,
            bounds,
            settings,
            around,
            over,
        )
    }

    /// What `segments` from `start` cost along their motion; `None` where they do not pass.
    ///
    /// In the unit of `cost`, integrated over the metres driven.
    ///
    /// One prediction of motion, in the usual steps.
    pub fn cost(&self, start: &Planar, segments: &[Segment], cost: GroundCost) -> Option<f64> {
        rough::cost_along(&self.course(Steps::default()), start, segments, cost)
    }

    /// Where `segments` lead from `start`, predicted in steps of `steps`.
    ///
    /// # Errors
    /// Where the ground ends or the body finds no rest.
    ///
    /// Steps are looked at in their middles; agreement between 6 cm and 2 mm steps is within a millimetre, by test.
    /// Cost: one or two looks at the ground a step.
    pub fn predict(
        &self,
        start: &Planar,
        segments: &[Segment],
        steps: Steps,
    ) -> Result<rough::Prediction, rough::Blocked> {
        rough::predict(&self.course(steps), start, segments, |_| {})
    }

    /// [`Self::predict`], every step's middle shown to `observe`.
    ///
    /// # Errors
    /// As [`Self::predict`].
    pub fn trace(
        &self,
        start: &Planar,
        segments: &[Segment],
        steps: Steps,
        observe: impl FnMut(&Driven),
    ) -> Result<rough::Prediction, rough::Blocked> {
        rough::predict(&self.course(steps), start, segments, observe)
    }

    /// `segments` as they would be written, replayed against `start` and `goal` by other equations and finer steps.
    ///
    /// # Errors
    /// Where the ground ends or the body finds no rest.
    ///
    /// Errors of the answer are at the end, in the map's frame: m, rad, 1/m; at least 2000 steps.
    pub fn replay(&self, start: &Planar, goal: &Planar, segments: &[Segment]) -> Result<GroundReplay, Stopped> {
        let pieces: Vec<DrivePiece> = segments.iter().map(drive_piece).collect();
        let driven = self.driven(segments);
        let claim = GroundClaim {
            start: [start.x, start.y, start.yaw],
            start_curvature: start.curvature,
            crab: self.direction.start,
            crab_rate: self.direction.rate(driven.iter().map(Segment::length_m).sum()),
            speed: Timing::new(&self.speed, &driven).knots(),
            end: [goal.x, goal.y, goal.yaw],
            end_curvature: goal.curvature,
        };
        replay_ground(&pieces, &ground_vehicle(self.rover), self.map, &claim)
    }
}

/// `rover` for the replay.
///
/// Plain numbers alone: nothing of the robot's own equations goes along, so that the proof cannot repeat their
/// mistakes. Lengths m in the body's frame, x ahead, y left, z up.
pub(super) fn ground_vehicle(rover: &Rover) -> GroundVehicle {
    let stand = match &rover.suspension {
        Suspension::Level => Stand::Level,
        Suspension::FourWheel(body) => Stand::FourWheel { wheels: body.wheels, radius: body.wheel_radius },
        Suspension::RockerBogie(body) => Stand::RockerBogie {
            pivot: body.pivot,
            rocker_wheel: body.rocker_wheel,
            bogie_joint: body.bogie_joint,
            bogie_wheels: body.bogie_wheels,
            radius: body.wheel_radius,
        },
    };
    GroundVehicle {
        stand,
        slip_at_20_deg: rover.slip.at_20_deg,
        side_slip_at_20_deg: rover.slip.side_at_20_deg,
        latency_s: rover.response.latency,
        steering_time_constant_s: rover.response.steering_time_constant,
        steering_rate_rad_s: rover.response.steering_rate,
        steered_axle_m: rover.response.steered_axle,
        exact: rover.kinematics == Kinematics::Exact,
        haul: haul(rover),
        wheels: held_wheels(rover),
    }
}

/// What the wheels of `rover` may do, as the replay has it; `None` where nothing binds.
fn held_wheels(rover: &Rover) -> Option<HeldWheels> {
    let wheels = &rover.wheels;
    wheels.are_held().then_some(HeldWheels {
        steered: match wheels.steering {
            Steering::Corner => SteeredWheels::Corners,
            Steering::Front => SteeredWheels::Front,
            Steering::AllWheel => SteeredWheels::All,
            Steering::Skid => SteeredWheels::Skid(wheels.effective_track),
        },
        steer_rad: wheels.steer,
        steer_rate_rad_s: wheels.steer_rate,
        speed_rad_s: wheels.speed,
        acceleration_rad_s2: wheels.acceleration,
    })
}

/// Driven rims for the judge of drives.
///
/// m, m/s and m/s².
pub fn wheel_rims(rims: &Rims) -> WheelRims {
    WheelRims { half_track_m: 0.5 * rims.track, speed_m_s: rims.speed, acceleration_m_s2: rims.acceleration }
}

/// What the wheels of `rover` carry, as the replay has it.
///
/// `None` for a vehicle without a weight. Wheels are those at joint angles of 0.
fn haul(rover: &Rover) -> Option<Haul> {
    let (_, wheels, radius_m) = rover.suspension.wheels(&[0.0; 3]);
    rover.weight.map(|weight| Haul {
        mass_kg: weight.mass,
        gravity_m_s2: weight.gravity,
        rolling_resistance: weight.rolling_resistance,
        wheels,
        radius_m,
    })
}

/// What a drive for a flat `query` is held to, of a vehicle that travels at `direction` to its body.
///
/// In the query's frame: from the origin, heading 0.
pub fn flat_claim(query: &Query, direction: f64) -> DriveClaim {
    let goal = &query.goal;
    DriveClaim {
        start_curvature: query.start_curvature,
        crab: direction,
        crab_rate: 0.0,
        end: [goal.x, goal.y, goal.yaw],
        end_curvature: goal.curvature,
    }
}

/// `segments` as they would be written, replayed against `claim` in the plane; nothing is taken from the heap.
///
/// At most [`MOST_SEGMENTS`] segments, as a list holds no more.
pub fn replay_pieces(segments: &SegmentList, claim: &DriveClaim) -> DriveReplay {
    let mut pieces = [DrivePiece::Turn { angle_rad: 0.0 }; MOST_SEGMENTS];
    pieces.iter_mut().zip(segments.iter()).for_each(|(piece, segment)| *piece = drive_piece(segment));
    replay_drive(&pieces[..segments.len()], claim)
}

/// `segments` as they would be written, replayed against a flat `query` of a vehicle that travels at `direction` to its
/// body.
///
/// Errors of the answer are at the end, in the query's frame: m, rad, 1/m.
pub fn replay_flat(query: &Query, direction: f64, segments: &[Segment]) -> DriveReplay {
    let pieces: Vec<DrivePiece> = segments.iter().map(drive_piece).collect();
    replay_drive(&pieces, &flat_claim(query, direction))
}

/// `segment` as it is written.
///
/// The gear is the arc's direction, 1 or −1; lengths in m, curvatures in 1/m, angles in rad.
pub fn drive_piece(segment: &Segment) -> DrivePiece {
    match segment.motion {
        Motion::Arc { length_m, curvature } => DrivePiece::Arc { length_m, curvature, direction: segment.gear.sign() },
        Motion::Turn { angle_rad } => DrivePiece::Turn { angle_rad },
    }
}
