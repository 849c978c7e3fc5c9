//! Masses of links: each with what is fixed to it as one, its tensor of inertia turned into the link's axes.

use hairpin::robot::arm::MassDescription;
use nalgebra::{Matrix3, Vector3};
use roxmltree::Node;

use super::element::{UrdfError, child, number, origin};
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
    pub(super) fn add(&mut self, stand: &Stand, inertial: &Node) -> Result<Option<usize>, UrdfError> {
        let link = stand.of;
        let mass = child(inertial, "mass").map_or(Ok(0.0), |node| number(&node, "value"))?;
        let link_from_inertial = stand.pose * origin(inertial)?;
        let centre = link_from_inertial.translation.vector * 1e3;
        let turn = link_from_inertial.rotation.to_rotation_matrix();
        let own = child(inertial, "inertia").map_or(Ok(Matrix3::zeros()), |node| tensor(&node))?;
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

/// Products may be left out.
fn tensor(node: &Node) -> Result<Matrix3<f64>, UrdfError> {
    let product = |name: &str| node.attribute(name).map_or(Ok(0.0), |_| number(node, name));
    let (xx, yy, zz) = (number(node, "ixx")?, number(node, "iyy")?, number(node, "izz")?);
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
