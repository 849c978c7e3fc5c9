//! The proof of a drive over several waypoints: every leg replayed from its own start.

use super::drive::{DriveClaim, DrivePiece, replay_drive};
use super::finding::{Collector, Finding, Proof, Worst, note};
use super::ground::follow_ground;
use super::ground_claim::{GroundClaim, GroundVehicle};
use super::pace::{PaceClaim, check_speeds};
use super::peak::largest;
use super::place::FlatPlace;
use super::rims::{WheelRims, rim_breaches};
use super::way::Way;
use super::wheels::WheelExtremes;
use crate::world::terrain::Terrain;

/// One leg of a drive as it was written.
///
/// As the campaign's table of legs has it: a leg stands on its own, and joints are checked beside.
///
/// World frame. A leg is replayed from `from`, not from where the leg before came to: errors of legs do not add up
/// here, and joints are held to 1 nm.
#[derive(Debug, Clone, PartialEq)]
pub struct DriveLegClaim {
    /// x, y (m), ψ (rad), κ (1/m) at its first waypoint.
    pub from: [f64; 4],
    /// The same at its last.
    pub to: [f64; 4],
    /// The commands.
    pub pieces: Vec<DrivePiece>,
    /// Metres of the leg, rising from 0, with the commanded speed there, m/s; v² is linear between, and as at the ends
    /// beyond.
    pub speed: Vec<[f64; 2]>,
    /// Planned duration, s.
    pub duration: f64,
    /// Direction of travel in the body at its first waypoint and at its last, rad; it turns evenly with the metres.
    pub direction: [f64; 2],
}

impl DriveLegClaim {
    /// Change of the direction of travel, rad/m.
    ///
    /// (δ_end − δ_start)/metres; 0 of a leg that only turns in place.
    fn crab_rate(&self) -> f64 {
        let metres: f64 = self.pieces.iter().map(DrivePiece::length).sum();
        if metres > 0.0 { (self.direction[1] - self.direction[0]) / metres } else { 0.0 }
    }

    /// What it is to do on the ground.
    pub(super) fn ground(&self) -> GroundClaim {
        GroundClaim {
            start: [self.from[0], self.from[1], self.from[2]],
            start_curvature: self.from[3],
            crab: self.direction[0],
            crab_rate: self.crab_rate(),
            speed: self.speed.clone(),
            end: [self.to[0], self.to[1], self.to[2]],
            end_curvature: self.to[3],
        }
    }
}

/// What the whole drive claims.
///
/// `legs` has one entry fewer than `waypoints`, and at least one.
#[derive(Debug, Clone, PartialEq)]
pub struct DrivesClaim<'a> {
    /// Waypoints, x and y, m.
    pub waypoints: &'a [[f64; 2]],
    /// One leg between each two.
    pub legs: &'a [DriveLegClaim],
    /// The highest commanded speed, m/s.
    pub speed: f64,
    /// Rate of turns in place, rad/s.
    pub turn_rate: f64,
    /// What it keeps away from.
    pub places: &'a [FlatPlace],
}

/// What a leg may leave open, and what it must keep.
///
/// In a campaign position, heading and curvature are the precision that the generator itself was asked for.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriveTolerances {
    /// Distance from the leg's last waypoint, m.
    pub position: f64,
    /// Heading there, rad.
    pub yaw: f64,
    /// Curvature there, 1/m.
    pub curvature: f64,
    /// Largest |κ| of the commands, 1/m.
    pub most_curvature: f64,
    /// Largest |κ′| of the commands, 1/m².
    pub most_curvature_rate: f64,
    /// Largest angle of the body's z axis from the vertical, rad.
    pub most_tilt: f64,
    /// Largest |angle| of rocker and bogies, rad; without a suspension there are none.
    pub most_joint: f64,
    /// Largest |torque| of each wheel, N·m; infinite where none is asked for.
    pub most_torque: f64,
    /// Least and greatest direction of travel in the body, rad.
    pub directions: [f64; 2],
    /// Largest change of speed, m/s²; infinite where drives do not stop for changes of gear and turns in place.
    pub most_acceleration: f64,
    /// The driven wheels of a differential drive; `None` of others.
    pub rims: Option<WheelRims>,
    /// Largest commanded speed, m/s.
    pub most_speed: f64,
    /// Largest rate of turns in place, rad/s.
    pub most_turn_rate: f64,
    /// What a leg may do.
    pub manoeuvres: DriveManoeuvres,
    /// Least distance of the body's origin from each place of the claim, m.
    pub clearance: f64,
}

