//! The roadmap: headed waypoints of one graph and the drives between them, solved when first asked for and kept.

use std::cell::{Cell, RefCell};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use super::judge::{Ends, Solved, judge, refitted};
use super::pace::Pace;
use super::settings::{DriveSettings, DriveSite};
use super::tally::DriveTally;
use super::watch::stands;
use super::ways::Way;
use crate::feasibility::reach::{Leg, LegFeatures, Reach};
use crate::math::random::{Stream, hashed_unit, named_seed, stream, unit};
use crate::math::rotation::angle_between;
use crate::trajectory::drive::{Planar, Segment};
use crate::trajectory::{Direction, Drive, DriveLeg, Passing, SpeedProfile};

/// A node: a waypoint and one of its headings, passed with straight wheels.
///
/// Curvature is 0 at every node but the start's, so that legs join whatever comes before and after.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct DriveNode {
    /// The waypoint.
    pub waypoint: u32,
    /// Which of its headings; 0 at the start, and at the end if that has a pose of its own.
    pub heading: u32,
}

/// A solved leg and the state it leads to.
#[derive(Debug)]
struct Kept {
    state: u32,
    solved: Solved,
}

/// The legs of a [`DriveRoadmap`] that were solved so far; they serve every roadmap that is drawn alike.
#[derive(Debug)]
pub struct DriveLegs(Vec<Option<Arc<[Kept]>>>);

impl DriveLegs {
    /// Memory that they take, about.
    pub fn bytes(&self) -> usize {
        let legs = || self.0.iter().flatten().flat_map(|legs| legs.iter());
        let segments: usize = legs().map(|leg| leg.solved.segments.len()).sum();
        self.0.len() * size_of::<Option<Arc<[Kept]>>>()
            + legs().count() * size_of::<Kept>()
            + segments * size_of::<Segment>()
    }
}

/// The headed waypoints of one graph and the legs between them. One graph is one task on one thread.
///
/// A leg is a drive that the boundary-value solver found on the map: its predicted motion ends in the next waypoint's
/// pose and curvature within the solver's precision and keeps every limit of [`DriveSettings`] on the way. Its
/// [`LegFeatures`] have the speeds at both ends, the angle from the direction of travel to the straight
/// line to the next waypoint as `turn`, and the score of the settings as `ground`.
///
/// n waypoints with M headings make up to (n M)² legs, of which a search asks few. Not shared between threads: what is
/// solved lies in cells.
pub struct DriveRoadmap<'a> {
    site: DriveSite<'a>,
    settings: DriveSettings,
    points: Vec<Point3<f64>>,
    /// Directions in which the waypoints are passed, rad.
    directions: Vec<f64>,
    /// Poses of all waypoints, waypoint by waypoint.
    states: Vec<Planar>,
    /// First state of every waypoint, and the number of states.
    first: Vec<u32>,
    kept: RefCell<Vec<Option<Arc<[Kept]>>>>,
    tally: Cell<DriveTally>,
}

/// Headings that are drawn for one that stands, at most.
const DRAWS: usize = 8;
/// Rounds in which commands and their speeds are made to agree.
const ROUNDS: usize = 5;
/// One heading in so many points anywhere, the others at waypoints.
const ANYWHERE: usize = 4;

impl<'a> DriveRoadmap<'a> {
    /// The roadmap over `points`, index 0 the start: there the pose and curvature are those of `start`.
    ///
    /// Every other waypoint gets M headings in which the body stands within its limits, fewer where it does not:
    /// towards a waypoint drawn from those at a leg's distance, every fourth anywhere. With `end` the last waypoint has
    /// that pose alone.
    ///
    /// `points` in m, x and y those of nodes; z is the ground's. Nothing is solved yet. Waypoints where the body stands
    /// in no heading drawn have no node.
    pub fn new(
        site: DriveSite<'a>,
        points: &[Point3<f64>],
        start: &Planar,
        end: Option<&Planar>,
        settings: &DriveSettings,
    ) -> Self {
        let (mut states, mut first) = (Vec::new(), Vec::with_capacity(points.len() + 1));
        for (w, point) in points.iter().enumerate() {
            first.push(states.len() as u32);
            match end.filter(|_| w + 1 == points.len()) {
                _ if w == 0 => states.push(Planar { x: point.x, y: point.y, ..*start }),
                Some(end) => states.push(Planar { x: point.x, y: point.y, ..*end }),
                None => draw_headings(&site, settings, points, w, &mut states),
            }
        }
        first.push(states.len() as u32);
        let kept = RefCell::new((0..states.len()).map(|_| None).collect());
        let directions = (0..points.len()).map(|w| settings.direction_at(w)).collect();
        let (points, settings) = (points.to_vec(), settings.clone());
        Self { site, settings, points, directions, states, first, kept, tally: Cell::default() }
    }

