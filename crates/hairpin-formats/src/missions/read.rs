//! A mission's file, or a folder of them.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use hairpin::campaign::{Environment, Scenario};

use super::error::MissionError;
use super::mission::{Frame, Mission, Uncertain, Whose};
use super::place::place;
use crate::bounds::{self, MOST_BYTES, MOST_TEXT_BYTES};
use crate::folder::{is_exported, is_of_a_motion};
use crate::geodetic;
use crate::qgc::{read_plan, read_wpl};
use crate::quote;
use crate::waypoints;

/// Endings of files that are missions, of which `txt` may be anything.
const ENDINGS: [&str; 4] = ["csv", "plan", "waypoints", "txt"];

/// `NAME.environment.json` in the folder of missions.
pub fn environment_path(folder: &Path, name: &str) -> PathBuf {
    folder.join(format!("{name}.environment.json"))
}

fn read_environment(path: &Path) -> Result<Option<Environment>, MissionError> {
    let refuse = |cause| MissionError::Unreadable { path: path.into(), cause };
    match bounds::read_text(path, MOST_BYTES) {
        Err(cause) if cause.kind() == io::ErrorKind::NotFound => Ok(None),
        // Read as a list, its values would be taken for keys in their order.
        text => text
            .and_then(|text| serde_json::from_str::<serde_json::Map<_, _>>(&text).map_err(io::Error::from))
            .and_then(|keys| serde_json::from_value(keys.into()).map_err(io::Error::from))
            .map(Some)
            .map_err(refuse),
    }
}

/// Reads the missions of a folder, sorted by name, or the one of a file, with the environments beside them. Places on
/// Earth are the world's by `scenario`. A table in degrees is passed over where the same waypoints lie beside it in
/// metres, as `export` writes both; so are the motions that it writes, what it made of the same waypoints for
/// autopilots, and text files that are no missions.
///
/// # Errors
/// As [`read`]; a folder that cannot be read or has no such file; an environment that is none.
pub fn read_all(path: &Path, scenario: &Scenario, farthest: f64) -> Result<Vec<Mission>, MissionError> {
    let refuse = |cause| MissionError::Unreadable { path: path.into(), cause };
    if !fs::metadata(path).map_err(refuse)?.is_dir() {
        return Ok(vec![with_environment(path, scenario, farthest)?]);
    }
    let entries = fs::read_dir(path).map_err(refuse)?;
    let mut paths = entries.map(|entry| entry.map(|e| e.path())).collect::<Result<Vec<_>, _>>().map_err(refuse)?;
    paths.retain(|path| {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        ENDINGS.contains(&ending.as_str()) && (ending != "txt" || is_wpl(path)) && !is_motion(path)
    });
    let is_again = |path: &PathBuf| forms_before(path).iter().any(|form| paths.contains(form));
    let mut kept: Vec<&PathBuf> = paths.iter().filter(|path| !is_again(path)).collect();
    kept.sort();
    if kept.is_empty() {
        return Err(MissionError::Empty { path: path.into() });
    }
    let all = kept.into_iter().map(|path| with_environment(path, scenario, farthest));
    let mut all = all.collect::<Result<Vec<Mission>, _>>()?;
    let names: Vec<String> = all.iter().map(|mission| mission.name.clone()).collect();
    for mission in &mut all {
        if names.iter().filter(|name| **name == mission.name).count() > 1 {
            mission.name = mission.path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        }
    }
    Ok(all)
}

/// Whether a file is a motion that `export` wrote: by its name and, as a mission may be called so too, its first
/// column.
fn is_motion(path: &Path) -> bool {
    let named = path.file_name().and_then(|name| name.to_str()).is_some_and(is_of_a_motion);
    let first = |bytes: Vec<u8>| bytes.split(|byte| *byte == b',').next().map(<[u8]>::to_vec);
    named
        && bounds::read_table(path)
            .ok()
            .and_then(first)
            .is_some_and(|column| [&b"t"[..], b"Duration"].contains(&&column[..]))
}

/// The files that a mission is read from rather than from this one, where they lie beside it: of degrees the one in
/// metres; of what `export` wrote for an autopilot (take-off, way home and landing added, or slow) what it was made of.
fn forms_before(path: &Path) -> Vec<PathBuf> {
    let name = path.file_name().unwrap_or_default().to_string_lossy();
    let beside = |case: &str, endings: &[&str]| -> Vec<PathBuf> {
        endings.iter().map(|ending| path.with_file_name(format!("{case}{ending}"))).collect()
    };
    if let Some(case) = name.strip_suffix(geodetic::ENDING) {
        return beside(case, &[".csv"]);
    }
    let more = [
        ("_slow.plan", &[".csv", geodetic::ENDING, ".plan"][..]),
        (".plan", &[".csv", geodetic::ENDING]),
        (".waypoints", &[".csv", geodetic::ENDING, ".plan"]),
    ];
    let form = more.iter().find_map(|(ending, before)| Some((name.strip_suffix(ending)?, *before)));
    form.filter(|_| is_exported(path)).map_or_else(Vec::new, |(case, before)| beside(case, before))
}

