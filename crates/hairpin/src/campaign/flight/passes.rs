//! Missions made elsewhere, by the claim of flights: a witness through their waypoints at the speeds that they demand,
//! or the limits that break.
//!
//! | found | certainty |
//! | --- | --- |
//! | a place outside of the free space, an obstacle on the straight line, speeds or turns beyond limits | proven |
//! | no profile between two stops, though all leg times and velocities were tried | not found |
//!
//! Sections from rest to rest are independent: each is flown or refused by itself, so that all that breaks is told at
//! once.

use nalgebra::Point3;

use super::FlightSetup;
use super::estimated::doubt;
use super::legs::judge_up_to;
use crate::campaign::bounds::LONGEST_LEG_S;
use crate::campaign::passage::{Broken, Certainty, Demands, Passage, Passed, PassedLeg};
use crate::feasibility::certify::{Certificate, Impossible, certify};
use crate::feasibility::hold::{fastest, hold, turns_too_hard};
use crate::feasibility::steering::{LegJudge, LegTiming};
use crate::feasibility::{Infeasible, Limit};
use crate::math::decimals;
use crate::trajectory::{Profile, ProfileLeg};

/// The shortest leg time that is tried where no speed is demanded, s.
///
/// From here a ladder of ratio 1.2 goes to the longest leg time of the program.
const SHORTEST_LEG_S: f64 = 0.05;
/// Instants of a leg at which its speed is looked at.
/// For what is told, not for what is held: speeds are bounded by the judge between instants too.
///
/// Even in time: 65 instants, both ends included. Between two of them the speed may be a little higher.
const INSTANTS: u32 = 64;
/// A speed within this share of the limit keeps it.
const ROUNDING: f64 = 1e-9;

/// What the claim says of `asked`.
///
/// # Errors
/// As [`judge_up_to`].
///
/// `asked` has waypoints in m, speeds in m/s where some are demanded, and stops. The witness is that of the whole
/// mission; there is none if a single leg breaks.
///
/// Sections are those between stops. `estimated` are the keys that were not given and that a refusal rests on, sorted,
/// each once; such a refusal is not proven any more.
pub(super) fn passes(setup: &FlightSetup, asked: &Demands) -> Result<Passage, String> {
    // What a mission asks for is held to the robot's top speed as well.
    let judge = judge_up_to(setup, setup.robot.max_speed)?;
    let looked = Looked { setup, judge: &judge, asked };
    let mut legs: Vec<PassedLeg> = asked.waypoints.windows(2).map(|pair| looked.alone(pair)).collect();
    for (number, leg) in legs.iter_mut().enumerate() {
        leg.broken = looked.proven(number);
    }
    let mut flight: Vec<ProfileLeg> = Vec::new();
    let mut broken = None;
    for [first, last] in asked.sections() {
        match looked.section(first, last) {
            Ok(profile) => {
                for (leg, piece) in legs[first..last].iter_mut().zip(&profile.legs) {
                    (leg.time, leg.top_speed) = (Some(piece.duration), Some(top_speed(piece)));
                }
                flight.extend(profile.legs);
            }
            Err(refused) => {
                for one in refused {
                    let leg = one.leg.unwrap_or(last - 1);
                    legs[leg].broken.get_or_insert(one);
                }
            }
        }
    }
    let mut estimated = Vec::new();
    for broken in legs.iter_mut().filter_map(|leg| leg.broken.as_mut()) {
        estimated.extend(doubt(setup, broken));
    }
    estimated.sort_unstable();
    estimated.dedup();
    let whole = flight.len() == legs.len() && legs.iter().all(|leg| leg.broken.is_none());
    let flight = Profile { legs: flight };
    if let Some(most) = setup.scenario.generate.limits.max_flight_time_s.filter(|_| whole) {
        broken = too_long(asked, flight.duration(), most);
    }
    let witness = (whole && broken.is_none()).then(|| Passed {
        waypoints: asked.waypoints.to_vec(),
        leg_times: flight.legs.iter().map(|leg| leg.duration).collect(),
        witness: flight.into(),
    });
    Ok(Passage { legs, witness, broken, estimated, model: model(), afloat: false })
}

/// Flying for `duration` (s) and waiting where it is asked to takes more than `most` (s).
///
/// What waits alone take is sure; that no flight is quicker is not.
///
/// `None` where it is not. `hold` is the sum of all waits, s, infinite where one has no end.
fn too_long(asked: &Demands, duration: f64, most: f64) -> Option<Broken> {
    let time = duration + asked.hold;
    if time <= most {
        return None;
    }
    let waits = match asked.hold {
        0.0 => String::new(),
        hold if hold.is_finite() => format!(" and waits {hold:.1} s, {time:.1} s together"),
        _ => " and waits until it is told to go on".into(),
    };
    let sure = asked.hold.is_finite() && asked.hold > most;
    Some(Broken {
        waypoint: asked.waypoints.len() - 1,
        leg: None,
        limit: "duration",
        unit: "s",
        excess: Some(time - most).filter(|excess| excess.is_finite()),
        certainty: if sure { Certainty::Proven } else { Certainty::NotFound },
        words: format!("the flight takes {duration:.1} s{waits}, {most} s at most"),
    })
}

