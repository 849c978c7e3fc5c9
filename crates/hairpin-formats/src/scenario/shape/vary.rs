//! Keys of `[vary]` that the scenario has not: which one was meant, as everywhere else.

use hairpin::campaign::scenario::KeyPath;
use serde_json::Value;

use super::{Node, NodeKind, Shape, most_alike, type_of};
use crate::scenario::report::Report;

/// What the key that `[vary]` draws under `mistaken`, such as `vary."robot.mass_kg"`, must be, where `schema` has no
/// such key in what `root` is; `None` where it has, or where `mistaken` is another key.
pub(in crate::scenario) fn unknown_in_vary(schema: &Value, root: &Node, mistaken: &str) -> Option<String> {
    let path = KeyPath::parse(mistaken)?;
    let [table, key] = path.segments() else { return None };
    let drawn = KeyPath::parse(key).filter(|_| table == "vary")?;
    let shape = Shape { root: schema, report: &mut Report::default() };
    shape.unknown(schema, Some(root), drawn.segments(), "")
}

impl<'s> Shape<'s> {
    /// Follows `segments` down from `schema`, the shape of the value at `path`, and from `node`, which is there if it
    /// was given.
    fn unknown(&self, schema: &'s Value, node: Option<&Node>, segments: &[String], path: &str) -> Option<String> {
        let (first, rest) = segments.split_first()?;
        let alternatives = self.alternatives(schema);
        if let Some(NodeKind::Array(items)) = node.map(|node| &node.kind) {
            let array = alternatives.into_iter().find(|schema| type_of(schema) == "array")?;
            let item = items.get(first.parse::<usize>().ok()?)?;
            return self.unknown(&array["items"], Some(item), rest, &format!("{path}[{first}]"));
        }
        let tables: Vec<&'s Value> =
            alternatives.into_iter().filter(|schema| schema["properties"].is_object()).collect();
        let table = self.chosen(&tables, node)?;
        let here = if path.is_empty() { first.clone() } else { format!("{path}.{first}") };
        match table["properties"].get(first) {
            Some(schema) => self.unknown(schema, node.and_then(|node| node.get(first)), rest, &here),
            None if table["additionalProperties"].as_bool() == Some(false) => {
                let (hint, list) = self.instead_of(table, first, &here);
                let place = if path.is_empty() { String::new() } else { format!(" in `{path}`") };
                Some(format!("a key of the scenario, which has no `{here}`: {hint}valid{place}: {list}"))
            }
            None => None,
        }
    }

    /// Of several tables the one that `node` is.
    fn chosen(&self, tables: &[&'s Value], node: Option<&Node>) -> Option<&'s Value> {
        let Some(node) = node else { return tables.first().copied() };
        let tagged = self.tag(tables).and_then(|tag| {
            let NodeKind::Text(word) = &node.get(tag)?.kind else { return None };
            tables.iter().copied().find(|schema| self.word_of(schema, tag) == Some(word))
        });
        tagged.or_else(|| most_alike(tables, node)).or(tables.first().copied())
    }
}
