//! Tables of a campaign in parts: `NAME/part-00000.parquet` and so on, blocks of whole cases in their order, a row
//! group a case or run; or one file `NAME.parquet`. A case is found by looking into few parts, and read without the
//! rest.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use hairpin::campaign::CaseNumber;

use super::{CampaignFolder, FolderError};
use crate::atomic;
use crate::parquet::part::Part;
use crate::parquet::part_writer::PartWriter;
use crate::parquet::piece::Piece;

pub(super) const TRAJECTORIES: &str = "trajectories";
pub(super) const PROFILES: &str = "profiles";
pub(super) const PROGRAMS: &str = "programs";
pub(super) const EXECUTIONS: &str = "executions";
pub(super) const RERUNS: &str = "reruns";
/// What is known of reruns beside their motion.
pub(super) const RERUN_FACTS: &str = "rerun-runs";

/// Cases of a part.
pub(super) const CASES_PER_PART: usize = 1000;

/// What schema the rows of a table have, as their files say it.
fn schema_of(table: &str) -> &'static str {
    match table {
        TRAJECTORIES => "trajectory",
        PROFILES => "profile",
        PROGRAMS => "program",
        _ => "execution",
    }
}

fn single_file(folder: &Path, table: &str) -> PathBuf {
    folder.join(format!("{table}.parquet"))
}

/// Parts of a table in order; of one in a single file, that.
pub(super) fn parts_of(folder: &Path, table: &str) -> Vec<PathBuf> {
    let entries = std::fs::read_dir(folder.join(table)).into_iter().flatten().flatten().map(|entry| entry.path());
    let is_part = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        name.starts_with("part-") && name.ends_with(".parquet")
    };
    let mut parts: Vec<PathBuf> = entries.filter(is_part).collect();
    parts.sort();
    let single = single_file(folder, table);
    if parts.is_empty() && single.is_file() {
        parts.push(single);
    }
    parts
}

/// The number of a part by its file's name; `None` of a table in a single file.
pub(super) fn part_number(path: &Path) -> Option<usize> {
    path.file_stem()?.to_str()?.strip_prefix("part-")?.parse().ok()
}

/// The one of `parts`, whose cases rise, that `case` would be in, by what `cases` says of each: the one whose number
/// says so is asked first.
pub(super) fn part_with<T>(
    parts: &[PathBuf],
    case: CaseNumber,
    mut cases: impl FnMut(&Path) -> Result<(T, Option<(CaseNumber, CaseNumber)>), FolderError>,
) -> Result<Option<T>, FolderError> {
    if let Some(likely) = parts.iter().find(|part| part_number(part) == Some(case.0 / CASES_PER_PART))
        && let (part, Some((first, last))) = cases(likely)?
        && (first..=last).contains(&case)
    {
        return Ok(Some(part));
    }
    search(parts, case, &mut cases)
}

/// As [`part_with`] of parts of which nothing is known but that their cases rise.
fn search<T>(
    parts: &[PathBuf],
    case: CaseNumber,
    cases: &mut impl FnMut(&Path) -> Result<(T, Option<(CaseNumber, CaseNumber)>), FolderError>,
) -> Result<Option<T>, FolderError> {
    let (mut low, mut high) = (0, parts.len());
    while low < high {
        let middle = (low + high) / 2;
        let (part, range) = cases(&parts[middle])?;
        match range {
            Some((first, _)) if case < first => high = middle,
            Some((_, last)) if case > last => low = middle + 1,
            Some(_) => return Ok(Some(part)),
            // One without rows says nothing of its neighbours.
            None => {
                let rest: Vec<PathBuf> = [&parts[low..middle], &parts[middle + 1..high]].concat();
                return search(&rest, case, cases);
            }
        }
    }
    Ok(None)
}

impl CampaignFolder {
    /// Lets go of all parts that are open: files are removed.
    pub(super) fn close_tables(&self) {
        self.open_parts.forget_all();
        self.facts.forget_all();
    }

    /// The part of `table` that has `case`; `None` where none has.
    pub(super) fn part_with(&self, table: &str, case: CaseNumber) -> Result<Option<Arc<Part>>, FolderError> {
        if let Some(part) = self.open_parts.find(|path, part| self.is_around(table, case, (path, part.cases()))) {
            return Ok(Some(part));
        }
        part_with(&parts_of(&self.path, table), case, |path| {
            let part = self.open_parts.or_read(path, Part::open)?;
            let cases = part.cases();
            Ok((part, cases))
        })
    }

    /// Whether a file is one of `table` whose cases, the first and the last of them, have `case` between them.
    pub(super) fn is_around(
        &self,
        table: &str,
        case: CaseNumber,
        (path, cases): (&Path, Option<(CaseNumber, CaseNumber)>),
    ) -> bool {
        let is_of = path.parent() == Some(&self.path.join(table)) || path == single_file(&self.path, table);
        is_of && cases.is_some_and(|(first, last)| (first..=last).contains(&case))
    }

    /// `NAME/part-NNNNN.parquet`.
    pub(super) fn part_path(&self, table: &str, number: usize) -> PathBuf {
        self.path.join(table).join(format!("part-{number:05}.parquet"))
    }

    /// Writes a part of `table`, whose folder is made when it is needed.
    pub(super) fn save_part(&self, table: &str, number: usize, part: &mut PartWriter) -> Result<(), FolderError> {
        let path = self.part_path(table, number);
        if part.keys().next().is_none() {
            return Ok(());
        }
        atomic::make_folder(&self.path.join(table))?;
        self.open_parts.forget(&path);
        Ok(part.save(&path, schema_of(table))?)
    }

    /// One that begins with those pieces of the part number `number` that `stay`.
    pub(super) fn begun_part(
        &self,
        table: &str,
        number: usize,
        stay: &dyn Fn(CaseNumber, usize) -> bool,
    ) -> Result<PartWriter, FolderError> {
        let mut part = PartWriter::in_folder(&self.path);
        let path = self.part_path(table, number);
        if path.is_file() {
            let old = self.open_parts.or_read(&path, Part::open)?;
            for (case, run) in old.keys().filter(|(case, run)| stay(*case, *run)) {
                if let Some(piece) = old.piece((case, run))? {
                    self.put(&mut part, table, ((case, run), piece))?;
                }
            }
        }
        Ok(part)
    }

    pub(super) fn put(
        &self,
        part: &mut PartWriter,
        table: &str,
        (key, piece): ((CaseNumber, usize), Piece),
    ) -> Result<(), FolderError> {
        part.put(key, piece).map_err(|cause| self.no_room(table, cause))
    }

    /// Adds `pieces`, in the order of their cases, to `table`; what it has from the first of these cases on goes.
    pub(super) fn add_pieces(&self, table: &str, pieces: Vec<(CaseNumber, Piece)>) -> Result<(), FolderError> {
        let Some(first) = pieces.first().map(|(case, _)| *case) else { return Ok(()) };
        let mut open: Option<(usize, PartWriter)> = None;
        for (case, piece) in pieces {
            let number = case.0 / CASES_PER_PART;
            if open.as_ref().is_some_and(|(begun, _)| *begun != number)
                && let Some((begun, mut part)) = open.take()
            {
                self.save_part(table, begun, &mut part)?;
            }
            let (_, part) = match &mut open {
                Some(open) => open,
                none => none.insert((number, self.begun_part(table, number, &|case, _| case < first)?)),
            };
            self.put(part, table, ((case, 0), piece))?;
        }
        open.map_or(Ok(()), |(number, mut part)| self.save_part(table, number, &mut part))
    }
}
