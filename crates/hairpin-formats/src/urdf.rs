//! URDF in: the six turning joints from the root link to the flange, with their limits, masses and, as capsules, their
//! shapes.

use std::collections::BTreeMap;

use hairpin::math::rotation::{euler_from_quaternion, quaternion_from_euler, unit_quaternion};
use hairpin::robot::arm::{
    ArmDescription, ArmKind, CapsuleDescription, ChainDescription, ChainJoint, JointsDescription, MassDescription,
};
use nalgebra::{Isometry3, Point3, Translation3, Vector3};
use roxmltree::{Document, Node, ParsingOptions};
use thiserror::Error;

/// Why a text is no arm in URDF.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum UrdfError {
    /// No XML.
    #[error("is no XML: {0}")]
    Xml(String),
    /// An element or attribute is missing or wrong.
    #[error("line {line}: {what}")]
    At {
        /// Line of the element, from 1.
        line: u32,
        /// What is wrong.
        what: String,
    },
    /// The links form no single chain, or one with another number of turning joints.
    #[error("{0}")]
    Chain(String),
}

/// Joints of an arm.
const AXES: usize = 6;

/// A joint with what lies behind it.
struct Joint<'t> {
    node: Node<'t, 't>,
    parent: &'t str,
    child: &'t str,
    moves: bool,
    origin: Isometry3<f64>,
}

/// Elements, attributes and texts of a robot: the largest have some thousand.
const MOST_NODES: u32 = 100_000;

/// Reads the longest chain of joints from the root link; fixed joints are merged into the links that they join.
///
/// Collision shapes become capsules: cylinders and spheres as they are, boxes as the capsule around them; meshes are
/// left out. Joint accelerations are not part of URDF.
///
/// # Errors
/// [`UrdfError`]: no XML; no turning joints, or another number than six; a sliding joint; limits or numbers missing or
/// wrong.
pub fn read_urdf(text: &str) -> Result<ArmDescription, UrdfError> {
    let options = ParsingOptions { nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text, options).map_err(|error| UrdfError::Xml(error.to_string()))?;
    let robot = document.root_element();
    if robot.tag_name().name() != "robot" {
        return Err(at(&robot, "the root element must be <robot>"));
    }
    let joints =
        robot.children().filter(|node| node.has_tag_name("joint")).map(joint).collect::<Result<Vec<_>, _>>()?;
    let links: BTreeMap<&str, Node> = robot
        .children()
        .filter(|node| node.has_tag_name("link"))
        .map(|node| attribute(&node, "name").map(|name| (name, node)))
        .collect::<Result<_, _>>()?;
    let chain = longest_chain(&joints)?;
    let mut built = Built::default();
    if let Some(base) = chain.first().and_then(|joint| links.get(joint.parent)) {
        built.link(base)?;
    }
    for joint in chain {
        built.joint(joint)?;
        if let Some(link) = links.get(joint.child) {
            built.link(link)?;
        }
    }
    let name = robot.attribute("name").unwrap_or_default().to_owned();
    built.finish(name)
}

/// What has been gathered from the base on.
#[derive(Default)]
struct Built {
    joints: Vec<ChainJoint>,
    limits: Vec<[f64; 3]>,
    capsules: Vec<CapsuleDescription>,
    masses: Vec<MassDescription>,
    /// Of the present link in the frame of the last turning joint.
    shift: Option<Isometry3<f64>>,
}

impl Built {
    fn here(&self) -> Isometry3<f64> {
        self.shift.unwrap_or_else(Isometry3::identity)
    }

    fn joint(&mut self, joint: &Joint) -> Result<(), UrdfError> {
        let origin = self.here() * joint.origin;
        if !joint.moves {
            self.shift = Some(origin);
            return Ok(());
        }
        let rpy = euler(&origin);
        let axis = match child(&joint.node, "axis") {
            Some(axis) => triple(&axis, "xyz")?,
            None => [1.0, 0.0, 0.0],
        };
        self.joints.push(ChainJoint { xyz_mm: (origin.translation.vector * 1e3).into(), rpy_deg: rpy, axis });
        let limit = child(&joint.node, "limit").ok_or_else(|| at(&joint.node, "a turning joint needs <limit>"))?;
        let unbounded = attribute(&joint.node, "type")? == "continuous";
        let bound = |name: &str, free: f64| if unbounded { Ok(free) } else { number(&limit, name) };
        self.limits.push([
            bound("lower", -3600f64.to_radians())?,
            bound("upper", 3600f64.to_radians())?,
            number(&limit, "velocity")?,
        ]);
        self.shift = None;
        Ok(())
    }

