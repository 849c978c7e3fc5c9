//! Reads QGroundControl's `.plan`: everything that its own loader demands is demanded here.

use std::collections::BTreeMap;

use serde_json::{Map, Value};

use super::follow::follow;
use super::item::{Frame, Item, Wrong};
use super::uploaded::Uploaded;
use crate::frames::Geodetic;

/// Items at most.
const MOST_ITEMS: usize = 20_000;
/// Vertices of all fences at most.
const MOST_VERTICES: usize = 20_000;
/// `MAV_TYPE`s that do not fly: ground rover, surface boat.
const ON_THE_GROUND: [u64; 2] = [10, 11];
/// Altitude modes of QGroundControl, with the frame that each is sent with.
const MODES: [(u64, &str, &[Frame]); 4] = [
    (1, "above home", &[Frame::Relative]),
    (2, "above sea level", &[Frame::Global]),
    (3, "above terrain, computed", &[Frame::Global]),
    (4, "above terrain, by the vehicle", &[Frame::Terrain]),
];

/// A plan, as read.
#[derive(Debug, Clone, PartialEq)]
pub struct Plan {
    /// What its vehicle is sent.
    pub mission: Uploaded,
    /// Whose it is.
    pub whose: Whose,
    /// Where the vehicle must stay, and must not go.
    pub fences: Vec<Fence>,
}

/// Whose a plan is, by its own words.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Whose {
    /// `MAV_AUTOPILOT` (`firmwareType`).
    pub firmware: Option<u64>,
    /// `MAV_TYPE` (`vehicleType`).
    pub vehicle: Option<u64>,
}

/// A part of a geofence.
#[derive(Debug, Clone, PartialEq)]
pub struct Fence {
    /// Whether the vehicle must stay inside; else it must stay outside.
    pub keeps_in: bool,
    /// Its outline.
    pub outline: Outline,
}

/// An outline on the ground, degrees and m.
#[derive(Debug, Clone, PartialEq)]
pub enum Outline {
    /// Around a place.
    Circle([f64; 2], f64),
    /// Latitudes and longitudes of its corners.
    Polygon(Vec<[f64; 2]>),
}

/// Reads the text of a file.
///
/// # Errors
/// What the loader would refuse, or no vehicle could be sent, with its JSON path.
pub fn parse(text: &str) -> Result<Plan, Wrong> {
    let root: Value = serde_json::from_str(text).map_err(|error| {
        Wrong::new(format!("line {}, column {}", error.line(), error.column()), error, "the JSON of a plan")
    })?;
    let root = Keys::of(&root, "the file")?;
    root.is("fileType", &Value::from("Plan"))?;
    root.is("version", &Value::from(1))?;
    root.text("groundStation")?;
    let fences = fences(&root.table("geoFence")?)?;
    let rally = root.table("rallyPoints")?;
    rally.is("version", &Value::from(2))?;
    let rally = rally.list("points")?.len();
    let (mut mission, whose) = mission(&root.table("mission")?)?;
    // No vehicle is sent them.
    let beyond = unknown(&root).into_iter().map(|path| format!("{path} is no key of a plan: no loader reads it"));
    mission.notes.extend(beyond);
    if rally > 0 {
        mission.notes.push(format!("{rally} rally points are passed over"));
    }
    Ok(Plan { mission, whose, fences })
}

/// Keys that each object of a plan may have; `[]` stands for a place in a list.
const KNOWN: [(&str, &[&str]); 8] = [
    ("", &["fileType", "geoFence", "groundStation", "mission", "rallyPoints", "version"]),
    ("geoFence", &["breachReturn", "circles", "polygons", "version"]),
    ("geoFence.circles[]", &["circle", "inclusion", "version"]),
    ("geoFence.circles[].circle", &["center", "radius"]),
    ("geoFence.polygons[]", &["inclusion", "polygon", "version"]),
    ("rallyPoints", &["points", "version"]),
    (
        "mission",
        &[
            "cruiseSpeed",
            "firmwareType",
            "globalPlanAltitudeMode",
            "hoverSpeed",
            "items",
            "plannedHomePosition",
            "vehicleType",
            "version",
        ],
    ),
    (
        "mission.items[]",
        &[
            "AMSLAltAboveTerrain",
            "Altitude",
            "AltitudeMode",
            "autoContinue",
            "command",
            "doJumpId",
            "frame",
            "params",
            "type",
        ],
    ),
];

