//! `vehicle_local_position` and its ground truth: where the body was, when the estimate jumped, and when it was none.

use nalgebra::Point3;

use super::super::accuracy::{both, half, known};
use super::super::axes::{enu_point, enu_vector};
use super::super::error::Fault;
use super::super::invalid::Invalid;
use super::super::late::set_back;
use super::super::log::{LoggedMotion, Reset, Sample, Source};
use super::super::samples::Budget;
use super::super::twice::{places_apart, two_places};
use super::formats::Slot;
use super::projection::{place, tangent};
use super::topic::{Finder, seconds};
use crate::frames::Geodetic;

/// A reference on Earth that moves less than this has not moved, m.
const SAME_PLACE: f64 = 0.01;
/// A place that is no further away than this in degrees is the same, by a metre in 10⁵ of them.
const SAME_DEG: f64 = 1e-7;
/// Turns of the heading that are told one by one.
const TOLD: usize = 5;
/// No robot is further from where it began, m.
const FARTHEST_M: f64 = 1e7;

#[derive(Debug)]
struct Slots {
    sample: Option<Slot>,
    p: [Slot; 3],
    v: Option<[Slot; 3]>,
    /// xy, z, vxy, vz.
    valid: [Option<Slot>; 4],
    dead_reckoning: Option<Slot>,
    /// xy, z, heading.
    counters: [Option<Slot>; 3],
    /// x, y, z, heading.
    deltas: [Option<Slot>; 4],
    /// xy, z.
    global: [Option<Slot>; 2],
    reference: Option<[Slot; 3]>,
    accuracy: [Option<Slot>; 2],
}

/// What was read of one instance.
#[derive(Debug)]
pub(super) struct Positions {
    slots: Slots,
    samples: Vec<Sample>,
    resets: Vec<Reset>,
    invalid: Invalid,
    counters: Option<[u8; 3]>,
    /// References on Earth, each with the first sample that it holds for.
    references: Vec<(usize, Geodetic)>,
    turned: Vec<String>,
    turns: usize,
    skipped: usize,
    /// Samples of whose accuracy only one of both is told.
    halves: usize,
    unfit: Option<String>,
}

impl Positions {
    pub(super) fn of(finder: &Finder) -> Result<Self, String> {
        let slots = Slots {
            sample: finder.slot("timestamp_sample"),
            p: [finder.needed("x")?, finder.needed("y")?, finder.needed("z")?],
            v: finder.slots(["vx", "vy", "vz"]),
            valid: ["xy_valid", "z_valid", "v_xy_valid", "v_z_valid"].map(|name| finder.slot(name)),
            dead_reckoning: finder.slot("dead_reckoning"),
            counters: ["xy_reset_counter", "z_reset_counter", "heading_reset_counter"].map(|name| finder.slot(name)),
            deltas: [
                finder.slot("delta_xy"),
                finder.element("delta_xy", 1),
                finder.slot("delta_z"),
                finder.slot("delta_heading"),
            ],
            global: ["xy_global", "z_global"].map(|name| finder.slot(name)),
            reference: finder.slots(["ref_lat", "ref_lon", "ref_alt"]),
            accuracy: ["eph", "epv"].map(|name| finder.slot(name)),
        };
        let (samples, resets, invalid, references, turned) = Default::default();
        let (counters, turns, skipped, halves, unfit) = Default::default();
        Ok(Self { slots, samples, resets, invalid, counters, references, turned, turns, skipped, halves, unfit })
    }

    pub(super) fn push(&mut self, stamp: f64, data: &[u8], budget: &mut Budget) -> Result<(), Fault> {
        let read = |slot: Option<Slot>| slot.and_then(|slot| slot.read(data));
        let is = |slot: Option<Slot>| read(slot).map(|value| value != 0.0);
        let three = |slots: [Slot; 3]| slots.map(|slot| slot.read(data).unwrap_or(f64::NAN));
        let slots = &self.slots;
        let t_s = seconds(stamp, read(slots.sample));
        let ned = three(slots.p);
        let is_number = ned.iter().all(|p| p.is_finite() && p.abs() < FARTHEST_M);
        let rises = self.samples.last().is_none_or(|last| last.t_s < t_s);
        let valid = is(slots.valid[0]) != Some(false) && is(slots.valid[1]) != Some(false);
        let lost = !valid || !is_number || is(slots.dead_reckoning) == Some(true);
        if !is_number || !rises {
            self.skipped += usize::from(valid);
            if !lost && self.unfit.is_none() {
                self.unfit = contradiction(&self.samples, t_s, &enu_point(ned));
            }
            self.invalid.settle(t_s, lost);
            return Ok(());
        }
        budget.take()?;
        let v = slots.v.map(three).filter(|v| v.iter().all(|v| v.is_finite()));
        let v = v.filter(|_| is(slots.valid[2]) != Some(false) && is(slots.valid[3]) != Some(false));
        let (accuracy_m, is_half) = both(slots.accuracy.map(|slot| read(slot).and_then(known)));
        let sample = Sample { t_s, p_m: enu_point(ned), attitude: None, v_m_s: v.map(enu_vector), accuracy_m };
        self.halves += usize::from(is_half);
        self.take_resets(t_s, data);
        self.take_reference(t_s, data);
        self.samples.push(sample);
        self.invalid.settle(t_s, lost);
        Ok(())
    }

