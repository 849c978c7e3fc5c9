//! Triangle meshes in: STL (binary and ASCII), OBJ and Collada, as vertices that triangles share.

mod collada;
mod polygon;
mod types;

use std::collections::BTreeMap;

use nalgebra::Vector3;
use polygon::Faces;
pub use types::{Mesh, MeshError};

/// Reads a mesh whose surface bounds a solid; the ending of `name` tells OBJ, STL and Collada (`.dae`) apart.
/// Coordinates of OBJ and STL are in the file's own unit, which neither says; Collada's are made metres.
///
/// A face that is not flat is cut so that the solid holds what any other way to cut it makes, on the side that the
/// surface is wound to: inwards where its volume Σ a·(b × c)/6 is negative.
///
/// # Errors
/// [`MeshError`].
pub fn read_mesh(bytes: &[u8], name: &str) -> Result<Mesh, MeshError> {
    let mesh = read(bytes, name, Faces::Outwards)?;
    if volume(&mesh) < 0.0 { read(bytes, name, Faces::Inwards) } else { Ok(mesh) }
}

/// Reads a mesh of which convex hulls are made, as [`read_mesh`] does: faces that are not flat, not convex or cross
/// themselves are all triangles of a corner and an edge. Its triangles are no surface.
///
/// # Errors
/// [`MeshError`].
pub fn read_mesh_of_hulls(bytes: &[u8], name: &str) -> Result<Mesh, MeshError> {
    read(bytes, name, Faces::Hulls)
}

fn read(bytes: &[u8], name: &str, faces: Faces) -> Result<Mesh, MeshError> {
    // Some programs begin a text with its mark.
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let ending = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    let mesh = match ending.as_str() {
        "obj" => read_obj(&String::from_utf8_lossy(bytes), faces)?,
        "dae" => collada::read_collada(&String::from_utf8_lossy(bytes), faces)?,
        "stl" if is_ascii_stl(bytes) => read_ascii_stl(&String::from_utf8_lossy(bytes))?,
        "stl" => read_binary_stl(bytes)?,
        _ => return Err(MeshError::Format),
    };
    match mesh.vertices.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(MeshError::NotFinite { vertex }),
        None if mesh.triangles.is_empty() => Err(none_of(bytes, &ending)),
        None => Ok(mesh),
    }
}

/// Six times the volume that triangles bound, above 0 if they are wound outwards.
fn volume(mesh: &Mesh) -> f64 {
    let Some(origin) = mesh.vertices.first().map(|v| Vector3::from(*v)) else { return 0.0 };
    let corner = |index: u32| Vector3::from(mesh.vertices[index as usize]) - origin;
    mesh.triangles.iter().map(|&[a, b, c]| corner(a).dot(&corner(b).cross(&corner(c)))).sum()
}

/// A file without triangles holds something else, or is written otherwise.
fn none_of(bytes: &[u8], ending: &str) -> MeshError {
    let lines = String::from_utf8_lossy(bytes).lines().count();
    MeshError::NoTriangles(match ending {
        "obj" => format!("none of its {lines} lines begins with f"),
        "stl" if is_ascii_stl(bytes) => format!("none of its {lines} lines begins with vertex"),
        "stl" => "its header says 0".into(),
        _ => "no geometry has any".into(),
    })
}

/// Binary files may begin with `solid` too: a text has no byte of 0, of which numbers are full.
fn is_ascii_stl(bytes: &[u8]) -> bool {
    let begin = bytes.trim_ascii_start().get(..5);
    begin.is_some_and(|word| word.eq_ignore_ascii_case(b"solid")) && !bytes.contains(&0)
}

/// 80 bytes of header, the count, then 50 bytes per triangle: normal, three corners (f32, little-endian), attributes.
fn read_binary_stl(bytes: &[u8]) -> Result<Mesh, MeshError> {
    let Some((head, body)) = bytes.split_at_checked(84) else {
        return Err(MeshError::NoHeader { bytes: bytes.len() });
    };
    let said = u32::from_le_bytes([head[80], head[81], head[82], head[83]]);
    let found = body.len() / 50;
    if found < said as usize {
        return Err(MeshError::Truncated { said, found });
    }
    // Less than a triangle fills up a block; more may be a part of the world.
    if found > said as usize {
        return Err(MeshError::Beyond { said, bytes: body.len() - 50 * said as usize });
    }
    let mut welder = Welder::default();
    for triangle in body.chunks_exact(50) {
        let number = |i: usize| f64::from(f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[12 + 4 * i + byte])));
        welder.triangle([0, 3, 6].map(|at| [number(at), number(at + 1), number(at + 2)]));
    }
    Ok(welder.mesh)
}

