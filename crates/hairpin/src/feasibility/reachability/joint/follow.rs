//! A move followed from its start in one configuration: limits, singularities and collisions on every piece, proven or
//! halved.
//!
//! Cost is dominated by bodies: pieces times their questions. A move far from everything takes its first pieces, 8 cm
//! or 0.3 rad each; one that grazes a limit is halved there alone.

use super::bodies::{Bodies, Contact};
use super::motion::Motion;
use crate::feasibility::reachability::Refusal;
use crate::robot::arm::{AXES, Arm, Branch, Joints, Sweep, Tool};

/// What is asked of a move.
///
/// `locate` costs more and says where; a graph's refusals need not know.
///
/// `Default`: margin 0.03, pieces down to 2⁻¹⁴ of the move, any place of failure.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FollowSettings {
    /// Least margin to every singularity on straight and circular moves, a pure number.
    pub margin: f64,
    /// Pieces shorter than this share of the move are not halved; what is open there is refused.
    pub least: f64,
    /// Whether to look for the first place where the move fails; else for any.
    pub locate: bool,
}

impl Default for FollowSettings {
    fn default() -> Self {
        Self { margin: 0.03, least: 1.0 / 16384.0, locate: false }
    }
}

/// A move that is possible.
///
/// `end` is on the turns that the move arrives at, not those of any table.
#[derive(Debug, Clone, PartialEq)]
pub struct Followed {
    /// Joint angles at its end.
    pub end: Joints,
    /// Pieces that it took.
    pub pieces: u32,
    /// Least distance of a joint from its bounds at the samples, rad.
    ///
    /// At the middles of the pieces; both ends of the move are not among them.
    pub limit_margin: f64,
}

/// A joint may turn by this much on half a piece, rad: neighbouring samples then differ by less than a third of a turn,
/// and whole turns cannot be confused.
const MOST_TURN: f64 = 0.5;
/// How near (as a share of the move) the first place where it fails is looked for.
const LOCATED: f64 = 1.0 / 1024.0;
/// Length (m) and angle (rad) of the pieces that a move is first cut into.
const FIRST_PIECE: [f64; 2] = [0.08, 0.3];

/// Follows `motion` from the joint angles `start`, counting the questions to obstacles.
///
/// On a piece of half width h around a sample, no joint is farther from the sample's angle than rate·h
/// (`Arm::bounds_around`); limits hold on all of it if they hold with that room, and no link meets anything if its
/// distance exceeds what these turns can move it (`Chain::displacement`). Otherwise the piece is halved. So what is
/// found free is free between samples as well.
///
/// No branch can change unseen: a joint turns at most 0.5 rad on half a piece, and margins keep singularities away.
///
/// `bodies` of `None` asks limits and singularities alone. Moves in joints are not held to singularities. Pieces are 80
/// mm or 0.3 rad at first.
///
/// Of a move in joints limits are checked at both ends, between which it turns evenly.
///
/// # Errors
/// The first reason along the move.
pub fn follow(
    arm: &Arm,
    tool: &Tool,
    bodies: Option<&Bodies>,
    motion: &Motion,
    start: &Joints,
    settings: &FollowSettings,
    queries: &mut u64,
) -> Result<Followed, Refusal> {
    Walk { arm, tool, bodies, motion, settings, queries, branch: arm.branch(start) }.along(start)
}

/// What a walk along a move needs.
struct Walk<'w> {
    arm: &'w Arm,
    tool: &'w Tool,
    bodies: Option<&'w Bodies<'w>>,
    motion: &'w Motion,
    settings: &'w FollowSettings,
    queries: &'w mut u64,
    branch: Branch,
}

/// What a sample says of the piece around it.
enum Judged {
    Holds(Joints, Joints),
    /// At the sample itself something is wrong.
    Refused(Refusal),
    /// Too wide a piece to say; what to tell if it is not halved.
    Open(Refusal),
}