    fn link(&mut self, link: &Node) -> Result<(), UrdfError> {
        let number_of = self.joints.len();
        for collision in link.children().filter(|node| node.has_tag_name("collision")) {
            let from_shape = self.here() * origin(&collision)?;
            let Some(shape) = child(&collision, "geometry").and_then(|g| g.children().find(Node::is_element)) else {
                return Err(at(&collision, "<collision> needs <geometry> with a shape"));
            };
            let (half, radius) = match shape.tag_name().name() {
                "sphere" => (Vector3::zeros(), number(&shape, "radius")?),
                "cylinder" => (Vector3::z() * 0.5 * number(&shape, "length")?, number(&shape, "radius")?),
                "capsule" => (Vector3::z() * 0.5 * number(&shape, "length")?, number(&shape, "radius")?),
                "box" => around_box(&(Vector3::from(triple(&shape, "size")?) * 0.5)),
                _ => continue,
            };
            let mm = |at: Vector3<f64>| (from_shape * Point3::from(at) * 1e3).coords.into();
            let capsule =
                CapsuleDescription { link: number_of, a_mm: mm(-half), b_mm: mm(half), radius_mm: radius * 1e3 };
            self.capsules.push(capsule);
        }
        if let Some(inertial) = child(link, "inertial")
            && number_of > 0
        {
            self.mass(number_of, &inertial)?;
        }
        Ok(())
    }

    /// Joins the mass with what the link already has: centre of both, moments by Steiner's theorem; products of inertia
    /// are left out.
    fn mass(&mut self, link: usize, inertial: &Node) -> Result<(), UrdfError> {
        let mass = child(inertial, "mass").map_or(Ok(0.0), |node| number(&node, "value"))?;
        let centre = (self.here() * origin(inertial)? * Point3::origin()).coords * 1e3;
        let moments = match child(inertial, "inertia") {
            Some(node) => [number(&node, "ixx")?, number(&node, "iyy")?, number(&node, "izz")?],
            None => [0.0; 3],
        };
        let Some(known) = self.masses.iter_mut().find(|known| known.link == link) else {
            let centre_mm = centre.into();
            self.masses.push(MassDescription { link, mass_kg: mass, centre_mm, inertia_kg_m2: moments });
            return Ok(());
        };
        let whole = known.mass_kg + mass;
        if whole > 0.0 {
            let before = Vector3::from(known.centre_mm);
            let reduced = known.mass_kg * mass / whole;
            let apart = (centre - before) * 1e-3;
            for (axis, moment) in known.inertia_kg_m2.iter_mut().enumerate() {
                *moment += moments[axis] + reduced * (apart.norm_squared() - apart[axis] * apart[axis]);
            }
            known.centre_mm = ((before * known.mass_kg + centre * mass) / whole).into();
            known.mass_kg = whole;
        }
        Ok(())
    }

    fn finish(mut self, name: String) -> Result<ArmDescription, UrdfError> {
        if self.joints.len() != AXES {
            let count = self.joints.len();
            return Err(UrdfError::Chain(format!("the longest chain has {count} turning joints, not six")));
        }
        let limit = |which: usize| std::array::from_fn(|axis| self.limits[axis][which].to_degrees());
        let flange = self.here();
        if self.masses.len() != AXES {
            self.masses.clear();
        }
        Ok(ArmDescription {
            kind: ArmKind::Arm,
            name,
            source: "URDF".into(),
            caveat: String::new(),
            opw: None,
            chain: Some(ChainDescription {
                joints: self.joints.clone(),
                flange_mm: (flange.translation.vector * 1e3).into(),
                flange_rpy_deg: euler(&flange),
            }),
            joints: JointsDescription {
                lower_deg: limit(0),
                upper_deg: limit(1),
                speed_deg_s: limit(2),
                acceleration_deg_s2: None,
            },
            capsules: self.capsules,
            masses: self.masses,
        })
    }
}

/// Roll, pitch, yaw, degrees.
fn euler(pose: &Isometry3<f64>) -> [f64; 3] {
    let q = pose.rotation;
    euler_from_quaternion(&[q.w, q.i, q.j, q.k]).map(f64::to_degrees)
}

/// Half the axis along the longest side, and the radius of the capsule around the box ±`half`.
fn around_box(half: &Vector3<f64>) -> (Vector3<f64>, f64) {
    let long = half.imax();
    let mut along = Vector3::zeros();
    along[long] = half[long];
    // The corners lie this far from the axis' ends.
    (along, (half - along).norm())
}

fn joint<'t>(node: Node<'t, 't>) -> Result<Joint<'t>, UrdfError> {
    let link = |name: &str| {
        let end = node.children().find(|node| node.has_tag_name(name));
        end.and_then(|end| end.attribute("link")).ok_or_else(|| at(&node, &format!("<joint> needs <{name} link=…>")))
    };
    let moves = matches!(attribute(&node, "type")?, "revolute" | "continuous");
    Ok(Joint { node, parent: link("parent")?, child: link("child")?, moves, origin: origin(&node)? })
}

