//! One graph of ground waypoints, from its number to its plans.
//!
//! A node is a waypoint with a heading, passed with straight wheels; a leg a boundary-value drive between two, solved
//! when a search first asks and then kept. The four reach sets differ in what a leg is: a drive (`witness`), or a
//! straight line (`none`, `sphere`, `hull`).

use std::f64::consts::PI;

use nalgebra::Point3;

use super::DriveSetup;
use super::ask::{Asked, Graph, ask, beside};
use super::legs::count;
use super::stepwise::Stepwise;
use super::surround::{coordinates, put};
use crate::campaign::graph::{
    Counter, Executions, Looped, Outcome, Plan, Remembered, Surroundings, Wanted, into_unit_ball, learned,
};
use crate::campaign::kind::Solver;
use crate::campaign::learn::AnyScore;
use crate::campaign::scenario::{GroundReach, Manoeuvre, SearchMethod, SearchSection};
use crate::campaign::{Evidence, Stop};
use crate::feasibility::reach::drive::{
    DriveDraft, DriveLegs, DriveLimits, DriveRoadmap, DriveSettings, DriveSite, GroundSampling, GroundScore,
    LegRefusal, Manoeuvres, sample_ground, stands,
};
use crate::feasibility::steering::shooting::families;
use crate::math::random::{Stream, named_seed};
use crate::search::{Found, Score};
use crate::trajectory::{Drive, Passing};
use crate::world::terrain::Terrain;

/// Waypoints at a leg's distance that each waypoint has, about: the disc that waypoints are spread over follows from
/// it.
/// With fewer, chains break off; with more, legs are solved that no trajectory takes.
///
/// Area of the disc = waypoints · π (l₁² − l₀²)/12, of which a ring of radii l₀ and l₁ around a waypoint in the middle
/// holds 12 others on the average; near the rim it is fewer.
const NEIGHBOURS: f64 = 12.0;
/// The ground's part in what learned scores see.
///
/// The same two terms whatever is learned, so that a model's inputs mean the same in every campaign.
const LEARNED_FROM: &str = "slope+slip";

/// The part of a search that is the same for every graph.
///
/// One for all graphs. Holds no legs but those that rounds of an adaptive search come back to.
pub(super) struct DriveSolver<'a> {
    /// Its planner's vehicle drives the legs.
    pub(super) setup: &'a DriveSetup,
    /// Of all graphs; the seed of what waypoints draw is set for each graph.
    pub(super) settings: DriveSettings,
    /// The scenario's section of the search, with defaults filled in.
    pub(super) search: SearchSection,
    /// The reach set, where it is another than `witness`.
    pub(super) stepwise: Option<Stepwise<'a>>,
    /// Of the graphs that rounds come back to.
    remembered: Remembered<DriveLegs>,
}

impl<'a> DriveSolver<'a> {
    /// # Errors
    /// Why nothing can be searched, in a sentence's part.
    ///
    /// The scenario's settings are no settings of legs, as an unknown score; or the hull's inputs give none.
    pub(super) fn new(setup: &'a DriveSetup) -> Result<Self, String> {
        let settings = settings(setup)?;
        let stepwise = match setup.scenario.generate.reach {
            GroundReach::Witness => None,
            GroundReach::None | GroundReach::Sphere | GroundReach::Hull => Some(Stepwise::new(setup)?),
        };
        let search = setup.scenario.generate.search.section();
        Ok(Self { setup, settings, search, stepwise, remembered: Remembered::default() })
    }

    /// Whether the wheels can go at the commanded speed, and drives may begin at the task's start and end at its end:
    /// no leg leaves or comes to where the vehicle cannot stand, of no graph. Headings at the end are free, so that
    /// of it only keep-outs decide.
    ///
    /// # Errors
    /// Why they may not, in a sentence's part.
    pub(super) fn may_go(&self) -> Result<(), String> {
        let (start, end) = (self.setup.start(), self.setup.scenario.task.end_m);
        if let (None, Some([turns, most])) = (&self.stepwise, self.setup.wheels_beyond(self.setup.speed())) {
            return Err(format!(
                "straight ahead at {} m/s a wheel turns at {turns:.4} rad/s, and `robot.wheels.speed_rad_s` is {most}",
                self.setup.speed()
            ));
        }
        let refused = |why: LegRefusal| format!("already at `task.start` drives {}", why.says());
        let precision = match &self.stepwise {
            None => {
                stands(&self.site(), &self.settings, &start).map_err(refused)?;
                self.settings.solver.precision.position
            }
            Some(_) => {
                self.keeps_out("task.start", [start.x, start.y], 0.0)?;
                0.0
            }
        };
        end.map_or(Ok(()), |end| self.keeps_out("task.end_m", end, precision))
    }