fn model() -> String {
    "the rigid body with drag, level at every waypoint; without wind and without the lag of its rotors".into()
}

/// What is looked at.
///
/// The judge's limit of speed is the smaller of the scenario's and the robot's.
struct Looked<'a> {
    setup: &'a FlightSetup,
    judge: &'a LegJudge,
    asked: &'a Demands<'a>,
}

impl Looked<'_> {
    /// A leg by itself.
    ///
    /// From rest to rest: its least time, and the limit that is nearest there.
    ///
    /// `fastest` and `nearest` are `None` where no time up to the longest leg has a flight. How near is told without a
    /// sign, in the unit of [`named`].
    fn alone(&self, pair: &[Point3<f64>]) -> PassedLeg {
        let found = fastest(self.judge, &pair[0], &pair[1], LONGEST_LEG_S);
        let nearest = found.map(|(_, why)| {
            let (limit, unit, factor) = named(why.limit());
            (limit, factor * margin(&why).abs(), unit)
        });
        PassedLeg {
            length: (pair[1] - pair[0]).norm(),
            fastest: found.map(|(time, _)| time),
            nearest,
            ..PassedLeg::default()
        }
    }

    /// What no flight can do on leg `leg`, or at the waypoint that it leads to.
    ///
    /// The first of: place, straight line, speed, turn. The straight line is a necessary test only where legs are
    /// straight; it is told as proven because missions are flown along it.
    ///
    /// Excesses are positive: m, m/s or m/s². A turn is asked only of two legs that are both passed at demanded speeds,
    /// by a bound that holds for any shape of flight ([`turns_too_hard`]).
    fn proven(&self, leg: usize) -> Option<Broken> {
        let points = self.asked.waypoints;
        let broken = |waypoint, leg, limit, unit, excess, words| {
            Some(Broken { waypoint, leg, limit, unit, excess: Some(excess), certainty: Certainty::Proven, words })
        };
        let ends = if leg == 0 { &[0, 1][..] } else { &[leg + 1][..] };
        for waypoint in ends {
            if let Err(why) = self.judge.space().allows(&points[*waypoint], 0.0) {
                let (limit, unit, _) = named(why.limit());
                let excess = -margin(&why);
                let words = match why.limit() {
                    Limit::Obstacle => {
                        format!("it lies {} m too near to {}", decimals::beyond(excess), self.obstacle(&why))
                    }
                    _ => format!(
                        "it lies {} m outside of what the walls and their margin leave",
                        decimals::beyond(excess)
                    ),
                };
                return broken(*waypoint, None, limit, unit, excess, words);
            }
        }
        let radius = self.setup.robot.clearance_radius;
        let clear = self.setup.world.segment_distance(&points[leg], &points[leg + 1]) - radius;
        if clear < 0.0 {
            let words = format!("its straight line comes {} m too near to an obstacle", decimals::beyond(-clear));
            return broken(leg + 1, Some(leg), "clearance", "m", -clear, words);
        }
        let speed = self.asked.speed(leg)?;
        let most = self.judge.top_speed();
        if speed > most * (1.0 + ROUNDING) {
            let words = format!("{speed} m/s are demanded, {most} m/s is the most");
            return broken(leg + 1, Some(leg), "speed", "m/s", speed - most, words);
        }
        let passed = |leg: usize| !self.asked.rests(leg) && !self.asked.rests(leg + 1);
        let before = leg.checked_sub(1).filter(|before| passed(*before) && passed(leg))?;
        let speeds = [self.asked.speed(before)?, speed];
        let excess = turns_too_hard(self.judge, [&points[before], &points[leg], &points[leg + 1]], speeds)?;
        let words = format!(
            "to turn there at {speed} m/s takes {} m/s² more than thrust, tilt and drag give",
            decimals::beyond(excess)
        );
        broken(leg, Some(leg), "thrust", "m/s²", excess, words)
    }

    /// The flight from rest at waypoint `first` to rest at `last`, or what is not known to be flown.
    ///
    /// Where speeds are demanded they are held ([`hold`]); else the quick way is tried first, then [`certify`], which
    /// may also prove that there is none. Indices in answers are those of the mission.
    fn section(&self, first: usize, last: usize) -> Result<Profile, Vec<Broken>> {
        let (points, speeds) = (&self.asked.waypoints[first..=last], &self.asked.speeds[first..last]);
        let longest = self.setup.scenario.generate.limits.max_flight_time_s.unwrap_or(f64::INFINITY);
        let held = hold(self.judge, points, speeds, LONGEST_LEG_S);
        if speeds.iter().any(Option::is_some) {
            return held.map_err(|legs| legs.iter().map(|(leg, why)| self.refused(first + leg, why)).collect());
        }
        // Where nothing is demanded and that finds none, all leg times are tried, and what no flight can do is known.
        if let Ok(flight) = held
            && flight.duration() <= longest
        {
            return Ok(flight);
        }
        let timing = LegTiming::ladder(SHORTEST_LEG_S, LONGEST_LEG_S);
        let sure = |waypoint, leg, limit, unit, excess, words| {
            let certainty = Certainty::Proven;
            Err(vec![Broken { waypoint, leg, limit, unit, excess: Some(excess), certainty, words }])
        };
        match certify(self.judge, points, &timing, longest) {
            Certificate::Yes(profile) => Ok(profile),
            Certificate::Unknown { leg, why } => Err(vec![self.refused(first + leg, &why)]),
            Certificate::No(Impossible::Waypoint { waypoint, why }) => {
                let (limit, unit, factor) = named(why.limit());
                let excess = -factor * margin(&why);
                sure(first + waypoint, None, limit, unit, excess, "it is not in the free space".into())
            }
            Certificate::No(Impossible::Distance { leg, needed }) => {
                let excess = needed - self.judge.limits().max_speed;
                let words = format!("no leg takes longer than {LONGEST_LEG_S} s, and this one needs {needed:.2} m/s");
                sure(first + leg + 1, Some(first + leg), "speed", "m/s", excess, words)
            }
            Certificate::No(Impossible::Duration { needed, allowed }) => {
                let words = format!("it takes {needed:.1} s at least, {allowed:.1} s at most");
                sure(last, None, "duration", "s", needed - allowed, words)
            }
        }
    }

    /// A leg that no flight was found for.
    ///
    /// The numbers are those of the last leg that was tried, not of the best: how much the limit is broken by says
    /// where to look, not what would do.
    fn refused(&self, leg: usize, why: &Infeasible) -> Broken {
        let (limit, unit, factor) = named(why.limit());
        let told = match why.limit() {
            Limit::Obstacle => format!("{limit} to {}", self.obstacle(why)),
            Limit::RotorMin => "least rotor speed".into(),
            _ => limit.to_owned(),
        };
        let excess = -factor * margin(why);
        let words = match why {
            Infeasible::Violates { at, .. } => {
                format!(
                    "no flight was found: the last one tried breaks the {told} by {excess:.3} {unit} after {at:.2} s"
                )
            }
            Infeasible::Unproven { at, .. } => {
                format!("no flight was found: of the last one tried the {told} could not be shown to hold at {at:.2} s")
            }
        };
        let certainty = Certainty::NotFound;
        Broken { waypoint: leg + 1, leg: Some(leg), limit, unit, excess: Some(excess.max(0.0)), certainty, words }
    }

    fn obstacle(&self, why: &Infeasible) -> &str {
        let (Infeasible::Violates { part, .. } | Infeasible::Unproven { part, .. }) = *why;
        self.setup.world.obstacles().get(usize::from(part)).map_or("an obstacle", |obstacle| &obstacle.name)
    }
}

