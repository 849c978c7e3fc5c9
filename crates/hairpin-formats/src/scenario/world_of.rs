//! A world that takes the place of another one: a world file, or the `[world]` of a scenario, as a key that is set.

use std::path::Path;

use hairpin::campaign::scenario::Origin;
use toml::{Table, Value};

use crate::bounds::{self, MOST_TEXT_BYTES};
use crate::library;

/// A world and where it is from.
#[derive(Debug, Clone, PartialEq)]
pub struct NamedWorld {
    /// The key `world` and its value, as they are typed.
    pub set: (String, String),
    /// Whether it is a scenario's, with a robot and a spec.
    pub is_scenario: bool,
    /// Whether it lies elsewhere on Earth than the one whose place it takes, which stays.
    pub is_elsewhere: bool,
}

/// Endings of maps that say themselves where they lie, or are placed by keys.
const MAPS: [&str; 5] = ["tif", "tiff", "asc", "png", "npy"];

/// Whether `name` is a map's file by its ending: a world that is ground alone.
pub fn is_map(name: &str) -> bool {
    let ending = Path::new(name).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    MAPS.contains(&ending.as_str())
}

/// The world that `name` means, a world's, map's or scenario's file or shipped name, in the place of one at `origin`:
/// where that is given it stays, for it is what waypoints are relative to. Files that it names are looked for beside
/// it.
///
/// # Errors
/// It cannot be read, or is neither, in a sentence's part.
pub fn named_world(name: &str, origin: Option<&Origin>) -> Result<NamedWorld, String> {
    let path = Path::new(name);
    if is_map(name) {
        if !path.is_file() {
            return Err("no such file".into());
        }
        let file = std::path::absolute(path).unwrap_or_else(|_| path.into());
        let file = Value::String(file.to_string_lossy().into_owned());
        let terrain = Table::from_iter([("file".to_owned(), file)]);
        let set =
            ("world".to_owned(), Value::Table(Table::from_iter([("terrain".to_owned(), terrain.into())])).to_string());
        return Ok(NamedWorld { set, is_scenario: false, is_elsewhere: false });
    }
    let shipped = library::worlds().chain(library::scenarios()).find(|shipped| shipped.name == name);
    let (text, base) = match shipped.filter(|_| !path.is_file()) {
        Some(shipped) => (shipped.text.to_owned(), Path::new("")),
        None => {
            let text = bounds::read_text(path, MOST_TEXT_BYTES).map_err(|cause| cause.to_string())?;
            (text, path.parent().unwrap_or(Path::new("")))
        }
    };
    let whole = text.parse::<Table>().map_err(|error| error.message().to_owned())?;
    let is_scenario = whole.contains_key("hairpin");
    let is_world = ["size_m", "obstacles", "terrain"].iter().any(|key| whole.contains_key(*key));
    let mut table = match whole.get("world") {
        Some(Value::Table(table)) => table.clone(),
        None if is_world && !is_scenario => whole,
        _ => return Err("neither a world (size_m, obstacles, terrain) nor a scenario with a table [world]".into()),
    };
    table.iter_mut().for_each(|(key, value)| from_here(key, value, base));
    let own = table.get("origin").cloned();
    let stays = origin.map(Value::try_from).transpose().map_err(|error| error.to_string())?;
    let is_elsewhere = own.as_ref().zip(stays.as_ref()).is_some_and(|(own, stays)| differ(own, stays));
    if let Some(stays) = stays {
        table.insert("origin".into(), stays);
    }
    let set = ("world".to_owned(), Value::Table(table).to_string());
    Ok(NamedWorld { set, is_scenario, is_elsewhere })
}

/// Whether two tables of numbers differ, whole ones and others being the same.
fn differ(a: &Value, b: &Value) -> bool {
    let number = |value: &Value| value.as_float().or_else(|| Some(value.as_integer()? as f64));
    match (a, b) {
        (Value::Table(a), Value::Table(b)) => a.iter().any(|(key, a)| b.get(key).is_none_or(|b| differ(a, b))),
        (a, b) => number(a) != number(b),
    }
}

/// Files are named from where the world's file lies.
fn from_here(key: &str, value: &mut Value, base: &Path) {
    match value {
        Value::String(file) if key == "file" || key == "base" => {
            let path = base.join(&*file);
            if path.is_file() {
                let path = std::path::absolute(&path).unwrap_or(path);
                *file = path.to_string_lossy().into_owned();
            }
        }
        Value::Table(table) => table.iter_mut().for_each(|(key, value)| from_here(key, value, base)),
        Value::Array(all) => all.iter_mut().for_each(|value| from_here("", value, base)),
        _ => {}
    }
}
