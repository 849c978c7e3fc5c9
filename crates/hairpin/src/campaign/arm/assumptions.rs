//! What an arm's claim, search, execution and limits rest on, said from the run's own settings.

use nalgebra::Isometry3;

use super::ArmSetup;
use crate::campaign::scenario::{ArmMode, CostName, CostSection, Keys, PathFrom, ProgramMethod};
use crate::campaign::{Case, Tally};
use crate::robot::arm::{Outline, WorkObject, body_name};
use crate::search::heaviest::MOST_EXACT_POINTS;

/// What stands behind the moves.
pub(super) fn claim(setup: &ArmSetup, tally: &Tally, said: &mut Vec<String>) {
    let generate = &setup.scenario.generate;
    let clearance = generate.moves.clearance_mm;
    let off = match (tally.proven_short_of(&*setup.scenario), setup.scenario.widest_mm()) {
        (Some(within), _) => format!(
            "of runs within {within} mm of their path, which is less than `spec.path.max_mm` by now, and of no others"
        ),
        (None, Some(most)) => format!("as far as runs stay within the {most} mm of `spec.path.max_mm` of their path"),
        (None, None) => "of runs on their path alone, as no `spec.path.max_mm` says how far off they may be".into(),
    };
    said.push(match generate.mode {
        ArmMode::Joint => format!(
            "Mode `joint`: `clear: all links` means that along every move, joints within their bounds and away from \
             singularities, no link and no tool comes nearer than {clearance} mm to an obstacle, nor links to each other, between \
             samples as well; the links are the capsules and hulls of the robot's file{}. It holds {off}.",
            stand_ins(setup)
        ),
        ArmMode::Cartesian => format!(
            "Mode `cartesian`: `clear: tool sphere` means that a ball of the tool's radius and {clearance} mm more touches nothing \
             along the straight segments between the points, rounding errors included; the arm behind it, its joints and the moves \
             from and to home were not looked at. It holds {off}."
        ),
    });
    if !setup.scenario.world.keep_out_mm.is_empty() {
        said.push("Keep-outs in words hold for the tool; the arm's own links may be in them.".into());
    }
    if counts_effort(&generate.cost) && !setup.station.arm.has_masses() {
        said.push(
            "Joint effort is of squared accelerations, not of torques: the robot's file has not the masses of all six links."
                .into(),
        );
    }
    let declared = |declare: bool| if declare { "declared in every program" } else { "expected on the controller" };
    said.push(format!(
        "Programs are in work object `{}` ({}) with tool `{}` ({}).",
        setup.station.work_object.name,
        declared(setup.scenario.world.wobj.declare),
        setup.station.tool.name,
        declared(setup.scenario.world.tool.declare)
    ));
    said.extend(misnamed(setup));
    if let Some(first) = setup.station.points.first() {
        let p = first.pose.translation.vector * 1e3;
        said.push(format!(
            "The first point of the cloud, {}, is at ({:.1}, {:.1}, {:.1}) mm in the base frame: check it at the pendant.",
            setup.point_name(0),
            p.x,
            p.y,
            p.z
        ));
    }
}

/// `tool0` and `wobj0` where they are not what every controller has under these names.
///
/// A user frame stands in the world: where the base stands in that changes nothing here.
pub(super) fn misnamed(setup: &ArmSetup) -> Option<String> {
    let (tool, object) = (&setup.station.tool, &setup.scenario.world.wobj);
    let other = |key: &str, name: &str, is: &str, has: &str| {
        format!(
            "On a controller `{name}` is {is}, and here it has {has} of its own: give `{key}.name` another name before a program \
             runs on an arm, and set `{key}.declare` or set it up on the controller."
        )
    };
    if tool.name.eq_ignore_ascii_case("tool0") && is_elsewhere(&tool.tcp) {
        return Some(other("world.tool", "tool0", "the flange", "a point"));
    }
    let (user, frame) = ((object.uframe_mm, object.uframe_q1_q4), (object.oframe_mm, object.oframe_q1_q4));
    let placed = WorkObject::new(&object.name, user, frame).ok()?;
    let is_misnamed = object.name.eq_ignore_ascii_case("wobj0") && is_elsewhere(&placed.base_from_object());
    is_misnamed.then(|| other("world.wobj", "wobj0", "the world", "a frame"))
}

/// Whether a frame is another one than that which it is given in, by a nanometre or some nanoradians.
fn is_elsewhere(frame: &Isometry3<f64>) -> bool {
    frame.translation.vector.norm() > 1e-9 || frame.rotation.vector().norm() > 1e-9
}

fn counts_effort(cost: &CostSection) -> bool {
    match cost {
        CostSection::Named(name) => *name == CostName::JointEffort,
        CostSection::Weighted(weights) => weights.joint_effort > 0.0,
        CostSection::Table(_) | CostSection::Learned(_) => false,
    }
}

/// Which links are none of these.
fn stand_ins(setup: &ArmSetup) -> String {
    let links = setup.station.arm.links.iter().enumerate();
    let unknown = links.filter(|(_, link)| link.outline == Outline::StandIn);
    let unknown: Vec<String> = unknown.map(|(link, _)| body_name(link)).collect();
    match unknown.len() {
        0 => String::new(),
        _ => format!(", but {} estimated: stand-ins along the dimensions", unknown.join(", ")),
    }
}

