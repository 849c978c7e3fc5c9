//! A search that learns, on several machines: each follows it from the beginning, and what is to be executed in a round
//! they share, through a folder and nothing else.
//!
//! | file | does |
//! | --- | --- |
//! | `pieces` | cuts the executions of a round into pieces |
//! | `lease` | who executes a piece, and who takes over from one that died |
//! | `beat` | says that this one is alive |
//!
//! Data flow: the search asks for a batch → its pieces that nobody has are claimed and executed, those of others read
//! as they land → all of them are the answer. Which round it is and what is in it follows from the answers before, so
//! that all ask the same and nobody is told anything. A lease decides who works, never what comes of it: a piece that
//! is executed twice has one result, the one that was there first.

mod beat;
mod lease;
mod pieces;
#[cfg(test)]
mod tests;

use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::sync::{Mutex, OnceLock, PoisonError};
use std::thread::sleep;
use std::time::{Duration, Instant};

use hairpin::campaign::Batch;
use hairpin::campaign::answers::Answer;
use hairpin_formats::atomic;
use hairpin_formats::executor::Greeting;
use hairpin_formats::folder::{Piece, executor_of_rounds, first_executor_of_rounds};
use rayon::prelude::*;

use self::beat::Beat;
use self::lease::Leases;
use self::pieces::Pieces;
use crate::Problem;
use crate::program::of_another_shard;

/// What is waited before others are asked again, as a share of what was waited already; at least and at most.
const PATIENCE: f64 = 0.05;
const WAITS: [Duration; 2] = [Duration::from_micros(200), Duration::from_millis(250)];

/// How often who is alive says so, and after how long without a word one counts as dead.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pace {
    beat: Duration,
    patience: Duration,
}

impl Default for Pace {
    fn default() -> Self {
        Self { beat: Duration::from_secs(1), patience: Duration::from_secs(6) }
    }
}

/// The rounds of one search, and this machine's part in them.
pub(crate) struct Rounds {
    folder: PathBuf,
    /// Executions of a round are cut into so many pieces at most.
    most: usize,
    /// Where it begins to look for work, as a share of the pieces.
    begins: f64,
    leases: Leases,
    /// Rounds before the next one.
    number: AtomicUsize,
    any_flown: AtomicBool,
    /// Whether the program that was started here may execute, once there is one.
    may: OnceLock<bool>,
    trouble: Mutex<Option<Problem>>,
    /// Until it is dropped.
    _alive: Beat,
}

impl Rounds {
    /// Takes part in the search whose rounds are kept in `folder`, as number `place` of so many. Of its executions one
    /// is a piece where they are `dear`.
    ///
    /// # Errors
    /// The folder cannot be made or written.
    pub(crate) fn join(folder: &Path, (place, of): (u64, u64), dear: bool, pace: Pace) -> Result<Self, Problem> {
        atomic::make_folder(folder)?;
        let alive = Beat::begin(folder, pace.beat)?;
        let leases = Leases::new(folder, alive.name(), pace.patience);
        let begins = (place % of.max(1)) as f64 / of.max(1) as f64;
        let most = if dear { usize::MAX } else { pieces::OF_CHEAP };
        let (number, any_flown, trouble) = (AtomicUsize::new(0), AtomicBool::new(false), Mutex::new(None));
        Ok(Self {
            folder: folder.into(),
            most,
            begins,
            leases,
            number,
            any_flown,
            may: OnceLock::new(),
            trouble,
            _alive: alive,
        })
    }

    /// Whether an execution, anyone's, has come to something.
    pub(crate) fn any_flown(&self) -> bool {
        self.any_flown.load(Ordering::Relaxed)
    }

    /// Whether the program that says `now` of itself may execute: it does for the other shards as well, or none was
    /// started before it.
    pub(crate) fn may(&self, now: &Greeting) -> bool {
        *self.may.get_or_init(|| {
            let refused = match first_executor_of_rounds(&self.folder, now) {
                Ok(first) if first.is_of_same(now) => return true,
                Ok(first) => of_another_shard(&first, now),
                Err(error) => error.into(),
            };
            self.trouble.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(refused);
            false
        })
    }

