//! Tracks as CSV: a header, `t` first, then numbers with `.` decimals in the order of the Parquet files.

use std::path::Path;

use hairpin::trajectory::Track;

use crate::atomic::{self, WriteError};
use crate::channels::in_order;

/// The text of `track`: `t,x_m,y_m,z_m,qw,qx,qy,qz` and its channels; `t` in s. Numbers read back to the same bits.
pub fn text(track: &Track) -> String {
    let mut text = String::from("t,x_m,y_m,z_m,qw,qx,qy,qz");
    let channels = in_order(track);
    for channel in &channels {
        text.push(',');
        text.push_str(&field(&channel.name));
    }
    text.push('\n');
    for (row, (time, pose)) in track.times().iter().zip(track.poses()).enumerate() {
        let (p, q) = (pose.translation.vector, pose.rotation);
        let values = [*time, p.x, p.y, p.z, q.w, q.i, q.j, q.k];
        let values = values.into_iter().chain(channels.iter().map(|channel| channel.values[row]));
        text.push_str(&values.map(|value| value.to_string()).collect::<Vec<_>>().join(","));
        text.push('\n');
    }
    text
}

/// Writes [`text`].
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, track: &Track) -> Result<(), WriteError> {
    atomic::write(path, text(track).as_bytes())
}

/// Names of channels come from anywhere: quoted where the format asks for it.
fn field(name: &str) -> String {
    if name.contains([',', '"', '\n', '\r']) { format!("\"{}\"", name.replace('"', "\"\"")) } else { name.into() }
}