    /// The same, with `legs` of one that was drawn alike; its tally is of those that it solves itself.
    ///
    /// # Panics
    /// If it has another number of states.
    pub fn knowing(self, legs: DriveLegs) -> Self {
        assert_eq!(legs.0.len(), self.states.len(), "legs of another roadmap");
        Self { kept: RefCell::new(legs.0), ..self }
    }

    /// The legs that were solved.
    pub fn into_legs(self) -> DriveLegs {
        DriveLegs(self.kept.into_inner())
    }

    /// The node at the start.
    pub fn start(&self) -> DriveNode {
        DriveNode { waypoint: 0, heading: 0 }
    }

    /// Number of headed waypoints.
    pub fn states(&self) -> usize {
        self.states.len()
    }

    /// Pose and curvature of a node.
    pub fn pose(&self, node: &DriveNode) -> Planar {
        self.states[self.state(node)]
    }

    /// What became of the legs that were asked for so far.
    pub fn tally(&self) -> DriveTally {
        self.tally.get()
    }

    /// A necessary test for searches that end at the last waypoint: false only if no `steps` legs lead from `node` to
    /// it. One leg is no longer than the longest, as the crow flies.
    pub fn may_arrive(&self, node: &DriveNode, steps: usize) -> bool {
        let end = self.points.len() - 1;
        if steps == 0 {
            return node.waypoint as usize == end;
        }
        // A hair more, for the rounding of sums of legs.
        self.distance(node.waypoint as usize, end) <= steps as f64 * self.settings.leg_m[1] * (1.0 + 1e-9)
    }

    /// The drive over `nodes`, with its speeds; `None` where two successive ones are no leg, and where a leg that was
    /// solved for the commanded speed has no commands for those that it really has, which lags of the steering can do.
    ///
    /// From rest to rest unless the pace is constant. At most five rounds of fitting commands to speeds.
    pub fn drive(&self, nodes: &[DriveNode]) -> Option<Drive> {
        let states: Vec<usize> = nodes.iter().map(|node| self.state(node)).collect();
        // Nothing leaves the last: its legs need not be solved.
        let leaving = &states[..states.len().saturating_sub(1)];
        let kept: Vec<Arc<[Kept]>> = leaving.iter().map(|&state| self.kept_legs(state)).collect();
        let mut legs = Vec::with_capacity(nodes.len().saturating_sub(1));
        for (pair, kept) in states.windows(2).zip(&kept) {
            let leg = kept.iter().find(|leg| leg.state as usize == pair[1])?;
            legs.push((self.ends(pair[0], pair[1]), leg.solved.way, leg.solved.segments.clone()));
        }
        self.joined(legs)
    }

    /// The drive over waypoints that are passed as `passings` say, in order, each leg solved as those of a roadmap are;
    /// `None` where one of them is no leg, or as [`Self::drive`].
    pub fn through(site: DriveSite<'a>, passings: &[Passing], settings: &DriveSettings) -> Option<Drive> {
        let points = passings.iter().map(|passing| Point3::new(passing.at.x, passing.at.y, 0.0)).collect();
        let (first, kept) = ((0..=passings.len() as u32).collect(), RefCell::default());
        let roadmap = Self {
            site,
            settings: settings.clone(),
            points,
            directions: passings.iter().map(|passing| passing.direction).collect(),
            states: passings.iter().map(|passing| passing.at).collect(),
            first,
            kept,
            tally: Cell::default(),
        };
        let leg = |from: usize| {
            let ends = roadmap.ends(from, from + 1);
            let solved = at_a_leg(settings, ends.distance).then(|| judge(&site, settings, &ends, &mut 0).ok())??;
            Some((ends, solved.way, solved.segments))
        };
        let legs: Option<Vec<_>> = (0..passings.len().saturating_sub(1)).map(leg).collect();
        roadmap.joined(legs?)
    }

