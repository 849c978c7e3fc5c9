//! Whether a program is one that a controller would execute.
//!
//! Everything that a controller would stop at before or while it runs, found before anything is written: ABB,
//! "Technical reference manual: RAPID Instructions, Functions and Data types". Whether an arm reaches the targets is
//! not asked here.

use std::fmt;

use nalgebra::{Isometry3, Point3, Vector3};
use thiserror::Error;

use super::{Arc, External, Motion, Move, PoseTarget, Program};
use crate::math::rotation::angle_between;

/// Where in a program.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Place {
    /// Index of the move.
    pub index: usize,
    /// Its line, from 1, where it was read from a file.
    pub line: Option<usize>,
    /// Name of its end.
    pub name: Option<String>,
}

impl fmt::Display for Place {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            Some(line) => write!(f, "line {line}")?,
            None => write!(f, "move {}", self.index)?,
        }
        self.name.as_ref().map_or(Ok(()), |name| write!(f, " (to {name})"))
    }
}

/// Why a program cannot be executed.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ProgramError {
    /// A number out of its bound.
    #[error("{at}: {field} = {value}: must be {bound}")]
    Value {
        /// Which move.
        at: Place,
        /// Which number.
        field: &'static str,
        /// The value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// A number of a tool or work object out of its bound.
    #[error("{name}: {field} = {value}: must be {bound}")]
    Frame {
        /// Name of the tool or work object.
        name: String,
        /// Which number.
        field: &'static str,
        /// The value.
        value: f64,
        /// What it must be.
        bound: &'static str,
    },
    /// A move refers to a tool or work object that the program has not.
    #[error("{at}: {what} {index} of {count}")]
    Missing {
        /// Which move.
        at: Place,
        /// `tool` or `work object`.
        what: &'static str,
        /// The index.
        index: usize,
        /// How many there are.
        count: usize,
    },
    /// An arc has nowhere to start from.
    #[error("{at}: a program cannot begin with a circular move")]
    ArcFirst {
        /// Which move.
        at: Place,
    },
    /// Two points of an arc are too near to each other for the arc to be known.
    #[error("{at}: {which} are {distance_mm:.4} mm apart: must be {LEAST_CHORD_MM} mm at least")]
    ArcShort {
        /// Which move.
        at: Place,
        /// Which two.
        which: &'static str,
        /// Their distance, mm.
        distance_mm: f64,
    },
    /// The point on the way lies in line with the end.
    #[error(
        "{at}: seen from the start, point on the way and end are {angle_deg:.3}° apart: must be {LEAST_ANGLE_DEG}° at least"
    )]
    ArcFlat {
        /// Which move.
        at: Place,
        /// The angle, degrees.
        angle_deg: f64,
    },
    /// The arc is too long for one move.
    #[error("{at}: an arc of {angle_deg:.2}°: must be less than {MOST_ARC_DEG}°")]
    ArcLong {
        /// Which move.
        at: Place,
        /// The angle, degrees.
        angle_deg: f64,
    },
}

impl ProgramError {
    /// Which move it is about; `None` of tools and work objects.
    pub fn place(&self) -> Option<&Place> {
        match self {
            Self::Frame { .. } => None,
            Self::Value { at, .. }
            | Self::Missing { at, .. }
            | Self::ArcFirst { at }
            | Self::ArcShort { at, .. }
            | Self::ArcFlat { at, .. }
            | Self::ArcLong { at, .. } => Some(at),
        }
    }
}

/// Points of an arc are at least this far apart. (ABB, Technical reference manual, RAPID, `MoveC`.)
const LEAST_CHORD_MM: f64 = 0.1;
/// Seen from the start, point on the way and end are at least this far apart. (Ibid.)
const LEAST_ANGLE_DEG: f64 = 1.0;
/// Arcs are shorter than that. (Ibid.)
const MOST_ARC_DEG: f64 = 240.0;
/// Larger numbers are another unit or a slip: m, m/s, rad, rad/s alike.
const LARGEST: f64 = 1e4;
const POSITION: &str = "a finite number, at most 10 km";
const UNIT: &str = "of square 1 within 0.00001";

/// What a number of a program must be for a controller to take it.
///
/// One for all languages: of numbers that moves carry ([`Program::problems`]), and of those that a language says beside
/// them. Comparisons are such that NaN holds nowhere.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Bound {
    /// Whether 0 is too little.
    above: bool,
    most: f64,
    /// In words.
    words: &'static str,
}