/// The paths of the keys that are none of a plan's, of those that differ by their places in lists the first.
fn unknown(root: &Keys) -> Vec<String> {
    let mut found = BTreeMap::new();
    root.map.iter().for_each(|(key, value)| look_at(key, value, ["", ""], &mut found));
    found.into_values().collect()
}

/// Looks at `key` of an object at a place, as [`KNOWN`] have it, and as it is told.
fn look_at(key: &str, value: &Value, place: [&str; 2], found: &mut BTreeMap<String, String>) {
    let Some((_, known)) = KNOWN.iter().find(|(name, _)| *name == place[0]) else { return };
    let [kind, at] = place.map(|of| if of.is_empty() { key.to_owned() } else { format!("{of}.{key}") });
    match known.contains(&key) {
        true => look_through(value, [&kind, &at], found),
        false => drop(found.entry(kind).or_insert(at)),
    }
}

fn look_through(value: &Value, [kind, at]: [&str; 2], found: &mut BTreeMap<String, String>) {
    match value {
        Value::Object(map) => map.iter().for_each(|(key, value)| look_at(key, value, [kind, at], found)),
        Value::Array(list) => {
            for (place, value) in list.iter().enumerate() {
                look_through(value, [&format!("{kind}[]"), &format!("{at}[{place}]")], found);
            }
        }
        _ => {}
    }
}

fn mission(keys: &Keys) -> Result<(Uploaded, Whose), Wrong> {
    keys.is("version", &Value::from(2))?;
    let firmware = Some(keys.count("firmwareType")?);
    let vehicle = if keys.has("vehicleType") { Some(keys.count("vehicleType")?) } else { None };
    for speed in ["cruiseSpeed", "hoverSpeed"] {
        if keys.has(speed) {
            keys.number(speed)?;
        }
    }
    let [lat_deg, lon_deg, alt_amsl_m] = keys.place("plannedHomePosition")?;
    let home = Geodetic { lat_deg, lon_deg, alt_amsl_m };
    let list = keys.list("items")?;
    if list.len() > MOST_ITEMS {
        let must = format!("at most {MOST_ITEMS} items");
        return Err(Wrong::new(keys.path("items"), format!("{} items", list.len()), must));
    }
    let flies = !vehicle.is_some_and(|vehicle| ON_THE_GROUND.contains(&vehicle));
    let items = list.iter().enumerate().map(|(index, value)| item(value, index, flies));
    let mission = follow(&items.collect::<Result<Vec<_>, _>>()?, home, flies)?;
    Ok((mission, Whose { firmware, vehicle }))
}

fn item(value: &Value, index: usize, flies: bool) -> Result<Item, Wrong> {
    let keys = Keys::of(value, &format!("mission.items[{index}]"))?;
    match keys.text("type")? {
        "SimpleItem" => {}
        "ComplexItem" => {
            let name = keys.text("complexItemType")?;
            let must = "SimpleItem: QGroundControl makes the items of a pattern when it uploads; save the mission as it is on the vehicle";
            return Err(Wrong::new(keys.path("type"), format!("ComplexItem ({name})"), must));
        }
        other => return Err(Wrong::new(keys.path("type"), format!("`{other}`"), "SimpleItem or ComplexItem")),
    }
    let at = format!("{}.", keys.at);
    let command = keys.count("command")?;
    let frame = Frame::of(keys.count("frame")?, &at)?;
    let goes_on = keys.flag("autoContinue")?;
    if keys.has("doJumpId") {
        keys.count("doJumpId")?;
    }
    let list = keys.list("params")?;
    if list.len() != 7 {
        return Err(Wrong::new(keys.path("params"), format!("{} values", list.len()), "exactly 7"));
    }
    let mut params = [f64::NAN; 7];
    for (place, value) in list.iter().enumerate() {
        params[place] = match value {
            Value::Null => f64::NAN,
            Value::Number(number) => number.as_f64().unwrap_or(f64::NAN),
            other => {
                return Err(Wrong::new(format!("{}[{place}]", keys.path("params")), other, "a number or null"));
            }
        };
    }
    if flies {
        check_altitude(&keys, frame, params[6])?;
    }
    Ok(Item { at, number: index + 1, command, frame, params, goes_on })
}

