//! Missions of waypoints for PX4 and ArduPilot: `.plan`, WPL 110, and the parameters that they ask for.

use std::path::{Path, PathBuf};

use hairpin::campaign::{Case, mission};
use hairpin_formats::atomic;
use hairpin_formats::frames::Geodetic;
use hairpin_formats::home::Home;
use hairpin_formats::qgc::mission::{Autopilot, Mission, Step, Vehicle};
use hairpin_formats::qgc::{parameters, plan, wpl};
use nalgebra::Point3;

use super::gears;
use super::hardware::{Hardware, home, note};
use super::limits::Limits;
use super::placed::placed;
use super::preflight::Cleared;
use super::speeds::{HOMEWARD, of_legs, rounded_down};
use super::written::Written;
use crate::Problem;
use crate::work::Work;

/// A file of missions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum MissionFile {
    /// QGroundControl's `.plan`.
    Plan,
    /// QGC WPL 110.
    Wpl,
}

impl MissionFile {
    /// Its word on the command line.
    pub(super) fn word(self) -> &'static str {
        match self {
            Self::Plan => "plan",
            Self::Wpl => "wpl",
        }
    }
}

/// `CASE.plan` or `CASE.waypoints`, and `CASE.params` beside it.
pub(super) fn write(
    (work, place): (&Work, &Path),
    cases: &[&Case],
    hardware: &Hardware,
    (file, autopilot): (MissionFile, Autopilot),
) -> Result<Written, Problem> {
    let world = placed(work, file.word())?;
    let mut written = Written { told: hardware.told(), ..Written::default() };
    let flies = hardware.room.flies;
    let name = autopilot.name();
    written.told.push(format!(
        "{name} plans its own way between the waypoints: the timing of the plan, and its stress, are lost; --to setpoints keeps them"
    ));
    for (case, cleared) in cases.iter().zip(&hardware.cleared) {
        let case = &with_gears(work, case, flies)?;
        let home = home(&world, cleared, case)?;
        let made = Maker { work, case, cleared, home: &home, hardware, autopilot }.make(1.0)?;
        written.told.extend(hardware.obstacle_met(case));
        written.told.extend(made.limits.told(&case.id()));
        written.told.extend(made.gears.iter().map(|words| format!("case {}: {words}", case.id())));
        let ending = match file {
            MissionFile::Plan => plan::ENDING,
            MissionFile::Wpl => wpl::ENDING,
        };
        let text = match file {
            MissionFile::Plan => plan::text(&made.mission),
            MissionFile::Wpl => wpl::text(&made.mission),
        };
        written.files.extend(made.write(place, &case.id(), (ending, &text))?);
    }
    Ok(written)
}

/// `CASE_slow.plan` with its parameters: every speed is `share` of the plan's, for a first run.
pub(super) fn write_slow(
    (work, place): (&Work, &Path),
    case: &Case,
    (hardware, cleared): (&Hardware, &Cleared),
    (share, autopilot): (f64, Autopilot),
) -> Result<Vec<PathBuf>, Problem> {
    let world = placed(work, "plan")?;
    let case = &with_gears(work, case, hardware.room.flies)?;
    let home = home(&world, cleared, case)?;
    let made = Maker { work, case, cleared, home: &home, hardware, autopilot }.make(share)?;
    made.write(place, &format!("{}{SLOWLY}", case.id()), (plan::ENDING, &plan::text(&made.mission)))
}

/// What slow first runs of plans are called after their cases' numbers.
const SLOWLY: &str = "_slow";

/// Removes all that [`write_slow`] wrote to `place` before.
pub(super) fn remove_slow(place: &Path) -> Result<(), Problem> {
    let is_slow = |name: &str| {
        let of_slow = |ending: &str| Some(name.strip_suffix(ending)?.strip_suffix(SLOWLY)?.parse::<u64>().is_ok());
        [plan::ENDING, parameters::ENDING].into_iter().any(|ending| of_slow(ending) == Some(true))
    };
    let refuse = |error: std::io::Error| Problem::input(format!("{}: {error}", place.display()));
    for entry in std::fs::read_dir(place).map_err(refuse)? {
        let path = entry.map_err(refuse)?.path();
        if path.file_name().and_then(|name| name.to_str()).is_some_and(is_slow) {
            std::fs::remove_file(&path).map_err(refuse)?;
        }
    }
    Ok(())
}

/// `case` with the commands of its drive, which say the gear of each leg; what flies has none.
fn with_gears(work: &Work, case: &Case, flies: bool) -> Result<Case, Problem> {
    let mut case = case.clone();
    if !flies && case.witness.is_none() {
        work.folder.read_witness(&mut case)?;
    }
    Ok(case)
}

/// A mission and the parameters that it asks for.
struct Made {
    mission: Mission,
    limits: Limits,
    /// What is to be said of legs that are not driven forwards.
    gears: Option<String>,
}

