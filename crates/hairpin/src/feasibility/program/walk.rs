//! A program followed move by move in the joints of an arm.
//!
//! The state between two moves is where the arm stands, in joints, if that is known:
//!
//! ```text
//! q_(k+1) = end of the followed move                 MoveL, MoveC: by continuation from q_k
//!         = the posture at the target                MoveJ: demanded, or nearest to q_k by Σ|Δq|
//!         = what is told                             MoveAbsJ
//!         = a posture at the target, or unknown      after a refusal
//! ```
//!
//! Arms of which the meaning of a configuration is not known (chains) are followed in the posture that is nearest, and
//! everything that rests on that is told as open.

use nalgebra::Isometry3;

use super::finding::{Checked, Finding, Fit};
use super::posture::{self, beyond};
use crate::feasibility::reachability::Refusal;
use crate::feasibility::reachability::joint::{
    Bodies, Circle, FollowSettings, Followed, Motion as Way, Worth, follow, is_known,
};
use crate::robot::arm::{AXES, Arm, Joints, Tool};
use crate::trajectory::program::{Motion, Move, PoseTarget, Program};
use crate::world::cell::Cell;

/// What stands around the arm, and what its tool takes up.
#[derive(Debug, Clone, Copy, Default)]
pub struct Surroundings<'a> {
    /// In the base frame; without it only the arm itself is in its way.
    pub cell: Option<&'a Cell>,
    /// The tool is taken for all points this near (m) to the line from the flange to its point.
    pub tool_radius: f64,
    /// What every link and the tool keep from the cell, m.
    pub clearance: f64,
}

/// So much faster than its largest speed an axis may be asked to turn, as a share of it: rated speeds are no walls.
const FASTER: f64 = 0.1;
/// Findings for which another configuration is looked for; beyond, a program has other worries.
const MOST_REMEDIES: usize = 50;

/// Follows the first `count` moves of a program whose tools and work objects are all there, from wherever its first
/// posture or configuration puts the arm.
///
/// Straight and circular moves keep one branch of the inverse kinematics; limits, singularities and what links and tool
/// meet are proven between samples ([`follow`]). After a move that is refused the arm is taken to stand at its target,
/// so that one mistake is one finding: in its configuration where the program demands that, else in the posture nearest
/// to the last one known; a target that nothing reaches leaves it unknown where the arm stands.
///
/// | move | proven |
/// | --- | --- |
/// | MoveAbsJ | bounds at its end, and the way there in joints |
/// | MoveJ | the demanded posture, else the nearest, and the way there in joints |
/// | MoveL, MoveC | one branch all along, limits, margins, bodies; then the demanded configuration |
///
/// `count` may be less than the program has; its indices of tools and work objects are the caller's to have checked.
pub fn check(
    arm: &Arm,
    program: &Program,
    count: usize,
    around: &Surroundings<'_>,
    settings: &FollowSettings,
) -> Checked {
    let nothing = Cell::default();
    let cell = around.cell.unwrap_or(&nothing);
    let of = |tool: &crate::trajectory::program::Tool| {
        let tool = Tool { name: tool.name.clone(), tcp: tool.tcp, radius: around.tool_radius, ..Tool::flange() };
        let (bodies, doubtful) =
            Bodies::new(arm, &tool, cell, around.clearance).parted(|body| is_known(arm, &tool, body));
        Carried { tool, bodies, doubtful }
    };
    let tools: Vec<Carried> = program.tools.iter().map(of).collect();
    let checked = Checked { followed: 0, ends_only: 0, findings: Vec::new() };
    let mut walk = Walk {
        arm,
        program,
        tools: &tools,
        settings,
        at: None,
        last: None,
        from: None,
        assumed: false,
        told: false,
        checked,
    };
    for (index, m) in program.moves.iter().take(count).enumerate() {
        walk.step(index, m);
        walk.from = m.motion.name().map(Into::into);
    }
    walk.checked
}

/// A tool, and what it and the arm take up.
struct Carried<'a> {
    tool: Tool,
    /// All that a finding may rest on.
    bodies: Bodies<'a>,
    /// Pairs of which neither is known, where there are any.
    doubtful: Option<Bodies<'a>>,
}

