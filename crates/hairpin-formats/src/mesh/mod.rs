//! Triangle meshes in: STL (binary and ASCII), OBJ and Collada, as vertices that triangles share.

mod collada;
mod types;

use std::collections::BTreeMap;

pub use types::{Mesh, MeshError};

/// Reads a mesh; the ending of `name` tells OBJ, STL and Collada (`.dae`) apart. Coordinates of OBJ and STL are taken
/// as metres; Collada says its unit.
///
/// # Errors
/// [`MeshError`].
pub fn read_mesh(bytes: &[u8], name: &str) -> Result<Mesh, MeshError> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    let mesh = match ending.as_str() {
        "obj" => read_obj(&String::from_utf8_lossy(bytes))?,
        "dae" => collada::read_collada(&String::from_utf8_lossy(bytes))?,
        "stl" if is_ascii_stl(bytes) => read_ascii_stl(&String::from_utf8_lossy(bytes))?,
        "stl" => read_binary_stl(bytes)?,
        _ => return Err(MeshError::Format),
    };
    match mesh.vertices.iter().position(|v| v.iter().any(|x| !x.is_finite())) {
        Some(vertex) => Err(MeshError::NotFinite { vertex }),
        None => Ok(mesh),
    }
}

/// Binary files may begin with `solid` too: the length decides.
fn is_ascii_stl(bytes: &[u8]) -> bool {
    let said = bytes.get(80..84).map(|n| u64::from(u32::from_le_bytes([n[0], n[1], n[2], n[3]])));
    bytes.trim_ascii_start().starts_with(b"solid") && said.is_none_or(|said| 84 + 50 * said != bytes.len() as u64)
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
    let mut welder = Welder::default();
    for triangle in body.chunks_exact(50).take(said as usize) {
        let number = |i: usize| f64::from(f32::from_le_bytes([0, 1, 2, 3].map(|byte| triangle[12 + 4 * i + byte])));
        welder.triangle([0, 3, 6].map(|at| [number(at), number(at + 1), number(at + 2)]));
    }
    Ok(welder.mesh)
}

fn read_ascii_stl(text: &str) -> Result<Mesh, MeshError> {
    let mut welder = Welder::default();
    let mut corners = Vec::with_capacity(3);
    for (index, line) in text.lines().enumerate() {
        let Some(rest) = line.trim().strip_prefix("vertex") else { continue };
        corners.push(point(rest, index)?);
        if let [a, b, c] = corners[..] {
            welder.triangle([a, b, c]);
            corners.clear();
        }
    }
    let last = text.lines().count();
    if corners.is_empty() {
        Ok(welder.mesh)
    } else {
        Err(MeshError::Line { line: last, expected: "three vertices a facet" })
    }
}

/// `v x y z` and `f a b c …` (from 1, or from the end if negative; `a/b/c` has texture and normal too); faces of more
/// corners become fans. Everything else is passed over.
fn read_obj(text: &str) -> Result<Mesh, MeshError> {
    let mut mesh = Mesh::default();
    for (index, line) in text.lines().enumerate() {
        let line = line.split('#').next().unwrap_or_default().trim();
        if let Some(rest) = line.strip_prefix("v ") {
            mesh.vertices.push(point(rest, index)?);
        } else if let Some(rest) = line.strip_prefix("f ") {
            let error = MeshError::Line { line: index + 1, expected: "f with at least three vertices given before" };
            let corners = rest.split_whitespace().map(|corner| corner_index(corner, mesh.vertices.len()));
            let Some(corners) = corners.collect::<Option<Vec<u32>>>().filter(|corners| corners.len() >= 3) else {
                return Err(error);
            };
            mesh.triangles.extend((2..corners.len()).map(|i| [corners[0], corners[i - 1], corners[i]]));
        }
    }
    Ok(mesh)
}

fn corner_index(corner: &str, count: usize) -> Option<u32> {
    let given: i64 = corner.split('/').next()?.parse().ok()?;
    let index = if given < 0 { count as i64 + given } else { given - 1 };
    (0..count as i64).contains(&index).then(|| u32::try_from(index).ok())?
}

fn point(text: &str, index: usize) -> Result<[f64; 3], MeshError> {
    let mut numbers = text.split_whitespace().map(|word| word.parse::<f64>().ok());
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
