//! A campaign's trajectories as files that other programs open, in `export/` of its folder.

mod airtime;
mod chosen;
mod flights;
mod gears;
mod hardware;
mod limits;
mod mcap;
mod missions;
mod motions;
mod placed;
mod planned;
mod preflight;
mod programs;
mod speeds;
mod timed;
mod way;
mod written;

use std::path::PathBuf;

use hairpin::campaign::Case;
use hairpin_formats::qgc::mission::Autopilot;

use crate::Problem;
use crate::work::{PLACE, Work, open_to_read, same_as_made};

use hardware::Hardware;

pub use chosen::Which;
pub use missions::MissionFile;
pub use programs::Language;
pub use written::Written;

/// A format of trajectories.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Format {
    /// CASE.csv: x_m,y_m,z_m.
    Waypoints,
    /// CASE.geodetic.csv, by the scenario's world.origin or its map's EPSG code.
    Geodetic,
    /// CASE.planned.csv and CASE-RUN.csv: poses in time.
    Csv,
    /// Of arms, in the language of a controller.
    Program(Language),
    /// Of arms: arc_clock.mod, which clocks every move of the graph on the controller.
    ArcClock,
    /// CASE.ref.tum and CASE.exec.tum: planned motion and worst run on the same stamps.
    Tum,
    /// CASE.mcap: planned motion, runs and obstacles for Foxglove.
    Mcap,
    /// CASE.ros2.mcap: planned motion, runs and an arm's joints for ROS 2.
    McapRos2,
    /// For autopilots, waypoints on Earth: CASE.plan or CASE.waypoints, and CASE.params.
    Mission(MissionFile),
    /// For companion computers, in time about home: CASE.setpoints.csv and CASE.setpoints.json.
    Setpoints,
    /// For Crazyflies: CASE.poly4d.csv, CASE.poly4d.bin and CASE.poly4d.json.
    Poly4d,
}

/// What is exported, and how.
#[derive(Debug, Clone, Default)]
pub struct ExportSettings {
    /// Campaign folder.
    pub folder: PathBuf,
    /// Its cases that are.
    pub which: Which,
    /// Whose missions are written.
    pub autopilot: Autopilot,
    /// Whether cases that leave the keep-in margin are written for hardware all the same.
    pub accept_excursion: bool,
}

/// A campaign that is exported.
pub struct Export {
    work: Work,
    cases: Vec<Case>,
    autopilot: Autopilot,
    accept_excursion: bool,
}

impl Export {
    /// The cases that `settings` name of the campaign in their folder.
    ///
    /// # Errors
    /// The folder is no campaign's, or broken; it has no case, or not one that is named; its scenario was edited since,
    /// beside `spec` and its place on Earth.
    pub fn open(settings: &ExportSettings) -> Result<Self, Problem> {
        let ExportSettings { folder, which, autopilot, accept_excursion } = settings;
        let work = open_to_read(folder)?;
        same_as_made(&work.folder, &work.setup, &PLACE)?;
        let cases = which.of(&work, work.folder.read_cases_without_profiles()?)?;
        if cases.is_empty() {
            return Err(Problem::input(format!("{} has no case: there is nothing to export", folder.display())));
        }
        Ok(Self { cases, work, autopilot: *autopilot, accept_excursion: *accept_excursion })
    }

    /// Writes the day card of `count` of its cases.
    ///
    /// # Errors
    /// Fewer cases that were measured and stay inside; a file cannot be read or written.
    pub fn write_day_card(&self, count: usize) -> Result<Written, Problem> {
        let cases: Vec<&Case> = self.cases.iter().collect();
        let place = self.work.folder.export_folder()?;
        flights::write((&self.work, &place), &cases, (count, self.accept_excursion, self.autopilot))
    }

    /// Writes all files of a format into the campaign's folder.
    ///
    /// # Errors
    /// There is nothing to write; a case that leaves the keep-in margin, where the format is for hardware; a file
    /// cannot be read or written.
    pub fn write(&self, format: Format) -> Result<Written, Problem> {
        let work = &self.work;
        let cases: Vec<&Case> = self.cases.iter().collect();
        let cleared = |word: &str| Hardware::clear(work, &cases, self.accept_excursion, word);
        let place = work.folder.export_folder()?;
        match format {
            Format::Waypoints => motions::write_waypoints(&place, &cases),
            Format::Geodetic => motions::write_geodetic(work, &place, &cases),
            Format::Csv => motions::write_csv(work, &place, &cases),
            Format::Tum => motions::write_tum(work, &place, &cases),
            Format::Mcap => mcap::write(work, &place, &cases, mcap::For::Foxglove),
            Format::McapRos2 => mcap::write(work, &place, &cases, mcap::For::Ros2),
            Format::Program(language) => programs::write(work, &place, &cases, language),
            Format::ArcClock => programs::write_clock(work, &place),
            Format::Mission(file) => {
                missions::write((work, &place), &cases, &cleared(file.word())?, (file, self.autopilot))
            }
            Format::Setpoints => timed::write_setpoints((work, &place), &cases, &cleared("setpoints")?),
            Format::Poly4d => timed::write_poly4d((work, &place), &cases, &cleared("poly4d")?),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::{executed, generated};

    #[test]
    fn files_lie_in_the_campaign() {
        let (_place, folder) = executed();
        let export = Export::open(&ExportSettings { folder: folder.clone(), ..ExportSettings::default() }).unwrap();
        for (format, count) in [
            (Format::Waypoints, 2),
            (Format::Geodetic, 2),
            (Format::Csv, 4),
            (Format::Tum, 4),
            (Format::Mcap, 2),
            (Format::McapRos2, 2),
        ] {
            let written = export.write(format).unwrap();
            assert_eq!((written.files.len(), written.missing.len()), (count, 0), "{format:?}");
            assert!(written.files.iter().all(|file| file.starts_with(folder.join("export")) && file.is_file()));
        }
        for format in [Format::Program(Language::Rapid), Format::ArcClock] {
            assert!(export.write(format).is_err(), "{format:?}");
        }
    }

    #[test]
    fn no_case_is_nothing_to_export() {
        let (_place, folder) = generated();
        let work = open_to_read(&folder).unwrap();
        work.folder.write_new_cases(&[], 0).unwrap();
        work.folder.write_results(&[], &[]).unwrap();
        let refused = Export::open(&ExportSettings { folder, ..ExportSettings::default() }).err().unwrap().to_string();
        assert!(refused.ends_with("has no case: there is nothing to export"), "{refused}");
    }

    #[test]
    fn what_was_not_flown_has_no_pair() {
        let (_place, folder) = generated();
        let refused = Export::open(&ExportSettings { folder: folder.clone(), ..ExportSettings::default() })
            .unwrap()
            .write(Format::Tum)
            .unwrap_err()
            .to_string();
        assert!(refused.contains("it has not been flown"), "{refused}");
    }
}
