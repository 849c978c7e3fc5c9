//! Robots of one kind by name or path, outside scenarios.

use std::collections::BTreeMap;
use std::path::Path;

use hairpin::campaign::Mistake;
use schemars::JsonSchema;
use serde::de::DeserializeOwned;

use super::guest::Guest;
use super::report::{Place, Report};
use super::resolve::Resolver;
use super::tree::{Node, NodeKind};
use super::whole::as_path;
use super::{apply_sets, is_scenario, kept_in, place_of, shape, tree};
use crate::bounds::{self, MOST_TEXT_BYTES};
use crate::library::{self, Shipped};

/// The robot of one of `kinds` that `name_or_path` means, a robot's name or file or a scenario ([`means_scenario`]),
/// built from its description with `sets` in it (`robot.KEY`, value); `shipped` are those that are told of.
///
/// # Errors
/// Nothing of that name, no robot's file, another kind of robot, wrong keys and types, values out of bounds.
pub(super) fn robot_for<D: DeserializeOwned + JsonSchema, R>(
    name_or_path: &str,
    kinds: &[&str],
    sets: &[(String, String)],
    shipped: impl Iterator<Item = Shipped>,
    build: impl Fn(&D) -> Result<R, Mistake>,
) -> Result<R, Report> {
    let mut report = Report::default();
    match read(name_or_path, kinds, sets, shipped, build, &mut report) {
        Some(robot) if report.is_empty() => Ok(robot),
        _ => Err(report),
    }
}

/// Whether `name_or_path` gives a robot by a scenario: a file of one, or a shipped name that no robot has.
pub fn means_scenario(name_or_path: &str) -> bool {
    is_scenario(name_or_path)
        && (Path::new(name_or_path).is_file() || library::robots().all(|robot| robot.name != name_or_path))
}

/// Of the scenario that `name_or_path` means the robot, as it names or describes it, and nothing else.
fn of_scenario(name_or_path: &str, sets: &[(String, String)], report: &mut Report) -> Option<Node> {
    let path = Path::new(name_or_path);
    let text = if path.is_file() {
        bounds::read_text(path, MOST_TEXT_BYTES).unwrap_or_default()
    } else {
        library::scenarios().find(|shipped| shipped.name == name_or_path)?.text.to_owned()
    };
    let source = report.add_source(name_or_path, text);
    let mut root = tree::parse(source, report)?;
    if let Some(folder) = kept_in(name_or_path)
        && let Some((key, name, why)) = Guest::new(&folder, sets).wrong_part(&root)
    {
        report.complain(&place_of(&root, key), key, &name, &why, format!("`{key}` = {name:?}: {why}"));
        return None;
    }
    root.entries()?.retain(|key, _| key == "robot");
    if root.get("robot").is_none() {
        report.complain(&root.place, "robot", "", "must be given", "`robot` is missing: the scenario has none".into());
        return None;
    }
    Some(root)
}

fn read<D: DeserializeOwned + JsonSchema, R>(
    name_or_path: &str,
    kinds: &[&str],
    sets: &[(String, String)],
    shipped: impl Iterator<Item = Shipped>,
    build: impl Fn(&D) -> Result<R, Mistake>,
    report: &mut Report,
) -> Option<R> {
    let kind = alternatives(kinds);
    let own = Path::new(name_or_path).is_file();
    let whole = means_scenario(name_or_path);
    if !whole && !own && library::robots().all(|robot| robot.name != name_or_path) {
        let known: Vec<&str> = shipped.map(|robot| robot.name).collect();
        let near = shape::nearest(name_or_path, known.iter().copied());
        let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let known = known.join(", ");
        let message = format!("`{name_or_path}` is no file and no shipped name: {hint}shipped {kind}s are {known}");
        report.complain_of_file(name_or_path, &message);
        return None;
    }
    let mut around = if whole {
        of_scenario(name_or_path, sets, report)?
    } else {
        let source = report.add_source(name_or_path, "");
        let asked = Place { source, span: 0..0 };
        // A file goes before what is shipped.
        let path = if own { as_path(name_or_path) } else { name_or_path.into() };
        let named = Node { kind: NodeKind::Text(path.into_owned()), place: asked.clone(), key: None };
        let robot = BTreeMap::from([("robot".to_owned(), named)]);
        Node { kind: NodeKind::Table(robot), place: asked, key: None }
    };
    let base = if whole && own { Path::new(name_or_path).parent() } else { None };
    let mut resolver = Resolver { base: base.unwrap_or(Path::new("")), report };
    apply_sets(&mut around, sets, &mut resolver);
    resolver.robot(&mut around);
    let root = around.entries()?.remove("robot")?;
    if !report.is_empty() {
        return None;
    }
    if let Some(Node { kind: NodeKind::Text(found), place, .. }) = root.get("kind")
        && !kinds.contains(&found.as_str())
    {
        let message = format!("`kind` = \"{found}\": this robot is no {kind}");
        report.complain(place, "kind", found, &format!("must be {kind}"), message);
        return None;
    }
    shape::check(&schemars::schema_for!(D).to_value(), &root, "", report);
    if !report.is_empty() {
        return None;
    }
    let description: D = match serde_json::from_value(root.to_value()) {
        Ok(description) => description,
        Err(error) => {
            report.complain(&root.place, "", "", "", format!("this is no {kind}: {error}"));
            return None;
        }
    };
    match build(&description) {
        Ok(robot) => Some(robot),
        Err(mistake) => {
            let place = place_of(&root, &mistake.key);
            let bound = format!("must be {}", mistake.bound);
            report.complain(&place, &mistake.key, &mistake.value, &bound, mistake.to_string());
            None
        }
    }
}

/// `rover, car or differential-drive`.
fn alternatives(kinds: &[&str]) -> String {
    match kinds {
        [others @ .., last] if !others.is_empty() => format!("{} or {last}", others.join(", ")),
        _ => kinds.concat(),
    }
}
