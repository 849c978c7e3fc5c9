//! A TOML text as a tree whose every value knows where it stands.

use std::collections::BTreeMap;

use serde_json::{Map, Number, Value};
use toml::Spanned;
use toml::de::{DeTable, DeValue};

use super::report::{Place, Report};
use crate::bounds::check_values;

/// A value and where it stands.
#[derive(Debug, Clone)]
pub(super) struct Node {
    pub(super) kind: NodeKind,
    pub(super) place: Place,
    /// Where its key stands.
    pub(super) key: Option<Place>,
}

#[derive(Debug, Clone)]
pub(super) enum NodeKind {
    Table(BTreeMap<String, Node>),
    Array(Vec<Node>),
    Text(String),
    Integer(i128),
    Float(f64),
    Bool(bool),
    Date,
    /// A number that has been refused already: nothing more is said of it.
    Refused,
}

/// The tree of source number `source`, every number that is not finite told; `None`, and why told, if it is no TOML.
pub(super) fn parse(source: usize, report: &mut Report) -> Option<Node> {
    let text = report.source(source).text.clone();
    if let Err(what) = check_values(&text) {
        report.complain(&Place { source, span: 0..0 }, "", "", &what, format!("too large: {what}"));
        return None;
    }
    let (table, errors) = DeTable::parse_recoverable(&text);
    for error in errors.iter().take(10) {
        let place = Place { source, span: error.span().unwrap_or(0..0) };
        report.complain(&place, "", "", error.message(), format!("no TOML: {}", error.message()));
    }
    if !errors.is_empty() {
        return None;
    }
    let mut reader = Reader { source, offset: 0, report };
    let place = Place { source, span: 0..0 };
    Some(Node { kind: reader.table(table.get_ref(), ""), place, key: None })
}

/// The value `text`, which stands `offset` bytes into source number `source`. `None`: it is no TOML value.
pub(super) fn parse_value(text: &str, source: usize, offset: usize, key: &str, report: &mut Report) -> Option<Node> {
    let value = DeValue::parse(text).ok()?;
    Some(Reader { source, offset, report }.value(&value, key))
}

struct Reader<'r> {
    source: usize,
    offset: usize,
    report: &'r mut Report,
}

impl Reader<'_> {
    fn place<T>(&self, spanned: &Spanned<T>) -> Place {
        let span = spanned.span();
        Place { source: self.source, span: span.start + self.offset..span.end + self.offset }
    }

    fn table(&mut self, table: &DeTable<'_>, path: &str) -> NodeKind {
        let mut entries = BTreeMap::new();
        for (key, value) in table {
            let name = key.get_ref().to_string();
            let place = self.place(key);
            let mut node = self.value(value, &below(path, &name));
            node.key = Some(place);
            entries.insert(name, node);
        }
        NodeKind::Table(entries)
    }

    fn value(&mut self, value: &Spanned<DeValue<'_>>, path: &str) -> Node {
        let place = self.place(value);
        let kind = match value.get_ref() {
            DeValue::String(text) => NodeKind::Text(text.to_string()),
            DeValue::Integer(n) => match i128::from_str_radix(n.as_str(), n.radix()) {
                Ok(n) => NodeKind::Integer(n),
                Err(_) => self.refuse(&place, path, n.as_str(), "a whole number of at most 64 bits"),
            },
            DeValue::Float(x) => match x.as_str().parse::<f64>() {
                Ok(x) if x.is_finite() => NodeKind::Float(x),
                _ => self.refuse(&place, path, x.as_str(), "a finite number"),
            },
            DeValue::Boolean(b) => NodeKind::Bool(*b),
            DeValue::Datetime(_) => NodeKind::Date,
            DeValue::Array(items) => NodeKind::Array(
                items.iter().enumerate().map(|(i, item)| self.value(item, &format!("{path}[{i}]"))).collect(),
            ),
            DeValue::Table(table) => self.table(table, path),
        };
        Node { kind, place, key: None }
    }

    fn refuse(&mut self, place: &Place, path: &str, value: &str, bound: &str) -> NodeKind {
        let message = format!("`{path}` = {value}: must be {bound}");
        self.report.complain(place, path, value, &format!("must be {bound}"), message);
        NodeKind::Refused
    }
}

impl Node {
    /// The node at `segments`, or the deepest one on the way to it, and whether it is the one asked for.
    pub(super) fn nearest(&self, segments: &[String]) -> (&Node, bool) {
        let Some((first, rest)) = segments.split_first() else { return (self, true) };
        let child = match &self.kind {
            NodeKind::Table(entries) => entries.get(first),
            NodeKind::Array(items) => first.parse::<usize>().ok().and_then(|index| items.get(index)),
            _ => None,
        };
        child.map_or((self, false), |child| child.nearest(rest))
    }

    /// The entry `key` of a table.
    pub(super) fn get(&self, key: &str) -> Option<&Node> {
        match &self.kind {
            NodeKind::Table(entries) => entries.get(key),
            _ => None,
        }
    }

    /// The same for changes.
    pub(super) fn entries(&mut self) -> Option<&mut BTreeMap<String, Node>> {
        match &mut self.kind {
            NodeKind::Table(entries) => Some(entries),
            _ => None,
        }
    }

    /// What stands there, in words.
    pub(super) fn describe(&self) -> String {
        match &self.kind {
            NodeKind::Table(_) => "a table".into(),
            NodeKind::Array(items) => format!("an array of {}", items.len()),
            NodeKind::Text(text) => format!("the text {text:?}"),
            NodeKind::Integer(n) => n.to_string(),
            NodeKind::Float(x) => format!("{x:?}"),
            NodeKind::Bool(b) => b.to_string(),
            NodeKind::Date => "a date".into(),
            NodeKind::Refused => "a number that is refused".into(),
        }
    }

    /// Without places. Dates and refused numbers, which no scenario has, become nothing.
    pub(super) fn to_value(&self) -> Value {
        match &self.kind {
            NodeKind::Table(entries) => {
                Value::Object(entries.iter().map(|(key, node)| (key.clone(), node.to_value())).collect::<Map<_, _>>())
            }
            NodeKind::Array(items) => Value::Array(items.iter().map(Node::to_value).collect()),
            NodeKind::Text(text) => Value::String(text.clone()),
            NodeKind::Integer(n) => Number::from_i128(*n).map_or_else(|| Value::from(*n as f64), Value::Number),
            NodeKind::Float(x) => Number::from_f64(*x).map_or(Value::Null, Value::Number),
            NodeKind::Bool(b) => Value::Bool(*b),
            NodeKind::Date | NodeKind::Refused => Value::Null,
        }
    }
}

/// The dotted key of `name` in the table `path`.
pub(super) fn below(path: &str, name: &str) -> String {
    let name = if name.contains('.') { format!("\"{name}\"") } else { name.to_owned() };
    if path.is_empty() { name } else { format!("{path}.{name}") }
}
