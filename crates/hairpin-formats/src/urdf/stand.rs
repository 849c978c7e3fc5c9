//! Where every link of a URDF stands beside the arm's own: fixed to one of them, held by a joint of a gripper at rest,
//! or carried about by one that follows an axis.

use std::collections::{BTreeMap, BTreeSet};

use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Isometry3, Point3, Translation3, UnitQuaternion};

use super::element::{UrdfError, child, number};
use super::tip::Way;
use super::tree::{Joint, Moves, Tree};

/// How well it is known where a link stands.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Held {
    /// Fixed.
    Firmly,
    /// At rest of a joint that no program of the arm moves.
    AtRest,
    /// Somewhere about this point (m, of the arm's link): its joint follows an axis.
    About(Point3<f64>),
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
    let axes: BTreeSet<&str> = own.keys().map(|joint| tree.joints[*joint].name).collect();
    let on_way: BTreeSet<usize> = way.joints.iter().copied().collect();
    let base = Stand { of: 0, pose: Isometry3::identity(), held: Held::Firmly, on_way: true };
    let mut found = vec![(way.base, base)];
    let mut place: BTreeMap<&str, usize> = BTreeMap::from([(way.base, 0)]);
    let named: BTreeMap<&str, &Joint> = tree.joints.iter().map(|joint| (joint.name, joint)).collect();
    for index in tree.downwards(way.base) {
        let joint = &tree.joints[index];
        let Some((_, parent)) = place.get(joint.parent).map(|at| found[*at]) else { continue };
        let pose = parent.pose * joint.origin;
        let on_way = on_way.contains(&index);
        let stand = match (joint.moves, own.get(&index)) {
            (_, Some(axis)) => Stand { of: *axis, pose: Isometry3::identity(), held: Held::Firmly, on_way },
            (Moves::Not, None) => Stand { pose, on_way, ..parent },
            (_, None) if joint.mimic.is_some_and(|(master, ..)| axes.contains(master)) => {
                let about = Held::About(pose.translation.vector.into());
                let held = if let Held::About(_) = parent.held { parent.held } else { about };
                Stand { pose, held, on_way, ..parent }
            }
            (_, None) => {
                let held = if parent.held == Held::Firmly { Held::AtRest } else { parent.held };
                Stand { pose: pose * displaced(joint, rest(joint, &named)?)?, held, on_way, ..parent }
            }
        };
        place.insert(joint.child, found.len());
        found.push((joint.child, stand));
    }
    Ok(found)
}

/// Where a joint of no axis rests: at 0 or the bound next to it; one that follows where its master does.
fn rest(joint: &Joint, named: &BTreeMap<&str, &Joint>) -> Result<f64, UrdfError> {
    if let Some((master, share, offset)) = joint.mimic {
        // A master that follows another itself is not looked at further.
        let of = named.get(master).filter(|master| master.mimic.is_none());
        return Ok(share * of.map_or(Ok(0.0), |master| alone(master))? + offset);
    }
    alone(joint)
}

fn alone(joint: &Joint) -> Result<f64, UrdfError> {
    let Some(limit) = child(&joint.node, "limit") else { return Ok(0.0) };
    let bound = |name: &str| limit.attribute(name).map_or(Ok(0.0), |_| number(&limit, name));
    let (lower, upper) = (bound("lower")?, bound("upper")?);
    Ok(if lower <= upper { 0f64.clamp(lower, upper) } else { 0.0 })
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
