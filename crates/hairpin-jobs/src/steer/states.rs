//! A drive's states as files: the path, and what the wheels do.

use std::path::Path;

use hairpin_formats::atomic;
use hairpin_formats::folder::refuse_own;
use hairpin_formats::steering::{Asked, path_table, wheel_table};

use super::{Answered, Rows, Vehicle};
use crate::{Problem, Watch};

impl Vehicle {
    /// Writes the path of states and what the wheels do, a row a time step; a question without a drive writes neither.
    ///
    /// # Errors
    /// A vehicle without wheels; a file that cannot be written.
    pub fn write_states(
        &self,
        asked: &Asked,
        answered: &Answered,
        [path, wheels]: [Option<&Path>; 2],
        watch: &dyn Watch,
    ) -> Result<(), Problem> {
        let names = self.rover.wheel_names();
        if wheels.is_some() && names.is_empty() {
            return Err(Problem::input(format!("--wheels: `{}` has no wheels (suspension)", self.rover.name)));
        }
        path.into_iter().chain(wheels).try_for_each(refuse_own)?;
        if path.is_none() && wheels.is_none() {
            return Ok(());
        }
        let Some(states) = self.follow(asked, answered, Rows::AsAsked) else {
            watch.warn("without a drive there is nothing to write to --path and --wheels");
            return Ok(());
        };
        if let Some(path) = path {
            atomic::write(path, &path_table(&states, asked.frame).map_err(Problem::input)?)?;
        }
        if let Some(path) = wheels {
            atomic::write(path, &wheel_table(&states, names, asked.frame).map_err(Problem::input)?)?;
        }
        Ok(())
    }
}
