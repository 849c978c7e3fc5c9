use super::*;

/// A box of 2 × 4 × 6 in the file's own axes, as the `primitive` says, placed by `nodes`.
fn file(asset: &str, primitive: &str, scene: &str) -> String {
    let corner = |c: usize| format!("{} {} {} ", (c & 1) * 2, (c >> 1 & 1) * 4, (c >> 2 & 1) * 6);
    let points: String = (0..8).map(corner).collect();
    format!(
        "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\">\
         <asset>{asset}</asset><library_geometries><geometry id=\"box\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"24\">\
         {points}</float_array><technique_common><accessor source=\"#a\" count=\"8\" stride=\"3\"/></technique_common></source>\
         <vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices>{primitive}</mesh></geometry></library_geometries>\
         {scene}</COLLADA>"
    )
}

/// Two sides of it, with normals beside the corners.
const TRIANGLES: &str = "<triangles count=\"2\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>\
     <input semantic=\"NORMAL\" source=\"#n\" offset=\"1\"/><p>0 9 1 9 2 9  1 9 3 9 7 9</p></triangles>";

fn scene(nodes: &str) -> String {
    format!(
        "<library_visual_scenes><visual_scene id=\"s\">{nodes}</visual_scene></library_visual_scenes>\
         <scene><instance_visual_scene url=\"#s\"/></scene>"
    )
}

fn far(mesh: &Mesh) -> [f64; 3] {
    [0, 1, 2]
        .map(|k| mesh.vertices.iter().map(|v| v[k]).fold(0.0, |far: f64, x| if x.abs() > far.abs() { x } else { far }))
}

fn near(found: [f64; 3], right: [f64; 3]) {
    assert!(found.iter().zip(right).all(|(a, b)| (a - b).abs() < 1e-12), "{found:?} {right:?}");
}

#[test]
fn unit_and_upward_axis_are_the_file_s_own() {
    for (asset, right) in [
        ("<unit meter=\"0.001\" name=\"millimeter\"/><up_axis>Z_UP</up_axis>", [0.002, 0.004, 0.006]),
        ("<unit meter=\"0.5\"/><up_axis>Y_UP</up_axis>", [1.0, -3.0, 2.0]),
        ("<up_axis>X_UP</up_axis>", [-4.0, -6.0, 2.0]),
        // What a file does not say is the format's own: metres, y up.
        ("", [2.0, -6.0, 4.0]),
    ] {
        let read = read_collada(&file(asset, TRIANGLES, ""), Faces::Outwards).unwrap();
        near(far(&read), right);
        assert_eq!(read.triangles, [[0, 1, 2], [1, 3, 7]]);
    }
}

#[test]
fn nodes_stand_where_their_transforms_put_them() {
    let z_up = "<up_axis>Z_UP</up_axis>";
    let here = "<instance_geometry url=\"#box\"/>";
    for (nodes, right) in [
        (format!("<node><translate>10 0 0</translate><scale>1 2 1</scale>{here}</node>"), [12.0, 8.0, 6.0]),
        // First turned, then shifted.
        (format!("<node><translate>0 0 1</translate><rotate>0 0 1 90</rotate>{here}</node>"), [-4.0, 2.0, 7.0]),
        (
            format!(
                "<node><matrix>1 0 0 5 0 1 0 6 0 0 1 7 0 0 0 1</matrix><node><translate>1 1 1</translate>{here}</node></node>"
            ),
            [8.0, 11.0, 14.0],
        ),
    ] {
        near(far(&read_collada(&file(z_up, TRIANGLES, &scene(&nodes)), Faces::Outwards).unwrap()), right);
    }
    let twice = format!(
        "<library_nodes><node id=\"n\">{here}</node></library_nodes>{}",
        scene(
            "<node><instance_node url=\"#n\"/></node><node><translate>1 0 0</translate><instance_node url=\"#n\"/></node>"
        )
    );
    assert_eq!(read_collada(&file(z_up, TRIANGLES, &twice), Faces::Outwards).unwrap().triangles.len(), 4);
    // Millimetres shift in millimetres.
    let moved = scene(&format!("<node><translate>8 0 0</translate>{here}</node>"));
    let moved = file("<unit meter=\"0.001\"/><up_axis>Z_UP</up_axis>", TRIANGLES, &moved);
    let read = read_collada(&moved, Faces::Outwards);
    near(far(&read.unwrap()), [0.01, 0.004, 0.006]);
    // A mirror leaves what is outside outside.
    let mirrored = scene(&format!("<node><scale>-1 1 1</scale>{here}</node>"));
    let read = read_collada(&file(z_up, TRIANGLES, &mirrored), Faces::Outwards).unwrap();
    assert_eq!(read.triangles, [[0, 2, 1], [1, 7, 3]]);
}

#[test]
fn every_kind_of_face_becomes_triangles() {
    let input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
    for (primitive, right) in [
        (
            format!("<polylist count=\"2\">{input}<vcount>4 3</vcount><p>0 1 3 2 4 5 6</p></polylist>"),
            vec![[0, 1, 3], [0, 3, 2], [4, 5, 6]],
        ),
        (format!("<polygons count=\"1\">{input}<p>0 1 3 2</p></polygons>"), vec![[0, 1, 3], [0, 3, 2]]),
        (format!("<tristrips count=\"1\">{input}<p>0 1 2 3</p></tristrips>"), vec![[0, 1, 2], [2, 1, 3]]),
        (
            format!("<trifans count=\"1\">{input}<p>0 1 3 2</p></trifans><lines count=\"1\">{input}<p>0 7</p></lines>"),
            vec![[0, 1, 3], [0, 3, 2]],
        ),
    ] {
        assert_eq!(read_collada(&file("", &primitive, ""), Faces::Outwards).unwrap().triangles, right, "{primitive}");
    }
}

#[test]
fn what_is_no_collada_is_told() {
    let told = |text: &str| read_collada(text, Faces::Outwards).unwrap_err().to_string();
    assert!(told("<x").contains("is no Collada"));
    assert!(told("<svg/>").contains("its root is <svg>"));
    let input = "<input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>";
    assert!(told(&file("", &format!("<triangles>{input}<p>0 1 8</p></triangles>"), "")).contains("\"8\" is no vertex"));
    assert!(
        told(&file("", &format!("<polylist>{input}<vcount>9</vcount><p>0 1 2</p></polylist>"), "")).contains("vcount")
    );
    let bow = format!("<polylist>{input}<vcount>4</vcount><p>0 3 1 2</p></polylist>");
    assert!(
        told(&file("", &bow, "")).contains("face 0: a face of 4 corners crosses itself"),
        "{}",
        told(&file("", &bow, ""))
    );
    assert!(told(&file("<unit meter=\"-1\"/>", TRIANGLES, "")).contains("unit"));
    assert!(told(&file("", TRIANGLES, &scene("<node><instance_geometry url=\"#none\"/></node>"))).contains("#none"));
    assert!(told(&file("", TRIANGLES, &scene("<node><matrix>1 2</matrix></node>"))).contains("2 numbers, not 16"));
    // A node that names itself has no end.
    let round =
        "<library_nodes><node id=\"n\"><instance_node url=\"#n\"/><instance_node url=\"#n\"/></node></library_nodes>";
    let round = format!("{round}{}", scene("<node><instance_node url=\"#n\"/></node>"));
    assert!(told(&file("", TRIANGLES, &round)).contains("within one another"));
}
