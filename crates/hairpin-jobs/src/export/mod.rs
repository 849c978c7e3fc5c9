//! A campaign's trajectories as files that other programs open, in `export/` of its folder.

mod chosen;
mod motions;
mod placed;
mod programs;
mod written;

use std::path::{Path, PathBuf};

use hairpin::campaign::Case;

use crate::Problem;
use crate::work::{Work, open_to_read};

pub use chosen::Which;
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
}

/// A campaign that is exported.
pub struct Export {
    work: Work,
    cases: Vec<Case>,
}

impl Export {
    /// The cases `which` of the campaign in `folder`.
    ///
    /// # Errors
    /// The folder is no campaign's, or broken; a case that it has not.
    pub fn open(folder: &Path, which: &Which) -> Result<Self, Problem> {
        let work = open_to_read(folder)?;
        let cases = which.of(&work, work.folder.read_cases_without_profiles()?)?;
        Ok(Self { cases, work })
    }

    /// Writes all files of a format into the campaign's folder.
    ///
    /// # Errors
    /// There is nothing to write; a file cannot be read or written.
    pub fn write(&self, format: Format) -> Result<Written, Problem> {
        let work = &self.work;
        let cases: Vec<&Case> = self.cases.iter().collect();
        let place: PathBuf = work.folder.export_folder()?;
        match format {
            Format::Waypoints => motions::write_waypoints(&place, &cases),
            Format::Geodetic => motions::write_geodetic(work, &place, &cases),
            Format::Csv => motions::write_csv(work, &place, &cases),
            Format::Tum => motions::write_tum(work, &place, &cases),
            Format::Program(language) => programs::write(work, &place, &cases, language),
            Format::ArcClock => programs::write_clock(work, &place),
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
        let export = Export::open(&folder, &Which::All).unwrap();
        for (format, count) in [(Format::Waypoints, 2), (Format::Geodetic, 2), (Format::Csv, 4), (Format::Tum, 4)] {
            let written = export.write(format).unwrap();
            assert_eq!((written.files.len(), written.missing.len()), (count, 0), "{format:?}");
            assert!(written.files.iter().all(|file| file.starts_with(folder.join("export")) && file.is_file()));
        }
        for format in [Format::Program(Language::Rapid), Format::ArcClock] {
            assert!(export.write(format).is_err(), "{format:?}");
        }
    }

    #[test]
    fn what_was_not_flown_has_no_pair() {
        let (_place, folder) = generated();
        let refused = Export::open(&folder, &Which::All).unwrap().write(Format::Tum).unwrap_err().to_string();
        assert!(refused.contains("it has not been flown"), "{refused}");
    }
}
