//! Which program executed: all that is executed of a campaign is one program's, or what is told of it would be told of
//! another.

use std::path::Path;
use std::sync::{Mutex, OnceLock, PoisonError};

use hairpin::campaign::Setup;
use hairpin_formats::bounds;
use hairpin_formats::executor::{Command, Greeting};
use hairpin_formats::folder::{CampaignFolder, FolderError};

use crate::Problem;

/// A program by its own words: `` `sim`, version `2` ``.
pub(crate) fn words(greeting: &Greeting) -> String {
    match &greeting.version {
        Some(told) => format!("`{}`, version `{told}`", greeting.name),
        None => format!("`{}` without a version", greeting.name),
    }
}

/// Files of a program are no larger, bytes: what is larger counts by its name alone.
const MOST: u64 = 1 << 28;

/// A hash of who executes for `setup`, by what can be seen of it: the command, or our simulator's controller, the files
/// that it names, and what a program `said` of itself. What these load beside them is not looked at: a version in a
/// program's `ready` tells.
pub(crate) fn fingerprint(setup: &Setup, said: Option<&Greeting>) -> String {
    let mut hash = blake3::Hasher::new();
    let mut take = |bytes: &[u8]| {
        hash.update(&(bytes.len() as u64).to_le_bytes());
        hash.update(bytes);
    };
    let own = setup.user_controller();
    let given = setup.scenario.executor().command.or_else(|| Some(own?.word.as_str())).or(setup.scenario.controller());
    let given = given.unwrap_or_default();
    take(given.as_bytes());
    let said = said.map(|said| [said.name.as_str(), said.version.as_deref().unwrap_or_default()]);
    said.iter().flatten().for_each(|word| take(word.as_bytes()));
    if let Some((_, bytes)) = own.and_then(|own| own.file.as_ref()) {
        take(bytes);
    }
    let command: Option<Command> = given.trim_start_matches("command:").parse().ok();
    let files = command.iter().flat_map(Command::words).map(Path::new).filter(|file| file.is_file());
    files.filter_map(|file| bounds::read(file, MOST).ok()).for_each(|bytes| take(&bytes));
    hash.finalize().to_hex().to_string()
}

/// What is to be known of what the program that says `now` of itself flew again, where it is another than flew it
/// `before`: a sentence.
pub(crate) fn another_than(before: Option<&Greeting>, now: Option<&Greeting>) -> Option<String> {
    let (before, now) = before.zip(now)?;
    let told = || format!("another program flew it now: {}; before it was {}", words(now), words(before));
    (!before.is_of_same(now)).then(told)
}

/// Who executes in a campaign's folder, held against who did before.
pub(crate) struct Executing<'f> {
    folder: &'f CampaignFolder,
    before: Option<Greeting>,
    now: OnceLock<Greeting>,
    is_kept: Mutex<bool>,
}

impl<'f> Executing<'f> {
    /// Of `folder`, where nobody has said anything yet.
    ///
    /// # Errors
    /// What the folder keeps of who executed is broken.
    pub(crate) fn within(folder: &'f CampaignFolder) -> Result<Self, FolderError> {
        Ok(Self { folder, before: folder.executor_before()?, now: OnceLock::new(), is_kept: Mutex::default() })
    }

    /// Whether the program that says `now` of itself may execute: it did before, or none has.
    pub(crate) fn may(&self, now: &Greeting) -> bool {
        let now = self.now.get_or_init(|| now.clone());
        self.before.as_ref().is_none_or(|before| before.is_of_same(now))
    }

    /// Writes who executes, once that is known: before anything that it executed is written, so that a kill leaves
    /// nothing of which nobody knows whose it is.
    ///
    /// # Errors
    /// It cannot be written.
    pub(crate) fn keep(&self) -> Result<(), FolderError> {
        let Some(now) = self.now.get().filter(|now| self.may(now)) else { return Ok(()) };
        let mut is_kept = self.is_kept.lock().unwrap_or_else(PoisonError::into_inner);
        if !*is_kept {
            self.folder.write_executor(now)?;
            *is_kept = true;
        }
        Ok(())
    }

    /// Whether a program was started here.
    pub(crate) fn is_known(&self) -> bool {
        self.now.get().is_some()
    }

    /// Why nothing was executed, where the program is another than before.
    pub(crate) fn refusal(&self) -> Option<Problem> {
        let (before, now) = self.before.as_ref().zip(self.now.get())?;
        (!self.may(now)).then(|| {
            Problem::input(format!(
                "the program says of itself {}; what is kept was executed by {}: go on with that one, or do all anew (execute \
                 without --resume, stress --force)",
                words(now),
                words(before)
            ))
        })
    }
}

/// Why the program that says `now` of itself executes nothing of a search that shards share, for all of whom `first`
/// executes.
pub(crate) fn of_another_shard(first: &Greeting, now: &Greeting) -> Problem {
    Problem::input(format!(
        "the program says of itself {}; what shards executed of this search is of {}: go on with that one, or hairpin plan … \
         --force begins anew",
        words(now),
        words(first)
    ))
}

/// The program that executed what the folders of `parts`, in their order, hold; `None` where none has.
///
/// # Errors
/// They were executed by several.
pub(crate) fn of_all(parts: &[CampaignFolder]) -> Result<Option<Greeting>, Problem> {
    let mut first: Option<(&CampaignFolder, Greeting)> = None;
    for part in parts {
        let Some(now) = part.read_executor()? else { continue };
        match &first {
            None => first = Some((part, now)),
            Some((_, program)) if program.is_of_same(&now) => {}
            Some((other, program)) => {
                return Err(Problem::input(format!(
                    "{} was executed by {}, and {} by {}: all runs of a campaign are one program's; remove the parts of the one \
                     and run their shards again with the other",
                    other.path().display(),
                    words(program),
                    part.path().display(),
                    words(&now)
                )));
            }
        }
    }
    Ok(first.map(|(_, program)| program))
}
