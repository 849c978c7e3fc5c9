//! The messages of the protocol as types; their field names are the protocol's.

use hairpin::campaign::Mission;
use hairpin::campaign::kind::Handed;
use serde::{Deserialize, Serialize};
use serde_json::Value;

/// What hairpin says.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum ToExecutor {
    /// First line; `hairpin` is the version of the protocol.
    Hello {
        /// 2, or 1.
        hairpin: u64,
    },
    /// Protocol 2: what comes next is this mission, and nothing of the one before; answered by `ready`.
    Reset {
        /// The case.
        case: String,
        /// Its run.
        run: usize,
    },
    /// Fly this.
    Mission(Box<MissionMessage>),
    /// No more missions; exit.
    Bye,
}

impl ToExecutor {
    /// As it is sent, with the end of its line.
    pub(super) fn line(&self) -> Vec<u8> {
        let mut line = serde_json::to_vec(self).expect("messages are trees of strings and finite numbers");
        line.push(b'\n');
        line
    }
}

/// One mission, world frame, SI.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MissionMessage {
    case: String,
    run: usize,
    seed: u64,
    /// The robot's numbers.
    robot: Value,
    world: Value,
    /// Steady force on it, east, north, up, where there is one.
    #[serde(skip_serializing_if = "Option::is_none")]
    external_force_n: Option<[f64; 3]>,
    waypoints_m: Vec<[f64; 3]>,
    accept_m: f64,
    time_limit_s: f64,
    timed: Vec<TimedMessage>,
}

/// One sample of the planned motion.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct TimedMessage {
    /// Stamp.
    pub t_s: f64,
    /// Position.
    pub p_m: [f64; 3],
    /// Velocity.
    pub v_m_s: [f64; 3],
}

/// What a mission looks like to an executor. A robot that flies has all its numbers, derived ones too; one that drives
/// has its file's, and its map is the campaign folder's.
pub fn mission_message(mission: &Mission) -> ToExecutor {
    let timed = mission.timed.iter().map(|sample| TimedMessage {
        t_s: sample.t,
        p_m: sample.position.coords.into(),
        v_m_s: sample.velocity.into(),
    });
    let Handed { robot, world, external_force, .. } = mission.setup.handed();
    ToExecutor::Mission(Box::new(MissionMessage {
        case: mission.case.clone(),
        run: mission.run,
        seed: mission.seed,
        robot,
        world,
        external_force_n: external_force,
        waypoints_m: mission.waypoints.iter().map(|p| p.coords.into()).collect(),
        accept_m: mission.accept,
        time_limit_s: mission.time_limit,
        timed: timed.collect(),
    }))
}

/// What tells one mission from another: BLAKE3 of its message, whatever its case is called.
pub(super) fn mission_key(mission: &Mission) -> [u8; 32] {
    let mut message = mission_message(mission);
    if let ToExecutor::Mission(message) = &mut message {
        message.case.clear();
    }
    blake3::hash(&message.line()).into()
}

/// What the executor says. Fields that we do not know are ignored. From protocol 2 on, answers say by `case` and `run`
/// what they are of.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(tag = "type", rename_all = "lowercase")]
pub enum FromExecutor {
    /// The answer to `hello` and, with case and run, to `reset`.
    Ready {
        /// Version of the protocol it speaks.
        protocol: Option<u64>,
        /// What it calls itself.
        #[serde(default)]
        name: String,
        /// Of which case.
        case: Option<Value>,
        /// Of which run.
        run: Option<Value>,
    },
    /// Where the robot is.
    Pose(PoseMessage),
    /// The same, many at once: `[t, x, y, z, qw, qx, qy, qz, vx, vy, vz, leg]` each, `null` where it is not known.
    Poses {
        /// A row each.
        poses: Vec<Vec<Option<f64>>>,
        /// Of which case.
        case: Option<Value>,
        /// Of which run.
        run: Option<Value>,
    },
    /// The flight is over.
    End {
        /// Why.
        reason: EndReason,
        /// Of which case.
        case: Option<Value>,
        /// Of which run.
        run: Option<Value>,
    },
    /// The mission could not be flown.
    Error {
        /// Why.
        message: String,
        /// Of which case.
        case: Option<Value>,
        /// Of which run.
        run: Option<Value>,
    },
}

impl FromExecutor {
    /// The value of `type`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::Ready { .. } => "ready",
            Self::Pose(_) => "pose",
            Self::Poses { .. } => "poses",
            Self::End { .. } => "end",
            Self::Error { .. } => "error",
        }
    }

    /// The case and the run that it is of, where it says so.
    pub fn envelope(&self) -> [Option<&Value>; 2] {
        match self {
            Self::Pose(PoseMessage { case, run, .. })
            | Self::Ready { case, run, .. }
            | Self::Poses { case, run, .. }
            | Self::End { case, run, .. }
            | Self::Error { case, run, .. } => [case.as_ref(), run.as_ref()],
        }
    }
}

/// One pose in the world frame.
#[derive(Debug, Clone, PartialEq, Deserialize)]
pub struct PoseMessage {
    /// Stamp: 0 at the start, strictly rising.
    pub t_s: f64,
    /// Position.
    pub p_m: [f64; 3],
    /// Attitude, `world_from_body`, w first. It counts as unknown unless every pose has it.
    pub q_wxyz: Option<[f64; 4]>,
    /// Velocity; differentiated from positions unless every pose has it.
    pub v_m_s: Option<[f64; 3]>,
    /// The leg being flown, numbered by its first waypoint; assigned along the path unless every pose has it.
    pub leg: Option<u64>,
    /// Of which case.
    pub case: Option<Value>,
    /// Of which run.
    pub run: Option<Value>,
}

impl PoseMessage {
    /// That of a row of `poses`; what is wrong with the row where it is none.
    ///
    /// # Errors
    /// Another number of columns, no time or place, a leg that is no whole number.
    pub fn of_row(row: &[Option<f64>]) -> Result<Self, String> {
        let &[t, x, y, z, qw, qx, qy, qz, vx, vy, vz, leg] = row else {
            return Err(format!("has {} numbers: must be 12", row.len()));
        };
        let (Some(t_s), Some(x), Some(y), Some(z)) = (t, x, y, z) else {
            return Err("has no time or no place".to_owned());
        };
        let whole = |leg: f64| match leg {
            leg if (0.0..=1e9).contains(&leg) && leg.fract() == 0.0 => Ok(leg as u64),
            _ => Err(format!("has leg = {leg}: must be a whole number from 0")),
        };
        let q_wxyz = || Some([qw?, qx?, qy?, qz?]);
        let v_m_s = || Some([vx?, vy?, vz?]);
        let leg = leg.map(whole).transpose()?;
        Ok(Self { t_s, p_m: [x, y, z], q_wxyz: q_wxyz(), v_m_s: v_m_s(), leg, case: None, run: None })
    }
}

/// Why the flight is over.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum EndReason {
    /// The last waypoint was reached.
    Done,
    /// The time limit came first.
    Time,
    /// It crashed.
    Crash,
}
