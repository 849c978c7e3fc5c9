//! The executor protocol: a program of the user's, in any language, flies our missions over stdin and stdout.
//!
//! UTF-8, one JSON object a line; its stderr is its log; one mission at a time per process:
//!
//! ```text
//! > {"type":"hello","hairpin":2}
//! < {"type":"ready","protocol":2,"name":"my simulator","version":"1.4","deterministic":true,"timed":false}
//! > {"type":"reset","case":"0117","run":0}
//! < {"type":"ready","case":"0117","run":0}
//! > {"type":"mission","case":"0117","run":0,"seed":123,"robot":{…},"world":{…},"waypoints_m":[[x,y,z],…],
//!    "accept_m":1.0,"yaw_rad":[…],"limits":{…},"accept":{"radius_m":1.0,"height_m":1.0},"time_limit_s":90,
//!    "timed":[{"t_s":…,"p_m":[…],"v_m_s":[…]},…]}
//! < {"type":"pose","case":"0117","run":0,"t_s":0.01,"p_m":[…],"q_wxyz":[…],"v_m_s":[…],"leg":0}
//! < {"type":"poses","case":"0117","run":0,"poses":[[t,x,y,z,qw,qx,qy,qz,vx,vy,vz,leg],…]}
//! < {"type":"end","case":"0117","run":0,"reason":"done|time|crash"}   or   {"type":"error","message":"…"}
//! > {"type":"bye"}
//! ```
//!
//! t is from 0, strictly rising; places are in the world frame. Answers carry the case and the run that they are of,
//! and count for these alone. In protocol 1 they do not, and there are neither `reset` nor `poses`, nor `yaw_rad`,
//! `limits` and `accept`; a program that answers `hello` with 1, with an error, or by ending is started again and
//! spoken to in protocol 1. There, what comes after an `end` is a mistake of the mission that ended.
//!
//! The first pose lies at the first waypoint, `leg` counts from 0 and is in all poses, never falling, or in none, and
//! `v_m_s` are the velocities of these places ([`crate::velocities`]): what is otherwise would be judged as a violation
//! that nobody flew, or pass for none, so it is refused ([`PoseError`]). `leg`, `v_m_s` and `q_wxyz` may be left
//! out: legs are then assigned along the path, velocities differentiated, and the attitude counts as unknown (channel
//! [`hairpin::trajectory::ATTITUDE_UNKNOWN`]). `done` may be claimed anywhere: the judge sees what was flown, and a
//! `done` without the last waypoint is an unfinished mission. Who passes on flights of others and was not told how one
//! ended says what it takes it for with `"assumed":true` ([`hairpin::trajectory::END_UNSAID`]); without a `reason` an
//! `end` is a mistake.
//!
//! Of what drives on a map, z = 0 in all poses of a mission is no height, as planar simulators have none: heights are
//! then those of the vehicle on the map's ground (channel [`hairpin::trajectory::HEIGHTS_BY_MAP`],
//! [`OnGround`](hairpin::campaign::OnGround)), and the velocities that were sent are not taken. Where it cannot stand,
//! its height must be told.
//!
//! `"timed":false` in the first `ready` asks for missions without the planned motion, which is nearly all of their
//! length.
//!
//! Missions of drives under a steady force say it in `external_force_n` (east, north, up, N).
//!
//! Whatever the program does wrong fails the mission it was flying and no other: the process is ended with all its
//! children, the end of its stderr is kept, and a new one is started for the next mission.

mod acceptance;
mod answer;
mod command;
mod envelope;
mod failure;
mod first_pose;
mod greeting;
mod heard;
mod in_loop;
mod line;
mod lines;
mod message;
mod patience;
mod pilot;
mod pool;
mod process;
mod queue;
mod recording;
#[cfg(test)]
mod tests;
mod watchdog;
mod wire;
mod worker;

pub use answer::{Answer, read_flight};
pub use command::{Command, CommandError};
pub(crate) use failure::excerpt;
pub use failure::{Failed, Failure, was_never_asked};
pub use first_pose::{Elsewhere, Slip};
pub use greeting::Greeting;
pub use heard::{EndReason, FromExecutor, PoseMessage};
pub use in_loop::InLoop;
pub(crate) use lines::{Line, Lines, Tail};
pub use message::{ToExecutor, mission_message};
pub use process::kill_all;
pub(crate) use process::{end, start};
pub use queue::{fly_all, fly_all_if};
pub use recording::{PoseError, Recording};
pub use wire::{Said, Speaker, Transcript, Wire};
pub use worker::{Limits, QUIET, Worker};
