//! A file is the old one or the new one: after a kill, on a full disk, in a folder that takes no files.

use std::fs;
use std::io::{self, Write};
use std::path::Path;
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};

use hairpin_formats::atomic::{is_temporary, remove_leftovers, write, write_with};

fn temporaries(folder: &Path) -> usize {
    let names = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().to_string_lossy().into_owned());
    names.filter(|name| is_temporary(name)).count()
}

#[test]
fn a_failing_write_leaves_the_old_file_and_no_temporary() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("results");
    write(&path, b"old").unwrap();
    let error = write_with(&path, |file| {
        file.write_all(&[b'n'; 100_000])?;
        Err(io::Error::from(io::ErrorKind::StorageFull))
    })
    .unwrap_err();
    assert_eq!((error.path.as_path(), error.cause.kind()), (path.as_path(), io::ErrorKind::StorageFull));
    assert_eq!(fs::read(&path).unwrap(), b"old");
    assert_eq!(temporaries(place.path()), 0);
}

#[test]
fn a_folder_that_takes_no_files_is_an_error_with_its_path() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("file");
    write(&file, b"x").unwrap();
    for path in [file.join("below"), place.path().join("none/below")] {
        let error = write(&path, b"y").unwrap_err();
        assert_eq!(error.path, path);
        assert!(error.to_string().starts_with(&format!("cannot write {}: ", path.display())), "{error}");
    }
    fs::create_dir(place.path().join("folder")).unwrap();
    assert!(write(&place.path().join("folder"), b"y").is_err(), "a folder stands in the way");
    assert_eq!(temporaries(place.path()), 0);
}

/// The writer that [`a_killed_writer_leaves_the_old_file_or_the_new_one`] starts and kills; nothing on its own.
#[test]
#[ignore = "started by the test that kills it"]
fn writer_to_be_killed() {
    let Some(path) = std::env::var_os("HAIRPIN_TEST_WRITE_TO") else { return };
    let mut stdout = io::stdout();
    for round in 0_u64.. {
        // Never the z that stood there before.
        let byte = b'a' + (round % 25) as u8;
        write(Path::new(&path), &vec![byte; 300_000]).unwrap();
        let _ = stdout.write_all(b".");
    }
}

#[test]
fn a_killed_writer_leaves_the_old_file_or_the_new_one() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("file");
    write(&path, &[b'z'; 300_000]).unwrap();
    for round in 0..12 {
        let written = || fs::metadata(&path).unwrap().modified().unwrap();
        let before = written();
        let mut writer = Command::new(std::env::current_exe().unwrap())
            .args(["--ignored", "--exact", "writer_to_be_killed", "--nocapture"])
            .env("HAIRPIN_TEST_WRITE_TO", &path)
            .stdout(Stdio::null())
            .spawn()
            .unwrap();
        // Amid its writing, however long a busy machine takes to start it.
        let patience = Instant::now() + Duration::from_secs(60);
        while written() == before && Instant::now() < patience {
            std::thread::sleep(Duration::from_millis(1));
        }
        std::thread::sleep(Duration::from_millis(7 * round));
        writer.kill().unwrap();
        writer.wait().unwrap();
        let bytes = fs::read(&path).unwrap();
        assert_eq!(bytes.len(), 300_000, "round {round}");
        assert!(bytes.iter().all(|byte| *byte == bytes[0]), "round {round}: a mixture");
    }
    assert_ne!(fs::read(&path).unwrap()[0], b'z', "no writer ever got to write");
    remove_leftovers(place.path());
    assert_eq!(temporaries(place.path()), 0);
}

/// A real file system of 64 KiB, where this user may mount one; elsewhere the injected error above stands alone.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_is_told_and_loses_nothing() {
    let place = tempfile::tempdir().unwrap();
    let mount = |args: &[&str]| {
        Command::new("mount").args(args).arg(place.path()).stderr(Stdio::null()).status().is_ok_and(|s| s.success())
    };
    if !mount(&["-t", "tmpfs", "-o", "size=64k", "tmpfs"]) {
        return;
    }
    let path = place.path().join("file");
    let old = write(&path, b"old");
    let new = write(&path, &[b'n'; 1_000_000]);
    let (bytes, left) = (fs::read(&path), temporaries(place.path()));
    let unmounted = Command::new("umount").arg(place.path()).status().unwrap();
    assert!(unmounted.success());
    old.unwrap();
    assert_eq!(new.unwrap_err().cause.kind(), io::ErrorKind::StorageFull);
    assert_eq!((bytes.unwrap().as_slice(), left), (b"old".as_slice(), 0));
}
