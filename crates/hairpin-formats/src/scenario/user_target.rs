//! Targets of the user's own: the Python file that `generate.search.target = "python:FILE"` names.
//!
//! The file defines `target(run)`; `run` is a dictionary. It must be a function of the run alone, and more is worse.

use std::path::PathBuf;
use std::sync::Arc;

use hairpin::campaign::scenario::{PYTHON, TARGET_KEY, Target};
use hairpin::campaign::user_target::{NAME, RunFacts};
use hairpin::campaign::{Attached, RunMeter};

use super::attached::{Wrong, attached};
use super::python::Python;
use super::whole::read_file;

/// Reads the target of the user's own, if `target` is one. A resolved scenario's is [`NAME`]. One that stands `alone`
/// finds no other Python files beside it.
pub(super) fn read(
    target: &mut Target,
    find: &dyn Fn(&str) -> PathBuf,
    alone: bool,
) -> Result<Option<Attached<dyn RunMeter>>, Wrong> {
    let Target::Python(file) = target else { return Ok(None) };
    let (path, given) = (find(file), format!("{PYTHON}{file}"));
    let wrong = |bound: String| Wrong { key: TARGET_KEY.into(), value: given.clone(), bound, at: None };
    let bytes = read_file(&path).map_err(|why| wrong(format!("`{file}` cannot be read: {why}")))?;
    let user = Arc::new(Python::new((path, alone), &given, "target")) as Arc<dyn RunMeter>;
    *file = NAME.into();
    Ok(Some(attached(user, bytes, NAME, &given)))
}

impl RunMeter for Python {
    fn measure(&self, run: &RunFacts) -> f64 {
        let answer = self.ask::<Option<f64>>(&[run], 1).and_then(|answer| answer.into_iter().next());
        answer.flatten().unwrap_or(f64::NAN)
    }
}
