//! Tracks in the format of the TUM RGB-D benchmark: `t x y z qx qy qz qw`, one space between, one pose a line.

use std::path::{Path, PathBuf};

use hairpin::trajectory::Track;

use crate::atomic::{self, WriteError};

/// The text of `track`, times in s strictly rising, positions in m, quaternion w last. Numbers read back to the same
/// bits, so stamps that rise strictly still do.
pub fn text(track: &Track) -> String {
    let mut text = String::new();
    for (time, pose) in track.times().iter().zip(track.poses()) {
        let (p, q) = (pose.translation.vector, pose.rotation);
        text.push_str(&format!("{time} {} {} {} {} {} {} {}\n", p.x, p.y, p.z, q.i, q.j, q.k, q.w));
    }
    text
}

/// Writes `CASE.ref.tum` and `CASE.exec.tum` into `folder`: [`hairpin::trajectory::Track`]s on the same stamps, so that
/// a comparison pairs them without tolerance and aligns nothing. Returns their paths.
///
/// # Errors
/// A file cannot be written.
///
/// # Panics
/// If the stamps differ: a mistake of the caller's.
pub fn write_pair(folder: &Path, case: &str, reference: &Track, executed: &Track) -> Result<[PathBuf; 2], WriteError> {
    assert_eq!(reference.times(), executed.times(), "reference and execution stand on the same stamps");
    let paths = ["ref", "exec"].map(|which| folder.join(format!("{case}.{which}.tum")));
    atomic::write(&paths[0], text(reference).as_bytes())?;
    atomic::write(&paths[1], text(executed).as_bytes())?;
    Ok(paths)
}
