//! How fast a program flies, and what of that the protocol takes.

use std::time::{Duration, Instant};

use hairpin::campaign::Mission;
use hairpin::trajectory::Flight;
use hairpin_formats::executor::{Greeting, QUIET, Said, Speaker, Transcript, mission_message, read_flight};

/// How fast it is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Speed {
    /// Missions that were flown for it, one after the other by one process.
    pub missions: usize,
    /// Missions a second.
    pub executions_per_s: f64,
    /// Simulated seconds a second.
    pub real_time: f64,
    /// Poses of a mission.
    pub poses: usize,
    /// What the protocol takes of a mission beside its poses, ms: the mission is written, and in protocol 2 `reset` is
    /// answered, by the program's own time.
    pub protocol_ms_per_mission: f64,
    /// What it takes us to read a pose, µs.
    pub protocol_us_per_pose: f64,
}

/// Flown for speed: so many at most, and no more after so long.
pub(super) const MOST: usize = 50;
pub(super) const LONGEST: Duration = Duration::from_secs(2);
/// Answers are read so often to time it.
const READINGS: u32 = 5;

/// One mission's share.
pub(super) struct Timed {
    /// From `reset` to its `ready`.
    reset: Option<Duration>,
    /// Writing the mission.
    written: Duration,
    /// Reading the answer.
    read: Duration,
}

/// What of one mission the protocol took that `greeting` speaks, as its `transcript` has it.
pub(super) fn timed(mission: &Mission, greeting: &Greeting, transcript: &Transcript) -> Timed {
    let (said, protocol) = (&transcript.said, greeting.protocol);
    let reset = (protocol > 1).then(|| answered_within(said)).flatten();
    let begun = Instant::now();
    let line = mission_message(mission, greeting).line();
    let written = begun.elapsed();
    drop(line);
    let after = said.iter().position(|said| said.line.starts_with("{\"type\":\"mission\"")).map_or(0, |at| at + 1);
    let lines: Vec<&str> =
        said[after..].iter().filter(|said| said.by == Speaker::Program).map(|said| said.line.as_str()).collect();
    let begun = Instant::now();
    for _ in 0..READINGS {
        drop(read_flight(mission, protocol, &lines));
    }
    Timed { reset, written, read: begun.elapsed() / READINGS }
}

/// How soon the first line of ours was answered.
fn answered_within(said: &[Said]) -> Option<Duration> {
    let asked = said.iter().position(|said| said.by == Speaker::Hairpin)?;
    let answer = said[asked..].iter().find(|said| said.by == Speaker::Program)?;
    Some(answer.at.duration_since(said[asked].at))
}

impl Speed {
    /// Of missions that took `elapsed`, each like `flight`.
    pub(super) fn of(flight: &Flight, elapsed: Duration, timed: &[Timed]) -> Self {
        let (missions, poses) = (timed.len(), flight.track.len());
        let seconds = elapsed.as_secs_f64().max(1e-9);
        let simulated = flight.track.times().last().copied().unwrap_or_default();
        let of_mission = |one: &Timed| one.reset.unwrap_or(QUIET) + one.written;
        Self {
            missions,
            executions_per_s: missions as f64 / seconds,
            real_time: missions as f64 * simulated / seconds,
            poses,
            protocol_ms_per_mission: 1e3 * median(timed.iter().map(of_mission)),
            protocol_us_per_pose: 1e6 * median(timed.iter().map(|one| one.read)) / poses.max(1) as f64,
        }
    }
}

/// s; of nothing 0.
fn median(all: impl Iterator<Item = Duration>) -> f64 {
    let mut all: Vec<Duration> = all.collect();
    all.sort_unstable();
    all.get(all.len() / 2).map_or(0.0, Duration::as_secs_f64)
}
