mod followers;

use nalgebra::Point3;

use super::*;
use hairpin::robot::arm::{Arm, ArmDescription, Outline};

fn nowhere(_: &str) -> Result<Triangles, NoMesh> {
    Err(NoMesh::Missing("no mesh is there".into()))
}

fn read(text: &str) -> Result<UrdfArm, UrdfError> {
    read_urdf(text, &UrdfOptions::default(), &nowhere)
}

fn arm(text: &str) -> (ArmDescription, Arm) {
    let description = read(text).unwrap().description;
    let built = description.build().unwrap();
    (description, built)
}

fn told(text: &str) -> String {
    read(text).unwrap_err().to_string()
}

/// The IRB 120 as its xacro file puts it, with a fixed world link and a tool frame.
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

/// With more joints and links in it.
fn with(more: &str) -> String {
    irb120().replace("</robot>", &format!("{more}</robot>"))
}

fn joint(name: &str, kind: &str, parent: &str, child: &str, more: &str) -> String {
    format!(
        "<joint name='{name}' type='{kind}'><parent link='{parent}'/><child link='{child}'/>{more}</joint><link name='{child}'/>"
    )
}

const LIMIT: &str = "<limit lower='0' upper='0.8' velocity='2' effort='20'/>";

#[test]
fn the_same_arm_as_the_shipped_file() {
    let (read, ours) = arm(&irb120());
    assert_eq!((read.name.as_str(), read.hulls.len(), read.masses.len()), ("abb", 1, 0));
    let shipped = crate::scenario::arm_for("irb120").unwrap();
    for i in 0..50 {
        let q: [f64; 6] = std::array::from_fn(|k| f64::from(i * (k as i32 + 3) % 17) * 0.1 - 0.7);
        let difference = (ours.forward(&q).to_homogeneous() - shipped.forward(&q).to_homogeneous()).amax();
        assert!(difference < 1e-12, "{difference} at {q:?}");
    }
    for (a, b) in ours.limits.iter().zip(&shipped.limits) {
        assert!((a.lower - b.lower).abs() + (a.upper - b.upper).abs() + (a.speed - b.speed).abs() < 1e-12);
    }
    // Where one link has a shape, the others have stand-ins, each named.
    assert_eq!(ours.links[0].outline, Outline::Given);
    assert!(ours.links[1..].iter().all(|link| link.outline == Outline::StandIn && link.capsules.len() == 1));
    for link in 1..=6 {
        let sentence = format!("link {link} (`link_{link}`");
        assert!(ours.estimated.iter().any(|said| said.starts_with(&sentence)), "{:?}", ours.estimated);
    }
}

#[test]
fn what_is_no_arm_is_told_with_its_line() {
    let text = irb120();
    let five = text.replace("name='joint_6' type='revolute'", "name='joint_6' type='fixed'");
    assert_eq!(told(&five), "the longest chain has 5 turning joints, not six");
    assert!(matches!(read("<robot"), Err(UrdfError::Xml { .. })));
    let nan = text.replacen("velocity='4.", "velocity='x4.", 1);
    assert!(told(&nan).starts_with("line 5: velocity = \"x4."), "{}", told(&nan));
    let two = text.replace("<parent link='world'/>", "<parent link='elsewhere'/>").replace("<link name='world'/>", "");
    assert!(read(&two).is_ok(), "an undeclared root is still one root");
    let split = text.replace("<parent link='link_2'/>", "<parent link='nowhere'/>");
    assert!(told(&split).contains("one root"));
    let round = text.replace("<parent link='world'/>", "<parent link='tool0'/>").replace("<link name='world'/>", "");
    assert!(told(&round).contains("one root") || told(&round).contains("circle"), "{}", told(&round));
    let zero = text.replacen("lower='-2.8797932657906435' upper='2.8797932657906435'", "lower='0' upper='0'", 1);
    assert!(told(&zero).starts_with("line 5: joint `joint_1`: lower and upper are 0"), "{}", told(&zero));
    let flat = text.replacen("axis xyz='0 0 1'", "axis xyz='0 0 0'", 1);
    assert!(told(&flat).contains("is no direction"), "{}", told(&flat));
    let long = with(&joint(&"n".repeat(300), "fixed", "tool0", "x", ""));
    assert!(told(&long).contains("a name of 300 bytes"), "{}", told(&long));
    let xacro = "<robot xmlns:xacro='http://ros.org/wiki/xacro'><xacro:macro name='m'/></robot>";
    assert!(told(xacro).contains("is a xacro file"));
}

