//! Missions made elsewhere, by the claim of drives: boundary-value drives through their waypoints, or the limits that
//! break.
//!
//! Legs are solved among their neighbours, as headings at waypoints are free and join them. What refuses a leg is one
//! reason of [`LegRefusal`]; what it would take is found by letting that limit out step by step.

use nalgebra::Point3;

use super::DriveSetup;
use super::solve::{DriveSolver, settings};
use crate::campaign::passage::{Broken, Certainty, Demands, Passage, Passed, PassedLeg};
use crate::feasibility::reach::drive::{DriveSettings, LegRefusal, Through, through};
use crate::math::decimals;
use crate::robot::rover::Suspension;
use crate::world::terrain::Terrain;

/// Factors by which a limit is let out to see how much of it a leg would need.
/// The least that helps is told as the excess, so that it is too large by a step at most.
///
/// At most eight questions of up to three legs each for every leg that is refused.
const LET_OUT: [f64; 8] = [1.1, 1.25, 1.5, 2.0, 3.0, 5.0, 8.0, 16.0];
/// A speed within this share of the limit keeps it.
const ROUNDING: f64 = 1e-9;

/// What the claim says of `asked`; heights are the ground's.
///
/// # Errors
/// As of a search.
///
/// Heights of `asked` are not looked at. Speeds above the limit are proven to break; the rest is not found, never
/// proven.
///
/// Leg lengths of the task do not bind: the mission is not of this scenario's making. `witness` is there only if every
/// leg is one and their speeds settle; then leg times are those within the whole drive, where `fastest` is a leg's own.
pub(super) fn passes(setup: &DriveSetup, asked: &Demands) -> Result<Passage, String> {
    let looked = Looked { setup, asked, settings: DriveSettings { leg_m: [0.0, f64::INFINITY], ..settings(setup)? } };
    let places: Vec<[f64; 2]> = asked.waypoints.iter().map(|p| [p.x, p.y]).collect();
    let count = places.len() - 1;
    let proven: Vec<Option<Broken>> = (0..count).map(|leg| looked.proven(leg)).collect();
    let solver = DriveSolver::new(setup)?;
    let of_leg = |leg: usize| looked.settings_of(leg);
    // Where a place is none, no leg to it is looked for.
    let Through { legs: solved, drive } = if proven.iter().flatten().any(|broken| broken.leg.is_none()) {
        Through { legs: vec![Err(LegRefusal::Unsolved); count], drive: None }
    } else {
        through(&solver.site(), &of_leg, &places, asked.stops)
    };
    let misplaced = proven.iter().flatten().any(|broken| broken.leg.is_none());
    let mut legs = Vec::with_capacity(count);
    for (leg, (proven, solved)) in proven.into_iter().zip(solved).enumerate() {
        let [a, b] = [places[leg], places[leg + 1]];
        let length = libm::hypot(b[0] - a[0], b[1] - a[1]);
        let mut one = PassedLeg { length, ..PassedLeg::default() };
        match solved {
            Ok(solved) => {
                let most = looked.settings.bounds.most;
                one.fastest = Some(solved.duration);
                one.top_speed = Some(looked.settings_of(leg).speed);
                one.nearest = most.is_finite().then_some(("curvature", most - solved.curvature, "1/m"));
                one.broken = proven;
            }
            Err(_) if misplaced => one.broken = proven,
            Err(why) => one.broken = proven.or_else(|| Some(looked.refused(leg, why, &places))),
        }
        legs.push(one);
    }
    let whole = legs.iter().all(|leg| leg.broken.is_none());
    let witness = drive.filter(|_| whole).and_then(|drive| {
        let leg_times: Vec<f64> = (0..count).map(|leg| drive.leg_time(leg)).collect();
        let waypoints = asked.waypoints.iter().map(|p| looked.on_ground(p)).collect::<Option<_>>()?;
        Some(Passed { waypoints, leg_times, witness: drive.into() })
    });
    let mut broken = None;
    if let Some(passed) = &witness {
        for (leg, time) in legs.iter_mut().zip(&passed.leg_times) {
            leg.time = Some(*time);
        }
    } else if whole && looked.speeds_are_alike() {
        broken = Some(Broken {
            waypoint: count,
            leg: None,
            limit: "speed",
            unit: "m/s",
            excess: None,
            certainty: Certainty::NotFound,
            words: "each leg is one, but their commands and speeds do not settle together".into(),
        });
    }
    Ok(Passage { legs, witness, broken, estimated: Vec::new(), model: model(setup), afloat: false })
}

