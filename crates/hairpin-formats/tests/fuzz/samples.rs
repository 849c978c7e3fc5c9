//! Inputs that every reader reads, to be spoiled.

use std::path::Path;

pub(crate) fn texts(all: &[&str]) -> Vec<Vec<u8>> {
    all.iter().map(|text| text.as_bytes().to_vec()).collect()
}

/// The files of a folder under tests/fixtures with one of these endings.
pub(crate) fn fixtures(folder: &str, endings: &[&str]) -> Vec<Vec<u8>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(folder);
    let mut paths: Vec<_> = std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    let wanted = |path: &&std::path::PathBuf| {
        path.extension().is_some_and(|ending| endings.iter().any(|wanted| ending == *wanted))
    };
    paths.iter().filter(wanted).map(|path| std::fs::read(path).unwrap()).collect()
}

/// Header and heights of a NumPy array of two rows and three columns.
pub(crate) fn numpy() -> Vec<Vec<u8>> {
    let one = |descr: &str, order: &str, data: Vec<u8>| {
        let header = format!("{{'descr': '{descr}', 'fortran_order': {order}, 'shape': (2, 3), }}\n");
        let length = (header.len() as u16).to_le_bytes();
        [b"\x93NUMPY\x01\x00".as_slice(), &length, header.as_bytes(), &data].concat()
    };
    let numbers = [1.0_f64, 4.0, 2.0, 5.0, 3.0, 6.0];
    let single = numbers.iter().flat_map(|h| (*h as f32).to_le_bytes()).collect();
    let double = numbers.iter().flat_map(|h| h.to_be_bytes()).collect();
    vec![one("<f4", "False", single), one(">f8", "True", double)]
}

pub(crate) fn picture() -> Vec<u8> {
    let mut bytes = Vec::new();
    let mut encoder = png::Encoder::new(&mut bytes, 8, 6);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.set_depth(png::BitDepth::Sixteen);
    let pixels: Vec<u8> = (0..96).collect();
    encoder.write_header().unwrap().write_image_data(&pixels).unwrap();
    bytes
}

