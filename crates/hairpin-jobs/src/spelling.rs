//! Names that programs carry, looked at before anything is searched: a controller's language refuses them only where
//! programs are written, and what was searched and executed by then would be lost.

use hairpin::campaign::Setup;
use hairpin_formats::rapid::{self, RapidError};

use crate::Problem;

/// Keys whose values are names in programs, by what they name there.
const KEYS: [(&str, &str); 3] =
    [("procedure", "generate.moves.procedure"), ("tool", "world.tool.name"), ("work object", "world.wobj.name")];

/// Whether programs of `setup` can have the names that its scenario gives.
///
/// # Errors
/// The first that a controller would not take, by its key.
pub(crate) fn check_names(setup: &Setup) -> Result<(), Problem> {
    let Some(program) = setup.naming_all() else { return Ok(()) };
    rapid::check_names(&program).map_err(|error| {
        let of = |wanted: &str| KEYS.iter().find(|(what, _)| *what == wanted).map(|(_, key)| format!("`{key}`"));
        let key = match &error {
            RapidError::Name { what, .. } => of(what),
            RapidError::Program(_)
            | RapidError::Point { .. }
            | RapidError::Twice { .. }
            | RapidError::Endless { .. } => None,
        };
        let all = || KEYS.map(|(_, key)| format!("`{key}`")).join(", ");
        Problem::input(format!("{}: {error}", key.unwrap_or_else(all)))
    })
}

#[cfg(test)]
mod tests {
    use std::path::Path;

    use hairpin_formats::scenario::read_setup;

    use super::*;

    const CELL: &str = "hairpin = 1\nrobot = \"irb120\"\n[world]\ntool = { name = \"tGrip\", declare = true }\n\
        [task]\npoints = [[300, 0, 400], [300, 100, 400]]\n";

    fn told(key: &str, value: &str) -> Result<(), String> {
        let setup = read_setup(CELL, "cell.toml", Path::new(""), &[(key.to_owned(), value.to_owned())]).unwrap();
        check_names(&setup).map_err(|problem| problem.to_string())
    }

    #[test]
    fn names_that_no_controller_takes_are_refused_by_their_keys() {
        assert_eq!(told("seed", "1"), Ok(()));
        let long = "w".repeat(43);
        let [procedure, tool, object] = ["generate.moves.procedure", "world.tool.name", "world.wobj.name"];
        for (key, value) in [
            (procedure, "PROC"),
            (procedure, "a-b"),
            (tool, "MoveL"),
            (tool, "\"\""),
            (object, "PROC"),
            (object, &long),
        ] {
            let error = told(key, value).unwrap_err();
            assert!(error.starts_with(&format!("`{key}`: ")), "{key}: {error}");
        }
        for (key, value) in [(procedure, "tGrip"), (object, "tGrip"), (object, "p01"), (tool, "pHome")] {
            let error = told(key, value).unwrap_err();
            assert!(error.contains("names two different things"), "{key} = {value}: {error}");
        }
    }
}
