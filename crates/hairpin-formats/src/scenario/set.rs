//! `--set KEY=VALUE`: one scenario key overridden from the command line.

use std::collections::BTreeMap;

use hairpin::campaign::scenario::KeyPath;

use super::report::{Place, Report};
use super::tree::{Node, NodeKind, parse_value};

/// Deeper than any key of a scenario.
const DEEPEST: usize = 16;

/// An override taken apart.
pub(super) struct Override {
    pub(super) path: KeyPath,
    node: Node,
}

/// Takes KEY and VALUE apart. VALUE is TOML; a word that is no TOML is taken as text. `None`: told in `report`.
pub(super) fn parse(key: &str, value: &str, report: &mut Report) -> Option<Override> {
    let source = report.add_source("--set", format!("{key}={value}"));
    let key_place = Place { source, span: 0..key.len() };
    let Some(path) = KeyPath::parse(key).filter(|path| path.segments().len() <= DEEPEST) else {
        let bound = "must be a dotted key, such as generate.search.width";
        report.complain(&key_place, key, value, bound, format!("--set {key}={value}: `{key}` is no key"));
        return None;
    };
    let offset = key.len() + 1;
    let place = Place { source, span: offset..offset + value.len() };
    let mut node = match parse_value(value.trim(), source, offset, key, report) {
        Some(node) => node,
        None if is_word(value) => Node { kind: NodeKind::Text(value.trim().into()), place, key: None },
        None => {
            let bound = "must be a TOML value: 5, 0.5, true, [1, 2], { step_s = 1.0 }, \"text\", or a bare word";
            report.complain(&place, key, value, bound, format!("--set {key}={value}: the value is no TOML"));
            return None;
        }
    };
    node.key = Some(key_place);
    Some(Override { path, node })
}

/// Text that need not be quoted: nothing in it means anything in TOML.
fn is_word(value: &str) -> bool {
    !value.trim().is_empty() && !value.contains(['"', '\'', '[', ']', '{', '}', '=', ',', '#', '\n', '\r'])
}

impl Override {
    /// Puts the value into the tree; tables on the way that are missing are made. Told in `report` where it cannot be.
    pub(super) fn apply(self, root: &mut Node, report: &mut Report) {
        let segments = self.path.segments();
        let place = self.node.key.clone().unwrap_or_else(|| self.node.place.clone());
        let mut at = root;
        for (depth, segment) in segments.iter().enumerate() {
            let upto = KeyPath::of(&segments[..depth].iter().map(String::as_str).collect::<Vec<_>>());
            let found = at.describe();
            let element = segments.get(depth + 1).filter(|next| next.bytes().all(|byte| byte.is_ascii_digit()));
            at = match (&mut at.kind, element) {
                (NodeKind::Table(entries), Some(element)) if !entries.contains_key(segment) => {
                    let whole = KeyPath::of(&segments[..=depth].iter().map(String::as_str).collect::<Vec<_>>());
                    let bound = format!("there is no `{whole}` to take an element of: give all of it");
                    let message = format!("--set {}: no element `{element}`", self.path);
                    report.complain(&place, &self.path.to_string(), element, &bound, message);
                    return;
                }
                (NodeKind::Table(entries), _) => entries.entry(segment.clone()).or_insert_with(|| Node {
                    kind: NodeKind::Table(BTreeMap::new()),
                    place: place.clone(),
                    key: Some(place.clone()),
                }),
                (NodeKind::Array(items), _) => {
                    let count = items.len();
                    match segment.parse::<usize>().ok().and_then(|index| items.get_mut(index)) {
                        Some(item) => item,
                        None => {
                            let bound = format!("`{upto}` has {count} elements, counted from 0");
                            let message = format!("--set {}: no element `{segment}`", self.path);
                            report.complain(&place, &self.path.to_string(), segment, &bound, message);
                            return;
                        }
                    }
                }
                _ => {
                    let bound = format!("`{upto}` is {found} and has no keys");
                    let message = format!("--set {}: no such key", self.path);
                    report.complain(&place, &self.path.to_string(), segment, &bound, message);
                    return;
                }
            };
        }
        *at = self.node;
    }
}