impl Bound {
    /// Speed of the tool's centre point, m/s, where it is not as fast as the arm can: no arm's tool is faster, and mm/s
    /// for m/s, or one digit too many, are the usual slips.
    pub const SPEED: Self = Self::above("a number, more than 0 m/s and at most 20 m/s, or vmax", 20.0);
    /// The same in KRL, where more is an error at the statement, and mm/s are the usual slip. (KRC 4, `$VEL.CP`.)
    pub const KRL_SPEED: Self = Self::above("more than 0 m/s and at most 3 m/s", 3.0);
    /// The same in URScript: the most that safety settings can allow. (UR, general limits.)
    pub const URSCRIPT_SPEED: Self = Self::above("more than 0 m/s and at most 5 m/s", 5.0);
    /// Speed of axes in URScript, rad/s: no wrist turns faster than a turn in a second, and °/s are the usual slip.
    pub const URSCRIPT_JOINT_SPEED: Self = Self::above("more than 0 rad/s and at most 10 rad/s", 10.0);
    /// Speed of reorientation, °/s.
    pub const TURNING: Self = Self::above("a number, more than 0 °/s", f64::MAX);
    /// Acceleration of the tool's centre point, m/s².
    pub const ACCELERATION: Self = Self::above("a number, more than 0 m/s²", f64::MAX);
    /// Acceleration of axes, rad/s².
    pub const JOINT_ACCELERATION: Self = Self::above("a number, more than 0 rad/s²", f64::MAX);
    /// What a move is to take, s.
    pub const DURATION: Self = Self::above("more than 0 s and at most 10000 s", LARGEST);
    /// A share of what axes can.
    pub const PERCENT: Self = Self::above("more than 0 % and at most 100 %", 100.0);
    /// Radii of corners, masses, speeds of what need not move.
    pub const NOT_NEGATIVE: Self = Self { above: false, most: LARGEST, words: "a number from 0 to 10000" };

    const fn above(words: &'static str, most: f64) -> Self {
        Self { above: true, most, words }
    }

    /// Whether a controller takes `value`.
    pub fn holds(self, value: f64) -> bool {
        (if self.above { value > 0.0 } else { value >= 0.0 }) && value <= self.most
    }

    /// What is wrong with `value`; `None` where it holds.
    pub fn refuse(self, at: Place, field: &'static str, value: f64) -> Option<ProgramError> {
        (!self.holds(value)).then_some(ProgramError::Value { at, field, value, bound: self.words })
    }
}

impl Program {
    /// The program itself, if it can be executed.
    ///
    /// # Errors
    /// The first of [`Program::problems`].
    pub fn checked(self) -> Result<Self, ProgramError> {
        match self.problems().into_iter().next() {
            Some(problem) => Err(problem),
            None => Ok(self),
        }
    }

    /// Everything that keeps the program from being executed, in its order: indices, numbers, quaternions, arcs.
    ///
    /// An arc that begins where a posture ended or where another tool was in use is not looked at: its start is known
    /// only to who knows the arm.
    ///
    /// Linear in the moves. An empty list says that the program loads, not that it is safe to run.
    pub fn problems(&self) -> Vec<ProgramError> {
        let mut found = Vec::new();
        self.check_frames(&mut found);
        for (index, m) in self.moves.iter().enumerate() {
            let check = Check { program: self, index, m };
            check.indices(&mut found);
            check.numbers(&mut found);
            check.arc(&mut found);
        }
        found
    }

    fn check_frames(&self, found: &mut Vec<ProgramError>) {
        let mut hold = |good: bool, name: &str, field, value, bound| {
            if !good {
                found.push(ProgramError::Frame { name: name.into(), field, value, bound });
            }
        };
        for tool in &self.tools {
            let (length, square) = (largest(&tool.tcp), tool.tcp.rotation.norm_squared());
            hold(length <= LARGEST, &tool.name, "position of the tool's centre point", length, POSITION);
            hold((square - 1.0).abs() <= 1e-5, &tool.name, "|q|²", square, UNIT);
            let mass = Bound::NOT_NEGATIVE;
            hold(mass.holds(tool.mass), &tool.name, "mass", tool.mass, mass.words);
        }
        for object in &self.work_objects {
            for frame in [&object.user, &object.object] {
                let (length, square) = (largest(frame), frame.rotation.norm_squared());
                hold(length <= LARGEST, &object.name, "position", length, POSITION);
                hold((square - 1.0).abs() <= 1e-5, &object.name, "|q|²", square, UNIT);
            }
        }
    }
}

/// One move under examination.
struct Check<'a> {
    program: &'a Program,
    index: usize,
    m: &'a Move,
}

