//! Which of a URDF's joints are the arm: six turning ones from its base to its flange.

use std::collections::{BTreeMap, BTreeSet};

use super::element::{UrdfError, at, told};
use super::tree::{Joint, Moves, Tree};

/// Joints of an arm.
pub(super) const AXES: usize = 6;

/// From the base to the flange.
pub(super) struct Way<'t> {
    pub(super) base: &'t str,
    pub(super) tip: &'t str,
    /// The joints in between.
    pub(super) joints: Vec<usize>,
}

/// Names that say that a link is the flange, the first of them where there are both.
const FLANGES: [&str; 2] = ["tool0", "flange"];

/// The arm of a tree: where `tip` and `base` are given, between these; else whatever leads from the root over six
/// turning joints to one flange.
///
/// # Errors
/// No such link; not six turning joints; something that slides on the way; several flanges.
pub(super) fn arm_of<'t>(tree: &Tree<'t>, base: Option<&str>, tip: Option<&str>) -> Result<Way<'t>, UrdfError> {
    let base = base.map_or(Ok(tree.root), |link| known(tree, "base", link))?;
    let tip = match tip {
        Some(link) => known(tree, "tip", link)?,
        None => chosen(tree, base)?,
    };
    let Some(joints) = tree.way(base, tip) else {
        return Err(UrdfError::Chain(format!("tip `{}` is not below the base `{}`", told(tip), told(base))));
    };
    for joint in joints.iter().map(|joint| &tree.joints[*joint]) {
        let Some(moves) = moves_otherwise(joint) else { continue };
        let what = format!(
            "joint {} {moves} and lies between the base `{}` and the flange `{}`: arms of six turning joints are \
             modelled; where it stands before the arm, the key base = \"{}\" leaves it out",
            joint.told(),
            told(base),
            told(tip),
            told(joint.child)
        );
        return Err(at(&joint.node, &what));
    }
    let turning: Vec<usize> = joints.iter().copied().filter(|j| tree.joints[*j].moves == Moves::Turns).collect();
    if turning.len() == AXES {
        return Ok(Way { base, tip, joints });
    }
    let names: Vec<String> = turning.iter().take(12).map(|joint| tree.joints[*joint].told()).collect();
    let count = turning.len();
    Err(UrdfError::Chain(format!(
        "from `{}` to `{}` {count} joints turn, not six: {}; the keys tip and base say which links they lie between",
        told(base),
        told(tip),
        names.join(", ")
    )))
}

/// How a joint moves that is neither fixed nor an axis of an arm.
fn moves_otherwise(joint: &Joint) -> Option<&'static str> {
    match joint.moves {
        Moves::Slides => Some("slides (prismatic)"),
        Moves::Anyhow => Some("floats, or moves in a plane"),
        Moves::Turns if joint.mimic.is_some() => Some("follows another (mimic)"),
        Moves::Not | Moves::Turns => None,
    }
}

fn known<'t>(tree: &Tree<'t>, key: &str, link: &str) -> Result<&'t str, UrdfError> {
    let declared = tree.links.get_key_value(link).map(|(name, _)| *name);
    let named = || tree.joints.iter().flat_map(|joint| [joint.parent, joint.child]).find(|name| *name == link);
    declared.or_else(named).ok_or_else(|| UrdfError::Chain(format!("{key} = \"{}\": no link is called so", told(link))))
}

/// How many joints turn on the way to each link, and the first that makes it no arm's.
fn turning<'t>(tree: &Tree<'t>, base: &str) -> BTreeMap<&'t str, usize> {
    let mut count = BTreeMap::new();
    for index in tree.downwards(base) {
        let joint = &tree.joints[index];
        let before = count.get(joint.parent).copied().unwrap_or(0);
        count.insert(joint.child, before + usize::from(joint.moves == Moves::Turns && joint.mimic.is_none()));
    }
    count
}

