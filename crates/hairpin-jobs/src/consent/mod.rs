//! What a stranger's folder may run. What is typed runs; what a scenario file that the user names asks to run is told
//! first; but a campaign's folder or a repro file is data, and a command or a Python file that stands in it runs only
//! where the user allows it on that call, or has run it in this folder himself: then he has left a mark.

mod marks;
mod wish;

use std::path::{Path, PathBuf};

use hairpin::campaign::CallersCode;

use crate::sets::Set;
use crate::{Problem, Watch};
use marks::Marks;
pub(crate) use wish::Wish;

/// What the user allows, and where his marks are.
#[derive(Debug, Clone, Default)]
pub struct Consent {
    /// Whatever a folder asks to run on this call (`--allow-commands`).
    pub allow_commands: bool,
    /// The folder of his marks; without one nothing is remembered.
    pub state: Option<PathBuf>,
    /// Code in his own process, which answers in place of files.
    pub code: CallersCode,
}

impl Consent {
    /// That of the user whose environment has these variables: his state lies in `$XDG_STATE_HOME/hairpin`, or else in
    /// `$HOME/.local/state/hairpin`.
    pub fn of_user(allow_commands: bool, variable: impl Fn(&str) -> Option<std::ffi::OsString>) -> Self {
        // The specification of base directories has relative ones ignored.
        let place = |name: &str| variable(name).map(PathBuf::from).filter(|path| path.is_absolute());
        let state = place("XDG_STATE_HOME").or_else(|| Some(place("HOME")?.join(".local/state")));
        Self { allow_commands, state: state.map(|state| state.join("hairpin")), ..Self::default() }
    }

    /// Asks whether what `folder` wishes may run.
    ///
    /// # Errors
    /// The first wish that the user has neither allowed nor marked.
    pub(crate) fn ask(&self, folder: &Path, wishes: &[Wish]) -> Result<(), Problem> {
        if self.allow_commands || wishes.is_empty() {
            return Ok(());
        }
        let marks = self.state.as_deref().and_then(Marks::there);
        let marked = |wish: &&Wish| marks.as_ref().is_some_and(|marks| marks.has(folder, wish));
        let Some(wish) = wishes.iter().find(|wish| !marked(wish)) else { return Ok(()) };
        Err(Problem::input(format!(
            "{} asks to {wish}, and this user has not run that there before, or it has changed since. A folder or file that you \
             were given is data: look at it first; --allow-commands on this call lets it run",
            folder.display()
        )))
    }

    /// As [`Self::ask`], of what a scenario asks for that `sets` change: what is typed runs; what a file of the user's
    /// says is told first; what the folder of a campaign says, `kept`, is asked for.
    pub(crate) fn ask_of_scenario(
        &self,
        (name, kept): (&str, Option<&Path>),
        wishes: &[Wish],
        sets: &[Set],
        watch: &dyn Watch,
    ) -> Result<(), Problem> {
        let written: Vec<Wish> = wishes.iter().filter(|wish| !wish.is_typed(sets)).cloned().collect();
        match kept {
            Some(folder) => self.ask(folder, &written),
            None => {
                let runs = written.iter().filter(|wish| wish.runs());
                runs.for_each(|wish| watch.warn(&format!("{name} asks to {wish}")));
                Ok(())
            }
        }
    }

    /// Remembers that the user has these wishes of `folder` fulfilled. Where nothing can be remembered, the next call
    /// asks.
    pub(crate) fn mark(&self, folder: &Path, wishes: &[Wish]) {
        let Some(state) = self.state.as_deref().filter(|_| !wishes.is_empty()) else { return };
        let marked = Marks::make(state).and_then(|marks| wishes.iter().try_for_each(|wish| marks.put(folder, wish)));
        if let Err(cause) = marked {
            tracing::info!("nothing is remembered in {}: {cause}; later calls need --allow-commands", state.display());
        }
    }

