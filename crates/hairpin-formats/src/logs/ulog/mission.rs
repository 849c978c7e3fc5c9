//! What a PX4 flew when: items of the mission, modes, failsafes, fences, the ground.

use super::super::log::{Event, EventKind, Progress};
use super::super::modes::{Flies, Modes, in_order};
use super::formats::Slot;
use super::topic::Finder;
use crate::frames::Geodetic;

/// The setpoint of an item is published with it, or a cycle of the logger's later, s.
const TOGETHER: f64 = 0.1;
/// Entries of each kind at most: who has more was no flight.
const MOST: usize = 100_000;

/// Modes by number (`VehicleStatus.msg`).
const MODES: [&str; 23] = [
    "MANUAL",
    "ALTCTL",
    "POSCTL",
    "AUTO_MISSION",
    "AUTO_LOITER",
    "AUTO_RTL",
    "POSITION_SLOW",
    "FREE5",
    "FREE4",
    "FREE3",
    "ACRO",
    "FREE2",
    "DESCEND",
    "TERMINATION",
    "OFFBOARD",
    "STAB",
    "FREE1",
    "AUTO_TAKEOFF",
    "AUTO_LAND",
    "AUTO_FOLLOW_TARGET",
    "AUTO_PRECLAND",
    "ORBIT",
    "AUTO_VTOL_TAKEOFF",
];
/// What is flown in a mode: missions, and setpoints from outside.
fn flies(number: f64) -> Flies {
    match number {
        3.0 => Flies::Uploaded,
        14.0 => Flies::Sent,
        _ => Flies::Other,
    }
}

fn mode(number: f64) -> String {
    MODES.get(number as usize).map_or_else(|| format!("mode {number}"), |name| (*name).to_owned())
}

/// Flags of `geofence_result`, of all versions.
const FENCES: [&str; 9] = [
    "geofence_violated",
    "geofence_max_dist_triggered",
    "geofence_max_alt_triggered",
    "geofence_custom_fence_triggered",
    "max_altitude_exceeded",
    "max_distance_exceeded",
    "primary_geofence_breached",
    "secondary_geofence_breached",
    "custom_fence_breached",
];

