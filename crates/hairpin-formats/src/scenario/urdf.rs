//! A URDF in place of an arm's table: the keys that say how it is read, the files that it names, and mistakes told in
//! its own text.

use std::collections::BTreeMap;
use std::ops::Range;
use std::path::{Path, PathBuf};

use serde_json::Value;

use super::report::{Place, Report};
use super::tree::{Node, NodeKind, below};
use super::whole::{is_urdf, read_file};
use crate::mesh::read_mesh_of_hulls;
use crate::urdf::{NoMesh, Triangles, UrdfError, UrdfOptions, read_srdf, read_urdf};

/// The key of the file.
pub(super) const URDF: &str = "urdf";
/// Keys that say how a URDF is read; what stands beside them goes over what is read.
const KEYS: [&str; 6] = [URDF, "tip", "base", "packages", "srdf", "exclude"];
/// Arrays of shapes, each of which says of which link it is.
const SHAPES: [&str; 2] = ["capsules", "hulls"];
/// Kinds of meshes that are read.
const READ: [&str; 3] = [".stl", ".obj", ".dae"];
/// Folders above a URDF that a package's folder is looked for in.
const HIGHEST: usize = 8;

/// How a URDF is to be read.
#[derive(Default)]
pub(super) struct Wanted {
    options: UrdfOptions,
    packages: Vec<PathBuf>,
}

/// Whether `robot.KEY` says how a URDF is read: its name then becomes a table that has such keys.
pub(super) fn takes(root: &mut Node, key: &str) -> bool {
    let Some(robot) = root.entries().and_then(|entries| entries.get_mut("robot")) else { return false };
    if !KEYS.contains(&key) {
        return false;
    }
    if matches!(&robot.kind, NodeKind::Text(name) if is_urdf(name)) {
        let named = Node { key: None, ..robot.clone() };
        robot.kind = NodeKind::Table(BTreeMap::from([(URDF.to_owned(), named)]));
    }
    robot.get(URDF).is_some()
}

/// The arm of a table that names a URDF; what it names lies in `base`.
pub(super) fn of_urdf(mut table: Node, base: &Path, report: &mut Report) -> Option<Node> {
    let entries = table.entries()?;
    let mut given: BTreeMap<&str, Node> = KEYS.iter().filter_map(|key| Some((*key, entries.remove(*key)?))).collect();
    let named = given.remove(URDF)?;
    let NodeKind::Text(name) = &named.kind else {
        told(&named, URDF, "expected the path of a URDF", report);
        return None;
    };
    let mut wanted = wanted(&given, base, report)?;
    let shaped = SHAPES.map(|key| links(&table, key)).concat();
    wanted.options.no_stand_in = [links(&table, "no_body"), shaped.clone()].concat();
    let path = base.join(name);
    let text = read_file(&path).and_then(|b| String::from_utf8(b).map_err(|_| "it is no UTF-8 text".into()));
    let mut arm = match text {
        Ok(text) => arm_of(&path, text, &wanted, report)?,
        Err(why) => {
            told(&named, URDF, &format!("cannot be read: {why}"), report);
            return None;
        }
    };
    for key in SHAPES {
        join(&mut arm, &mut table, key, &shaped);
    }
    merge(&mut arm, table);
    Some(arm)
}

/// The arm's links that the array `key` of `table` is about: numbers, or tables with a `link`.
fn links(table: &Node, key: &str) -> Vec<usize> {
    let Some(Node { kind: NodeKind::Array(items), .. }) = table.get(key) else { return Vec::new() };
    items.iter().filter_map(link_of).collect()
}

fn link_of(item: &Node) -> Option<usize> {
    match item.get("link").unwrap_or(item).kind {
        NodeKind::Integer(number) => usize::try_from(number).ok(),
        _ => None,
    }
}

/// Shapes of `table` are in the place of those that `arm` has of the same links, `shaped`; of others its own stay. An
/// empty array is in the place of all.
fn join(arm: &mut Node, table: &mut Node, key: &str, shaped: &[usize]) {
    if shaped.is_empty() {
        return;
    }
    let Some(Node { kind: NodeKind::Array(own), .. }) = arm.entries().and_then(|arm| arm.get_mut(key)) else { return };
    own.retain(|item| link_of(item).is_none_or(|link| !shaped.contains(&link)));
    if let Some(Node { kind: NodeKind::Array(given), .. }) = table.entries().and_then(|table| table.get_mut(key))
        && !given.is_empty()
    {
        given.append(own);
    }
}

