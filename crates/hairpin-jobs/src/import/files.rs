//! Which files are one program, and in which language.

use std::path::{Path, PathBuf};

use hairpin_formats::bounds::{self, MOST_TEXT_BYTES};
use hairpin_formats::listing::{File, Module};
use hairpin_formats::rapid::{self, Frames, NoModule, Options};
use hairpin_formats::{krl, urscript};

use crate::Problem;

/// What `import` reads, for whoever brings something else.
pub(super) const READS: &str = "import reads RAPID modules (.mod, .sys, .prg) and program files (.pgf), KRL (.src with \
    its .dat), URScript (.script), logs that arc_clock.mod wrote, logs of robots that moved (PX4 ULog, ArduPilot \
    DataFlash, ROS 2 MCAP, TUM, CSV) and missions (.plan, QGC WPL 110, tables of waypoints)";

/// Files that are one program, at most.
const MOST_FILES: usize = 1000;

/// What a file holds.
pub(super) fn load(file: &Path) -> Result<Vec<u8>, Problem> {
    bounds::read(file, MOST_TEXT_BYTES).map_err(|error| Problem::of_file(file, error))
}

/// A file and the name under which it is told.
struct Loaded {
    path: PathBuf,
    name: String,
    bytes: Vec<u8>,
}

impl Loaded {
    fn of(path: &Path, name: String) -> Result<Self, Problem> {
        Ok(Self { path: path.into(), name, bytes: load(path)? })
    }

    fn file(&self) -> File<'_> {
        File { name: &self.name, bytes: &self.bytes }
    }
}

fn ending(path: &Path) -> String {
    path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase()
}

/// Reads the files as one program, which finds `frames` on its controller.
pub(super) fn read(files: &[PathBuf], procedure: Option<&str>, frames: &Frames) -> Result<Module, Problem> {
    if files.len() > MOST_FILES {
        return Err(Problem::input(format!("{} files: must be {MOST_FILES} at most", files.len())));
    }
    let endings: Vec<String> = files.iter().map(|file| ending(file)).collect();
    let foreign = endings.iter().position(|ending| is_foreign(ending));
    match foreign {
        Some(index) => {
            let module = of_another(files, &files[index], &endings[index])?;
            let name = &module.program.procedure;
            match procedure {
                Some(asked) if !asked.eq_ignore_ascii_case(name) => Err(Problem::of_file(
                    &files[index],
                    NoModule::Procedure { asked: asked.into(), there: vec![name.clone()] },
                )),
                _ => Ok(module),
            }
        }
        None => of_rapid(files, procedure, frames),
    }
}

/// KRL with its positions, or URScript.
fn of_another(files: &[PathBuf], first: &Path, language: &str) -> Result<Module, Problem> {
    if language == "script" {
        let [file] = files else { return Err(Problem::of_file(first, "a program in URScript is one file")) };
        let loaded = Loaded::of(file, name_of(file))?;
        return urscript::read(loaded.file()).map_err(|error| Problem::of_file(file, error));
    }
    let of = |wanted: &str| files.iter().filter(|file| ending(file) == wanted).collect::<Vec<_>>();
    let (src, dat) = match (&of("src")[..], &of("dat")[..]) {
        ([src], []) if files.len() == 1 => (*src, beside(src)),
        ([src], [dat]) if files.len() == 2 => (*src, Some(dat.to_path_buf())),
        ([], _) => {
            return Err(Problem::of_file(first, "holds positions alone: give the .src, this is found beside it"));
        }
        _ => return Err(Problem::of_file(first, "a program in KRL is one .src and its .dat")),
    };
    let positions = dat.as_deref().map(|dat| Loaded::of(dat, name_of(dat))).transpose()?;
    let loaded = Loaded::of(src, name_of(src))?;
    krl::read(loaded.file(), positions.as_ref().map(Loaded::file)).map_err(|error| Problem::of_file(src, error))
}

