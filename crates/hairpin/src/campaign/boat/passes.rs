//! Missions made elsewhere, by the claim of boats: legs from state to state through their waypoints, each passed
//! between its legs with a speed of a few, or the limits that break.
//!
//! Dynamic programming along the mission: at waypoint k a state is a velocity along the bisector of its two legs
//! (zero where it rests), and J(k, s′) = min over s of J(k − 1, s) + T(s, s′), T the shortest leg time of the ladder
//! that the judge finds feasible. Where a speed is demanded of a leg its time is fixed: length over speed, times 1, 2
//! or 35/16 for no, one or both ends at rest. A leg that breaks begins the chain anew, so that all that breaks is
//! told.

use nalgebra::{Point3, Vector2};

use super::BoatSetup;
use super::through::is_free;
use crate::campaign::bounds::LONGEST_PASSAGE_S;
use crate::campaign::passage::{Broken, Certainty, Demands, Passage, Passed, PassedLeg};
use crate::feasibility::boat::{BoatEnd, BoatInfeasible, BoatJudge, BoatLimit};
use crate::feasibility::steering::LegTiming;
use crate::math::decimals;
use crate::trajectory::{Profile, ProfileLeg};

/// Shares of the top speed that a waypoint is passed with where none is demanded; 0: at rest.
const SHARES: [f64; 4] = [0.9, 0.6, 0.3, 0.0];
/// The shortest leg time that is tried, s.
///
/// The ladder from here to the longest passage has ratio 1.2.
const SHORTEST_S: f64 = 1.0;
/// A rest-to-rest septic's peak speed by its mean one.
///
/// A leg that is demanded at v between two rests takes PEAK · L/v, so that v is its greatest speed.
const PEAK: f64 = 35.0 / 16.0;
/// A speed within this share of the limit keeps it.
const ROUNDING: f64 = 1e-9;

/// A state at a waypoint, and how it was come to.
///
/// `from` is the index of the state before in its own column, and the leg from there; `None` at the head of a chain.
struct Reached {
    end: BoatEnd,
    /// Seconds from the beginning of the chain.
    cost: f64,
    from: Option<(usize, ProfileLeg)>,
}

/// What the claim says of `asked`.
///
/// What no boat can do is told as proven; what was not found under these states and times as not found, which says
/// nothing of others. O(legs · states² · times) judgements at most.
///
/// Of the first time that is feasible between two states no longer one is tried. A mission that is longer than
/// `generate.limits.max_time_s` has no witness, but legs. Top speeds are those of 65 instants a leg, m/s over ground.
pub(super) fn passes(setup: &BoatSetup, asked: &Demands) -> Passage {
    let judge = setup.judge();
    let points = asked.waypoints;
    let count = points.len() - 1;
    let rungs = LegTiming::ladder(SHORTEST_S, LONGEST_PASSAGE_S).rungs();
    let mut table = vec![states(&judge, asked, 0)];
    let (mut legs, mut whole) = (Vec::with_capacity(count), true);
    for leg in 0..count {
        let length = (points[leg + 1] - points[leg]).xy().norm();
        let mut one = PassedLeg { length, broken: proven(setup, asked, leg), ..PassedLeg::default() };
        let times = match asked.speed(leg) {
            Some(speed) => {
                let factor = match [asked.rests(leg), asked.rests(leg + 1)] {
                    [false, false] => 1.0,
                    [true, true] => PEAK,
                    _ => 2.0,
                };
                vec![factor * length / speed]
            }
            None => rungs.clone(),
        };
        let (mut found, mut why): (Vec<Reached>, Option<BoatInfeasible>) = (Vec::new(), None);
        for state in states(&judge, asked, leg + 1) {
            let mut best: Option<Reached> = None;
            for (index, before) in table[leg].iter().enumerate() {
                let mut judged = times.iter().map(|time| judge.judge(&before.end, &state.end, *time));
                let solved = judged.find_map(|one| one.map_err(|refused| why = Some(refused)).ok());
                let Some(solved) = solved else { continue };
                one.fastest = Some(one.fastest.unwrap_or(f64::INFINITY).min(solved.duration));
                let cost = before.cost + solved.duration;
                if best.as_ref().is_none_or(|known| cost < known.cost) {
                    best = Some(Reached { end: state.end, cost, from: Some((index, solved)) });
                }
            }
            found.extend(best);
        }
        if found.is_empty() {
            whole = false;
            one.broken = one.broken.or_else(|| why.map(|why| refused(leg, &why)));
            found = states(&judge, asked, leg + 1);
        }
        legs.push(one);
        table.push(found);
    }
    let whole = whole && legs.iter().all(|leg| leg.broken.is_none());
    let profile = whole.then(|| joined(table));
    let most = setup.longest();
    let late = profile.as_ref().map(Profile::duration).filter(|duration| *duration > most);
    let broken = late.map(|duration| Broken {
        waypoint: count,
        leg: None,
        limit: "duration",
        unit: "s",
        excess: Some(duration - most),
        certainty: Certainty::NotFound,
        words: format!("the trip takes {duration:.1} s, {most} s at most"),
    });
    let witness = profile.filter(|_| broken.is_none()).map(|profile| {
        for (leg, piece) in legs.iter_mut().zip(&profile.legs) {
            let speed = |k: u32| piece.derivative(piece.duration * f64::from(k) / 64.0, 1).xy().norm();
            (leg.time, leg.top_speed) = (Some(piece.duration), Some((0..=64).map(speed).fold(0.0, f64::max)));
        }
        Passed {
            waypoints: points.to_vec(),
            leg_times: profile.legs.iter().map(|leg| leg.duration).collect(),
            witness: profile.into(),
        }
    });
    let model = "the boat in the current that is known, bow into its motion at every waypoint; without wind and waves";
    Passage { legs, witness, broken, estimated: Vec::new(), model: model.into(), afloat: true }
}

