//! The proof of one flight: every condition checked, every leg flown.

use super::body::{Body, State, attitude_error, level};
use super::claim::{Claim, Leg};
use super::demand::Singular;
use super::finding::{Collector, EndError, Finding, Proof, Tolerances, note};
use super::gauss::Gauss;
use super::knots::mismatches;
use super::replay::{Flyer, Replay, Trouble};
use super::rotors::check_rotors;
use crate::math::power::square;

/// Checks a claim by integrating the rigid body, drag included, under the rotor speeds that its polynomials demand:
/// every leg from the state claimed at its start to the state claimed at its end, and the whole flight in one go.
/// Whatever is wrong is a finding; nothing panics on what a file may hold.
///
/// A coefficient c_i that is off by 1 % moves a derivative of order k at the leg's end by 0.01 c_i i!/(i−k)! T^(i−k),
/// which is found if it exceeds [`Tolerances::knots`] plus 1e-12 of the sum of that derivative's terms: at the default,
/// with legs of 0.8 s and longer, every coefficient of magnitude 1e-6 m/s^i or more.
///
/// Each leg is integrated at halved steps until two runs agree to what [`Tolerances::accuracy`] asks for, so that
/// accuracy is estimated and not assumed.
///
/// Squared rotor speeds come from the polynomial alone (`demand`), the state from integrating them: if both agree at
/// the leg's end, the flatness map, its derivatives and the robot's signs are right. Within a leg the path must stay
/// within [`Tolerances::position`] of its polynomial.
pub fn verify(body: &Body, claim: &Claim, tolerances: &Tolerances) -> Proof {
    let mut proof = Proof::default();
    let refuse =
        |field: String, value: f64, bound: f64, leg: usize| Finding { field, value, bound, unit: "", leg, at: 0.0 };
    if claim.legs.is_empty() || claim.legs.len() + 1 != claim.waypoints.len() {
        let (found, wanted) = (claim.legs.len() as f64, claim.waypoints.len() as f64 - 1.0);
        proof.findings.push(refuse("legs".into(), found, wanted, 0));
        return proof;
    }
    let broken = claim.legs.iter().position(|leg| !leg.is_finite());
    let lost = claim.waypoints.iter().position(|w| !w.iter().all(|c| c.is_finite()));
    if let Some((field, leg)) = broken
        .map(|leg| (format!("legs[{leg}]"), leg))
        .or(lost.map(|waypoint| (format!("waypoints[{waypoint}]"), waypoint.saturating_sub(1))))
    {
        proof.findings.push(refuse(field, f64::NAN, f64::MAX, leg));
        return proof;
    }
    let Some(mixer) = body.mixer().filter(|_| body.is_physical()) else {
        proof.findings.push(refuse("body".into(), f64::NAN, f64::MAX, 0));
        return proof;
    };
    let flyer = Flyer { body, mixer, gauss: Gauss::new(), accuracy: tolerances.accuracy };
    check_knots(&mut proof, body, claim, tolerances);
    proof.slowest_rotor.value = f64::INFINITY;
    fly_legs(&mut proof, &flyer, claim, tolerances);
    proof
}

/// The end error of the whole flight, open loop, with rotors that lag behind the demand: what the claim leaves out.
/// `None` where the claim or the body cannot be flown at all. Without a time constant the rotors do not lag.
///
/// ẇ = (w_demanded − w)/τ for each rotor. The claim leaves lag out, since snap jumps at waypoints and rotor speeds with
/// it; this number says how much that is.
///
/// Rotors begin at what the first leg demands at its start. Also `None` where a demand is singular or an integration
/// does not converge.
pub fn open_loop_with_lag(body: &Body, claim: &Claim) -> Option<EndError> {
    let sound = claim.legs.len() + 1 == claim.waypoints.len() && claim.legs.iter().all(Leg::is_finite);
    let first = claim.legs.first().filter(|_| sound && body.is_physical())?;
    let flyer = Flyer { body, mixer: body.mixer()?, gauss: Gauss::new(), accuracy: Tolerances::default().accuracy };
    let mut state = level(claim.waypoints[0], velocity_at(first, 0.0));
    let mut speeds = flyer.squares(first, 0.0).ok()?.map(|square| square.max(0.0).sqrt());
    for leg in claim.legs {
        state = if body.rotor_time_constant > 0.0 {
            flyer.replay_with_lag(leg, &state, &mut speeds).ok()?
        } else {
            flyer.replay(leg, &state, &state).ok()?.end
        };
    }
    Some(end_error(&state, claim))
}