/// `vertex x y z`, three a facet; words in capitals are the same.
fn read_ascii_stl(text: &str) -> Result<Mesh, MeshError> {
    let mut welder = Welder::default();
    let mut corners = Vec::with_capacity(3);
    let last = text.lines().count();
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split_whitespace();
        let line = index + 1;
        match words.next().unwrap_or_default().to_ascii_lowercase().as_str() {
            "vertex" => {
                corners.push(point(words.clone(), index)?);
                if words.count() != 3 {
                    return Err(MeshError::Line { line, expected: "three numbers, and no more" });
                }
            }
            "endloop" | "endfacet" | "end" => {
                match corners[..] {
                    [] => {}
                    [a, b, c] => welder.triangle([a, b, c]),
                    _ => return Err(MeshError::Line { line, expected: "three vertices a facet" }),
                }
                corners.clear();
            }
            "" | "#" | "solid" | "endsolid" | "facet" | "outer" | "color" => {}
            _ => {
                return Err(MeshError::Line {
                    line,
                    expected: "solid, facet, outer loop, vertex, endloop, endfacet or endsolid",
                });
            }
        }
    }
    if corners.is_empty() { Ok(welder.mesh) } else { Err(MeshError::Line { line: last, expected: "endloop" }) }
}

/// Statements of OBJ that leave its solids as they are.
const NOTHING_SOLID: [&str; 20] = [
    "vt",
    "vn",
    "vp",
    "p",
    "l",
    "g",
    "o",
    "s",
    "mg",
    "usemtl",
    "mtllib",
    "usemap",
    "maplib",
    "bevel",
    "c_interp",
    "d_interp",
    "lod",
    "shadow_obj",
    "trace_obj",
    "version",
];

/// `v x y z` and `f a b c …` (from 1, or from the end if negative; `a/b/c` has texture and normal too); faces of more
/// corners are cut into triangles. Words are apart by any white space. What names, groups or paints these, points and
/// lines are passed over.
fn read_obj(text: &str, faces: Faces) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::default();
    for (index, line) in text.lines().enumerate() {
        let mut words = line.split('#').next().unwrap_or_default().split_whitespace();
        let word = words.next();
        if word == Some("v") {
            mesh.vertices.push(point(words, index)?);
        } else if word == Some("f") {
            let error = MeshError::Line { line: index + 1, expected: "f with at least three vertices given before" };
            let corners = words.map(|corner| corner_index(corner, mesh.vertices.len()));
            let Some(corners) = corners.collect::<Option<Vec<u32>>>().filter(|corners| corners.len() >= 3) else {
                return Err(error);
            };
            let places: Vec<[f64; 3]> = corners.iter().map(|corner| mesh.vertices[*corner as usize]).collect();
            let cut = polygon::cut(&places, faces).map_err(|why| MeshError::Face {
                place: format!("line {}", index + 1),
                corners: corners.len(),
                why,
            })?;
            mesh.triangles.extend(cut.iter().map(|triangle| triangle.map(|corner| corners[corner])));
        } else if let Some(word) = word.filter(|word| !NOTHING_SOLID.contains(word)) {
            return Err(MeshError::Statement { line: index + 1, word: word.into() });
        }
    }
    Ok(mesh)
}

fn corner_index(corner: &str, count: usize) -> Option<u32> {
    let given: i64 = corner.split('/').next()?.parse().ok()?;
    let index = if given < 0 { count as i64 + given } else { given - 1 };
    (0..count as i64).contains(&index).then(|| u32::try_from(index).ok())?
}

fn point<'t>(words: impl Iterator<Item = &'t str>, index: usize) -> Result<[f64; 3], MeshError> {
    let mut numbers = words.map(|word| word.parse::<f64>().ok());
    match [numbers.next(), numbers.next(), numbers.next()] {
        [Some(Some(x)), Some(Some(y)), Some(Some(z))] => Ok([x, y, z]),
        _ => Err(MeshError::Line { line: index + 1, expected: "three numbers" }),
    }
}

/// Joins corners that are equal to the bit.
#[derive(Default)]
struct Welder {
    mesh: Mesh,
    known: BTreeMap<[u64; 3], u32>,
}

