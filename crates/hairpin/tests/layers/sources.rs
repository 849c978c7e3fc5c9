//! The source files, found on disk.

use std::path::{Path, PathBuf};

/// A source file with the name of its module, such as `hairpin::world::sample`.
pub(crate) struct Source {
    pub(crate) module: String,
    /// Path below the project.
    pub(crate) path: String,
    pub(crate) text: String,
}

/// Where the project lies.
pub(crate) fn project() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Every source of the crates, without their tests beside `src`.
pub(crate) fn of_crates() -> Vec<Source> {
    let mut found = Vec::new();
    for member in members() {
        walk(&format!("crates/{member}/src"), &member.replace('-', "_"), &mut found);
    }
    assert!(found.len() > 30, "only {} source files found below {:?}", found.len(), project());
    found
}

/// Everything written in Rust: sources, tests, benches and examples.
pub(crate) fn everything() -> Vec<Source> {
    let mut found = Vec::new();
    for member in members() {
        walk(&format!("crates/{member}"), &member, &mut found);
    }
    walk("examples", "examples", &mut found);
    found
}

/// Folders of the crates, in order.
pub(crate) fn members() -> Vec<String> {
    entries("crates")
        .into_iter()
        .filter(|name| project().join("crates").join(name).join("Cargo.toml").exists())
        .collect()
}

fn entries(folder: &str) -> Vec<String> {
    let read = std::fs::read_dir(project().join(folder)).into_iter().flatten();
    let mut names: Vec<String> =
        read.map(|entry| entry.expect("an entry").file_name().to_string_lossy().into_owned()).collect();
    names.sort();
    names
}

fn walk(folder: &str, module: &str, found: &mut Vec<Source>) {
    for name in entries(folder) {
        let path = format!("{folder}/{name}");
        let at = project().join(&path);
        if at.is_dir() {
            walk(&path, &format!("{module}::{name}"), found);
        } else if let Some(stem) = name.strip_suffix(".rs") {
            let module = match stem {
                // A binary beside a library is a crate of its own.
                "main" if at.with_file_name("lib.rs").exists() => format!("{module}_binary"),
                "mod" | "lib" | "main" => module.to_owned(),
                _ => format!("{module}::{stem}"),
            };
            found.push(Source { module, path, text: std::fs::read_to_string(&at).expect("a source file") });
        }
    }
}
