//! The roadmap: headed waypoints of one graph and the drives between them, solved when first asked for and kept.

use std::cell::{Cell, RefCell};
use std::f64::consts::{PI, TAU};
use std::rc::Rc;

use nalgebra::{Point3, Vector3};

use super::judge::{Ends, Solved, judge};
use super::settings::{DriveSettings, DriveSite};
use super::tally::DriveTally;
use super::watch::stands;
use crate::feasibility::reach::{Leg, LegFeatures, Reach};
use crate::math::random::{Stream, hashed_unit, named_seed, stream, unit};
use crate::math::rotation::angle_between;
use crate::trajectory::drive::{Drive, DriveLeg, Planar};

/// A node: a waypoint and one of its headings, passed with straight wheels.
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

/// The headed waypoints of one graph and the legs between them. One graph is one task on one thread.
///
/// A leg is a drive that the boundary-value solver found on the map: its predicted motion ends in the next waypoint's
/// pose and curvature within the solver's precision and keeps every limit of [`DriveSettings`] on the way. Its
/// [`LegFeatures`] have the commanded speed at both ends, the angle from the direction of travel to the straight
/// line to the next waypoint as `turn`, and the score of the settings as `ground`.
pub struct DriveRoadmap<'a> {
    site: DriveSite<'a>,
    settings: DriveSettings,
    points: Vec<Point3<f64>>,
    /// Poses of all waypoints, waypoint by waypoint.
    states: Vec<Planar>,
    /// First state of every waypoint, and the number of states.
    first: Vec<u32>,
    kept: RefCell<Vec<Option<Rc<[Kept]>>>>,
    tally: Cell<DriveTally>,
}

/// Headings that are drawn for one that stands, at most.
const DRAWS: usize = 8;
/// One heading in so many points anywhere, the others at waypoints.
const ANYWHERE: usize = 4;

impl<'a> DriveRoadmap<'a> {
    /// The roadmap over `points`, index 0 the start: there the pose and curvature are those of `start`.
    ///
    /// Every other waypoint gets M headings in which the body stands within its limits, fewer where it does not: towards a
    /// waypoint drawn from those at a leg's distance, every fourth anywhere. With `end` the last waypoint has that
    /// pose alone.
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
        let (points, settings) = (points.to_vec(), settings.clone());
        Self { site, settings, points, states, first, kept, tally: Cell::default() }
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

    /// A necessary test for searches that end at the last waypoint: false only if no `steps` legs lead from `node` to it.
    /// One leg is no longer than the longest, as the crow flies.
    pub fn may_arrive(&self, node: &DriveNode, steps: usize) -> bool {
        let end = self.points.len() - 1;
        if steps == 0 {
            return node.waypoint as usize == end;
        }
        // A hair more, for the rounding of sums of legs.
        self.distance(node.waypoint as usize, end) <= steps as f64 * self.settings.leg_m[1] * (1.0 + 1e-9)
    }

    /// The drive over `nodes`; `None` where two successive ones are no leg.
    pub fn drive(&self, nodes: &[DriveNode]) -> Option<Drive> {
        let leg = |pair: &[DriveNode]| {
            let (from, to) = (self.state(&pair[0]), self.state(&pair[1]));
            let kept = self.kept_legs(from);
            let leg = kept.iter().find(|leg| leg.state as usize == to)?;
            Some(DriveLeg { from: self.states[from], to: self.states[to], segments: leg.solved.segments.to_vec() })
        };
        let DriveSettings { speed, turn_rate, direction, .. } = self.settings;
        Some(Drive { legs: nodes.windows(2).map(leg).collect::<Option<_>>()?, speed, turn_rate, direction })
    }

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

    fn distance(&self, a: usize, b: usize) -> f64 {
        apart(&self.points[a], &self.points[b])
    }

    fn kept_legs(&self, from: usize) -> Rc<[Kept]> {
        if let Some(legs) = &self.kept.borrow()[from] {
            return Rc::clone(legs);
        }
        let own = self.node(from as u32).waypoint as usize;
        let mut tally = self.tally.get();
        let mut legs = Vec::new();
        for w in 0..self.points.len() {
            let distance = self.distance(own, w);
            if w == own || !at_a_leg(&self.settings, distance) {
                continue;
            }
            let random = hashed_unit(self.settings.seed, &[own as u64, w as u64]);
            for state in self.first[w]..self.first[w + 1] {
                let ends = Ends { from: &self.states[from], to: &self.states[state as usize], distance, random };
                let outcome = judge(&self.site, &self.settings, &ends, &mut tally.solves);
                tally.count(&outcome);
                legs.extend(outcome.ok().map(|solved| Kept { state, solved }));
            }
        }
        self.tally.set(tally);
        let legs: Rc<[Kept]> = legs.into();
        self.kept.borrow_mut()[from] = Some(Rc::clone(&legs));
        legs
    }
}

impl Reach<DriveNode> for DriveRoadmap<'_> {
    fn legs(&self, from: &DriveNode, candidates: &[Point3<f64>], out: &mut Vec<Leg<DriveNode>>) {
        assert_eq!(candidates.len(), self.points.len(), "a roadmap serves the graph that it was drawn over");
        let left = self.state(from);
        let (sin, cos) = libm::sincos(self.states[left].yaw + self.settings.direction);
        let heading = Vector3::new(cos, sin, 0.0);
        let here = self.points[from.waypoint as usize];
        for leg in self.kept_legs(left).iter() {
            let to = self.node(leg.state);
            let way = self.points[to.waypoint as usize] - here;
            out.push(Leg {
                to,
                waypoint: to.waypoint,
                duration: leg.solved.duration,
                features: LegFeatures {
                    v_in: self.settings.speed,
                    v_out: self.settings.speed,
                    turn: angle_between(&heading, &Vector3::new(way.x, way.y, 0.0)),
                    length: way.norm(),
                    climb: way.z,
                    ground: leg.solved.stress,
                },
            });
        }
    }
}

fn apart(a: &Point3<f64>, b: &Point3<f64>) -> f64 {
    libm::hypot(b.x - a.x, b.y - a.y)
}

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
    for k in 0..settings.headings.max(1) {
        let drawn = (0..DRAWS)
            .map(|_| heading(settings, here, &near, (k + 1) % ANYWHERE == 0, &mut random))
            .map(|yaw| Planar { x: here.x, y: here.y, yaw, curvature: 0.0 })
            .find(|at| stands(site, settings, at).is_ok());
        states.extend(drawn);
    }
}

/// A heading that travels towards one of `near`, or anywhere; in [−π, π].
fn heading(
    settings: &DriveSettings,
    here: &Point3<f64>,
    near: &[&Point3<f64>],
    anywhere: bool,
    random: &mut Stream,
) -> f64 {
    let draw = unit(random);
    if anywhere || near.is_empty() {
        return TAU * draw - PI;
    }
    let towards = near[((draw * near.len() as f64) as usize).min(near.len() - 1)];
    let way = settings.gear().sign();
    let bearing = libm::atan2(way * (towards.y - here.y), way * (towards.x - here.x));
    libm::remainder(bearing - settings.direction, TAU)
}
