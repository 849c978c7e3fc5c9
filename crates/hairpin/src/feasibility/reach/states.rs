//! The states of one graph's waypoints and the legs between them, judged when a search first asks and kept.
//!
//! Nodes are (waypoint, velocity): rest at start and end, M velocities elsewhere; n waypoints make up to (n M)² legs.
//! A leg takes the shortest time of a ladder for which its judge proves it. What a state is, and what proves a leg, is
//! the robot's.

use std::cell::{OnceCell, RefCell};
use std::ops::Range;
use std::sync::Arc;

use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::proven_legs::{Judged, ProveLegs, WitnessLegs, WitnessNode};
use super::{Leg, LegFeatures};
use crate::feasibility::steering::LegTiming;
use crate::feasibility::steering::firsts::Asked;
use crate::math::random::{Stream, named_seed, stream};
use crate::trajectory::Profile;

/// How velocities are drawn: each waypoint from a stream of its own.
#[derive(Debug, Clone, Copy)]
pub(in crate::feasibility) struct Velocities {
    /// Per waypoint, M; 0 is taken as 1.
    pub(in crate::feasibility) many: usize,
    /// Seed and name of the streams.
    pub(in crate::feasibility) seed: (u64, &'static str),
    /// Leg times.
    pub(in crate::feasibility) timing: LegTiming,
}

/// The states of one graph and the legs between them. One graph is one task on one thread.
#[derive(Debug)]
pub(in crate::feasibility) struct States<'a, J: ProveLegs> {
    judge: &'a J,
    points: Vec<Point3<f64>>,
    /// States of all waypoints, waypoint by waypoint.
    states: Vec<J::End>,
    /// The same as they are looked at together.
    lanes: Vec<J::Lanes>,
    /// First state of every waypoint, and the number of states.
    first: Vec<u32>,
    rungs: Vec<f64>,
    kept: RefCell<Vec<Option<Arc<[Judged]>>>>,
    /// Which states have a leg to the end.
    arrivals: OnceCell<Vec<bool>>,
}

impl<'a, J: ProveLegs> States<'a, J> {
    /// Over `points`: index 0 the start, the last the end, both `at_rest`; every other waypoint gets M states.
    ///
    /// State k of a waypoint has a speed drawn from the k-th of M equal parts of [0, top speed]; `moving` is given the
    /// waypoint, that speed and its stream.
    pub(in crate::feasibility) fn new(
        judge: &'a J,
        points: &[Point3<f64>],
        velocities: &Velocities,
        at_rest: impl Fn(&Point3<f64>) -> J::End,
        moving: impl Fn(usize, f64, &mut Stream) -> J::End,
    ) -> Self {
        let many = velocities.many.max(1);
        let (mut states, mut first) = (Vec::with_capacity(points.len() * many), Vec::with_capacity(points.len() + 1));
        for (w, point) in points.iter().enumerate() {
            first.push(states.len() as u32);
            if w == 0 || w + 1 == points.len() {
                states.push(at_rest(point));
                continue;
            }
            let (seed, name) = velocities.seed;
            let mut random = stream(named_seed(seed, name, w as u64));
            for k in 0..many {
                let speed = judge.top_speed() * (k as f64 + random.random_range(0.0..1.0)) / many as f64;
                states.push(moving(w, speed, &mut random));
            }
        }
        first.push(states.len() as u32);
        let lanes = first.windows(2).map(|ends| J::lanes(&states[ends[0] as usize..ends[1] as usize])).collect();
        let (kept, arrivals) = (RefCell::new(vec![None; states.len()]), OnceCell::new());
        Self { judge, points: points.to_vec(), states, lanes, first, rungs: velocities.timing.rungs(), kept, arrivals }
    }

    /// The same, with `legs` of one that was drawn alike.
    ///
    /// # Panics
    /// If it has another number of states.
    pub(in crate::feasibility) fn knowing(self, legs: WitnessLegs) -> Self {
        assert_eq!(legs.0.len(), self.states.len(), "legs of another roadmap");
        Self { kept: RefCell::new(legs.0), ..self }
    }

