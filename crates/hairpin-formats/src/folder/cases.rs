//! The cases of a campaign folder: what `generate` writes, and every later part reads.

use std::path::Path;
use std::{fs, io};

use hairpin::campaign::{Case, CaseNumber, CaseResult, Evidence, Scenario, Witness};
use hairpin::trajectory::Track;
use hairpin::trajectory::program::Program;

use super::parts::{CASES_PER_PART, PROFILES, PROGRAMS, TRAJECTORIES, parts_of};
use super::{CampaignFolder, FolderError, RESULTS, WAYPOINTS};
use crate::atomic::WriteError;
use crate::bounds::{self, MOST_TEXT_BYTES};
use crate::parquet::piece::Piece;
use crate::parquet::results::Row;
use crate::parquet::table::Table;
use crate::parquet::{cases, drive, profile, program, track};
use crate::rapid::{self, Frames};
use crate::scenario::MADE_BY;

impl CampaignFolder {
    /// Writes generated cases; `results.parquet` has them with status `generated`.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write_cases(&self, all: &[Case]) -> Result<(), FolderError> {
        self.write_new_cases(all, 0)
    }

    /// As [`Self::write_cases`], where the witnesses of the first `old` cases are in the folder already.
    ///
    /// # Errors
    /// A file cannot be written.
    pub fn write_new_cases(&self, all: &[Case], old: usize) -> Result<(), FolderError> {
        for block in all[old..].chunk_by(|a, b| a.number.0 / CASES_PER_PART == b.number.0 / CASES_PER_PART) {
            let (mut profiles, mut programs) = (Vec::new(), Vec::new());
            for case in block {
                let (table, piece) = match (case.profile(), case.commands(), case.program()) {
                    (Some(witness), ..) => (PROFILES, profile::piece(case.number, witness)),
                    (_, Some(witness), _) => (PROFILES, drive::piece(case.number, witness)),
                    (.., Some(program)) => (PROGRAMS, program::piece(case.number, &self.module(case, program)?)),
                    _ => continue,
                };
                let pieces = if table == PROGRAMS { &mut programs } else { &mut profiles };
                pieces.push((case.number, piece.map_err(|cause| self.no_room(table, cause))?));
            }
            self.add_pieces(PROFILES, profiles)?;
            self.add_pieces(PROGRAMS, programs)?;
        }
        cases::write(&self.file(WAYPOINTS), all)?;
        self.write_results(all, &[])
    }

    pub(super) fn no_room(&self, table: &str, cause: io::Error) -> FolderError {
        FolderError::Write(WriteError { path: self.path.join(table), cause })
    }

    /// Whether there are cases, those of a checkpoint at least.
    pub fn has_cases(&self) -> bool {
        self.file(RESULTS).is_file() && self.file(WAYPOINTS).is_file()
    }

    /// Reads all cases, with their profiles where they have one.
    ///
    /// # Errors
    /// A file is missing or broken, or two contradict each other.
    pub fn read_cases(&self) -> Result<Vec<Case>, FolderError> {
        let mut all = self.read_cases_without_profiles()?;
        for case in &mut all {
            self.read_witness(case)?;
            if case.witness.as_ref().and_then(Witness::legs).is_some_and(|legs| legs + 1 != case.waypoints.len()) {
                let what = "has another number of legs than between its waypoints";
                return Err(FolderError::Contradiction { path: self.path.join(PROFILES), case: case.number, what });
            }
        }
        Ok(all)
    }

    /// Reads all cases and leaves their witnesses out: for `verify`, where a broken one is a finding about its case.
    ///
    /// # Errors
    /// As [`Self::read_cases`].
    pub fn read_cases_without_profiles(&self) -> Result<Vec<Case>, FolderError> {
        Ok(self.read_cases_and_results()?.0)
    }

    /// The same, and the results of all judged cases.
    ///
    /// # Errors
    /// As [`Self::read_cases`].
    pub fn read_cases_and_results(&self) -> Result<(Vec<Case>, Vec<CaseResult>), FolderError> {
        let path = self.file(WAYPOINTS);
        let mut routes = cases::read(&path)?;
        let contradiction = |case, what| FolderError::Contradiction { path: path.clone(), case, what };
        let (mut all, mut results) = (Vec::new(), Vec::new());
        for Row { mut case, length, result } in self.read_rows()? {
            let number = case.number;
            let route = routes.remove(&number).ok_or_else(|| contradiction(number, "has no waypoints"))?;
            if route.waypoints.len() != length {
                return Err(contradiction(number, "has another number of waypoints than in results.parquet"));
            }
            if !route.leg_times.is_empty() && route.leg_times.len() + 1 != length {
                return Err(contradiction(
                    number,
                    "has leg times for another number of legs than between its waypoints",
                ));
            }
            (case.waypoints, case.leg_times, case.seen) = (route.waypoints, route.leg_times, route.seen);
            all.push(case);
            results.extend(result);
        }
        // Waypoints are written first: those of higher numbers are of a checkpoint that a kill cut short. A search that
        // came to its end leaves none.
        let last = all.iter().map(|case| case.number).max();
        match routes.keys().next() {
            Some(&number) if last.is_some_and(|last| number < last) || self.is_complete() => {
                Err(contradiction(number, "is not in results.parquet"))
            }
            _ => Ok((all, results)),
        }
    }

    /// Whether the search came to its end, and what it found stands in all tables.
    fn is_complete(&self) -> bool {
        self.has_tally() && self.read_tally().is_ok_and(|tally| tally.complete)
    }

    /// Reads the control witness of `case`, of a flight or of a drive, into it; leaves it without one where there is
    /// none and none is claimed.
    ///
    /// # Errors
    /// The file is broken; what is claimed of the case is that of a witness, and there is none.
    pub fn read_witness(&self, case: &mut Case) -> Result<(), FolderError> {
        if let Some(program) = self.read_program(case.number)? {
            case.witness = Some(program.into());
        } else if let Some((rows, _)) = self.read_rows_of(PROFILES, case.number)? {
            let drive = drive::is_drive(&rows);
            let witness = if drive { drive::from_table(&rows)?.into() } else { profile::from_table(&rows)?.into() };
            case.witness = Some(witness);
        } else if case.evidence.is_of_a_witness() {
            // Another motion would be flown in its place, and told as witnessed.
            let (table, what) = match case.evidence {
                Evidence::Witnessed => (PROFILES, "is witnessed and has no witness"),
                _ => (PROGRAMS, "is of a program and has none"),
            };
            return Err(FolderError::Contradiction { path: self.path.join(table), case: case.number, what });
        }
        Ok(())
    }

    /// The program of a case as RAPID, which is what a campaign keeps of it.
    fn module(&self, case: &Case, program: &Program) -> Result<String, FolderError> {
        let header = [format!("Evidence: {}", case.claim())];
        let refuse = |what: String| FolderError::Program { path: self.path.join(PROGRAMS), what };
        rapid::module(program, &header).map_err(|error| refuse(format!("case {}: {error}", case.number)))
    }

    /// Reads the program of a case: from a file of its own, as earlier versions wrote it, or the table's.
    fn read_program(&self, case: CaseNumber) -> Result<Option<Program>, FolderError> {
        let own = self.path.join(PROGRAMS).join(format!("{case}.mod"));
        let (path, bytes) = match own.exists() {
            true => {
                let bytes = bounds::read(&own, MOST_TEXT_BYTES);
                (own.clone(), bytes.map_err(|cause| FolderError::Unreadable { path: own, cause })?)
            }
            false => match self.read_rows_of(PROGRAMS, case)? {
                Some((rows, _)) => (self.path.join(PROGRAMS), program::from_table(&rows)?.into_bytes()),
                None => return Ok(None),
            },
        };
        let refuse = |what: String| FolderError::Program { path: path.clone(), what: format!("case {case}: {what}") };
        let frames = self.frames.get_or_init(|| self.scenario().as_ref().map_or_else(Frames::default, Frames::of));
        let module = rapid::read(&bytes, &frames.options()).map_err(|error| refuse(error.to_string()))?;
        let program = module.whole().map_err(refuse)?;
        program.checked().map(Some).map_err(|error| refuse(error.to_string()))
    }

    /// Its scenario's keys; `None` where they are none.
    fn scenario(&self) -> Option<Scenario> {
        let mut table: toml::Table = self.read_scenario().ok()?.parse().ok()?;
        table.remove(MADE_BY);
        table.try_into().ok()
    }

    /// Writes the planned motions of cases, in their order, the rows where they bend; what is in the folder of the
    /// first of these cases or of later ones goes.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write_planned(&self, planned: Vec<(CaseNumber, Piece)>) -> Result<(), FolderError> {
        self.add_pieces(TRAJECTORIES, planned)
    }

    /// Reads the planned motion of a case, sampled as it was planned.
    ///
    /// # Errors
    /// It is missing or broken.
    pub fn read_planned(&self, case: CaseNumber) -> Result<Track, FolderError> {
        let path = self.path.join(TRAJECTORIES);
        let found = self.read_rows_of(TRAJECTORIES, case)?;
        let (rows, period) = found.ok_or(FolderError::Contradiction { path, case, what: "has no planned motion" })?;
        Ok(track::sampled(&rows, period)?)
    }

    /// The rows that are kept of the planned motion of a case, as they are, and the time between the samples that they
    /// stand for where not all are there; `None` in a folder that keeps no planned motions.
    ///
    /// # Errors
    /// The file is broken, or has those of other cases alone.
    pub fn read_planned_rows(&self, case: CaseNumber) -> Result<Option<(Track, Option<f64>)>, FolderError> {
        let path = self.path.join(TRAJECTORIES);
        match self.read_rows_of(TRAJECTORIES, case)? {
            Some((rows, period)) => Ok(Some((track::from_table(&rows)?, period))),
            None if parts_of(&self.path, TRAJECTORIES).is_empty() && is_empty(&path) => Ok(None),
            None => Err(FolderError::Contradiction { path, case, what: "has no planned motion" }),
        }
    }

    /// The rows of a case in `table` and, where only some are there, the time between its samples; from a file of its
    /// own in folders that have one per case.
    fn read_rows_of(&self, table: &str, case: CaseNumber) -> Result<Option<(Table, Option<f64>)>, FolderError> {
        let own = self.path.join(table).join(format!("{case}.parquet"));
        if own.exists() {
            return Ok(Some((Table::read(&own)?, None)));
        }
        let Some(part) = self.part_with(table, case)? else { return Ok(None) };
        Ok(part.table((case, 0))?.map(|rows| (rows, part.period())))
    }
}

/// Whether there is nothing in `folder`, or no such folder.
fn is_empty(folder: &Path) -> bool {
    fs::read_dir(folder).map_or(true, |mut entries| entries.next().is_none())
}
