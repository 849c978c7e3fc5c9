//! The cell of a scenario: its obstacles and keep-outs as named regions in the base frame, m.

use nalgebra::{Isometry3, Point3, Vector3};

use crate::campaign::digits::number;
use crate::campaign::scenario::{CellObstacle, CellSection, FrameSection, Mistake, frame_of};
use crate::world::cell::{Cell, Part, Region, Words};
use crate::world::{Shape, WorldError};

/// mm in a metre.
const MM: f64 = 1000.0;

/// Builds the regions.
///
/// # Errors
/// The key whose shape is none.
pub(super) fn cell_of(section: &CellSection) -> Result<Cell, Mistake> {
    let mut cell = Cell::default();
    for (index, obstacle) in section.obstacles.iter().enumerate() {
        let key = format!("world.obstacles[{index}]");
        let name = if obstacle.name.is_empty() { format!("obstacle {index}") } else { obstacle.name.clone() };
        cell.parts.push(Part { name, region: region_of(&key, obstacle)? });
    }
    for (index, text) in section.keep_out_mm.iter().enumerate() {
        let words = Words::parse(text, MM).map_err(|error| Mistake {
            key: format!("world.keep_out_mm[{index}]"),
            value: format!("\"{text}\""),
            bound: format!("an inequation such as x^2 + y^2 < 190^2 and z < 480: {error}"),
        })?;
        cell.parts.push(Part { name: format!("keep-out {text}"), region: Region::Words(words) });
    }
    Ok(cell)
}

/// Keys are in mm, regions in m, base frame. A box with an orientation becomes the hull of its eight corners, one
/// without stays a box; a half space keeps its normal as given. Sizes that are none (NaN, negative) are the shape's
/// own error, told with the key in mm.
fn region_of(key: &str, obstacle: &CellObstacle) -> Result<Region, Mistake> {
    let CellObstacle { name: _, cuboid, sphere, capsule, cylinder, hull, mesh, half_space } = obstacle;
    let given = [
        cuboid.is_some(),
        sphere.is_some(),
        capsule.is_some(),
        cylinder.is_some(),
        hull.is_some(),
        mesh.is_some(),
        half_space.is_some(),
    ];
    let count = given.into_iter().filter(|given| *given).count();
    if count != 1 {
        return Err(Mistake {
            key: key.into(),
            value: format!("{count} shapes"),
            bound: "exactly one of box, sphere, capsule, cylinder, hull, mesh, half_space".into(),
        });
    }
    let wrong = |error: WorldError| Mistake {
        key: format!("{key}.{}", in_mm(&error.field)),
        value: error.value,
        bound: format!("{} (in m: the key has mm)", error.bound),
    };
    let shape = |shape: Result<Shape, WorldError>| shape.map(Region::Shape).map_err(wrong);
    let region = |region: Result<Region, WorldError>| region.map_err(wrong);
    if let Some(it) = cuboid {
        return match it.q1_q4 {
            None => shape(Shape::cuboid(metres(it.center_mm), metres(it.size_mm))),
            Some(q1_q4) => {
                let frame = frame_of(&format!("{key}.box"), &FrameSection { mm: it.center_mm, q1_q4 })?;
                // The hull would take a negative size for its amount.
                shape(Shape::cuboid(metres(it.center_mm), metres(it.size_mm)))?;
                shape(Shape::hull(&corners(&frame, metres(it.size_mm))))
            }
        };
    }
    if let Some(it) = sphere {
        return shape(Shape::sphere(metres(it.center_mm), it.radius_mm / MM));
    }
    if let Some(it) = capsule {
        return shape(Shape::capsule(metres(it.a_mm), metres(it.b_mm), it.radius_mm / MM));
    }
    if let Some(it) = cylinder {
        return region(Region::cylinder(metres(it.a_mm), metres(it.b_mm), it.radius_mm / MM));
    }
    if let Some(it) = hull {
        let points: Vec<[f64; 3]> = it.points_mm.iter().map(|point| metres(*point)).collect();
        return shape(Shape::hull(&points));
    }
    if let Some(it) = mesh {
        if let Some(scale) = it.scale_mm {
            let bound = "left out where vertices are given: they are in mm".into();
            return Err(Mistake { key: format!("{key}.mesh.scale_mm"), value: scale.to_string(), bound });
        }
        let vertices: Vec<[f64; 3]> = it.vertices_mm.iter().map(|vertex| metres(*vertex)).collect();
        let solid = Shape::mesh(&vertices, &it.triangles).map_err(wrong)?;
        return of_a_cells_size(key, &solid).map(|()| Region::Shape(solid));
    }
    let Some(it) = half_space else { unreachable!("one shape is given") };
    region(Region::half_space(it.normal, it.offset_mm / MM))
}

/// Meshes shorter or longer, m, are in another unit than was taken.
const MESH_LENGTHS: [f64; 2] = [0.005, 50.0];

/// A mesh in m that is taken for mm is smaller than a thumbnail, and stands in nobody's way.
fn of_a_cells_size(key: &str, mesh: &Shape) -> Result<(), Mistake> {
    let bounds = mesh.bounds();
    let length = (bounds.max - bounds.min).max();
    let [least, most] = MESH_LENGTHS;
    if (least..=most).contains(&length) {
        return Ok(());
    }
    let unit =
        if length < least { "m? `scale_mm = 1000` beside its file" } else { "mm? `scale_mm = 1` beside its file" };
    let bound = format!("from {} to {} mm long; {unit}", least * MM, most * MM);
    Err(Mistake { key: format!("{key}.mesh"), value: format!("{} mm long", number(Some(length * MM))), bound })
}

fn metres(mm: [f64; 3]) -> [f64; 3] {
    mm.map(|part| part / MM)
}

/// `box.size_m` as the key that scenarios of arms have.
fn in_mm(field: &str) -> String {
    match field.strip_suffix("_m") {
        Some(stem) => format!("{stem}_mm"),
        None => field.replace("_m[", "_mm["),
    }
}

/// The eight corners of a box of edges `size` (m) centred in `frame`; bit k of a corner's number says on which side it
/// is along axis k.
fn corners(frame: &Isometry3<f64>, size: [f64; 3]) -> Vec<[f64; 3]> {
    let half = Vector3::from(size) * 0.5;
    let corner = |c: usize| {
        let sign = |axis: usize| if c >> axis & 1 == 1 { 1.0 } else { -1.0 };
        let local = Point3::new(sign(0) * half.x, sign(1) * half.y, sign(2) * half.z);
        (frame * local).coords.into()
    };
    (0..8).map(corner).collect()
}