#[test]
fn a_flange_is_found_by_name_or_asked_for() {
    let camera = joint("c", "fixed", "link_6", "camera", "<origin xyz='0.03 0 0.05'/>");
    let (with_camera, _) = arm(&with(&camera));
    assert_eq!(with_camera.chain, arm(&irb120()).0.chain);
    let nameless = with(&camera).replace("'tool0'", "'ee_link'");
    let asked = told(&nameless);
    assert!(asked.contains("`ee_link`") && asked.contains("`camera`") && asked.contains("tip = "), "{asked}");
    let tip = |link: &str| UrdfOptions { tip: Some(link.into()), ..UrdfOptions::default() };
    let read = read_urdf(&nameless, &tip("ee_link"), &nowhere).unwrap();
    assert_eq!(read.description.chain, with_camera.chain);
    let camera = read_urdf(&nameless, &tip("camera"), &nowhere).unwrap().description.chain.unwrap();
    assert_eq!(camera.flange_mm, [30.0, 0.0, 50.0]);
    for (link, why) in [("link_5", "5 joints turn"), ("nothing", "no link is called so")] {
        let error = read_urdf(&nameless, &tip(link), &nowhere).unwrap_err().to_string();
        assert!(error.contains(why), "{error}");
    }
    // The last part of a name says it as well; of tool0 and flange it is tool0.
    let both = with(&joint("f", "fixed", "link_6", "arm_flange", "")).replace("'tool0'", "'arm_tool0'");
    assert_eq!(arm(&both).0.chain, with_camera.chain);
}

#[test]
fn grippers_are_held_and_seventh_axes_asked_about() {
    let jaws = |mimic: &str| {
        joint("left", "revolute", "tool0", "left_finger", LIMIT)
            + &joint("right", "revolute", "tool0", "right_finger", &format!("{LIMIT}{mimic}"))
    };
    for mimic in ["<mimic joint='left'/>", ""] {
        assert_eq!(arm(&with(&jaws(mimic))).0.chain, arm(&irb120()).0.chain);
    }
    let box_ = "<collision><geometry><box size='0.02 0.04 0.06'/></geometry></collision>";
    let finger = with(&jaws("<mimic joint='left' multiplier='-1' offset='0.1'/>"))
        .replace("<link name='left_finger'/>", &format!("<link name='left_finger'>{box_}</link>"));
    let (held, built) = arm(&finger);
    assert_eq!(
        (held.hulls.len(), held.hulls[1].link, built.links[6].outline),
        (2, 6, Outline::Around(held.hulls[1].larger_mm * 1e-3))
    );
    assert!(held.estimates.iter().any(|said| said == "link 6 (`left_finger`) held at rest"), "{:?}", held.estimates);
    // Nothing says that a seventh joint in a row is a finger's, unless the flange has its name.
    let seven = with(&joint("joint_7", "revolute", "tool0", "link_7", LIMIT));
    assert!(read(&seven).is_ok());
    assert!(told(&seven.replace("'tool0'", "'mount'")).contains("a seventh joint turns, `joint_7`"));
    // A finger that another follows is no sixth axis.
    let five = irb120().replace("name='joint_6' type='revolute'", "name='joint_6' type='fixed'");
    let five = five.replace("</robot>", &(jaws("<mimic joint='left'/>") + "</robot>"));
    assert!(told(&five).starts_with("5 joints turn before `left`, which another one follows"), "{}", told(&five));
}

