//! Runs on their way into a campaign's folder: gathered part by part, each written when its last run has landed, and
//! now and then before, so that a kill costs little. Runs come in any order and from any thread; the parts are the
//! same.

use std::collections::btree_map::Entry;
use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use hairpin::campaign::{CaseNumber, Run};

use super::parts::{CASES_PER_PART, EXECUTIONS, RERUN_FACTS, RERUNS};
use super::{CampaignFolder, FolderError, RUNS};
use crate::atomic::{self, WriteError};
use crate::parquet::part_writer::PartWriter;
use crate::parquet::piece::Piece;
use crate::parquet::runs::{self, RunFacts};

/// Runs of a part at most: no reader opens more row groups than these to find one.
const RUNS_PER_PART: usize = 5000;
/// Between two writings of a part that is not whole: what a kill may cost …
const CHECKPOINT: Duration = Duration::from_secs(20);
/// … and how often the time that a writing took has to pass before the next.
const SELDOM: u32 = 20;

/// Where runs are kept: the motion, and what is known beside it.
#[derive(Debug, Clone, Copy)]
struct Tables {
    motion: &'static str,
    facts: &'static str,
}

/// A run that has landed, packed.
#[derive(Debug)]
pub struct Landed {
    facts: RunFacts,
    motion: Option<Piece>,
}

impl Landed {
    /// `run`, of whose rows those in `marked` are kept beside the ones where it bends.
    ///
    /// # Errors
    /// There is no room for it.
    pub fn of(run: &Run, marked: &BTreeSet<usize>) -> io::Result<Self> {
        Ok(Self { facts: RunFacts::of(run), motion: runs::piece(run, marked)? })
    }

    /// `run` under the number `kept`, without its motion.
    pub fn bare(run: &Run, kept: usize) -> Self {
        Self { facts: RunFacts { run: kept, recorded: false, ..RunFacts::of(run) }, motion: None }
    }

    /// One that has landed before.
    pub(super) fn known(facts: RunFacts, motion: Option<Piece>) -> Self {
        Self { facts, motion }
    }

    /// The same of a violation that was run again, for the time number `again`.
    ///
    /// # Errors
    /// There is no room for it.
    pub fn again(run: &Run, again: usize, marked: &BTreeSet<usize>) -> io::Result<Self> {
        Ok(Self { facts: RunFacts { run: again, ..RunFacts::of(run) }, motion: runs::motion(run, again, marked)? })
    }
}

/// A part whose runs are landing.
struct Open {
    facts: BTreeMap<(CaseNumber, usize), RunFacts>,
    motion: PartWriter,
    saved: Instant,
    next: Duration,
}

/// Takes runs in.
pub struct RunWriter<'f> {
    folder: &'f CampaignFolder,
    tables: Tables,
    cases_per_part: usize,
    /// Runs that each part has once it is whole.
    whole: BTreeMap<usize, usize>,
    open: Mutex<BTreeMap<usize, Arc<Mutex<Open>>>>,
}

impl CampaignFolder {
    /// Takes in the runs of cases that are flown `repeat` times each; the parts are whole with `all`.
    pub fn write_runs(&self, repeat: usize, all: impl Iterator<Item = (CaseNumber, usize)>) -> RunWriter<'_> {
        RunWriter::new(self, Tables { motion: EXECUTIONS, facts: RUNS }, repeat, all)
    }

    /// Takes in violations that were run again, up to `repeat` times each.
    pub fn write_reruns(&self, repeat: usize, all: impl Iterator<Item = (CaseNumber, usize)>) -> RunWriter<'_> {
        RunWriter::new(self, Tables { motion: RERUNS, facts: RERUN_FACTS }, repeat, all)
    }
}

impl<'f> RunWriter<'f> {
    fn new(
        folder: &'f CampaignFolder,
        tables: Tables,
        repeat: usize,
        all: impl Iterator<Item = (CaseNumber, usize)>,
    ) -> Self {
        let cases_per_part = (RUNS_PER_PART / repeat.max(1)).clamp(1, CASES_PER_PART);
        let mut whole = BTreeMap::new();
        all.for_each(|(case, _)| *whole.entry(case.0 / cases_per_part).or_default() += 1);
        Self { folder, tables, cases_per_part, whole, open: Mutex::default() }
    }

