//! Whether a tree has the shape of the types: keys, types, words. The JSON Schema of the types is the yardstick, so
//! that nothing is said twice, and every mistake of a file is told at once.

mod vary;

use serde_json::Value;

use super::report::Report;
use super::tree::{Node, NodeKind, below};

pub(super) use vary::unknown_in_vary;

/// Compares `node`, at the dotted key `path`, with `schema`; mistakes go to `report`.
pub(super) fn check(schema: &Value, node: &Node, path: &str, report: &mut Report) {
    Shape { root: schema, report }.check(schema, node, path);
}

struct Shape<'s> {
    root: &'s Value,
    report: &'s mut Report,
}

impl<'s> Shape<'s> {
    fn check(&mut self, schema: &'s Value, node: &Node, path: &str) {
        if matches!(node.kind, NodeKind::Refused) {
            return;
        }
        let alternatives = self.alternatives(schema);
        if alternatives.is_empty() || alternatives.iter().any(|schema| schema.as_bool() == Some(true)) {
            return;
        }
        let words: Vec<&str> = alternatives.iter().flat_map(|schema| words(schema)).collect();
        let fits = |schema: &&&Value| is_of_type(type_of(schema), node);
        // What may be a word may be a table, too, such as a cost.
        let is_table = matches!(node.kind, NodeKind::Table(_)) && alternatives.iter().any(|schema| fits(&schema));
        // So may what only begins like one, such as a model's file.
        let starts: Vec<&str> =
            alternatives.iter().filter_map(|schema| schema["pattern"].as_str()?.strip_prefix('^')).collect();
        if matches!(&node.kind, NodeKind::Text(text) if starts.iter().any(|start| text.starts_with(start))) {
            return;
        }
        if !words.is_empty() && !is_table {
            return self.check_word((&words, &starts), node, path);
        }
        let Some(schema) = alternatives.iter().find(fits) else {
            let expected: Vec<String> = alternatives.iter().map(|schema| self.describe(schema)).collect();
            return self.complain(node, path, &format!("expected {}", expected.join(" or ")));
        };
        match &node.kind {
            NodeKind::Table(_) => {
                let tables: Vec<&'s Value> = alternatives.iter().copied().filter(|schema| fits(&schema)).collect();
                match self.tag(&tables) {
                    Some(tag) if tables.len() > 1 => self.check_tagged(tag, &tables, node, path),
                    _ => self.check_table(most_alike(&tables, node).unwrap_or(schema), node, path),
                }
            }
            NodeKind::Array(items) => {
                let count = items.len() as u64;
                let least = schema["minItems"].as_u64().unwrap_or(0);
                if count < least || count > schema["maxItems"].as_u64().unwrap_or(u64::MAX) {
                    return self.complain(node, path, &format!("expected {}", self.describe(schema)));
                }
                for (index, item) in items.iter().enumerate() {
                    self.check(&schema["items"], item, &format!("{path}[{index}]"));
                }
            }
            NodeKind::Integer(n) => self.check_integer(schema, *n, node, path),
            _ => {}
        }
    }