#[test]
fn what_slides_before_the_arm_is_named() {
    let rail = irb120().replace("name='w' type='fixed'", "name='rail' type='prismatic'");
    let error = told(&rail);
    assert!(
        error.starts_with("line 4: joint `rail` slides (prismatic)") && error.contains("base = \"base\""),
        "{error}"
    );
    let base = UrdfOptions { base: Some("base".into()), ..UrdfOptions::default() };
    assert_eq!(read_urdf(&rail, &base, &nowhere).unwrap().description.chain, arm(&irb120()).0.chain);
    let floating = irb120().replace("name='w' type='fixed'", "name='w' type='floating'");
    assert!(told(&floating).contains("joint `w` floats"));
    let hung = irb120().replace(
        "<axis xyz='1 0 0'/><limit lower='-2.79",
        "<axis xyz='1 0 0'/><mimic joint='joint_3'/><limit lower='-2.79",
    );
    let words = "the longest chain has 5 turning joints, not six; on its way joint `joint_4` follows another (mimic)";
    assert!(told(&hung).starts_with("line ") && told(&hung).ends_with(words), "{}", told(&hung));
    // One that slides, or floats, in the place of an axis; of the last the flange's name says that it is before that.
    for (joint, kind, moves) in
        [("joint_3", "prismatic", "slides (prismatic)"), ("joint_6", "planar", "floats, or moves in a plane")]
    {
        let other =
            irb120().replace(&format!("name='{joint}' type='revolute'"), &format!("name='{joint}' type='{kind}'"));
        let words = format!("5 turning joints, not six; on its way joint `{joint}` {moves}");
        assert!(told(&other).starts_with("line ") && told(&other).ends_with(&words), "{}", told(&other));
    }
}

#[test]
fn continuous_joints_need_no_limit() {
    let text = irb120();
    let from = text.find("<limit lower='-6.98").unwrap();
    let end = from + text[from..].find("/>").unwrap() + 2;
    let free = text
        .replace(&text[from..end], "")
        .replace("name='joint_6' type='revolute'", "name='joint_6' type='continuous'");
    let (read, built) = arm(&free);
    assert_eq!((read.joints.lower_deg[5], read.joints.upper_deg[5]), (-3600.0, 3600.0));
    assert!(built.estimated.iter().any(|said| said.contains("speed of joint `joint_6`")), "{:?}", built.estimated);
    let bare = text.replace(&text[from..end], "");
    assert!(told(&bare).contains("joint `joint_6` turns and needs <limit>"), "{}", told(&bare));
}

/// A controller that obeys softer limits stops short of what is planned.
#[test]
fn narrower_bounds_of_a_safety_controller_are_told() {
    let of = |soft: &str| {
        let text =
            irb120().replacen("<axis xyz='0 0 1'/>", &format!("<axis xyz='0 0 1'/><safety_controller {soft}/>"), 1);
        let (_, built) = arm(&text);
        built.estimated.into_iter().filter(|said| said.contains("safety_controller")).collect::<Vec<_>>()
    };
    let words = "bounds of joint `joint_1`: its <safety_controller> has -114.6° to 165.0°, narrower than they are, and is not kept";
    assert_eq!(of("soft_lower_limit='-2' k_velocity='10'"), [words]);
    assert_eq!(of("soft_lower_limit='-2.88' soft_upper_limit='2.88' k_velocity='10'").len(), 0);
    assert_eq!(of("k_velocity='10'").len(), 0);
    let broken =
        irb120().replacen("<axis xyz='0 0 1'/>", "<axis xyz='0 0 1'/><safety_controller soft_upper_limit='2m'/>", 1);
    assert!(told(&broken).ends_with("soft_upper_limit = \"2m\" is no number"), "{}", told(&broken));
}

#[test]
fn shapes_are_read_as_they_are_described() {
    let shapes = "<collision><origin xyz='0 0 0.5'/><geometry><box size='0.2 0.4 0.6'/></geometry></collision>\
        <collision><geometry><sphere radius='0.1'/></geometry></collision>\
        <collision><geometry><cylinder radius='0.05' length='0.3'/></geometry></collision>";
    let text = irb120().replace("<link name='link_3'/>", &format!("<link name='link_3'>{shapes}</link>"));
    let (read, built) = arm(&text);
    let link = &built.links[3];
    assert_eq!((link.outline, link.capsules.len(), link.hulls.len()), (Outline::Given, 1, 2));
    assert!(link.hulls[0].points.contains(&Point3::new(0.1, -0.2, 0.8)), "{:?}", link.hulls[0].points);
    // Every point of the cylinder's rim lies within the prism: half a percent of the radius at most.
    assert!(
        link.hulls[1].points.iter().all(|p| p.x.hypot(p.y) >= 0.05 && p.x.hypot(p.y) < 0.0503 && p.z.abs() == 0.15)
    );
    assert!(!read.estimates.iter().any(|said| said.contains("link_3")), "{:?}", read.estimates);
    for (bad, why) in [
        ("<box size='0.2 0.4'/>", "are no three numbers"),
        ("<sphere radius='-1'/>", "must be > 0"),
        ("<cone radius='1'/>", "<cone> is no shape of URDF"),
        ("", "needs <geometry>"),
    ] {
        let bad = format!("<link name='link_3'><collision><geometry>{bad}</geometry></collision></link>");
        let error = told(&irb120().replace("<link name='link_3'/>", &bad));
        assert!(error.contains(why), "{error}");
    }
}

