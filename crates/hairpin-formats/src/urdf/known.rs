//! The elements and attributes that a URDF may have. What is on no list is refused with its line: a body that is passed
//! over would be clear of everything, a turn that is passed over would put it elsewhere.

use roxmltree::Node;

use super::element::{UrdfError, at, told};

/// Elements that are read, their attributes, and what may be in them.
const READ: [(&str, &[&str], &[&str]); 18] = [
    (
        "robot",
        &["name", "version"],
        &["link", "joint", "material", "transmission", "gazebo", "ros2_control", "sensor", "mujoco"],
    ),
    (
        "link",
        &["name", "type"],
        &["inertial", "collision", "visual", "material", "contact", "gazebo", "gravity", "self_collision_checking"],
    ),
    (
        "joint",
        &["name", "type", "dont_collapse"],
        &[
            "origin",
            "parent",
            "child",
            "axis",
            "limit",
            "mimic",
            "dynamics",
            "joint_properties",
            "calibration",
            "safety_controller",
            "controller_gains",
            "traits",
            "gazebo",
        ],
    ),
    ("collision", &["name", "group"], &["origin", "geometry", "verbose", "contact_coefficients", "material"]),
    ("geometry", &[], &["box", "sphere", "cylinder", "capsule", "mesh"]),
    ("box", &["name", "size"], &[]),
    ("sphere", &["name", "radius"], &[]),
    ("cylinder", &["name", "radius", "length"], &[]),
    ("capsule", &["name", "radius", "length"], &[]),
    ("mesh", &["name", "filename", "scale"], &[]),
    ("origin", &["xyz", "rpy"], &[]),
    ("inertial", &["name"], &["origin", "mass", "inertia"]),
    ("mass", &["value"], &[]),
    ("inertia", &["ixx", "ixy", "ixz", "iyy", "iyz", "izz"], &[]),
    ("axis", &["xyz"], &[]),
    ("limit", &["lower", "upper", "velocity", "effort", "acceleration", "deceleration", "jerk", "command_effort"], &[]),
    ("mimic", &["joint", "multiplier", "offset"], &[]),
    // Parent and child alike.
    ("parent", &["link"], &[]),
];

/// Elements of which there may be several in one; of others that are read the second would be passed over.
const SEVERAL: [&str; 3] = ["link", "joint", "collision"];

/// What is read of an element: its attributes and what may be in it. `None`: nothing is, whatever it holds.
fn read_of(name: &str) -> Option<(&'static [&'static str], &'static [&'static str])> {
    let name = if name == "child" { "parent" } else { name };
    READ.iter().find(|(known, ..)| *known == name).map(|(_, attributes, inside)| (*attributes, *inside))
}

/// Whether all of a robot is known.
///
/// # Errors
/// An element or attribute on no list; a second one where one is read; anything of xacro, wherever it stands.
pub(super) fn all_known(robot: &Node) -> Result<(), UrdfError> {
    let of_xacro = |node: &Node| node.tag_name().namespace().is_some_and(|space| space.contains("xacro"));
    if let Some(node) = robot.descendants().find(of_xacro) {
        return Err(at(&node, "is a xacro file: `xacro FILE.xacro > FILE.urdf` makes the URDF of it"));
    }
    known(robot, robot)
}