impl Made {
    fn write(&self, place: &Path, stem: &str, (ending, text): (&str, &str)) -> Result<Vec<PathBuf>, Problem> {
        let path = place.join(format!("{stem}{ending}"));
        atomic::write(&path, text.as_bytes())?;
        let beside = place.join(format!("{stem}{}", parameters::ENDING));
        let head: Vec<String> = self.mission.note.iter().map(|(key, value)| format!("{key}: {value}")).collect();
        atomic::write(&beside, parameters::text(&head, &self.limits.parameters()).as_bytes())?;
        Ok(vec![path, beside])
    }
}

struct Maker<'a> {
    work: &'a Work,
    case: &'a Case,
    cleared: &'a Cleared,
    home: &'a Home<'a>,
    hardware: &'a Hardware,
    autopilot: Autopilot,
}

impl Maker<'_> {
    fn make(&self, share: f64) -> Result<Made, Problem> {
        let Self { work, case, cleared, home, hardware, autopilot } = self;
        let (room, way) = (&hardware.room, &cleared.way);
        let own = mission(&work.setup, case, 0)?;
        let speeds: Vec<Option<f64>> =
            of_legs(work, room, case)?.into_iter().map(|speed| Some(rounded_down(share * speed?))).collect();
        let heading =
            |number: usize| own.yaws.get(number).filter(|_| room.flies).map(|yaw| home.heading(*yaw).to_degrees());
        let (accept, last) = (own.accept, case.waypoints.len() - 1);
        let mut steps = Vec::new();
        if room.flies {
            steps.push(Step::TakeOff { place: self.on_earth(&case.waypoints[0])?, yaw: heading(0) });
        }
        // Of what flies, and of legs that nobody claims to drive, nothing is known.
        let gears = case
            .commands()
            .map_or_else(Vec::new, |drive| gears::backwards(drive.legs.iter().map(|leg| &*leg.segments)));
        let (mut speed, mut backwards) = (None, false);
        for (number, waypoint) in case.waypoints.iter().enumerate() {
            let asked = number.checked_sub(1).and_then(|leg| speeds.get(leg).copied().flatten());
            if asked.is_some() && asked != speed {
                steps.extend(asked.map(Step::Speed));
                speed = asked;
            }
            let gear = number.checked_sub(1).and_then(|leg| gears.get(leg).copied().flatten());
            if *autopilot == Autopilot::ArduPilot && gear.is_some_and(|gear| gear != backwards) {
                backwards = !backwards;
                steps.push(Step::Reverse(backwards));
            }
            steps.push(Step::Waypoint { place: self.on_earth(waypoint)?, accept, yaw: heading(number) });
        }
        // The next mission begins forwards.
        steps.extend(backwards.then_some(Step::Reverse(false)));
        if let Some(land) = way.land {
            steps.extend(speed.filter(|speed| *speed > HOMEWARD).map(|_| Step::Speed(HOMEWARD)));
            for place in &way.back {
                steps.push(Step::Waypoint { place: self.on_earth(place)?, accept, yaw: heading(last) });
            }
            steps.push(Step::Land { place: self.on_earth(&land)?, yaw: heading(last) });
        }
        let floor = way.home.z;
        let corners = [
            (room.low.x, room.low.y),
            (room.high.x, room.low.y),
            (room.high.x, room.high.y),
            (room.low.x, room.high.y),
        ];
        let fence = corners.map(|(x, y)| self.on_earth(&Point3::new(x, y, floor)));
        let returning = way.return_height(&work.setup, room, case)?;
        let limits = Limits::new(*autopilot, room, (case, way, returning), accept);
        let mut note = note(work, case, cleared, self.way());
        note.push(("home", self.home_words()));
        note.extend(limits.return_words().map(|words| ("return", words)));
        note.extend(
            (share < 1.0).then(|| ("speed", format!("{:.0} % of the plan's speeds, for a first run", 100.0 * share))),
        );
        let gears = gears::told(&gears, *autopilot);
        note.extend(gears.clone().map(|words| ("gear", words)));
        let mission = Mission {
            autopilot: *autopilot,
            vehicle: if room.flies { Vehicle::Multirotor } else { Vehicle::Ground },
            home: *home.place(),
            steps,
            fence: fence.into_iter().collect::<Result<_, _>>()?,
            speed: speeds.iter().copied().flatten().reduce(f64::max),
            note,
        };
        Ok(Made { mission, limits, gears })
    }

    fn on_earth(&self, place: &Point3<f64>) -> Result<Geodetic, Problem> {
        self.home.geodetic(place).map_err(|why| Problem::input(format!("case {}: {why}", self.case.id())))
    }

    fn way(&self) -> String {
        format!(
            "{} plans its own way between the waypoints; the timing of hairpin's plan, and its stress, are lost (--to setpoints keeps them)",
            self.autopilot.name()
        )
    }

    fn home_words(&self) -> String {
        let Geodetic { lat_deg, lon_deg, alt_amsl_m } = self.home.place();
        let Point3 { coords } = self.cleared.way.home;
        format!(
            "{lat_deg:.10} deg, {lon_deg:.10} deg, {alt_amsl_m:.3} m AMSL is ({:.3}, {:.3}, {:.3}) m of the world; heights are above it",
            coords.x, coords.y, coords.z
        )
    }
}
