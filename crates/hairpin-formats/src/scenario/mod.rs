//! Scenario files in and out. Reading resolves, and checks by building: what comes out is a setup.

mod arm;
mod asked;
mod attached;
mod baseline;
mod cell;
mod files;
mod guest;
mod learned;
mod python;
mod report;
mod resolve;
mod robot;
mod rover;
mod set;
mod shape;
mod terrain;
mod tree;
mod urdf;
mod user_controller;
mod user_score;
mod user_target;
mod whole;
mod world_of;
mod write;

use std::path::Path;

use hairpin::campaign::scenario::{KeyPath, RobotKind};
use hairpin::campaign::{Mistake, Resolved, Scenario, Setup};
use serde_json::Value;
use toml::Table;

pub use arm::{arm_for, arm_with};
pub use asked::check_asked;
pub use files::attach;
pub use guest::kept_in;
pub(crate) use python::{driver, held};
pub use report::{Complaint, Report};
pub use robot::means_scenario;
pub use rover::rover_for;
pub use world_of::{NamedWorld, is_map, named_world};
pub(crate) use write::MADE_BY;
pub use write::{Digests, MadeBy, WriteError, changed_keys, on_a_line, read_made_by, to_toml};

use crate::bounds::{self, MOST_TEXT_BYTES};
use crate::folder::SCENARIO;
use crate::{library, schema};
use guest::Guest;
use resolve::Resolver;
use tree::{Node, NodeKind};
use whole::{as_path, is_urdf};

/// Reads a scenario, resolves it, and builds what it describes.
///
/// `file` is the name that mistakes are told with; robots, worlds and meshes are looked for among the shipped ones,
/// then relative to `base`. `sets` are overrides, key and value as typed; one of several keys that exclude each other
/// (`generate.timing.step_s` and `leg_time_s`; `execute.controller` and `command`) takes the others' place, and a
/// step-wise `generate.reach` that of the file's leg times.
///
/// # Errors
/// All mistakes of one stage: no TOML, or wrong keys and types, or values out of bounds.
pub fn read_setup(text: &str, file: &str, base: &Path, sets: &[(String, String)]) -> Result<Setup, Report> {
    read_from(text, file, (base, None), (sets, Setup::build))
}

/// Reads the scenario that the campaign's folder `folder` keeps. As it may have come from elsewhere, all that it names,
/// but for what `sets` name, must lie in the folder, and Python there finds no other files beside it.
///
/// # Errors
/// As [`read_setup`]; a name that leads out of the folder.
pub fn read_kept(text: &str, file: &str, folder: &Path, sets: &[(String, String)]) -> Result<Setup, Report> {
    read_from(text, file, (folder, Some(Guest::new(folder, sets))), (sets, Setup::build))
}

/// How a setup is made of what was read.
type Make = fn(Resolved) -> Result<Setup, Vec<Mistake>>;

fn read_from(
    text: &str,
    file: &str,
    whose: Whose<'_>,
    (sets, make): (&[(String, String)], Make),
) -> Result<Setup, Report> {
    let mut report = Report::default();
    let source = report.add_source(file, text);
    match read(source, whose, (sets, make), &mut report) {
        Some(setup) if report.is_empty() => Ok(setup),
        _ => Err(report),
    }
}

/// What is to be said where a file and something shipped answer to one name; `None` where they do not.
pub fn shadowed(name_or_path: &str) -> Option<String> {
    let shipped = library::scenarios().chain(library::robots()).any(|shipped| shipped.name == name_or_path);
    let both = shipped && Path::new(name_or_path).is_file();
    both.then(|| format!("`{name_or_path}` is a file here and a shipped name: the file is taken"))
}

/// The setup of the scenario that `name_or_path` means: a scenario file, a shipped scenario's name, or a robot's file
/// or name, which is put into the shipped scenario of its kind. A file goes before what is shipped ([`shadowed`]).
///
/// # Errors
/// As [`read_setup`]; nothing of that name.
pub fn setup_for(name_or_path: &str, sets: &[(String, String)]) -> Result<Setup, Report> {
    setup_made(name_or_path, (sets, Setup::build))
}

/// The same for missions that are given: whatever world was set, the ends of the scenario's own `[task]` need not lie
/// in it, as nothing is searched for between them.
///
/// # Errors
/// As [`setup_for`], but for keys of `[task]`.
pub fn setup_for_missions(name_or_path: &str, sets: &[(String, String)]) -> Result<Setup, Report> {
    setup_made(name_or_path, (sets, Setup::build_for_missions))
}