/// Whether a text file says that it is a list of mission items. One that is not there (a link may lead nowhere), or
/// that nobody may read, could be one, and is read to be refused.
fn is_wpl(path: &Path) -> bool {
    use io::ErrorKind::{FileTooLarge, InvalidData, InvalidInput};
    match bounds::read_text(path, MOST_TEXT_BYTES) {
        Ok(text) => text.starts_with("QGC WPL"),
        Err(cause) => !matches!(cause.kind(), FileTooLarge | InvalidData | InvalidInput),
    }
}

fn with_environment(path: &Path, scenario: &Scenario, farthest: f64) -> Result<Mission, MissionError> {
    let mission = read(path, scenario, farthest)?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let environment = read_environment(&environment_path(folder, &mission.name))?;
    Ok(Mission { environment, ..mission })
}

/// Reads one file: a plan, a list of items, or a table, as its ending says or, where it has another, its first signs.
///
/// # Errors
/// The first thing wrong, with its place, value and bound.
pub fn read(path: &Path, scenario: &Scenario, farthest: f64) -> Result<Mission, MissionError> {
    let unreadable = |cause| MissionError::Unreadable { path: path.into(), cause };
    let wrong = |wrong| MissionError::Wrong { path: path.into(), wrong };
    match Format::of(path).map_err(unreadable)? {
        Format::Plan => {
            let text = bounds::read_json_text(path).map_err(unreadable)?;
            let plan = read_plan::parse(&text).map_err(wrong)?;
            place((path, "QGroundControl plan"), (plan.mission, plan.whose, &plan.fences), scenario, farthest)
        }
        Format::Wpl => {
            let text = bounds::read_text(path, MOST_TEXT_BYTES).map_err(unreadable)?;
            let uploaded = read_wpl::parse(&text).map_err(wrong)?;
            place((path, "QGC WPL 110"), (uploaded, Whose::default(), &[]), scenario, farthest)
        }
        Format::Table => {
            let (waypoints, rounded) = waypoints::read(path, scenario, farthest)?;
            let (names, asking): (Vec<String>, Vec<String>) =
                waypoints::unread_columns(path)?.into_iter().partition(|name| is_a_name(name));
            let told = |columns: Vec<String>| quote::shortened(&columns.join(", ")).into_owned();
            let words = |columns| format!("columns that are not followed: {}", told(columns));
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let stem = path.file_stem().unwrap_or_default().to_string_lossy();
            Ok(Mission {
                name: name.strip_suffix(geodetic::ENDING).unwrap_or(&stem).to_owned(),
                path: path.into(),
                format: "CSV",
                sources: Vec::new(),
                speeds: vec![None; waypoints.len() - 1],
                waypoints,
                rounded,
                frame: if rounded { Frame::Placed } else { Frame::World },
                accept: Vec::new(),
                whose: Whose::default(),
                stops: Vec::new(),
                notes: match names.is_empty() {
                    true => Vec::new(),
                    false => vec![format!("columns that are not read: {}", told(names))],
                },
                uncertain: match asking.is_empty() {
                    true => Vec::new(),
                    false => vec![Uncertain { waypoint: 0, words: words(asking) }],
                },
                fences: Vec::new(),
                environment: None,
            })
        }
    }
}

/// Whether a column of a table tells waypoints apart, and asks for nothing.
fn is_a_name(column: &str) -> bool {
    // The last is an altitude once more, beside that above the sea, as missions are exported.
    const NAMES: [&str; 17] = [
        "id",
        "index",
        "no",
        "nr",
        "number",
        "seq",
        "row",
        "name",
        "label",
        "tag",
        "comment",
        "note",
        "description",
        "waypoint",
        "leg",
        "case",
        "relative_alt_m",
    ];
    NAMES.contains(&column.to_ascii_lowercase().as_str())
}

/// What a file is written in.
enum Format {
    Plan,
    Wpl,
    Table,
}

impl Format {
    fn of(path: &Path) -> io::Result<Self> {
        let ending = path.extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
        match ending.as_str() {
            "plan" => return Ok(Self::Plan),
            "waypoints" => return Ok(Self::Wpl),
            "csv" => return Ok(Self::Table),
            _ => {}
        }
        let bytes = bounds::read(path, MOST_BYTES)?;
        let first = bytes.iter().find(|byte| !byte.is_ascii_whitespace());
        Ok(match first {
            _ if bytes.starts_with(b"QGC WPL") => Self::Wpl,
            Some(b'{') => Self::Plan,
            _ => Self::Table,
        })
    }
}
