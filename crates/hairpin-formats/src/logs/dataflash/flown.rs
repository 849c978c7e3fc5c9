//! What an ArduPilot flew when: modes, commands of the mission, events and errors.

use nalgebra::Point3;

use super::super::log::{Event, EventKind, Progress, Reset};
use super::super::modes::{Flies, Modes, in_order};
use super::place::{between, geodetic};
use super::stream::Message;
use crate::frames::Geodetic;

/// Entries of each kind at most.
const MOST: usize = 100_000;
/// Commands nearer to another are those of the whole mission, written when the log begins, s.
const TOGETHER: f64 = 0.05;
/// An origin that moves by less has not moved, m.
const SAME: f64 = 0.01;

/// Modes by number, of the vehicles that hairpin knows: what flies a mission, what is flown from outside, and others
/// by name.
const COPTER: [(f64, &str); 8] = [
    (0.0, "STABILIZE"),
    (2.0, "ALT_HOLD"),
    (3.0, "AUTO"),
    (4.0, "GUIDED"),
    (5.0, "LOITER"),
    (6.0, "RTL"),
    (9.0, "LAND"),
    (17.0, "BRAKE"),
];
const ROVER: [(f64, &str); 7] =
    [(0.0, "MANUAL"), (1.0, "ACRO"), (3.0, "STEERING"), (4.0, "HOLD"), (10.0, "AUTO"), (11.0, "RTL"), (15.0, "GUIDED")];
const PLANE: [(f64, &str); 16] = [
    (0.0, "MANUAL"),
    (1.0, "CIRCLE"),
    (2.0, "STABILIZE"),
    (4.0, "ACRO"),
    (5.0, "FBWA"),
    (6.0, "FBWB"),
    (7.0, "CRUISE"),
    (10.0, "AUTO"),
    (11.0, "RTL"),
    (12.0, "LOITER"),
    (13.0, "TAKEOFF"),
    (15.0, "GUIDED"),
    (17.0, "QSTABILIZE"),
    (18.0, "QHOVER"),
    (19.0, "QLOITER"),
    (20.0, "QLAND"),
];
const SUB: [(f64, &str); 7] = [
    (0.0, "STABILIZE"),
    (1.0, "ACRO"),
    (2.0, "ALT_HOLD"),
    (3.0, "AUTO"),
    (4.0, "GUIDED"),
    (16.0, "POSHOLD"),
    (19.0, "MANUAL"),
];
/// What is flown in a mode.
fn flies(mode: &str) -> Flies {
    match mode {
        "AUTO" => Flies::Uploaded,
        "GUIDED" => Flies::Sent,
        _ => Flies::Other,
    }
}

/// A command of a mission: when, its number, where.
type Command = (f64, u32, Option<Geodetic>);

/// What was flown.
#[derive(Debug, Default)]
pub(super) struct Flown {
    modes: Option<&'static [(f64, &'static str)]>,
    /// Of MISE, which is written when a command begins, and of CMD, which is also written for all at the beginning.
    begun: Vec<Command>,
    written: Vec<Command>,
    numbers: Vec<(f64, f64)>,
    events: Vec<Event>,
    resets: Vec<Reset>,
}

impl Flown {
    fn tell(&mut self, t_s: f64, kind: EventKind, words: String) {
        if self.events.len() < MOST {
            self.events.push(Event { t_s, kind, words });
        }
    }

    /// The filter's origin was set, or moved.
    pub(super) fn origin(&mut self, t_s: f64, before: Option<Geodetic>, now: &Geodetic) {
        if before.is_some_and(|before| between(&before, now).norm() > SAME) && self.resets.len() < MOST {
            self.resets.push(Reset { t_s, by_m: None });
        }
    }

    pub(super) fn resets(&self) -> Vec<Reset> {
        self.resets.clone()
    }

