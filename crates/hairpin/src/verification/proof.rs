//! The proof of one flight, condition by condition, and what it found.

use super::body::{Body, State, attitude_error, level};
use super::claim::{Claim, Leg};
use super::demand::Singular;
use super::gauss::Gauss;
use super::knots::mismatches;
use super::replay::{Flyer, Replay, Trouble};

/// What a proof may leave open.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerances {
    /// Distance from the next waypoint at the end of a leg, and from the polynomial on the way, m.
    pub position: f64,
    /// Velocity error at the end of a leg, m/s.
    pub velocity: f64,
    /// Attitude error at the end of a leg, rad.
    pub attitude: f64,
    /// Angular velocity left at the end of a leg, rad/s.
    pub rates: f64,
    /// Mismatch of the polynomials at waypoints beyond rounding, m/s^k for the k-th derivative.
    pub knots: f64,
    /// Error of any component of the integrated state, SI, estimated by halving the step.
    pub accuracy: f64,
    /// Spacing of the grid on which rotor speeds are held to their limits, s; near a limit it is refined.
    pub grid: f64,
}

impl Default for Tolerances {
    /// 0.1 mm, 0.1 mm/s, 0.001°, 0.001°/s; 1e-9 at waypoints; 1e-10; 10 ms.
    fn default() -> Self {
        let thousandth_degree = 1e-3f64.to_radians();
        Self {
            position: 1e-4,
            velocity: 1e-4,
            attitude: thousandth_degree,
            rates: thousandth_degree,
            knots: 1e-9,
            accuracy: 1e-10,
            grid: 0.01,
        }
    }
}

/// The largest (or smallest) of something, and where.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Worst {
    /// The value, SI.
    pub value: f64,
    /// The leg, numbered by its first waypoint.
    pub leg: usize,
    /// Time since the start of the flight, s.
    pub at: f64,
}

/// State at the end of the whole flight against what was claimed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct EndError {
    /// Distance from the last waypoint, m.
    pub position: f64,
    /// Speed left, m/s.
    pub velocity: f64,
    /// Angle from level with yaw 0, rad.
    pub attitude: f64,
}

/// Something that does not hold.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// What: `legs[2].end.velocity`, `legs[0].rotor3.max`, `legs`, ….
    pub field: String,
    /// What was found, in `unit`.
    pub value: f64,
    /// What it must not exceed (or, of a minimum, fall below), in `unit`.
    pub bound: f64,
    /// SI unit; empty for pure numbers.
    pub unit: &'static str,
    /// The leg.
    pub leg: usize,
    /// Time since the start of the flight, s.
    pub at: f64,
}

/// What verification found, condition by condition.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Proof {
    /// Leg by leg, from each leg's own start: distance from the next waypoint, m.
    pub position: Worst,
    /// Velocity error there, m/s.
    pub velocity: Worst,
    /// Angle from level there, rad.
    pub attitude: Worst,
    /// Angular velocity left there, rad/s.
    pub rates: Worst,
    /// Distance of the integrated path from the polynomial, m.
    pub path: Worst,
    /// Mismatch at waypoints: position, velocity, acceleration, jerk, m/s^k.
    pub knots: [Worst; 4],
    /// Smallest rotor speed, rad/s; negative: a rotor would have to pull.
    pub slowest_rotor: Worst,
    /// Largest rotor speed, rad/s.
    pub fastest_rotor: Worst,
    /// The whole flight in one go, without correction at waypoints; `None` if it could not be flown.
    pub open_loop: Option<EndError>,
    /// Steps of the integrator in all.
    pub steps: usize,
    /// All that does not hold; empty: the claim is proven.
    pub findings: Vec<Finding>,
}

impl Proof {
    /// Whether everything holds.
    pub fn ok(&self) -> bool {
        self.findings.is_empty()
    }
}

/// Checks a claim by integrating the rigid body, drag included, under the rotor speeds that its polynomials demand:
/// every leg from the state claimed at its start to the state claimed at its end, and the whole flight in one go.
/// Whatever is wrong is a finding; nothing panics on what a file may hold.
///
/// A coefficient c_i that is off by 1 % moves a derivative of order k at the leg's end by 0.01 c_i i!/(i−k)! T^(i−k),
/// which is found if it exceeds [`Tolerances::knots`] plus 1e-12 of the sum of that derivative's terms: at the default,
/// with legs of 0.8 s and longer, every coefficient of magnitude 1e-6 m/s^i or more.
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
            proof.findings.push(Finding {
                field: format!("legs[{}].{end}.{name}", knot.leg),
                value: knot.difference,
                bound: knot.allowed,
                unit,
                leg: knot.leg,
                at,
            });
        }
    }
}

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
                exceed(proof, "path", replay.path.0, tolerances.position, "m", (number, began + replay.path.1));
                proof.steps += replay.steps;
            }
            Err(trouble) => {
                whole = false;
                proof.findings.push(unflown(trouble, number, began, tolerances));
            }
        }
        began += leg.duration;
    }
    proof.open_loop = whole.then(|| end_error(&chained, claim));
}