fn model(setup: &DriveSetup) -> String {
    let ground = match setup.rover.suspension {
        Suspension::Level if setup.leaves_slopes_out => "the vehicle in the plane, without the map's slopes",
        Suspension::Level => "the vehicle in the plane",
        _ => "the vehicle settled on the ground at every step",
    };
    format!(
        "{ground}, waypoints passed with straight wheels; without slip that the plan does not know, latency or wind"
    )
}

/// What is looked at.
///
/// `settings` with leg lengths of 0 to infinity.
struct Looked<'a> {
    setup: &'a DriveSetup,
    asked: &'a Demands<'a>,
    settings: DriveSettings,
}

impl Looked<'_> {
    /// Settings of leg `leg`, at the speed that is demanded of it; turns in place go on as they do.
    ///
    /// m/s, at most the scenario's and the robot's limit.
    ///
    /// A demand above the scenario's commanded speed has bounds of curvature of its own speed; below, those of the
    /// commanded speed are kept, which are never wider.
    fn settings_of(&self, leg: usize) -> DriveSettings {
        let speed = self.asked.speed(leg).map_or(self.settings.speed, |speed| speed.min(self.setup.most_speed()));
        // At another speed it bends otherwise.
        let bounds = if speed > self.settings.speed { self.setup.bounds_at(speed) } else { self.settings.bounds };
        DriveSettings { speed, bounds, ..self.settings.clone() }
    }

    /// A whole drive has one commanded speed; of legs that differ none is made, which is no refusal.
    fn speeds_are_alike(&self) -> bool {
        let speeds: Vec<f64> = (0..self.asked.waypoints.len() - 1).map(|leg| self.settings_of(leg).speed).collect();
        speeds.windows(2).all(|pair| pair[0] == pair[1])
    }

    fn on_ground(&self, place: &Point3<f64>) -> Option<Point3<f64>> {
        Some(Point3::new(place.x, place.y, self.setup.map.patch(place.x, place.y).ok()?.height))
    }

    /// What nothing can do on leg `leg`, or at the place that it leads to.
    ///
    /// The first of: off the map, no data, keep-out, speed of the wheels, speed.
    ///
    /// `None`: nothing is known to be impossible. Leg 0 answers for the first waypoint too, so that each is asked about
    /// once.
    fn proven(&self, leg: usize) -> Option<Broken> {
        let broken = |waypoint, leg, limit, unit, excess, words| {
            Some(Broken { waypoint, leg, limit, unit, excess, certainty: Certainty::Proven, words })
        };
        let ends = if leg == 0 { &[0, 1][..] } else { &[leg + 1][..] };
        for waypoint in ends {
            let place = &self.asked.waypoints[*waypoint];
            let ([west, south], [east, north]) = self.setup.map.extent();
            let beyond = (west - place.x).max(place.x - east).max(south - place.y).max(place.y - north);
            if beyond > 0.0 {
                let words = format!("it lies {} m off the map", decimals::beyond(beyond));
                return broken(*waypoint, None, "map", "m", Some(beyond), words);
            }
            if self.on_ground(place).is_none() {
                return broken(*waypoint, None, "map", "m", None, "the map has no data there".into());
            }
            let radius = self.setup.radius();
            if let Some(nearest) = self.setup.keep_out.nearest(place.x, place.y).filter(|near| near.distance < radius) {
                let excess = radius - nearest.distance;
                let words = format!("it lies {} m too near to {}", decimals::beyond(excess), nearest.keep_out.name);
                return broken(*waypoint, None, "clearance", "m", Some(excess), words);
            }
        }
        let speed = self.settings_of(leg).speed;
        if let Some([turns, most]) = self.setup.wheels_beyond(speed) {
            let words = format!(
                "straight ahead at {speed} m/s a wheel turns at {turns:.4} rad/s, {most} rad/s (`robot.wheels.speed_rad_s`) \
                 is the most"
            );
            return broken(leg + 1, Some(leg), "wheel_speed", "rad/s", Some(turns - most), words);
        }
        let speed = self.asked.speed(leg)?;
        let most = self.setup.most_speed();
        let words = format!("{speed} m/s are demanded, {most} m/s is the most");
        let over = speed > most * (1.0 + ROUNDING);
        if over { broken(leg + 1, Some(leg), "speed", "m/s", Some(speed - most), words) } else { None }
    }

    /// A leg that no drive was found for, with how much of the limit one would need.
    ///
    /// Only curvature and slope are let out; of the others no excess is told.
    ///
    /// The excess is (f − 1) · limit with f the least factor of [`LET_OUT`] that helped; curvature and its rate are let
    /// out together. `None`: no factor helped, or the limit is not one that is let out.
    fn refused(&self, leg: usize, why: LegRefusal, places: &[[f64; 2]]) -> Broken {
        let (limit, unit) = named(why);
        let own = self.settings_of(leg);
        let with = |factor: f64| {
            let mut more = own.clone();
            match limit {
                "curvature" => {
                    (more.bounds.most, more.bounds.most_rate) =
                        (own.bounds.most * factor, own.bounds.most_rate * factor)
                }
                "slope" => more.limits.tilt = own.limits.tilt * factor,
                _ => return None,
            }
            Some(more)
        };
        let solved = |factor: &f64| with(*factor).is_some_and(|more| self.beside(leg, &more, places));
        let factor = LET_OUT.iter().find(|factor| solved(factor)).copied();
        let bound = if limit == "slope" { own.limits.tilt.to_degrees() } else { own.bounds.most };
        let excess = factor.map(|factor| (factor - 1.0) * bound).filter(|excess| excess.is_finite());
        let words = match excess {
            Some(excess) => format!(
                "no drive was found: drives here {}; with {excess:.3} {unit} more of it there is one",
                why.says()
            ),
            None => format!("no drive was found: drives here {}", why.says()),
        };
        Broken { waypoint: leg + 1, leg: Some(leg), limit, unit, excess, certainty: Certainty::NotFound, words }
    }

    /// Whether the leg is one among its neighbours under `more`.
    ///
    /// One leg before it and one after, so that its headings are as free as in the mission.
    fn beside(&self, leg: usize, more: &DriveSettings, places: &[[f64; 2]]) -> bool {
        let (first, last) = (leg.saturating_sub(1), (leg + 3).min(places.len()));
        let solver = DriveSolver::new(self.setup);
        solver.is_ok_and(|solver| {
            through(&solver.site(), &|_| more.clone(), &places[first..last], &[]).legs[leg - first].is_ok()
        })
    }
}

/// What a refusal is called here, and the unit that it is told in.
///
/// A detour and an unsolved leg are told as curvature, which is what is let out to solve them. A body that finds no
/// rest is told as slope; to let the tilt out does not help it, so that no excess is told.
fn named(why: LegRefusal) -> (&'static str, &'static str) {
    match why {
        LegRefusal::Detour | LegRefusal::Unsolved | LegRefusal::Curvature => ("curvature", "1/m"),
        LegRefusal::MapEdge | LegRefusal::NoData => ("map", "m"),
        LegRefusal::NoRest | LegRefusal::Tilt => ("slope", "°"),
        LegRefusal::Steering => ("steering rate", "rad/s"),
        LegRefusal::Torque => ("torque", "N·m"),
        LegRefusal::SteerAngle => ("steer_angle", "rad"),
        LegRefusal::SteerRate => ("steer_rate", "rad/s"),
        LegRefusal::WheelSpeed => ("wheel_speed", "rad/s"),
        LegRefusal::WheelAcceleration => ("wheel_acceleration", "rad/s²"),
        LegRefusal::Joint => ("joint", "°"),
        LegRefusal::Belly | LegRefusal::KeepOut => ("clearance", "m"),
    }
}
