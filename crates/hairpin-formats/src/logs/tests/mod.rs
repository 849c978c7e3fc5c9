//! Logs of each format, as their writers write them, and spoiled.

mod bag;
mod dataflash;
mod text;
mod ulog;
mod write_bag;
mod write_dataflash;
mod write_ulog;

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

/// The logs that tests/python has the formats' own readers read; `HAIRPIN_FIXTURES=1` writes them.
#[test]
fn fixtures_are_what_is_written_here() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures/logs");
    for (name, bytes) in [
        ("flight.ulg", write_ulog::flight()),
        ("flight.bin", write_dataflash::flight()),
        ("drive.mcap", write_bag::drive(true, None)),
    ] {
        let path = folder.join(name);
        if std::env::var_os("HAIRPIN_FIXTURES").is_some() {
            std::fs::create_dir_all(&folder).unwrap();
            std::fs::write(&path, &bytes).unwrap();
        }
        assert!(std::fs::read(&path).unwrap() == bytes, "{name} is another than its writer's");
        assert!(read(&path).is_ok());
    }
}