    /// The legs that were judged.
    pub(in crate::feasibility) fn into_legs(self) -> WitnessLegs {
        WitnessLegs(self.kept.into_inner())
    }

    /// The node at rest at the start.
    pub(in crate::feasibility) fn start(&self) -> WitnessNode {
        WitnessNode { previous: 0, waypoint: 0, velocity: 0 }
    }

    /// What judges legs.
    pub(in crate::feasibility) fn judge(&self) -> &'a J {
        self.judge
    }

    /// The graph's waypoints.
    pub(in crate::feasibility) fn points(&self) -> &[Point3<f64>] {
        &self.points
    }

    /// All states, waypoint by waypoint.
    pub(in crate::feasibility) fn all(&self) -> &[J::End] {
        &self.states
    }

    /// Numbers of the states of waypoint `w`.
    pub(in crate::feasibility) fn of(&self, w: usize) -> Range<u32> {
        self.first[w]..self.first[w + 1]
    }

    /// Leg times, rising, s.
    pub(in crate::feasibility) fn rungs(&self) -> &[f64] {
        &self.rungs
    }

    /// The longest leg time, s.
    pub(in crate::feasibility) fn longest(&self) -> f64 {
        self.rungs.last().copied().unwrap_or(0.0)
    }

    /// A necessary test for searches: false only if no `steps` legs lead from `node` to the end. One step is judged
    /// exactly; more are asked of `beyond`.
    pub(in crate::feasibility) fn may_arrive(
        &self,
        node: &WitnessNode,
        steps: usize,
        beyond: impl FnOnce() -> bool,
    ) -> bool {
        match steps {
            0 => node.waypoint as usize + 1 == self.points.len(),
            1 => self.arrivals()[self.number(node)],
            _ => beyond(),
        }
    }

    /// What every candidate for a leg from `from` is, a state of another waypoint each: its node, or why it is none;
    /// `None` where the straight line alone takes longer at the largest speed than the longest leg may.
    ///
    /// The evidence is that of the leg time that `told` chooses for two states and their least time.
    ///
    /// For telling why nothing was found: every refused candidate is judged once more.
    pub(in crate::feasibility) fn candidates(
        &self,
        from: &WitnessNode,
        told: impl Fn(&J::End, &J::End, f64) -> f64,
    ) -> Vec<Result<WitnessNode, Option<J::Why>>> {
        let (left, own) = (self.number(from), from.waypoint as usize);
        let others = (0..self.points.len()).filter(|w| *w != own);
        let judged = others.flat_map(|w| self.of(w).map(move |state| (w, state)));
        let fate = |(w, state): (usize, u32)| {
            let least = self.least_time(own, w);
            if least > self.longest() {
                return Err(None);
            }
            if self.shortest(left, state as usize, least).is_some() {
                let (waypoint, velocity) = (w as u32, state - self.first[w]);
                return Ok(WitnessNode { previous: from.waypoint, waypoint, velocity });
            }
            let (here, there) = (&self.states[left], &self.states[state as usize]);
            Err(self.judge.leg(here, there, told(here, there, least)).err())
        };
        judged.map(fate).collect()
    }

    /// The trajectory over `nodes` as polynomials, built once for what is returned: legs are judged again, since only
    /// their rungs are kept.
    ///
    /// # Errors
    /// Why two successive nodes are no leg: the evidence of the longest leg time.
    pub(in crate::feasibility) fn profile(&self, nodes: &[WitnessNode]) -> Result<Profile, J::Why> {
        let leg = |pair: &[WitnessNode]| {
            let (from, to) = (self.number(&pair[0]), self.number(&pair[1]));
            let judged = |rung: &f64| self.judge.leg(&self.states[from], &self.states[to], *rung);
            let (last, shorter) = self.rungs.split_last().expect("a timing has at least one rung");
            shorter.iter().find_map(|rung| judged(rung).ok()).map_or_else(|| judged(last), Ok)
        };
        Ok(Profile { legs: nodes.windows(2).map(leg).collect::<Result<_, _>>()? })
    }

    /// Number of a node's state.
    pub(in crate::feasibility) fn number(&self, node: &WitnessNode) -> usize {
        let state = self.first[node.waypoint as usize] + node.velocity;
        assert!(state < self.first[node.waypoint as usize + 1], "a node of another roadmap: {node:?}");
        state as usize
    }

    /// Waypoint and velocity of a state.
    pub(in crate::feasibility) fn place(&self, state: u32) -> (u32, u32) {
        let waypoint = self.first.partition_point(|first| *first <= state) - 1;
        (waypoint as u32, state - self.first[waypoint])
    }

    /// The shortest feasible rung between two states, of those that are no shorter than `least`.
    fn shortest(&self, from: usize, to: usize, least: f64) -> Option<u32> {
        let mut found = None;
        let (waypoint, state) = self.place(to as u32);
        let state = state as usize;
        self.each_shortest(from, &[self.asked(waypoint as usize, state..state + 1, least)], |_, rung| {
            found = Some(rung)
        });
        found
    }

    /// Which of the states of a waypoint are asked, of which no rung shorter than `least`.
    fn asked(&self, waypoint: usize, states: Range<usize>, least: f64) -> Asked {
        let first = self.rungs.partition_point(|rung| *rung < least);
        Asked { waypoint, begin: self.first[waypoint] as usize, states, first }
    }

    /// Calls `found` with each of the states that are `asked` for and to which there is a leg, and its shortest rung.
    fn each_shortest(&self, from: usize, asked: &[Asked], mut found: impl FnMut(u32, u32)) {
        let found = |state: usize, rung: usize| found(state as u32, rung as u32);
        self.judge.firsts(&self.states[from], (&self.states, &self.lanes), asked, &self.rungs, found);
    }

    /// Time of the straight line between two waypoints at the largest speed, s.
    fn least_time(&self, from: usize, to: usize) -> f64 {
        (self.points[to] - self.points[from]).norm() / self.judge.fastest()
    }

    /// All legs out of a state, judged at the first question and kept. Waypoints farther than the largest speed goes in
    /// the longest rung are not looked at; each leg keeps the shortest rung that holds.
    pub(in crate::feasibility) fn kept_legs(&self, from: usize) -> Arc<[Judged]> {
        if let Some(legs) = &self.kept.borrow()[from] {
            return Arc::clone(legs);
        }
        let mut legs = Vec::new();
        self.each_shortest(from, &self.all_asked(from), |state, rung| legs.push(Judged { state, rung }));
        let legs: Arc<[Judged]> = legs.into();
        self.kept.borrow_mut()[from] = Some(Arc::clone(&legs));
        legs
    }

    /// All states of the waypoints that the longest rung can reach from a state.
    fn all_asked(&self, from: usize) -> Vec<Asked> {
        let own = self.place(from as u32).0 as usize;
        let asked = |w: usize| {
            let least = self.least_time(own, w);
            (least <= self.longest()).then(|| self.asked(w, 0..self.of(w).len(), least))
        };
        (0..self.points.len()).filter(|w| *w != own).filter_map(asked).collect()
    }

    /// Which states have a leg to the end, one leg judged for each.
    pub(in crate::feasibility) fn arrivals(&self) -> &[bool] {
        self.arrivals.get_or_init(|| {
            let (end, goal) = (self.states.len() - 1, self.points.len() - 1);
            let arrives = |state: usize| {
                let own = self.place(state as u32).0 as usize;
                state != end && self.shortest(state, end, self.least_time(own, goal)).is_some()
            };
            (0..self.states.len()).map(arrives).collect()
        })
    }

    /// Appends every leg from `from`, in the order of their states; `ground` is what their judge's world adds to what
    /// scores see, from the straight way.
    ///
    /// # Panics
    /// If `candidates` are not the graph's waypoints.
    pub(in crate::feasibility) fn legs(
        &self,
        from: &WitnessNode,
        candidates: &[Point3<f64>],
        ground: impl Fn(&LegFeatures, &Vector3<f64>) -> f64,
        out: &mut Vec<Leg<WitnessNode>>,
    ) {
        self.seen(from, &self.kept_legs(self.number(from)), candidates, ground, out);
    }

    /// The one of [`Self::legs`] to the node `to`: alone, where not all from `from` are known.
    ///
    /// # Panics
    /// If `candidates` are not the graph's waypoints.
    pub(in crate::feasibility) fn leg(
        &self,
        [from, to]: [&WitnessNode; 2],
        candidates: &[Point3<f64>],
        ground: impl Fn(&LegFeatures, &Vector3<f64>) -> f64,
    ) -> Option<Leg<WitnessNode>> {
        let (left, state) = (self.number(from), self.number(to) as u32);
        let kept = self.kept.borrow()[left].clone();
        let rung = match kept {
            Some(legs) => legs.iter().find(|leg| leg.state == state)?.rung,
            None => {
                let least = self.least_time(from.waypoint as usize, to.waypoint as usize);
                self.shortest(left, state as usize, least)?
            }
        };
        let mut leg = Vec::with_capacity(1);
        self.seen(from, &[Judged { state, rung }], candidates, ground, &mut leg);
        leg.pop().filter(|leg| leg.to == *to)
    }

    /// Appends what may be legs from `from`, in the order of their states: all legs are among them, none is shorter.
    /// Nothing is kept of them.
    ///
    /// # Panics
    /// If `candidates` are not the graph's waypoints.
    pub(in crate::feasibility) fn possible(
        &self,
        from: &WitnessNode,
        candidates: &[Point3<f64>],
        out: &mut Vec<Leg<WitnessNode>>,
    ) {
        let (number, mut legs) = (self.number(from), Vec::new());
        let found = |state: usize, rung: usize| legs.push(Judged { state: state as u32, rung: rung as u32 });
        let asked = self.all_asked(number);
        self.judge.possible(&self.states[number], (&self.states, &self.lanes), &asked, &self.rungs, found);
        self.seen(from, &legs, candidates, |_, _| 0.0, out);
    }

    /// The shortest duration of a leg between two nodes' states, s.
    pub(in crate::feasibility) fn proven(&self, from: &WitnessNode, to: &WitnessNode) -> Option<f64> {
        let least = self.least_time(from.waypoint as usize, to.waypoint as usize);
        Some(self.rungs[self.shortest(self.number(from), self.number(to), least)? as usize])
    }

    /// Appends the `judged` legs from `from`.
    fn seen(
        &self,
        from: &WitnessNode,
        judged: &[Judged],
        candidates: &[Point3<f64>],
        ground: impl Fn(&LegFeatures, &Vector3<f64>) -> f64,
        out: &mut Vec<Leg<WitnessNode>>,
    ) {
        assert_eq!(candidates.len(), self.points.len(), "a roadmap serves the graph that it was drawn over");
        let (here, left) = (self.points[from.waypoint as usize], self.number(from));
        let v_in = J::speed(&self.states[left]);
        // States of a waypoint follow on one another: they share the straight way to it, and the turn into that.
        let (mut to, mut outgoing, mut way) = (from.waypoint, Vector3::zeros(), LegFeatures::default());
        out.reserve(judged.len());
        for leg in judged {
            if leg.state >= self.first[to as usize + 1] || to == from.waypoint {
                to = self.place(leg.state).0;
                outgoing = self.points[to as usize] - here;
                way = LegFeatures { v_in, length: outgoing.norm(), climb: outgoing.z, ..LegFeatures::default() }
                    .entered(&self.points, [from.previous, from.waypoint, to]);
            }
            let (waypoint, velocity) = (to, leg.state - self.first[to as usize]);
            let features = LegFeatures { v_out: J::speed(&self.states[leg.state as usize]), ..way };
            out.push(Leg {
                to: WitnessNode { previous: from.waypoint, waypoint, velocity },
                waypoint,
                duration: self.rungs[leg.rung as usize],
                features: LegFeatures { ground: ground(&features, &outgoing), ..features },
            });
        }
    }
}