#[test]
fn meshes_are_read_where_they_are_and_stood_in_for_where_not() {
    let mesh = |name: &str, scale: &str| {
        let mesh = format!("<mesh filename='{name}'{scale}/>");
        irb120().replace(
            "<link name='link_3'/>",
            &format!(
                "<link name='link_3'><collision><origin xyz='0 0 1'/><geometry>{mesh}</geometry></collision></link>"
            ),
        )
    };
    let corners = vec![[0.0; 3], [100.0, 0.0, 0.0], [0.0, 200.0, 0.0], [0.0, 0.0, 300.0]];
    let find = |name: &str| match name {
        "package://a/b.obj" => Ok((corners.clone(), vec![[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]])),
        "broken.stl" => Err(NoMesh::Broken("broken.stl: is no STL file".into())),
        _ => Err(NoMesh::Missing(format!("{name} is not there"))),
    };
    let read = |text: &str| read_urdf(text, &UrdfOptions::default(), &find);
    let found = read(&mesh("package://a/b.obj", " scale='0.001 0.001 0.001'")).unwrap().description;
    let built = found.build().unwrap();
    assert_eq!((built.links[3].outline, built.links[3].hulls.len()), (Outline::Given, 1));
    let points = &built.links[3].hulls[0].points;
    assert!(points.len() == 4 && points.iter().any(|p| (p - Point3::new(0.0, 0.2, 1.0)).norm() < 1e-12), "{points:?}");
    let stood = read(&mesh("gone.stl", "")).unwrap().description;
    assert_eq!(stood.build().unwrap().links[3].outline, Outline::StandIn);
    let said = stood.estimates.iter().find(|said| said.starts_with("link 3 (`link_3`) is a stand-in"));
    assert!(said.is_some_and(|said| said.contains("gone.stl is not there")), "{:?}", stood.estimates);
    let error = read(&mesh("broken.stl", "")).unwrap_err().to_string();
    assert!(error.starts_with("line 10: broken.stl: is no STL file"), "{error}");
    // Millimetres taken for metres.
    let error = read(&mesh("package://a/b.obj", "")).unwrap_err().to_string();
    assert!(error.contains("larger than 50 m: its unit is another, which scale says"), "{error}");
    // Scaled once too often.
    let error = read(&mesh("package://a/b.obj", " scale='1e-6 1e-6 1e-6'")).unwrap_err().to_string();
    assert!(error.contains("smaller than 1 mm: its unit is another, which scale says"), "{error}");
}

#[test]
fn pairs_are_left_out_by_name_and_by_an_srdf() {
    let pair = |a: &str, b: &str| [a.to_owned(), b.to_owned()];
    let asked = UrdfOptions { exclude: vec![pair("link_4", "base"), pair("link 3", "tool")], ..UrdfOptions::default() };
    assert_eq!(read_urdf(&irb120(), &asked, &nowhere).unwrap().description.exclude, [[0, 4], [3, 7]]);
    let wrong = UrdfOptions { exclude: vec![pair("link_9", "base")], ..UrdfOptions::default() };
    assert!(read_urdf(&irb120(), &wrong, &nowhere).unwrap_err().to_string().contains("link_9"));
    let srdf = "<?xml version='1.0'?><robot name='abb'><disable_collisions link1='base' link2='link_5' reason='Never'/>\
        <disable_collisions link1='link_6' link2='link_3' reason='Never'/></robot>";
    let disabled = read_srdf(srdf).unwrap();
    assert_eq!(disabled, [pair("base", "link_5"), pair("link_6", "link_3")]);
    let options = UrdfOptions { disabled, ..UrdfOptions::default() };
    assert_eq!(read_urdf(&irb120(), &options, &nowhere).unwrap().description.exclude, [[0, 5], [3, 6]]);
    assert!(read_srdf("<robot><disable_collisions link1='a'/></robot>").is_err());
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
    let masses = read(&text).unwrap().description.masses;
    let last = masses.iter().find(|mass| mass.link == 6).unwrap();
    assert_eq!((masses.len(), last.mass_kg), (6, 4.0));
    assert!((last.centre_mm[0] - 36.0).abs() < 1e-9);
    // Two equal masses 72 mm apart: 2 · 2 kg · (36 mm)² across, nothing along.
    assert!((last.inertia_kg_m2[0] - 0.2).abs() < 1e-12);
    assert!((last.inertia_kg_m2[2] - 0.2 - 4.0 * 0.036 * 0.036).abs() < 1e-12);
}

