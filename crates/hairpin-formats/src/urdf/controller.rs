//! What an arm's controller counts from: makers' bases are not always the root that ROS has.

use nalgebra::Isometry3;

use super::tip::Way;
use super::tree::{Moves, Tree};

/// Links that are called so, by how much they say: the frame that programs count in, as packages of ROS-Industrial have
/// it beside their own; else what stands on the floor.
const NAMES: [&str; 2] = ["base", "base_link"];

/// Where it stands in the arm's base; at its origin where nothing that hangs fast with that is called so.
///
/// Names may have the prefix that links of the arm have, as of the left of two (`left_base_link`, `left_base`). Links
/// nearer to the root come first.
pub(super) fn base(tree: &Tree, way: &Way) -> Isometry3<f64> {
    let (here, root_from_base) = held(tree, way.base);
    let mut own = std::iter::once(way.base).chain(way.joints.iter().map(|joint| tree.joints[*joint].child));
    let prefix = own.find_map(|link| NAMES.iter().find_map(|name| link.strip_suffix(name)));
    let called = |link: &str, name: &str| link.strip_suffix(name) == Some(prefix.unwrap_or_default());
    let all =
        std::iter::once(tree.root).chain(tree.downwards(tree.root).into_iter().map(|index| tree.joints[index].child));
    let all: Vec<&str> = all.collect();
    let found = NAMES.iter().find_map(|name| {
        let mut called = all.iter().filter(|link| called(link, name));
        called.find_map(|link| Some(held(tree, link)).filter(|(by, _)| *by == here))
    });
    match found {
        Some((_, root_from_controller)) if root_from_controller != root_from_base => {
            root_from_base.inverse() * root_from_controller
        }
        _ => Isometry3::identity(),
    }
}

/// The link farthest up that `link` hangs fast with, and where it stands in that.
fn held<'t>(tree: &Tree<'t>, link: &'t str) -> (&'t str, Isometry3<f64>) {
    let (mut here, mut pose) = (link, Isometry3::identity());
    while let Some(joint) = tree.above(here).map(|index| &tree.joints[index]).filter(|joint| joint.moves == Moves::Not)
    {
        pose = joint.origin * pose;
        here = joint.parent;
    }
    (here, pose)
}
