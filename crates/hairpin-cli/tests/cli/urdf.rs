//! Arms in URDF: shapes that are read, stood in for and said so, flanges, grippers, and mistakes in its own text.

use std::fs;
use std::path::Path;

use crate::commands::{json, refused, run};

const CASES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/urdf");

/// A folder with the cases in it.
fn cases() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    for entry in fs::read_dir(CASES).unwrap() {
        let path = entry.unwrap().path();
        fs::write(folder.path().join(path.file_name().unwrap()), fs::read(&path).unwrap()).unwrap();
    }
    folder
}

/// A box from `low` to `high` as an STL file, m.
fn stl(path: &Path, low: [f64; 3], high: [f64; 3]) {
    let corner = |c: usize| [0, 1, 2].map(|k| if c >> k & 1 == 1 { high[k] } else { low[k] });
    let faces = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let mut text = String::from("solid box\n");
    for [a, b, c, d] in faces {
        for triangle in [[a, b, c], [a, c, d]] {
            text += "facet normal 0 0 0\nouter loop\n";
            for corner in triangle.map(corner) {
                text += &format!("vertex {} {} {}\n", corner[0], corner[1], corner[2]);
            }
            text += "endloop\nendfacet\n";
        }
    }
    fs::create_dir_all(path.parent().unwrap()).unwrap();
    fs::write(path, text + "endsolid\n").unwrap();
}

/// A program that only stands at these angles.
fn stands(folder: &Path, degrees: [f64; 6]) {
    let text = format!(
        "MODULE Stand\nPROC main()\nMoveAbsJ [{degrees:?},[9E9,9E9,9E9,9E9,9E9,9E9]],v200,fine,tool0;\nENDPROC\nENDMODULE\n"
    );
    fs::write(folder.join("stand.mod"), text).unwrap();
}

#[test]
fn a_link_without_a_shape_is_no_hole_in_the_check() {
    let folder = cases();
    for robot in ["six_mixed.urdf", "six_mesh.urdf"] {
        let set = format!("robot=\"{robot}\"");
        let check = ["import", "sweep.mod", "--check", "--cell", "cell_post.toml", "--set", &set];
        let (code, out, error) = run(folder.path(), &check);
        assert_eq!(code, 1, "{robot}: {out}{error}");
        assert!(out.contains("COLLISION") && out.contains("link 2 meets post"), "{robot}: {out}");
        assert!(out.contains("(estimated: link 2 is a stand-in)"), "{robot}: {out}");
        assert!(out.lines().last().unwrap().starts_with("FAIL: 1 finding in 2 moves, estimated"), "{robot}: {out}");
        for link in 1..=6 {
            assert!(
                out.contains(&format!("estimated: link {link} (`l{link}`) is a stand-in: package://six_")),
                "{out}"
            );
        }
        assert_eq!(out.contains("estimated: link 0 (`base_link`)"), robot == "six_mesh.urdf", "{out}");
        let object = json(folder.path(), &check);
        assert_eq!(
            (&object["findings"][0]["estimated"], &object["findings"][0]["open"]),
            (&true.into(), &false.into())
        );
    }
}