    pub(super) fn take(&mut self, message: &Message, t_s: f64, home: Option<Geodetic>) {
        let number = |name: &str| message.number(name);
        match &message.format.name[..] {
            "MSG" => {
                let text = message.text("Message").unwrap_or_default();
                let of = |word: &str| text.starts_with(word);
                self.modes = match () {
                    () if of("ArduCopter") => Some(&COPTER),
                    () if of("ArduRover") || of("Rover") => Some(&ROVER),
                    () if of("ArduPlane") => Some(&PLANE),
                    () if of("ArduSub") => Some(&SUB),
                    () => self.modes,
                };
            }
            "MODE" => {
                if let Some(mode) = number("ModeNum").or_else(|| number("Mode")).filter(|_| self.numbers.len() < MOST) {
                    self.numbers.push((t_s, mode));
                }
            }
            kind @ ("CMD" | "MISE") => {
                let Some(item) = number("CNum").filter(|item| (1.0..65_536.0).contains(item)) else { return };
                let place = message.numbers(["Lat", "Lng", "Alt"]).and_then(geodetic);
                // 0: above the sea; 3: above home; others are not told here.
                let place = match number("Frame") {
                    Some(0.0) => place,
                    Some(3.0) => place
                        .zip(home)
                        .map(|(place, home)| Geodetic { alt_amsl_m: place.alt_amsl_m + home.alt_amsl_m, ..place }),
                    _ => None,
                };
                let commands = if kind == "MISE" { &mut self.begun } else { &mut self.written };
                if commands.len() < MOST {
                    // Home is item 0 of ArduPilot's, and none of the mission's.
                    commands.push((t_s, item as u32 - 1, place));
                }
            }
            "EV" => match number("Id") {
                Some(18.0) => self.tell(t_s, EventKind::Landed, "EV land complete".into()),
                Some(28.0) => self.tell(t_s, EventKind::TookOff, "EV not landed".into()),
                _ => {}
            },
            "ERR" => {
                let (Some(part), Some(code)) = (number("Subsys"), number("ECode").filter(|code| *code > 0.0)) else {
                    return;
                };
                let kind = if part == 9.0 { EventKind::Geofence } else { EventKind::Failsafe };
                self.tell(t_s, kind, format!("ERR subsystem {part}, code {code}"));
            }
            _ => {}
        }
    }

    pub(super) fn progress(&self, place: impl Fn(&Geodetic) -> Option<Point3<f64>>) -> Vec<Progress> {
        let near = |index: usize, other: Option<usize>| {
            let other = other.and_then(|other| self.written.get(other));
            other.is_some_and(|(at, ..)| (at - self.written[index].0).abs() < TOGETHER)
        };
        let alone = |(index, command): (usize, &Command)| {
            (!near(index, index.checked_sub(1)) && !near(index, Some(index + 1))).then_some(*command)
        };
        let commands: Vec<Command> = match self.begun.is_empty() {
            false => self.begun.clone(),
            true => self.written.iter().enumerate().filter_map(alone).collect(),
        };
        // The whole mission is written at once, from its first item on; more than one was not the same throughout.
        let whole: Vec<u32> = (0..self.written.len())
            .filter(|index| near(*index, index.checked_sub(1)) || near(*index, Some(index + 1)))
            .map(|index| self.written[index].1)
            .collect();
        let counts = whole.iter().zip(0..).all(|(item, count)| *item == count);
        let of = u32::try_from(whole.len()).ok().filter(|count| counts && *count > 0);
        let one = |(t_s, item, target): Command| {
            let target_m = target.and_then(|target| place(&target));
            Progress { t_s, item, of, target_m }
        };
        commands.into_iter().map(one).collect()
    }

    /// Events in the order of time, and what is to be told of them.
    pub(super) fn into_events(mut self) -> (Vec<Event>, Vec<String>) {
        let mut notes = Vec::new();
        let (mut before, mut modes) = (None, Modes::default());
        for (t_s, number) in std::mem::take(&mut self.numbers) {
            let known = self.modes.and_then(|modes| modes.iter().find(|(mode, _)| *mode == number));
            let name = known.map_or("other", |(_, name)| name);
            let words = known.map_or_else(|| format!("MODE {number}"), |(_, name)| format!("MODE {name}"));
            if before != Some(name) {
                modes.go(&self.events, flies(name));
                self.tell(t_s, EventKind::OtherMode, words);
            }
            before = Some(name);
        }
        self.events = modes.settle(self.events);
        if before.is_some() && self.modes.is_none() {
            notes.push("modes are not read: no message says which vehicle's they are".into());
        }
        (in_order(self.events), notes)
    }
}