/// The `.dat` of a `.src`, whichever way its ending is spelt.
fn beside(src: &Path) -> Option<PathBuf> {
    ["dat", "DAT", "Dat"].iter().map(|ending| src.with_extension(ending)).find(|dat| dat.is_file())
}

fn name_of(file: &Path) -> String {
    file.file_name().unwrap_or_default().to_string_lossy().into_owned()
}

/// Modules and program files.
fn of_rapid(files: &[PathBuf], procedure: Option<&str>, frames: &Frames) -> Result<Module, Problem> {
    let mut loaded: Vec<Loaded> = Vec::new();
    let mut seen: Vec<PathBuf> = Vec::new();
    for file in files {
        let parts = if ending(file) == "pgf" { named_by(file)? } else { vec![Loaded::of(file, told(file, files))?] };
        for part in parts {
            // A module that is named twice is one module all the same.
            let real = std::fs::canonicalize(&part.path).unwrap_or_else(|_| part.path.clone());
            if !seen.contains(&real) {
                seen.push(real);
                loaded.push(part);
            }
        }
    }
    let all: Vec<File<'_>> = loaded.iter().map(Loaded::file).collect();
    let options = Options { procedure, ..frames.options() };
    rapid::read_all(&all, &options).map_err(|(index, error)| {
        let path = loaded.get(index).map_or(Path::new(""), |file| file.path.as_path());
        match (&error, is_rapid_by_name(path)) {
            (NoModule::Absent, false) => Problem::of_file(path, format!("{error}; {READS}")),
            _ => Problem::of_file(path, error),
        }
    })
}

/// The file's name; its path where another one has the same name.
fn told(file: &Path, files: &[PathBuf]) -> String {
    let same = files.iter().filter(|other| other.file_name() == file.file_name()).count();
    if same > 1 { file.display().to_string() } else { name_of(file) }
}

/// Whether a file is called as programs are.
pub(super) fn is_program_by_name(file: &Path) -> bool {
    is_rapid_by_name(file) || ["pgf", "src", "dat", "script"].contains(&ending(file).as_str())
}

/// Whether the language's poses are in the arm's base: of others they are in frames of the world.
pub(super) fn is_in_base(files: &[PathBuf]) -> bool {
    files.iter().any(|file| ending(file) == "script")
}

/// Whether files are RAPID's, whose joint targets have axis 3 as the controller tells it.
pub(super) fn are_rapid(files: &[PathBuf]) -> bool {
    !files.iter().any(|file| is_foreign(&ending(file)))
}

/// Whether files that end so are of another language than RAPID.
fn is_foreign(ending: &str) -> bool {
    ["src", "dat", "script"].contains(&ending)
}

/// Whether a file is called as RAPID's are.
fn is_rapid_by_name(file: &Path) -> bool {
    ["mod", "sys", "prg"].contains(&ending(file).as_str())
}

/// The modules that a program file names: all of them lie in its folder or below.
fn named_by(file: &Path) -> Result<Vec<Loaded>, Problem> {
    let names = rapid::modules_of(&load(file)?).map_err(|error| Problem::of_file(file, error))?;
    let folder = file.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let real = std::fs::canonicalize(folder).map_err(|error| Problem::of_file(folder, error))?;
    let one = |name: String| {
        let path = folder.join(&name);
        let refuse = |why: String| Problem::of_file(file, format!("module `{}` {why}", name.escape_default()));
        let there = std::fs::canonicalize(&path).map_err(|error| refuse(format!("cannot be read: {error}")))?;
        if !there.starts_with(&real) {
            return Err(refuse("is a link that leads out of the folder".into()));
        }
        let bytes = bounds::read(&path, MOST_TEXT_BYTES).map_err(|error| refuse(format!("cannot be read: {error}")))?;
        Ok(Loaded { path, name, bytes })
    };
    names.into_iter().map(one).collect()
}
