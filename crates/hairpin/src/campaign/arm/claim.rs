//! Hands an arm, its cell and a program to the verification room, as plain numbers.

use nalgebra::{Isometry3, Point3};

use super::ArmSetup;
use super::graph::allowed;
use crate::robot::arm::{AXES, Joints};
use crate::simulation::arm::{Order, Target};
use crate::verification::{
    ArmBodyClaim, ArmJointClaim, ArmMoveClaim, ArmMoveFinding, ArmMovesClaim, ArmSolidClaim, ArmSolidForm,
    verify_arm_moves,
};
use crate::world::cell::{Region, Words};
use crate::world::{Shape, Solid};

/// Whether words hold at a point.
type Holds = Box<dyn Fn(&Point3<f64>) -> bool>;

impl ArmSetup<'_> {
    /// Follows every move of `orders` by code of its own: bounds, targets, and the distance that links and tool keep from the cell. Zones are left out: a
    /// blend is another path, which its corner's triangle was proven for.
    pub(super) fn followed_again(&self, orders: &[Order]) -> Vec<ArmMoveFinding> {
        let station = self.station;
        let chain = &station.arm.chain;
        let joints: [ArmJointClaim; AXES] = std::array::from_fn(|k| ArmJointClaim {
            parent_from_joint: chain.joints[k].origin,
            axis: chain.joints[k].axis,
            bounds: [station.arm.limits[k].lower, station.arm.limits[k].upper],
        });
        let links = station.arm.links.iter().enumerate().skip(1);
        let mut bodies: Vec<ArmBodyClaim> = links
            .flat_map(|(link, body)| {
                body.capsules.iter().map(move |capsule| ArmBodyClaim {
                    link,
                    name: format!("link {link}"),
                    tool: false,
                    axis: [capsule.a, capsule.b],
                    radius: capsule.radius,
                })
            })
            .collect();
        let in_link = |p: Point3<f64>| chain.flange * p;
        let tip: Point3<f64> = station.tool.tcp.translation.vector.into();
        bodies.push(ArmBodyClaim {
            link: AXES,
            name: "the tool".into(),
            tool: true,
            axis: [in_link(Point3::origin()), in_link(tip)],
            radius: station.tool.radius,
        });
        // Words are not grown: they are held against the tool's line itself.
        let words: Vec<Option<Holds>> = station.cell.parts.iter().map(|part| within(&part.region)).collect();
        let parts = station.cell.parts.iter().zip(&words);
        let solids: Vec<ArmSolidClaim> = parts
            .filter_map(|(part, words)| {
                let form = match words {
                    Some(words) => ArmSolidForm::Where(words.as_ref()),
                    None => form_of(&part.region)?,
                };
                Some(ArmSolidClaim { name: &part.name, tool_only: words.is_some(), form })
            })
            .collect();
        let claim = ArmMovesClaim {
            joints: &joints,
            tool: chain.flange * station.tool.tcp,
            bodies: &bodies,
            solids: &solids,
            clearance: self.scenario.generate.moves.clearance_mm * 1e-3 + allowed(self.scenario),
            start: station.home,
            moves: &self.moves_of(orders),
        };
        verify_arm_moves(&claim)
    }

    /// Targets as they are; where a pose is met in joints its angles are the ones of its configuration, which the proof holds to the pose.
    fn moves_of(&self, orders: &[Order]) -> Vec<ArmMoveClaim> {
        let joints = |pose: &Isometry3<f64>, configuration: &Option<crate::robot::arm::Configuration>| -> Joints {
            let flange = self.station.flange(pose);
            let turned = self.station.arm.inverse(&flange, &self.station.home).into_iter();
            let mut turned = turned.flat_map(|q| self.station.arm.turns_of(&q));
            let fits = |q: &Joints| configuration.is_none_or(|wanted| self.station.arm.configuration(q) == wanted);
            turned.find(fits).unwrap_or(self.station.home)
        };
        let one = |order: &Order| match &order.target {
            Target::Joints(end) => ArmMoveClaim::Joints(*end, None),
            Target::Joint(pose, configuration) => ArmMoveClaim::Joints(joints(pose, configuration), Some(*pose)),
            Target::Line(pose, _) => ArmMoveClaim::Straight(*pose),
            Target::Arc(_, pose, configuration) => ArmMoveClaim::Joints(joints(pose, configuration), Some(*pose)),
        };
        orders.iter().map(one).collect()
    }
}

/// Of words where they hold.
fn within(region: &Region) -> Option<Holds> {
    let Region::Words(words) = region else { return None };
    let words: Words = words.clone();
    Some(Box::new(move |p: &Point3<f64>| words.holds([p.x, p.y, p.z])))
}

/// The plain numbers of a region; words have none, and what is beyond a sphere is no part of a cell.
fn form_of(region: &Region) -> Option<ArmSolidForm<'static>> {
    let triangles = |solid: &Solid| {
        let vertices = solid.vertices();
        let corners = solid.triangles().iter().map(|triangle| triangle.map(|vertex| vertices[vertex as usize]));
        ArmSolidForm::Triangles(corners.collect())
    };
    Some(match region {
        Region::Shape(Shape::Sphere { center, radius }) => ArmSolidForm::Ball(*center, *radius),
        Region::Shape(Shape::Box { center, half_extents }) => ArmSolidForm::Box(*center, *half_extents),
        Region::Shape(Shape::Capsule { a, b, radius }) => ArmSolidForm::Capsule([*a, *b], *radius),
        Region::Shape(Shape::Hull(solid) | Shape::Mesh(solid)) => triangles(solid),
        Region::Cylinder { a, b, radius } => ArmSolidForm::Cylinder([*a, *b], *radius),
        Region::HalfSpace { normal, offset } => ArmSolidForm::HalfSpace(*normal, *offset),
        Region::Beyond { .. } | Region::Words(_) => return None,
    })
}