impl Check<'_> {
    fn place(&self) -> Place {
        Place { index: self.index, line: self.m.line, name: self.m.motion.name().map(Into::into) }
    }

    fn indices(&self, found: &mut Vec<ProgramError>) {
        let counts = [
            ("tool", self.m.tool, self.program.tools.len()),
            ("work object", self.m.work_object, self.program.work_objects.len()),
        ];
        for (what, index, count) in counts {
            if index >= count {
                found.push(ProgramError::Missing { at: self.place(), what, index, count });
            }
        }
    }

    /// Comparisons are written so that NaN fails each. Infinity passes as the speed of the tool's point alone
    /// (`vmax`).
    fn numbers(&self, found: &mut Vec<ProgramError>) {
        let mut hold = |good: bool, field, value, bound| {
            if !good {
                found.push(ProgramError::Value { at: self.place(), field, value, bound });
            }
        };
        let (speed, zone) = (&self.m.speed, &self.m.zone);
        hold(speed.tcp == f64::INFINITY || Bound::SPEED.holds(speed.tcp), "tcp speed", speed.tcp, Bound::SPEED.words);
        for (field, value) in [
            ("orientation speed", speed.orientation),
            ("speed of linear external axes", speed.linear_external),
            ("speed of rotating external axes", speed.rotating_external),
            ("zone", zone.tcp),
            ("zone of reorientation", zone.path_orientation),
            ("zone of external axes", zone.path_external),
            ("angle of the zone", zone.orientation),
            ("zone of linear external axes", zone.linear_external),
            ("zone of rotating external axes", zone.rotating_external),
        ] {
            hold(Bound::NOT_NEGATIVE.holds(value), field, value, Bound::NOT_NEGATIVE.words);
        }
        if let Some(duration) = self.m.duration {
            hold(Bound::DURATION.holds(duration), "duration", duration, Bound::DURATION.words);
        }
        let mut external = |external: &External| {
            for value in external.iter().flatten() {
                hold(value.abs() <= 1e7, "external axis", *value, "a finite number, at most 10000000");
            }
        };
        if let Motion::AbsoluteJoint(target) = &self.m.motion {
            external(&target.external);
            for angle in target.joints {
                hold(angle.abs() <= LARGEST, "joint", angle, "a finite number, at most 10000 rad");
            }
        } else {
            self.m.motion.poses().for_each(|target| external(&target.external));
        }
        for PoseTarget { pose, .. } in self.m.motion.poses() {
            let (length, square) = (largest(pose), pose.rotation.norm_squared());
            hold(length <= LARGEST, "position", length, POSITION);
            hold((square - 1.0).abs() <= 1e-5, "|q|²", square, UNIT);
        }
    }

    /// Only the first that is wrong is told: 0.1 mm between any two points, 1° between via and end as seen from the
    /// start, 240° of arc. Three points on a line with via behind the start count as 360°, with via beyond the end
    /// as flat.
    fn arc(&self, found: &mut Vec<ProgramError>) {
        let Motion::Circular { via, to } = &self.m.motion else { return };
        let Some(previous) = self.index.checked_sub(1).and_then(|index| self.program.moves.get(index)) else {
            return found.push(ProgramError::ArcFirst { at: self.place() });
        };
        let Some(start) = self.start(previous) else { return };
        let points: [Point3<f64>; 3] = [start, via.pose, to.pose].map(|pose| pose.translation.vector.into());
        let [start, via, end] = &points;
        for (which, a, b) in [
            ("start and point on the way", start, via),
            ("start and end", start, end),
            ("point on the way and end", via, end),
        ] {
            let distance_mm = (b - a).norm() * 1e3;
            if distance_mm < LEAST_CHORD_MM {
                return found.push(ProgramError::ArcShort { at: self.place(), which, distance_mm });
            }
        }
        let angle_deg = angle_between(&(via - start), &(end - start)).to_degrees();
        if angle_deg < LEAST_ANGLE_DEG {
            return found.push(ProgramError::ArcFlat { at: self.place(), angle_deg });
        }
        let angle_deg = Arc::through(start, via, end).map_or(360.0, |arc| arc.angle.to_degrees());
        if angle_deg >= MOST_ARC_DEG {
            found.push(ProgramError::ArcLong { at: self.place(), angle_deg });
        }
    }

    /// Where the arc starts, in its own work object; `None` where that takes the arm's kinematics.
    ///
    /// object_from_tcp at the start = (base_from_object)⁻¹ · base_from_object′ · pose′, primes those of the move
    /// before.
    fn start(&self, previous: &Move) -> Option<Isometry3<f64>> {
        let pose = previous.motion.end()?.pose;
        if previous.tool != self.m.tool {
            return None;
        }
        if previous.work_object == self.m.work_object {
            return Some(pose);
        }
        let objects = &self.program.work_objects;
        let (before, now) = (objects.get(previous.work_object)?, objects.get(self.m.work_object)?);
        Some(now.base_from_object().inverse() * before.base_from_object() * pose)
    }
}

/// The largest coordinate by magnitude; NaN where one is not a number.
fn largest(pose: &Isometry3<f64>) -> f64 {
    let v: Vector3<f64> = pose.translation.vector;
    if v.iter().any(|x| x.is_nan()) { f64::NAN } else { v.amax() }
}
