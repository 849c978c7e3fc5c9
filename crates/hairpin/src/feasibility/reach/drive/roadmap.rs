//! The roadmap: headed waypoints of one graph and the drives between them, solved when first asked for and kept.

use std::cell::{Cell, RefCell};
use std::collections::HashMap;
use std::sync::Arc;

use nalgebra::{Point3, Vector3};

use super::draft::DriveDraft;
use super::headings::{apart, draw_headings};
use super::judge::{Ends, Solved, judge};
use super::settings::{DriveSettings, DriveSite};
use super::tally::DriveTally;
use crate::feasibility::reach::{Leg, LegFeatures, Reach};
use crate::math::random::hashed_unit;
use crate::math::rotation::angle_between;
use crate::trajectory::drive::{Planar, Segment};
use crate::trajectory::{Direction, Drive, Passing};

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
    /// Legs between two states that were asked for by themselves.
    single: RefCell<HashMap<[usize; 2], Option<Solved>>>,
    tally: Cell<DriveTally>,
}

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
        Self {
            site,
            settings,
            points,
            directions,
            states,
            first,
            kept,
            single: RefCell::default(),
            tally: Cell::default(),
        }
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

    /// Nodes that a leg from `node` may lead to, as far as the distance tells: nothing is solved.
    pub fn near(&self, node: &DriveNode) -> Vec<DriveNode> {
        let own = node.waypoint as usize;
        let others = (0..self.points.len()).filter(|w| *w != own && self.settings.is_a_leg(self.distance(own, *w)));
        let headings = |w: usize| {
            let count = self.first[w + 1] - self.first[w];
            (0..count).map(move |heading| DriveNode { waypoint: w as u32, heading })
        };
        others.flat_map(headings).collect()
    }

    /// The leg from one node to another, solved by itself where those of the first are not known; `None`: there is
    /// none. What is refused stands in the tally.
    pub fn leg(&self, from: &DriveNode, to: &DriveNode) -> Option<Leg<DriveNode>> {
        let pair = [from, to].map(|node| self.state(node));
        self.solved(pair).map(|solved| self.told(pair[0], &Kept { state: pair[1] as u32, solved }))
    }

    /// The drive over `nodes`, with its speeds; `None` where two successive ones are no leg, and where a leg that was
    /// solved for the commanded speed has no commands for those that it really has, which lags of the steering can do.
    ///
    /// From rest to rest unless the pace is constant. At most five rounds of fitting commands to speeds.
    pub fn drive(&self, nodes: &[DriveNode]) -> Option<Drive> {
        let states: Vec<usize> = nodes.iter().map(|node| self.state(node)).collect();
        let legs = states.windows(2).map(|pair| Some(Some(self.solved([pair[0], pair[1]])?.commands())));
        let legs = legs.collect::<Option<_>>()?;
        let passing = |(node, state): (&DriveNode, &usize)| Passing {
            at: self.states[*state],
            direction: self.directions[node.waypoint as usize],
        };
        let wishes = nodes.iter().map(|node| self.settings.wish(node.waypoint as usize)).collect();
        let passings = nodes.iter().zip(&states).map(passing).collect();
        DriveDraft::with_legs(passings, wishes, legs).driven(&self.site, &self.settings)
    }

    /// The leg from one state to another, from among those of the first if they are known, else by itself.
    fn solved(&self, [from, to]: [usize; 2]) -> Option<Solved> {
        if let Some(legs) = &self.kept.borrow()[from] {
            return legs.iter().find(|leg| leg.state as usize == to).map(|leg| leg.solved.clone());
        }
        if let Some(known) = self.single.borrow().get(&[from, to]) {
            return known.clone();
        }
        let ends = self.ends(from, to);
        let mut tally = self.tally.get();
        let solved = self.settings.is_a_leg(ends.distance).then(|| {
            let outcome = judge(&self.site, &self.settings, &ends, &mut tally.solves);
            tally.count(&outcome);
            outcome.ok()
        });
        self.tally.set(tally);
        let solved = solved.flatten();
        self.single.borrow_mut().insert([from, to], solved.clone());
        solved
    }

    /// What a leg from one state to another joins.
    fn ends(&self, from: usize, to: usize) -> Ends<'_> {
        let [a, b] = [from, to].map(|state| self.node(state as u32).waypoint as usize);
        Ends {
            from: &self.states[from],
            to: &self.states[to],
            distance: self.distance(a, b),
            speeds: [a, b].map(|waypoint| self.settings.wish(waypoint)),
            direction: Direction { start: self.directions[a], end: self.directions[b] },
            random: hashed_unit(self.settings.seed, &[a as u64, b as u64]),
        }
    }

    /// What searches are told of a leg out of the state `from`.
    fn told(&self, from: usize, leg: &Kept) -> Leg<DriveNode> {
        let own = self.node(from as u32).waypoint as usize;
        let (sin, cos) = libm::sincos(self.states[from].yaw + self.directions[own]);
        let heading = Vector3::new(cos, sin, 0.0);
        let to = self.node(leg.state);
        let way = self.points[to.waypoint as usize] - self.points[own];
        Leg {
            to,
            waypoint: to.waypoint,
            duration: leg.solved.duration,
            features: LegFeatures {
                v_in: self.settings.wish(own),
                v_out: self.settings.wish(to.waypoint as usize),
                turn: angle_between(&heading, &Vector3::new(way.x, way.y, 0.0)),
                length: way.norm(),
                climb: way.z,
                slope_in: 0.0,
                ground: leg.solved.stress,
            },
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
            if w == own || !self.settings.is_a_leg(distance) {
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
        out.extend(self.kept_legs(left).iter().map(|leg| self.told(left, leg)));
    }
}
