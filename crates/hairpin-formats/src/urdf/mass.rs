//! Masses of links: each with what is fixed to it as one, its tensor of inertia turned into the link's axes.
//!
//! No body has any tensor. Its principal moments A ≤ B ≤ C are ∫ of two squared distances each, so that
//!
//! ```text
//! C ≤ A + B      and with that 0 ≤ A
//! ```
//!
//! What a file's last digits leave open is no mistake. Published files are beyond by more (an arm's by 0.14 C, a hand's
//! by 0.28 C, a camera's by 0.51 C): that is told. C − A − B above 0.6 C, of which a plate has 0 and a point beside two
//! nothings all, or A below −0.05 C, is refused.

use hairpin::robot::arm::MassDescription;
use nalgebra::{Matrix3, Vector3};
use roxmltree::Node;

use super::element::{UrdfError, at, at_attribute, child, number, origin, told};
use super::stand::Stand;
use super::tip::AXES;

/// Of links that move, one entry each.
#[derive(Default)]
pub(super) struct Masses {
    pub(super) all: Vec<MassDescription>,
    /// Tensors that no body has, but nearly.
    pub(super) said: Vec<String>,
}

/// So much of the largest principal moment it may be beyond what a body can have, and is told; more is refused …
const NEARLY: f64 = 0.6;
/// … and a principal moment may be as much below 0.
const BELOW: f64 = 0.05;
/// What is as little as a gram's a millimetre off is nobody's care, kg m².
const LEAST: f64 = 1e-9;
/// What binary numbers round, of the largest principal moment.
const ROUNDED: f64 = 1e-9;

impl Masses {
    /// Joins the mass of `inertial` with what its link already has: I = Σ (R I Rᵀ + m (d² − d dᵀ)) about the common
    /// centre. Which entry is new, if one is.
    ///
    /// Each is held to what masses can be before it is joined: what it is joined to would hide it. `name` is its
    /// link's.
    pub(super) fn add(&mut self, name: &str, stand: &Stand, inertial: &Node) -> Result<Option<usize>, UrdfError> {
        let link = stand.of;
        let Some(mass) = child(inertial, "mass") else {
            self.said.push(format!("link `{}`: its <inertial> without <mass> counts as none", told(name)));
            return Ok(None);
        };
        let mass = not_negative(&mass, name, "value", "mass, kg")?;
        let link_from_inertial = stand.pose * origin(inertial)?;
        let centre = link_from_inertial.translation.vector * 1e3;
        let turn = link_from_inertial.rotation.to_rotation_matrix();
        let own = match child(inertial, "inertia") {
            Some(node) => {
                let own = tensor(&node, name)?;
                self.said.extend(of_a_body(&own, &node, name)?);
                own
            }
            None => {
                let what = "its <inertial> without <inertia> is that of a point";
                self.said.push(format!("link `{}`: {what}", told(name)));
                Matrix3::zeros()
            }
        };
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

/// What is told of a tensor that a body nearly has; nothing of one that it may have.
///
/// With a last digit of q every number of the tensor may be off by q/2, and C − A − B = 2 C − tr by 1.5 q, with
/// products by 4.5 q.
fn of_a_body(tensor: &Matrix3<f64>, node: &Node, name: &str) -> Result<Option<String>, UrdfError> {
    let largest = tensor.amax();
    if largest == 0.0 {
        return Ok(None);
    }
    let mut moments: [f64; 3] = (tensor / largest).symmetric_eigenvalues().into();
    moments.sort_by(f64::total_cmp);
    let moments = moments.map(|moment| largest * moment);
    let [least, middle, most] = moments;
    let has_products = [tensor[(0, 1)], tensor[(0, 2)], tensor[(1, 2)]].iter().any(|product| *product != 0.0);
    let digit = if has_products { 4.5 } else { 1.5 } * last_digit(node);
    let beyond = most - least - middle;
    if beyond <= digit.max(ROUNDED * most).max(LEAST) {
        return Ok(None);
    }
    let what = format!(
        "link `{}`: principal moments of inertia {} kg m²: no body has them, the largest is at most the sum of the others",
        told(name),
        moments.map(|moment| format!("{moment:.4e}")).join(", ")
    );
    if beyond <= NEARLY * most && least >= -BELOW * most { Ok(Some(what)) } else { Err(at(node, &what)) }
}

/// The finest last digit that a number other than 0 of the tensor is written with: 0.001 of `0.012`, 1e-6 of `1.2e-5`;
/// 0 where none is finite.
fn last_digit(node: &Node) -> f64 {
    let of = |text: &str| {
        let (mantissa, exponent) = text.split_once(['e', 'E']).unwrap_or((text, "0"));
        let exponent: i32 = exponent.parse().ok()?;
        let decimals = mantissa.split_once('.').map_or(0, |(_, decimals)| decimals.len());
        let is_given = mantissa.contains(|c: char| ('1'..='9').contains(&c));
        is_given.then(|| libm::exp10(f64::from(exponent) - decimals as f64))
    };
    let all = ["ixx", "iyy", "izz", "ixy", "ixz", "iyz"].into_iter().filter_map(|key| of(node.attribute(key)?.trim()));
    Some(all.fold(f64::INFINITY, f64::min)).filter(|digit| digit.is_finite()).unwrap_or(0.0)
}

/// Products may be left out.
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