/// Principal moments keep the triangle inequality, within what the last digits leave open.
#[test]
fn tensors_that_no_body_has_are_refused() {
    let told_of = |inertia: &str| {
        let mut text = irb120();
        for k in 1..=6 {
            let inertia = if k == 3 { inertia } else { "ixx='0.1' iyy='0.1' izz='0.1'" };
            let link = format!("<link name='link_{k}'/>");
            let inertial = format!("<inertial><mass value='2'/><inertia {inertia}/></inertial>");
            text = text.replace(&link, &format!("<link name='link_{k}'>{inertial}</link>"));
        }
        match read(&text) {
            Ok(read) => read.description.estimates.into_iter().find(|said| said.contains("no body has them")),
            Err(error) => Some(format!("refused: {error}")),
        }
    };
    for possible in [
        "ixx='0.1' iyy='0.2' izz='0.3'",
        "ixx='0.1' iyy='0.2' izz='0.3' ixy='0' ixz='0' iyz='0'",
        // A rod, and small parts to three decimals or in powers of ten.
        "ixx='0.02' iyy='0.02' izz='0'",
        "ixx='0.000' iyy='0.000' izz='0.001'",
        "ixx='1.0E-05' iyy='1.1E-05' izz='2.2E-05' ixy='0.1e-5'",
        "ixx='0' iyy='0' izz='0' ixy='1e-20'",
    ] {
        assert_eq!(told_of(possible), None, "{possible}");
    }
    let rod = told_of("ixx='0.001' iyy='0.001' izz='5'").unwrap();
    let words = "link `link_3`: principal moments of inertia 1.0000e-3, 1.0000e-3, 5.0000e0 kg m²: no body has them";
    assert!(rod.starts_with("refused: line ") && rod.contains(words), "{rod}");
    // Neither is one with a negative principal moment, however harmless its diagonal.
    let product = told_of("ixx='0.01' iyy='0.01' izz='0.01' ixy='0.5'").unwrap();
    assert!(product.starts_with("refused: line ") && product.contains("-4.9000e-1, "), "{product}");
    // Published arms and hands are a little beyond, and are told.
    for nearly in
        ["ixx='0.1001' iyy='0.2002' izz='0.3106'", "ixx='0.00730620018' iyy='0.00429974291' izz='0.00202306691'"]
    {
        let said = told_of(nearly).unwrap();
        assert!(said.starts_with("link `link_3`: principal moments"), "{said}");
    }
}

/// What is joined to a link hides nothing: each link's mass and moments are held to their bounds.
#[test]
fn negative_masses_are_refused_where_they_stand() {
    let inertial = |kg: f64, moment: f64| {
        format!("<inertial><mass value='{kg}'/><inertia ixx='0.1' iyy='{moment}' izz='0.1'/></inertial>")
    };
    let told_of = |kg: f64, moment: f64| {
        let mut text = irb120();
        for k in 1..=6 {
            let link = format!("<link name='link_{k}'/>");
            text = text.replace(&link, &format!("<link name='link_{k}'>{}</link>", inertial(2.0, 0.1)));
        }
        let last = format!("<link name='tool0'>{}</link>", inertial(kg, moment));
        read(&text.replace("<link name='tool0'/>", &last)).err().map(|error| error.to_string())
    };
    assert_eq!(told_of(0.0, 0.0), None);
    let error = told_of(-1.5, 0.1).unwrap();
    assert!(error.contains("link `tool0`: value = -1.5: must be a mass, kg, of at least 0"), "{error}");
    let error = told_of(1.0, -0.05).unwrap();
    assert!(error.contains("link `tool0`: iyy = -0.05: must be a moment of inertia"), "{error}");
}

