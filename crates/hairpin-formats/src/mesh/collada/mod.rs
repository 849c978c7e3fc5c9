//! Collada in: the triangles of a scene, in metres, z up.
//!
//! | read | as |
//! | --- | --- |
//! | `asset`: `unit`, `up_axis` | metres and z up, in place of what the file has |
//! | `scene`, `visual_scene`, `node`, `instance_node` | where its parts stand |
//! | `matrix`, `translate`, `rotate`, `scale` of a node | one after the other |
//! | `instance_geometry`, `instance_controller` (its skin's source) | a part |
//! | `triangles`, `polylist`, `polygons`, `tristrips`, `trifans` | triangles; faces of more corners are cut into some |
//! | colours, textures, lights, cameras, lines, animations | nothing |
//!
//! A file without a scene is taken for all of its geometries, each where it is.

mod geometry;
mod place;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use nalgebra::{Matrix4, Point3};
use roxmltree::{Document, Node, ParsingOptions};

use self::geometry::{child, children, line, triangles_of};
use self::place::{place_of, upright};
use super::polygon::Faces;
use super::types::{MOST_TRIANGLES, Mesh, MeshError};

/// Nodes within nodes, at most, and in all: a file may name one node again and again.
const DEEPEST: usize = 64;
const MOST_NODES: usize = 100_000;
/// Elements, attributes and texts of a file: its numbers stand in few.
const MOST_ELEMENTS: u32 = 2_000_000;
/// Bytes of a file: XML takes many times as much memory.
const LARGEST: usize = 64_000_000;

/// Reads the triangles of a Collada text.
///
/// # Errors
/// No XML, no Collada, numbers that are none, indices of nothing, more than is read.
pub(super) fn read_collada(text: &str, faces: Faces) -> Result<Mesh, MeshError> {
    if text.len() > LARGEST {
        return Err(MeshError::NoCollada(format!("{} bytes are more than {LARGEST}", text.len())));
    }
    let options = ParsingOptions { nodes_limit: MOST_ELEMENTS, ..ParsingOptions::default() };
    let document =
        Document::parse_with_options(text, options).map_err(|error| MeshError::NoCollada(error.to_string()))?;
    let root = document.root_element();
    if root.tag_name().name() != "COLLADA" {
        return Err(MeshError::NoCollada(format!("its root is <{}>", root.tag_name().name())));
    }
    let asset = child(&root, "asset");
    let mut scene = Scene { named: named(&root), faces, nodes: 0, mesh: Mesh::default() };
    let upright = upright(asset.as_ref())?;
    match scene.begin(&root)? {
        Some(visual) => scene.children(&visual, &upright, 0)?,
        None => {
            for geometry in root.descendants().filter(|node| node.has_tag_name_of("geometry")) {
                scene.part(&geometry, &upright)?;
            }
        }
    }
    Ok(scene.mesh)
}

/// Elements by their id.
fn named<'t>(root: &Node<'t, 't>) -> BTreeMap<&'t str, Node<'t, 't>> {
    root.descendants().filter_map(|node| Some((node.attribute("id")?, node))).collect()
}

/// Whether an element is called so, whatever its namespace.
trait Called {
    fn has_tag_name_of(&self, name: &str) -> bool;
}

impl Called for Node<'_, '_> {
    fn has_tag_name_of(&self, name: &str) -> bool {
        self.is_element() && self.tag_name().name() == name
    }
}

/// What has been gathered.
struct Scene<'t> {
    named: BTreeMap<&'t str, Node<'t, 't>>,
    faces: Faces,
    nodes: usize,
    mesh: Mesh,
}

impl<'t> Scene<'t> {
    /// The scene that is shown: the one named, or the only one that there is.
    fn begin(&self, root: &Node<'t, 't>) -> Result<Option<Node<'t, 't>>, MeshError> {
        if let Some(instance) = child(root, "scene").and_then(|scene| child(&scene, "instance_visual_scene")) {
            return self.meant(&instance, "url").map(Some);
        }
        let mut scenes = root.descendants().filter(|node| node.has_tag_name_of("visual_scene"));
        Ok(scenes.next().filter(|_| scenes.next().is_none()))
    }

    /// The element that `#id` names.
    fn meant(&self, from: &Node<'t, 't>, key: &str) -> Result<Node<'t, 't>, MeshError> {
        let given = from.attribute(key).unwrap_or_default();
        let found = given.strip_prefix('#').and_then(|id| self.named.get(id));
        found.copied().ok_or_else(|| {
            let name = from.tag_name().name();
            MeshError::NoCollada(format!("line {}: <{name}> names {given:?}, which is not in the file", line(from)))
        })
    }

    fn children(&mut self, of: &Node<'t, 't>, at: &Matrix4<f64>, depth: usize) -> Result<(), MeshError> {
        for node in children(of, "node") {
            self.node(&node, at, depth)?;
        }
        Ok(())
    }

    fn node(&mut self, node: &Node<'t, 't>, parent: &Matrix4<f64>, depth: usize) -> Result<(), MeshError> {
        self.nodes += 1;
        if depth > DEEPEST || self.nodes > MOST_NODES {
            let bound = format!("more than {DEEPEST} nodes within one another, or {MOST_NODES} in all");
            return Err(MeshError::NoCollada(bound));
        }
        let at = parent * place_of(node)?;
        for instance in children(node, "instance_geometry") {
            self.part(&self.meant(&instance, "url")?, &at)?;
        }
        for instance in children(node, "instance_controller") {
            let controller = self.meant(&instance, "url")?;
            let Some(skin) = child(&controller, "skin") else {
                let what =
                    controller.children().find(Node::is_element).map_or("nothing", |node| node.tag_name().name());
                let line = line(&controller);
                return Err(MeshError::NoCollada(format!("line {line}: a controller is {what}, which is not read")));
            };
            let bound = child(&skin, "bind_shape_matrix").map_or(Ok(Matrix4::identity()), |m| place::matrix(&m))?;
            self.part(&self.meant(&skin, "source")?, &(at * bound))?;
        }
        for instance in children(node, "instance_node") {
            self.node(&self.meant(&instance, "url")?, &at, depth + 1)?;
        }
        self.children(node, &at, depth + 1)
    }

    /// Adds a geometry where it stands.
    fn part(&mut self, geometry: &Node<'t, 't>, at: &Matrix4<f64>) -> Result<(), MeshError> {
        let (points, triangles) = triangles_of(geometry, &self.named, self.faces)?;
        if self.mesh.triangles.len() + triangles.len() > MOST_TRIANGLES {
            return Err(MeshError::TooMany(MOST_TRIANGLES));
        }
        let before = self.mesh.vertices.len() as u32;
        self.mesh
            .vertices
            .extend(points.iter().map(|p| <[f64; 3]>::from(at.transform_point(&Point3::from(*p)).coords)));
        // A mirror turns what is wound outwards inwards.
        let mirrored = at.fixed_view::<3, 3>(0, 0).determinant() < 0.0;
        self.mesh.triangles.extend(triangles.iter().map(|&[a, b, c]| {
            let triangle = if mirrored { [a, c, b] } else { [a, b, c] };
            triangle.map(|corner| corner + before)
        }));
        Ok(())
    }
}