fn setup_made(name_or_path: &str, (sets, make): (&[(String, String)], Make)) -> Result<Setup, Report> {
    let path = Path::new(name_or_path);
    let shipped = library::scenarios().find(|shipped| shipped.name == name_or_path);
    if let Some(shipped) = shipped.filter(|_| !path.is_file()) {
        return read_from(shipped.text, shipped.path, (Path::new(""), None), (sets, make));
    }
    if path.is_dir() {
        return Err(folder(name_or_path));
    }
    let text = if path.is_file() {
        bounds::read_text(path, MOST_TEXT_BYTES).map_err(|error| unreadable(name_or_path, &error.to_string()))?
    } else {
        let shipped = library::robots().find(|robot| robot.name == name_or_path);
        shipped.ok_or_else(|| unknown(name_or_path))?.text.to_owned()
    };
    let table = text.parse::<Table>().unwrap_or_default();
    let kind = if is_urdf(name_or_path) { Some("arm") } else { table.get("kind").and_then(|kind| kind.as_str()) };
    if kind.is_none() && is_of_nothing(&table) {
        return Err(of_no_kind(name_or_path));
    }
    let Some(kind) = kind.filter(|_| !table.contains_key("hairpin")) else {
        if let Some(folder) = kept_in(name_or_path) {
            let guest = Guest::new(&folder, sets);
            return read_from(&text, name_or_path, (&folder, Some(guest)), (sets, make));
        }
        let base = path.parent().unwrap_or(Path::new(""));
        return read_from(&text, name_or_path, (base, None), (sets, make));
    };
    // A word that no kind has is told where robots are read.
    let words = RobotKind::of_word(Some(kind)).words;
    let around = if words.contains(&kind) { kind } else { words[0] };
    let Some(around) = library::scenarios().find(|shipped| shipped.name == around) else {
        unreachable!("a scenario of every kind is shipped")
    };
    let robot = if path.is_file() { as_path(name_or_path) } else { name_or_path.into() };
    let robot = ("robot".to_owned(), toml::Value::String(robot.into_owned()).to_string());
    let sets: Vec<_> = std::iter::once(robot).chain(sets.iter().cloned()).collect();
    read_from(around.text, around.path, (Path::new(""), None), (&sets, make))
}

/// Whether `name_or_path` means a scenario, shipped or in a file: a robot or a world is none.
pub fn is_scenario(name_or_path: &str) -> bool {
    let path = Path::new(name_or_path);
    if !path.is_file() {
        return library::scenarios().any(|shipped| shipped.name == name_or_path);
    }
    let text = bounds::read_text(path, MOST_TEXT_BYTES).unwrap_or_default();
    text.parse::<Table>().is_ok_and(|table| table.contains_key("hairpin"))
}

/// The setup of an arm for the points of a file: that of a shipped name or a file, or a bare cell around a robot's name
/// or file.
///
/// # Errors
/// As [`read_setup`]; nothing of that name.
pub fn arm_setup_for(cell: &str, points: &Path, sets: &[(String, String)]) -> Result<Setup, Report> {
    let text = |path: &str| {
        bounds::read_text(Path::new(path), MOST_TEXT_BYTES).ok().and_then(|text| text.parse::<Table>().ok())
    };
    let is_scenario = library::scenarios().any(|shipped| shipped.name == cell)
        || text(cell).is_some_and(|table| table.contains_key("hairpin"));
    // The key is nothing that was typed, and no place to send anybody to.
    let name = points.to_string_lossy().into_owned();
    bounds::open(points, bounds::MOST_BYTES).map_err(|error| unreadable(&name, &error.to_string()))?;
    // The points' file is given from where the command runs, the scenario's other files from where it lies.
    let points = match is_scenario && Path::new(cell).is_file() {
        true => std::path::absolute(points).unwrap_or_else(|_| points.to_owned()),
        false => points.to_owned(),
    };
    let quoted = |text: &str| toml::Value::String(text.to_owned()).to_string();
    let given = ("task.points".to_owned(), quoted(&points.to_string_lossy()));
    let sets: Vec<_> = std::iter::once(given).chain(sets.iter().cloned()).collect();
    if is_scenario {
        return setup_for(cell, &sets);
    }
    let shipped = library::robots().find(|robot| robot.name == cell).and_then(|robot| robot.text.parse::<Table>().ok());
    let urdf = Path::new(cell).is_file() && is_urdf(cell);
    let robot = text(cell).or(shipped).unwrap_or_default();
    if robot.is_empty() && !urdf {
        return Err(unknown(cell));
    }
    let kind = robot.get("kind").and_then(|kind| kind.as_str());
    if kind != Some("arm") && !urdf {
        let mut report = Report::default();
        let message = format!("`{cell}` is no arm: its kind is {}", kind.unwrap_or("not given"));
        report.complain_of_file(cell, &message);
        return Err(report);
    }
    let robot = if Path::new(cell).is_file() { as_path(cell) } else { cell.into() };
    let bare = format!("hairpin = 1\nrobot = {}\nspec = \"none\"\n[task]\npoints = \"cloud.csv\"\n", quoted(&robot));
    read_setup(&bare, cell, Path::new(""), &sets)
}

