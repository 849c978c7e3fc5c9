//! Which logs of a real controller are which runs of a campaign, by their names, and what is in them.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::{Case, CaseNumber, Run};
use thiserror::Error;

use crate::controller_log::{self, ControllerLog, ControllerLogError};
use crate::folder::inside;

/// Why logs are not the runs of a campaign.
#[derive(Debug, Error)]
pub enum RecordingError {
    /// The folder of the pattern cannot be read.
    #[error("`execute.logs`: {} cannot be read: {cause}", folder.display())]
    Folder {
        /// Which.
        folder: PathBuf,
        /// The system's answer.
        cause: std::io::Error,
    },
    /// A link among what lies in the campaign's own folder.
    #[error("`execute.logs` = \"{pattern}\": {why}")]
    Link {
        /// The pattern.
        pattern: String,
        /// What is wrong.
        why: String,
    },
    /// A file fits the pattern, and its name is no run's.
    #[error("{}: `{stem}` is no run of this campaign: {why}", path.display())]
    Name {
        /// The file.
        path: PathBuf,
        /// What `*` stands for.
        stem: String,
        /// What is wrong with it.
        why: String,
    },
    /// Two files of one run.
    #[error("{} and {} are the same run", first.display(), second.display())]
    Twice {
        /// One of them.
        first: PathBuf,
        /// The other.
        second: PathBuf,
    },
    /// Fewer or more logs of a case than the scenario has runs.
    #[error("case {case} has {found} logs that match `{pattern}`, and `execute.repeat` = {expected}{}", if *found == 0 { "" } else { ": set it to the number of logs" })]
    Count {
        /// The case.
        case: String,
        /// Logs found.
        found: usize,
        /// Runs that the scenario asks for.
        expected: usize,
        /// Where they were looked for.
        pattern: String,
    },
    /// A file that is no recording.
    #[error(transparent)]
    Log(#[from] ControllerLogError),
    /// It ends before the program does.
    #[error("{}, line {line}: the log ends at t = {time} s, on move {reached} of {moves} ({name}): it is shorter than the program", path.display())]
    Shorter {
        /// The file.
        path: PathBuf,
        /// Its last line.
        line: usize,
        /// Its last stamp, s.
        time: f64,
        /// The move that it ends on, from 1.
        reached: usize,
        /// Moves of the program.
        moves: usize,
        /// That move's name.
        name: String,
    },
    /// The oracle cannot hold it against the program.
    #[error("{}: {why}", path.display())]
    Refused {
        /// The file.
        path: PathBuf,
        /// Why.
        why: String,
    },
}

/// `pattern`, which is relative to `base`, as one that is relative to `folder`; an absolute one stays.
pub fn relative_to(folder: &Path, base: &Path, pattern: &str) -> String {
    if Path::new(pattern).is_absolute() {
        return pattern.into();
    }
    let (from, to) = (plain(folder), plain(&base.join(pattern)));
    let shared = from.iter().zip(&to).take_while(|(a, b)| a == b).count();
    let up = (shared..from.len()).map(|_| "..".to_owned());
    let down = to[shared..].iter().map(|part| part.to_string_lossy().into_owned());
    up.chain(down).collect::<Vec<_>>().join("/")
}

/// Whether logs that `pattern` names may lie outside the folder that it is relative to.
pub fn leads_out(pattern: &str) -> bool {
    Path::new(pattern).components().any(|part| !matches!(part, Component::Normal(_) | Component::CurDir))
}

/// The parts of a path from the root on, `.` and `..` resolved by name.
fn plain(path: &Path) -> Vec<std::ffi::OsString> {
    let whole = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut parts = Vec::new();
    for part in whole.components() {
        match part {
            Component::ParentDir => drop(parts.pop()),
            Component::CurDir => {}
            Component::Prefix(_) | Component::RootDir | Component::Normal(_) => parts.push(part.as_os_str().to_owned()),
        }
    }
    parts
}

/// The log of every run of `cases`. In the name of a file that matches `pattern` (relative to `folder`) the `*` stands
/// for `CASE-RUN`, or for `CASE` alone where a case has one run: `0003-1`, `0003`. Runs may be numbered from anywhere;
/// they become run 0, 1, … in the order of their numbers.
///
/// # Errors
/// Every file whose name is no run's, cases with another number of logs than `repeat`.
pub fn find(
    folder: &Path,
    pattern: &str,
    cases: &[Case],
    repeat: usize,
) -> Result<BTreeMap<(CaseNumber, usize), PathBuf>, Vec<RecordingError>> {
    let path = folder.join(pattern);
    let parent = path.parent().unwrap_or(folder).to_owned();
    let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let (before, after) = name.split_once('*').unwrap_or((&name, ""));
    let listed = fs::read_dir(&parent).and_then(Iterator::collect::<Result<Vec<_>, _>>);
    if !leads_out(pattern) {
        let parent = Path::new(pattern).parent().unwrap_or(Path::new(""));
        let names = listed.iter().flatten().map(|entry| parent.join(entry.file_name()));
        // What lies in a campaign's folder may be a stranger's.
        let link = names.chain([parent.to_owned()]).find_map(|name| inside(folder, &name.to_string_lossy()).err());
        if let Some(why) = link {
            return Err(vec![RecordingError::Link { pattern: pattern.into(), why }]);
        }
    }
    let mut files: Vec<PathBuf> = match listed {
        Ok(entries) => entries.into_iter().map(|entry| entry.path()).collect(),
        Err(cause) => return Err(vec![RecordingError::Folder { folder: parent, cause }]),
    };
    files.sort_unstable();
    let mut wrong = Vec::new();
    let mut numbered: BTreeMap<CaseNumber, BTreeMap<u64, PathBuf>> =
        cases.iter().map(|case| (case.number, BTreeMap::new())).collect();
    for file in files {
        let name = file.file_name().unwrap_or_default().to_string_lossy().into_owned();
        let stem = name.strip_prefix(before).and_then(|rest| rest.strip_suffix(after));
        let Some(stem) = stem.filter(|_| name.len() >= before.len() + after.len()) else { continue };
        let found = run_of(stem).and_then(|(case, run)| match numbered.get_mut(&case) {
            Some(runs) => Ok((runs, run)),
            None => Err(format!("there is no case {case}")),
        });
        match found {
            Err(why) => wrong.push(RecordingError::Name { path: file, stem: stem.into(), why }),
            Ok((runs, run)) => {
                if let Some(first) = runs.insert(run, file.clone()) {
                    wrong.push(RecordingError::Twice { first, second: file });
                }
            }
        }
    }
    for (case, runs) in &numbered {
        if runs.len() != repeat {
            let count = RecordingError::Count {
                case: case.to_string(),
                found: runs.len(),
                expected: repeat,
                pattern: path.display().to_string(),
            };
            wrong.push(count);
        }
    }
    if !wrong.is_empty() {
        return Err(wrong);
    }
    let runs = numbered
        .into_iter()
        .flat_map(|(case, runs)| runs.into_values().enumerate().map(move |(run, path)| ((case, run), path)));
    Ok(runs.collect())
}

/// `0003-1` as case 3, run 1; `0003` as its run 0.
fn run_of(stem: &str) -> Result<(CaseNumber, u64), String> {
    const RULE: &str = "`*` must stand for CASE-RUN or CASE, such as 0003-1";
    let digits = |text: &str, least: usize| text.len() >= least && text.bytes().all(|byte| byte.is_ascii_digit());
    let (case, run) = stem.split_once('-').unwrap_or((stem, "0"));
    if !digits(case, 4) || !digits(run, 1) {
        return Err(RULE.into());
    }
    Ok((case.parse().map_err(|_| RULE)?, run.parse().map_err(|_| RULE)?))
}

/// The recording at `path` as run `run` of `case`.
///
/// # Errors
/// A file that is no recording, one whose stamps do not rise, one that is shorter than the program; joints more than a
/// turn beyond their bounds.
pub fn read(path: &Path, arm: &ArmSetup, case: &Case, run: usize) -> Result<Run, RecordingError> {
    let ControllerLog { track, orientation_known, last_line, .. } =
        controller_log::read(path, Some((&arm.station.arm, &arm.station.tool.tcp)))?;
    let refuse = |why: String| RecordingError::Refused { path: path.into(), why };
    let beyond = arm.beyond_bounds(&track);
    if let Some(why) = beyond.and_then(|beyond| beyond.refused(&format!("joint {}", beyond.axis))) {
        return Err(refuse(why));
    }
    let recorded = arm.recorded(case, track, orientation_known).map_err(|error| refuse(error.to_string()))?;
    match recorded {
        (flight, None) => Ok(Run { case: case.number, run, drawn: Vec::new(), outcome: Ok(flight), full_rate: None }),
        (_, Some(short)) => Err(RecordingError::Shorter {
            path: path.into(),
            line: last_line,
            time: short.ends,
            reached: short.reached + 1,
            moves: short.moves,
            name: short.name,
        }),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_runs() {
        let run = |case, run| Ok((CaseNumber(case), run));
        assert_eq!((run_of("0003-1"), run_of("0003"), run_of("10000-12")), (run(3, 1), run(3, 0), run(10_000, 12)));
        for stem in ["", "3", "003-1", "0003-", "0003-a", "x0003", "0003-1-2", "0003-99999999999999999999"] {
            assert!(run_of(stem).is_err(), "{stem}");
        }
    }

    #[test]
    fn patterns_are_told_from_where_the_folder_is() {
        let told = |folder: &str, base: &str, pattern: &str| relative_to(Path::new(folder), Path::new(base), pattern);
        assert_eq!(told("/w/out/arm", "/w", "nightly/*.csv"), "../../nightly/*.csv");
        assert_eq!(told("/w/out/arm", "/w/x", "../nightly/*.csv"), "../../nightly/*.csv");
        assert_eq!(told("/w/out", "/w/out", "*.csv"), "*.csv");
        assert_eq!(told("/w/out", "/v", "/n/*.csv"), "/n/*.csv");
        assert_eq!(told("out/arm", "", "nightly/*.csv"), "../../nightly/*.csv");
    }
}