impl Walk<'_> {
    /// Piece by piece from the start on.
    ///
    /// Each piece is judged wider than it is by 10⁻⁹ of itself, for the rounding of its ends.
    fn along(&mut self, start: &Joints) -> Result<Followed, Refusal> {
        if let Some((axis, _)) = self.arm.outside_limits(start) {
            return Err(self.beyond(axis, start, 0.0));
        }
        let sweep = self.motion.sweep(&self.tool.tcp);
        let reach = match self.motion {
            Motion::Joint { start, end } => {
                (0..AXES).map(|k| (end[k] - start[k]).abs()).fold(0.0, f64::max) / FIRST_PIECE[1]
            }
            _ => (sweep.speed / FIRST_PIECE[0]).max(sweep.turn / FIRST_PIECE[1]),
        };
        let first = (reach.ceil() as usize).clamp(1, 1000);
        // Pieces to come, the next one last: exact fractions, so that they join without gaps.
        let mut open: Vec<(f64, f64)> =
            (0..first).rev().map(|i| (i as f64 / first as f64, (i + 1) as f64 / first as f64)).collect();
        let (mut last, mut last_turns) = (*start, [0.0; AXES]);
        let (mut pieces, mut limit_margin) = (0, f64::INFINITY);
        while let Some((from, to)) = open.pop() {
            let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
            match self.judge(middle, half * (1.0 + 1e-9), &sweep, &last, &last_turns) {
                Judged::Holds(q, turns) => {
                    let margins = self.arm.limits.iter().zip(&q).map(|(limit, angle)| limit.margin(*angle));
                    limit_margin = margins.fold(limit_margin, f64::min);
                    (last, last_turns) = (q, turns);
                    pieces += 1;
                }
                Judged::Refused(refusal) if !self.settings.locate || to - from <= LOCATED => return Err(refusal),
                Judged::Open(refusal) if to - from <= self.settings.least => {
                    return Err(self.settled(refusal, to, &last));
                }
                Judged::Open(_) | Judged::Refused(_) => {
                    open.push((middle, to));
                    open.push((from, middle));
                }
            }
        }
        let end = self.solve(1.0, &last).ok_or(Refusal::OutOfReach { at: 1.0 })?;
        // Its pieces were judged by their middles.
        if let Motion::Joint { end, .. } = self.motion
            && let Some((axis, _)) = self.arm.outside_limits(end)
        {
            return Err(self.beyond(axis, end, 1.0));
        }
        Ok(Followed { end, pieces, limit_margin })
    }

    /// With the bound that the angle is nearer to.
    fn beyond(&self, axis: usize, q: &Joints, at: f64) -> Refusal {
        let limit = &self.arm.limits[axis];
        let bound = if q[axis] - limit.lower < limit.upper - q[axis] { limit.lower } else { limit.upper };
        Refusal::JointLimit { axis, angle: q[axis], bound, at }
    }

    /// Joint angles at `s`, on the turns next to `near`.
    fn solve(&self, s: f64, near: &Joints) -> Option<Joints> {
        match self.motion {
            Motion::Joint { start, end } => Some(std::array::from_fn(|k| start[k] + s * (end[k] - start[k]))),
            _ => {
                let flange = self.motion.pose(s)? * self.tool.tcp.inverse();
                self.arm.inverse_in(&flange, self.branch, near).map(|found| found.joints)
            }
        }
    }

    /// What was not decided where a link or an axis comes too near is mostly decided a little farther on.
    ///
    /// Looks ahead at six places, each four times as far as the one before: only what is told changes, not that it is
    /// refused.
    fn settled(&mut self, undecided: Refusal, from: f64, near: &Joints) -> Refusal {
        let collides = matches!(undecided, Refusal::Collides { .. } | Refusal::SelfCollides { .. });
        let bodies = self.bodies.filter(|_| collides);
        if bodies.is_none() && !matches!(undecided, Refusal::JointLimit { .. }) {
            return undecided;
        }
        let ahead = (0..6).map(|k| from + self.settings.least * f64::from(1 << (2 * k))).take_while(|s| *s <= 1.0);
        let mut last = *near;
        for s in ahead {
            let Some(q) = self.solve(s, &last) else { break };
            match bodies.map(|bodies| bodies.contact(&q, &[0.0; AXES], s, self.queries)) {
                Some(Contact::Met(refusal)) => return refusal,
                Some(Contact::Clear | Contact::Unknown(_)) => {}
                None => {
                    if let Some((axis, _)) = self.arm.outside_limits(&q) {
                        return self.beyond(axis, &q, s);
                    }
                }
            }
            last = q;
        }
        undecided
    }

    /// One piece, |s − at| ≤ half: the joints at its middle, bounds on how far each turns from there (rates · half),
    /// then margins, limits and bodies with these. Holds where all hold over the whole piece; refused where the middle
    /// itself breaks one; open where only the bounds do, or a joint turns too far to tell neighbours apart, which
    /// halving settles.
    ///
    /// `half` in the move's parameter. |q − q_before| must not exceed both turns together, else a branch or a whole
    /// turn was lost.
    fn judge(&mut self, at: f64, half: f64, sweep: &Sweep, last: &Joints, last_turns: &Joints) -> Judged {
        let closed = matches!(self.arm.kinematics, crate::robot::arm::Kinematics::Opw(_));
        let Some(q) = self.solve(at, last) else {
            let refusal = Refusal::OutOfReach { at };
            // Newton may have failed for having come too far; a closed form does not.
            return if closed { Judged::Refused(refusal) } else { Judged::Open(refusal) };
        };
        let turns: Joints = match self.motion {
            Motion::Joint { start, end } => std::array::from_fn(|k| (end[k] - start[k]).abs() * half),
            _ => {
                let least = self.settings.margin;
                let margin = self.arm.margin(&q);
                let singular = |margin| Refusal::Singular { margin, least, at };
                if margin.value < least && closed {
                    return Judged::Refused(singular(margin));
                }
                match self.arm.bounds_around(&q, sweep, half) {
                    Some(bounds) if bounds.margin.value >= least || (!closed && margin.value >= least) => {
                        bounds.rates.map(|rate| rate * half)
                    }
                    _ => return Judged::Open(singular(margin)),
                }
            }
        };
        // Whole turns and branches are followed only where neighbours cannot be confused.
        let strayed = |k: usize| (q[k] - last[k]).abs() > turns[k] + last_turns[k] + 1e-6;
        if let Some(axis) = (0..AXES).find(|&k| turns[k] > MOST_TURN || strayed(k)) {
            return Judged::Open(Refusal::Configuration { axis, arrives: q[axis], wanted: last[axis] });
        }
        for (axis, limit) in self.arm.limits.iter().enumerate() {
            let margin = limit.margin(q[axis]);
            if margin < 0.0 {
                return Judged::Refused(self.beyond(axis, &q, at));
            }
            // A joint move that ends on its bound does not pass it.
            if margin < turns[axis] && !matches!(self.motion, Motion::Joint { .. }) {
                return Judged::Open(self.beyond(axis, &q, at));
            }
        }
        match self.bodies.map(|bodies| bodies.contact(&q, &turns, at, self.queries)) {
            None | Some(Contact::Clear) => Judged::Holds(q, turns),
            Some(Contact::Met(refusal)) => Judged::Refused(refusal),
            Some(Contact::Unknown(refusal)) => Judged::Open(refusal),
        }
    }
}