/// The loader takes altitude and mode from their keys, a vehicle is sent frame and parameter: both must say the same.
fn check_altitude(keys: &Keys, frame: Frame, altitude: f64) -> Result<(), Wrong> {
    const KEYS: [&str; 3] = ["AltitudeMode", "Altitude", "AMSLAltAboveTerrain"];
    let there = KEYS.iter().filter(|key| keys.has(key)).count();
    if there == 0 {
        return Ok(());
    }
    if let Some(missing) = KEYS.iter().find(|key| !keys.has(key)) {
        return Err(Wrong::new(
            keys.path(missing),
            "nothing",
            "given: AltitudeMode, Altitude and AMSLAltAboveTerrain all three, or none",
        ));
    }
    let mode = keys.count(KEYS[0])?;
    let given = keys.number_or_null(KEYS[1])?;
    keys.number_or_null(KEYS[2])?;
    // 0: each item has its own, which is its frame's.
    if mode == 0 || frame == Frame::Mission {
        return Ok(());
    }
    let Some((_, name, frames)) = MODES.iter().find(|(number, ..)| *number == mode) else {
        return Err(Wrong::new(
            keys.path(KEYS[0]),
            mode,
            "0, 1 (above home), 2 (above sea level), 3 or 4 (above terrain)",
        ));
    };
    if !frames.contains(&frame) {
        let value = format!("{mode} ({name})");
        return Err(Wrong::new(keys.path(KEYS[0]), value, "the mode that the item's frame stands for"));
    }
    let differs = given.is_some_and(|given| altitude.is_finite() && (given - altitude).abs() > 1e-3);
    if differs && mode != 3 {
        let value = given.unwrap_or(f64::NAN);
        return Err(Wrong::new(keys.path(KEYS[1]), value, format!("params[6], {altitude}")));
    }
    Ok(())
}

fn fences(keys: &Keys) -> Result<Vec<Fence>, Wrong> {
    keys.is("version", &Value::from(2))?;
    let mut fences = Vec::new();
    for (index, value) in keys.list("circles")?.iter().enumerate() {
        let one = Keys::of(value, &format!("geoFence.circles[{index}]"))?;
        let circle = one.table("circle")?;
        let radius = circle.number("radius")?;
        if !(radius > 0.0 && radius <= 1e6) {
            return Err(Wrong::new(circle.path("radius"), radius, "above 0 and up to 1000000 m"));
        }
        let outline = Outline::Circle(corner(circle.get("center")?, &circle.path("center"))?, radius);
        fences.push(Fence { keeps_in: one.flag("inclusion")?, outline });
    }
    let mut vertices = 0;
    for (index, value) in keys.list("polygons")?.iter().enumerate() {
        let one = Keys::of(value, &format!("geoFence.polygons[{index}]"))?;
        let list = one.list("polygon")?;
        vertices += list.len();
        if list.len() < 3 || vertices > MOST_VERTICES {
            let must = format!("3 corners at least, and {MOST_VERTICES} of all polygons at most");
            return Err(Wrong::new(one.path("polygon"), format!("{} corners", list.len()), must));
        }
        let at = |place: usize| format!("{}[{place}]", one.path("polygon"));
        let corners = list.iter().enumerate().map(|(place, value)| corner(value, &at(place)));
        let outline = Outline::Polygon(corners.collect::<Result<_, _>>()?);
        fences.push(Fence { keeps_in: one.flag("inclusion")?, outline });
    }
    Ok(fences)
}

