//! A robot's program as data: what RAPID, KRL and URScript all say, unrolled to one move after the other, in SI.
//!
//! Languages are read into a [`Program`] and written from one; nothing here knows any of them. Names of targets, speeds
//! and zones are kept so that what is written can be recognised by who wrote it.
//!
//! Data flow: a language's file → [`Program`] → [`Program::checked`] → planned, executed and judged, or written in
//! another language. Poses are in their work object, as they were written: nothing is resolved to the base before an
//! arm asks for it, so that reading and writing is the identity.

mod arc;
mod check;
mod digits;
mod frames;
mod speed;
mod target;
mod zone;

#[cfg(feature = "unit-tests")]
mod tests;

pub use arc::Arc;
pub use check::{Bound, Place, ProgramError};
pub use digits::{DECIMALS, QUATERNION_DECIMALS};
pub use frames::{Tool, WorkObject, unit_quaternion};
pub use speed::Speed;
pub use target::{External, JointTarget, Motion, NO_EXTERNAL, PoseTarget};
pub use zone::Zone;

/// A program: moves in the order in which they are executed.
///
/// ```
/// use hairpin::trajectory::program::{Motion, Move, PoseTarget, Program, Speed, Tool, WorkObject, Zone};
/// use nalgebra::Isometry3;
///
/// let mut program = Program::new("Stress", "main", Tool::flange(), WorkObject::base());
/// let target = PoseTarget::unnamed(Isometry3::translation(0.4, 0.0, 0.3)).named("p10");
/// let speed = Speed::predefined("v1000").expect("controllers have it");
/// program.moves.push(Move::new(Motion::Linear(target), speed, Zone::stop()));
/// assert!(program.problems().is_empty());
/// assert_eq!(program.moves[0].speed.tcp, 1.0); // m/s
/// ```
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Program {
    /// Name of the module or file.
    pub name: String,
    /// Name of the procedure that holds the moves.
    pub procedure: String,
    /// Tools that moves refer to.
    pub tools: Vec<Tool>,
    /// Work objects that moves refer to.
    pub work_objects: Vec<WorkObject>,
    /// The moves.
    pub moves: Vec<Move>,
}

/// One move from wherever the arm is to a target.
///
/// A move begins where the one before ended, the first where the arm stands; `zone` is what happens at its own end.
#[derive(Debug, Clone, PartialEq)]
pub struct Move {
    /// How, and where to.
    pub motion: Motion,
    /// How fast.
    pub speed: Speed,
    /// How near.
    pub zone: Zone,
    /// What it is to take, s, whatever the speed says.
    pub duration: Option<f64>,
    /// Index into [`Program::tools`].
    pub tool: usize,
    /// Index into [`Program::work_objects`].
    pub work_object: usize,
    /// Whether the target's configuration is demanded (RAPID's ConfL and ConfJ), or the nearest one will do.
    pub configuration_demanded: bool,
    /// Line of the file that it was read from, from 1.
    pub line: Option<usize>,
}

impl Program {
    /// The same program with every joint target's angles, rad, as `to` makes them.
    pub fn with_joints(&self, to: impl Fn(&[f64; 6]) -> [f64; 6]) -> Self {
        let mut program = self.clone();
        for one in &mut program.moves {
            if let Motion::AbsoluteJoint(target) = &mut one.motion {
                target.joints = to(&target.joints);
            }
        }
        program
    }

    /// A program without moves, for one tool and one work object.
    pub fn new(name: &str, procedure: &str, tool: Tool, work_object: WorkObject) -> Self {
        Self {
            name: name.into(),
            procedure: procedure.into(),
            tools: vec![tool],
            work_objects: vec![work_object],
            moves: Vec::new(),
        }
    }

    /// The same program with no component of any speed above `cap`'s, for a first run: `_slow` after both names, cut to
    /// `longest` characters, and no move timed.
    ///
    /// For the first run on a real arm: the same path, slower.
    pub fn slowed(&self, cap: &Speed, longest: usize) -> Self {
        let named = |name: &str| {
            let room = longest.saturating_sub("_slow".len());
            name.chars().take(room).chain("_slow".chars()).collect()
        };
        let slow = |m: &Move| Move { speed: m.speed.capped(cap), duration: None, ..m.clone() };
        Self {
            name: named(&self.name),
            procedure: named(&self.procedure),
            moves: self.moves.iter().map(slow).collect(),
            ..self.clone()
        }
    }
}

impl Move {
    /// A move with the program's first tool and work object, its configuration demanded.
    pub fn new(motion: Motion, speed: Speed, zone: Zone) -> Self {
        Self { motion, speed, zone, duration: None, tool: 0, work_object: 0, configuration_demanded: true, line: None }
    }
}
