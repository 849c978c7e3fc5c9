//! Masses of links: each with what is fixed to it as one, its tensor of inertia turned into the link's axes.

use hairpin::robot::arm::MassDescription;
use nalgebra::{Matrix3, Vector3};
use roxmltree::Node;

use super::element::{UrdfError, at_attribute, child, number, origin, told};
use super::stand::Stand;
use super::tip::AXES;

/// Of links that move, one entry each.
#[derive(Default)]
pub(super) struct Masses {
    pub(super) all: Vec<MassDescription>,
}

impl Masses {
    /// Joins the mass of `inertial` with what its link already has: I = Σ (R I Rᵀ + m (d² − d dᵀ)) about the common
    /// centre. Which entry is new, if one is.
    ///
    /// Each is held to what masses can be before it is joined: what it is joined to would hide it. `name` is its
    /// link's.
    pub(super) fn add(&mut self, name: &str, stand: &Stand, inertial: &Node) -> Result<Option<usize>, UrdfError> {
        let link = stand.of;
        let mass = match child(inertial, "mass") {
            Some(node) => not_negative(&node, name, "value", "mass, kg")?,
            None => 0.0,
        };
        let link_from_inertial = stand.pose * origin(inertial)?;
        let centre = link_from_inertial.translation.vector * 1e3;
        let turn = link_from_inertial.rotation.to_rotation_matrix();
        let own = child(inertial, "inertia").map_or(Ok(Matrix3::zeros()), |node| tensor(&node, name))?;
        let own = turn.matrix() * own * turn.matrix().transpose();
        let Some(known) = self.all.iter_mut().find(|known| known.link == link) else {
            self.all.push(described(link, mass, centre, &own));
            return Ok(Some(self.all.len() - 1));
        };
        let whole = known.mass_kg + mass;
        if whole > 0.0 {
            let before = Vector3::from(known.centre_mm);
            let apart = (centre - before) * 1e-3;
            let spread = Matrix3::identity() * apart.norm_squared() - apart * apart.transpose();
            let joined = known.tensor() + own + spread * (known.mass_kg * mass / whole);
            *known = described(link, whole, (before * known.mass_kg + centre * mass) / whole, &joined);
        }
        Ok(None)
    }

    /// Keeps them only if all links that move have one; the first that has none, where others have.
    pub(super) fn of_all_or_none(&mut self) -> Option<usize> {
        let without = (1..=AXES).find(|link| self.all.iter().all(|mass| mass.link != *link))?;
        let some = !self.all.is_empty();
        self.all.clear();
        some.then_some(without)
    }
}

/// Of link `name`, at least 0.
fn not_negative(node: &Node, name: &str, attribute: &str, what: &str) -> Result<f64, UrdfError> {
    let value = number(node, attribute)?;
    if value >= 0.0 {
        return Ok(value);
    }
    let what = format!("link `{}`: {attribute} = {value}: must be a {what}, of at least 0", told(name));
    Err(at_attribute(node, attribute, &what))
}

/// Products may be left out. Moments alone are held to their bound: many a file's products are rounded.
fn tensor(node: &Node, name: &str) -> Result<Matrix3<f64>, UrdfError> {
    let moment = |attribute: &str| not_negative(node, name, attribute, "moment of inertia, kg m²");
    let product = |name: &str| node.attribute(name).map_or(Ok(0.0), |_| number(node, name));
    let (xx, yy, zz) = (moment("ixx")?, moment("iyy")?, moment("izz")?);
    let (xy, xz, yz) = (product("ixy")?, product("ixz")?, product("iyz")?);
    Ok(Matrix3::new(xx, xy, xz, xy, yy, yz, xz, yz, zz))
}

fn described(link: usize, mass_kg: f64, centre: Vector3<f64>, tensor: &Matrix3<f64>) -> MassDescription {
    MassDescription {
        link,
        mass_kg,
        centre_mm: centre.into(),
        inertia_kg_m2: [tensor[(0, 0)], tensor[(1, 1)], tensor[(2, 2)]],
        products_kg_m2: [tensor[(0, 1)], tensor[(0, 2)], tensor[(1, 2)]],
    }
}
