//! Where a node of a scene stands.

use hairpin::math::rotation::from_rotation_vector;
use nalgebra::{Matrix4, Vector3};
use roxmltree::Node;

use super::super::types::MeshError;
use super::geometry::{child, numbers};

/// What turns a file's own axes and unit into metres with z up.
pub(super) fn upright(asset: Option<&Node>) -> Result<Matrix4<f64>, MeshError> {
    let unit = asset.and_then(|asset| child(asset, "unit")).and_then(|unit| unit.attribute("meter"));
    let unit = match unit.map(|text| (text, text.trim().parse::<f64>())) {
        None => 1.0,
        Some((_, Ok(metres))) if metres.is_finite() && metres > 0.0 => metres,
        Some((text, _)) => return Err(MeshError::NoCollada(format!("its unit, meter = {text:?}, is no length"))),
    };
    let up = asset.and_then(|asset| child(asset, "up_axis"));
    let turn = match up.and_then(|up| up.text()).map(str::trim) {
        Some("Z_UP") => Matrix4::identity(),
        // Right, up and in of each are right, up and in of all: x, y, z; −y, x, z; x, z, −y.
        None | Some("Y_UP") => rows([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]]),
        Some("X_UP") => rows([[0.0, -1.0, 0.0], [0.0, 0.0, -1.0], [1.0, 0.0, 0.0]]),
        Some(other) => return Err(MeshError::NoCollada(format!("its up_axis is {other:?}"))),
    };
    Ok(turn * Matrix4::new_scaling(unit))
}

fn rows(rows: [[f64; 3]; 3]) -> Matrix4<f64> {
    Matrix4::from_fn(|i, j| if i < 3 && j < 3 { rows[i][j] } else { f64::from(u8::from(i == j)) })
}

/// All transforms of a node, one after the other.
pub(super) fn place_of(node: &Node) -> Result<Matrix4<f64>, MeshError> {
    let mut place = Matrix4::identity();
    for element in node.children().filter(Node::is_element) {
        let given = |count| counted(&element, count);
        place *= match element.tag_name().name() {
            "matrix" => matrix(&element)?,
            "translate" => {
                let v = given(3)?;
                Matrix4::new_translation(&Vector3::new(v[0], v[1], v[2]))
            }
            "scale" => {
                let v = given(3)?;
                Matrix4::new_nonuniform_scaling(&Vector3::new(v[0], v[1], v[2]))
            }
            "rotate" => {
                let v = given(4)?;
                let axis = Vector3::new(v[0], v[1], v[2]).try_normalize(0.0).unwrap_or_else(Vector3::zeros);
                from_rotation_vector(&(axis * v[3].to_radians())).to_homogeneous()
            }
            name @ ("lookat" | "skew") => {
                return Err(MeshError::NoCollada(format!("<{name}> places one of its nodes, which is not read")));
            }
            _ => continue,
        };
    }
    Ok(place)
}

/// Row by row.
pub(super) fn matrix(element: &Node) -> Result<Matrix4<f64>, MeshError> {
    Ok(Matrix4::from_row_slice(&counted(element, 16)?))
}

fn counted(element: &Node, count: usize) -> Result<Vec<f64>, MeshError> {
    let found = numbers(element)?;
    if found.len() == count {
        return Ok(found);
    }
    let name = element.tag_name().name();
    Err(MeshError::NoCollada(format!("<{name}> has {} numbers, not {count}", found.len())))
}
