//! The triangles of one geometry.

use std::collections::BTreeMap;

use roxmltree::Node;

use super::super::polygon::{self, Faces};
use super::super::types::{MOST_TRIANGLES, MeshError};

/// Points and triangles.
pub(super) type Triangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// What a geometry is made of, in its own unit.
pub(super) fn triangles_of(
    geometry: &Node,
    named: &BTreeMap<&str, Node>,
    uneven: Faces,
) -> Result<Triangles, MeshError> {
    let Some(mesh) = child(geometry, "mesh") else {
        let what = geometry.children().find(Node::is_element).map_or("nothing", |node| node.tag_name().name());
        return Err(MeshError::NoCollada(format!("a geometry is {what}, no <mesh>")));
    };
    let (mut points, mut triangles) = (Vec::new(), Vec::new());
    let mut known: BTreeMap<&str, u32> = BTreeMap::new();
    for primitive in mesh.children().filter(Node::is_element) {
        let kind = primitive.tag_name().name();
        match kind {
            "triangles" | "polylist" | "polygons" | "tristrips" | "trifans" => {}
            "source" | "vertices" | "lines" | "linestrips" | "extra" => continue,
            _ => {
                let line = line(&primitive);
                return Err(MeshError::NoCollada(format!("line {line}: <{kind}> of a mesh is not read")));
            }
        }
        let inputs: Vec<Node> = children(&primitive, "input").collect();
        let offset = |node: &Node| node.attribute("offset").and_then(|text| text.parse::<usize>().ok()).unwrap_or(0);
        let stride = inputs.iter().map(offset).max().unwrap_or(0) + 1;
        let vertex = inputs.iter().find(|input| input.attribute("semantic") == Some("VERTEX"));
        let Some(vertex) = vertex.filter(|_| stride <= 64) else {
            return Err(MeshError::NoCollada(format!("<{kind}> has no vertices")));
        };
        let source = vertex.attribute("source").unwrap_or_default();
        let first = match known.get(source) {
            Some(first) => *first,
            None => {
                let first = points.len() as u32;
                points.extend(positions(source, named)?);
                known.insert(source, first);
                first
            }
        };
        let corners = Corners { at: offset(vertex), stride, first, count: points.len() as u32 - first };
        for (number, face) in faces(&primitive, kind, &corners)?.into_iter().enumerate() {
            if triangles.len() + face.len() > MOST_TRIANGLES {
                return Err(MeshError::TooMany(MOST_TRIANGLES));
            }
            match kind {
                // Triangles of a strip share two corners each, every second one in the opposite order.
                "tristrips" => triangles.extend((2..face.len()).map(|i| match i % 2 {
                    0 => [face[i - 2], face[i - 1], face[i]],
                    _ => [face[i - 1], face[i - 2], face[i]],
                })),
                "triangles" | "trifans" => triangles.extend((2..face.len()).map(|i| [face[0], face[i - 1], face[i]])),
                _ => {
                    let places: Vec<[f64; 3]> = face.iter().map(|corner| points[*corner as usize]).collect();
                    let cut = polygon::cut(&places, uneven).map_err(|why| MeshError::Face {
                        place: format!("<{kind}> in line {}, face {number}", line(&primitive)),
                        corners: face.len(),
                        why,
                    })?;
                    triangles.extend(cut.iter().map(|triangle| triangle.map(|corner| face[corner])));
                }
            }
        }
    }
    Ok((points, triangles))
}

/// Which of a primitive's numbers are corners, and of which points.
struct Corners {
    at: usize,
    stride: usize,
    first: u32,
    count: u32,
}

impl Corners {
    /// The corners that `<p>` lists.
    fn of(&self, p: &Node) -> Result<Vec<u32>, MeshError> {
        let wrong = |what: String| MeshError::NoCollada(format!("<p>: {what}"));
        let mut corners = Vec::new();
        for (i, word) in words(p).enumerate() {
            if i % self.stride != self.at {
                continue;
            }
            let index = word.parse::<u32>().ok().filter(|index| *index < self.count);
            let index = index.ok_or_else(|| wrong(format!("{word:?} is no vertex: there are {}", self.count)))?;
            corners.push(index + self.first);
        }
        Ok(corners)
    }
}

