//! Where every link of a URDF stands beside the arm's own: fixed to one of them, held by a joint of a gripper at rest,
//! or carried about by one that follows an axis.

use std::collections::{BTreeMap, BTreeSet};

use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Isometry3, Translation3, UnitQuaternion};

use super::element::{UrdfError, at};
use super::follower::{Driven, Masters, Orbit};
use super::tip::Way;
use super::tree::{Joint, Moves, Tree};

/// How well it is known where a link stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Held {
    /// Fixed.
    Firmly,
    /// At rest of a joint that no program of the arm moves.
    AtRest,
    /// Somewhere about a point: a joint before it follows an axis.
    About(Orbit),
}

/// A link beside the arm's link that carries it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Stand {
    /// 0 the base, k what axis k moves.
    pub(super) of: usize,
    /// In that link's frame.
    pub(super) pose: Isometry3<f64>,
    pub(super) held: Held,
    /// Whether it lies between base and flange.
    pub(super) on_way: bool,
}

/// Of every link at or below the base, in the order from there outwards.
pub(super) fn stands<'t>(tree: &Tree<'t>, way: &Way<'t>) -> Result<Vec<(&'t str, Stand)>, UrdfError> {
    let turning = way.joints.iter().copied().filter(|joint| tree.joints[*joint].moves == Moves::Turns);
    let own: BTreeMap<usize, usize> = turning.enumerate().map(|(axis, joint)| (joint, axis + 1)).collect();
    let masters = Masters::of(tree, own.keys().copied());
    let on_way: BTreeSet<usize> = way.joints.iter().copied().collect();
    let base = Stand { of: 0, pose: Isometry3::identity(), held: Held::Firmly, on_way: true };
    let mut found = vec![(way.base, base)];
    let mut place: BTreeMap<&str, usize> = BTreeMap::from([(way.base, 0)]);
    for index in tree.downwards(way.base) {
        let joint = &tree.joints[index];
        let Some((_, parent)) = place.get(joint.parent).map(|at| found[*at]) else { continue };
        let on_way = on_way.contains(&index);
        let stand = match own.get(&index) {
            Some(axis) => Stand { of: *axis, pose: Isometry3::identity(), held: Held::Firmly, on_way },
            None => Stand { on_way, ..carried(&parent, joint, &masters)? },
        };
        place.insert(joint.child, found.len());
        found.push((joint.child, stand));
    }
    Ok(found)
}

/// Where the child of a joint of no axis stands, and how well that is known.
fn carried(parent: &Stand, joint: &Joint, masters: &Masters) -> Result<Stand, UrdfError> {
    let pose = parent.pose * joint.origin;
    let before = match parent.held {
        Held::About(orbit) => Some(orbit.then(&joint.origin)),
        Held::Firmly | Held::AtRest => None,
    };
    if joint.moves == Moves::Not {
        return Ok(Stand { pose, held: before.map_or(parent.held, Held::About), ..*parent });
    }
    match masters.driven(joint)? {
        Driven::ByAxis(travel) => {
            let orbit = before.unwrap_or_else(|| Orbit::about(pose.translation.vector.into()));
            let orbit = match joint.moves {
                Moves::Slides => orbit.slid(travel),
                Moves::Turns | Moves::Not => orbit.turned(),
                Moves::Anyhow => {
                    let what = format!("joint {} floats and follows an axis: how far is not known", joint.told());
                    return Err(at(&joint.node, &what));
                }
            };
            Ok(Stand { pose, held: Held::About(orbit), ..*parent })
        }
        Driven::AtRest(value) => {
            let by = displaced(joint, value)?;
            let held = before.map_or(Held::AtRest, |orbit| Held::About(orbit.then(&by)));
            Ok(Stand { pose: pose * by, held, ..*parent })
        }
    }
}

/// What a joint does at `value` (rad or m).
fn displaced(joint: &Joint, value: f64) -> Result<Isometry3<f64>, UrdfError> {
    let along = joint.axis()?.into_inner() * value;
    Ok(match joint.moves {
        Moves::Turns => Isometry3::from_parts(Translation3::identity(), from_rotation_vector(&along)),
        Moves::Slides => Isometry3::from_parts(Translation3::from(along), UnitQuaternion::identity()),
        Moves::Not | Moves::Anyhow => Isometry3::identity(),
    })
}
