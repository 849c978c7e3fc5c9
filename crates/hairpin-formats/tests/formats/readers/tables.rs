//! Robots, clouds, logs, waypoints, costs, meshes, answers of executors.

use std::fmt::{Debug, Display};
use std::path::Path;

use hairpin::campaign::bounds::FARTHEST_M;
use hairpin::robot::arm::ArmDescription;
use hairpin_formats::executor::FromExecutor;
use hairpin_formats::scenario::setup_for;
use hairpin_formats::{cloud, controller_log, costs, mesh, missions, rapid, urdf, waypoints};

use super::{Answer, Sample};

fn said<T: Debug, E: Display>(read: Result<T, E>) -> Answer {
    match read {
        Ok(read) => Answer::Read(format!("{read:?}")),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

/// What a reader of files makes of one that holds the text.
fn of_file<T: Debug, E: Display>(text: &str, name: &str, read: impl Fn(&Path) -> Result<T, E>) -> Answer {
    let folder = tempfile::tempdir().expect("a folder of our own");
    let path = folder.path().join(name);
    std::fs::write(&path, text).expect("a file of our own");
    match read(&path) {
        Ok(read) => Answer::Read(format!("{read:?}")),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_arm(text: &str) -> Answer {
    match toml::from_str::<ArmDescription>(text) {
        Ok(described) => said(described.build()),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_urdf(text: &str) -> Answer {
    let meshes = |name: &str| Err(urdf::NoMesh::Missing(name.into()));
    match urdf::read_urdf(text, &urdf::UrdfOptions::default(), &meshes) {
        Ok(arm) => said(arm.description.build()),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_srdf(text: &str) -> Answer {
    said(urdf::read_srdf(text))
}

fn of_dae(text: &str) -> Answer {
    said(mesh::read_mesh(text.as_bytes(), "part.dae"))
}

fn of_stl(text: &str) -> Answer {
    said(mesh::read_mesh(text.as_bytes(), "part.stl"))
}

fn of_cloud(text: &str) -> Answer {
    said(cloud::parse(text))
}

fn of_targets(text: &str) -> Answer {
    match rapid::read(text.as_bytes(), &rapid::Options::default()) {
        Ok(module) => said(cloud::from_targets(
            module.targets.iter().map(|t| (t.line, t.name.as_str(), t.target.as_ref().map_err(String::as_str))),
        )),
        Err(error) => Answer::Refused(error.to_string()),
    }
}

fn of_log(text: &str) -> Answer {
    // Where the file ends is no matter of its rows.
    of_file(text, "0000-0.csv", |path| controller_log::read(path, None).map(|log| (log.track, log.orientation_known)))
}

fn of_waypoints(text: &str) -> Answer {
    let robot = setup_for("demo-quadrotor", &[]).expect("shipped");
    of_file(text, "a.csv", |path| waypoints::read(path, &robot.scenario, FARTHEST_M))
}

/// What is followed of a mission: what is passed over in words is not.
fn of_mission(text: &str, name: &str) -> Answer {
    let robot = setup_for("quadrotor", &[]).expect("shipped");
    let read = |path: &Path| {
        let mission = missions::read(path, &robot.scenario, FARTHEST_M)?;
        let missions::Mission { waypoints, speeds, accept, stops, uncertain, .. } = mission;
        Ok::<_, missions::MissionError>((waypoints, speeds, accept, stops, uncertain))
    };
    match of_file(text, name, read) {
        Answer::Read(told) if !told.ends_with("[])") => Answer::Open,
        other => other,
    }
}

fn of_plan(text: &str) -> Answer {
    of_mission(text, "a.plan")
}

fn of_wpl(text: &str) -> Answer {
    of_mission(text, "a.waypoints")
}

const PLAN: &str = include_str!("../../fixtures/missions/cage.plan");
const WPL: &str = include_str!("../../fixtures/missions/cage.waypoints");

fn plan_row(row: &'static str, from: &str, to: &str) -> Sample {
    assert!(PLAN.contains(from), "{row}: {from}");
    Sample { row, read: of_plan, without: PLAN.into(), with: PLAN.replacen(from, to, 1) }
}

/// The plan with `item` in the place of its camera's.
fn item_row(row: &'static str, item: &str) -> Sample {
    plan_row(row, "\"command\": 203", item)
}

fn wpl_row(row: &'static str, from: &str, to: &str) -> Sample {
    assert!(WPL.contains(from), "{row}: {from}");
    Sample { row, read: of_wpl, without: WPL.into(), with: WPL.replacen(from, to, 1) }
}

fn of_costs(text: &str) -> Answer {
    of_file(text, "costs.csv", costs::read)
}

fn of_clock(text: &str) -> Answer {
    said(rapid::read_log(text.as_bytes()))
}

fn of_obj(text: &str) -> Answer {
    said(mesh::read_mesh(text.as_bytes(), "part.obj"))
}

fn of_answer(text: &str) -> Answer {
    said(text.parse::<FromExecutor>())
}

const ARM: &str = include_str!("../../../../../data/robots/arm/irb120.toml");

fn arm_row(row: &'static str, more: &str) -> Sample {
    Sample { row, read: of_arm, without: ARM.into(), with: ARM.replace("[joints]", &format!("[joints]\n{more}")) }
}

/// Six joints in a row; `joint` goes into the third, `link` into the last link, `more` behind all.
fn six(joint: &str, link: &str, more: &str) -> String {
    let mut text = String::from("<robot name=\"six\">\n<link name=\"l0\"/>\n");
    for k in 1..=6 {
        let axis = if k % 2 == 1 { "0 0 1" } else { "0 1 0" };
        let inside = if k == 3 { joint } else { "" };
        let shape = if k == 6 { link } else { "" };
        text += &format!(
            "<link name=\"l{k}\">{shape}</link>\n<joint name=\"j{k}\" type=\"revolute\"><parent link=\"l{}\"/><child link=\"l{k}\"/>\
             <origin xyz=\"0.05 0 0.2\"/><axis xyz=\"{axis}\"/><limit lower=\"-2\" upper=\"2\" velocity=\"3\" effort=\"9\"/>{inside}</joint>\n",
            k - 1
        );
    }
    text + more + "</robot>\n"
}

/// A link on the last one, by a joint of a kind with `more` inside.
fn gripper(kind: &str, more: &str) -> String {
    format!(
        "<link name=\"finger\"/><joint name=\"to_finger\" type=\"{kind}\"><parent link=\"l6\"/><child link=\"finger\"/>{more}</joint>\n"
    )
}

fn urdf_row(row: &'static str, [joint, link, more]: [&str; 3]) -> Sample {
    Sample { row, read: of_urdf, without: six("", "", ""), with: six(joint, link, more) }
}

fn row(row: &'static str, read: fn(&str) -> Answer, without: &str, with: &str) -> Sample {
    Sample { row, read, without: without.into(), with: with.into() }
}

const CLOUD: &str = "x_mm,y_mm,z_mm\n300,0,300\n320,10,310\n";
const TARGET: &str =
    "MODULE M\nCONST robtarget p:=[[300,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\nENDMODULE\n";
const LOG: &str = "t_s,x_mm,y_mm,z_mm\n0,300,0,300\n0.1,310,0,300\n0.2,320,0,300\n";
const WAYPOINTS: &str = "x_m,y_m,z_m\n0,0,1\n1,0,1\n";
const OBJ: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
const STL: &str = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid s\n";
const DAE: &str = "<COLLADA version=\"1.4.1\"><asset><unit meter=\"1\"/><up_axis>Z_UP</up_axis></asset><library_geometries>\
    <geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0.5</float_array><technique_common>\
    <accessor source=\"#a\" count=\"3\" stride=\"3\"/></technique_common></source><vertices id=\"v\">\
    <input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>\
    <p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node>\
    <instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>";
const POSE: &str = "{\"type\":\"pose\",\"t_s\":0.1,\"p_m\":[0,0,1]}";

pub(crate) fn samples() -> Vec<Sample> {
    vec![
        arm_row("arm.accelerations", "acceleration_deg_s2 = [600, 600, 600, 900, 900, 1200]"),
        arm_row("arm.unknown-key", "torque_nm = [1, 2, 3, 4, 5, 6]"),
        urdf_row("urdf.primitives", ["", "<collision><geometry><sphere radius=\"0.05\"/></geometry></collision>", ""]),
        urdf_row("urdf.visual", ["", "<visual><geometry><sphere radius=\"0.05\"/></geometry></visual>", ""]),
        urdf_row("urdf.dynamics", ["<dynamics damping=\"0.1\" friction=\"0.2\"/>", "", ""]),
        urdf_row("urdf.transmission", ["", "", "<transmission name=\"t\"/>\n"]),
        urdf_row(
            "urdf.missing-mesh",
            ["", "<collision><geometry><mesh filename=\"a.stl\"/></geometry></collision>", ""],
        ),
        urdf_row("urdf.unknown-element", ["", "", "<group><link name=\"hand\"/></group>\n"]),
        urdf_row("urdf.unknown-attribute", ["", "<collision><origin quat_xyzw=\"0 0 1 0\"/></collision>", ""]),
        urdf_row(
            "urdf.second-shape",
            ["", "<collision><geometry><sphere radius=\"1\"/><sphere radius=\"2\"/></geometry></collision>", ""],
        ),
        urdf_row("urdf.second-origin", ["<origin xyz=\"0 0 1\"/>", "", ""]),
        urdf_row("urdf.xacro", ["", "<x:if xmlns:x=\"http://ros.org/wiki/xacro\"/>", ""]),
        urdf_row("urdf.mimic", ["<mimic joint=\"j1\"/>", "", ""]),
        urdf_row(
            "urdf.gripper",
            ["", "", &gripper("prismatic", "<limit lower=\"0\" upper=\"0.04\" velocity=\"1\" effort=\"9\"/>")],
        ),
        urdf_row("urdf.two-tips", ["", "", &(gripper("fixed", "") + &gripper("fixed", "").replace("finger", "thumb"))]),
        Sample {
            row: "urdf.tool0",
            read: of_urdf,
            without: six("", "", ""),
            with: six("", "", &gripper("fixed", "<origin xyz=\"0 0 0.1\"/>").replace("finger", "tool0")),
        },
        Sample {
            row: "urdf.no-limits",
            read: of_urdf,
            without: six("", "", ""),
            with: six("", "", "").replacen("lower=\"-2\" upper=\"2\"", "lower=\"0\" upper=\"0\"", 1),
        },
        Sample {
            row: "urdf.continuous",
            read: of_urdf,
            without: six("", "", ""),
            with: six("", "", "").replacen("type=\"revolute\"", "type=\"continuous\"", 1),
        },
        Sample {
            row: "urdf.sliding",
            read: of_urdf,
            without: six("", "", ""),
            with: six("", "", "").replacen("type=\"revolute\"", "type=\"prismatic\"", 1),
        },
        row(
            "srdf.pairs",
            of_srdf,
            "<robot name=\"six\"/>",
            "<robot name=\"six\"><disable_collisions link1=\"a\" link2=\"b\"/></robot>",
        ),
        row("srdf.groups", of_srdf, "<robot name=\"six\"/>", "<robot name=\"six\"><group name=\"arm\"/></robot>"),
        row(
            "srdf.half-a-pair",
            of_srdf,
            "<robot name=\"six\"/>",
            "<robot name=\"six\"><disable_collisions link1=\"a\"/></robot>",
        ),
        Sample {
            row: "urdf.no-robot",
            read: of_urdf,
            without: six("", "", ""),
            with: "<model name=\"six\"><link name=\"l0\"/></model>".into(),
        },
        row(
            "cloud.orientation",
            of_cloud,
            CLOUD,
            "x_mm,y_mm,z_mm,q1,q2,q3,q4\n300,0,300,0,0,1,0\n320,10,310,0,0,1,0\n",
        ),
        row("cloud.other-columns", of_cloud, CLOUD, "x_mm,y_mm,z_mm,note\n300,0,300,a\n320,10,310,b\n"),
        row("cloud.other-units", of_cloud, CLOUD, "x_m,y_m,z_m\n0.3,0,0.3\n0.32,0.01,0.31\n"),
        row("cloud.twice", of_cloud, CLOUD, "x_mm,y_mm,z_mm\n300,0,300\n300,0,300\n"),
        row("targets.configuration", of_targets, TARGET, &TARGET.replace("[0,0,0,0],", "[1,0,0,0],")),
        row("targets.external-axes", of_targets, TARGET, &TARGET.replace("[9E9,", "[900,")),
        row("log.moves", of_log, LOG, "t_s,x_mm,y_mm,z_mm,move\n0,300,0,300,0\n0.1,310,0,300,0\n0.2,320,0,300,1\n"),
        row(
            "log.other-columns",
            of_log,
            LOG,
            "t_s,x_mm,y_mm,z_mm,temp\n0,300,0,300,5\n0.1,310,0,300,5\n0.2,320,0,300,5\n",
        ),
        row("log.decimal-commas", of_log, LOG, "t_s;x_mm;y_mm;z_mm\n0;300;0;300\n0,1;310;0;300\n0,2;320;0;300,5\n"),
        row("log.time-back", of_log, LOG, "t_s,x_mm,y_mm,z_mm\n0,300,0,300\n0.1,310,0,300\n0.1,320,0,300\n"),
        row("log.no-units", of_log, LOG, "t_s,x,y,z\n0,300,0,300\n0.1,310,0,300\n0.2,320,0,300\n"),
        row("log.not-finite", of_log, LOG, "t_s,x_mm,y_mm,z_mm\n0,300,0,300\n0.1,nan,0,300\n0.2,320,0,300\n"),
        row("waypoints.other-columns", of_waypoints, WAYPOINTS, "name,x_m,y_m,z_m\na,0,0,1\nb,1,0,1\n"),
        row("waypoints.blank-lines", of_waypoints, WAYPOINTS, "x_m,y_m,z_m\n0,0,1\n\n1,0,1\n"),
        row("waypoints.other-units", of_waypoints, WAYPOINTS, "x_ft,y_ft,z_ft\n0,0,1\n1,0,1\n"),
        row("waypoints.twice", of_waypoints, WAYPOINTS, "x_m,y_m,z_m\n0,0,1\n0,0,1\n"),
        item_row("plan.speed", "\"command\": 178"),
        plan_row("plan.throttle", "[1, 3, -1, 0, 0, 0, 0]", "[1, 3, 40, 0, 0, 0, 0]"),
        plan_row("plan.relative-speed", "[1, 3, -1, 0, 0, 0, 0]", "[1, 3, -1, 1, 0, 0, 0]"),
        plan_row(
            "plan.waiting-speed",
            "{ \"type\": \"SimpleItem\", \"command\": 178,",
            "{ \"type\": \"SimpleItem\", \"command\": 112, \"frame\": 2, \"autoContinue\": true, \
             \"params\": [5, 0, 0, 0, 0, 0, 0] }, { \"type\": \"SimpleItem\", \"command\": 178,",
        ),
        plan_row("plan.accept", "[0, 1, 0, null, 38.0336", "[0, 3, 0, null, 38.0336"),
        plan_row("plan.beside", "[0, 1, 0, null, 38.0336", "[0, 1, 4, null, 38.0336"),
        plan_row(
            "plan.flat-fence",
            "[38.0339, -78.5076], [38.0339, -78.5082]",
            "[38.0334, -78.5079], [38.0334, -78.5078]",
        ),
        item_row("plan.camera", "\"command\": 206"),
        item_row("plan.moves", "\"command\": 18"),
        item_row("plan.unknown", "\"command\": 31000"),
        item_row("plan.jump", "\"command\": 177"),
        item_row("plan.return", "\"command\": 20"),
        plan_row("plan.hold", "[0, 1, 0, null, 38.0336", "[4, 1, 0, null, 38.0336"),
        plan_row("plan.heading", "[0, 1, 0, null, 38.0336", "[0, 1, 0, 90, 38.0336"),
        plan_row(
            "plan.home",
            "\"plannedHomePosition\": [38.033553, -78.5079772, 180]",
            "\"plannedHomePosition\": [38.033553, -78.5079772, 181]",
        ),
        plan_row(
            "plan.pattern",
            "\"type\": \"SimpleItem\"",
            "\"complexItemType\": \"survey\", \"type\": \"ComplexItem\"",
        ),
        plan_row("plan.terrain", "\"frame\": 3", "\"frame\": 10"),
        plan_row("plan.local", "\"frame\": 3", "\"frame\": 1"),
        plan_row("plan.no-fence", "\"geoFence\"", "\"fence\""),
        plan_row("plan.altitudes", "\"AltitudeMode\": 1, ", ""),
        plan_row("plan.params", "[0, 1, 0, null, 38.0336", "[0, 0, 1, 0, null, 38.0336"),
        wpl_row("wpl.head", "QGC WPL 110", "QGC WPL 120"),
        wpl_row("wpl.fields", "0\t1\t0\t16\t", "0\t1\t0\t16 "),
        wpl_row("wpl.crlf", "110\n", "110\r\n"),
        wpl_row("wpl.comment", "110\n", "110\n# made by hand\n"),
        wpl_row("wpl.hold", "3\t16\t0\t1", "3\t16\t5\t1"),
        row("costs.no-arc", of_costs, "0,1\n2,0\n", "0,1\n,0\n"),
        row("costs.diagonal", of_costs, "0,1\n2,0\n", "-1,1\n2,nan\n"),
        row("costs.not-square", of_costs, "0,1\n2,0\n", "0,1,3\n2,0,3\n"),
        row("clock.readings", of_clock, "arc_ms;2\n0;1;20\n", "arc_ms;2\n0;1;20\n0;1;30\n"),
        row("clock.no-point", of_clock, "arc_ms;2\n0;1;20\n", "arc_ms;2\n0;5;20\n"),
        arm_row("arm.j23-coupled", "j23_coupled = true"),
        row("obj.faces", of_obj, OBJ, &format!("{OBJ}v 1 1 0\nf 2 4 3\n")),
        row("obj.materials", of_obj, OBJ, &format!("mtllib a.mtl\nusemtl a\nvn 0 0 1\n{OBJ}")),
        row("obj.tabs", of_obj, OBJ, &OBJ.replace(' ', "\t")),
        row("obj.concave", of_obj, OBJ, &format!("{OBJ}v 4 0 0\nv 4 1 0\nv 1 1 0\nv 1 4 0\nf 1 4 5 6 7 3\n")),
        row("obj.crossing", of_obj, OBJ, &format!("{OBJ}v 1 1 0\nf 1 4 2 3\n")),
        row("obj.uneven", of_obj, OBJ, &format!("{OBJ}v 1 1 0.3\nf 1 2 4 3\n")),
        row("obj.uneven-concave", of_obj, OBJ, &format!("{OBJ}v 0.2 0.2 0.3\nf 1 2 4 3\n")),
        row("obj.no-faces", of_obj, OBJ, "v 0 0 0\nv 1 0 0\nv 0 1 0\n"),
        row("stl.capitals", of_stl, STL, &STL.to_uppercase()),
        row("stl.no-facets", of_stl, STL, "solid s\nendsolid s\n"),
        row("stl.facets", of_stl, STL, &STL.replace("0 1 0\n", "0 2 0\n")),
        row("stl.broken", of_stl, STL, &STL.replace("0 1 0\n", "0 up 0\n")),
        row("dae.unit", of_dae, DAE, &DAE.replace("meter=\"1\"", "meter=\"0.001\"")),
        row("dae.up-axis", of_dae, DAE, &DAE.replace("Z_UP", "Y_UP")),
        row(
            "dae.materials",
            of_dae,
            DAE,
            &DAE.replace("<library_geometries>", "<library_materials/><library_geometries>"),
        ),
        row("dae.broken", of_dae, DAE, &DAE.replace("<p>0 1 2</p>", "<p>0 1 9</p>")),
        row("dae.polygons-left", of_dae, DAE, &DAE.replace("<p>0 1 2</p>", "<p>0 1 2 0</p>")),
        row("obj.statements", of_obj, OBJ, &format!("{OBJ}call b.obj\n")),
        row("stl.words", of_stl, STL, &STL.replace("vertex", "vertx")),
        row("obj.broken", of_obj, OBJ, &format!("{OBJ}f 1 2 9\n")),
        row(
            "executor.attitude",
            of_answer,
            POSE,
            "{\"type\":\"pose\",\"t_s\":0.1,\"p_m\":[0,0,1],\"q_wxyz\":[1,0,0,0]}",
        ),
        row(
            "executor.other-fields",
            of_answer,
            POSE,
            "{\"type\":\"pose\",\"t_s\":0.1,\"p_m\":[0,0,1],\"battery\":0.5}",
        ),
        row("executor.no-stamp", of_answer, POSE, "{\"type\":\"pose\",\"p_m\":[0,0,1]}"),
        row("executor.other-type", of_answer, POSE, "{\"type\":\"telemetry\",\"t_s\":0.1}"),
    ]
}
