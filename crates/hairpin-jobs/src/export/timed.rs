//! Set points and polynomials in time: what keeps the stress that timing is.

use std::path::{Path, PathBuf};

use hairpin::campaign::Case;
use hairpin::math::rotation::between;
use hairpin::trajectory::Track;
use hairpin_formats::atomic;
use hairpin_formats::home::Home;
use hairpin_formats::poly4d::{self, Fitted, compress, fit_profile, fit_track};
use hairpin_formats::setpoints::{self, Setpoint};
use nalgebra::{Isometry3, Point3, UnitQuaternion, Vector3};

use super::hardware::{Hardware, home, is_witnessed, note};
use super::placed::placed;
use super::planned::planned;
use super::written::Written;
use crate::Problem;
use crate::work::Work;

/// Set points in a second.
const RATE: f64 = 50.0;

/// `CASE.setpoints.csv`, and what is said of it in `CASE.setpoints.json`.
pub(super) fn write_setpoints(
    (work, place): (&Work, &Path),
    cases: &[&Case],
    hardware: &Hardware,
) -> Result<Written, Problem> {
    let world = placed(work, "setpoints")?;
    let mut written = Written { told: hardware.told(), ..Written::default() };
    written.told.push("set points keep the timing of the plan: whoever streams them flies its stress".into());
    for (case, cleared) in cases.iter().zip(&hardware.cleared) {
        let mut case = Case::clone(case);
        work.folder.read_witness(&mut case)?;
        if !is_witnessed(&case) {
            written.missing.push(format!(
                "case {} has no {}: its plan is {}, and has no accelerations",
                case.id(),
                setpoints::ENDING,
                case.evidence.word()
            ));
            continue;
        }
        let home = home(&world, cleared, &case)?;
        let refuse = |why: String| Problem::input(format!("case {}: {why}", case.id()));
        let planned = planned(work, &case)?;
        let points = setpoints_of(&case, &planned, &home, hardware.room.flies).map_err(refuse)?;
        let way = "north, east, down of home, at the times of hairpin's plan".to_owned();
        let mut note = note(work, &case, cleared, way);
        let at = home.place();
        note.push(("home", format!("{:.10} deg, {:.10} deg, {:.3} m AMSL", at.lat_deg, at.lon_deg, at.alt_amsl_m)));
        written.told.extend(hardware.obstacle_met(&case));
        let path = place.join(format!("{}{}", case.id(), setpoints::ENDING));
        atomic::write(&path, setpoints::text(&points).as_bytes())?;
        written.files.extend([path, write_note(place, &format!("{}.setpoints.json", case.id()), &note)?]);
    }
    written.or_refused()
}

/// `CASE.poly4d.csv`, `CASE.poly4d.bin` where it fits, and what is said of them in `CASE.poly4d.json`.
pub(super) fn write_poly4d(
    (work, place): (&Work, &Path),
    cases: &[&Case],
    hardware: &Hardware,
) -> Result<Written, Problem> {
    if !hardware.room.flies {
        return Err(Problem::input(format!("--to poly4d: {} does not fly", work.setup.robot_name())));
    }
    let mut written = Written { told: hardware.told(), ..Written::default() };
    for (case, cleared) in cases.iter().zip(&hardware.cleared) {
        let mut case = Case::clone(case);
        work.folder.read_witness(&mut case)?;
        let id = case.id();
        if case.leg_times.is_empty() {
            written
                .missing
                .push(format!("case {id} has no {}: a mission made elsewhere has no timed plan", poly4d::ENDING));
            continue;
        }
        let fitted = match case.profile() {
            Some(profile) => Some(fit_profile(profile)),
            None => fit_track(&work.folder.read_planned(case.number)?),
        };
        let Some(Fitted { pieces, error }) = fitted else {
            written.missing.push(format!("case {id} has no {}: its plan is empty", poly4d::ENDING));
            continue;
        };
        let path = place.join(format!("{id}{}", poly4d::ENDING));
        atomic::write(&path, poly4d::text(&pieces).as_bytes())?;
        written.files.push(path);
        let bytes = pieces.len() * poly4d::PIECE_BYTES;
        let mut size = format!("{} pieces, {:.3} mm from the plan at most, {bytes} bytes", pieces.len(), 1e3 * error);
        match compress(&pieces) {
            Ok(compressed) => {
                let path = place.join(format!("{id}{}", poly4d::COMPRESSED_ENDING));
                atomic::write(&path, &compressed.bytes)?;
                written.files.push(path);
                size += &format!(
                    "; compressed {} bytes, {:.3} mm and {:.2} ms more",
                    compressed.bytes.len(),
                    1e3 * compressed.error,
                    1e3 * compressed.clock
                );
            }
            Err(why) => written.missing.push(format!("case {id} has no {}: {why}", poly4d::COMPRESSED_ENDING)),
        }
        let memory = poly4d::MEMORY_BYTES;
        written.told.push(format!("case {id}: {size}; a Crazyflie has {memory} bytes for them by default"));
        let way =
            "the Crazyflie's own frame must be the world's: x, y and z are those of the world; yaw is 0".to_owned();
        let mut note = note(work, &case, cleared, way);
        note.push(("size", size));
        written.files.push(write_note(place, &format!("{id}.poly4d.json"), &note)?);
    }
    written.or_refused()
}

fn write_note(place: &Path, name: &str, note: &[(&'static str, String)]) -> Result<PathBuf, Problem> {
    let path = place.join(name);
    let words: serde_json::Map<String, serde_json::Value> =
        note.iter().map(|(key, value)| ((*key).to_owned(), value.as_str().into())).collect();
    atomic::write_json(&path, &words)?;
    Ok(path)
}

/// Set points of a witnessed case: of a flight its own polynomials' derivatives, else even accelerations between the
/// planned velocities.
fn setpoints_of(case: &Case, planned: &Track, home: &Home, flies: bool) -> Result<Vec<Setpoint>, String> {
    let end = planned.times().last().copied().unwrap_or(0.0);
    let steps = (end * RATE).floor() as usize;
    let mut stamps: Vec<f64> = (0..=steps).map(|i| i as f64 / RATE).collect();
    if end - stamps[steps] > 1e-6 {
        stamps.push(end);
    }
    let profile = case.profile().filter(|_| flies);
    let one = |t: &f64| {
        let (position, mut velocity, mut acceleration) = planned.motion_at(*t).ok_or("its plan has no velocities")?;
        let mut place = Isometry3::from_parts(position.into(), turned(planned, *t));
        if let Some((_, [p, v, a])) = profile.and_then(|profile| profile.motion(*t)) {
            place.translation.vector = p;
            (velocity, acceleration) = (v, a);
        }
        // A flight's plan does not turn, whatever its attitude does.
        let forward = if flies { Vector3::x() } else { place.rotation * Vector3::x() };
        Ok(Setpoint {
            t: *t,
            position: Point3::from(home.ned(&place)?.0.translation.vector),
            velocity: home.ned_vector(&velocity),
            acceleration: home.ned_vector(&acceleration),
            yaw: home.heading(libm::atan2(forward.y, forward.x)),
        })
    };
    stamps.iter().map(one).collect()
}

/// The attitude of a planned motion of two samples or more at a time of it.
fn turned(planned: &Track, t: f64) -> UnitQuaternion<f64> {
    let (times, poses) = (planned.times(), planned.poses());
    let before = times.partition_point(|stamp| *stamp <= t).clamp(1, times.len() - 1) - 1;
    let share = ((t - times[before]) / (times[before + 1] - times[before])).clamp(0.0, 1.0);
    between(&poses[before].rotation, &poses[before + 1].rotation, share)
}
