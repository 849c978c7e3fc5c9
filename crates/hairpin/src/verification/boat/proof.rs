//! The proof of one trip: every condition checked, every leg sailed.
//!
//! | condition | how |
//! | --- | --- |
//! | polynomials meet waypoints and each other in value and three derivatives | compared |
//! | forces, speed, waters, keep-outs at every moment | bounded between moments, in ways of this room's own |
//! | each leg leads to the next waypoint under its forces | integrated, steps halved until they agree |

use super::bound::broken;
use super::claim::{BoatClaim, BoatHull, BoatLeg};
use super::knots::mismatches;
use super::places::near;
use super::replay::{Sailor, State};
use crate::math::power::square;
use crate::verification::finding::{Collector, EndError, Finding, Proof, Tolerances, note};
use crate::verification::gauss::Gauss;

/// Checks a claim: polynomials that meet waypoints and each other, forces and speed within their limits and the way
/// clear at every moment, and a boat that comes from each waypoint to the next under these forces, stretch by stretch.
/// Whatever is wrong is a finding; nothing panics on what a file may hold.
///
/// What becomes of the whole trip in one go is told, not judged ([`Proof::open_loop`]): not every hull keeps its
/// heading by itself. Of [`Tolerances`] `attitude` and `rates` are those of the heading; no grid is used.
///
/// `proof.findings` empty is a proof for the model. Times of findings are of the whole trip, s.
pub fn verify_boat(hull: &BoatHull, claim: &BoatClaim, tolerances: &Tolerances) -> Proof {
    let mut proof = Proof::default();
    if let Some((field, value, bound, leg)) = unsound(hull, claim) {
        proof.findings.push(Finding { field, value, bound, unit: "", leg, at: 0.0 });
        return proof;
    }
    check_knots(&mut proof, claim, tolerances);
    let sailor = Sailor { hull, claim, gauss: Gauss::new(), accuracy: tolerances.accuracy };
    let mut began = 0.0;
    let mut chained = Some(sailor.state(&claim.legs[0], 0.0));
    for (number, leg) in claim.legs.iter().enumerate() {
        check_limits(&mut proof, hull, claim, (number, leg), began);
        sail(&mut proof, &sailor, number, began, tolerances);
        chained = chained.and_then(|chained| sailor.sail_on(leg, &onto(leg, chained)));
        began += leg.duration;
    }
    proof.open_loop = chained.map(|end| end_error(&sailor, &end));
    proof
}

/// The end error of the whole trip, open loop, with thrusters that lag behind the demand: what the claim leaves out.
/// `None` where the claim or the hull cannot be sailed at all, or nothing lags.
///
/// m, m/s, rad and rad/s at the end; an estimate, held to nothing.
pub fn boat_with_lag(hull: &BoatHull, claim: &BoatClaim) -> Option<EndError> {
    if unsound(hull, claim).is_some() || hull.time_constant <= 0.0 {
        return None;
    }
    let sailor = Sailor { hull, claim, gauss: Gauss::new(), accuracy: Tolerances::default().accuracy };
    let first = claim.legs.first()?;
    let (mut state, mut thrust) = (sailor.state(first, 0.0), sailor.forces(first, 0.0));
    for leg in claim.legs {
        state = sailor.sail_with_lag(leg, &onto(leg, state), &mut thrust)?;
    }
    Some(end_error(&sailor, &state))
}

/// What makes the claim none at all: field, value, bound, leg.
///
/// Told as one finding, and nothing else is looked at.
fn unsound(hull: &BoatHull, claim: &BoatClaim) -> Option<(String, f64, f64, usize)> {
    if claim.legs.is_empty() || claim.legs.len() + 1 != claim.waypoints.len() {
        return Some(("legs".into(), claim.legs.len() as f64, claim.waypoints.len() as f64 - 1.0, 0));
    }
    if let Some(leg) = claim.legs.iter().position(|leg| !leg.is_finite()) {
        return Some((format!("legs[{leg}]"), f64::NAN, f64::MAX, leg));
    }
    if let Some(at) = claim.waypoints.iter().position(|w| !w.iter().all(|c| c.is_finite())) {
        return Some((format!("waypoints[{at}]"), f64::NAN, f64::MAX, at.saturating_sub(1)));
    }
    let sound = hull.is_physical() && claim.current.iter().all(|c| c.is_finite());
    (!sound).then(|| ("hull".into(), f64::NAN, f64::MAX, 0))
}