/// Whether a file says neither that it is a scenario nor has anything that only scenarios have, but numbers of a robot.
fn is_of_nothing(table: &Table) -> bool {
    const SCENARIO: [&str; 8] = ["hairpin", "robot", "world", "task", "generate", "execute", "spec", "vary"];
    const ROBOT: [&str; 7] = ["name", "mass_kg", "rotors", "wheels", "joints", "limits", "wheelbase_m"];
    let has = |keys: &[&str]| keys.iter().any(|key| table.contains_key(*key));
    has(&ROBOT) && !has(&SCENARIO)
}

/// A robot's file without the key that says what it is.
fn of_no_kind(name: &str) -> Report {
    let kinds = "\"quadrotor\", \"rover\", \"car\", \"differential-drive\", \"boat\" or \"arm\"";
    let mut report = Report::default();
    report.complain_of_file(
        name,
        &format!("`{name}` has no `kind`: of a robot it must be {kinds}; a scenario begins with `hairpin = 1`"),
    );
    report
}

/// What whoever names a folder may have meant.
fn folder(name: &str) -> Report {
    let mut report = Report::default();
    let campaign = Path::new(name).join(SCENARIO);
    let meant = if campaign.is_file() {
        format!(
            "a campaign's: `hairpin execute {name}`, `judge {name}` and `report {name}` go on with it, and {} is the scenario \
             that it was made of",
            campaign.display()
        )
    } else {
        format!("no campaign's (no {SCENARIO} in it): a scenario is a file or a shipped name")
    };
    report.complain_of_file(name, &format!("`{name}` is a folder, and {meant}"));
    report
}

fn unreadable(file: &str, why: &str) -> Report {
    let mut report = Report::default();
    report.complain_of_file(file, &format!("`{file}` cannot be read: {why}"));
    report
}

fn unknown(name: &str) -> Report {
    let known: Vec<&str> = library::scenarios().chain(library::robots()).map(|shipped| shipped.name).collect();
    let near = shape::nearest(name, known.iter().copied());
    let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    let mut report = Report::default();
    let message = format!("`{name}` is no file and no shipped name: {hint}shipped are {}", known.join(", "));
    report.complain_of_file(name, &message);
    report
}

/// Where files are looked for, and whose names are held to that folder.
type Whose<'a> = (&'a Path, Option<Guest<'a>>);

/// The stages of [`read_setup`]; `None` after a stage with mistakes.
fn read(
    source: usize,
    (base, guest): Whose<'_>,
    (sets, make): (&[(String, String)], Make),
    report: &mut Report,
) -> Option<Setup> {
    let mut root = tree::parse(source, report)?;
    if let Some(entries) = root.entries() {
        entries.remove("made_by");
    }
    if let Some((key, name, why)) = guest.and_then(|guest| guest.wrong_part(&root)) {
        report.complain(&place_of(&root, key), key, &name, &why, format!("`{key}` = {name:?}: {why}"));
        return None;
    }
    let mut resolver = Resolver { base, report };
    apply_sets(&mut root, sets, &mut resolver);
    let before = resolver.report.complaints().len();
    resolver.robot(&mut root);
    let is_read = resolver.report.complaints().len() == before;
    resolver.world(&mut root);
    let schema = match is_read {
        true => schema::scenario_schema_of(kind_of(&root)),
        false => schema_without_robot(&mut root, report),
    };
    shape::check(&schema, &root, "", report);
    if !report.is_empty() {
        return None;
    }
    let mut scenario: Scenario = match serde_json::from_value(root.to_value()) {
        Ok(scenario) => scenario,
        Err(error) => {
            report.complain(&root.place, "", "", "", format!("this is no scenario: {error}"));
            return None;
        }
    };
    let own_coordinates = terrain::in_own_coordinates(&mut scenario);
    let (attachments, mut wrong) = files::read(&mut scenario, &|file| base.join(file), guest);
    if wrong.is_empty() {
        wrong.extend(terrain::place(&mut scenario, own_coordinates).err());
    }
    for one in wrong {
        let message = one.message();
        let place = match one.at {
            Some(at) => report.line_of(*at),
            None => place_of(&root, &one.key),
        };
        report.complain(&place, &one.key, &one.value, &one.bound, message);
    }
    if !report.is_empty() {
        return None;
    }
    scenario.write_defaults();
    // Points of a file are wrong there, not where the file is named.
    let cloud = attachments.cloud.clone();
    let told = |mistake: Mistake| {
        let place = match cloud.as_ref().and_then(|cloud| cell::row_of(cloud, &mistake.key)) {
            Some(at) => report.line_of(*at),
            None => place_of(&root, &mistake.key),
        };
        let bound = shape::unknown_in_vary(&schema, &root, &mistake.key).unwrap_or(mistake.bound);
        let message = format!("`{}` = {}: must be {bound}", mistake.key, mistake.value);
        report.complain(&place, &mistake.key, &mistake.value, &format!("must be {bound}"), message);
    };
    make(Resolved { scenario, attachments }).map_err(|mistakes| mistakes.into_iter().for_each(told)).ok()
}