/// From the one link that is no child down to the leaf with the most turning joints; the shortest of these.
fn longest_chain<'j, 't>(joints: &'j [Joint<'t>]) -> Result<Vec<&'j Joint<'t>>, UrdfError> {
    let roots: Vec<&str> = {
        let mut parents: Vec<&str> = joints.iter().map(|joint| joint.parent).collect();
        parents.sort_unstable();
        parents.dedup();
        parents.retain(|parent| joints.iter().all(|joint| joint.child != *parent));
        parents
    };
    let [root] = roots[..] else {
        return Err(UrdfError::Chain(format!("{} links are nobody's child; one root is needed", roots.len())));
    };
    let mut best: Vec<&Joint> = Vec::new();
    let mut open: Vec<(&str, Vec<&Joint>)> = vec![(root, Vec::new())];
    let turning = |chain: &[&Joint]| chain.iter().filter(|joint| joint.moves).count();
    while let Some((link, chain)) = open.pop() {
        if chain.len() > joints.len() {
            return Err(UrdfError::Chain(format!("the links go round in a circle at `{link}`")));
        }
        if turning(&chain) > turning(&best) {
            best = chain.clone();
        }
        for joint in joints.iter().filter(|joint| joint.parent == link) {
            // A gripper's fingers slide; the chain ends before them.
            if joint.moves || joint.node.attribute("type") == Some("fixed") {
                open.push((joint.child, chain.iter().copied().chain([joint]).collect()));
            }
        }
    }
    // Fixed joints behind the last turning one: the flange is where they lead in one line.
    while let Some(last) = best.last().map(|joint| joint.child) {
        let mut next = joints.iter().filter(|joint| joint.parent == last);
        let (Some(only), None) = (next.next(), next.next()) else { break };
        if only.node.attribute("type") != Some("fixed") || best.len() > joints.len() {
            break;
        }
        best.push(only);
    }
    Ok(best)
}

fn at(node: &Node, what: &str) -> UrdfError {
    UrdfError::At { line: node.document().text_pos_at(node.range().start).row, what: what.to_owned() }
}

fn child<'t>(node: &Node<'t, 't>, name: &str) -> Option<Node<'t, 't>> {
    node.children().find(|child| child.has_tag_name(name))
}

fn attribute<'t>(node: &Node<'t, 't>, name: &str) -> Result<&'t str, UrdfError> {
    node.attribute(name).ok_or_else(|| at(node, &format!("<{}> needs {name}", node.tag_name().name())))
}

fn number(node: &Node, name: &str) -> Result<f64, UrdfError> {
    let text = node.attribute(name).ok_or_else(|| at(node, &format!("<{}> needs {name}", node.tag_name().name())))?;
    let parsed = text.trim().parse().ok().filter(|value: &f64| value.is_finite());
    parsed.ok_or_else(|| at(node, &format!("{name} = \"{text}\" is no number")))
}

fn triple(node: &Node, name: &str) -> Result<[f64; 3], UrdfError> {
    let text = node.attribute(name).unwrap_or("0 0 0");
    let numbers: Vec<f64> = text.split_whitespace().filter_map(|word| word.parse().ok()).collect();
    match numbers[..] {
        [x, y, z] if x.is_finite() && y.is_finite() && z.is_finite() => Ok([x, y, z]),
        _ => Err(at(node, &format!("{name} = \"{text}\" are no three numbers"))),
    }
}