fn told(node: &Node, key: &str, bound: &str, report: &mut Report) {
    let (value, key) = (node.describe(), format!("robot.{key}"));
    report.complain(&node.place, &key, &value, bound, format!("`{key}` is {value}: {bound}"));
}

/// The keys beside `urdf`; `None` where one of them is of another kind, or cannot be read.
fn wanted(given: &BTreeMap<&str, Node>, base: &Path, report: &mut Report) -> Option<Wanted> {
    let mut wanted = Wanted::default();
    for (key, node) in given {
        let fine = match (*key, &node.kind) {
            ("tip", NodeKind::Text(link)) => {
                wanted.options.tip = Some(link.clone());
                true
            }
            ("base", NodeKind::Text(link)) => {
                wanted.options.base = Some(link.clone());
                true
            }
            ("packages", _) => {
                texts(node).map(|all| wanted.packages = all.iter().map(|at| base.join(at)).collect()).is_some()
            }
            ("exclude", NodeKind::Array(pairs)) => {
                let pairs: Option<Vec<[String; 2]>> = pairs.iter().map(pair).collect();
                pairs.map(|pairs| wanted.options.exclude = pairs).is_some()
            }
            ("srdf", NodeKind::Text(file)) => {
                wanted.options.disabled = srdf(node, &base.join(file), report)?;
                true
            }
            _ => false,
        };
        if !fine {
            let expected = match *key {
                "packages" => "expected a folder that packages lie in, or an array of folders",
                "exclude" => "expected pairs of links, such as [[\"base_link\", \"link_4\"]]",
                "srdf" => "expected the path of an SRDF",
                _ => "expected the name of a link",
            };
            told(node, key, expected, report);
            return None;
        }
    }
    Some(wanted)
}

fn srdf(node: &Node, path: &Path, report: &mut Report) -> Option<Vec<[String; 2]>> {
    let text = read_file(path).and_then(|b| String::from_utf8(b).map_err(|_| "it is no UTF-8 text".into()));
    match text {
        Ok(text) => {
            let source = report.add_source(path.display().to_string(), text.clone());
            read_srdf(&text).map_err(|error| wrong(source, &error, report)).ok()
        }
        Err(why) => {
            told(node, "srdf", &format!("cannot be read: {why}"), report);
            None
        }
    }
}

/// The arm's table of a URDF's text.
pub(super) fn arm_of(path: &Path, text: String, wanted: &Wanted, report: &mut Report) -> Option<Node> {
    let read = read_urdf(&text, &wanted.options, &|name| mesh_of(path, &wanted.packages, name));
    let source = report.add_source(path.display().to_string(), text);
    match read {
        Ok(arm) => {
            let robot = robot_element(source, report);
            let tree = Tree { places: &arm.places, source };
            serde_json::to_value(&arm.description).ok().map(|value| tree.node(&value, "", &robot))
        }
        Err(error) => {
            wrong(source, &error, report);
            None
        }
    }
}

/// Tells what is wrong with the XML of source number `source`.
fn wrong(source: usize, error: &UrdfError, report: &mut Report) {
    let (place, what) = match error {
        UrdfError::Xml { at, .. } => (Place { source, span: *at..*at }, error.to_string()),
        UrdfError::At { span, what, .. } => (Place { source, span: span.clone() }, what.clone()),
        UrdfError::Chain(what) => (robot_element(source, report), what.clone()),
    };
    let name = report.source(source).name.clone();
    report.complain(&place, "robot", "", &what, format!("{name}: {what}"));
}

/// Where the root element begins.
fn robot_element(source: usize, report: &Report) -> Place {
    let text = &report.source(source).text;
    let at = text.find("<robot").unwrap_or(0);
    Place { source, span: at..text.len().min(at + "<robot".len()) }
}

/// A table's tree, every value where the URDF has what it comes from.
struct Tree<'p> {
    places: &'p BTreeMap<String, Range<usize>>,
    source: usize,
}