    /// The drive over solved `legs`, with its speeds.
    ///
    /// `None` where commands and speeds do not settle.
    fn joined(&self, mut legs: Vec<(Ends, Way, Box<[Segment]>)>) -> Option<Drive> {
        let profiles = self.settled(&mut legs)?;
        let DriveSettings { speed, turn_rate, .. } = self.settings;
        let leg = |((ends, _, segments), speed): ((Ends, Way, Box<[Segment]>), _)| DriveLeg {
            from: *ends.from,
            to: *ends.to,
            segments: segments.into_vec(),
            speed,
            direction: ends.direction,
        };
        Some(Drive { legs: legs.into_iter().zip(profiles).map(leg).collect(), speed, turn_rate })
    }

    /// The speeds of `legs`, whose commands are fitted to them where the steering lags: other commands stop elsewhere,
    /// and so it goes on until nothing changes. `None` if that does not come to an end.
    fn settled(&self, legs: &mut [(Ends, Way, Box<[Segment]>)]) -> Option<Vec<SpeedProfile>> {
        for _ in 0..ROUNDS {
            let profiles = self.profiles(legs);
            if !self.site.rover.response.lags() || self.settings.pace == Pace::Constant {
                return Some(profiles);
            }
            let mut changed = false;
            for ((ends, way, segments), profile) in legs.iter_mut().zip(&profiles) {
                let other = refitted(&self.site, &self.settings, ends, *way, segments, profile).ok()?;
                changed |= other.is_some();
                *segments = other.unwrap_or_else(|| std::mem::take(segments));
            }
            if !changed {
                return Some(profiles);
            }
        }
        None
    }

    /// The speeds of legs that follow each other from rest to rest.
    fn profiles(&self, legs: &[(Ends, Way, Box<[Segment]>)]) -> Vec<SpeedProfile> {
        let between = legs.iter().skip(1).map(|(ends, ..)| ends.speeds[0]);
        let wishes: Vec<f64> = std::iter::once(0.0).chain(between).chain([0.0]).collect();
        let segments: Vec<&[Segment]> = legs.iter().map(|(.., segments)| segments.as_ref()).collect();
        self.settings.pace.over(self.settings.speed, &wishes, &segments, &self.site.rover.response)
    }

    /// What a leg from one state to another joins.
    fn ends(&self, from: usize, to: usize) -> Ends<'_> {
        let [a, b] = [from, to].map(|state| self.node(state as u32).waypoint as usize);
        let DriveSettings { pace, speed, seed, .. } = self.settings;
        Ends {
            from: &self.states[from],
            to: &self.states[to],
            distance: self.distance(a, b),
            speeds: [a, b].map(|waypoint| pace.wish(speed, seed, waypoint)),
            direction: Direction { start: self.directions[a], end: self.directions[b] },
            random: hashed_unit(seed, &[a as u64, b as u64]),
        }
    }

    /// Number of a node's pose.
    fn state(&self, node: &DriveNode) -> usize {
        let state = self.first[node.waypoint as usize] + node.heading;
        assert!(state < self.first[node.waypoint as usize + 1], "a node of another roadmap: {node:?}");
        state as usize
    }

    /// Waypoint and heading of a state.
    fn node(&self, state: u32) -> DriveNode {
        // Waypoints without a heading share their first state with the next one.
        let waypoint = self.first.partition_point(|first| *first <= state) - 1;
        DriveNode { waypoint: waypoint as u32, heading: state - self.first[waypoint] }
    }

    /// Between two waypoints over the ground plan, m.
    fn distance(&self, a: usize, b: usize) -> f64 {
        apart(&self.points[a], &self.points[b])
    }

    /// All legs out of a state, solved at the first question and kept, with what they were refused for in the tally.
    /// Only waypoints at a leg's distance are tried, every headed state of each.
    fn kept_legs(&self, from: usize) -> Arc<[Kept]> {
        if let Some(legs) = &self.kept.borrow()[from] {
            return Arc::clone(legs);
        }
        let own = self.node(from as u32).waypoint as usize;
        let mut tally = self.tally.get();
        let mut legs = Vec::new();
        for w in 0..self.points.len() {
            let distance = self.distance(own, w);
            if w == own || !at_a_leg(&self.settings, distance) {
                continue;
            }
            for state in self.first[w]..self.first[w + 1] {
                let ends = self.ends(from, state as usize);
                let outcome = judge(&self.site, &self.settings, &ends, &mut tally.solves);
                tally.count(&outcome);
                legs.extend(outcome.ok().map(|solved| Kept { state, solved }));
            }
        }
        self.tally.set(tally);
        let legs: Arc<[Kept]> = legs.into();
        self.kept.borrow_mut()[from] = Some(Arc::clone(&legs));
        legs
    }
}

