//! ArduPilot's DataFlash logs (`.bin`): where the vehicle says that it was, on Earth, and what it flew.

mod cores;
mod flown;
mod place;
mod stream;

use std::collections::BTreeMap;

use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Point3, Quaternion, UnitQuaternion, Vector3};

use super::attitude::Attitudes;
use super::axes::{enu_attitude, enu_vector};
use super::error::Fault;
use super::late::set_back;
use super::log::{Clock, LogFrame, Logged, LoggedMotion, Sample, Source, ToldTo};
use super::samples::Budget;
use super::twice::two;
use crate::frames::Geodetic;
use cores::Cores;
use flown::Flown;
use place::{METRES, between, geodetic, is_place, local, plane};
use stream::{Message, each};

pub(super) use stream::MAGIC;

/// Which of two kinds of origin an ORGN is.
const EKF: f64 = 0.0;
const HOME: f64 = 1.0;
/// Places that are no farther apart are the same one, told by degrees of 10⁻⁷, m.
const SAME_M: f64 = 0.02;

pub(super) fn read_dataflash(bytes: &[u8]) -> Result<Logged, Fault> {
    let mut log = Log::default();
    let breaks = each(bytes, |message| log.take(message))?;
    Ok(log.logged(breaks))
}

/// Places on Earth over time.
#[derive(Debug)]
struct Series {
    source: Source,
    samples: Vec<(f64, Geodetic, Option<Vector3<f64>>)>,
    attitudes: Attitudes,
    unfit: Option<String>,
    /// Of latitude and longitude, °, and altitude, m.
    steps: Option<[f64; 3]>,
}

impl Series {
    /// The steps in which it tells places, about the first of them.
    fn told_to(&self) -> Option<ToldTo> {
        let ([lat, lon, up], (_, first, _)) = (self.steps?, self.samples.first()?);
        let [north, east] = [lat * METRES, lon * METRES * libm::cos(first.lat_deg.to_radians())];
        Some(ToldTo::Steps([north, east, up]))
    }

    /// What is wrong where it is elsewhere than at `place` with the same stamp, or its clock was set back.
    fn contradiction(&self, t_s: f64, place: &Geodetic) -> Option<String> {
        let Ok(before) = self.samples.binary_search_by(|(at, ..)| at.total_cmp(&t_s)) else {
            let about = |i: usize| Point3::from(between(place, &self.samples[i].1));
            return set_back((t_s, &Point3::origin()), self.samples.len(), |i| self.samples[i].0, about);
        };
        let before = self.samples[before].1;
        let words = |p: &Geodetic| format!("{:.7}°, {:.7}°, {:.2} m", p.lat_deg, p.lon_deg, p.alt_amsl_m);
        let is_other = between(&before, place).norm() > SAME_M;
        is_other.then(|| two(t_s, "places", &words(&before), &words(place)))
    }
}

#[derive(Debug, Default)]
struct Log {
    series: BTreeMap<(u8, String), Series>,
    attitudes: Attitudes,
    origin: Option<Geodetic>,
    home: Option<Geodetic>,
    flown: Flown,
    cores: Cores,
    budget: Budget,
    skipped: usize,
    before_origin: usize,
}

/// NED from angles in degrees: yaw, then pitch, then roll, each about the axis that the turns before left.
fn attitude([roll, pitch, yaw]: [f64; 3]) -> UnitQuaternion<f64> {
    let about = |axis: Vector3<f64>, angle: f64| from_rotation_vector(&(axis * angle.to_radians()));
    enu_attitude(about(Vector3::z(), yaw) * about(Vector3::y(), pitch) * about(Vector3::x(), roll))
}