struct Walk<'a> {
    arm: &'a Arm,
    program: &'a Program,
    /// With what each takes up.
    tools: &'a [Carried<'a>],
    settings: &'a FollowSettings,
    /// Where the arm stands, if that is known.
    at: Option<Joints>,
    /// Where it stood last, as far as that was ever known.
    last: Option<Joints>,
    /// Name of where it stands.
    from: Option<String>,
    /// Whether it stands there in a posture that a configuration would tell, if one knew what that means.
    assumed: bool,
    /// Whether it was told that configurations are not known.
    told: bool,
    checked: Checked,
}

impl Walk<'_> {
    fn step(&mut self, index: usize, m: &Move) {
        let (before, found) = (self.at, self.checked.findings.len());
        self.go(index, m);
        // What cannot be done at all is not done in time either.
        if let (Some(from), Some(to), true) = (before, self.at, found == self.checked.findings.len()) {
            self.hurry(index, m, &from, &to);
        }
    }

    /// Looks at whether the axes can turn from `from` to `to` in the time that the move is to take, by mean speeds:
    /// ramps, which take longer, are left out.
    fn hurry(&mut self, index: usize, m: &Move, from: &Joints, to: &Joints) {
        let Some(seconds) = m.duration.filter(|seconds| *seconds > 0.0) else { return };
        let share = |axis: usize| (to[axis] - from[axis]).abs() / seconds / self.arm.limits[axis].speed;
        let Some(axis) = (0..AXES).reduce(|most, axis| if share(axis) > share(most) { axis } else { most }) else {
            return;
        };
        if share(axis) > 1.0 + FASTER {
            let (turn, speed) = ((to[axis] - from[axis]).abs(), self.arm.limits[axis].speed);
            self.record(index, m, Refusal::TooQuick { axis, turn, seconds, speed }, None, None);
        }
    }

    fn go(&mut self, index: usize, m: &Move) {
        *(if self.at.is_some() { &mut self.checked.followed } else { &mut self.checked.ends_only }) += 1;
        let tcp = &self.program.tools[m.tool].tcp;
        match (&m.motion, self.at) {
            (Motion::AbsoluteJoint(to), _) => self.stand_as_told(index, m, &to.joints),
            (Motion::Joint(to), _) => self.arrive(index, m, to, to.configuration.filter(|_| m.configuration_demanded)),
            (Motion::Linear(to) | Motion::Circular { to, .. }, None) => {
                let demanded = to.configuration.filter(|_| m.configuration_demanded);
                self.arrive(index, m, to, demanded);
            }
            (Motion::Linear(to), Some(q)) => {
                let way = Way::linear(&(self.arm.forward(&q) * tcp), &self.base_from_tcp(m, to));
                self.follow(index, m, to, &way, &q);
            }
            (Motion::Circular { via, to }, Some(q)) => {
                let (start, via, end) =
                    (self.arm.forward(&q) * tcp, self.base_from_tcp(m, via), self.base_from_tcp(m, to));
                let [a, b, c] = [&start, &via, &end].map(|pose| pose.translation.vector);
                match Circle::through(&a, &b, &c) {
                    Ok(circle) => self.follow(index, m, to, &Way::circular(&start, circle, &end.rotation), &q),
                    Err(why) => self.refuse(index, m, Refusal::NoArc(why), to.configuration, None),
                }
            }
        }
    }

    /// Takes the arm to a posture that the program tells.
    fn stand_as_told(&mut self, index: usize, m: &Move, joints: &Joints) {
        let refusal = beyond(self.arm, joints, 1.0);
        if refusal.is_none() {
            // The way there begins where the arm may only be assumed to stand.
            self.turn(index, m, *joints);
        }
        self.assumed = false;
        if let Some(refusal) = refusal {
            self.refuse(index, m, refusal, None, None);
        }
    }

    /// Whether what is demanded is not known to be a posture; told once.
    fn is_unknown(&mut self, index: usize, m: &Move, demanded: Option<[i32; 4]>) -> bool {
        let Some(demanded) = demanded.filter(|_| !self.arm.knows_configurations()) else { return false };
        if !self.told {
            self.told = true;
            self.record(index, m, Refusal::UnknownConfiguration { demanded }, None, None);
        }
        true
    }

    /// Where a posture was never known, the first turns of all axes.
    fn near(&self) -> Joints {
        self.last.unwrap_or([0.0; AXES])
    }

    fn stand(&mut self, at: Option<Joints>) {
        self.at = at;
        self.last = at.or(self.last);
    }

    /// The posture at a target, in the configuration if there is one.
    fn choose(
        &self,
        m: &Move,
        to: &PoseTarget,
        configuration: Option<[i32; 4]>,
    ) -> Result<Joints, (Refusal, Option<Fit>)> {
        posture::choose(self.arm, &self.flange(m, to), configuration, &self.near())
    }

    /// base_from_object · target.
    fn base_from_tcp(&self, m: &Move, target: &PoseTarget) -> Isometry3<f64> {
        self.program.work_objects[m.work_object].base_from_object() * target.pose
    }

    /// `base_from_flange` that puts the move's tool at the target.
    fn flange(&self, m: &Move, target: &PoseTarget) -> Isometry3<f64> {
        self.base_from_tcp(m, target) * self.program.tools[m.tool].tcp.inverse()
    }

    /// With the bodies of the move's own tool.
    fn followed(&self, m: &Move, way: &Way, start: &Joints) -> Result<Followed, Refusal> {
        let Carried { tool, bodies, .. } = &self.tools[m.tool];
        follow(self.arm, tool, Some(bodies), way, start, self.settings, &mut 0)
    }

    /// Notes where bodies of which neither is known meet on a move that is fine but for them.
    ///
    /// A collision of two bodies that are both stand-ins is no finding about the arm. It is looked for apart, after a
    /// move passed with all that is known, and is told as open. Any other refusal of that second look is left out: the
    /// first look had it.
    fn doubt(&mut self, index: usize, m: &Move, way: &Way, start: &Joints) {
        let Carried { tool, doubtful, .. } = &self.tools[m.tool];
        let Some(doubtful) = doubtful else { return };
        let followed = follow(self.arm, tool, Some(doubtful), way, start, self.settings, &mut 0);
        if let Err(refusal @ Refusal::SelfCollides { .. }) = followed {
            self.record(index, m, refusal, None, None);
        }
    }

    /// Takes the arm to the posture in joints; where it stands is not known, it only has to stand there.
    fn turn(&mut self, index: usize, m: &Move, end: Joints) {
        let refusal = match self.at {
            Some(start) => self.followed(m, &Way::Joint { start, end }, &start).err(),
            None => self.tools[m.tool].bodies.standing(&end, 1.0),
        };
        let tried = m.motion.end().and_then(|to| to.configuration);
        match refusal {
            Some(refusal) => self.record(index, m, refusal, tried, None),
            // Where it comes from is not known: it only has to stand there.
            None => self.doubt(index, m, &Way::Joint { start: self.at.unwrap_or(end), end }, &self.at.unwrap_or(end)),
        }
        self.stand(Some(end));
    }

    /// Takes the arm to the target in joints.
    ///
    /// Tried in this order: what is demanded; where nothing is demanded and nothing was ever known, the configuration
    /// that the target carries; else any, the nearest by Σ|Δq| to where the arm stood last.
    fn arrive(&mut self, index: usize, m: &Move, to: &PoseTarget, demanded: Option<[i32; 4]>) {
        // Nobody demands it, but where nothing else is known it is what the program's maker saw.
        let seen = to.configuration.filter(|_| demanded.is_none() && self.last.is_none());
        let unknown = self.is_unknown(index, m, demanded);
        let chosen = match seen {
            Some(_) => self.choose(m, to, seen).or_else(|_| self.choose(m, to, None)),
            None if unknown => self.choose(m, to, demanded).or_else(|_| self.choose(m, to, None)),
            None => self.choose(m, to, demanded),
        };
        match chosen {
            Ok(q) => {
                self.assumed |= unknown;
                self.turn(index, m, q);
            }
            Err((refusal, fit)) => {
                let assumed = self.assumed && self.unmet(m, to).is_none();
                self.refuse_as(index, m, (refusal, assumed), to.configuration, fit);
            }
        }
    }

    /// Why no posture at all has the target, where that is certain: it is so wherever the arm comes from.
    fn unmet(&self, m: &Move, to: &PoseTarget) -> Option<Refusal> {
        self.choose(m, to, None).err().map(|(refusal, _)| refusal).filter(|refusal| !refusal.is_open())
    }

    /// Takes the tool along the way, and looks at where that arrives if a configuration is demanded.
    fn follow(&mut self, index: usize, m: &Move, to: &PoseTarget, way: &Way, start: &Joints) {
        match self.followed(m, way, start) {
            Ok(followed) => {
                self.doubt(index, m, way, start);
                self.stand(Some(followed.end));
                let demanded = to.configuration.filter(|_| m.configuration_demanded);
                if self.is_unknown(index, m, demanded) {
                    return;
                }
                if let Some(demanded) = demanded.filter(|cf| !posture::has(self.arm, &followed.end, cf)) {
                    let arrives = self.arm.configuration(&followed.end).numbers();
                    self.refuse(index, m, Refusal::ArrivesOtherwise { demanded, arrives }, Some(demanded), None);
                }
            }
            Err(refusal) => {
                let tried = to.configuration.unwrap_or(self.arm.configuration(start).numbers());
                // What is not decided on the way decides nothing where the way has no end.
                if self.is_open(m, &refusal)
                    && let Some(unmet) = self.unmet(m, to)
                {
                    return self.refuse_as(index, m, (unmet, false), Some(tried), None);
                }
                let fit = self.remedy(m, way, start);
                self.refuse(index, m, refusal, Some(tried), fit);
            }
        }
    }

    /// The posture at the move's start from which it fits with the most room.
    ///
    /// Every other posture that has the same pose at the start is followed along the whole way: up to eight branches
    /// on all turns of the axes, each as dear as the move. Not looked for after 50 findings, nor for arms whose
    /// configurations are not known.
    fn remedy(&self, m: &Move, way: &Way, start: &Joints) -> Option<Fit> {
        if self.checked.findings.len() >= MOST_REMEDIES || !self.arm.knows_configurations() {
            return None;
        }
        let others = posture::within_limits(self.arm, &self.arm.forward(start), start);
        let fits = others.iter().filter_map(|other| self.followed(m, way, other).ok());
        let best = fits.max_by(|a, b| a.limit_margin.total_cmp(&b.limit_margin))?;
        Some(Fit { configuration: self.arm.configuration(&best.end).numbers(), margin: best.limit_margin })
    }

    /// Whether the refusal says nothing for certain of where the arm stands.
    fn is_open(&self, m: &Move, refusal: &Refusal) -> bool {
        let worth = Worth::of(self.arm, &self.tools[m.tool].tool, refusal);
        self.assumed || refusal.is_open() || matches!(worth, Worth::Undecidable(_))
    }

    /// Writes a finding down.
    fn record(&mut self, index: usize, m: &Move, refusal: Refusal, tried: Option<[i32; 4]>, fit: Option<Fit>) {
        self.record_as(index, m, (refusal, self.assumed), tried, fit);
    }

    /// Writes a finding down that rests on where the arm is `assumed` to stand, or does not.
    fn record_as(
        &mut self,
        index: usize,
        m: &Move,
        (refusal, assumed): (Refusal, bool),
        tried: Option<[i32; 4]>,
        fit: Option<Fit>,
    ) {
        let to = m.motion.name().map(Into::into);
        let worth = Worth::of(self.arm, &self.tools[m.tool].tool, &refusal);
        let unknown = assumed || refusal.is_open();
        let (estimated, open) = (worth.in_words(self.arm), unknown || matches!(worth, Worth::Undecidable(_)));
        let (line, from) = (m.line, self.from.clone());
        self.checked.findings.push(Finding { index, line, from, to, refusal, tried, fit, estimated, open });
    }

    /// Writes a finding down and moves on to the target, in its configuration if there is such a posture.
    fn refuse(&mut self, index: usize, m: &Move, refusal: Refusal, tried: Option<[i32; 4]>, fit: Option<Fit>) {
        self.refuse_as(index, m, (refusal, self.assumed), tried, fit);
    }

    /// The same of a finding that rests on where the arm is assumed to stand, or does not.
    fn refuse_as(&mut self, index: usize, m: &Move, found: (Refusal, bool), tried: Option<[i32; 4]>, fit: Option<Fit>) {
        self.record_as(index, m, found, tried, fit);
        let at = m.motion.end().and_then(|to| {
            let demanded = to.configuration.filter(|_| m.configuration_demanded);
            self.assumed |= demanded.is_some() && !self.arm.knows_configurations();
            self.choose(m, to, demanded).or_else(|_| self.choose(m, to, None)).ok()
        });
        self.stand(at);
    }
}