/// The one link that is a flange.
fn chosen<'t>(tree: &Tree<'t>, base: &'t str) -> Result<&'t str, UrdfError> {
    let count = turning(tree, base);
    let masters: BTreeSet<&str> = tree.joints.iter().filter_map(|joint| Some(joint.mimic?.0)).collect();
    let followed = |name: &str| masters.contains(name);
    let sixth = |index: &usize| {
        let joint = &tree.joints[*index];
        joint.moves == Moves::Turns && joint.mimic.is_none() && count[joint.child] == AXES
    };
    let below = tree.downwards(base);
    let sixths: Vec<usize> = below.iter().copied().filter(sixth).collect();
    // What another joint follows is a gripper's.
    let wrists: Vec<usize> = sixths.iter().copied().filter(|index| !followed(tree.joints[*index].name)).collect();
    if wrists.is_empty() {
        return Err(sixths.first().map_or_else(|| too_few(tree, base, &count), |sixth| followed_sixth(tree, *sixth)));
    }
    let rigid: Vec<Vec<&str>> = wrists.iter().map(|index| rigidly(tree, tree.joints[*index].child)).collect();
    // By name: exactly, else as the last part of a name.
    let all = || rigid.iter().flatten().copied();
    for flange in FLANGES {
        let exact: Vec<&str> = all().filter(|link| *link == flange).collect();
        let named = if exact.is_empty() { all().filter(|link| ends_as(link, flange)).collect() } else { exact };
        match named[..] {
            [] => {}
            [link] => return Ok(link),
            _ => return Err(several(&named)),
        }
    }
    let ends = |links: &Vec<&'t str>| -> Vec<&'t str> {
        links.iter().copied().filter(|link| !tree.below(link).any(|j| tree.joints[j].moves == Moves::Not)).collect()
    };
    let tips: Vec<&str> = rigid.iter().flat_map(ends).collect();
    let [tip] = tips[..] else { return Err(several(&tips)) };
    // One more joint that turns may be a seventh axis as well as a finger: a hand has several.
    let beyond = rigid[0].iter().flat_map(|link| tree.below(link)).filter(|j| tree.joints[*j].moves != Moves::Not);
    match beyond.collect::<Vec<_>>()[..] {
        [one] if tree.joints[one].moves == Moves::Turns && !followed(tree.joints[one].name) => {
            Err(UrdfError::Chain(format!(
                "a seventh joint turns, {}: the key tip says which link is the flange of six, such as \"{}\"",
                tree.joints[one].told(),
                told(tip)
            )))
        }
        _ => Ok(tip),
    }
}

/// Whether the last part of a link's name is a flange's.
fn ends_as(link: &str, flange: &str) -> bool {
    link.strip_suffix(flange).is_some_and(|before| before.ends_with(['_', '-', '/', '.']))
}

/// That nowhere six joints turn in a row; and what moves otherwise on the way to where most do, or to a link with a
/// flange's name, so that it stands in the place of one.
fn too_few(tree: &Tree, base: &str, count: &BTreeMap<&str, usize>) -> UrdfError {
    let most = count.values().copied().max().unwrap_or(0);
    let is_flange = |link: &str| FLANGES.iter().any(|flange| link == *flange || ends_as(link, flange));
    // The first of a chain's links with as many is what the last of its joints turns.
    let links = || tree.downwards(base).into_iter().map(move |index| tree.joints[index].child);
    let last = links().find(|link| count[*link] == most);
    let ways = last.into_iter().chain(links().filter(|link| is_flange(link))).filter_map(|link| tree.way(base, link));
    let other = ways.flatten().find_map(|index| Some((&tree.joints[index], moves_otherwise(&tree.joints[index])?)));
    let what = format!("the longest chain has {most} turning joints, not six");
    match other {
        Some((joint, moves)) => at(&joint.node, &format!("{what}; on its way joint {} {moves}", joint.told())),
        None => UrdfError::Chain(what),
    }
}

/// `link` and what is fixed to it.
fn rigidly<'t>(tree: &Tree<'t>, link: &'t str) -> Vec<&'t str> {
    let mut found = vec![link];
    let mut next = 0;
    while next < found.len() {
        let fixed = tree.below(found[next]).filter(|index| tree.joints[*index].moves == Moves::Not);
        found.extend(fixed.map(|index| tree.joints[index].child));
        next += 1;
    }
    found
}

/// What another joint follows is a finger more often than a wrist; which of both it is is not guessed.
fn followed_sixth(tree: &Tree, sixth: usize) -> UrdfError {
    let joint = &tree.joints[sixth];
    let links = rigidly(tree, joint.child);
    let flange = FLANGES.iter().find_map(|flange| links.iter().find(|link| link.ends_with(flange)));
    UrdfError::Chain(format!(
        "{} joints turn before {}, which another one follows (mimic) as fingers are followed: where it is the arm's sixth, the key \
         tip says which link is the flange, such as tip = \"{}\"",
        AXES - 1,
        joint.told(),
        told(flange.unwrap_or(&joint.child))
    ))
}

fn several(tips: &[&str]) -> UrdfError {
    let named: Vec<String> = tips.iter().take(12).map(|link| format!("`{}`", told(link))).collect();
    UrdfError::Chain(format!(
        "{} links may be the flange: {}; the key tip says which, such as tip = \"{}\"",
        tips.len(),
        named.join(", "),
        tips.first().copied().map(told).unwrap_or_default()
    ))
}
