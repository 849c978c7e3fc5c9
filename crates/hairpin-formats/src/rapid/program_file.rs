//! Program files (`.pgf`): which modules are one program.

use roxmltree::Document;
use thiserror::Error;

use crate::listing::decode;

/// Modules at most.
const MOST_MODULES: usize = 1000;

/// Why a file is no program file.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum ProgramFileError {
    /// No XML.
    #[error("is no XML: {0}")]
    Xml(String),
    /// Its outermost element is another one.
    #[error("line {line}: is <{found}>: a program file is <Program> with a <Module> for each file")]
    Root {
        /// Its line, from 1.
        line: u32,
        /// The element.
        found: String,
    },
    /// It names no module, or too many.
    #[error("names {0} modules: must be 1 to {MOST_MODULES}")]
    Count(usize),
    /// A module that does not lie beside it.
    #[error("line {line}: `{name}`: must be a file in the folder of the program file, or in one below it")]
    Outside {
        /// Its line, from 1.
        line: u32,
        /// What it names.
        name: String,
    },
}

/// The modules' files that a program file names, as paths from its own folder, in its order and each once.
///
/// # Errors
/// [`ProgramFileError`].
pub fn modules_of(bytes: &[u8]) -> Result<Vec<String>, ProgramFileError> {
    let text = decode(bytes);
    let document = Document::parse(&text).map_err(|error| ProgramFileError::Xml(error.to_string()))?;
    let line = |at: usize| document.text_pos_at(at).row;
    let root = document.root_element();
    if !root.tag_name().name().eq_ignore_ascii_case("Program") {
        let found = root.tag_name().name().to_owned();
        return Err(ProgramFileError::Root { line: line(root.range().start), found });
    }
    let mut names: Vec<String> = Vec::new();
    for module in root.children().filter(|node| node.tag_name().name().eq_ignore_ascii_case("Module")) {
        let written = module.text().unwrap_or_default().trim();
        let name = below(written)
            .ok_or_else(|| ProgramFileError::Outside { line: line(module.range().start), name: written.into() })?;
        if !names.contains(&name) {
            names.push(name);
        }
    }
    if (1..=MOST_MODULES).contains(&names.len()) { Ok(names) } else { Err(ProgramFileError::Count(names.len())) }
}

/// The path with its folders joined by `/`, if it leads nowhere but down: either kind of slash, no drive, no `..`.
fn below(written: &str) -> Option<String> {
    let steps: Vec<&str> = written.split(['/', '\\']).filter(|step| *step != ".").collect();
    let good =
        |step: &&str| !step.is_empty() && *step != ".." && !step.contains(':') && !step.contains(char::is_control);
    steps.iter().all(good).then(|| steps.join("/")).filter(|path| !path.is_empty())
}

#[cfg(test)]
mod tests {
    use super::super::program_file;
    use super::*;

    #[test]
    fn what_is_written_names_its_module() {
        assert_eq!(modules_of(program_file("0003.mod").as_bytes()), Ok(vec!["0003.mod".into()]));
        assert_eq!(modules_of(program_file("a & <b>.mod").as_bytes()), Ok(vec!["a & <b>.mod".into()]));
    }

    #[test]
    fn only_what_lies_beside_it_or_below_is_named() {
        let named = |name: &str| {
            modules_of(format!("<?xml version=\"1.0\"?>\n<Program>\n<Module>{name}</Module>\n</Program>").as_bytes())
        };
        assert_eq!(named(" cell.mod\t"), Ok(vec!["cell.mod".into()]));
        assert_eq!(named("./sub\\cell.mod"), Ok(vec!["sub/cell.mod".into()]));
        for name in ["../cell.mod", "/etc/passwd", "a/../../b.mod", "C:\\cell.mod", "\\\\host\\cell.mod", "..", "."] {
            let outside = ProgramFileError::Outside { line: 3, name: name.into() };
            assert_eq!(named(name), Err(outside), "{name}");
        }
        assert_eq!(modules_of(b"<Program/>"), Err(ProgramFileError::Count(0)));
        assert_eq!(modules_of(b"\n<robot/>"), Err(ProgramFileError::Root { line: 2, found: "robot".into() }));
        assert!(matches!(modules_of(b"MODULE M"), Err(ProgramFileError::Xml(_))));
    }
}