impl Reach<DriveNode> for DriveRoadmap<'_> {
    fn legs(&self, from: &DriveNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<DriveNode>>) {
        assert_eq!(candidates.len(), self.points.len(), "a roadmap serves the graph that it was drawn over");
        let left = self.state(from);
        let (sin, cos) = libm::sincos(self.states[left].yaw + self.directions[from.waypoint as usize]);
        let heading = Vector3::new(cos, sin, 0.0);
        let here = self.points[from.waypoint as usize];
        let DriveSettings { pace, speed, seed, .. } = self.settings;
        let speed_at = |waypoint: u32| pace.wish(speed, seed, waypoint as usize);
        for leg in self.kept_legs(left).iter() {
            let to = self.node(leg.state);
            let way = self.points[to.waypoint as usize] - here;
            out.push(Leg {
                to,
                waypoint: to.waypoint,
                duration: leg.solved.duration,
                features: LegFeatures {
                    v_in: speed_at(from.waypoint),
                    v_out: speed_at(to.waypoint),
                    turn: angle_between(&heading, &Vector3::new(way.x, way.y, 0.0)),
                    length: way.norm(),
                    climb: way.z,
                    slope_in: 0.0,
                    ground: leg.solved.stress,
                },
            });
        }
    }
}

/// √(Δx² + Δy²).
fn apart(a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    libm::hypot(b.x - a.x, b.y - a.y)
}

/// Whether waypoints this far apart (m) may have a leg.
fn at_a_leg(settings: &DriveSettings, distance: f64) -> bool {
    (settings.leg_m[0]..=settings.leg_m[1]).contains(&distance)
}

/// Appends up to M poses at waypoint `w`.
fn draw_headings(
    site: &DriveSite,
    settings: &DriveSettings,
    points: &[Point3<f64>],
    w: usize,
    states: &mut Vec<Planar>,
) {
    let mut random = stream(named_seed(settings.seed, "waypoint headings", w as u64));
    let here = &points[w];
    let near: Vec<&Point3<f64>> = points.iter().filter(|p| at_a_leg(settings, apart(here, p))).collect();
    let (way, direction) = (settings.gear().sign(), settings.direction_at(w));
    let aimed = |at: &Point3<f64>| {
        let bearing = libm::atan2(way * (at.y - here.y), way * (at.x - here.x));
        libm::remainder(bearing - direction, TAU)
    };
    for k in 0..settings.headings.max(1) {
        let drawn = (0..DRAWS)
            .map(|_| heading(&near, (k + 1) % ANYWHERE == 0, aimed, &mut random))
            .map(|yaw| Planar { x: here.x, y: here.y, yaw, curvature: 0.0 })
            .find(|at| stands(site, settings, at).is_ok());
        states.extend(drawn);
    }
}

/// A heading that is `aimed` at one of `near`, or anywhere; in [−π, π].
fn heading(near: &[&Point3<f64>], anywhere: bool, aimed: impl Fn(&Point3<f64>) -> f64, random: &mut Stream) -> f64 {
    let draw = unit(random);
    if anywhere || near.is_empty() {
        return TAU * draw - PI;
    }
    aimed(near[((draw * near.len() as f64) as usize).min(near.len() - 1)])
}
