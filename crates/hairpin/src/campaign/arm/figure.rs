//! An arm as it is drawn: the solids of its links, and its tool.

use nalgebra::Point3;

use super::Station;
use crate::campaign::kind::{FigureLink, Look, RobotFigure, Surface, Turned, capsule, surface};
use crate::robot::arm::{Link, Outline};
use crate::world::{Obstacle, Shape};

/// Half of the least thickness at which a tool is seen, m.
const SEEN: f64 = 0.006;

/// Links that are not the arm's own are stand-ins: what is drawn is what they were proven clear with.
pub(super) fn figure(station: &Station) -> RobotFigure {
    let arm = &station.arm;
    let mut links: Vec<FigureLink> = arm
        .links
        .iter()
        .enumerate()
        .map(|(k, link)| {
            let drawn = FigureLink::still(Look::Body, link.outline == Outline::StandIn, surfaces(link));
            let Some(joint) = k.checked_sub(1).map(|joint| &arm.chain.joints[joint]) else { return drawn };
            let turned = Turned::By { channel: format!("q{k}_rad"), factor: 1.0 };
            FigureLink { parent: Some(k - 1), place: joint.origin, axis: joint.axis, turned, ..drawn }
        })
        .collect();
    let tip = Point3::from(station.tool.tcp.translation.vector);
    let tool = capsule(&Point3::origin(), &tip, station.tool.radius.max(SEEN));
    links.push(FigureLink {
        parent: Some(links.len() - 1),
        place: arm.chain.flange,
        ..FigureLink::still(Look::Nose, false, vec![tool])
    });
    let told = if arm.has_stand_ins() { "hatched links are stand-ins along the arm's dimensions" } else { "" };
    RobotFigure { links, fixed: true, radius: 0.5 * arm.chain.length(), lift: 0.0, told: told.into() }
}

/// Capsules as they are; hulls without what they are grown by.
fn surfaces(link: &Link) -> Vec<Surface> {
    let capsules = link.capsules.iter().map(|body| capsule(&body.a, &body.b, body.radius));
    let hulls = link.hulls.iter().filter_map(|hull| {
        let points: Vec<[f64; 3]> = hull.points.iter().map(|p| [p.x, p.y, p.z]).collect();
        let shape = Shape::hull(&points).ok()?;
        Some(surface(&Obstacle { name: "link".into(), shape }))
    });
    capsules.chain(hulls).collect()
}
