//! A plan as poses: its path for the judge, and its motion for tables.
//!
//! Between two knots the tool's point runs along p(s), forward kinematics of the joints' cubic. The cubic through both
//! ends with their dp/ds = J(q) dq/ds is compared with it half-way, where such cubics are off the most, and where that
//! is more than [`NEAR`] there is a knot more. Times do not enter the path. The motion has the velocities dp/ds · ṡ
//! instead, and rows until the cubics through them hold in time.

use nalgebra::{Isometry3, Point3, Vector3};

use super::grid::Section;
use super::plan::{Plan, Timed};
use crate::math::cubic::Cubic;
use crate::robot::arm::AXES;
use crate::trajectory::{Channel, PlannedMove, PlannedPath, Track};

/// How near the line between two poses of a path is to forward kinematics, m.
const NEAR: f64 = 5e-7;
/// How near the motion between two rows is to that of the plan, a quarter, a half and three quarters of the way: m, and
/// of attitudes the distance of unit quaternions. A fifth of what rows that are picked of these may be off.
const HELD: f64 = 2e-5;
const HELD_ATTITUDE: f64 = 2e-4;
/// Rows under way are no farther apart, s: who picks some of them looks at rows alone, and not between.
const APART: f64 = 0.01;
/// Intervals are halved so often at most: where tools change in a blend places jump.
const HALVINGS: usize = 7;

/// Where the tool is at a parameter, and how it goes on.
#[derive(Clone, Copy)]
struct Stand {
    pose: Isometry3<f64>,
    /// dp/ds of its point.
    slope: Vector3<f64>,
}

impl Stand {
    fn place(&self) -> Point3<f64> {
        self.pose.translation.vector.into()
    }
}

/// A row of the motion.
#[derive(Clone, Copy)]
struct Row {
    time: f64,
    pose: Isometry3<f64>,
    velocity: Vector3<f64>,
}