impl Welder {
    fn triangle(&mut self, corners: [[f64; 3]; 3]) {
        let triangle = corners.map(|corner| {
            // −0 and 0 are the same place.
            let key = corner.map(|x| (x + 0.0).to_bits());
            *self.known.entry(key).or_insert_with(|| {
                self.mesh.vertices.push(corner);
                (self.mesh.vertices.len() - 1) as u32
            })
        });
        self.mesh.triangles.push(triangle);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const CORNERS: [[f32; 3]; 4] = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 2.0, 0.0], [0.0, 0.0, 3.0]];
    const FACES: [[usize; 3]; 4] = [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]];

    fn binary(header: &[u8]) -> Vec<u8> {
        let mut bytes = vec![b' '; 80];
        bytes[..header.len()].copy_from_slice(header);
        bytes.extend(4u32.to_le_bytes());
        for face in FACES {
            bytes.extend([0; 12]);
            bytes.extend(face.iter().flat_map(|&i| CORNERS[i]).flat_map(f32::to_le_bytes));
            bytes.extend([0; 2]);
        }
        bytes
    }

    #[test]
    fn the_three_ways_to_write_a_tetrahedron_agree() {
        let read = read_mesh(&binary(b"solid misleading"), "a.STL").unwrap();
        assert_eq!((read.vertices.len(), read.triangles.len()), (4, 4));
        let mut ascii = String::from("solid t\n");
        for face in FACES {
            ascii += " facet normal 0 0 0\n  outer loop\n";
            for i in face {
                ascii += &format!("   vertex {:e} {:e} {:e}\n", CORNERS[i][0], CORNERS[i][1], CORNERS[i][2]);
            }
            ascii += "  endloop\n endfacet\n";
        }
        assert_eq!(read_mesh(ascii.as_bytes(), "a.stl").unwrap(), read);
        let obj = "# t\nv 0 0 0\nv 1 0 0\nv 0 2 0\nv 0 0 3\nf 1/1/1 3//2 2\nf 1 2 4\nf -4 -1 -2\nf 2 3 4\n";
        let obj = read_mesh(obj.as_bytes(), "a.obj").unwrap();
        let place = |mesh: &Mesh, t: [u32; 3]| t.map(|i| mesh.vertices[i as usize]);
        for i in 0..4 {
            assert_eq!(place(&obj, obj.triangles[i]), place(&read, read.triangles[i]));
        }
        let quad = read_mesh(b"v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4", "q.obj").unwrap();
        assert_eq!(quad.triangles, [[0, 1, 2], [0, 2, 3]]);
    }

    #[test]
    fn concave_faces_are_cut_and_what_is_no_face_is_refused_with_its_line() {
        // An L, which a fan from its second corner would leave.
        let l = "v 0 0 0\nv 4 0 0\nv 4 1 0\nv 1 1 0\nv 1 4 0\nv 0 4 0\n";
        let read = read_mesh(format!("{l}f 2 3 4 5 6 1\n").as_bytes(), "a.obj").unwrap();
        let twice = |t: &[u32; 3]| {
            let [a, b, c] = t.map(|i| read.vertices[i as usize]);
            (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        };
        assert!(read.triangles.len() == 4 && read.triangles.iter().all(|t| twice(t) > 0.0), "{:?}", read.triangles);
        assert!((read.triangles.iter().map(twice).sum::<f64>() - 14.0).abs() < 1e-12);
        let bow = read_mesh(format!("{l}f 1 3 2 6\n").as_bytes(), "a.obj").unwrap_err();
        assert_eq!(bow.to_string(), "line 7: a face of 4 corners crosses itself");
    }

    #[test]
    fn a_solid_with_uneven_faces_holds_both_ways_to_cut_them() {
        // A box whose lid is lifted at one corner, wound outwards, and inwards.
        let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1.5\nv 0 1 1\n";
        let quads = [[4, 3, 2, 1], [5, 6, 7, 8], [1, 2, 6, 5], [2, 3, 7, 6], [3, 4, 8, 7], [4, 1, 5, 8]];
        for from in 0..4 {
            for turned in [false, true] {
                let mut text = corners.to_owned();
                for mut quad in quads {
                    quad.rotate_left(from);
                    if turned {
                        quad.reverse();
                    }
                    text += &format!("f {} {} {} {}\n", quad[0], quad[1], quad[2], quad[3]);
                }
                let read = read_mesh(text.as_bytes(), "a.obj").unwrap();
                let shape = hairpin::world::Shape::mesh(&read.vertices, &read.triangles).unwrap();
                // Over its diagonal the lid is as high as the lifted corner's share, 1.25, or flat, 1.
                assert!(shape.signed_distance(&[0.5, 0.5, 1.2].into()) < 0.0, "{from} {turned}");
                assert_eq!(read_mesh_of_hulls(text.as_bytes(), "a.obj").unwrap().triangles.len(), 5 * 2 + 4);
            }
        }
    }

    #[test]
    fn words_are_read_in_capitals_and_between_any_white_space() {
        let obj = "v 0 0 0\nv 1 0 0\nv 0 2 0\nf 1 2 3\n";
        let read = read_mesh(obj.as_bytes(), "a.obj").unwrap();
        assert_eq!((read.vertices.len(), read.triangles.len()), (3, 1));
        for spaced in [obj.replace(' ', "\t"), obj.replace(' ', "  \t"), obj.replace('\n', "\r\n")] {
            assert_eq!(read_mesh(spaced.as_bytes(), "a.obj").unwrap(), read, "{spaced:?}");
        }
        let stl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 2 0\nendloop\n\
                   endfacet\nendsolid s\n";
        for spelled in [stl.to_owned(), stl.to_uppercase(), stl.replace("vertex ", "\t VERTEX\t")] {
            assert_eq!(read_mesh(spelled.as_bytes(), "a.stl").unwrap(), read, "{spelled:?}");
        }
    }

    #[test]
    fn files_without_triangles_are_refused() {
        let none = |bytes: &[u8], name: &str| read_mesh(bytes, name).unwrap_err().to_string();
        let empty = [&[b' '; 80][..], &[0; 4]].concat();
        for (bytes, name, words) in [
            (&b"v 0 0 0\nv 1 0 0\n"[..], "a.obj", "holds no triangles: none of its 2 lines begins with f"),
            (&b"v 0 0 0\rv 1 0 0\rv 0 1 0\rf 1 2 3"[..], "a.obj", "none of its 1 lines begins with f"),
            (&b""[..], "a.obj", "none of its 0 lines begins with f"),
            (&b"solid s\nendsolid s\n"[..], "a.stl", "none of its 2 lines begins with vertex"),
            (&empty[..], "a.stl", "its header says 0"),
            (&b"solid s\n facet normal 0 0 1\n"[..], "a.stl", "none of its 2 lines begins with vertex"),
            (&b"solid s\nvertex 0 0 0 vertex 1 0 0\n"[..], "a.stl", "line 2: expected three numbers, and no more"),
        ] {
            assert!(none(bytes, name).contains(words), "{}", none(bytes, name));
        }
    }

    #[test]
    fn what_is_not_read_is_refused_whatever_stands_beside_it() {
        let told = |bytes: &[u8], name: &str| read_mesh(bytes, name).unwrap_err().to_string();
        // Two files in one: the second is beyond what the header of the first says.
        let two = [binary(b""), binary(b"")].concat();
        assert_eq!(told(&two, "a.stl"), "says 4 triangles, and 284 bytes more follow them");
        let padded = [binary(b""), vec![0; 49]].concat();
        assert_eq!(read_mesh(&padded, "a.stl"), read_mesh(&binary(b""), "a.stl"));
        // What begins with `solid` is told as what it is.
        let begins = binary(b"solid s");
        assert_eq!(told(&begins[..150], "a.stl"), "says 4 triangles, but holds 1");
        let facet = "facet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 2 0\nendloop\nendfacet\n";
        let twice = format!("solid s\n{facet}{facet}endsolid s\n");
        assert_eq!(read_mesh(twice.as_bytes(), "a.stl").unwrap().triangles.len(), 2);
        for (from, to, words) in [
            ("vertex 1", "vertx 1", "line 5: expected solid, facet, outer loop, vertex"),
            ("vertex 1 0 0\n", "", "line 6: expected three vertices a facet"),
            ("endloop", "endlop", "line 7: expected solid"),
        ] {
            let text = format!("solid s\n{}", facet.replace(from, to));
            assert!(told(text.as_bytes(), "a.stl").contains(words), "{}", told(text.as_bytes(), "a.stl"));
        }
        let obj = "mtllib a.mtl\no a\nv 0 0 0\nv 1 0 0\nv 0 2 0\nvn 0 0 1\nusemtl a\ns off\nf 1 2 3\n";
        assert!(read_mesh(obj.as_bytes(), "a.obj").is_ok());
        for word in ["call b.obj", "curv 0 1 1 2", "surf 0 1 0 1 1 2", "fo 1 2 3", "F 1 2 3"] {
            let name = word.split(' ').next().unwrap();
            let words = format!("line 10: {name:?} is a statement of OBJ that is not read");
            let text = format!("{obj}{word}\n");
            assert!(told(text.as_bytes(), "a.obj").starts_with(&words), "{}", told(text.as_bytes(), "a.obj"));
        }
    }

    #[test]
    fn broken_files_are_refused_with_the_place() {
        let cut = &binary(b"")[..150];
        assert_eq!(read_mesh(cut, "a.stl"), Err(MeshError::Truncated { said: 4, found: 1 }));
        assert_eq!(read_mesh(b"xx", "a.stl"), Err(MeshError::NoHeader { bytes: 2 }));
        assert_eq!(read_mesh(b"", "a.ply"), Err(MeshError::Format));
        assert!(matches!(read_mesh(b"v 0 0\n", "a.obj"), Err(MeshError::Line { line: 1, .. })));
        assert!(matches!(read_mesh(b"v 0 0 0\nf 1 2 3\n", "a.obj"), Err(MeshError::Line { line: 2, .. })));
        assert_eq!(read_mesh(b"v 0 0 nan\n", "a.obj"), Err(MeshError::NotFinite { vertex: 0 }));
        assert!(matches!(read_mesh(b"solid\nvertex 0 0 0\n", "a.stl"), Err(MeshError::Line { line: 2, .. })));
    }
}
