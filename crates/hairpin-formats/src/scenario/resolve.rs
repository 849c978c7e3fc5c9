//! What a scenario names rather than holds and is part of its keys: robots and base worlds, shipped or in files.

use std::path::Path;

use super::report::{Place, Report};
use super::shape::nearest;
use super::tree::{self, Node, NodeKind};
use super::urdf::{self, URDF, Wanted};
use super::whole::{is_urdf, read_file};
use crate::library::{self, Shipped};

pub(super) struct Resolver<'r> {
    pub(super) base: &'r Path,
    pub(super) report: &'r mut Report,
}

impl Resolver<'_> {
    /// Puts the robot's table where its name stands.
    pub(super) fn robot(&mut self, root: &mut Node) {
        let Some(node) = root.entries().and_then(|entries| entries.get_mut("robot")) else { return };
        let table = match &node.kind {
            NodeKind::Text(name) => self.robot_file(name, &node.place),
            NodeKind::Table(_) if node.get(URDF).is_some() => urdf::of_urdf(node.clone(), self.base, self.report),
            _ => return,
        };
        let Some(table) = table else { return };
        *node = Node { key: node.key.take(), ..table };
    }

    /// The tree of the robot of this name or path; `place` is where mistakes in the name are told.
    pub(super) fn robot_file(&mut self, name: &str, place: &Place) -> Option<Node> {
        let shipped: Vec<Shipped> = library::robots().collect();
        let node = self.file("robot", name, place, &shipped)?;
        if node.get(URDF).is_none() {
            return Some(node);
        }
        // What a robot's file names lies beside it.
        let path = self.base.join(name);
        urdf::of_urdf(node, path.parent().unwrap_or(self.base), self.report)
    }

    /// Fills in the keys of the base world that the scenario's own world has not.
    pub(super) fn world(&mut self, root: &mut Node) {
        let world = root.entries().and_then(|entries| entries.get_mut("world"));
        let Some(entries) = world.and_then(Node::entries) else { return };
        let Some(Node { kind: NodeKind::Text(name), place, .. }) = entries.get("base") else { return };
        let shipped: Vec<Shipped> = library::worlds().collect();
        let table = self.file("world.base", name, place, &shipped);
        // A base that cannot be read has been told; its own base would only be told again.
        entries.remove("base");
        let Some(Node { kind: NodeKind::Table(base), .. }) = table else { return };
        for (key, node) in base {
            entries.entry(key).or_insert(node);
        }
    }

    /// The tree of the shipped file of this name, or of the file at this path.
    fn file(&mut self, key: &str, name: &str, place: &Place, shipped: &[Shipped]) -> Option<Node> {
        if let Some(file) = shipped.iter().find(|shipped| shipped.name == name) {
            let source = self.report.add_source(file.path, file.text);
            return tree::parse(source, self.report);
        }
        let path = self.base.join(name);
        let urdf = key == "robot" && is_urdf(name);
        let is_path = name.contains(['/', '\\']) || name.ends_with(".toml") || urdf || path.is_file();
        if !is_path {
            let names: Vec<&str> = shipped.iter().map(|shipped| shipped.name).collect();
            let hint = nearest(name, names.iter().copied());
            let hint = hint.map_or(String::new(), |near| format!("did you mean `{near}`? "));
            let bound = format!("{hint}shipped are {}; or the path of a file", names.join(", "));
            let message = format!("`{key}` = \"{name}\": no shipped one of this name and no file");
            self.report.complain(place, key, name, &bound, message);
            return None;
        }
        let text =
            read_file(&path).and_then(|bytes| String::from_utf8(bytes).map_err(|_| "it is no UTF-8 text".into()));
        match text {
            Ok(text) if urdf => urdf::arm_of(&path, text, &Wanted::default(), self.report),
            // What is not even called TOML is shown to nobody: a scenario from elsewhere may name any file.
            Ok(text)
                if !name.ends_with(".toml")
                    && let Some(line) = first_that_is_no_toml(&text) =>
            {
                let message = format!("`{key}` = \"{name}\": the file is no TOML from its line {line} on");
                let bound = match FOREIGN.iter().find(|(ending, _)| name.to_ascii_lowercase().ends_with(ending)) {
                    Some((_, what)) if key == "robot" => &format!("must be a TOML file, or a shipped name: {what}"),
                    _ => "must be a TOML file, or a shipped name",
                };
                self.report.complain(place, key, name, bound, message);
                None
            }
            Ok(text) => {
                let source = self.report.add_source(path.display().to_string(), text);
                tree::parse(source, self.report)
            }
            Err(why) => {
                let message = format!("`{key}` = \"{name}\": the file cannot be read: {why}");
                self.report.complain(place, key, name, &format!("cannot be read: {why}"), message);
                None
            }
        }
    }
}

/// Models of robots in files that are not read, by their ending, and what serves instead.
const FOREIGN: [(&str, &str); 5] = [
    (".sdf", "models in SDF are not read; `hairpin schema robot` tells what a robot's file has, of arms a URDF serves"),
    (
        ".xml",
        "models in MJCF are not read; `hairpin schema robot` tells what a robot's file has, of arms a URDF serves",
    ),
    (".params", PARAMETERS),
    (".param", PARAMETERS),
    (".parm", PARAMETERS),
];
const PARAMETERS: &str = "an autopilot's parameters do not tell masses, inertias and thrusts; `hairpin schema robot` tells what a robot's file \
                          has, `hairpin fit` estimates it from logs";

/// The line, from 1, from which on `text` is no TOML; `None` where all of it is.
fn first_that_is_no_toml(text: &str) -> Option<usize> {
    let mut report = Report::default();
    let source = report.add_source("", text);
    match tree::parse(source, &mut report) {
        Some(_) => None,
        None => report.complaints().first().map(|complaint| complaint.line),
    }
}