/// Of value, velocity, acceleration and jerk, for places and headings apart.
fn check_knots(proof: &mut Proof, claim: &BoatClaim, tolerances: &Tolerances) {
    let mut ends = vec![0.0];
    claim.legs.iter().for_each(|leg| ends.push(ends[ends.len() - 1] + leg.duration));
    for knot in mismatches(claim, tolerances.knots) {
        let at = ends[knot.leg + usize::from(knot.at_end)];
        if !knot.heading {
            note(&mut proof.knots[knot.order], knot.difference, knot.leg, at);
        }
        let end = if knot.at_end { "end" } else { "start" };
        let (name, unit) = match (knot.heading, knot.order) {
            (false, order) => {
                [("position", "m"), ("velocity", "m/s"), ("acceleration", "m/s²"), ("jerk", "m/s³")][order]
            }
            (true, order) => {
                [("heading", "rad"), ("rate", "rad/s"), ("turning", "rad/s²"), ("turning rate", "rad/s³")][order]
            }
        };
        let mut found = Collector::on_leg(&mut proof.findings, knot.leg, at);
        found.above(format_args!("{end}.{name}"), knot.difference, knot.allowed, unit);
    }
}

/// Every limit that is broken or not shown to hold, once a leg.
fn check_limits(proof: &mut Proof, hull: &BoatHull, claim: &BoatClaim, (number, leg): (usize, &BoatLeg), began: f64) {
    for broken in broken(hull, claim, leg) {
        let mut found = Collector::on_leg(&mut proof.findings, number, began + broken.at);
        found.unless(false, broken.what, broken.value, broken.bound, broken.unit);
    }
    for near in near(hull, claim, leg) {
        let mut found = Collector::on_leg(&mut proof.findings, number, began + near.at);
        match near.place {
            Some(place) => {
                found.unless(false, format_args!("keep_out[{place}].clearance"), near.distance, near.wanted, "m");
            }
            None => found.unless(false, "waters", near.distance, near.wanted, "m"),
        }
    }
}

/// Sails leg `number`, which must lead where it ends.
fn sail(proof: &mut Proof, sailor: &Sailor, number: usize, began: f64, tolerances: &Tolerances) {
    let leg = &sailor.claim.legs[number];
    let at = began + leg.duration;
    let replay = match sailor.replay(leg) {
        Ok(replay) => replay,
        Err(change) => {
            let mut found = Collector::on_leg(&mut proof.findings, number, began);
            return found.unless(false, "integration", change, tolerances.accuracy, "");
        }
    };
    let waypoint = sailor.claim.waypoints[number + 1];
    let position = (square(replay.end[0] - waypoint[0]) + square(replay.end[1] - waypoint[1])).sqrt();
    let [velocity, attitude, rates] = replay.off;
    note(&mut proof.position, position, number, at);
    note(&mut proof.velocity, velocity, number, at);
    note(&mut proof.attitude, attitude, number, at);
    note(&mut proof.rates, rates, number, at);
    note(&mut proof.path, replay.path.0, number, began + replay.path.1);
    proof.steps += replay.steps;
    let mut found = Collector::on_leg(&mut proof.findings, number, at);
    found.above("sailed.position", position, tolerances.position, "m");
    found.above("sailed.velocity", velocity, tolerances.velocity, "m/s");
    found.above("sailed.heading", attitude, tolerances.attitude, "rad");
    found.above("sailed.rate", rates, tolerances.rates, "rad/s");
    let mut found = found.at(number, began + replay.path.1);
    found.above("path", replay.path.0, tolerances.position, "m");
}

/// `state` with its heading as `leg` tells it: by whole turns they may differ.
fn onto(leg: &BoatLeg, mut state: State) -> State {
    let begins = leg.coefficients[2][0];
    state[2] = begins + libm::remainder(state[2] - begins, std::f64::consts::TAU);
    state
}

fn end_error(sailor: &Sailor, end: &State) -> EndError {
    let claim = sailor.claim;
    let (last, leg) = (claim.waypoints[claim.waypoints.len() - 1], &claim.legs[claim.legs.len() - 1]);
    let [vx, vy, _] = sailor.velocity(end);
    EndError {
        position: (square(end[0] - last[0]) + square(end[1] - last[1])).sqrt(),
        velocity: (square(vx) + square(vy)).sqrt(),
        attitude: (end[2] - leg.taylor(leg.duration)[2][0]).abs(),
    }
}