    /// Whether this user's mark is on everything that `folder` wishes.
    pub(crate) fn has_marked(&self, folder: &Path, wishes: &[Wish]) -> bool {
        Self { allow_commands: false, ..self.clone() }.ask(folder, wishes).is_ok()
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    fn wish(command: &str) -> Vec<Wish> {
        vec![Wish::command(command)]
    }

    #[test]
    fn a_mark_is_of_one_user_one_folder_and_one_command() {
        let place = tempfile::tempdir().unwrap();
        let (ours, theirs) = (place.path().join("ours"), place.path().join("theirs"));
        [&ours, &theirs].into_iter().for_each(|folder| fs::create_dir(folder).unwrap());
        let user = |name: &str| Consent { state: Some(place.path().join(name)), ..Consent::default() };
        let me = user("me");
        let refused = me.ask(&ours, &wish("touch x")).unwrap_err().to_string();
        assert!(refused.contains("`touch x`") && refused.contains("--allow-commands"), "{refused}");
        assert!(!place.path().join("me").exists(), "asking leaves nothing");
        me.mark(&ours, &wish("touch x"));
        me.ask(&ours, &wish("touch x")).unwrap();
        me.ask(&ours.join("../ours"), &wish("touch x")).unwrap();
        for (who, folder, command) in
            [(&me, &ours, "touch y"), (&me, &theirs, "touch x"), (&user("you"), &ours, "touch x")]
        {
            assert!(who.ask(folder, &wish(command)).is_err(), "{command}");
        }
        Consent { allow_commands: true, ..Consent::default() }.ask(&theirs, &wish("touch x")).unwrap();
        // Moved elsewhere, it is another folder.
        fs::rename(&ours, place.path().join("moved")).unwrap();
        assert!(me.ask(&place.path().join("moved"), &wish("touch x")).is_err());
    }

    #[test]
    #[cfg(unix)]
    fn the_key_is_the_users_alone() {
        use std::os::unix::fs::PermissionsExt;
        let place = tempfile::tempdir().unwrap();
        let me = Consent { state: Some(place.path().join("state")), ..Consent::default() };
        me.mark(place.path(), &wish("touch x"));
        let key = place.path().join("state/key");
        assert_eq!(
            (fs::metadata(&key).unwrap().permissions().mode() & 0o777, fs::read(&key).unwrap().len()),
            (0o600, 32)
        );
        me.ask(place.path(), &wish("touch x")).unwrap();
        // A key that others can read makes no marks.
        fs::set_permissions(&key, fs::Permissions::from_mode(0o644)).unwrap();
        assert!(me.ask(place.path(), &wish("touch x")).is_err());
        fs::set_permissions(&key, fs::Permissions::from_mode(0o600)).unwrap();
        fs::write(&key, [0; 32]).unwrap();
        assert!(me.ask(place.path(), &wish("touch x")).is_err(), "another key's marks are none");
    }

    #[test]
    fn a_state_that_cannot_be_written_is_none() {
        let place = tempfile::tempdir().unwrap();
        fs::write(place.path().join("file"), "").unwrap();
        let me = Consent { state: Some(place.path().join("file/state")), ..Consent::default() };
        me.mark(place.path(), &wish("touch x"));
        assert!(me.ask(place.path(), &wish("touch x")).is_err());
        let of = |pairs: &'static [(&str, &str)]| {
            Consent::of_user(false, move |name| {
                pairs.iter().find(|(key, _)| *key == name).map(|(_, value)| value.into())
            })
            .state
        };
        assert_eq!(of(&[("XDG_STATE_HOME", "/s"), ("HOME", "/h")]), Some("/s/hairpin".into()));
        assert_eq!(of(&[("XDG_STATE_HOME", "s"), ("HOME", "/h")]), Some("/h/.local/state/hairpin".into()));
        assert_eq!(of(&[("HOME", "")]), None);
    }

    #[test]
    fn files_of_the_folder_that_a_command_names_count() {
        let place = tempfile::tempdir().unwrap();
        let me = Consent { state: Some(place.path().join("state")), ..Consent::default() };
        let folder = place.path().join("out");
        fs::create_dir(&folder).unwrap();
        let program = folder.join("fly.py");
        let asked = wish(&format!("python3 '{}'", program.display()));
        fs::write(&program, "1").unwrap();
        me.mark(&folder, &asked);
        me.ask(&folder, &asked).unwrap();
        fs::write(&program, "2").unwrap();
        assert!(me.ask(&folder, &asked).is_err());
    }
}
