//! Elements of a URDF, their numbers, and where what is wrong with them stands.

use std::ops::Range;

use hairpin::math::rotation::{quaternion_from_euler, unit_quaternion};
use nalgebra::{Isometry3, Translation3, Vector3};
use roxmltree::{Document, Node, ParsingOptions};
use thiserror::Error;

/// Why a text is no arm in URDF.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UrdfError {
    /// No XML.
    #[error("is no XML: {what}")]
    Xml {
        /// Where, in bytes.
        at: usize,
        /// What is wrong.
        what: String,
    },
    /// An element or attribute is missing or wrong.
    #[error("line {line}: {what}")]
    At {
        /// Line of the element, from 1.
        line: u32,
        /// Where it stands, in bytes.
        span: Range<usize>,
        /// What is wrong.
        what: String,
    },
    /// The links form no single chain, or one with another number of turning joints, or several.
    #[error("{0}")]
    Chain(String),
}

/// Letters of a name, at most: they are told in findings.
const LONGEST_NAME: usize = 255;

/// What is wrong with an element; of its start tag the place.
pub(super) fn at(node: &Node, what: &str) -> UrdfError {
    let range = node.range();
    let text = &node.document().input_text()[range.clone()];
    let end = text.find('>').map_or(range.end, |end| range.start + end + 1);
    UrdfError::At { line: node.document().text_pos_at(range.start).row, span: range.start..end, what: what.to_owned() }
}

/// What is wrong with an attribute.
pub(super) fn at_attribute(node: &Node, name: &str, what: &str) -> UrdfError {
    match node.attribute_node(name) {
        Some(attribute) => {
            let span = attribute.range();
            UrdfError::At { line: node.document().text_pos_at(span.start).row, span, what: what.to_owned() }
        }
        None => at(node, what),
    }
}

/// A text of somebody else's as it may be told: of bounded length.
pub(super) fn told(text: &str) -> String {
    let short: String = text.chars().take(80).collect();
    if short.len() < text.len() { format!("{short}…") } else { short }
}

pub(super) fn child<'t>(node: &Node<'t, 't>, name: &str) -> Option<Node<'t, 't>> {
    node.children().find(|child| child.has_tag_name(name))
}

pub(super) fn attribute<'t>(node: &Node<'t, 't>, name: &str) -> Result<&'t str, UrdfError> {
    node.attribute(name).ok_or_else(|| at(node, &format!("<{}> needs {name}", node.tag_name().name())))
}

/// A name of bounded length.
pub(super) fn named<'t>(node: &Node<'t, 't>, key: &str) -> Result<&'t str, UrdfError> {
    let name = attribute(node, key)?;
    if name.len() <= LONGEST_NAME {
        return Ok(name);
    }
    Err(at_attribute(node, key, &format!("a name of {} bytes; {LONGEST_NAME} at most", name.len())))
}

pub(super) fn number(node: &Node, name: &str) -> Result<f64, UrdfError> {
    let text = attribute(node, name)?;
    let parsed = text.trim().parse().ok().filter(|value: &f64| value.is_finite());
    parsed.ok_or_else(|| at_attribute(node, name, &format!("{name} = \"{}\" is no number", told(text))))
}

/// A number > 0, of a shape.
pub(super) fn positive(node: &Node, name: &str) -> Result<f64, UrdfError> {
    let value = number(node, name)?;
    if value > 0.0 && value < 50.0 {
        return Ok(value);
    }
    Err(at_attribute(node, name, &format!("{name} = \"{value}\": must be > 0 and < 50 m")))
}

pub(super) fn triple(node: &Node, name: &str, usual: [f64; 3]) -> Result<[f64; 3], UrdfError> {
    let Some(text) = node.attribute(name) else { return Ok(usual) };
    let numbers: Option<Vec<f64>> = text.split_whitespace().take(4).map(|word| word.parse().ok()).collect();
    match numbers.as_deref() {
        Some([x, y, z]) if [x, y, z].into_iter().all(|part| part.is_finite()) => Ok([*x, *y, *z]),
        _ => Err(at_attribute(node, name, &format!("{name} = \"{}\" are no three numbers", told(text)))),
    }
}

pub(super) fn origin(node: &Node) -> Result<Isometry3<f64>, UrdfError> {
    let Some(origin) = node.children().find(|child| child.has_tag_name("origin")) else {
        return Ok(Isometry3::identity());
    };
    let [roll, pitch, yaw] = triple(&origin, "rpy", [0.0; 3])?;
    let rotation = unit_quaternion(&quaternion_from_euler(roll, pitch, yaw));
    Ok(Isometry3::from_parts(Translation3::from(Vector3::from(triple(&origin, "xyz", [0.0; 3])?)), rotation))
}

/// Elements, attributes and texts of a robot: the largest have some ten thousand.
const MOST_NODES: u32 = 2_000_000;

/// The elements of a text.
pub(super) fn parse(text: &str) -> Result<Document<'_>, UrdfError> {
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    Document::parse_with_options(text, options).map_err(|error| {
        let place = error.pos();
        let before = text.split_inclusive('\n').take(place.row.saturating_sub(1) as usize).map(str::len).sum::<usize>();
        let within =
            text[before..].chars().take(place.col.saturating_sub(1) as usize).map(char::len_utf8).sum::<usize>();
        UrdfError::Xml { at: before + within, what: error.to_string() }
    })
}