#[test]
fn many_joints_take_time_in_proportion() {
    let started = std::time::Instant::now();
    let mut more = String::new();
    let mut parent = "tool0".to_owned();
    for k in 0..50_000 {
        let child = format!("x{k}");
        // Half in one line, half beside one another.
        more += &joint(&format!("f{k}"), "fixed", if k < 25_000 { &parent } else { "link_2" }, &child, "");
        parent = child;
    }
    assert!(read(&with(&more)).is_ok());
    let nested = format!("<robot>{}{}</robot>", "<a>".repeat(50_000), "</a>".repeat(50_000));
    assert!(read(&nested).is_err());
    // Quadratic was 42 s.
    assert!(started.elapsed().as_secs() < 15, "{:?}", started.elapsed());
}

#[test]
fn degrees_are_told_from_radians_where_they_can_be() {
    let degrees = irb120().replacen(&format!("lower='{}'", (-165.0_f64).to_radians()), "lower='-165'", 1);
    let error = told(&degrees);
    assert!(
        error.contains("lower = -165") && error.contains("URDF has radians, 63 at most; are these degrees?"),
        "{error}"
    );
}

/// A tensor that is turned is the one in the link's axes, and where one link has none, that no torques are counted is
/// told.
#[test]
fn moments_are_turned_and_missing_ones_told() {
    let inertial = "<inertial><origin xyz='0 0 0' rpy='0 0 1.5707963267948966'/><mass value='2'/>\
                    <inertia ixx='0.1' ixy='0.01' iyy='0.2' izz='0.3'/></inertial>";
    let mut text = irb120();
    for k in 1..=6 {
        let link = format!("<link name='link_{k}'/>");
        text = text.replace(&link, &format!("<link name='link_{k}'>{inertial}</link>"));
    }
    let mass = read(&text).unwrap().description.masses[0];
    let off = |a: [f64; 3], b: [f64; 3]| (0..3).map(|k| (a[k] - b[k]).abs()).fold(0.0, f64::max);
    assert!(off(mass.inertia_kg_m2, [0.2, 0.1, 0.3]) < 1e-12, "{mass:?}");
    assert!(off(mass.products_kg_m2, [-0.01, 0.0, 0.0]) < 1e-12, "{mass:?}");
    // What is fixed to a link, a quarter about y from it, turns with it: 72 mm on, of the same mass.
    text = text.replace("<link name='tool0'/>", &format!("<link name='tool0'>{inertial}</link>"));
    let last = *read(&text).unwrap().description.masses.iter().find(|mass| mass.link == 6).unwrap();
    let across = 4.0 * 0.036 * 0.036;
    assert!(off(last.inertia_kg_m2, [0.2 + 0.3, 0.1 + 0.1 + across, 0.3 + 0.2 + across]) < 1e-12, "{last:?}");
    let bare = text.replacen(inertial, "", 1);
    let read = read(&bare).unwrap().description;
    let told = "joint effort is of accelerations, not of torques: link 1 (`link_1`) has no <inertial>";
    assert!(read.masses.is_empty() && read.estimates.iter().any(|said| said == told), "{:?}", read.estimates);
}

/// `no_body` beside a URDF did nothing, and shapes of one link took those of all others away.
#[test]
fn what_a_table_says_of_links_goes_before_stand_ins_and_shapes() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("six.urdf"), irb120()).unwrap();
    let path = folder.path().join("my_arm.toml");
    let of = |more: &str| {
        std::fs::write(&path, format!("kind = \"arm\"\nurdf = \"six.urdf\"\n{more}")).unwrap();
        crate::scenario::arm_for(&path.display().to_string()).unwrap()
    };
    let stand_ins =
        |arm: &Arm| -> Vec<usize> { (0..7).filter(|link| arm.links[*link].outline == Outline::StandIn).collect() };
    let named = |arm: &Arm, link: usize| arm.estimated.iter().any(|said| said.starts_with(&format!("link {link} ")));
    let plain = of("");
    assert_eq!(stand_ins(&plain), [1, 2, 3, 4, 5, 6]);
    let without = of("no_body = [1, 5]\n");
    assert_eq!(stand_ins(&without), [2, 3, 4, 6]);
    assert!(without.links[1].capsules.is_empty() && without.links[5].capsules.is_empty());
    assert!(!named(&without, 1) && !named(&without, 5) && named(&without, 2), "{:?}", without.estimated);
    // The base keeps the hull of its cylinder.
    let shaped = of("capsules = [{ link = 3, a_mm = [0, 0, 0], b_mm = [0, 0, 80], radius_mm = 50 }]\n");
    assert_eq!(stand_ins(&shaped), [1, 2, 4, 5, 6]);
    assert_eq!((shaped.links[3].outline, shaped.links[3].capsules.len()), (Outline::Given, 1));
    assert_eq!((&shaped.links[0], named(&shaped, 3)), (&plain.links[0], false));
    // Of the base that is given anew nothing else is left.
    let base = of("capsules = [{ link = 0, a_mm = [0, 0, 0], b_mm = [0, 0, 80], radius_mm = 90 }]\n");
    assert_eq!((base.links[0].hulls.len(), base.links[0].capsules.len()), (0, 1));
}