    /// That there is no room for what is to land.
    pub fn no_room(&self, cause: io::Error) -> FolderError {
        self.folder.no_room(self.tables.motion, cause)
    }

    /// The number of the part that a case belongs to.
    fn part_of(&self, case: CaseNumber) -> usize {
        case.0 / self.cases_per_part
    }

    /// Takes a run in.
    ///
    /// # Errors
    /// A part cannot be written.
    pub fn land(&self, landed: Landed) -> Result<(), FolderError> {
        let key = (landed.facts.case, landed.facts.run);
        let number = self.part_of(key.0);
        let part = self.part(number)?;
        // Others land in other parts meanwhile, whatever this one has to write.
        let mut open = part.lock().unwrap_or_else(PoisonError::into_inner);
        open.facts.insert(key, landed.facts);
        open.motion.leave_out(key);
        if let Some(piece) = landed.motion {
            self.folder.put(&mut open.motion, self.tables.motion, (key, piece))?;
        }
        if Some(&open.facts.len()) == self.whole.get(&number) {
            self.save(number, &mut open)?;
            let mut all = self.open.lock().unwrap_or_else(PoisonError::into_inner);
            // The map's and this one: nobody else waits to land in it, who would be alone with what was forgotten.
            if Arc::strong_count(&part) == 2 {
                all.remove(&number);
            }
        } else if open.saved.elapsed() > open.next {
            let begun = Instant::now();
            self.save(number, &mut open)?;
            (open.saved, open.next) = (Instant::now(), CHECKPOINT.max(SELDOM * begun.elapsed()));
        }
        Ok(())
    }

    /// The part of this number, which is open from now on.
    fn part(&self, number: usize) -> Result<Arc<Mutex<Open>>, FolderError> {
        let mut all = self.open.lock().unwrap_or_else(PoisonError::into_inner);
        Ok(match all.entry(number) {
            Entry::Occupied(open) => open.get().clone(),
            Entry::Vacant(place) => place.insert(Arc::new(Mutex::new(self.begun(number)?))).clone(),
        })
    }

    /// Writes the parts that are not whole, so that what has landed stays.
    ///
    /// # Errors
    /// One cannot be written.
    pub fn finish(self) -> Result<(), FolderError> {
        let open = std::mem::take(&mut *self.open.lock().unwrap_or_else(PoisonError::into_inner));
        open.into_iter()
            .try_for_each(|(number, open)| self.save(number, &mut open.lock().unwrap_or_else(PoisonError::into_inner)))
    }

    /// A part with the runs that are in the folder already and sound.
    fn begun(&self, number: usize) -> Result<Open, FolderError> {
        let Tables { motion, facts } = self.tables;
        let path = self.folder.part_path(facts, number);
        // What cannot be read is flown again.
        let facts = if path.is_file() { runs::read_facts(&path).unwrap_or_default() } else { BTreeMap::new() };
        let motion = self.folder.begun_part(motion, number, &|case, run| facts.contains_key(&(case, run)));
        let motion = motion.unwrap_or_else(|_| PartWriter::in_folder(self.folder.path()));
        let moved: BTreeSet<_> = motion.keys().collect();
        let sound = |key: &(CaseNumber, usize), facts: &RunFacts| !facts.has_motion() || moved.contains(key);
        let facts = facts.into_iter().filter(|(key, facts)| sound(key, facts)).collect();
        Ok(Open { facts, motion, saved: Instant::now(), next: CHECKPOINT })
    }

    /// First the motion, then what is known of it: nothing is said of runs that are not there.
    fn save(&self, number: usize, open: &mut Open) -> Result<(), FolderError> {
        self.folder.save_part(self.tables.motion, number, &mut open.motion)?;
        let path = self.folder.part_path(self.tables.facts, number);
        atomic::make_folder(&self.folder.path().join(self.tables.facts))?;
        let facts: Vec<RunFacts> = open.facts.values().cloned().collect();
        self.folder.forget_facts(&path);
        runs::write_facts(&path, &facts).map_err(|error: WriteError| error.into())
    }
}
