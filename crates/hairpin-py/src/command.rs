//! The command `hairpin`, as the package carries it.

use std::ffi::OsString;
use std::io::Write;

use pyo3::prelude::*;

/// Runs the command line in `arguments`, whose first is the program's name, and gives its exit code.
#[pyfunction]
pub(crate) fn run(py: Python<'_>, arguments: Vec<OsString>) -> u8 {
    py.detach(|| {
        let code = hairpin_cli::run(arguments);
        // Nobody else writes what stands behind the last end of a line; it fails only where nobody reads on.
        let _ = std::io::stdout().flush();
        code
    })
}