#[test]
fn programs_count_from_the_makers_base() {
    let counts = |text: &str| {
        let (description, built) = arm(text);
        let chain = description.chain.unwrap();
        let back = built.base_from_controller;
        assert!((back.translation.vector * 1e3 - nalgebra::Vector3::from(chain.controller_mm)).norm() < 1e-9);
        (chain.controller_mm, chain.controller_rpy_deg)
    };
    // As packages of Universal Robots have it: beside the root, turned by half a turn.
    let leaf = |name: &str, under: &str, origin: &str| {
        let fixed = format!("<origin {origin}/>");
        joint(&format!("to_{name}"), "fixed", under, name, &fixed)
    };
    let rooted = irb120().replace("'base'", "'base_link'");
    let turned = "xyz='0 0 0' rpy='0 0 3.141592653589793'";
    let (at, by) = counts(&rooted.replace("</robot>", &(leaf("base", "base_link", turned) + "</robot>")));
    assert!(at == [0.0; 3] && (by[2].abs() - 180.0).abs() < 1e-9 && by[0].abs().max(by[1].abs()) < 1e-9, "{by:?}");
    // Of one of two arms by the prefix that it has; what another arm counts from is nothing to it.
    let lifted = "xyz='0 0 -0.3'";
    let left = rooted.replace("'base_link'", "'left_base_link'");
    let both = leaf("base", "left_base_link", turned) + &leaf("left_base", "left_base_link", lifted);
    assert_eq!(counts(&left.replace("</robot>", &(both + "</robot>"))).0, [0.0, 0.0, -300.0]);
    // On a pedestal nothing of which a controller knows.
    let raised = rooted.replace("<origin xyz='0 0 0'/></joint>", "<origin xyz='0 0.5 0.8'/></joint>");
    assert_eq!(counts(&raised), ([0.0, 500.0, 800.0], [0.0; 3]));
    // What slides under the arm, or has no such name, moves nothing.
    assert_eq!(counts(&irb120()), ([0.0; 3], [0.0; 3]));
    let plain = raised.replace("base_link", "stand");
    assert_eq!(counts(&plain), ([0.0; 3], [0.0; 3]));
}

/// As ROS takes it: without a mass there is none. What no arm does is told.
#[test]
fn masses_that_are_no_masses_and_speeds_that_no_arm_has_are_told() {
    let link = |k: usize, inner: &str| {
        let inertial = format!("<inertial>{inner}<inertia ixx='0.1' iyy='0.1' izz='0.1'/></inertial>");
        (format!("<link name='link_{k}'/>"), format!("<link name='link_{k}'>{inertial}</link>"))
    };
    let with_masses = |third: &str| {
        (1..=6).fold(irb120(), |text, k| {
            let (bare, whole) = link(k, if k == 3 { third } else { "<mass value='2'/>" });
            text.replace(&bare, &whole)
        })
    };
    assert_eq!(arm(&with_masses("<mass value='2'/>")).0.masses.len(), 6);
    let (without, _) = arm(&with_masses(""));
    let told = |words: &str| without.estimates.iter().any(|said| said.contains(words));
    assert!(without.masses.is_empty() && told("link `link_3`: its <inertial> without <mass> counts as none"));
    assert!(told("link 3 (`link_3`) has no <inertial>"), "{:?}", without.estimates);
    let (fast, _) = arm(&irb120().replacen(&format!("velocity='{}'", 250_f64.to_radians()), "velocity='250'", 1));
    let words = "speed of joint `joint_1`: 250 rad/s, no arm's (63 at most): in degrees?";
    assert!(fast.estimates.iter().any(|said| said == words), "{:?}", fast.estimates);
}