pub(crate) fn meshes() -> (Vec<Vec<u8>>, Vec<Vec<u8>>) {
    let corners = [[0.0_f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    let faces = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];
    let mut binary = vec![b' '; 80];
    binary.extend(4_u32.to_le_bytes());
    let mut ascii = String::from("solid t\n");
    for face in faces {
        binary.extend([0; 12]);
        binary.extend(face.iter().flat_map(|&i| corners[i]).flat_map(f32::to_le_bytes));
        binary.extend([0; 2]);
        ascii += "facet normal 0 0 0\nouter loop\n";
        face.iter().for_each(|&i| ascii += &format!("vertex {} {} {}\n", corners[i][0], corners[i][1], corners[i][2]));
        ascii += "endloop\nendfacet\n";
    }
    let obj = "# t\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1/1/1 3//2 2\nf 1 2 4\nf -4 -1 -2\nf 2 3 4\n";
    (vec![binary, ascii.into_bytes()], texts(&[obj]))
}

pub(crate) fn urdf() -> Vec<Vec<u8>> {
    let mut text = String::from("<?xml version=\"1.0\"?>\n<robot name=\"six\">\n<link name=\"l0\"/>\n");
    for k in 1..=6 {
        let axis = if k % 2 == 1 { "0 0 1" } else { "0 1 0" };
        text += &format!(
            "<joint name=\"j{k}\" type=\"revolute\"><parent link=\"l{}\"/><child link=\"l{k}\"/><origin xyz=\"0 0 0.2\" \
             rpy=\"0 0 0\"/><axis xyz=\"{axis}\"/><limit lower=\"-2.5\" upper=\"2.5\" velocity=\"2\" effort=\"50\"/></joint>\n\
             <link name=\"l{k}\"><collision><origin xyz=\"0 0 0.1\"/><geometry><cylinder radius=\"0.05\" length=\"0.2\"/>\
             </geometry></collision></link>\n",
            k - 1
        );
    }
    text += "<joint name=\"tip\" type=\"fixed\"><parent link=\"l6\"/><child link=\"tool0\"/></joint>\n<link name=\"tool0\"/>\n</robot>\n";
    vec![text.into_bytes()]
}

pub(crate) const MODULE: &str = "MODULE Sweep(SYSMODULE)\n  ! a comment\n\
  TASK PERS tooldata tGrip:=[TRUE,[[31.8,0,229.6],[0.9455,0,0.3256,0]],[1,[0,0,1],[1,0,0,0],0,0,0]];\n\
  TASK PERS wobjdata wPal:=[FALSE,TRUE,\"\",[[1000,-500,200],[1,0,0,0]],[[10,0,0],[1,0,0,0]]];\n\
  CONST robtarget p1 := [[300,0,300],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
  CONST robtarget ps{2} := [p1,[[310,5,300],[0.7071068,0,0.7071068,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]]];\n\
  VAR num n := 0x10;\n  LOCAL PROC pick(num k, \\switch slow)\n    IF k > 2 AND NOT Present(slow) THEN\n\
    MoveL Offs(p1,0,k*5,10),v200,z5,tGrip\\WObj:=wPal;\n    ELSEIF k = 1 MoveJ p1,v50,fine,tGrip;\n    ENDIF\n  ENDPROC\n\
  PROC main()\n    ConfL\\Off;\n    FOR i FROM 1 TO 3 DO\n      pick i\\slow;\n      n := n + i;\n    ENDFOR\n\
    TEST n\n    CASE 22: MoveC p1, ps{2}, v100, z10, tGrip;\n    DEFAULT: Stop;\n    ENDTEST\n\
    WHILE n < 24 DO\n      n := n + 1;\n      MoveJ RelTool(p1,0,0,-n\\Rz:=5), v100, fine, tool0;\n    ENDWHILE\n\
    WaitTime 0.5; SetDO doGrip, 1;\n  ERROR\n    RETRY;\n  ENDPROC\nENDMODULE\n";

pub(crate) fn modules() -> Vec<Vec<u8>> {
    let plain = "MODULE m\nCONST robtarget p1 := [[300,0,300],[0.70710678,0,0.70710678,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
        PROC main()\n  MoveJ p1, v100, fine, tool0;\n  MoveAbsJ [[0,10,-10,0,45,0],[9E9,9E9,9E9,9E9,9E9,9E9]],v20,z1,tool0;\n\
        ENDPROC\nENDMODULE\n";
    texts(&[MODULE, plain])
}

pub(crate) const PRJ: &str = r#"COMPD_CS["both",PROJCS["WGS_1984_UTM_Zone_32N",GEOGCS["GCS_WGS_1984",DATUM["D_WGS_1984",SPHEROID["WGS_1984",6378137.0,298.257223563]],PRIMEM["Greenwich",0.0],UNIT["Degree",0.0174532925199433]],PROJECTION["Transverse_Mercator"],PARAMETER["False_Easting",500000.0],UNIT["Meter",1.0],AUTHORITY["EPSG","32632"]],VERT_CS["h",VERT_DATUM["d",2005],UNIT["foot",0.3048]]]"#;
pub(crate) const AUX: &str = "<PAMDataset><SRS>GEOGCS[\"WGS 84\",DATUM[\"d\",SPHEROID[\"s\",6378137,298.2]],UNIT[\"degree\",0.0174]]</SRS><PAMRasterBand band=\"1\"><NoDataValue>-9999</NoDataValue><Scale>1</Scale><Offset>0</Offset><UnitType>m</UnitType></PAMRasterBand></PAMDataset>";

/// Pairs that may touch.
pub(crate) fn srdf() -> Vec<Vec<u8>> {
    vec![br#"<robot name="six"><disable_collisions link1="a" link2="b" reason="Adjacent"/></robot>"#.to_vec()]
}

/// A triangle in millimetres, placed by a node.
pub(crate) fn collada() -> Vec<Vec<u8>> {
    let text = r##"<COLLADA version="1.4.1"><asset><unit meter="0.001"/><up_axis>Y_UP</up_axis></asset>
<library_geometries><geometry id="g"><mesh><source id="p"><float_array id="a" count="9">0 0 0 1 0 0 0 1 0</float_array>
<technique_common><accessor source="#a" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/>
<param name="Z" type="float"/></accessor></technique_common></source><vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_visual_scenes><visual_scene id="s"><node><matrix>1 0 0 5 0 1 0 0 0 0 1 0 0 0 0 1</matrix><instance_geometry url="#g"/></node>
</visual_scene></library_visual_scenes><scene><instance_visual_scene url="#s"/></scene></COLLADA>"##;
    vec![text.as_bytes().to_vec()]
}