impl Plan<'_> {
    /// The path as planned, blends and all, for the judge: what `from = "blended"` means.
    ///
    /// `base_from_tcp` with its times, s, at every node and knot; the tool's, as the set points have it and not the
    /// lagging joints. Between two of them the path is within a micrometre of forward kinematics, whatever the joints
    /// do there.
    ///
    /// Sections follow each other with the wait at fine points between, in which there is no pose: straight lines
    /// between stamps stand still there. O(nodes · log).
    pub fn path(&self) -> PlannedPath {
        let mut moves = Vec::with_capacity(self.passed().len());
        let mut line = Line::default();
        for timed in &self.timed {
            let (section, begin) = (&timed.section, timed.begin);
            let mut node_at = Vec::with_capacity(section.s.len());
            let mut before = None;
            for s in timed.law.knots() {
                match before {
                    Some(before) => self.lay(&mut line, timed, [before, *s]),
                    None => line.push(begin, section.poses[0], None),
                }
                if section.s[node_at.len()] == *s {
                    node_at.push(line.times.len() - 1);
                }
                before = Some(*s);
            }
            moves.extend(self.ends(section, &node_at));
        }
        let track = Track::new(line.times, line.poses, Vec::new()).expect("times rise and poses are finite");
        PlannedPath::new(track.along(line.ways), moves)
    }

    /// The planned motion: the path with the tool's velocities (`vx_m_s`, `vy_m_s`, `vz_m_s`) on rows near enough that
    /// the cubics between them hold to 0.02 mm.
    ///
    /// Knots of the law, halved in time where that takes it.
    pub fn motion(&self) -> PlannedPath {
        let mut moves = Vec::with_capacity(self.passed().len());
        let mut rows: Vec<Row> = Vec::new();
        for timed in &self.timed {
            let (section, mut span, mut first) = (&timed.section, 0, true);
            let mut node_at = Vec::with_capacity(section.s.len());
            for s in timed.law.knots() {
                let row = match section.spans.is_empty() {
                    true => Row { time: timed.begin, pose: section.poses[0], velocity: Vector3::zeros() },
                    false => self.row(timed, timed.begin + timed.law.when(*s), &mut span),
                };
                match rows.last().copied() {
                    Some(before) if !first => self.rows_between(timed, &mut rows, [before, row], (span, HALVINGS)),
                    _ => {}
                }
                // Rows that rounding puts at one time are one.
                if rows.last().is_none_or(|last| row.time > last.time) {
                    rows.push(row);
                }
                if section.s[node_at.len()] == *s {
                    node_at.push(rows.len() - 1);
                }
                first = false;
            }
            moves.extend(self.ends(section, &node_at));
        }
        let velocities = ["vx_m_s", "vy_m_s", "vz_m_s"].into_iter().enumerate().map(|(axis, name)| Channel {
            name: name.into(),
            values: rows.iter().map(|row| row.velocity[axis]).collect(),
        });
        let (times, poses) = (rows.iter().map(|row| row.time).collect(), rows.iter().map(|row| row.pose).collect());
        let track = Track::new(times, poses, velocities.collect()).expect("times rise and poses are finite");
        PlannedPath::new(track, moves)
    }

    /// The moves of a section, whose nodes are at these poses of the whole.
    fn ends(&self, section: &Section, node_at: &[usize]) -> Vec<PlannedMove> {
        let one = |(order, node): &(usize, usize)| PlannedMove {
            name: self.orders[*order].name.clone(),
            end: node_at[*node],
            stops: *node == section.last(),
        };
        section.marks.iter().map(one).collect()
    }

    /// Where the tool is at `s` of a span, whose move's tool it is.
    fn stand(&self, section: &Section, span: usize, s: f64) -> Stand {
        let frames = self.arm.chain.frames(&section.joints_at(span, s));
        let pose = frames[AXES] * self.arm.chain.flange * self.orders[section.spans[span].order].tool;
        let point = Point3::from(pose.translation.vector);
        let rates = section.jet(span, section.share(span, s)).slope;
        let axes = self.arm.chain.axes(&frames);
        let slope = axes.iter().zip(rates).map(|((origin, axis), rate)| axis.cross(&(point - origin)) * rate).sum();
        Stand { pose, slope }
    }

    /// The path between two knots of one span.
    fn lay(&self, line: &mut Line, timed: &Timed, [from, to]: [f64; 2]) {
        let section = &timed.section;
        let span = section.span(0.5 * (from + to), line.span(from));
        line.span = span;
        let ends = [from, to].map(|s| (s, self.stand(section, span, s)));
        // Where the tool is another from here on its place jumps.
        let jumps =
            line.poses.last().is_some_and(|last| (last.translation.vector - ends[0].1.place().coords).norm() > NEAR);
        if jumps {
            line.push(timed.begin + timed.law.when(to), ends[1].1.pose, None);
        } else {
            self.bend(line, timed, ends, HALVINGS);
        }
    }

    /// The path between two places of the span, with so many halvings at most.
    fn bend(&self, line: &mut Line, timed: &Timed, ends: [(f64, Stand); 2], halvings: usize) {
        let [(from, a), (to, b)] = ends;
        let way = Cubic::between(&a.place(), &b.place(), [a.slope * (to - from), b.slope * (to - from)]);
        let middle = 0.5 * (from + to);
        let there = self.stand(&timed.section, line.span, middle);
        if halvings > 0 && (way.at(0.5) - there.place()).norm() > NEAR {
            self.bend(line, timed, [(from, a), (middle, there)], halvings - 1);
            self.bend(line, timed, [(middle, there), (to, b)], halvings - 1);
        } else {
            let way = (way.bulge() > NEAR).then_some(way);
            line.push(timed.begin + timed.law.when(to), b.pose, way);
        }
    }

    /// The motion at `time`, s, in the section that is under way then.
    fn row(&self, timed: &Timed, time: f64, span: &mut usize) -> Row {
        let progress = timed.law.at(time - timed.begin);
        *span = timed.section.span(progress.s, *span);
        let stand = self.stand(&timed.section, *span, progress.s);
        Row { time, pose: stand.pose, velocity: stand.slope * progress.rate }
    }

    /// The rows between two that it takes for the motion between them to hold, about a span of the section, with so
    /// many halvings at most.
    fn rows_between(
        &self,
        timed: &Timed,
        rows: &mut Vec<Row>,
        [from, to]: [Row; 2],
        (mut about, halvings): (usize, usize),
    ) {
        let span = to.time - from.time;
        if halvings == 0 || span <= 0.0 {
            return;
        }
        let way = Cubic::between(
            &from.pose.translation.vector.into(),
            &to.pose.translation.vector.into(),
            [from.velocity * span, to.velocity * span],
        );
        let holds = span <= APART
            && [0.5, 0.25, 0.75].into_iter().all(|share| {
                let there = self.row(timed, from.time + share * span, &mut about);
                let turned = from.pose.rotation.nlerp(&to.pose.rotation, share);
                let apart = turned.coords.dot(&there.pose.rotation.coords).abs();
                (way.at(share) - Point3::from(there.pose.translation.vector)).norm() <= HELD
                    && 2.0 * (1.0 - apart) <= HELD_ATTITUDE * HELD_ATTITUDE
            });
        if holds {
            return;
        }
        let middle = self.row(timed, from.time + 0.5 * span, &mut about);
        self.rows_between(timed, rows, [from, middle], (about, halvings - 1));
        if rows.last().is_none_or(|last| middle.time > last.time) {
            rows.push(middle);
        }
        self.rows_between(timed, rows, [middle, to], (about, halvings - 1));
    }
}

/// A path in the making.
#[derive(Default)]
struct Line {
    times: Vec<f64>,
    poses: Vec<Isometry3<f64>>,
    /// One less than poses.
    ways: Vec<Option<Cubic>>,
    /// Of the section, the span that it has come to.
    span: usize,
}

impl Line {
    /// Poses that rounding puts at one time are one.
    fn push(&mut self, time: f64, pose: Isometry3<f64>, way: Option<Cubic>) {
        if self.times.last().is_some_and(|last| time <= *last) {
            return;
        }
        if !self.times.is_empty() {
            self.ways.push(way);
        }
        self.times.push(time);
        self.poses.push(pose);
    }

    /// From which span on to look: a section begins with its first.
    fn span(&self, s: f64) -> usize {
        if s == 0.0 { 0 } else { self.span }
    }
}
