//! An SRDF's pairs of links that are not held against each other.

use roxmltree::{Document, Node};

use super::element::{UrdfError, at, named, told};

/// Pairs, at most: a robot of a thousand links has half a million.
const MOST_PAIRS: usize = 1_000_000;

/// The `disable_collisions` of an SRDF.
///
/// # Errors
/// No XML, another root than `<robot>`, a pair without its links.
pub fn read_srdf(text: &str) -> Result<Vec<[String; 2]>, UrdfError> {
    let document = super::element::parse(text)?;
    let robot = root_of(&document)?;
    let pairs = robot.children().filter(|node| node.has_tag_name("disable_collisions")).take(MOST_PAIRS);
    pairs.map(|node| Ok([named(&node, "link1")?.to_owned(), named(&node, "link2")?.to_owned()])).collect()
}

/// The root element, which is a robot.
pub(super) fn root_of<'t>(document: &'t Document<'t>) -> Result<Node<'t, 't>, UrdfError> {
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        let found = told(robot.tag_name().name());
        return Err(at(&robot, &format!("the root element must be <robot>, and is <{found}>: it is no URDF")));
    }
    Ok(robot)
}
