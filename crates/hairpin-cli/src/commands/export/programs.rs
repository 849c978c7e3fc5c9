//! Programs of arms in the languages of their controllers.

use std::path::PathBuf;

use hairpin::campaign::Case;
use hairpin::trajectory::program::{Program, Speed};
use hairpin_formats::{atomic, krl, rapid, urscript};

use super::Written;
use crate::args::Format;
use crate::folder::Work;
use crate::problem::Problem;

/// Writes the program of every case; a case without one, or one that the language cannot hold, is told as missing.
pub(super) fn write(work: &Work, cases: &[Case], format: Format) -> Result<Written, Problem> {
    let mut written = Written::default();
    for case in cases {
        let mut case = case.clone();
        work.folder.read_witness(&mut case)?;
        let Some(program) = &case.program else {
            written.missing.push(format!("case {} has no program: it is no arm's", case.id()));
            continue;
        };
        match texts(&case, program, format) {
            Ok(texts) => {
                for (name, text) in texts {
                    let path: PathBuf = work.folder.file(&name);
                    atomic::write(&path, text.as_bytes())?;
                    written.files.push(path);
                }
            }
            Err(why) => written.missing.push(format!("case {}: {why}", case.id())),
        }
    }
    match written.missing.first() {
        Some(why) if written.files.is_empty() => Err(Problem::input(why)),
        _ => Ok(written),
    }
}

/// Names and texts of a program's files.
fn texts(case: &Case, program: &Program, format: Format) -> Result<Vec<(String, String)>, String> {
    let id = case.id();
    let header = [format!("Evidence: {}", case.claim())];
    Ok(match format {
        Format::Urscript => {
            let text = urscript::text(program, &urscript::Settings::default(), &header);
            vec![(format!("{id}.script"), text.map_err(|error| error.to_string())?)]
        }
        Format::Krl => {
            let files = krl::files(program, &krl::Settings::default(), &header).map_err(|error| error.to_string())?;
            vec![(format!("{id}.src"), files.src), (format!("{id}.dat"), files.dat)]
        }
        _ => {
            let module = rapid::module(program, &header).map_err(|error| error.to_string())?;
            let cap = Speed::predefined(rapid::FIRST_RUN).ok_or("no speed for the first run")?;
            let slow = rapid::module(&rapid::slow(program, &cap), &header).map_err(|error| error.to_string())?;
            vec![
                (format!("{id}.mod"), module),
                (format!("{id}_slow.mod"), slow),
                (format!("{id}.pgf"), rapid::program_file(&format!("{id}.mod"))),
            ]
        }
    })
}