    fn take_resets(&mut self, t_s: f64, data: &[u8]) {
        let slots = &self.slots;
        let counters = slots.counters.map(|slot| slot.and_then(|slot| slot.read(data)).unwrap_or(0.0) as u8);
        let before = self.counters.replace(counters).unwrap_or(counters);
        let by = |place: usize| slots.deltas[place].and_then(|slot| slot.read(data)).filter(|by| by.is_finite());
        // Of two in one step the counter tells, and only the last one's delta is there.
        let once = |which: usize| counters[which].wrapping_sub(before[which]) == 1;
        let changed = [0, 1, 2].map(|which| counters[which] != before[which]);
        let along = |which: usize, place: usize| match (changed[which], once(which)) {
            (false, _) => Some(0.0),
            (true, true) => by(place),
            (true, false) => None,
        };
        if changed[0] || changed[1] {
            let by_m = match (along(0, 0), along(0, 1), along(1, 2)) {
                (Some(x), Some(y), Some(z)) => Some(enu_vector([x, y, z])),
                _ => None,
            };
            self.resets.push(Reset { t_s, by_m });
        }
        if changed[2] {
            self.turns += 1;
            if self.turns <= TOLD {
                let by = along(2, 3)
                    .map_or("by an angle that is not told".into(), |by| format!("by {:.1}°", by.to_degrees()));
                self.turned.push(format!("the heading was reset {by} at t = {t_s:.2} s"));
            }
        }
    }

    fn take_reference(&mut self, t_s: f64, data: &[u8]) {
        let slots = &self.slots;
        if slots.global.iter().flatten().any(|slot| slot.read(data) == Some(0.0)) {
            return;
        }
        let Some(numbers) = slots.reference.map(|slots| slots.map(|slot| slot.read(data).unwrap_or(f64::NAN))) else {
            return;
        };
        let [lat_deg, lon_deg, alt_amsl_m] = numbers;
        if !(lat_deg.abs() <= 90.0 && lon_deg.abs() <= 180.0 && alt_amsl_m.abs() < 1e5) {
            return;
        }
        let now = Geodetic { lat_deg, lon_deg, alt_amsl_m };
        let moved = |(_, before): &(usize, Geodetic)| {
            (now.lat_deg - before.lat_deg).abs() > SAME_DEG
                || (now.lon_deg - before.lon_deg).abs() > SAME_DEG
                || (now.alt_amsl_m - before.alt_amsl_m).abs() > SAME_PLACE
        };
        match self.references.last() {
            // What was before the first one was about the same point.
            None => self.references.push((0, now)),
            Some(last) if moved(last) => {
                self.references.push((self.samples.len(), now));
                self.resets.push(Reset { t_s, by_m: None });
            }
            Some(_) => {}
        }
    }

    /// The point on Earth that positions are about.
    pub(super) fn reference(&self) -> Option<Geodetic> {
        self.references.first().map(|(_, reference)| *reference)
    }

    /// The motion, with positions about `origin` where both it and theirs are known; and what is to be told of it.
    pub(super) fn motion(
        mut self,
        name: &str,
        source: Source,
        origin: Option<Geodetic>,
    ) -> (LoggedMotion, Vec<String>) {
        let mut notes: Vec<String> = self.turned.iter().map(|turn| format!("{name}: {turn}")).collect();
        if self.turns > TOLD {
            notes.push(format!("{name}: {} more resets of the heading", self.turns - TOLD));
        }
        if self.skipped > 0 {
            notes.push(format!("{name}: {} samples without numbers or with stamps that do not rise", self.skipped));
        }
        match origin {
            Some(origin) if !self.references.is_empty() => self.place_about(&origin),
            Some(_) => notes.push(format!("{name}: about a point of its own, which is nowhere on Earth")),
            None => {}
        }
        if self.references.len() > 1 {
            notes.push(format!("{name}: its reference on Earth moved {} times", self.references.len() - 1));
        }
        let Self { samples, resets, invalid, halves, unfit, .. } = self;
        let invalid = invalid.until(samples.last().map(|last| last.t_s));
        notes.extend(half(name, halves));
        notes.extend(unfit.iter().map(|why| format!("{name}: {why}")));
        (LoggedMotion { resets, invalid, unfit, ..LoggedMotion::of(name, source, samples) }, notes)
    }

    /// Turns PX4's plane about the reference of each time into east, north, up about `origin`.
    fn place_about(&mut self, origin: &Geodetic) {
        let plane = tangent(origin);
        let ends: Vec<usize> =
            self.references.iter().skip(1).map(|(from, _)| *from).chain([self.samples.len()]).collect();
        for ((from, reference), to) in self.references.iter().zip(ends) {
            for sample in &mut self.samples[*from..to] {
                let local: Point3<f64> = sample.p_m;
                sample.p_m = plane.from_geodetic(&place(reference, &local));
            }
        }
    }

    pub(super) fn is_empty(&self) -> bool {
        self.samples.is_empty()
    }
}

/// What is wrong with a sample whose stamp does not rise: another place than `p` has the stamp `t_s` already, or the
/// clock was set back. Loggers write samples again: the same place once more is nothing.
pub(super) fn contradiction(samples: &[Sample], t_s: f64, p: &Point3<f64>) -> Option<String> {
    let Ok(before) = samples.binary_search_by(|sample| sample.t_s.total_cmp(&t_s)) else {
        return set_back((t_s, p), samples.len(), |i| samples[i].t_s, |i| samples[i].p_m);
    };
    let before = samples[before].p_m;
    places_apart(&before, p).map(|_| two_places(t_s, &before, p))
}

/// A target of a mission about `origin`.
pub(super) fn target(origin: &Geodetic, target: &Geodetic) -> Point3<f64> {
    tangent(origin).from_geodetic(target)
}
