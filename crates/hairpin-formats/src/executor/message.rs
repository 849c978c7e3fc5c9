//! What hairpin says, as types; their field names are the protocol's.

use hairpin::campaign::Mission;
use hairpin::campaign::kind::Handed;
use serde::Serialize;
use serde_json::Value;

use super::acceptance;
use super::greeting::Greeting;

/// Bytes of a message, and of a row of its timed motion: most need no more.
const ROOM: usize = 4 << 10;
const ROOM_OF_A_ROW: usize = 180;

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
    pub fn line(&self) -> Vec<u8> {
        let rows = if let Self::Mission(mission) = self { mission.timed.len() } else { 0 };
        let mut line = Vec::with_capacity(ROOM + rows * ROOM_OF_A_ROW);
        serde_json::to_writer(&mut line, self).expect("messages are trees of strings and finite numbers");
        if let Self::Mission(mission) = self {
            // Inside of the object, which ends here.
            line.pop();
            write_timed(&mut line, &mission.timed);
            line.push(b'}');
        }
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
    /// From protocol 2 on.
    #[serde(flatten)]
    more: Option<MoreOfMission>,
    time_limit_s: f64,
    /// The planned motion, its last key: nearly all of its length, and written by [`write_timed`] in half the time.
    #[serde(skip)]
    timed: Vec<TimedRow>,
}

/// A sample of the planned motion: `t_s`, the three of `p_m`, the three of `v_m_s`.
type TimedRow = [f64; 7];
/// What stands before each number of a row.
const BEFORE: [&str; 7] = ["{\"t_s\":", ",\"p_m\":[", ",", ",", "],\"v_m_s\":[", ",", ","];

/// The key `timed` behind others.
fn write_timed(line: &mut Vec<u8>, rows: &[TimedRow]) {
    line.extend_from_slice(b",\"timed\":[");
    for (index, row) in rows.iter().enumerate() {
        if index > 0 {
            line.push(b',');
        }
        for (words, number) in BEFORE.iter().zip(row) {
            line.extend_from_slice(words.as_bytes());
            serde_json::to_writer(&mut *line, number).expect("memory takes all");
        }
        line.extend_from_slice(b"]}");
    }
    line.push(b']');
}

/// What missions of protocol 2 have beside those of protocol 1.
#[derive(Debug, Clone, PartialEq, Serialize)]
struct MoreOfMission {
    /// Planned heading at each waypoint, counter-clockwise from x.
    yaw_rad: Vec<f64>,
    /// The limits that the plan keeps to: `generate.limits`, those that are in force.
    limits: Value,
    /// Where a waypoint counts as reached.
    accept: AcceptMessage,
}

/// An upright cylinder about a waypoint.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
struct AcceptMessage {
    /// Seen from above.
    radius_m: f64,
    /// Above and below.
    height_m: f64,
}

/// What a mission looks like to an executor. A robot that flies has all its numbers, derived ones too; one that drives
/// has its file's, and its map is the campaign folder's.
///
/// What protocol 2 added is left out of protocol 1, whose programs may mind what they do not know.
pub fn mission_message(mission: &Mission, to: &Greeting) -> ToExecutor {
    let wanted = if to.timed == Some(false) { &[] } else { &mission.timed[..] };
    let timed = wanted.iter().map(|sample| {
        let (p, v) = (sample.position, sample.velocity);
        [sample.t, p.x, p.y, p.z, v.x, v.y, v.z]
    });
    let Handed { robot, world, external_force, limits, .. } = mission.setup.handed();
    let (radius_m, height_m) = (mission.accept, acceptance::height(mission));
    let more = || MoreOfMission { yaw_rad: mission.yaws.clone(), limits, accept: AcceptMessage { radius_m, height_m } };
    ToExecutor::Mission(Box::new(MissionMessage {
        case: mission.case.clone(),
        run: mission.run,
        seed: mission.seed,
        robot,
        world,
        external_force_n: external_force,
        waypoints_m: mission.waypoints.iter().map(|p| p.coords.into()).collect(),
        accept_m: mission.accept,
        more: (to.protocol > 1).then(more),
        time_limit_s: mission.time_limit,
        timed: timed.collect(),
    }))
}

/// What tells one mission from another: BLAKE3 of its message, whatever its case is called.
pub(super) fn mission_key(mission: &Mission) -> [u8; 32] {
    let mut message = mission_message(mission, &Greeting { protocol: 2, ..Greeting::default() });
    if let ToExecutor::Mission(message) = &mut message {
        message.case.clear();
    }
    blake3::hash(&message.line()).into()
}
