//! Files that are one recording under several names. A simulator that is told the same does the same, so that they are
//! refused nowhere; but they are no repeats of one another, and whoever counts them is told.

use std::collections::BTreeMap;
use std::io::Read;
use std::path::{Path, PathBuf};

use hairpin_formats::bounds;
use hairpin_formats::logs::MOST_LOG_BYTES;

/// Names that are told of a recording, and recordings that are told by their names.
const NAMED: usize = 3;

/// The files of which others have every byte, in their order, each with these; what cannot be read is no one's.
pub(crate) fn copies<'a>(files: impl IntoIterator<Item = &'a PathBuf>) -> Vec<Vec<PathBuf>> {
    let mut sizes: BTreeMap<u64, Vec<&PathBuf>> = BTreeMap::new();
    for file in files {
        // Only what is as large may be the same, so that hardly any file is read once more.
        if let Ok(size) = bounds::open(file, MOST_LOG_BYTES).and_then(|open| Ok(open.metadata()?.len())) {
            sizes.entry(size).or_default().push(file);
        }
    }
    let mut same: BTreeMap<[u8; 32], Vec<PathBuf>> = BTreeMap::new();
    for file in sizes.into_values().filter(|files| files.len() > 1).flatten() {
        if let Ok(hash) = hash(file) {
            same.entry(hash).or_default().push(file.clone());
        }
    }
    let mut same: Vec<Vec<PathBuf>> = same.into_values().filter(|files| files.len() > 1).collect();
    same.sort();
    same
}

/// `one recording under several names, which are no repeats: a.ulg = b.ulg`; `None` of none.
pub(crate) fn told(copies: &[Vec<PathBuf>], name: impl Fn(&Path) -> String) -> Option<String> {
    let more = |all: usize| if all > NAMED { format!(" and {} more", all - NAMED) } else { String::new() };
    let one = |files: &Vec<PathBuf>| {
        let names: Vec<String> = files.iter().take(NAMED).map(|file| name(file)).collect();
        format!("{}{}", names.join(" = "), more(files.len()))
    };
    let told: Vec<String> = copies.iter().take(NAMED).map(one).collect();
    let words = || format!("one recording under several names, which are no repeats: {}", told.join(", "));
    (!copies.is_empty()).then(|| format!("{}{}", words(), more(copies.len())))
}

fn hash(file: &Path) -> std::io::Result<[u8; 32]> {
    let mut open = bounds::open(file, MOST_LOG_BYTES)?;
    let (mut hash, mut piece) = (blake3::Hasher::new(), vec![0; 1 << 16]);
    loop {
        match open.read(&mut piece)? {
            0 => return Ok(hash.finalize().into()),
            size => hash.update(&piece[..size]),
        };
    }
}

#[cfg(test)]
mod tests {
    use std::fs;

    use super::*;

    #[test]
    fn files_of_the_same_bytes_are_one_recording() {
        let place = tempfile::tempdir().unwrap();
        let all = [("b", "xy"), ("a", "xy"), ("c", "yx"), ("d", "z"), ("e", "xyz"), ("f", "z")];
        let files = all.map(|(name, text)| {
            fs::write(place.path().join(name), text).unwrap();
            place.path().join(name)
        });
        let name = |path: &Path| path.file_name().unwrap().to_string_lossy().into_owned();
        let same = copies(files.iter().chain([&place.path().join("none")]));
        let words = "one recording under several names, which are no repeats: b = a, d = f";
        assert_eq!(told(&same, name).as_deref(), Some(words));
        assert_eq!(told(&copies(&files[2..5]), name), None);
        let many: Vec<Vec<PathBuf>> = vec![vec![PathBuf::from("a"); 5]; 4];
        assert!(
            told(&many, name)
                .unwrap()
                .ends_with(": a = a = a and 2 more, a = a = a and 2 more, a = a = a and 2 more and 1 more")
        );
    }
}