/// A topic that says what is flown.
#[derive(Debug)]
pub(super) enum Topic {
    Result { current: Slot, total: Option<Slot>, finished: Option<Slot>, item: Option<[f64; 2]>, done: bool },
    Triplet { valid: Option<Slot>, place: [Slot; 3] },
    Status { mode: Slot, asked: Option<Slot>, failsafe: Option<Slot>, last: Option<f64>, failed: bool },
    Fence { flags: Vec<(&'static str, Slot, bool)> },
    Land { landed: Slot, last: Option<bool> },
}

impl Topic {
    pub(super) fn of(name: &str, finder: &Finder) -> Result<Option<Self>, String> {
        Ok(Some(match name {
            "mission_result" => Self::Result {
                current: finder.needed("seq_current")?,
                total: finder.slot("seq_total"),
                finished: finder.slot("finished"),
                item: None,
                done: false,
            },
            "position_setpoint_triplet" => Self::Triplet {
                valid: finder.slot("current.valid"),
                place: [finder.needed("current.lat")?, finder.needed("current.lon")?, finder.needed("current.alt")?],
            },
            "vehicle_status" => Self::Status {
                mode: finder.needed("nav_state")?,
                asked: finder.slot("nav_state_user_intention"),
                failsafe: finder.slot("failsafe"),
                last: None,
                failed: false,
            },
            "geofence_result" => {
                let flag = |name: &&'static str| Some((*name, finder.slot(name)?, false));
                Self::Fence { flags: FENCES.iter().filter_map(flag).collect() }
            }
            "vehicle_land_detected" => Self::Land { landed: finder.needed("landed")?, last: None },
            _ => return Ok(None),
        }))
    }
}

/// From `t_s` on it flies to item `item` of so many.
#[derive(Debug)]
struct Item {
    t_s: f64,
    item: u32,
    of: Option<u32>,
}

/// What was flown.
#[derive(Debug, Default)]
pub(super) struct Flown {
    items: Vec<Item>,
    targets: Vec<(f64, Geodetic)>,
    events: Vec<Event>,
    modes: Modes,
}

impl Flown {
    fn tell(&mut self, t_s: f64, kind: EventKind, words: String) {
        if self.events.len() < MOST {
            self.events.push(Event { t_s, kind, words });
        }
    }

    pub(super) fn push(&mut self, topic: &mut Topic, t_s: f64, data: &[u8]) {
        let read = |slot: &Slot| slot.read(data).unwrap_or(f64::NAN);
        let is = |slot: &Slot| read(slot) == 1.0;
        match topic {
            Topic::Result { current, total, finished, item, done } => {
                let total = total.as_ref().map_or(0.0, read);
                let now = [read(current), total];
                if *item != Some(now) && now[0] >= 0.0 && self.items.len() < MOST {
                    let of = (total > 0.0).then_some(total as u32);
                    self.items.push(Item { t_s, item: now[0] as u32, of });
                    *item = Some(now);
                }
                let is_done = finished.as_ref().is_some_and(is);
                if is_done && !*done {
                    self.tell(t_s, EventKind::MissionEnds, "mission_result finished".into());
                }
                *done = is_done;
            }
            Topic::Triplet { valid, place } => {
                let [lat_deg, lon_deg, alt_amsl_m] = [0, 1, 2].map(|axis| read(&place[axis]));
                let is_place = lat_deg.abs() <= 90.0 && lon_deg.abs() <= 180.0 && alt_amsl_m.is_finite();
                if valid.as_ref().is_none_or(is) && is_place && self.targets.len() < MOST {
                    self.targets.push((t_s, Geodetic { lat_deg, lon_deg, alt_amsl_m }));
                }
            }
            Topic::Status { mode: slot, asked, failsafe, last, failed } => {
                let (now, before) = (read(slot), *last);
                if before != Some(now) {
                    let words = match asked.as_ref().map(read) {
                        Some(asked) if asked != now => format!("nav_state {}, asked for {}", mode(now), mode(asked)),
                        _ => format!("nav_state {}", mode(now)),
                    };
                    self.modes.go(&self.events, flies(now));
                    self.tell(t_s, EventKind::OtherMode, words);
                }
                *last = Some(now);
                let fails = failsafe.as_ref().is_some_and(is);
                if fails && !*failed {
                    self.tell(t_s, EventKind::Failsafe, format!("failsafe, nav_state {}", mode(now)));
                }
                *failed = fails;
            }
            Topic::Fence { flags } => {
                for (name, slot, last) in flags {
                    let now = is(slot);
                    if now && !*last {
                        self.tell(t_s, EventKind::Geofence, (*name).into());
                    }
                    *last = now;
                }
            }
            Topic::Land { landed, last } => {
                let now = is(landed);
                match (*last, now) {
                    (Some(false) | None, true) => self.tell(t_s, EventKind::Landed, "landed".into()),
                    (Some(true), false) => self.tell(t_s, EventKind::TookOff, "took off".into()),
                    _ => {}
                }
                *last = Some(now);
            }
        }
    }

    /// Items in the order of time, with the setpoint that was published with each.
    pub(super) fn progress(&self, place: impl Fn(&Geodetic) -> Option<nalgebra::Point3<f64>>) -> Vec<Progress> {
        let end = |index: usize| self.items.get(index + 1).map_or(f64::INFINITY, |next| next.t_s);
        let one = |(index, Item { t_s, item, of }): (usize, &Item)| {
            let from = self.targets.partition_point(|(at, _)| *at < t_s - TOGETHER);
            let target = self.targets.get(from);
            let target = target.filter(|(at, _)| *at < end(index) - TOGETHER || *at <= *t_s);
            Progress { t_s: *t_s, item: *item, of: *of, target_m: target.and_then(|(_, target)| place(target)) }
        };
        self.items.iter().enumerate().map(one).collect()
    }

    pub(super) fn into_events(self) -> Vec<Event> {
        in_order(self.modes.settle(self.events))
    }
}