/// `[latitude, longitude]`.
fn corner(value: &Value, at: &str) -> Result<[f64; 2], Wrong> {
    let list = value.as_array().filter(|list| list.len() >= 2);
    let number = |place: usize| list.and_then(|list| list[place].as_f64());
    match (number(0), number(1)) {
        (Some(lat), Some(lon)) if lat.abs() <= 90.0 && lon.abs() <= 180.0 => Ok([lat, lon]),
        _ => Err(Wrong::new(at, value, "[latitude, longitude] in degrees")),
    }
}

/// An object, and where it stands.
struct Keys<'a> {
    at: String,
    map: &'a Map<String, Value>,
}

impl<'a> Keys<'a> {
    fn of(value: &'a Value, at: &str) -> Result<Self, Wrong> {
        match value.as_object() {
            Some(map) => Ok(Self { at: if at == "the file" { String::new() } else { at.into() }, map }),
            None => Err(Wrong::new(at, value, "an object")),
        }
    }

    fn path(&self, key: &str) -> String {
        if self.at.is_empty() { key.into() } else { format!("{}.{key}", self.at) }
    }

    fn has(&self, key: &str) -> bool {
        self.map.contains_key(key)
    }

    fn get(&self, key: &str) -> Result<&'a Value, Wrong> {
        self.map
            .get(key)
            .ok_or_else(|| Wrong::new(self.path(key), "nothing", "given, as QGroundControl's loader demands"))
    }

    fn is(&self, key: &str, wanted: &Value) -> Result<(), Wrong> {
        let value = self.get(key)?;
        let alike = value == wanted || (value.as_f64().is_some() && value.as_f64() == wanted.as_f64());
        if alike { Ok(()) } else { Err(Wrong::new(self.path(key), value, wanted.to_string())) }
    }

    fn text(&self, key: &str) -> Result<&'a str, Wrong> {
        let value = self.get(key)?;
        value.as_str().ok_or_else(|| Wrong::new(self.path(key), value, "a text"))
    }

    fn flag(&self, key: &str) -> Result<bool, Wrong> {
        let value = self.get(key)?;
        value.as_bool().ok_or_else(|| Wrong::new(self.path(key), value, "true or false"))
    }

    fn number(&self, key: &str) -> Result<f64, Wrong> {
        let value = self.get(key)?;
        value.as_f64().ok_or_else(|| Wrong::new(self.path(key), value, "a number"))
    }

    /// The loader takes null for a number that is not known.
    fn number_or_null(&self, key: &str) -> Result<Option<f64>, Wrong> {
        if self.get(key)?.is_null() { Ok(None) } else { self.number(key).map(Some) }
    }

    fn count(&self, key: &str) -> Result<u64, Wrong> {
        let number = self.number(key)?;
        let whole = number >= 0.0 && number <= f64::from(u32::MAX) && number.fract() == 0.0;
        if whole { Ok(number as u64) } else { Err(Wrong::new(self.path(key), number, "a whole number")) }
    }

    fn list(&self, key: &str) -> Result<&'a [Value], Wrong> {
        let value = self.get(key)?;
        let list = value.as_array().ok_or_else(|| Wrong::new(self.path(key), value, "a list"))?;
        Ok(list)
    }

    fn table(&self, key: &str) -> Result<Keys<'a>, Wrong> {
        Keys::of(self.get(key)?, &self.path(key))
    }

    /// `[latitude, longitude, altitude]`.
    fn place(&self, key: &str) -> Result<[f64; 3], Wrong> {
        let value = self.get(key)?;
        let refuse =
            || Wrong::new(self.path(key), value, "[latitude, longitude, altitude], degrees and m above the sea");
        let [lat, lon] = corner(value, &self.path(key))?;
        let altitude = value.get(2).and_then(Value::as_f64).filter(|z| z.abs() <= 20_000.0);
        Ok([lat, lon, altitude.ok_or_else(refuse)?])
    }
}