/// At both ends of every leg: position at the waypoint, velocity that of the leg before (rest at the flight's ends),
/// thrust that carries the weight and points up, no turning; each within `knots` and the rounding of its polynomial.
fn check_knots(proof: &mut Proof, body: &Body, claim: &Claim, tolerances: &Tolerances) {
    let ends: Vec<f64> = claim
        .legs
        .iter()
        .scan(0.0, |t, leg| {
            *t += leg.duration;
            Some(*t)
        })
        .collect();
    for knot in mismatches(body, claim, tolerances.knots) {
        let at = ends[knot.leg] - if knot.at_end { 0.0 } else { claim.legs[knot.leg].duration };
        note(&mut proof.knots[knot.order], knot.difference, knot.leg, at);
        if knot.difference > knot.allowed {
            let end = if knot.at_end { "end" } else { "start" };
            let (name, unit) =
                [("position", "m"), ("velocity", "m/s"), ("acceleration", "m/s²"), ("jerk", "m/s³")][knot.order];
            let mut found = Collector::on_leg(&mut proof.findings, knot.leg, at);
            found.unless(false, format_args!("{end}.{name}"), knot.difference, knot.allowed, unit);
        }
    }
}

/// Flies each leg twice: from the state that its own polynomial begins with, which must end in the state at the next
/// waypoint; and from where the leg before was flown to, so that what errors add up to over the whole flight is known
/// ([`Proof::open_loop`]) without being judged.
fn fly_legs(proof: &mut Proof, flyer: &Flyer, claim: &Claim, tolerances: &Tolerances) {
    let mut began = 0.0;
    let mut chained = level(claim.waypoints[0], velocity_at(&claim.legs[0], 0.0));
    let mut whole = true;
    for (number, leg) in claim.legs.iter().enumerate() {
        let start = level(claim.waypoints[number], velocity_at(leg, 0.0));
        let flown = check_rotors(proof, flyer, leg, number, began, tolerances)
            .and_then(|()| flyer.replay(leg, &start, &chained));
        match flown {
            Ok(replay) => {
                chained = replay.chained;
                let next = claim.legs.get(number + 1);
                let velocity = next.map_or([0.0; 3], |next| velocity_at(next, 0.0));
                let target = level(claim.waypoints[number + 1], velocity);
                check_end(proof, &replay, &target, number, began + leg.duration, tolerances);
                note(&mut proof.path, replay.path.0, number, began + replay.path.1);
                let mut found = Collector::on_leg(&mut proof.findings, number, began + replay.path.1);
                found.above("path", replay.path.0, tolerances.position, "m");
                proof.steps += replay.steps;
            }
            Err(trouble) => {
                whole = false;
                unflown(proof, trouble, number, began, tolerances);
            }
        }
        began += leg.duration;
    }
    proof.open_loop = whole.then(|| end_error(&chained, claim));
}

/// Position, velocity and body rates by their norms, attitude by its angle from level.
fn check_end(proof: &mut Proof, replay: &Replay, target: &State, leg: usize, at: f64, tolerances: &Tolerances) {
    let distance = |from: usize| (from..from + 3).map(|i| square(replay.end[i] - target[i])).sum::<f64>().sqrt();
    let (position, velocity, rates) = (distance(0), distance(3), distance(15));
    let attitude = attitude_error(&replay.end);
    note(&mut proof.position, position, leg, at);
    note(&mut proof.velocity, velocity, leg, at);
    note(&mut proof.attitude, attitude, leg, at);
    note(&mut proof.rates, rates, leg, at);
    let mut found = Collector::on_leg(&mut proof.findings, leg, at);
    found.above("flown.position", position, tolerances.position, "m");
    found.above("flown.velocity", velocity, tolerances.velocity, "m/s");
    found.above("flown.attitude", attitude, tolerances.attitude, "rad");
    found.above("flown.rates", rates, tolerances.rates, "rad/s");
}

/// ṗ(τ), m/s.
fn velocity_at(leg: &Leg, tau: f64) -> [f64; 3] {
    leg.taylor(tau).map(|axis| axis[1])
}

/// Of a state at the end of the whole flight.
///
/// Position and velocity (at rest in the end) by their norms, m and m/s; attitude as the angle from level, rad.
fn end_error(state: &State, claim: &Claim) -> EndError {
    let last = claim.waypoints[claim.waypoints.len() - 1];
    EndError {
        position: (0..3).map(|i| square(state[i] - last[i])).sum::<f64>().sqrt(),
        velocity: state[3..6].iter().map(|v| v * v).sum::<f64>().sqrt(),
        attitude: attitude_error(state),
    }
}

/// A finding `thrust`, `yaw` or `integration` of a leg that could not be flown.
///
/// Values are what vanished (N for thrust, a sine for yaw) or the last change between two runs; the bound of the first
/// two is the smallest positive number, which only says "above 0".
fn unflown(proof: &mut Proof, trouble: Trouble, leg: usize, began: f64, tolerances: &Tolerances) {
    let (what, value, bound, unit, tau) = match trouble {
        Trouble::Singular(tau, Singular::FreeFall(thrust)) => ("thrust", thrust, f64::MIN_POSITIVE, "N", tau),
        Trouble::Singular(tau, Singular::Yaw(sine)) => ("yaw", sine, f64::MIN_POSITIVE, "", tau),
        Trouble::Steps(_, change) => ("integration", change, tolerances.accuracy, "", 0.0),
    };
    Collector::on_leg(&mut proof.findings, leg, began + tau).unless(false, what, value, bound, unit);
}