    /// Whether legs may come to `place` or leave it, of which they end within `precision` (m): all of them keep the
    /// vehicle's radius from every keep-out.
    fn keeps_out(&self, key: &str, place: [f64; 2], precision: f64) -> Result<(), String> {
        let DriveSite { keep_outs, radius, .. } = self.site();
        let near = keep_outs.nearest(place[0], place[1]).filter(|near| near.distance < radius - precision);
        near.map_or(Ok(()), |near| {
            let (name, by) = (&near.keep_out.name, near.distance);
            let is = if by < 0.0 { format!("{:.3} m inside", -by) } else { format!("{by:.3} m from") };
            Err(format!(
                "`{key}` is {is} `{name}`, and no drive comes nearer to it than {radius:.3} m, the vehicle's radius"
            ))
        })
    }

    /// `plan` over `points`, as many as its own, by the same reach set; heights are the ground's, and only legs with a
    /// moved end are solved again. `None` where they are not feasible.
    ///
    /// Passings (heading, direction, speed) go along with their waypoints.
    ///
    /// At most two legs are solved for each waypoint that moved. Headings, directions of travel and wishes of speed are
    /// the old ones, so that a small move is a small change of the drive; what is not feasible so is given up, not
    /// searched anew.
    fn moved(&self, graph: u64, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        let on_ground = |p: &Point3<f64>| Some(Point3::new(p.x, p.y, self.setup.map.patch(p.x, p.y).ok()?.height));
        let waypoints: Vec<Point3<f64>> = points.iter().map(on_ground).collect::<Option<_>>()?;
        if let Some(stepwise) = &self.stepwise {
            return stepwise.planned(plan, waypoints);
        }
        let settings = self.settings_of(named_seed(self.setup.scenario.seed, "roadmap", graph));
        let mut draft = DriveDraft::of(plan.witness.as_ref()?.commands()?, &settings);
        if draft.waypoints() != waypoints.len() {
            return None;
        }
        for (index, place) in waypoints.iter().enumerate() {
            draft.pass(index, draft.passing(index).moved_to(place));
        }
        Some(along(plan, waypoints, draft.driven(&self.site(), &settings)?))
    }

    /// The drive over waypoints passed as `passings` say, in order, solved as one of graph number `graph` is.
    ///
    /// Seeds of the graph decide what headings and directions are tried, so that a case is planned again as it was.
    pub(super) fn through(&self, graph: u64, passings: &[Passing]) -> Option<Drive> {
        let settings = self.settings_of(named_seed(self.setup.scenario.seed, "roadmap", graph));
        DriveDraft::new(passings, &settings).driven(&self.site(), &settings)
    }

    /// What legs may do, with what waypoints draw by their numbers drawn from `seed`.
    pub(super) fn settings_of(&self, seed: u64) -> DriveSettings {
        DriveSettings { seed, ..self.settings.clone() }
    }

    /// Counts what becomes of the candidates for legs near the start of graph number `graph`.
    ///
    /// Waypoints that cannot be sampled count for nothing. With `witness` every leg near the start is solved.
    pub(super) fn count(&self, graph: u64, counter: &mut Counter) {
        let [of_points, of_roadmap] = self.seeds_of(graph);
        let Ok(points) = self.sample(of_points, &|| false) else { return };
        match &self.stepwise {
            Some(stepwise) => stepwise.count(&points, counter),
            None => {
                let (length, ends) =
                    (self.setup.scenario.task.length as usize, self.setup.scenario.task.end_m.is_some());
                count(&self.roadmap(of_roadmap, &points), &points, length, ends, counter);
            }
        }
    }

    /// Seeds of the waypoints of graph number `graph`, and of its roadmap.
    ///
    /// Both are pure functions of the scenario's seed and the number: graphs may be made in any order, on any thread.
    fn seeds_of(&self, graph: u64) -> [u64; 2] {
        ["graph", "roadmap"].map(|label| named_seed(self.setup.scenario.seed, label, graph))
    }