/// The lists end after few levels, and so does this.
fn known(node: &Node, robot: &Node) -> Result<(), UrdfError> {
    let name = node.tag_name().name();
    let Some((attributes, inside)) = read_of(name) else { return Ok(()) };
    for attribute in node.attributes() {
        let fine = match attribute.namespace() {
            // A root may say where its schema is.
            Some(_) => node == robot,
            None => attributes.contains(&attribute.name()),
        };
        if !fine {
            let what = format!("{} is no attribute of <{name}> that is read", told(attribute.name()));
            let line = node.document().text_pos_at(attribute.range().start).row;
            return Err(UrdfError::At { line, span: attribute.range(), what });
        }
    }
    let mut once: Vec<&str> = Vec::new();
    for child in node.children().filter(Node::is_element) {
        let (own, space) = (child.tag_name().name(), child.tag_name().namespace());
        if space != robot.tag_name().namespace() || !inside.contains(&own) {
            let own = told(own);
            return Err(at(
                &child,
                &match name {
                    "geometry" => format!("<{own}> is no shape of URDF"),
                    _ => format!("<{own}> in <{name}> is not known, and what it holds would be left out"),
                },
            ));
        }
        if name == "geometry" && !once.is_empty() {
            return Err(at(&child, "a second shape in one <geometry>: each needs a <collision> of its own"));
        }
        if once.contains(&own) {
            return Err(at(&child, &format!("a second <{own}> in one <{name}>: which of them holds is not said")));
        }
        if !SEVERAL.contains(&own) && read_of(own).is_some() {
            once.push(own);
        }
        known(&child, robot)?;
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::super::element::parse;
    use super::super::srdf::root_of;
    use super::*;

    const BODY: &str = "<collision><geometry><sphere radius='0.1'/></geometry></collision>";

    /// What is said of a robot with a joint whose origin has `turned`, and a link with `inside`.
    fn told_of(turned: &str, inside: &str, more: &str) -> Result<(), String> {
        let text = format!(
            "<robot name='r' xmlns:xacro='http://ros.org/wiki/xacro'>\n<joint name='j' type='fixed'><origin xyz='0 0 1'{turned}/>\
             <parent link='a'/><child link='b'/></joint>\n<link name='b'>{inside}</link>\n{more}</robot>"
        );
        let document = parse(&text).unwrap();
        let robot = root_of(&document).unwrap();
        all_known(&robot).map_err(|error| error.to_string())
    }

    /// Left out, each of these would pass: a body that nothing meets, a turn that nobody makes.
    #[test]
    fn what_is_on_no_list_is_refused_with_its_line() {
        let second = |before: &str, more: &str| BODY.replacen(before, &format!("{more}{before}"), 1);
        for (inside, why) in [
            (second("</geometry>", "<box size='1 1 1'/>"), "a second shape in one <geometry>"),
            (second("<geometry>", "<origin/><origin/>"), "a second <origin> in one <collision>"),
            (second(" radius", " diameter='1'"), "diameter is no attribute of <sphere>"),
            (BODY.replace("sphere", "cone"), "<cone> is no shape of URDF"),
            (BODY.replace("collision", "collison"), "<collison> in <link> is not known"),
            ("<x:collision xmlns:x='y'/>".into(), "<collision> in <link> is not known"),
            ("<xacro:rod length='0.4'/>".into(), "is a xacro file"),
            ("<visual><xacro:if value='1'/></visual>".into(), "is a xacro file"),
        ] {
            let error = told_of("", &inside, "").unwrap_err();
            assert!(error.starts_with("line 3: ") && error.contains(why), "{error}");
        }
        let group = format!("<group><link name='hand'>{BODY}</link></group>");
        for (more, element) in [(&*group, "group"), ("<robot name='hand'/>", "robot"), ("<include/>", "include")] {
            let error = told_of("", "", more).unwrap_err();
            assert!(error.starts_with(&format!("line 4: <{element}> in <robot> is not known")), "{error}");
        }
        let error = told_of(" quat_xyzw='0 0 0.7 0.7'", "", "").unwrap_err();
        assert_eq!(error, "line 2: quat_xyzw is no attribute of <origin> that is read");
    }

    #[test]
    fn what_is_not_read_may_hold_anything() {
        let inside = format!("{BODY}{BODY}<visual><geometry><cone/></geometry></visual><contact><a b='1'/></contact>");
        assert_eq!(told_of(" rpy='0 0 1'", &inside, "<gazebo><x:y xmlns:x='z'/></gazebo><ros2_control/>"), Ok(()));
    }
}