    /// The schemas a value may have, references followed, `null` left out: TOML has none.
    fn alternatives(&self, schema: &'s Value) -> Vec<&'s Value> {
        if let Some(reference) = schema["$ref"].as_str() {
            let target = reference.strip_prefix('#').and_then(|pointer| self.root.pointer(pointer));
            return target.map_or(Vec::new(), |schema| self.alternatives(schema));
        }
        for key in ["anyOf", "oneOf"] {
            if let Some(any) = schema[key].as_array() {
                return any.iter().flat_map(|schema| self.alternatives(schema)).collect();
            }
        }
        if schema["type"].as_str() == Some("null") || schema.is_null() { Vec::new() } else { vec![schema] }
    }

    /// One of `words`, or what begins as one of `starts`.
    fn check_word(&mut self, (words, starts): (&[&str], &[&str]), node: &Node, path: &str) {
        let begun = starts.iter().map(|start| format!("{start}…"));
        let list = words.iter().map(|word| (*word).to_owned()).chain(begun).collect::<Vec<_>>().join(", ");
        let NodeKind::Text(word) = &node.kind else {
            return self.complain(node, path, &format!("expected one of {list}"));
        };
        if words.contains(&word.as_str()) {
            return;
        }
        let hint =
            nearest(word, words.iter().copied()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let message = format!("`{path}` = {word:?}: {hint}valid here: {list}");
        let bound = format!("must be one of {list}");
        self.report.complain(&node.place, path, &format!("{word:?}"), &bound, message);
    }

    /// The key whose word tells several tables apart: of serde's tagged enums, or a `kind` of one word each.
    fn tag(&self, alternatives: &[&'s Value]) -> Option<&'s str> {
        let first = alternatives.first()?["properties"].as_object()?;
        let tells = |key: &&String| alternatives.iter().all(|schema| self.word_of(schema, key).is_some());
        first.keys().find(tells).map(String::as_str)
    }

    /// The one word that `key` of a table may be, if there is only one.
    fn word_of(&self, schema: &'s Value, key: &str) -> Option<&'s str> {
        let allowed: Vec<&str> =
            self.alternatives(&schema["properties"][key]).into_iter().flat_map(|schema| words(schema)).collect();
        if let [word] = allowed[..] { Some(word) } else { None }
    }

    /// A table that is one of several, told apart by the word under `tag`.
    fn check_tagged(&mut self, tag: &str, alternatives: &[&'s Value], node: &Node, path: &str) {
        let words: Vec<&str> = alternatives.iter().filter_map(|schema| self.word_of(schema, tag)).collect();
        let key = below(path, tag);
        let Some(said) = node.get(tag) else {
            let bound = format!("`{tag}` is missing here: one of {}", words.join(", "));
            let place = node.key.as_ref().unwrap_or(&node.place);
            return self.report.complain(place, &key, "", &bound, format!("`{key}` is missing"));
        };
        let chosen = match &said.kind {
            NodeKind::Text(word) => alternatives.iter().find(|schema| self.word_of(schema, tag) == Some(word)),
            _ => None,
        };
        match chosen {
            Some(schema) => self.check_table(schema, node, path),
            None => self.check_word((&words, &[]), said, &key),
        }
    }

    fn check_table(&mut self, schema: &'s Value, node: &Node, path: &str) {
        let NodeKind::Table(entries) = &node.kind else { return };
        let properties = schema["properties"].as_object();
        for (name, child) in entries {
            let child_path = below(path, name);
            match (properties.and_then(|properties| properties.get(name)), &schema["additionalProperties"]) {
                (Some(schema), _) => self.check(schema, child, &child_path),
                (None, Value::Bool(false)) => self.unknown_key(schema, name, child, &child_path),
                (None, schema) => self.check(schema, child, &child_path),
            }
        }
        for name in schema["required"].as_array().into_iter().flatten().filter_map(Value::as_str) {
            if !entries.contains_key(name) {
                let key = below(path, name);
                let what = properties.and_then(|p| p.get(name)).map_or(String::new(), |schema| self.expected(schema));
                let place = node.key.as_ref().unwrap_or(&node.place);
                let bound = format!("`{name}` is missing here{what}");
                self.report.complain(place, &key, "", &bound, format!("`{key}` is missing"));
            }
        }
    }

    /// What a missing key wants, for the end of a sentence.
    fn expected(&self, schema: &'s Value) -> String {
        let alternatives = self.alternatives(schema);
        let kinds: Vec<String> = alternatives.iter().map(|schema| self.describe(schema)).collect();
        if kinds.is_empty() { String::new() } else { format!(": {}", kinds.join(" or ")) }
    }

    fn unknown_key(&mut self, schema: &Value, name: &str, node: &Node, path: &str) {
        let (hint, list) = self.instead_of(schema, name, path);
        let place = node.key.as_ref().unwrap_or(&node.place);
        let message = format!("unknown key `{path}`: {hint}valid here: {list}");
        let bound = if hint.is_empty() { "no such key".into() } else { hint.trim_end().to_owned() };
        self.report.complain(place, path, &node.describe(), &bound, message);
    }

    /// The key that `name`, which `schema` has not at `path`, was meant to be, as a question, and the keys that it has.
    fn instead_of(&self, schema: &Value, name: &str, path: &str) -> (String, String) {
        let known = schema["properties"].as_object();
        let here: Vec<&str> = known.into_iter().flat_map(|known| known.keys()).map(String::as_str).collect();
        let mut elsewhere = Vec::new();
        self.find_key(self.root, name, "", 0, &mut elsewhere);
        let meant =
            nearest(name, here.iter().copied()).map(str::to_owned).or(elsewhere.into_iter().find(|key| key != path));
        (meant.map_or(String::new(), |key| format!("did you mean `{key}`? ")), here.join(", "))
    }

    /// Where else in the file a key of this name is known.
    fn find_key(&self, schema: &'s Value, name: &str, path: &str, depth: usize, found: &mut Vec<String>) {
        for schema in self.alternatives(schema) {
            for (key, child) in schema["properties"].as_object().into_iter().flatten() {
                if key == name {
                    found.push(below(path, key));
                } else if depth < 3 {
                    self.find_key(child, name, &below(path, key), depth + 1, found);
                }
            }
        }
    }

    fn check_integer(&mut self, schema: &Value, n: i128, node: &Node, path: &str) {
        if type_of(schema) != "integer" {
            return;
        }
        let (least, most) = match schema["format"].as_str() {
            Some("int8") => (i8::MIN.into(), i8::MAX.into()),
            Some("uint32") => (0, u32::MAX.into()),
            _ => (0, i64::MAX.into()),
        };
        if !(least..=most).contains(&n) {
            self.complain(node, path, &format!("expected a whole number, {least} … {most}"));
        }
    }

    fn complain(&mut self, node: &Node, path: &str, expected: &str) {
        let found = node.describe();
        self.report.complain(&node.place, path, &found, expected, format!("`{path}`: {expected}, found {found}"));
    }

    /// What a schema wants, in words.
    fn describe(&self, schema: &Value) -> String {
        if !words(schema).is_empty() {
            return format!("one of {}", words(schema).join(", "));
        }
        match type_of(schema) {
            "number" => "a number".into(),
            "integer" => "a whole number ≥ 0".into(),
            "string" => "text".into(),
            "boolean" => "true or false".into(),
            "object" => "a table".into(),
            "array" => {
                let of = match type_of(&schema["items"]) {
                    "number" => "numbers",
                    "integer" => "whole numbers",
                    "array" => "arrays",
                    "object" => "tables",
                    _ => "values",
                };
                match (schema["minItems"].as_u64(), schema["maxItems"].as_u64()) {
                    (Some(least), Some(most)) if least == most => format!("an array of {least} {of}"),
                    _ => format!("an array of {of}"),
                }
            }
            _ => "a value".into(),
        }
    }
}

/// `"number"` of both `"number"` and `["number", "null"]`.
fn type_of(schema: &Value) -> &str {
    let listed = schema["type"].as_array().and_then(|types| types.first());
    schema["type"].as_str().or(listed.and_then(Value::as_str)).unwrap_or_default()
}

fn is_of_type(wanted: &str, node: &Node) -> bool {
    match node.kind {
        NodeKind::Table(_) => wanted == "object",
        NodeKind::Array(_) => wanted == "array",
        NodeKind::Text(_) => wanted == "string",
        NodeKind::Integer(_) => wanted == "integer" || wanted == "number",
        NodeKind::Float(_) => wanted == "number",
        NodeKind::Bool(_) => wanted == "boolean",
        NodeKind::Date | NodeKind::Refused => false,
    }
}

/// Of tables that nothing tells apart the first that knows most of the keys.
fn most_alike<'s>(tables: &[&'s Value], node: &Node) -> Option<&'s Value> {
    let NodeKind::Table(entries) = &node.kind else { return None };
    let known =
        |schema: &Value| entries.iter().filter(|(name, _)| schema["properties"].get(name.as_str()).is_some()).count();
    tables.iter().copied().rev().max_by_key(|schema| known(schema))
}

/// The words a schema of an enumeration allows; none for any other.
fn words(schema: &Value) -> Vec<&str> {
    let listed = schema["enum"].as_array().into_iter().flatten();
    schema["const"].as_str().into_iter().chain(listed.filter_map(Value::as_str)).collect()
}

/// The candidate that a slip of the finger would have turned into `word`.
pub(super) fn nearest<'c>(word: &str, candidates: impl Iterator<Item = &'c str>) -> Option<&'c str> {
    let part = |a: &str, b: &str| b.len() >= 3 && a.contains(b);
    let characters = word.chars().count();
    let slip = 1 + characters / 4;
    let scored = candidates.map(|candidate| {
        let contained = part(candidate, word) || part(word, candidate);
        // What is contained is that far, and the rest no nearer: a word of megabytes is not aligned to tell that.
        let longer = characters.abs_diff(candidate.chars().count());
        let distance = if contained || longer > slip { longer } else { strsim::osa_distance(word, candidate) };
        (!contained, distance, candidate)
    });
    let (is_no_part, distance, candidate) = scored.min_by_key(|(is_no_part, distance, _)| (*is_no_part, *distance))?;
    (!is_no_part || distance <= slip).then_some(candidate)
}