    /// Start, free waypoints and, if there is one, the end.
    ///
    /// n free waypoints in a disc of area n π (l₁² − l₀²) / 12 with l₀ and l₁ the leg's least and greatest length, so
    /// that each has about 12 others at a leg's distance; around the middle of both ends, and never so small that the
    /// ends lie outside.
    ///
    /// # Errors
    /// Why there are fewer, in a sentence's part; also once it is `over`.
    pub(super) fn sample(&self, seed: u64, over: &dyn Fn() -> bool) -> Result<Vec<Point3<f64>>, String> {
        let task = &self.setup.scenario.task;
        let [low, high] = task.leg_m;
        let start = [task.start.x_m, task.start.y_m];
        let area = self.search.waypoints as f64 * PI * (high * high - low * low) / NEIGHBOURS;
        let (center, apart) = match task.end_m {
            Some(end) => {
                let middle = [0.5 * (start[0] + end[0]), 0.5 * (start[1] + end[1])];
                (middle, 0.5 * libm::hypot(end[0] - start[0], end[1] - start[1]))
            }
            None => (start, 0.0),
        };
        let asked = GroundSampling {
            count: self.search.waypoints as usize,
            margin: self.setup.planner.suspension.outer_radius(),
            around: Some((center, libm::sqrt(area / PI).max(apart + high))),
            sampling: self.search.sampling,
            seed,
        };
        let free = sample_ground(&self.site(), &self.settings, &asked, over).map_err(|error| error.to_string())?;
        let on_ground =
            |[x, y]: [f64; 2]| Point3::new(x, y, self.setup.map.patch(x, y).map_or(0.0, |patch| patch.height));
        Ok(std::iter::once(on_ground(start)).chain(free).chain(task.end_m.map(on_ground)).collect())
    }

    /// The headed waypoints over `points`, with what they draw by their numbers drawn from `seed`.
    pub(super) fn roadmap(&self, seed: u64, points: &[Point3<f64>]) -> DriveRoadmap<'_> {
        DriveRoadmap::new(self.site(), points, &self.setup.start(), None, &self.settings_of(seed))
    }

    /// Legs that were solved are kept for the next round of an adaptive campaign. Where nothing is found the reason is
    /// what legs were refused for.
    ///
    /// The score of a leg is its `ground` unless a model was learned. The lookahead is 0: near the end the beam does
    /// not ask the reach set whether it arrives, as each leg would be a boundary-value problem.
    fn by_roadmap(&self, graph: Graph) -> Outcome {
        let points = graph.points;
        let (number, again) = (graph.graph, matches!(graph.looped.wanted, Wanted::Round(_)));
        let mut roadmap = self.roadmap(self.seeds_of(number)[1], points);
        if let Some(legs) = self.remembered.take(number) {
            roadmap = roadmap.knowing(legs);
        }
        let plan = |found: Found<_>| {
            let drive = roadmap.drive(&found.nodes)?;
            // With stops, which the search does not see before it knows what follows what.
            let leg_times = times(&drive);
            Some(Plan { leg_times, witness: Some(drive.into()), ..Plan::new(&found, points, Evidence::Witnessed) })
        };
        let score = learned(&graph.looped, &self.setup.attachments, &self.setup.scenario.generate.search.score)
            .unwrap_or(AnyScore::Named(Score::Ground));
        let also = beside(&graph.looped);
        let (reach, start) = (&roadmap, roadmap.start());
        let asked = Asked { scenario: &self.setup.scenario, graph, reach, start, score, also, lookahead: 0 };
        let mut outcome = ask(asked, &|node, steps| roadmap.may_arrive(node, steps), plan);
        if outcome.plans.is_empty() && !outcome.stopped {
            let tally = roadmap.tally();
            outcome.reason = Some(tally.to_string());
            if tally.refused(LegRefusal::Unsolved) > 0 {
                // A drive that was not found may be one.
                outcome.proven_empty = 0;
            }
        }
        if again {
            let legs = roadmap.into_legs();
            let bytes = legs.bytes();
            self.remembered.keep(number, legs, bytes);
        }
        outcome
    }

    /// With the planner's vehicle; its radius is that of the circle around its footprint.
    pub(super) fn site(&self) -> DriveSite<'_> {
        DriveSite::new(&self.setup.planner, &self.setup.map, &self.setup.keep_out)
    }
}