    /// The program that executes for all shards; `None` where none has been started.
    ///
    /// # Errors
    /// What is kept of it is broken.
    pub(crate) fn program(&self) -> Result<Option<Greeting>, Problem> {
        Ok(executor_of_rounds(&self.folder)?)
    }

    /// Whether nothing more can be shared.
    pub(crate) fn is_in_trouble(&self) -> bool {
        self.trouble.lock().unwrap_or_else(PoisonError::into_inner).is_some()
    }

    /// Why not.
    pub(crate) fn trouble(&self) -> Option<Problem> {
        self.trouble.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    /// What all of `batch`, the next round, came to; where it was `stopped`, what is known of it.
    pub(crate) fn carry_out(&self, batch: &Batch, stopped: &(dyn Fn() -> bool + Sync)) -> Vec<Option<Answer>> {
        if batch.names.is_empty() {
            return Vec::new();
        }
        let round = self.number.fetch_add(1, Ordering::Relaxed);
        let pieces = Pieces::of(round, batch.names.len(), self.most);
        let mut known: Vec<Option<Vec<Answer>>> = vec![None; pieces.count()];
        let mut waiting = Instant::now();
        loop {
            let open: Vec<usize> = pieces.from(self.begins).filter(|piece| known[*piece].is_none()).collect();
            let look = |piece: &usize| (*piece, self.piece((&pieces, *piece), batch, stopped));
            let found: Vec<_> = open.par_iter().with_max_len(1).map(look).collect();
            let is_new = found.iter().any(|(_, answers)| answers.is_some());
            found.into_iter().for_each(|(piece, answers)| known[piece] = answers);
            if known.iter().all(Option::is_some) || stopped() {
                break;
            }
            if is_new {
                waiting = Instant::now();
            }
            sleep(waiting.elapsed().mul_f64(PATIENCE).clamp(WAITS[0], WAITS[1]));
        }
        let all = known.into_iter().enumerate().flat_map(|(piece, answers)| match answers {
            Some(answers) => answers.into_iter().map(Some).collect(),
            None => vec![None; pieces.places(piece).len()],
        });
        all.collect()
    }

    /// What a piece came to: what stands there, or what it comes to now where nobody else is at it.
    fn piece(
        &self,
        (pieces, piece): (&Pieces, usize),
        batch: &Batch,
        stopped: &(dyn Fn() -> bool + Sync),
    ) -> Option<Vec<Answer>> {
        let (name, names) = (pieces.name(piece), &batch.names[pieces.places(piece)]);
        let path = self.folder.join(format!("{name}.tsv"));
        let done = || -> Result<Option<Vec<Answer>>, Problem> {
            if let Some(answers) = self.read(&path, names)? {
                return Ok(Some(answers));
            }
            if stopped() || !self.leases.claim(&name)? {
                return Ok(None);
            }
            let executed: Option<Vec<Answer>> = pieces.places(piece).map(|place| (batch.execute)(place)).collect();
            let Some(executed) = executed else { return Ok(None) };
            Piece::write(&path, names, &executed)?;
            // Who took over meanwhile may have been first, and what a program of the user's does may differ.
            Ok(Some(self.read(&path, names)?.unwrap_or(executed)))
        };
        let answers = done().unwrap_or_else(|problem| {
            self.trouble.lock().unwrap_or_else(PoisonError::into_inner).get_or_insert(problem);
            None
        });
        if answers.iter().flatten().any(Option::is_some) {
            self.any_flown.store(true, Ordering::Relaxed);
        }
        answers
    }

    fn read(&self, path: &Path, names: &[[u8; 16]]) -> Result<Option<Vec<Answer>>, Problem> {
        match Piece::read(path, names).map_err(|cause| Problem::of_file(path, cause))? {
            Piece::Whole(answers) => Ok(Some(answers)),
            Piece::Missing => Ok(None),
            Piece::Foreign => Err(Problem::of_file(
                path,
                "another shard has executed other trajectories in this round: a file that the scenario names, or a program \
                 that it asks, does not answer alike on all machines; hairpin plan … --force begins anew",
            )),
        }
    }
}