/// What a limit is called here, the unit that it is told in, and the factor to that.
///
/// Units are those of what is told, SI but for degrees.
///
/// Margins are in the limit's own unit; the factor takes rad to ° and leaves the rest.
fn named(limit: Limit) -> (&'static str, &'static str, f64) {
    match limit {
        Limit::Speed => ("speed", "m/s", 1.0),
        Limit::Thrust => ("thrust", "of the weight", 1.0),
        Limit::Tilt => ("tilt", "°", 180.0 / std::f64::consts::PI),
        Limit::RotorMin | Limit::RotorMax => ("rotor speed", "rad/s", 1.0),
        Limit::World => ("cage", "m", 1.0),
        Limit::Obstacle => ("clearance", "m", 1.0),
        Limit::Duration => ("duration", "s", 1.0),
    }
}

/// In the limit's own unit; negative where it is broken.
fn margin(why: &Infeasible) -> f64 {
    let (Infeasible::Violates { margin, .. } | Infeasible::Unproven { margin, .. }) = *why;
    margin
}

/// The greatest speed on a leg, m/s.
fn top_speed(leg: &ProfileLeg) -> f64 {
    let at = |k: u32| leg.derivative(leg.duration * f64::from(k) / f64::from(INSTANTS), 1).norm();
    (0..=INSTANTS).map(at).fold(0.0, f64::max)
}