/// The schema of a scenario whose robot could not be read, which has been told: that of the kind that it says, or else
/// of the kind of whose keys the fewest are wrong. What there is of the robot is no more to be held against it.
fn schema_without_robot(root: &mut Node, report: &Report) -> Value {
    let said = kind_of(root).map(str::to_owned);
    if let Some(robot) = root.entries().and_then(|entries| entries.get_mut("robot")) {
        robot.kind = NodeKind::Text("its name".into());
    }
    if said.is_some() {
        return schema::scenario_schema_of(said.as_deref());
    }
    let wrong = |schema: &Value| {
        let mut told = report.clone();
        shape::check(schema, root, "", &mut told);
        told.complaints().len()
    };
    let schemas = RobotKind::all().map(|kind| schema::scenario_schema_of(kind.words.first().copied()));
    schemas.min_by_key(wrong).unwrap_or_else(|| schema::scenario_schema_of(None))
}

/// The robot's kind, where its table says it.
fn kind_of(root: &Node) -> Option<&str> {
    match &root.get("robot")?.get("kind")?.kind {
        NodeKind::Text(kind) => Some(kind),
        _ => None,
    }
}

/// Where the value of `key` stands; if it is not in the file, the table that it is missing in.
fn place_of(root: &Node, key: &str) -> report::Place {
    let segments = KeyPath::parse(key).map_or(Vec::new(), |path| path.segments().to_vec());
    let (node, exact) = root.nearest(&segments);
    let of_key = node.key.as_ref().filter(|_| !exact);
    of_key.unwrap_or(&node.place).clone()
}

fn apply_sets(root: &mut Node, sets: &[(String, String)], resolver: &mut Resolver<'_>) {
    let mut done: Vec<String> = Vec::new();
    for (key, value) in sets {
        let Some(set) = set::parse(key, value, resolver.report) else { continue };
        // A key inside the robot or the base world can only be set where it is: there, and no longer in its file.
        match set.path.segments() {
            [first, key, ..] if first == "robot" && !urdf::takes(root, key) => resolver.robot(root),
            [first, second, ..] if first == "world" && second != "base" => resolver.world(root),
            _ => {}
        }
        // A limit takes the place of the word for none.
        if matches!(set.path.segments(), [first, _, ..] if first == "spec")
            && root.get("spec").is_some_and(|spec| matches!(spec.kind, NodeKind::Text(_)))
        {
            remove(root, "", &["spec"]);
        }
        done.push(set.path.to_string());
        set.apply(root, resolver.report);
    }
    supersede(root, &done);
}

/// Takes out what an override excludes.
fn supersede(root: &mut Node, set: &[String]) {
    const EXCLUSIVE: [(&str, &[&str]); 2] =
        [("generate.timing", &["leg_time_s", "step_s"]), ("execute", &["controller", "command", "logs"])];
    let is_set = |key: &str| set.iter().any(|done| done == key || done.starts_with(&format!("{key}[")));
    for (table, keys) in EXCLUSIVE {
        let (given, others): (Vec<&str>, Vec<&str>) = keys.iter().partition(|key| is_set(&format!("{table}.{key}")));
        if !given.is_empty() {
            remove(root, table, &others);
        }
    }
    let stepwise = is_set("generate.reach")
        && root.get("generate").and_then(|g| g.get("reach")).is_some_and(|r| r.to_value() != "witness");
    if stepwise && !set.iter().any(|done| done.starts_with("generate.timing")) {
        remove(root, "generate.timing", &["leg_time_s"]);
        let empty =
            root.get("generate").and_then(|g| g.get("timing")).is_some_and(|t| t.to_value() == serde_json::json!({}));
        if empty {
            remove(root, "generate", &["timing"]);
        }
    }
}

fn remove(root: &mut Node, table: &str, keys: &[&str]) {
    let mut parts = table.split('.').filter(|part| !part.is_empty());
    let table = parts.try_fold(root, |node, part| node.entries()?.get_mut(part));
    if let Some(entries) = table.and_then(Node::entries) {
        entries.retain(|key, _| !keys.contains(&key.as_str()));
    }
}
