//! The programs that were written, followed once more: by the virtual controller's own kinematics, and by code that shares nothing with either.

use nalgebra::Point3;

use super::ArmSetup;
use super::execute::program_of;
use crate::campaign::{Case, Evidence};
use crate::robot::arm::{AXES, Joints};
use crate::simulation::arm::{Plan, RunSettings};
use crate::verification::{Finding, Proof, Worst};
use crate::world::cell::Region;

/// Time between the postures that are looked at, s.
const SAMPLE: f64 = 0.002;
/// Distance within which a waypoint at which the arm stops counts as met, m: a module's numbers have a millionth of a millimetre.
const MET: f64 = 1e-6;

/// Follows the program of `case` without lag and noise, by the controller's inverse kinematics, not the graph's: every point must be
/// met, every joint stay within its bounds, and, where all links are claimed to be clear, none may be in a part of the cell, nor, followed by the
/// proof's own equations, come nearer to one than was claimed; nor may the tool where a zone cuts a corner. Sampled: what the graph proves between samples is not proven again. `None` for a case that has no program.
pub(in crate::campaign) fn verify(setup: &ArmSetup, case: &Case) -> Option<Proof> {
    case.program()?;
    let mut proof = Proof::default();
    let refuse = |what: String| Finding { field: what, value: f64::NAN, bound: 0.0, unit: "", leg: 0, at: 0.0 };
    let followed = program_of(case).and_then(|program| {
        let orders = setup.orders(program)?;
        let plan = Plan::new(&setup.station.arm, &setup.station.home, &orders, &setup.plan_settings())?;
        let stop = plan.stop().map(|stop| (stop.order, stop.reason.to_string()));
        let settings = RunSettings { sample: SAMPLE, interpolation: SAMPLE, lag: 0.0, ..RunSettings::default() };
        Ok((plan.path(), stop, plan.execute(&settings, &[], 0)?))
    });
    let (path, stop, run) = match followed {
        Ok(followed) => followed,
        Err(error) => {
            proof.findings.push(refuse(error.to_string()));
            return Some(proof);
        }
    };
    if let Some((leg, reason)) = stop {
        proof.findings.push(Finding { leg, ..refuse(reason) });
    }
    // Where the arm stops it must be at the point; a zone goes by it.
    for (leg, m) in path.moves().iter().enumerate().filter(|(_, m)| m.stops) {
        let Some(waypoint) = case.waypoints.get(leg + 1) else { continue };
        let (value, at) = ((path.track().position(m.end) - waypoint).norm(), path.passes(leg));
        if value > proof.position.value {
            proof.position = Worst { value, leg, at };
        }
        if value > MET {
            let field = format!("legs[{leg}].end.position");
            proof.findings.push(Finding { field, value, bound: MET, unit: "m", leg, at });
        }
    }
    if case.evidence == Evidence::ClearAllLinks
        && let Ok(orders) = program_of(case).and_then(|program| setup.orders(program))
    {
        let findings = setup.followed_again(&orders).into_iter();
        proof.findings.extend(findings.map(|found| Finding {
            leg: found.index,
            ..refuse(format!("{} at {:.0} % of the move", found.what, 100.0 * found.at))
        }));
    }
    let columns: Vec<&[f64]> = (1..=AXES).filter_map(|axis| run.recording.channel(&format!("q{axis}_rad"))).collect();
    let moves = run.recording.channel("move").unwrap_or_default();
    for (i, at) in run.recording.times().iter().enumerate() {
        let joints: Joints = std::array::from_fn(|axis| columns.get(axis).map_or(f64::NAN, |column| column[i]));
        let leg = moves.get(i).map_or(0, |leg| *leg as usize);
        if let Some(finding) = wrong_at(setup, case, &joints) {
            proof.findings.push(Finding { leg, at: *at, ..finding });
            break;
        }
    }
    Some(proof)
}

/// What is wrong with a posture.
fn wrong_at(setup: &ArmSetup, case: &Case, joints: &Joints) -> Option<Finding> {
    let station = setup.station;
    let finding = |field: String, value, bound, unit| Some(Finding { field, value, bound, unit, leg: 0, at: 0.0 });
    if let Some((axis, beyond)) = station.arm.outside_limits(joints).filter(|(_, beyond)| *beyond > 1e-9) {
        return finding(format!("axis {} beyond its bound", axis + 1), beyond, 0.0, "rad");
    }
    if case.evidence != Evidence::ClearAllLinks {
        return None;
    }
    let frames = station.arm.chain.frames(joints);
    let flange = frames[AXES] * station.arm.chain.flange;
    let tool: (Point3<f64>, Point3<f64>) =
        (flange.translation.vector.into(), (flange * station.tool.tcp).translation.vector.into());
    // The base stands where the user put it.
    let links = station.arm.links.iter().enumerate().skip(1);
    let links = links.flat_map(|(link, body)| body.capsules.iter().map(move |capsule| (link, capsule)));
    let links = links.map(|(link, capsule)| (link, frames[link] * capsule.a, frames[link] * capsule.b, capsule.radius));
    for (link, a, b, radius) in links.chain(std::iter::once((AXES + 1, tool.0, tool.1, station.tool.radius))) {
        for part in &station.cell.parts {
            let of_tool = matches!(part.region, Region::Words(_));
            if (link > AXES || !of_tool) && part.region.meets(&a, &b, radius) {
                let body = if link > AXES { "the tool".to_owned() } else { format!("link {link}") };
                return finding(format!("{body} in {}", part.name), 0.0, 0.0, "m");
            }
        }
    }
    None
}