impl Log {
    fn take(&mut self, message: &Message) -> Result<(), Fault> {
        let Some(t_s) = message.time() else { return Ok(()) };
        let place = || message.numbers(["Lat", "Lng", "Alt"]).and_then(geodetic);
        let turn = || message.numbers(["Roll", "Pitch", "Yaw"]).map(attitude);
        let steps = message.steps(["Lat", "Lng", "Alt"]);
        // Of raw GPS only a fix of three dimensions is a place.
        let fixed = || message.number("Status").is_none_or(|status| status >= 3.0);
        match &message.format.name[..] {
            "POS" => self.push(1, "POS", Source::Estimate, t_s, place(), None)?.steps = steps,
            "SIM" => {
                self.push(0, "SIM", Source::GroundTruth, t_s, place(), None)?.steps = steps;
                let q = message.numbers(["Q1", "Q2", "Q3", "Q4"]).map(|[w, x, y, z]| Quaternion::new(w, x, y, z));
                let q = q.filter(|q| (q.norm() - 1.0).abs() < 1e-2);
                let turn = q.map(|q| enu_attitude(UnitQuaternion::from_quaternion(q))).or_else(turn);
                self.turn((0, "SIM"), t_s, turn);
            }
            "XKF1" | "NKF1" => {
                let core = message.number("C").unwrap_or(0.0);
                let (name, rank) = (format!("{}[{core}]", message.format.name), 2);
                let (ned, v) = (message.numbers(["PN", "PE", "PD"]), message.numbers(["VN", "VE", "VD"]));
                let Some(origin) = self.origin else {
                    self.before_origin += 1;
                    return Ok(());
                };
                let place = ned.map(|ned| local(&origin, ned)).filter(is_place);
                self.cores.seen(&name, &message.format.name, core);
                self.push(rank, &name, Source::Estimate, t_s, place, v.map(enu_vector))?;
                self.turn((rank, &name), t_s, turn());
            }
            kind @ ("XKF4" | "NKF4") => {
                let Some(core) = message.number("PI") else { return Ok(()) };
                // Positions are in the same filter's first message.
                if self.cores.name(&kind.replace('4', "1"), t_s, core) {
                    self.budget.take()?;
                }
            }
            "AHR2" => {
                self.push(3, "AHR2", Source::Estimate, t_s, place(), None)?.steps = steps;
                self.turn((3, "AHR2"), t_s, turn());
            }
            "GPS" | "GPS2" if fixed() => {
                let name = message.number("I").map_or_else(|| message.format.name.clone(), |i| format!("GPS[{i}]"));
                self.push(4, &name, Source::Untold, t_s, place(), None)?.steps = steps;
            }
            "ATT" => {
                self.budget.take()?;
                if let Some(turn) = turn() {
                    self.attitudes.push(t_s, turn);
                }
            }
            "ORGN" => match (message.number("Type"), place()) {
                (Some(EKF), Some(place)) => {
                    self.flown.origin(t_s, self.origin.replace(place), &place);
                }
                (Some(HOME), Some(place)) => self.home = Some(place),
                _ => {}
            },
            _ => self.flown.take(message, t_s, self.home),
        }
        Ok(())
    }

    /// One more place of a source; better sources have lower ranks.
    fn push(
        &mut self,
        rank: u8,
        name: &str,
        source: Source,
        t_s: f64,
        place: Option<Geodetic>,
        v: Option<Vector3<f64>>,
    ) -> Result<&mut Series, Fault> {
        let key = (rank, name.to_owned());
        let (samples, attitudes, unfit, steps) = Default::default();
        let series = self.series.entry(key).or_insert(Series { source, samples, attitudes, unfit, steps });
        match place {
            Some(place) if series.samples.last().is_none_or(|(last, ..)| *last < t_s) => {
                self.budget.take()?;
                series.samples.push((t_s, place, v));
            }
            place => {
                self.skipped += 1;
                if let Some(place) = place.filter(|_| series.unfit.is_none()) {
                    series.unfit = series.contradiction(t_s, &place);
                }
            }
        }
        Ok(series)
    }

    fn turn(&mut self, (rank, name): (u8, &str), t_s: f64, turn: Option<UnitQuaternion<f64>>) {
        if let (Some(series), Some(turn)) = (self.series.get_mut(&(rank, name.to_owned())), turn) {
            series.attitudes.push(t_s, turn);
        }
    }

    fn logged(self, breaks: Vec<String>) -> Logged {
        let Self { series, attitudes, origin, flown, cores, skipped, before_origin, .. } = self;
        let mut notes = breaks;
        if skipped > 0 {
            notes.push(format!("{skipped} messages without a place or with a stamp that does not rise"));
        }
        if before_origin > 0 {
            notes.push(format!("{before_origin} positions of the filter before its origin was told are not read"));
        }
        let first = series.values().find_map(|series| series.samples.first()).map(|(_, place, _)| *place);
        let about = origin.or(first);
        if origin.is_none() && first.is_some() {
            notes.push("no origin (ORGN): positions are about the first one".into());
        }
        let plane = about.map(|about| plane(&about));
        let mut motions = Vec::new();
        for ((_, name), series) in series {
            let Some(plane) = plane.as_ref().filter(|_| !series.samples.is_empty()) else { continue };
            let beside = if series.attitudes.is_empty() { &attitudes } else { &series.attitudes };
            let turns = beside.at(series.samples.iter().map(|(t_s, ..)| *t_s));
            let one = |((t_s, place, v), attitude): (&(f64, Geodetic, Option<Vector3<f64>>), _)| Sample {
                t_s: *t_s,
                p_m: plane.from_geodetic(place),
                attitude,
                v_m_s: *v,
                accuracy_m: None,
            };
            let samples = series.samples.iter().zip(turns).map(one).collect();
            let resets = if series.source == Source::Estimate { flown.resets() } else { Vec::new() };
            let (source, told_to, unfit) = (series.source, series.told_to(), series.unfit);
            notes.extend(unfit.iter().map(|why| format!("{name}: {why}")));
            motions.push(LoggedMotion { resets, unfit, told_to, ..LoggedMotion::of(&name, source, samples) });
        }
        cores.settle(&mut motions, &mut notes);
        motions.sort_by_key(|motion| motion.source);
        let progress = flown.progress(|place| plane.as_ref().map(|plane| plane.from_geodetic(place)));
        let (events, told) = flown.into_events();
        notes.extend(told);
        Logged {
            format: "ArduPilot DataFlash",
            clock: Clock::SinceBoot,
            frame: LogFrame::Enu(about),
            motions,
            joints: Vec::new(),
            progress,
            events,
            dropouts: Vec::new(),
            notes,
        }
    }
}