/// Ways of driving that legs may have.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct DriveManoeuvres {
    /// Arcs with the nose ahead.
    pub forward: bool,
    /// Arcs with the nose behind.
    pub reverse: bool,
    /// Turns in place.
    pub turn_in_place: bool,
}

/// Waypoints are written with all their digits.
const SAME: f64 = 1e-9;
/// Bounds are kept up to this share of them: what a replay on a grid may see of rounding.
const ROUNDING: f64 = 1e-6;

/// Integrates the written commands of every leg on the ground: each must end in the next waypoint's pose, keep its
/// bounds, and begin where the one before ends. Whatever is wrong is a finding; nothing panics on what a file may hold.
///
/// Fields of findings: `legs[k].end…`, `legs[k].start…`, bounds and speeds by their names. One replay a leg, 2000 steps
/// or more each.
///
/// Per leg: joint (position, heading, curvature, direction of travel), speeds and stops, direction within bounds, |κ|,
/// |κ′| and jumps of κ of the commands, gears and turns, speed and acceleration of driven rims, then the replay on the
/// ground: end pose and curvature, tilt, wheel torque, what the wheels may do, `keep_out[k].clearance` from each
/// place, between the steps of the replay too. Of a leg that cannot be replayed `stopped_after` tells after how many
/// metres. Of the whole drive `drive.speed`, `drive.turn_rate`: the highest that are commanded.
pub fn verify_drives<T: Terrain>(
    vehicle: &GroundVehicle,
    terrain: &T,
    claim: &DrivesClaim,
    tolerances: &DriveTolerances,
) -> Proof {
    let mut proof = Proof::default();
    if claim.legs.is_empty() || claim.legs.len() + 1 != claim.waypoints.len() {
        let (found, wanted) = (claim.legs.len() as f64, claim.waypoints.len() as f64 - 1.0);
        proof.findings.push(Finding { field: "legs".into(), value: found, bound: wanted, unit: "", leg: 0, at: 0.0 });
        return proof;
    }
    let kept = |bound: f64| bound * (1.0 + ROUNDING);
    let mut found = Collector::about(&mut proof.findings, "drive");
    found.above("speed", claim.speed, kept(tolerances.most_speed), "m/s");
    found.above("turn_rate", claim.turn_rate, kept(tolerances.most_turn_rate), "rad/s");
    let mut at = 0.0;
    for (number, leg) in claim.legs.iter().enumerate() {
        check_joint(&mut proof, claim, number, at);
        let pace = PaceClaim {
            pieces: &leg.pieces,
            knots: &leg.speed,
            before: number.checked_sub(1).map(|before| &claim.legs[before]).map(|leg| (&*leg.pieces, &*leg.speed)),
            last: number + 1 == claim.legs.len(),
            speed: claim.speed,
            turn_rate: claim.turn_rate,
            duration: leg.duration,
            most_acceleration: tolerances.most_acceleration,
        };
        check_speeds(&pace, &mut Collector::on_leg(&mut proof.findings, number, at));
        at += leg.duration;
        let mut found = Collector::on_leg(&mut proof.findings, number, at);
        let ([crab, last], crab_rate) = (leg.direction, leg.crab_rate());
        let [least, greatest] = tolerances.directions;
        for (what, direction) in [("direction.start.excess", crab), ("direction.end.excess", last)] {
            found.above(what, (least - direction).max(direction - greatest), SAME, "rad");
        }
        // In the plane: the commands themselves, whatever they lead to.
        let plane =
            DriveClaim { start_curvature: leg.from[3], crab, crab_rate, end: [0.0; 3], end_curvature: leg.to[3] };
        let commands = replay_drive(&leg.pieces, &plane);
        found.above("curvature", commands.max_curvature, kept(tolerances.most_curvature), "1/m");
        found.above("curvature_rate", commands.max_curvature_rate, kept(tolerances.most_curvature_rate), "1/m²");
        found.above("curvature_jump", commands.max_jump, tolerances.curvature, "1/m");
        found.above("start.curvature", commands.start_error_curvature.abs(), tolerances.curvature, "1/m");
        check_rims(leg, claim.turn_rate, tolerances.rims.as_ref(), &mut found);
        check_manoeuvres(&leg.pieces, &tolerances.manoeuvres, &mut found);
        let ground = leg.ground();
        let mut way = Way::begun(ground.start, ground.crab_rate);
        let replayed = follow_ground(&leg.pieces, vehicle, terrain, &ground, Some(&mut |here| way.pass(here)));
        match replayed {
            Err(stopped) => found.above("stopped_after", stopped.after_m, f64::NEG_INFINITY, "m"),
            Ok(replay) => {
                let position = libm::hypot(replay.error[0], replay.error[1]);
                found.above("end.position", position, tolerances.position, "m");
                found.above("end.yaw", replay.error[2].abs(), tolerances.yaw, "rad");
                found.above("end.curvature", replay.error_curvature.abs(), tolerances.curvature, "1/m");
                found.above("tilt", replay.max_tilt, kept(tolerances.most_tilt), "rad");
                found.above("joint_angle", replay.max_joint, kept(tolerances.most_joint), "rad");
                found.above("wheel_torque", replay.max_torque, kept(tolerances.most_torque), "N·m");
                check_wheels(vehicle, &replay.wheels, claim.turn_rate, &mut found);
                check_places(&way, claim.places, tolerances.clearance, &mut found);
                note(&mut proof.position, position, number, at);
                note(&mut proof.attitude, replay.error[2].abs(), number, at);
                proof.steps += replay.steps;
            }
        }
    }
    proof
}

