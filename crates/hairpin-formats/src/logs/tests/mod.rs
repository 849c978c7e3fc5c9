//! Logs of each format, as their writers write them, and spoiled.

mod text;

use super::*;

/// The log of `bytes` in a file `name`.
fn read_bytes(bytes: &[u8], name: &str) -> Result<Logged, LogError> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join(name);
    std::fs::write(&path, bytes).unwrap();
    read(&path)
}

/// What a refusal says, behind the file's name.
fn refusal(bytes: &[u8], name: &str) -> String {
    let told = read_bytes(bytes, name).expect_err(name).to_string();
    told.split_once(name).map_or(told.clone(), |(_, told)| told.to_owned())
}