impl Solver for DriveSolver<'_> {
    fn solve(&self, graph: u64, executions: Executions, wanted: Wanted, stop: &Stop) -> Outcome {
        let points = match self.sample(self.seeds_of(graph)[0], stop.cancelled) {
            Ok(points) => points,
            Err(_) if (stop.cancelled)() => return Outcome { graphs: 1, stopped: true, ..Outcome::default() },
            Err(reason) => return Outcome { graphs: 1, reason: Some(reason), ..Outcome::default() },
        };
        let moved = |plan: &Plan, points: &[Point3<f64>]| self.moved(graph, plan, points);
        let asked = self.setup.scenario.generate.environment;
        let put = |plan: &Plan, place: &[f64], _| asked.map_or_else(|| plan.clone(), |asked| put(&asked, plan, place));
        let surroundings = asked.map(|asked| Surroundings {
            coordinates: coordinates(&asked),
            bound: &into_unit_ball,
            put: &put,
            obstacles: asked.obstacles.is_some(),
        });
        let looped = Looped { executions, surroundings, moved: &moved, wanted, over: stop.cancelled };
        let asked = Graph { search: &self.search, graph, points: &points, looped };
        match &self.stepwise {
            Some(stepwise) => stepwise.solve(&self.settings, asked),
            None => self.by_roadmap(asked),
        }
    }

    fn draw(&self, graph: u64, stop: &Stop) -> Result<Plan, String> {
        self.drawn(graph, stop)
    }

    fn drawn_how(&self) -> &'static str {
        "each leg alike among those that lead on from where the last one ended: drives with few ways on come more often"
    }

    fn over(&self, graph: u64, plan: &Plan, points: &[Point3<f64>]) -> Option<Plan> {
        self.moved(graph, plan, points)
    }

    fn elsewhere(&self, graph: u64, random: &mut Stream) -> Option<Point3<f64>> {
        self.place_of(graph, random)
    }

    fn crossed(&self, _: u64, plan: &Plan, other: &Plan, leg: usize, _: &mut Stream) -> Option<Plan> {
        self.joined(plan, other, leg)
    }

    fn altered(&self, plan: &Plan, leg: usize, random: &mut Stream) -> Option<Plan> {
        self.passed_otherwise(plan, leg, random)
    }
}

/// `plan` over `waypoints` along another drive. No search saw its legs.
///
/// Score, evidence and environment stay those of `plan`; a bound that was proven is dropped.
pub(super) fn along(plan: &Plan, waypoints: Vec<Point3<f64>>, drive: Drive) -> Plan {
    let leg_times = times(&drive);
    Plan { waypoints, leg_times, seen: Vec::new(), witness: Some(drive.into()), bound: None, ..plan.clone() }
}

/// Durations of the legs, s.
///
/// As each leg is driven within the whole drive, stops included.
fn times(drive: &Drive) -> Vec<f64> {
    (0..drive.legs.len()).map(|leg| drive.leg_time(leg)).collect()
}

/// The ways of driving that the scenario allows, of those that the vehicle has.
pub(super) fn allowed(setup: &DriveSetup) -> Manoeuvres {
    let may = |manoeuvre| setup.scenario.generate.manoeuvres.contains(&manoeuvre);
    Manoeuvres {
        forward: may(Manoeuvre::Forward),
        reverse: may(Manoeuvre::Reverse),
        turn_in_place: may(Manoeuvre::TurnInPlace) && setup.rover.limits.turns_in_place,
    }
}

/// What legs may do, and how hard they are looked for.
///
/// Speed, rate of turns, bounds, tilt and pace are the setup's; a turn in place is allowed only where the robot can. A
/// clearance of the underside that is not given is −∞: not asked.
///
/// # Errors
/// A score of legs that has an unknown term, in a sentence's part.
pub(super) fn settings(setup: &DriveSetup) -> Result<DriveSettings, String> {
    let (task, generate) = (&setup.scenario.task, &setup.scenario.generate);
    let settings = DriveSettings {
        leg_m: task.leg_m,
        headings: generate.headings as usize,
        speed: setup.speed(),
        turn_rate: setup.turn_rate(),
        manoeuvres: allowed(setup),
        bounds: setup.bounds(),
        limits: DriveLimits {
            tilt: setup.tilt(),
            joint: setup.rover.limits.joint,
            clearance: generate.limits.belly_clearance_m.unwrap_or(f64::NEG_INFINITY),
            wheels: true,
        },
        solver: setup.leg_solver(),
        flat: setup.flat_solver(),
        families: families::Settings {
            starts: generate.solver.starts.min(u64::from(u32::MAX)) as u32,
            ..families::Settings::default()
        },
        pace: setup.pace(),
        control: generate.control.control(),
        directions: setup.directions(),
        score: ground_score(setup)?,
        ..DriveSettings::of(&setup.planner)
    };
    Ok(settings)
}

/// What a leg's `ground` is: the score that is named or, as an input of a learned one, slope and slip.
///
/// A score of a file, a program of the user's and an adaptive search see [`LEARNED_FROM`]; all others the score by
/// name.
///
/// # Errors
/// The unknown terms, in a sentence's part.
fn ground_score(setup: &DriveSetup) -> Result<GroundScore, String> {
    let (search, files) = (&setup.scenario.generate.search, &setup.attachments);
    let of_file = files.model(&search.score).is_some() || files.user_score(&search.score).is_some();
    let learned = of_file || search.method == SearchMethod::Adaptive;
    let name = if learned { LEARNED_FROM } else { search.score_of_legs() };
    GroundScore::named(name).map_err(|error| error.to_string())
}
