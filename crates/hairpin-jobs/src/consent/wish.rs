//! What a scenario asks for beyond being read.

use std::fmt;
use std::path::Path;

use hairpin::campaign::Setup;
use hairpin::campaign::scenario::{COMMAND, CONTROLLER_KEY, TARGET_KEY};
use hairpin_formats::bounds::{self, MOST_RASTER_BYTES};
use hairpin_formats::executor::Command;
use hairpin_formats::recordings::leads_out;

use crate::sets::Set;

/// One thing that a scenario wants run or read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Wish {
    key: String,
    what: What,
}

#[derive(Debug, Clone, PartialEq, Eq)]
enum What {
    /// A program that flies.
    Command(String),
    /// A Python file, by the name that the user knows, and its hash.
    Python { file: String, hash: [u8; 32] },
    /// Recordings that lie outside the folder.
    Logs(String),
}

impl Wish {
    /// A command of `execute`.
    pub(crate) fn command(command: &str) -> Self {
        Self { key: "execute.command".into(), what: What::Command(command.into()) }
    }

    /// What executing asks for.
    pub(crate) fn of_execution(setup: &Setup) -> Vec<Self> {
        let command = setup.scenario.executor().command.map(Self::command);
        let outside = setup.recordings().filter(|logs| leads_out(logs));
        let logs = outside.map(|logs| Self { key: "execute.logs".into(), what: What::Logs(logs.into()) });
        command.into_iter().chain(Self::of_controller(setup)).chain(logs).collect()
    }

    /// What steering asks for.
    fn of_controller(setup: &Setup) -> Option<Self> {
        let user = setup.user_controller()?;
        let what = match (&user.file, user.word.strip_prefix(COMMAND)) {
            (Some((_, bytes)), _) => What::Python { file: user.given.clone(), hash: blake3::hash(bytes).into() },
            (None, command) => What::Command(command.unwrap_or_default().into()),
        };
        Some(Self { key: CONTROLLER_KEY.into(), what })
    }

    /// What searching asks for.
    pub(crate) fn of_search(setup: &Setup) -> Vec<Self> {
        let (scenario, attachments) = (&setup.scenario, &setup.attachments);
        let score = attachments.user_score(scenario.score()).map(|score| Self {
            key: scenario.score_key().into(),
            what: What::Python { file: score.given.clone(), hash: blake3::hash(&score.bytes).into() },
        });
        let target = attachments.user_target(scenario.search().target.as_ref()).map(|target| Self {
            key: TARGET_KEY.into(),
            what: What::Python { file: target.given.clone(), hash: blake3::hash(&target.bytes).into() },
        });
        score.into_iter().chain(target).collect()
    }

    /// All that a campaign asks for.
    pub(crate) fn of_campaign(setup: &Setup) -> Vec<Self> {
        Self::of_search(setup).into_iter().chain(Self::of_execution(setup)).collect()
    }

    /// Whether its key, or a table that it is in, is among those that were typed.
    pub(crate) fn is_typed(&self, sets: &[Set]) -> bool {
        let below = |key: &str| self.key.strip_prefix(key).is_some_and(|rest| rest.is_empty() || rest.starts_with('.'));
        sets.iter().any(|(key, _)| below(key.trim()))
    }

    /// Whether something is run, not only read.
    pub(super) fn runs(&self) -> bool {
        !matches!(self.what, What::Logs(_))
    }

    /// What a mark on it in the folder `real` is of: its key, what it says, and what of the folder runs with it.
    pub(super) fn parts(&self, real: &Path) -> Vec<Vec<u8>> {
        let part = |text: &str| text.as_bytes().to_vec();
        let mut parts = vec![part(&self.key)];
        match &self.what {
            What::Command(command) => {
                parts.extend([part("command"), part(command)]);
                let words = command.parse::<Command>();
                let words = words.iter().flat_map(Command::words).map(Path::new);
                let files = words.filter_map(|word| word.canonicalize().ok()).filter(|file| file.starts_with(real));
                // One that cannot be read is one, too: it may be readable when the command runs.
                parts.extend(files.map(|file| match bounds::read(&file, MOST_RASTER_BYTES) {
                    Ok(text) => blake3::hash(&text).as_bytes().to_vec(),
                    Err(_) => part("unread"),
                }));
            }
            What::Python { hash, .. } => parts.extend([part("python"), hash.to_vec()]),
            What::Logs(logs) => parts.extend([part("logs"), part(logs)]),
        }
        parts
    }
}

impl fmt::Display for Wish {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { key, what } = self;
        match what {
            What::Command(command) => write!(f, "run `{command}` (`{key}`)"),
            What::Python { file, .. } => write!(f, "run the Python file \"{file}\" (`{key}`)"),
            What::Logs(logs) => write!(f, "read \"{logs}\", which lies outside it (`{key}`)"),
        }
    }
}