/// The corners of each face, or of each strip or fan.
fn faces(primitive: &Node, kind: &str, corners: &Corners) -> Result<Vec<Vec<u32>>, MeshError> {
    let lists = children(primitive, "p").map(|p| corners.of(&p));
    match kind {
        "triangles" => {
            let all = lists.collect::<Result<Vec<_>, _>>()?.concat();
            let faces = all.chunks_exact(3);
            match faces.remainder() {
                [] => Ok(faces.map(<[u32]>::to_vec).collect()),
                _ => Err(MeshError::NoCollada(format!("<triangles>: {} corners are no whole triangles", all.len()))),
            }
        }
        "polylist" => {
            let all = lists.collect::<Result<Vec<_>, _>>()?.concat();
            let mut left = &all[..];
            let mut faces = Vec::new();
            for word in child(primitive, "vcount").iter().flat_map(words) {
                let count = word.parse::<usize>().ok().filter(|count| *count <= left.len());
                let count =
                    count.ok_or_else(|| MeshError::NoCollada(format!("<vcount>: {word:?} corners are not there")))?;
                let (face, rest) = left.split_at(count);
                faces.push(face.to_vec());
                left = rest;
            }
            if !left.is_empty() {
                return Err(MeshError::NoCollada(format!("<vcount>: {} corners belong to no face", left.len())));
            }
            Ok(faces)
        }
        // A polygon with holes is <ph>: what it is without them is no smaller.
        "polygons" => {
            let holed = children(primitive, "ph").filter_map(|ph| child(&ph, "p")).map(|p| corners.of(&p));
            lists.chain(holed).collect()
        }
        _ => lists.collect(),
    }
}

/// The points that `<vertices>` or a source of numbers has.
fn positions(source: &str, named: &BTreeMap<&str, Node>) -> Result<Vec<[f64; 3]>, MeshError> {
    let wrong = |what: &str| MeshError::NoCollada(format!("vertices {source:?}: {what}"));
    let meant = |name: &str| name.strip_prefix('#').and_then(|id| named.get(id)).copied();
    let mut node = meant(source).ok_or_else(|| wrong("are not in the file"))?;
    if node.tag_name().name() == "vertices" {
        let position = children(&node, "input").find(|input| input.attribute("semantic") == Some("POSITION"));
        let name = position.and_then(|input| input.attribute("source"));
        node = name.and_then(meant).ok_or_else(|| wrong("have no positions"))?;
    }
    let array = child(&node, "float_array").ok_or_else(|| wrong("have no numbers"))?;
    let all = numbers(&array)?;
    let accessor = child(&node, "technique_common").and_then(|common| child(&common, "accessor"));
    let count = |key: &str, usual: usize| {
        let given = accessor.and_then(|accessor| accessor.attribute(key));
        given.map_or(Some(usual), |text| text.trim().parse::<usize>().ok())
    };
    match (count("stride", 3), count("offset", 0)) {
        (Some(stride @ 3..=64), Some(offset)) if offset <= all.len() => {
            Ok(all[offset..].chunks_exact(stride).map(|chunk| [chunk[0], chunk[1], chunk[2]]).collect())
        }
        _ => Err(wrong("have an <accessor> that is not x, y, z")),
    }
}

/// Elements of a name within a node, whatever their namespace.
pub(super) fn children<'t>(of: &Node<'t, 't>, name: &'static str) -> impl Iterator<Item = Node<'t, 't>> + use<'t> {
    of.children().filter(move |node| node.is_element() && node.tag_name().name() == name)
}

/// The first of them.
pub(super) fn child<'t>(of: &Node<'t, 't>, name: &'static str) -> Option<Node<'t, 't>> {
    children(of, name).next()
}

fn words<'t>(of: &Node<'t, 't>) -> impl Iterator<Item = &'t str> {
    of.children().filter(Node::is_text).filter_map(|node| node.text()).flat_map(str::split_ascii_whitespace)
}

/// Finite numbers.
pub(super) fn numbers(of: &Node) -> Result<Vec<f64>, MeshError> {
    let number = |word: &str| {
        let parsed = word.parse::<f64>().ok().filter(|number| number.is_finite());
        parsed.ok_or_else(|| MeshError::NoCollada(format!("<{}>: {word:?} is no number", of.tag_name().name())))
    };
    words(of).map(number).collect()
}

/// Its line in the file.
pub(super) fn line(node: &Node) -> u32 {
    node.document().text_pos_at(node.range().start).row
}