/// Nothing is driven in a gear, or turned in place, that may not be; what has no length has no gear.
///
/// `reverse` and `forward` are metres, `turn_in_place` rad of what may not be.
fn check_manoeuvres(pieces: &[DrivePiece], may: &DriveManoeuvres, found: &mut Collector) {
    let [mut ahead, mut back, mut turned] = [0.0_f64; 3];
    for piece in pieces {
        match piece {
            DrivePiece::Arc { length_m, direction, .. } if length_m * direction < 0.0 => back += length_m.abs(),
            DrivePiece::Arc { length_m, .. } => ahead += length_m.abs(),
            DrivePiece::Turn { angle_rad } => turned += angle_rad.abs(),
        }
    }
    for (may, what, amount, unit) in [
        (may.forward, "forward", ahead, "m"),
        (may.reverse, "reverse", back, "m"),
        (may.turn_in_place, "turn_in_place", turned, "rad"),
    ] {
        found.above(what, amount, if may { f64::INFINITY } else { 0.0 }, unit);
    }
}

/// `way` keeps `wanted` m from all of `places`.
fn check_places(way: &Way, places: &[FlatPlace], wanted: f64, found: &mut Collector) {
    for (number, place) in places.iter().enumerate() {
        let distance = way.distance(place, wanted);
        found.unless(distance >= wanted, format_args!("keep_out[{number}].clearance"), distance, wanted, "m");
    }
}

/// All wheels keep what they may do, turned in place at `turn_rate` rad/s too.
fn check_wheels(vehicle: &GroundVehicle, met: &WheelExtremes, turn_rate: f64, found: &mut Collector) {
    let Some(held) = &vehicle.wheels else { return };
    let speed = largest(met.speed, met.spin * turn_rate.abs());
    for (what, value, bound, unit) in [
        ("steer_angle", met.steer, held.steer_rad, "rad"),
        ("steer_rate", met.steer_rate, held.steer_rate_rad_s, "rad/s"),
        ("wheel_speed", speed, held.speed_rad_s, "rad/s"),
        ("wheel_acceleration", met.acceleration, held.acceleration_rad_s2, "rad/s²"),
    ] {
        found.above(what, value, bound * (1.0 + ROUNDING), unit);
    }
}

/// Both driven wheels keep their speed and their acceleration.
fn check_rims(leg: &DriveLegClaim, turn_rate: f64, rims: Option<&WheelRims>, found: &mut Collector) {
    let Some(rims) = rims else { return };
    let breaches = rim_breaches(&leg.pieces, &leg.speed, turn_rate, rims);
    for (breach, (field, unit)) in breaches.iter().zip([("wheel_speed", "m/s"), ("wheel_acceleration", "m/s²")]) {
        if let Some(breach) = breach {
            found.unless(false, field, breach.value, breach.bound, unit);
        }
    }
}

