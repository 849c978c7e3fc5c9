//! `parts/rounds-PLAN/`: what shards have executed of a search that learns from one round for the next, piece by piece.
//!
//! | file | says |
//! | --- | --- |
//! | `ROUND-PIECE.tsv` | what a piece of a round came to: rows of `executed.tsv`, and the SHA-256 of them in the end |
//! | `ROUND-PIECE.N.lease` | who executes it; the N-th who took it over from one that died |
//! | `alive-…` | that one of them is alive: what it says changes every second |
//! | `executor.json` | what the program of the user's that executes says of itself: the one that was started first |

use std::fs;
use std::io::{self, ErrorKind};
use std::path::{Path, PathBuf};

use hairpin::campaign::answers::Answer;

use super::executed::{read, row};
use super::json::read_json_if_there;
use super::names::stands_for;
use super::{CampaignFolder, EXECUTOR, FolderError, entries};
use crate::atomic::{self, WriteError, is_temporary};
use crate::executor::Greeting;
use crate::{bounds, checksum};

/// A piece has less than that, bytes.
const MOST: u64 = 1 << 26;
/// Of a plan's hash in the folder's name.
const DIGITS: usize = 16;
/// How the name of that folder begins, and those of its files that say who is alive.
const ROUNDS: &str = "rounds-";
/// See there.
pub const ALIVE: &str = "alive-";

/// What stands of a piece.
#[derive(Debug, PartialEq)]
pub enum Piece {
    /// All that it came to.
    Whole(Vec<Answer>),
    /// Nothing that is whole.
    Missing,
    /// It is whole, and what was executed is not what was asked for: of another search.
    Foreign,
}

impl Piece {
    /// What stands in `path` of the piece in which plans of these `names` were executed.
    ///
    /// # Errors
    /// The file is there and cannot be read.
    pub fn read(path: &Path, names: &[[u8; 16]]) -> io::Result<Self> {
        let text = match bounds::read_text(path, MOST) {
            Err(cause) if matches!(cause.kind(), ErrorKind::NotFound | ErrorKind::InvalidData) => {
                return Ok(Self::Missing);
            }
            text => text?,
        };
        let Some(rows) = unsealed(&text) else { return Ok(Self::Missing) };
        let rows: Option<Vec<_>> = rows.lines().map(read).collect();
        let Some(rows) = rows else { return Ok(Self::Missing) };
        if !rows.iter().map(|(name, _)| name).eq(names) {
            return Ok(Self::Foreign);
        }
        Ok(Self::Whole(rows.into_iter().map(|(_, answer)| answer).collect()))
    }

    /// Writes what a piece came to, unless it is there.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn write(path: &Path, names: &[[u8; 16]], answers: &[Answer]) -> Result<(), WriteError> {
        let rows: String = names.iter().zip(answers).map(|(name, answer)| row(name, answer.as_ref())).collect();
        let sealed = format!("{rows}{}\n", checksum::sha256(&rows));
        let is_broken = || !bounds::read_text(path, MOST).is_ok_and(|text| unsealed(&text).is_some());
        if !atomic::write_new(path, sealed.as_bytes())? && is_broken() {
            atomic::write(path, sealed.as_bytes())?;
        }
        Ok(())
    }
}

/// The program that executes for all shards whose rounds are kept in `folder`, as it calls itself; `None` where none
/// was started.
///
/// # Errors
/// What is kept of it is broken.
pub fn executor_of_rounds(folder: &Path) -> Result<Option<Greeting>, FolderError> {
    read_json_if_there(folder.join(EXECUTOR))
}

/// The same with the program that says `now` of itself where no other was before it.
///
/// # Errors
/// Likewise; it cannot be written.
pub fn first_executor_of_rounds(folder: &Path, now: &Greeting) -> Result<Greeting, FolderError> {
    let path = folder.join(EXECUTOR);
    let text = atomic::json_text(now).map_err(|error| WriteError { path: path.clone(), cause: error.into() })?;
    atomic::write_new(&path, text.as_bytes())?;
    Ok(executor_of_rounds(folder)?.unwrap_or_else(|| now.clone()))
}

/// The rows of a piece whose seal is theirs.
fn unsealed(text: &str) -> Option<&str> {
    let text = text.strip_suffix('\n')?;
    let (rows, seal) = text.split_at(text.rfind('\n')? + 1);
    (checksum::sha256(rows) == seal).then_some(rows)
}

impl CampaignFolder {
    /// `parts/rounds-PLAN`, for a plan with this hash.
    pub fn rounds(&self, plan: &str) -> PathBuf {
        self.parts().join(format!("{ROUNDS}{plan:.DIGITS$}"))
    }

    /// Removes what was executed of rounds, of any plan; what others have put beside it stays.
    ///
    /// # Errors
    /// Something cannot be removed.
    pub fn forget_rounds(&self) -> Result<(), FolderError> {
        for place in entries(&self.parts()).unwrap_or_default().into_iter().filter(|path| is_rounds(path)) {
            for path in entries(&place)?.into_iter().filter(|path| is_ours(path)) {
                fs::remove_file(&path).map_err(|cause| WriteError { path, cause })?;
            }
            // One with other things in it stays.
            let _ = fs::remove_dir(place);
        }
        Ok(())
    }
}

fn is_rounds(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    // A link could lead anywhere.
    name.starts_with(ROUNDS) && fs::symlink_metadata(path).is_ok_and(|found| found.is_dir())
}

fn is_ours(path: &Path) -> bool {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let of_pieces = ["PART-RUN.tsv", "PART-RUN.RUN.lease"].iter().any(|pattern| stands_for(pattern, &name));
    of_pieces || name == EXECUTOR || name.starts_with(ALIVE) || is_temporary(&name)
}

#[cfg(test)]
mod tests {
    use hairpin::campaign::answers::Executed;

    use super::*;

    #[test]
    fn a_piece_is_whole_or_missing_or_of_another_search() {
        let place = tempfile::tempdir().unwrap();
        let path = place.path().join("00003-01.tsv");
        let names = [[1; 16], [2; 16]];
        let answers =
            vec![Some(Executed { trials: vec![(0.1 + 0.2, 3, 1)], behaviour: vec![1.0 / 3.0], fails: true }), None];
        assert_eq!(Piece::read(&path, &names).unwrap(), Piece::Missing);
        Piece::write(&path, &names, &answers).unwrap();
        assert_eq!(Piece::read(&path, &names).unwrap(), Piece::Whole(answers.clone()));
        assert_eq!(Piece::read(&path, &names[..1]).unwrap(), Piece::Foreign);
        // Who was first is not written over, but one that is broken is.
        Piece::write(&path, &names, &[None, None]).unwrap();
        assert_eq!(Piece::read(&path, &names).unwrap(), Piece::Whole(answers));
        let cut = fs::read_to_string(&path).unwrap();
        for broken in [&cut[..cut.len() / 2], "", "\n", &cut.replacen("0.3", "0.4", 1)] {
            fs::write(&path, broken).unwrap();
            assert_eq!(Piece::read(&path, &names).unwrap(), Piece::Missing, "{broken}");
            Piece::write(&path, &names, &[None, None]).unwrap();
            assert_eq!(Piece::read(&path, &names).unwrap(), Piece::Whole(vec![None, None]));
        }
        assert!(
            ["00003-01.tsv", "00003-1.0.lease", "alive-x", ".hairpin-x.tmp", EXECUTOR]
                .iter()
                .all(|n| is_ours(n.as_ref()))
        );
        assert!(!is_ours("notes.tsv".as_ref()));
    }
}