fn check_end(proof: &mut Proof, replay: &Replay, target: &State, leg: usize, at: f64, tolerances: &Tolerances) {
    let distance = |from: usize| (from..from + 3).map(|i| (replay.end[i] - target[i]).powi(2)).sum::<f64>().sqrt();
    let (position, velocity, rates) = (distance(0), distance(3), distance(15));
    let attitude = attitude_error(&replay.end);
    note(&mut proof.position, position, leg, at);
    note(&mut proof.velocity, velocity, leg, at);
    note(&mut proof.attitude, attitude, leg, at);
    note(&mut proof.rates, rates, leg, at);
    exceed(proof, "flown.position", position, tolerances.position, "m", (leg, at));
    exceed(proof, "flown.velocity", velocity, tolerances.velocity, "m/s", (leg, at));
    exceed(proof, "flown.attitude", attitude, tolerances.attitude, "rad", (leg, at));
    exceed(proof, "flown.rates", rates, tolerances.rates, "rad/s", (leg, at));
}

/// Rotor speeds against their limits on a grid, refined around each rotor's extremes where they come near a limit.
fn check_rotors(
    proof: &mut Proof,
    flyer: &Flyer,
    leg: &Leg,
    number: usize,
    began: f64,
    tolerances: &Tolerances,
) -> Result<(), Trouble> {
    let (slowest, fastest) = flyer.body.rotor_speed;
    let (lowest, highest) = (slowest * slowest, fastest * fastest);
    let intervals = (leg.duration / tolerances.grid).ceil().clamp(1.0, 1e6) as usize;
    let h = leg.duration / intervals as f64;
    let mut extremes = [[(f64::INFINITY, 0.0), (f64::NEG_INFINITY, 0.0)]; 4];
    for i in 0..=intervals {
        let tau = i as f64 * h;
        for ([low, high], square) in extremes.iter_mut().zip(flyer.squares(leg, tau)?) {
            if square < low.0 {
                *low = (square, tau);
            }
            if square > high.0 {
                *high = (square, tau);
            }
        }
    }
    let margin = 0.02 * highest;
    for (rotor, [low, high]) in extremes.iter_mut().enumerate() {
        if low.0 < lowest + margin {
            *low = refine(flyer, leg, rotor, -1.0, *low, h)?;
        }
        if high.0 > highest - margin {
            *high = refine(flyer, leg, rotor, 1.0, *high, h)?;
        }
        let (low_speed, high_speed) = (signed_root(low.0), signed_root(high.0));
        if low_speed < proof.slowest_rotor.value {
            proof.slowest_rotor = Worst { value: low_speed, leg: number, at: began + low.1 };
        }
        note(&mut proof.fastest_rotor, high_speed, number, began + high.1);
        let rounding = 1e-9 * highest;
        let (name, unit) = (format!("rotor{}", rotor + 1), "rad/s");
        if high.0 > highest + rounding {
            exceed(proof, &format!("{name}.max"), high_speed, fastest, unit, (number, began + high.1));
        }
        if low.0 < lowest - rounding {
            let (field, at) = (format!("legs[{number}].{name}.min"), began + low.1);
            proof.findings.push(Finding { field, value: low_speed, bound: slowest, unit, leg: number, at });
        }
    }
    Ok(())
}

/// The extreme of one rotor's squared speed within a grid interval of `from`, by golden-section search.
fn refine(flyer: &Flyer, leg: &Leg, rotor: usize, sign: f64, from: (f64, f64), h: f64) -> Result<(f64, f64), Trouble> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    let (mut low, mut high) = ((from.1 - h).max(0.0), (from.1 + h).min(leg.duration));
    let mut best = from;
    for _ in 0..24 {
        let (left, right) = (high - GOLDEN * (high - low), low + GOLDEN * (high - low));
        let (at_left, at_right) = (flyer.squares(leg, left)?[rotor], flyer.squares(leg, right)?[rotor]);
        for (square, tau) in [(at_left, left), (at_right, right)] {
            if sign * square > sign * best.0 {
                best = (square, tau);
            }
        }
        if sign * at_left > sign * at_right { high = right } else { low = left }
    }
    Ok(best)
}

fn signed_root(square: f64) -> f64 {
    square.abs().sqrt().copysign(square)
}

fn velocity_at(leg: &Leg, tau: f64) -> [f64; 3] {
    leg.taylor(tau).map(|axis| axis[1])
}

fn end_error(state: &State, claim: &Claim) -> EndError {
    let last = claim.waypoints[claim.waypoints.len() - 1];
    EndError {
        position: (0..3).map(|i| (state[i] - last[i]).powi(2)).sum::<f64>().sqrt(),
        velocity: state[3..6].iter().map(|v| v * v).sum::<f64>().sqrt(),
        attitude: attitude_error(state),
    }
}

fn note(worst: &mut Worst, value: f64, leg: usize, at: f64) {
    if value > worst.value {
        *worst = Worst { value, leg, at };
    }
}

/// A finding if `value` exceeds `bound` or is no number.
fn exceed(proof: &mut Proof, what: &str, value: f64, bound: f64, unit: &'static str, (leg, at): (usize, f64)) {
    if value > bound || value.is_nan() {
        proof.findings.push(Finding { field: format!("legs[{leg}].{what}"), value, bound, unit, leg, at });
    }
}

fn unflown(trouble: Trouble, leg: usize, began: f64, tolerances: &Tolerances) -> Finding {
    let (what, value, bound, unit, tau) = match trouble {
        Trouble::Singular(tau, Singular::FreeFall(thrust)) => ("thrust", thrust, f64::MIN_POSITIVE, "N", tau),
        Trouble::Singular(tau, Singular::Yaw(sine)) => ("yaw", sine, f64::MIN_POSITIVE, "", tau),
        Trouble::Steps(_, change) => ("integration", change, tolerances.accuracy, "", 0.0),
    };
    Finding { field: format!("legs[{leg}].{what}"), value, bound, unit, leg, at: began + tau }
}