/// A leg begins at its waypoint, and as the one before ends.
///
/// Differences of x, y (m), ψ (rad), κ (1/m) and of the direction of travel (rad) are held to one number, 10⁻⁹, and
/// the largest of them is told, as m. The leg's own ends are held against its two waypoints as well.
fn check_joint(proof: &mut Proof, claim: &DrivesClaim, number: usize, at: f64) {
    let leg = &claim.legs[number];
    let [x, y] = claim.waypoints[number];
    // What is no number is off by more than any.
    let larger = |a: f64, b: f64| if b > a || b.is_nan() { b } else { a };
    let mut off = libm::hypot(leg.from[0] - x, leg.from[1] - y);
    let [x, y] = claim.waypoints[number + 1];
    off = larger(off, libm::hypot(leg.to[0] - x, leg.to[1] - y));
    if number > 0 {
        let before = &claim.legs[number - 1].to;
        off = (0..4).fold(off, |off, i| larger(off, (leg.from[i] - before[i]).abs()));
        off = larger(off, (leg.direction[0] - claim.legs[number - 1].direction[1]).abs());
    }
    let worst = &mut proof.knots[0];
    if off > worst.value {
        *worst = Worst { value: off, leg: number, at };
    }
    Collector::on_leg(&mut proof.findings, number, at).above("joint", off, SAME, "m");
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::Flat;

    const TOLERANCES: DriveTolerances = DriveTolerances {
        position: 0.01,
        yaw: 0.01,
        curvature: 0.01,
        most_curvature: 1.0,
        most_curvature_rate: 1.0,
        most_tilt: 0.5,
        most_joint: f64::INFINITY,
        most_torque: f64::INFINITY,
        directions: [0.0, 0.0],
        most_acceleration: f64::INFINITY,
        rims: None,
        most_speed: 1.0,
        most_turn_rate: 1.0,
        manoeuvres: DriveManoeuvres { forward: true, reverse: false, turn_in_place: false },
        clearance: 0.5,
    };

    /// A quarter of a circle of radius 2 with clothoids of no length, then straight on: curvature jumps at the joint
    /// only.
    fn legs() -> Vec<DriveLegClaim> {
        let quarter = std::f64::consts::FRAC_PI_2;
        let arc = |curvature: f64, length_m: f64| DrivePiece::Arc {
            length_m,
            curvature: [curvature, 0.0, 0.0, 0.0, 0.0, 0.0],
            direction: 1.0,
        };
        vec![
            DriveLegClaim {
                from: [0.0, 0.0, 0.0, 0.5],
                to: [2.0, 2.0, quarter, 0.5],
                pieces: vec![arc(0.5, 2.0 * quarter)],
                speed: vec![[0.0, 1.0]],
                duration: 2.0 * quarter,
                direction: [0.0; 2],
            },
            DriveLegClaim {
                from: [2.0, 2.0, quarter, 0.5],
                to: [0.0, 4.0, 2.0 * quarter, 0.5],
                pieces: vec![arc(0.5, 2.0 * quarter)],
                speed: vec![[0.0, 1.0]],
                duration: 2.0 * quarter,
                direction: [0.0; 2],
            },
        ]
    }

    fn prove(legs: &[DriveLegClaim]) -> Proof {
        prove_within(legs, &TOLERANCES)
    }

    fn prove_within(legs: &[DriveLegClaim], tolerances: &DriveTolerances) -> Proof {
        prove_beside(&[], legs, tolerances)
    }

    fn prove_beside(places: &[FlatPlace], legs: &[DriveLegClaim], tolerances: &DriveTolerances) -> Proof {
        let waypoints = [[0.0, 0.0], [2.0, 2.0], [0.0, 4.0]];
        let claim = DrivesClaim { waypoints: &waypoints, legs, speed: 1.0, turn_rate: 1.0, places };
        verify_drives(&GroundVehicle::LEVEL, &Flat, &claim, tolerances)
    }

    /// The same half circle by a body that does not turn: what turns is the direction in which it travels.
    #[test]
    fn a_direction_that_turns_drives_round_and_joins_and_keeps_its_bounds() {
        let quarter = std::f64::consts::FRAC_PI_2;
        let mut legs = legs();
        for (number, leg) in legs.iter_mut().enumerate() {
            let line = DrivePiece::Arc { length_m: 2.0 * quarter, curvature: [0.0; 6], direction: 1.0 };
            leg.pieces = vec![line];
            for end in [&mut leg.from, &mut leg.to] {
                (end[2], end[3]) = (0.0, 0.0);
            }
            leg.direction = [number as f64 * quarter, (number as f64 + 1.0) * quarter];
        }
        let wide = DriveTolerances { directions: [0.0, 2.0 * quarter], ..TOLERANCES };
        let sound = prove_within(&legs, &wide);
        assert!(sound.ok() && sound.position.value < 1e-6, "{sound:?}");
        let told = |proof: Proof| proof.findings.into_iter().map(|f| f.field).collect::<Vec<_>>().join(" ");
        let narrow = told(prove_within(&legs, &DriveTolerances { directions: [0.0, quarter], ..TOLERANCES }));
        assert_eq!(narrow, "legs[1].direction.end.excess");
        legs[1].direction[0] = 0.9 * quarter;
        let jumps = told(prove_within(&legs, &wide));
        assert!(jumps.contains("legs[1].joint") && jumps.contains("legs[1].end.position"), "{jumps}");
        legs[1].direction[0] = f64::NAN;
        assert!(told(prove_within(&legs, &wide)).contains("legs[1].direction.start.excess"));
    }

    /// A wheel half a metre beside the middle goes at 1.25 m/s on a radius of 2 m.
    #[test]
    fn driven_wheels_are_held_to_their_rims() {
        let rims = |speed_m_s| Some(WheelRims { half_track_m: 0.5, speed_m_s, acceleration_m_s2: 1.0 });
        let sound = DriveTolerances { rims: rims(1.25), ..TOLERANCES };
        assert!(prove_within(&legs(), &sound).ok());
        let fast = prove_within(&legs(), &DriveTolerances { rims: rims(1.24), ..TOLERANCES });
        let fields: Vec<&str> = fast.findings.iter().map(|finding| finding.field.as_str()).collect();
        assert_eq!(fields, ["legs[0].wheel_speed", "legs[1].wheel_speed"]);
        assert!((fast.findings[0].value - 1.25).abs() < 1e-12 && fast.findings[0].bound == 1.24);
    }

    fn told(proof: Proof) -> Vec<String> {
        proof.findings.into_iter().map(|finding| finding.field).collect()
    }

    #[test]
    fn speeds_and_manoeuvres_are_those_that_are_asked() {
        let slow = DriveTolerances { most_speed: 0.9, most_turn_rate: 0.9, ..TOLERANCES };
        assert_eq!(told(prove_within(&legs(), &slow)), ["drive.speed", "drive.turn_rate"]);
        let may = DriveManoeuvres { forward: false, reverse: true, turn_in_place: true };
        let backwards = DriveTolerances { manoeuvres: may, ..TOLERANCES };
        assert_eq!(told(prove_within(&legs(), &backwards)), ["legs[0].forward", "legs[1].forward"]);
        let mut backed = legs();
        backed[1].pieces.push(DrivePiece::Arc { length_m: -0.1, curvature: [0.0; 6], direction: 1.0 });
        assert!(told(prove(&backed)).contains(&"legs[1].reverse".to_owned()));
        let mut turns = legs();
        turns[1].pieces.push(DrivePiece::Turn { angle_rad: -0.5 });
        assert!(told(prove(&turns)).contains(&"legs[1].turn_in_place".to_owned()));
    }

    /// The bend's far point is (2, 2), half a metre is kept.
    #[test]
    fn places_are_kept_away_from_all_along() {
        let found = |place: FlatPlace| told(prove_beside(&[place], &legs(), &TOLERANCES));
        let square = |x: f64| FlatPlace::Polygon(vec![[x, 0.5], [x + 1.0, 0.5], [x + 1.0, 3.5], [x, 3.5]]);
        let both = ["legs[0].keep_out[0].clearance", "legs[1].keep_out[0].clearance"];
        assert!(found(FlatPlace::Disc([3.501, 2.0], 1.0)).is_empty() && found(square(2.501)).is_empty());
        assert_eq!(found(FlatPlace::Disc([3.499, 2.0], 1.0)), both);
        assert_eq!(found(square(2.499)), both);
        assert_eq!(found(FlatPlace::Disc([f64::NAN, 2.0], 1.0)), both);
    }

    #[test]
    fn a_half_circle_is_proven_and_what_is_off_is_found() {
        let sound = prove(&legs());
        assert!(sound.ok() && sound.position.value < 1e-6, "{sound:?}");
        let fields = |change: fn(&mut Vec<DriveLegClaim>)| {
            let mut wrong = legs();
            change(&mut wrong);
            prove(&wrong).findings.into_iter().map(|finding| finding.field).collect::<Vec<_>>().join(" ")
        };
        let longer = fields(|legs| {
            if let DrivePiece::Arc { length_m, .. } = &mut legs[1].pieces[0] {
                *length_m *= 1.01;
            }
        });
        assert!(longer.contains("legs[1].end.position") && longer.contains("legs[1].end.yaw"), "{longer}");
        assert!(fields(|legs| legs[1].speed[0][1] = 0.5).contains("legs[1].speed_jump"));
        let sharper = fields(|legs| {
            if let DrivePiece::Arc { curvature, .. } = &mut legs[0].pieces[0] {
                curvature[0] = 1.5;
            }
        });
        assert!(sharper.contains("legs[0].curvature ") && sharper.contains("start.curvature"), "{sharper}");
        assert!(fields(|legs| legs[1].from[2] += 1e-6).contains("legs[1].joint"));
        assert!(fields(|legs| legs[0].to[0] = f64::NAN).contains("legs[0]"));
        assert_eq!(fields(|legs| legs.truncate(1)), "legs");
    }
}