impl Tree<'_> {
    fn node(&self, value: &Value, path: &str, above: &Place) -> Node {
        let own = self.places.get(path).map(|span| Place { source: self.source, span: span.clone() });
        let place = own.unwrap_or_else(|| above.clone());
        let kind = match value {
            Value::Object(entries) => NodeKind::Table(
                entries.iter().map(|(key, value)| (key.clone(), self.node(value, &below(path, key), &place))).collect(),
            ),
            Value::Array(items) => NodeKind::Array(
                items.iter().enumerate().map(|(i, item)| self.node(item, &format!("{path}[{i}]"), &place)).collect(),
            ),
            Value::String(text) => NodeKind::Text(text.clone()),
            Value::Bool(bool) => NodeKind::Bool(*bool),
            Value::Number(number) => match number.as_i64() {
                Some(n) => NodeKind::Integer(i128::from(n)),
                None => number.as_f64().map_or(NodeKind::Refused, NodeKind::Float),
            },
            Value::Null => NodeKind::Refused,
        };
        Node { kind, place, key: None }
    }
}

/// Puts what a table has over a tree.
fn merge(tree: &mut Node, over: Node) {
    match (tree.entries(), over.kind) {
        (Some(entries), NodeKind::Table(given)) => {
            for (key, node) in given {
                match entries.get_mut(&key) {
                    Some(there) => merge(there, node),
                    None => {
                        entries.insert(key, node);
                    }
                }
            }
        }
        (_, kind) => *tree = Node { kind, place: over.place, key: over.key },
    }
}

fn texts(node: &Node) -> Option<Vec<String>> {
    match &node.kind {
        NodeKind::Text(text) => Some(vec![text.clone()]),
        NodeKind::Array(items) => items
            .iter()
            .map(|item| if let NodeKind::Text(text) = &item.kind { Some(text.clone()) } else { None })
            .collect(),
        _ => None,
    }
}

/// Two links, by name or number.
fn pair(node: &Node) -> Option<[String; 2]> {
    let NodeKind::Array(items) = &node.kind else { return None };
    let link = |item: &Node| match &item.kind {
        NodeKind::Text(name) => Some(name.clone()),
        NodeKind::Integer(number) => Some(number.to_string()),
        _ => None,
    };
    match &items[..] {
        [a, b] => Some([link(a)?, link(b)?]),
        _ => None,
    }
}

/// The file of a mesh that a URDF names: beside it, or in a package that lies in one of `packages`, or among the
/// folders that the URDF itself lies in.
fn mesh_of(urdf: &Path, packages: &[PathBuf], name: &str) -> Result<Triangles, NoMesh> {
    let inside = name.strip_prefix("package://").or_else(|| name.strip_prefix("model://"));
    let candidates: Vec<PathBuf> = match inside.map(|inside| inside.split_once('/').unwrap_or((inside, ""))) {
        None => vec![urdf.parent().unwrap_or(Path::new("")).join(name.strip_prefix("file://").unwrap_or(name))],
        Some((package, rest)) => {
            let own = std::path::absolute(urdf).unwrap_or_else(|_| urdf.to_owned());
            let above = own.ancestors().skip(1).take(HIGHEST).map(Path::to_owned);
            let roots: Vec<PathBuf> = packages.iter().cloned().chain(above).collect();
            let of = |root: &PathBuf| {
                let is_it = root.file_name().is_some_and(|name| name == package);
                [is_it.then(|| root.join(rest)), Some(root.join(package).join(rest))]
            };
            roots.iter().flat_map(of).flatten().collect()
        }
    };
    let short: String = name.chars().take(120).collect();
    let Some(found) = candidates.iter().find(|file| file.is_file()) else {
        let where_to = "; robot.packages = [\"FOLDER\"] says where its package lies";
        let hint = if inside.is_some() { where_to } else { "" };
        return Err(NoMesh::Missing(format!("{short} is not there{hint}")));
    };
    let file = found.display().to_string();
    if !READ.iter().any(|ending| file.to_ascii_lowercase().ends_with(ending)) {
        return Err(NoMesh::Missing(format!("{short}: meshes are read as {}", READ.join(", "))));
    }
    let bytes = read_file(found).map_err(|why| NoMesh::Broken(format!("{file}: {why}")))?;
    let mesh = read_mesh_of_hulls(&bytes, &file).map_err(|error| NoMesh::Broken(format!("{file}: {error}")))?;
    Ok((mesh.vertices, mesh.triangles))
}
