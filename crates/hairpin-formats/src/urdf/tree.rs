//! The links and joints of a URDF as the tree that they must be, found in time in proportion to their number.

use std::collections::BTreeMap;

use nalgebra::{Isometry3, Unit, Vector3};
use roxmltree::Node;

use super::element::{UrdfError, at, at_attribute, attribute, child, named, number, origin, told, triple};

/// How a joint moves.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Moves {
    /// `fixed`.
    Not,
    /// `revolute` and `continuous`.
    Turns,
    /// `prismatic`.
    Slides,
    /// `floating` and `planar`.
    Anyhow,
}

/// A joint.
pub(super) struct Joint<'t> {
    pub(super) node: Node<'t, 't>,
    pub(super) name: &'t str,
    pub(super) parent: &'t str,
    pub(super) child: &'t str,
    pub(super) moves: Moves,
    pub(super) origin: Isometry3<f64>,
    /// The joint that it follows, its share and its offset.
    pub(super) mimic: Option<(&'t str, f64, f64)>,
}

/// Joints and links; every link is below the root.
pub(super) struct Tree<'t> {
    pub(super) joints: Vec<Joint<'t>>,
    pub(super) links: BTreeMap<&'t str, Node<'t, 't>>,
    /// The joint whose child a link is.
    above: BTreeMap<&'t str, usize>,
    /// The joints whose parent it is.
    below: BTreeMap<&'t str, Vec<usize>>,
    pub(super) root: &'t str,
}

/// Largest angle of a joint without bounds, °.
pub(super) const UNBOUNDED: f64 = 3600.0;
/// Joints, at most.
const MOST_JOINTS: usize = 200_000;

impl<'t> Tree<'t> {
    /// # Errors
    /// Something is missing or wrong in an element; the links are no tree.
    pub(super) fn of(robot: &Node<'t, 't>) -> Result<Self, UrdfError> {
        let nodes = robot.children().filter(|node| node.has_tag_name("joint"));
        let joints = nodes.take(MOST_JOINTS + 1).map(joint).collect::<Result<Vec<_>, _>>()?;
        if joints.len() > MOST_JOINTS {
            return Err(UrdfError::Chain(format!("has more than {MOST_JOINTS} joints")));
        }
        let mut links = BTreeMap::new();
        for node in robot.children().filter(|node| node.has_tag_name("link")) {
            let name = named(&node, "name")?;
            if links.insert(name, node).is_some() {
                return Err(at(&node, &format!("a second link is called `{}`", told(name))));
            }
        }
        let (mut above, mut below) = (BTreeMap::new(), BTreeMap::<&str, Vec<usize>>::new());
        let mut called = std::collections::BTreeSet::new();
        for (index, joint) in joints.iter().enumerate() {
            if !called.insert(joint.name) && !joint.name.is_empty() {
                return Err(at(&joint.node, &format!("a second joint is called {}", joint.told())));
            }
            if above.insert(joint.child, index).is_some() {
                return Err(at(&joint.node, &format!("link `{}` is the child of a second joint", told(joint.child))));
            }
            below.entry(joint.parent).or_default().push(index);
        }
        let mut roots = below.keys().filter(|link| !above.contains_key(*link));
        let lonely = links.keys().filter(|link| !above.contains_key(*link) && !below.contains_key(*link));
        let first = roots.next().copied();
        let others: Vec<&str> = roots.copied().chain(lonely.copied().filter(|_| first.is_some())).collect();
        let Some(root) = first.filter(|_| others.is_empty()) else {
            let count = others.len() + usize::from(first.is_some());
            let named: Vec<String> =
                first.iter().chain(&others).take(5).map(|link| format!("`{}`", told(link))).collect();
            let named = if named.is_empty() { String::new() } else { format!(" ({})", named.join(", ")) };
            return Err(UrdfError::Chain(format!("{count} links are nobody's child{named}; one root is needed")));
        };
        let tree = Self { joints, links, above, below, root };
        let reached = tree.downwards(root).len();
        match tree.joints.len() == reached {
            true => Ok(tree),
            false => {
                let seen: std::collections::BTreeSet<usize> = tree.downwards(root).into_iter().collect();
                let lost = (0..tree.joints.len()).find(|index| !seen.contains(index)).unwrap_or(0);
                Err(at(
                    &tree.joints[lost].node,
                    &format!("the links go round in a circle at `{}`", told(tree.joints[lost].child)),
                ))
            }
        }
    }

    /// The joints whose parent is `link`, in the order of the file.
    pub(super) fn below(&self, link: &str) -> impl Iterator<Item = usize> + '_ {
        self.below.get(link).into_iter().flatten().copied()
    }

    /// The joint whose child is `link`.
    pub(super) fn above(&self, link: &str) -> Option<usize> {
        self.above.get(link).copied()
    }

    /// All joints below `link`, each after the one that its parent is the child of.
    pub(super) fn downwards(&self, link: &str) -> Vec<usize> {
        let mut found: Vec<usize> = self.below(link).collect();
        let mut next = 0;
        while next < found.len() && found.len() <= self.joints.len() {
            found.extend(self.below(self.joints[found[next]].child));
            next += 1;
        }
        found
    }

    /// The joints from `base` down to `link`; `None` where that is not below it.
    pub(super) fn way(&self, base: &str, link: &str) -> Option<Vec<usize>> {
        let (mut way, mut here) = (Vec::new(), link);
        while here != base {
            let joint = self.above(here)?;
            way.push(joint);
            here = self.joints[joint].parent;
        }
        way.reverse();
        Some(way)
    }
}

fn joint<'t>(node: Node<'t, 't>) -> Result<Joint<'t>, UrdfError> {
    let link = |name: &str| {
        let end = child(&node, name).filter(|end| end.attribute("link").is_some());
        named(&end.ok_or_else(|| at(&node, &format!("<joint> needs <{name} link=…>")))?, "link")
    };
    let moves = match attribute(&node, "type")? {
        "fixed" => Moves::Not,
        "revolute" | "continuous" => Moves::Turns,
        "prismatic" => Moves::Slides,
        "floating" | "planar" => Moves::Anyhow,
        other => return Err(at_attribute(&node, "type", &format!("type = \"{}\" is no kind of joint", told(other)))),
    };
    let mimic = match child(&node, "mimic") {
        Some(mimic) if moves != Moves::Not => {
            let or = |key: &str, usual: f64| mimic.attribute(key).map_or(Ok(usual), |_| number(&mimic, key));
            Some((named(&mimic, "joint")?, or("multiplier", 1.0)?, or("offset", 0.0)?))
        }
        _ => None,
    };
    let name = node.attribute("name").map_or(Ok(""), |_| named(&node, "name"))?;
    Ok(Joint { node, name, parent: link("parent")?, child: link("child")?, moves, origin: origin(&node)?, mimic })
}

impl Joint<'_> {
    /// The axis, in the joint's frame, of length 1.
    pub(super) fn axis(&self) -> Result<Unit<Vector3<f64>>, UrdfError> {
        let Some(axis) = child(&self.node, "axis") else { return Ok(Vector3::x_axis()) };
        let given = triple(&axis, "xyz", [1.0, 0.0, 0.0])?;
        Unit::try_new(Vector3::from(given), 1e-9)
            .ok_or_else(|| at_attribute(&axis, "xyz", &format!("xyz = {given:?} is no direction")))
    }

    /// As findings call it.
    pub(super) fn told(&self) -> String {
        format!("`{}`", told(self.name))
    }
}
