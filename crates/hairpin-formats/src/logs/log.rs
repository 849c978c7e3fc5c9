//! What a log holds.

use nalgebra::{Point3, UnitQuaternion, Vector3};

use crate::frames::Geodetic;

/// A log, as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Logged {
    /// The format's name: `PX4 ULog`, `ArduPilot DataFlash`, `ROS 2 MCAP`, `TUM`, `CSV`.
    pub format: &'static str,
    /// Whose stamps the times are.
    pub clock: Clock,
    /// The frame of all positions.
    pub frame: LogFrame,
    /// Motions of the body, one a topic, in the order of [`Source`]: motion capture and ground truth before estimates,
    /// what was asked for last.
    pub motions: Vec<LoggedMotion>,
    /// Motions of an arm's joints.
    pub joints: Vec<Joints>,
    /// What the mission was at, in the order of time; empty where the log does not tell.
    pub progress: Vec<Progress>,
    /// What ended or changed the flight, in the order of time.
    pub events: Vec<Event>,
    /// Spans that the logger itself says it lost.
    pub dropouts: Vec<Span>,
    /// What a reader of the judgement should know: topics that were not read, messages that were skipped.
    pub notes: Vec<String>,
}

/// Whose stamps the times of a log are; all times of it are of the same clock.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Clock {
    /// Since the vehicle's computer was started.
    SinceBoot,
    /// The stamp in the messages' headers.
    Header,
    /// When the recorder received the messages.
    Receive,
    /// The file's first column.
    File,
}

/// A frame of positions.
#[derive(Debug, Clone, PartialEq)]
pub enum LogFrame {
    /// Not told by the format: taken for the world's own.
    Untold,
    /// East, north, up about a point: on Earth where the log knows it.
    Enu(Option<Geodetic>),
    /// A name that the log gives (ROS' `frame_id`).
    Named(String),
}

/// Who says where the body was.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub enum Source {
    /// Cameras around it.
    MotionCapture,
    /// The simulator.
    GroundTruth,
    /// The vehicle's own filter.
    Estimate,
    /// What that filter takes in: an odometry by cameras, say.
    Input,
    /// The format does not tell.
    Untold,
    /// The format does not tell, and it is a whole way at once: what a planner publishes, or a trail of what was moved.
    Way,
    /// By its name what was asked for: a command, a goal, a set point, a plan.
    Asked,
}

/// The motion of a body by one source.
#[derive(Debug, Clone, PartialEq)]
pub struct LoggedMotion {
    /// The topic or file it is from.
    pub name: String,
    /// Who says so.
    pub source: Source,
    /// Times strictly rising.
    pub samples: Vec<Sample>,
    /// Jumps of the estimate that it announces itself.
    pub resets: Vec<Reset>,
    /// Spans in which the source says that it is not valid, or is dead reckoning.
    pub invalid: Vec<Span>,
    /// Why nothing is to be judged by it, where that is so: it is at two places at one moment, or its clock was set
    /// back.
    pub unfit: Option<String>,
    /// How finely positions are told, where who reads them knows it.
    pub told_to: Option<ToldTo>,
    /// Why it has no heights, where that is so: its samples are at 0 m, wherever the body was.
    pub no_heights: Option<String>,
}

impl LoggedMotion {
    /// A motion of which no more is told than its samples.
    pub fn of(name: &str, source: Source, samples: Vec<Sample>) -> Self {
        let (resets, invalid, unfit, told_to, no_heights) = Default::default();
        Self { name: name.into(), source, samples, resets, invalid, unfit, told_to, no_heights }
    }
}

/// How finely positions are told.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum ToldTo {
    /// A text's last decimal, of the finest of its numbers, m.
    Decimal(f64),
    /// Steps along three axes at right angles, m; 0: exactly. Degrees have them, and metres made of degrees no longer
    /// show them.
    Steps([f64; 3]),
}

/// A body at a time.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// s.
    pub t_s: f64,
    /// Position, m.
    pub p_m: Point3<f64>,
    /// Attitude, world from body, where the log has it at about this time.
    pub attitude: Option<UnitQuaternion<f64>>,
    /// Velocity in the frame of positions, m/s.
    pub v_m_s: Option<Vector3<f64>>,
    /// Horizontal and vertical standard deviation that the source claims, m.
    pub accuracy_m: Option<[f64; 2]>,
}

/// The motion of an arm's joints.
#[derive(Debug, Clone, PartialEq)]
pub struct Joints {
    /// The topic or file.
    pub name: String,
    /// Who says so: [`Source::Asked`] of what by its name is a command.
    pub source: Source,
    /// Names of the joints, in the order of values.
    pub joints: Vec<String>,
    /// Strictly rising, s.
    pub times_s: Vec<f64>,
    /// One row a time, rad.
    pub positions_rad: Vec<Vec<f64>>,
    /// Why nothing is to be judged by it, where that is so: two positions of a joint at one moment.
    pub unfit: Option<String>,
}

/// From `t_s` on the mission flies to its item `item` (numbered from 0 in the mission as uploaded, take-off and speed
/// items counted).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Progress {
    /// s.
    pub t_s: f64,
    /// The item.
    pub item: u32,
    /// How many the mission as uploaded has, where the log says it.
    pub of: Option<u32>,
    /// The place that is flown to, in the frame of positions, where the log has it.
    pub target_m: Option<Point3<f64>>,
}

/// A jump of the estimate that is no motion: at `t_s` positions changed by `by_m`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reset {
    /// s.
    pub t_s: f64,
    /// m; `None` where only the counter tells (or the reference on Earth was moved).
    pub by_m: Option<Vector3<f64>>,
}

/// What happened.
#[derive(Debug, Clone, PartialEq)]
pub struct Event {
    /// s.
    pub t_s: f64,
    /// Which kind.
    pub kind: EventKind,
    /// In the log's own words: `nav_state AUTO_RTL`, `failsafe`.
    pub words: String,
}

/// Kinds of events.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum EventKind {
    /// The mission is flown by the autopilot from here.
    MissionBegins,
    /// It is no more: return, hold, landing, a pilot's take-over.
    MissionEnds,
    /// A failsafe.
    Failsafe,
    /// A geofence was crossed.
    Geofence,
    /// On the ground.
    Landed,
    /// In the air.
    TookOff,
    /// A mode that flies no mission: of logs that tell modes, none of which is a mission's.
    OtherMode,
}

/// From a time to a time, s.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Span {
    /// s.
    pub from_s: f64,
    /// s.
    pub to_s: f64,
}