/// The states that waypoint `number` may be passed in.
///
/// One where it rests or a speed is demanded (the smaller of both legs'), else [`SHARES`] of the top speed.
///
/// The direction is that of the bisector of both legs, or of the leg that goes on where that turns straight back. In
/// still water a boat at rest keeps its bow along the bisector.
fn states(judge: &BoatJudge, asked: &Demands, number: usize) -> Vec<Reached> {
    let points = asked.waypoints;
    let reached = |end: BoatEnd| Reached { end, cost: 0.0, from: None };
    if number == 0 || number + 1 == points.len() {
        return vec![reached(judge.end(&points[number], [0.0; 2]))];
    }
    let unit = |from: usize| (points[from + 1] - points[from]).xy().try_normalize(1e-9).unwrap_or_else(Vector2::x);
    let (before, after) = (unit(number - 1), unit(number));
    let along = (before + after).try_normalize(1e-6).unwrap_or(after);
    let demanded = [asked.speed(number - 1), asked.speed(number)].into_iter().flatten().reduce(f64::min);
    let speeds = match demanded {
        _ if asked.rests(number) => vec![0.0],
        Some(speed) => vec![speed],
        None => SHARES.map(|share| share * judge.top_speed()).to_vec(),
    };
    let passing = |speed: f64| {
        let (place, velocity): (_, [f64; 2]) = (&points[number], (along * speed).into());
        // At rest in still water both legs have it along the bend.
        let still = || BoatEnd { heading: Some(libm::atan2(along.y, along.x)), ..judge.end(place, velocity) };
        judge.between(place, velocity).unwrap_or_else(still)
    };
    speeds.into_iter().map(|speed| reached(passing(speed))).collect()
}

/// The legs along the quickest chain of `table`.
///
/// Backwards from the quickest state of the last column; the sum of leg times is least among all chains of these states
/// and times.
fn joined(mut table: Vec<Vec<Reached>>) -> Profile {
    let (mut legs, mut at) = (Vec::new(), None);
    while let Some(mut states) = table.pop() {
        let quickest = states.iter().enumerate().min_by(|a, b| a.1.cost.total_cmp(&b.1.cost));
        let Some(index) = at.or(quickest.map(|(index, _)| index)) else { break };
        let Some((before, leg)) = states.swap_remove(index).from else { break };
        legs.push(leg);
        at = Some(before);
    }
    legs.reverse();
    Profile { legs }
}

/// What no boat can do on leg `leg`, or at the waypoint that it leads to.
///
/// `None` where nothing is: waypoints outside, too near to a keep-out, or a speed beyond the limit of speeds. What the
/// boat itself can keep up is no proof, as a current may be behind it: there a trip is looked for.
fn proven(setup: &BoatSetup, asked: &Demands, leg: usize) -> Option<Broken> {
    let broken = |waypoint, leg, limit, unit, excess, words| {
        Some(Broken { waypoint, leg, limit, unit, excess, certainty: Certainty::Proven, words })
    };
    let ends = if leg == 0 { &[0, 1][..] } else { &[leg + 1][..] };
    for waypoint in ends {
        let place: &Point3<f64> = &asked.waypoints[*waypoint];
        if is_free(setup, place) {
            continue;
        }
        let world = &setup.scenario.world;
        let outside = (0..2).map(|axis| {
            let margin = world.keep_in_margin_m;
            (margin - place[axis]).max(place[axis] - (world.size_m[axis] - margin))
        });
        let outside = outside.fold(f64::NEG_INFINITY, f64::max);
        if outside > 0.0 {
            let words =
                format!("it lies {} m outside of what the edges and their margin leave", decimals::beyond(outside));
            return broken(*waypoint, None, "cage", "m", Some(outside), words);
        }
        let near = setup.boat.radius - setup.keep_out.distance(place.x, place.y);
        let words = format!("it lies {} m too near to a place to keep out of", decimals::beyond(near));
        return broken(*waypoint, None, "clearance", "m", Some(near), words);
    }
    let (speed, most) = (asked.speed(leg)?, setup.scenario.generate.limits.max_speed_m_s?);
    let words = format!("{speed} m/s are demanded, {most} m/s is the most");
    let over = speed > most * (1.0 + ROUNDING);
    if over { broken(leg + 1, Some(leg), "speed", "m/s", Some(speed - most), words) } else { None }
}

/// A leg that none was found for.
///
/// By the last judgement that failed: other states break other limits.
///
/// The excess is ≥ 0, in the unit of the limit; 0 where the last try was only not proven.
fn refused(leg: usize, why: &BoatInfeasible) -> Broken {
    let (limit, unit) = match why.limit() {
        BoatLimit::Speed => ("speed", "m/s"),
        BoatLimit::Surge | BoatLimit::Sway => ("thrust", "N"),
        BoatLimit::Yaw => ("yaw moment", "N·m"),
        BoatLimit::Waters => ("cage", "m"),
        BoatLimit::KeepOut => ("clearance", "m"),
        BoatLimit::Duration => ("duration", "s"),
    };
    let (excess, words) = match *why {
        BoatInfeasible::Violates { at, margin, .. } => (
            -margin,
            format!(
                "no trip was found: the last one tried breaks the {limit} by {:.3} {unit} after {at:.1} s",
                -margin
            ),
        ),
        BoatInfeasible::Unproven { at, .. } => (
            0.0,
            format!("no trip was found: of the last one tried the {limit} could not be shown to hold at {at:.1} s"),
        ),
    };
    let certainty = Certainty::NotFound;
    Broken { waypoint: leg + 1, leg: Some(leg), limit, unit, excess: Some(excess), certainty, words }
}
