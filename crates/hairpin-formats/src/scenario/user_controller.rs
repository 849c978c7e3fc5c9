//! Controllers of the user's own: the Python file, or the program, that `execute.controller` names.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

use hairpin::campaign::scenario::{CONTROLLER_KEY, Executor, PYTHON, UserSteering};
use hairpin::campaign::user_controller::NAME;
use hairpin::campaign::{UserController, user_score, user_target};

use super::attached::Wrong;
use super::whole::read_file;
use crate::controllers::{Source, Steersman};

/// Turns in a second where nothing says how many.
const USUAL_RATE: f64 = 100.0;

/// How often it is asked, and how long a run may take.
pub(super) struct Terms {
    rate: f64,
    timeout: f64,
}

impl Terms {
    pub(super) fn of(executor: &Executor) -> Self {
        Self { rate: executor.control_rate.unwrap_or(USUAL_RATE), timeout: executor.timeout }
    }
}

/// Reads what steers. One that stands `alone` finds no other Python files beside it.
pub(super) fn read(
    steering: &mut UserSteering,
    terms: &Terms,
    find: &dyn Fn(&str) -> PathBuf,
    alone: bool,
) -> Result<Arc<UserController>, Wrong> {
    let given = steering.word().to_owned();
    let wrong = |bound: String| Wrong { key: CONTROLLER_KEY.into(), value: given.clone(), bound, at: None };
    let (source, file) = match (steering.file().map(str::to_owned), steering.command()) {
        (Some(file), _) => {
            let path = find(&file);
            let bytes = read_file(&path).map_err(|why| wrong(format!("`{file}` cannot be read: {why}")))?;
            let copy = copy_of(&file);
            steering.rename(&copy);
            (Source::Python { path, alone }, Some((copy, bytes.into())))
        }
        (None, command) => {
            let command = command.unwrap_or_default().parse();
            (Source::Command(command.map_err(|error| wrong(format!("{error}")))?), None)
        }
    };
    // What is no time, or no rate, is refused with the keys that say it.
    let limit = Duration::try_from_secs_f64(terms.timeout).unwrap_or(Duration::MAX);
    // Whoever reads that a file does not load looks for it under the name that it has there.
    let name = match &source {
        Source::Python { path, .. } => {
            format!("{PYTHON}{}", path.file_name().unwrap_or_default().to_string_lossy())
        }
        Source::Command(_) => steering.word().to_owned(),
    };
    let steersman = Arc::new(Steersman::new(source, &name, terms.rate.recip(), limit));
    Ok(Arc::new(UserController { word: steering.word().to_owned(), given, code: steersman, file }))
}

/// The name of the copy of `file` in a campaign's folder: its own, if nothing else there can have that.
fn copy_of(file: &str) -> String {
    let name = Path::new(file).file_name().unwrap_or_default().to_string_lossy().into_owned();
    let plain = |stem: &str| !stem.is_empty() && stem.chars().all(|c| c.is_ascii_alphanumeric() || "_-".contains(c));
    let taken = [user_score::NAME, user_target::NAME].contains(&name.as_str());
    let fine = name.strip_suffix(".py").is_some_and(plain) && !taken;
    if fine { name } else { NAME.into() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_that_does_not_load_is_told_by_its_own_name() {
        let place = tempfile::tempdir().unwrap();
        let file = place.path().join("bom ü.py");
        std::fs::write(&file, "def control(t, s, r) return {}\n").unwrap();
        let set = ("execute.controller".to_owned(), format!("'python:{}'", file.display()));
        let setup = crate::scenario::setup_for("demo-quadrotor", &[set]).unwrap();
        let user = setup.user_controller().unwrap();
        assert_eq!(user.file.as_ref().unwrap().0, NAME, "the copy's name is plain");
        let told = user.code.try_out().unwrap_err();
        assert!(told.starts_with("python:bom ü.py: ") && told.contains("SyntaxError"), "{told}");
    }

    #[test]
    fn copies_keep_their_names_where_they_can() {
        for (file, copy) in [
            ("pd.py", "pd.py"),
            ("../control/my-pd_2.py", "my-pd_2.py"),
            ("score.py", NAME),
            ("a b.py", NAME),
            ("pd", NAME),
            (".py", NAME),
        ] {
            assert_eq!(copy_of(file), copy, "{file}");
        }
    }
}
