//! Embeds every shipped file: `data/{robots,worlds,scenarios}/**/NAME.toml` and `experiments/NAME.toml` are found at
//! run time by NAME.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

fn main() {
    let root = Path::new(&std::env::var("CARGO_MANIFEST_DIR").expect("cargo sets it")).join("../..");
    let data = root.join("data");
    let mut table = String::from("&[\n");
    for (kind, within) in [("robots", &data), ("worlds", &data), ("scenarios", &data), ("experiments", &root)] {
        let folder = within.join(kind);
        println!("cargo::rerun-if-changed={}", folder.display());
        let mut files = Vec::new();
        collect(&folder, &mut files);
        files.sort();
        for file in files {
            println!("cargo::rerun-if-changed={}", file.display());
            let path = file.strip_prefix(within).expect("found below it");
            let name = path.file_stem().expect("a file has a name").to_string_lossy();
            writeln!(table, "    ({kind:?}, {name:?}, {:?}, include_str!({file:?})),", path.display().to_string())
                .expect("strings take everything");
        }
    }
    table.push_str("]\n");
    let out = Path::new(&std::env::var("OUT_DIR").expect("cargo sets it")).join("shipped.rs");
    std::fs::write(out, table).expect("OUT_DIR is writable");
}

fn collect(folder: &Path, files: &mut Vec<PathBuf>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for path in entries.flatten().map(|entry| entry.path()) {
        if path.is_dir() {
            collect(&path, files);
        } else if path.extension().is_some_and(|extension| extension == "toml") {
            files.push(path);
        }
    }
}