#[test]
fn an_arm_with_an_offset_wrist_works_with_its_meshes_and_without() {
    let folder = cases();
    let check = ["import", "postures.mod", "--check", "--robot", "offset_wrist.urdf"];
    let (code, out, _) = run(folder.path(), &check);
    assert!(code == 0 && !out.contains("COLLISION"), "{out}");
    assert!(out.lines().last().unwrap().contains("estimated"), "{out}");
    let meshes = folder.path().join("ros/arm");
    // Tubes of 0.1 m from joint to joint.
    for (name, low, high) in [
        ("base", [-0.07, -0.07, 0.0], [0.07, 0.07, 0.12]),
        ("k1", [-0.06, -0.06, -0.06], [0.06, 0.2, 0.06]),
        ("k2", [-0.05, -0.05, -0.05], [0.05, 0.05, 0.61]),
        ("k3", [-0.045, -0.045, -0.05], [0.045, 0.045, 0.57]),
        ("k4", [-0.04, 0.0, -0.04], [0.04, 0.115, 0.04]),
        ("k5", [-0.04, -0.04, 0.0], [0.04, 0.04, 0.1]),
        ("k6", [-0.035, 0.0, -0.035], [0.035, 0.09, 0.035]),
    ] {
        stl(&meshes.join(format!("{name}.stl")), low, high);
    }
    let with = [&check[..], &["--packages", "ros"]].concat();
    let (code, out, error) = run(folder.path(), &with);
    assert!(code == 0 && out.ends_with("PASS: 0 findings in 3 moves\n"), "{out}{error}");
    assert!(!out.contains("stand-in"), "{out}");
    // The package's own folder is as good, and one that the URDF lies in needs no word.
    assert_eq!(run(folder.path(), &[&check[..], &["--packages", "ros/arm"]].concat()).1, out);
    fs::rename(folder.path().join("ros/arm"), folder.path().join("arm")).unwrap();
    assert_eq!(run(folder.path(), &check).1, out);
    // Folded until they meet, meshes are certain.
    stands(folder.path(), [0.0, -90.0, 170.0, 0.0, 90.0, 0.0]);
    let (code, out, _) = run(folder.path(), &["import", "stand.mod", "--check", "--robot", "offset_wrist.urdf"]);
    assert!(code == 1 && out.contains("COLLISION") && !out.contains("(estimated"), "{out}");
    // Broken, they are a mistake of the mesh's, told where the URDF names it.
    fs::write(folder.path().join("arm/k3.stl"), "solid\nvertex 0 0\n").unwrap();
    refused(folder.path(), &check, &["offset_wrist.urdf:10", "k3.stl: line 2: expected three numbers"]);
}

#[test]
fn the_flange_is_the_one_that_is_meant() {
    let folder = cases();
    for robot in ["six_mesh.urdf", "six_two_tips.urdf", "six_gripper.urdf"] {
        let (code, out, error) = run(folder.path(), &["import", "fk.mod", "--check", "--robot", robot]);
        assert!(code == 0 && out.contains("PASS: 0 findings in 3 moves"), "{robot}: {out}{error}");
    }
    let two = fs::read_to_string(folder.path().join("six_two_tips.urdf")).unwrap();
    fs::write(folder.path().join("asks.urdf"), two.replace("tool0", "ee_link")).unwrap();
    let check = ["import", "fk.mod", "--check", "--robot", "asks.urdf"];
    refused(folder.path(), &check, &["asks.urdf", "`ee_link`", "`camera`", "tip = \"ee_link\""]);
    assert_eq!(run(folder.path(), &[&check[..], &["--tip", "ee_link"]].concat()).0, 0);
    assert_eq!(run(folder.path(), &[&check[..], &["--set", "robot.tip=ee_link"]].concat()).0, 0);
    assert_eq!(run(folder.path(), &[&check[..], &["--tip", "camera"]].concat()).0, 1);
    refused(folder.path(), &[&check[..], &["--tip", "nose"]].concat(), &["tip = \"nose\": no link is called so"]);
}

