//! What a file holds, by its name and its first bytes.

use std::io::Read;
use std::path::Path;

use hairpin_formats::bounds;
use hairpin_formats::logs::{self, MOST_LOG_BYTES};
use hairpin_formats::rapid;

use super::files::{READS, is_program_by_name};
use crate::Problem;

/// By so many of the first bytes kinds are told apart.
const FIRST_BYTES: u64 = 65_536;

/// Kinds of files that come from elsewhere.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Program,
    ArcClock,
    Log,
    Mission,
    /// What hairpin wrote itself, and what reads it.
    Own(&'static str),
}

impl Kind {
    /// The kind of `file`; what nothing speaks for is taken for a program, whose reader says what it misses.
    ///
    /// # Errors
    /// It cannot be read, or is no text and of no format that is known.
    pub(super) fn of(file: &Path) -> Result<Self, Problem> {
        if is_program_by_name(file) {
            return Ok(Self::Program);
        }
        let refuse = |cause| Problem::of_file(file, cause);
        let mut first = Vec::new();
        let opened = bounds::open(file, MOST_LOG_BYTES).map_err(refuse)?;
        opened.take(FIRST_BYTES).read_to_end(&mut first).map_err(refuse)?;
        if !is_text(file)? {
            return Ok(Self::Log);
        }
        Ok(Self::of_text(&first, &file.to_string_lossy().to_ascii_lowercase()))
    }

    fn of_text(first: &[u8], name: &str) -> Self {
        if rapid::is_log(first) {
            return Self::ArcClock;
        }
        let start = first.trim_ascii_start();
        if let Some((_, what)) = OWN.iter().find(|(keys, _)| start.starts_with(b"{") && has_keys(first, keys)) {
            return Self::Own(what);
        }
        if [".plan", ".waypoints"].iter().any(|ending| name.ends_with(ending))
            || start.starts_with(b"QGC WPL")
            || start.starts_with(b"{")
        {
            return Self::Mission;
        }
        let text = String::from_utf8_lossy(first);
        let is_program = text.lines().any(starts_module);
        let header = text.lines().find(|line| !line.trim().is_empty()).unwrap_or_default();
        let columns = Columns::of(header);
        match () {
            () if name.ends_with(".tum") => Self::Log,
            () if is_program => Self::Program,
            () if columns.time => Self::Log,
            () if columns.place => Self::Mission,
            () if name.ends_with(".csv") || is_tum(&text) => Self::Log,
            () => Self::Program,
        }
    }
}

/// Of a log: see [`logs::is_text`], whose refusals of other programs' logs say what would make them readable.
fn is_text(file: &Path) -> Result<bool, Problem> {
    logs::is_text(file).map_err(|why| Problem::input(format!("{why}; {READS}")))
}

fn starts_module(line: &str) -> bool {
    line.split_whitespace().next().is_some_and(|word| word.eq_ignore_ascii_case("MODULE"))
}

/// Files in JSON that are none of those that are read here, by keys that they begin with.
const OWN: [(&[&str], &str); 3] = [
    (
        &["joint_names", "points"],
        "a motion of joints (trajectory_msgs/JointTrajectory, as `hairpin export --to joint-trajectory` writes it for \
         controllers), which no command reads: give the program that it was made of (`--to rapid`), or a recording to hairpin judge",
    ),
    (&["hairpin_repro"], "a saved case; hairpin replay runs it"),
    (&["kind", "points", "path", "cost"], "a certificate; hairpin max-load --verify checks it"),
];

/// Whether text has all of `keys` in quotes.
fn has_keys(text: &[u8], keys: &[&str]) -> bool {
    let has = |key: &&str| text.windows(key.len() + 2).any(|part| part == format!("\"{key}\"").as_bytes());
    keys.iter().all(has)
}

/// Whether the first line with numbers has the eight of a pose with its time.
fn is_tum(text: &str) -> bool {
    let first = text.lines().find(|line| !line.trim().is_empty() && !line.starts_with('#')).unwrap_or_default();
    let words: Vec<&str> = first.split_whitespace().collect();
    words.len() == 8 && words.iter().all(|word| word.parse::<f64>().is_ok())
}

/// What a header says of a table.
struct Columns {
    time: bool,
    place: bool,
}

impl Columns {
    fn of(header: &str) -> Self {
        let mut columns = Self { time: false, place: false };
        for name in header.trim_start_matches(['\u{feff}', '#']).split([',', ';']) {
            let name = name.trim().trim_matches('"').to_ascii_lowercase();
            columns.time |= name == "t" || name.starts_with("t_") || name.contains("time") || name.contains("stamp");
            columns.place |= ["x_m", "lat_deg"].contains(&name.as_str());
        }
        columns
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texts_are_told_apart_by_what_they_hold() {
        for (text, name, kind) in [
            ("x_m,y_m,z_m\n1,2,3\n", "a.csv", Kind::Mission),
            ("lat_deg,lon_deg,alt_amsl_m\n1,2,3\n", "a.csv", Kind::Mission),
            ("t_s,x_m,y_m,z_m\n1,2,3,4\n", "a.csv", Kind::Log),
            ("#timestamp [ns], p_RS_R_x [m]\n1,2\n", "a.csv", Kind::Log),
            ("a,b\n1,2\n", "a.csv", Kind::Log),
            ("# t x y z\n0.0 1 2 3 0 0 0 1\n", "a.txt", Kind::Log),
            ("QGC WPL 110\n", "a.txt", Kind::Mission),
            ("  {\"fileType\": \"Plan\"}", "a.json", Kind::Mission),
            ("%%%\n  VERSION:1\n%%%\nMODULE m(SYSMODULE)\nENDMODULE\n", "a.txt", Kind::Program),
            ("hello\n", "a.txt", Kind::Program),
            (
                "{\"header\": {}, \"joint_names\": [], \"points\": []}",
                "0000.joint_trajectory.json",
                Kind::Own(OWN[0].1),
            ),
            ("{\"hairpin_repro\": 1}", "0000.json", Kind::Own(OWN[1].1)),
            ("", "a.csv", Kind::Log),
        ] {
            assert_eq!(Kind::of_text(text.as_bytes(), name), kind, "{text:?}");
        }
    }
}