fn origin(node: &Node) -> Result<Isometry3<f64>, UrdfError> {
    let Some(origin) = node.children().find(|child| child.has_tag_name("origin")) else {
        return Ok(Isometry3::identity());
    };
    let [roll, pitch, yaw] = triple(&origin, "rpy")?;
    let rotation = unit_quaternion(&quaternion_from_euler(roll, pitch, yaw));
    Ok(Isometry3::from_parts(Translation3::from(Vector3::from(triple(&origin, "xyz")?)), rotation))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The IRB 120 as its xacro file puts it, with a fixed world link, a tool frame and fingers that slide.
    fn irb120() -> String {
        let joint = |k: usize, parent: &str, kind: &str, xyz: &str, axis: &str, limit: [f64; 3]| {
            let [lower, upper, velocity] = limit.map(f64::to_radians);
            format!(
                "<joint name='joint_{k}' type='{kind}'><parent link='{parent}'/><child link='link_{k}'/><origin xyz='{xyz}' rpy='0 0 0'/>\
                 <axis xyz='{axis}'/><limit lower='{lower}' upper='{upper}' velocity='{velocity}' effort='0'/></joint>\n<link name='link_{k}'/>\n"
            )
        };
        format!(
            "<?xml version='1.0'?>\n<robot name='abb'>\n<link name='world'/><link name='base'><collision><geometry>\
             <cylinder radius='0.09' length='0.1'/></geometry></collision></link>\n<joint name='w' type='fixed'><parent link='world'/>\
             <child link='base'/><origin xyz='0 0 0'/></joint>\n{}{}{}{}{}{}\
             <joint name='t' type='fixed'><parent link='link_6'/><child link='tool0'/><origin xyz='0.072 0 0' rpy='0 1.5707963267948966 0'/></joint>\
             <link name='tool0'/></robot>",
            joint(1, "base", "revolute", "0 0 0.29", "0 0 1", [-165.0, 165.0, 250.0]),
            joint(2, "link_1", "revolute", "0 0 0", "0 1 0", [-110.0, 110.0, 250.0]),
            joint(3, "link_2", "revolute", "0 0 0.27", "0 1 0", [-110.0, 70.0, 250.0]),
            joint(4, "link_3", "revolute", "0 0 0.07", "1 0 0", [-160.0, 160.0, 320.0]),
            joint(5, "link_4", "revolute", "0.302 0 0", "0 1 0", [-120.0, 120.0, 320.0]),
            joint(6, "link_5", "revolute", "0 0 0", "1 0 0", [-400.0, 400.0, 420.0]),
        )
    }

    #[test]
    fn the_same_arm_as_the_shipped_file() {
        let read = read_urdf(&irb120()).unwrap();
        assert_eq!((read.name.as_str(), read.capsules.len(), read.masses.len()), ("abb", 1, 0));
        let ours = read.build().unwrap();
        let shipped = crate::scenario::arm_for("irb120").unwrap();
        for i in 0..50 {
            let q: [f64; 6] = std::array::from_fn(|k| f64::from(i * (k as i32 + 3) % 17) * 0.1 - 0.7);
            let difference = (ours.forward(&q).to_homogeneous() - shipped.forward(&q).to_homogeneous()).amax();
            assert!(difference < 1e-12, "{difference} at {q:?}");
        }
        for (a, b) in ours.limits.iter().zip(&shipped.limits) {
            assert!((a.lower - b.lower).abs() + (a.upper - b.upper).abs() + (a.speed - b.speed).abs() < 1e-12);
        }
    }

    #[test]
    fn what_is_no_arm_is_told_with_its_line() {
        let text = irb120();
        let five = text.replace("name='joint_6' type='revolute'", "name='joint_6' type='fixed'");
        assert_eq!(read_urdf(&five).unwrap_err().to_string(), "the longest chain has 5 turning joints, not six");
        assert!(matches!(read_urdf("<robot"), Err(UrdfError::Xml(_))));
        let nan = text.replacen("velocity='4.", "velocity='x4.", 1);
        assert!(
            read_urdf(&nan).unwrap_err().to_string().starts_with("line 5: velocity = \"x4."),
            "{:?}",
            read_urdf(&nan)
        );
        let two =
            text.replace("<parent link='world'/>", "<parent link='elsewhere'/>").replace("<link name='world'/>", "");
        assert!(read_urdf(&two).is_ok(), "an undeclared root is still one root");
        let split = text.replace("<parent link='link_2'/>", "<parent link='nowhere'/>");
        assert!(read_urdf(&split).unwrap_err().to_string().contains("one root"));
    }

    #[test]
    fn masses_of_joined_links_are_joined() {
        let inertial = |kg: f64, x: f64| {
            format!(
                "<inertial><origin xyz='{x} 0 0'/><mass value='{kg}'/><inertia ixx='0.1' iyy='0.1' izz='0.1'/></inertial>"
            )
        };
        let mut text = irb120();
        for k in 1..=6 {
            text = text.replace(
                &format!("<link name='link_{k}'/>"),
                &format!("<link name='link_{k}'>{}</link>", inertial(2.0, 0.0)),
            );
        }
        text = text.replace("<link name='tool0'/>", &format!("<link name='tool0'>{}</link>", inertial(2.0, 0.0)));
        let masses = read_urdf(&text).unwrap().masses;
        let last = masses.iter().find(|mass| mass.link == 6).unwrap();
        assert_eq!((masses.len(), last.mass_kg), (6, 4.0));
        assert!((last.centre_mm[0] - 36.0).abs() < 1e-9);
        // Two equal masses 72 mm apart: 2 · 2 kg · (36 mm)² across, nothing along.
        assert!((last.inertia_kg_m2[0] - 0.2).abs() < 1e-12);
        assert!((last.inertia_kg_m2[2] - 0.2 - 4.0 * 0.036 * 0.036).abs() < 1e-12);
    }
}