#[test]
fn mistakes_are_told_in_the_urdf_s_own_text() {
    let folder = cases();
    let check = ["import", "fk.mod", "--check", "--robot", "six_sw.urdf"];
    let words = ["six_sw.urdf:4", "<limit lower=\"0\" upper=\"0\" velocity=\"0\" effort=\"0\"/>", "SolidWorks", "`j1`"];
    refused(folder.path(), &check, &words);
    let good = fs::read_to_string(folder.path().join("six_mesh.urdf")).unwrap();
    for (from, to, words) in [
        ("velocity=\"4.363323\"", "velocity=\"1e9\"", ["six_mesh.urdf:4", "speed_deg_s[0]"]),
        ("<robot name", "<robot nam", ["six_mesh.urdf:2", "</robot>"]),
        ("type=\"revolute\"", "type=\"prismatic\"", ["six_mesh.urdf", "not six"]),
    ] {
        fs::write(folder.path().join("six_mesh.urdf"), good.replacen(from, to, 1)).unwrap();
        if from.starts_with("<robot") {
            fs::write(folder.path().join("six_mesh.urdf"), good.replace("</robot>", "</robo>")).unwrap();
            refused(
                folder.path(),
                &["import", "fk.mod", "--check", "--robot", "six_mesh.urdf"],
                &["six_mesh.urdf", "is no XML"],
            );
            continue;
        }
        refused(folder.path(), &["import", "fk.mod", "--check", "--robot", "six_mesh.urdf"], &words);
    }
    let keys = [
        ("robot.tip=5", "name of a link"),
        ("robot.exclude=[1]", "pairs of links"),
        ("robot.srdf=no.srdf", "cannot be read"),
    ];
    fs::write(folder.path().join("six_mesh.urdf"), good).unwrap();
    for (set, words) in keys {
        refused(folder.path(), &["import", "fk.mod", "--check", "--robot", "six_mesh.urdf", "--set", set], &[words]);
    }
}

/// What has fifty thousand of something is answered soon, and not echoed.
#[test]
fn large_files_are_no_flood() {
    let folder = cases();
    let good = fs::read_to_string(folder.path().join("six_mesh.urdf")).unwrap();
    let many: String = (0..50_000)
        .map(|k| {
            let mesh = format!("<collision><geometry><mesh filename='package://a/{k}.stl'/></geometry></collision>");
            format!("<joint name='f{k}' type='fixed'><parent link='l2'/><child link='x{k}'/></joint><link name='x{k}'>{mesh}</link>")
        })
        .collect();
    fs::write(folder.path().join("six_mesh.urdf"), good.replace("</robot>", &(many + "</robot>"))).unwrap();
    let begun = std::time::Instant::now();
    let (code, _, error) = run(folder.path(), &["import", "fk.mod", "--check", "--robot", "six_mesh.urdf"]);
    assert!(code == 2 && error.len() < 3000 && error.contains("more than 2000 bodies"), "{code} {}", error.len());
    assert!(begun.elapsed().as_secs() < 15, "{:?}", begun.elapsed());
}

/// In this posture stand-ins meet each other and a tool without a radius: nobody knows whether the arm does.
#[test]
fn what_stand_ins_alone_do_is_not_found_out() {
    let folder = cases();
    stands(folder.path(), [0.0, 100.0, 69.0, 0.0, 0.0, 0.0]);
    let check = ["import", "stand.mod", "--check", "--robot", "six_mesh.urdf"];
    let mut pairs: Vec<String> = Vec::new();
    for _ in 0..9 {
        let set = format!("robot.exclude=[{}]", pairs.join(","));
        let (code, out, error) = run(folder.path(), &[&check[..], &["--set", &set]].concat());
        if code == 0 {
            break;
        }
        assert!(code == 5 && !out.contains("COLLISION"), "{out}{error}");
        let last = out.lines().last().unwrap();
        assert!(
            last.starts_with("INCONCLUSIVE: 0 findings in 1 moves, 1 meeting") && last.contains("estimated"),
            "{last}"
        );
        let (_, pair) = out.split_once("robot.exclude = [").unwrap();
        pairs.push(pair.split_inclusive(']').next().unwrap().into());
    }
    assert!(pairs.contains(&"[0, 4]".to_owned()) && pairs.len() > 1, "{pairs:?}");
    let set = format!("robot.exclude=[{}]", pairs.join(","));
    let (code, out, _) = run(folder.path(), &[&check[..], &["--set", &set]].concat());
    assert!(code == 0 && out.contains("PASS: 0 findings in 1 moves, estimated"), "{out}");
    // The same by the names of links, as an SRDF has them; the tool is the flange's.
    let name = |body: &str| match body {
        "0" => "base_link".to_owned(),
        "7" => "tool0".to_owned(),
        link => format!("l{link}"),
    };
    let disabled = pairs.iter().map(|pair| {
        let (a, b) = pair.trim_matches(['[', ']']).split_once(", ").unwrap();
        format!("<disable_collisions link1=\"{}\" link2=\"{}\" reason=\"Never\"/>", name(a), name(b))
    });
    let srdf = format!("<robot name=\"six\">{}</robot>", disabled.collect::<String>());
    fs::write(folder.path().join("six.srdf"), srdf).unwrap();
    let (code, out, error) = run(folder.path(), &[&check[..], &["--srdf", "six.srdf"]].concat());
    assert!(code == 0, "{out}{error}");
    let object = json(folder.path(), &check);
    assert_eq!((&object["exit_code"], &object["findings"][0]["open"]), (&5.into(), &true.into()));
}

