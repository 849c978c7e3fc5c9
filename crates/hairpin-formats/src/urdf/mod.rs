//! URDF in: the arm of six turning joints from a base to a flange, with limits, masses, and the collision geometry of
//! all links as convex bodies.
//!
//! ```text
//! text ─ element ─▶ tree of links ─ tip ─▶ base … flange ─ stand ─▶ which of the arm's links carries which
//!                                                               ─ shapes, outline ─▶ hulls ─ arm ─▶ an arm's file
//! ```
//!
//! | read | as |
//! | --- | --- |
//! | `revolute`, `continuous` between base and flange | the six axes; without `<limit>` at an estimated speed |
//! | `fixed` | part of the link before |
//! | a link `base`, else `base_link`, fast to the arm's base | what the controller counts poses of programs from |
//! | other joints beside or behind the arm (a gripper's) | held at rest |
//! | `mimic` there | where the master is; where an axis drives it, also by others, anywhere about the joint |
//! | `<collision>`: box, sphere, capsule | exactly |
//! | cylinder | a prism of 32 sides around it |
//! | mesh: STL, OBJ, Collada | convex hulls around it, never smaller |
//! | a link without, or whose mesh is not there | a stand-in, named in `estimates` |
//! | `<inertial>` | masses, where all six links have them |
//! | `<safety_controller>` with narrower bounds | nothing, and that it is not kept is named in `estimates` |
//! | `<visual>`, `<transmission>`, `<gazebo>`, `<dynamics>`, `effort` | nothing |
//! | whatever is on no list (`known`), or a second time where one is read | refused with its line |

mod arm;
mod controller;
mod element;
mod follower;
mod known;
mod mass;
mod outline;
mod pairs;
mod shapes;
mod srdf;
mod stand;
mod tip;
mod tree;

#[cfg(test)]
mod tests;

pub use arm::UrdfArm;
pub use element::UrdfError;
pub use shapes::{MeshFile, NoMesh, Triangles};
pub use srdf::read_srdf;

/// What a URDF does not say itself.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct UrdfOptions {
    /// The link that is the flange; found if not given.
    pub tip: Option<String>,
    /// The link that the arm stands on; the root if not given.
    pub base: Option<String>,
    /// Pairs that are not held against each other, by links' names or as findings call them.
    pub exclude: Vec<[String; 2]>,
    /// An SRDF's pairs ([`read_srdf`]).
    pub disabled: Vec<[String; 2]>,
    /// The arm's links (0 the base, k what axis k moves) that get no stand-in: elsewhere is said what they take up.
    pub no_stand_in: Vec<usize>,
}

/// Bytes of a text, at most.
const LARGEST: usize = 32_000_000;

/// Reads the arm of a URDF; `find` gives its meshes.
///
/// # Errors
/// [`UrdfError`]: no XML; no arm of six turning joints, or several; limits, numbers or shapes missing or wrong; a mesh
/// that is there and broken.
pub fn read_urdf(text: &str, options: &UrdfOptions, find: &MeshFile) -> Result<UrdfArm, UrdfError> {
    if text.len() > LARGEST {
        return Err(UrdfError::Chain(format!("{} bytes are more than {LARGEST}", text.len())));
    }
    let document = element::parse(text)?;
    let robot = srdf::root_of(&document)?;
    known::all_known(&robot)?;
    let tree = tree::Tree::of(&robot)?;
    let way = tip::arm_of(&tree, options.base.as_deref(), options.tip.as_deref())?;
    let stands = stand::stands(&tree, &way)?;
    let mut built = arm::Built::default();
    let flange = built.chain(&tree, &way)?;
    built.bodies(&tree, &stands, &options.no_stand_in, &mut shapes::Reader::new(find))?;
    let has_body = |link: &str| tree.links.get(link).is_some_and(|link| element::child(link, "collision").is_some());
    let exclude = pairs::left_out(&stands, (way.tip, &has_body), &options.disabled, &options.exclude)?;
    Ok(built.finish(robot.attribute("name").unwrap_or_default(), [&flange, &controller::base(&tree, &way)], exclude))
}