/// How programs were found.
pub(super) fn search(setup: &ArmSetup, cases: &[Case], tally: &Tally, said: &mut Vec<String>) {
    let search = &setup.scenario.generate.search;
    if !tally.missions.is_empty() {
        said.push(format!("Missions: {} waypoint files made elsewhere; nothing was searched.", tally.missions.len()));
        return;
    }
    let often = match search.visits {
        1 => "once".to_owned(),
        visits => format!("{visits} times and no move twice"),
    };
    if search.method == ProgramMethod::Worst {
        said.extend(executed(setup, cases, tally, &often));
        return;
    }
    said.push(format!(
        "Search: paths of largest total cost `{}` among {} points, each at most {often}; points may be left out; {} of {} programs \
         asked for, pairwise different. `optimal` means proven over all such paths.",
        setup.scenario.generate.cost.word(),
        setup.station.points.len(),
        cases.len(),
        search.programs,
    ));
    if setup.scenario.generate.moves.arcs {
        said.push(format!(
            "Arcs (MoveC) from a point through a second to a third are moves of the graph like straight ones, each proven clear, and searched with them: \
             exactly among {MOST_EXACT_POINTS} points at most, home counted where only some points can be reached from it; else by annealing under a bound."
        ));
    }
    if let Some(limit) = search.time_limit_s {
        said.push(format!(
            "Each search had {limit} s: where that did not suffice for the proof the gap to the bound is told."
        ));
    }
}

/// How programs were found by executing them.
fn executed(setup: &ArmSetup, cases: &[Case], tally: &Tally, often: &str) -> Vec<String> {
    let (moves, asked) = (&setup.scenario.generate.moves, setup.scenario.search());
    let arcs = if moves.arcs { ", which points arcs pass" } else { "" };
    let target = asked
        .target
        .as_ref()
        .map_or("each limit of `spec`, by its margin in spreads of what was drawn".into(), |target| {
            format!("`{}`", target.word())
        });
    let mut said = vec![format!(
        "Search: programs through points of {}, each at most {often}, by executing them for {target}: which points come, in which order and \
         configuration{arcs}, and the speeds ({}) and zones ({}) of the moves; {} of {} programs asked for, of {} executions, {} of them of \
         programs drawn at random ({}). Every program that was executed is a way through moves that are possible. Nothing says that no \
         other is worse.",
        setup.station.points.len(),
        moves.speeds.join(", "),
        moves.zones.join(", "),
        cases.len(),
        asked.cases,
        tally.expansions,
        tally.drawn,
        tally.sampler.as_deref().unwrap_or("none"),
    )];
    if let Some(seconds) = asked.seconds {
        said.push(format!("The search had {seconds} s: what it found depends on the clock and is not reproducible."));
    }
    said
}

/// Who ran them.
pub(super) fn act(setup: &ArmSetup, said: &mut Vec<String>) {
    let execute = &setup.scenario.execute;
    if let Some(own) = &setup.controller {
        said.push(format!(
            "The servos' set points are `{}`'s, the caller's own; the path and the times that runs are held against are those that hairpin's virtual \
             controller plans.",
            own.name()
        ));
    }
    let lags = match setup.station.arm.lags {
        Some(lags) => format!("{} s (axes 1 to 6, the arm's own)", lags.map(|lag| lag.to_string()).join(", ")),
        None => format!("{} s on every axis", execute.servo_lag_s),
    };
    said.push(match &execute.logs {
        Some(logs) => format!(
            "Recorded on a real controller (hardware): `{logs}`. Places are taken for those of the tool's point in the arm's base frame; what \
             they are held against is the path and the time that hairpin's virtual controller plans for the program, and joints against its \
             postures: logs that tell poses alone do not show that the links were where they were proven clear."
        ),
        None => format!(
            "Simulated: hairpin's virtual controller, a stand-in for one whose numbers are not public: profile {}, servo lag of {}, \
             samples every 10 ms, measured positions with a standard deviation of {} mm.",
            serde_json::to_value(execute.profile).ok().and_then(|word| word.as_str().map(str::to_owned)).unwrap_or_default(),
            lags,
            execute.noise_mm
        ),
    });
    if !execute.faults.is_none() {
        said.push("The virtual arm has faults injected (`execute.faults`).".into());
    }
}

/// What deviation is.
pub(super) fn verdict(setup: &ArmSetup, said: &mut Vec<String>) {
    let spec = &setup.scenario.spec;
    said.push(match spec.path.map(|limit| limit.from) {
        Some(PathFrom::Blended) => {
            "Deviation is the distance of the tool's point from the programmed path with its zones. Tracks are not aligned.".into()
        }
        Some(PathFrom::Sharp) => {
            "Deviation is the distance of the tool's point from the path through the points, zones left out. Tracks are not aligned."
                .into()
        }
        None => "No deviation limit is given: deviations from the programmed path are told, not judged.".into(),
    });
    if spec.arrival.is_some() {
        said.push(
            "A point's arrival is late by as much as it comes after the time that the virtual controller plans for it."
                .into(),
        );
    }
}