#[test]
fn a_campaign_says_where_it_rests_on_stand_ins() {
    let folder = cases();
    let cell = fs::read_to_string(folder.path().join("cell_post.toml")).unwrap();
    let cell = cell
        .replace("count = 12", "count = 5")
        .replace("\"six_mixed.urdf\"", "{ urdf = \"six_mesh.urdf\", tip = \"tool0\" }");
    fs::write(folder.path().join("cell.toml"), &cell).unwrap();
    let stress = json(folder.path(), &["stress", "cell.toml", "--out", "out"]);
    let verdict = stress["verdict"].as_str().unwrap();
    assert!(
        verdict.contains("; link shapes estimated; all 1 clear: all links") && verdict.ends_with(", optimal"),
        "{verdict}"
    );
    // What a campaign keeps needs no URDF any more, and is the same again.
    let kept = fs::read_to_string(folder.path().join("out/scenario.toml")).unwrap();
    assert!(kept.contains("stand_ins = [") && !kept.contains(".urdf\""), "{kept}");
    fs::remove_file(folder.path().join("six_mesh.urdf")).unwrap();
    let verified = json(folder.path(), &["verify", "out"]);
    assert_eq!(verified["exit_code"], 0, "{verified}");
    let report = fs::read_to_string(folder.path().join("out/report.html")).unwrap();
    assert!(report.contains("estimated: stand-ins along the dimensions") && report.contains("is a stand-in"));
}

#[test]
fn an_arm_is_explained_in_its_own_words() {
    let folder = cases();
    let cell = fs::read_to_string(folder.path().join("cell_post.toml")).unwrap();
    let folded = cell.replace("home_deg = [0, 0, 0, 0, 30, 0]", "home_deg = [0, 100, 69, 0, 0, 0]");
    fs::write(folder.path().join("folded.toml"), folded.replace("radius_mm = 20", "radius_mm = 0")).unwrap();
    let (code, out, error) = run(folder.path(), &["explain", "folded.toml", "--set", "robot.urdf=six_mesh.urdf"]);
    assert!(
        code == 5 && out.contains("at home the base and link 4 meet (estimated: the base is a stand-in, link 4"),
        "{out}{error}"
    );
    assert!(!out.contains("lost at") && out.contains("INCONCLUSIVE 0 ("), "{out}");
    assert!(out.lines().last().unwrap().contains("robot.exclude = [["), "{out}");
    // What stands in the way for certain is.
    let wall = "world.obstacles=[{name=\"wall\",box={center_mm=[300,0,600],size_mm=[50,400,400]}}]";
    let (code, out, _) = run(folder.path(), &["explain", "cell_post.toml", "--set", wall]);
    assert!(code == 3 && out.contains("at home link ") && out.contains(" meets wall (estimated: link "), "{out}");
    // Points, by name and reason.
    let points = "task.points=[[300,0,400],[3000,0,300],[350,50,400]]";
    let object = json(folder.path(), &["explain", "cell_post.toml", "--set", points]);
    let reasons = object["reasons"].as_array().unwrap();
    assert!(reasons.iter().any(|reason| reason == "p01 cannot be met: out of reach"), "{object}");
}
