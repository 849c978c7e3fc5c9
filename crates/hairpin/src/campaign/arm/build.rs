//! From an arm scenario's numbers to the station that they describe.

use std::sync::Arc;

use nalgebra::{Isometry3, Vector3};

use super::cell::cell_of;
use super::check::check;
use super::graph::{joint_settings, stands};
use super::points::points_of;
use super::{ArmSetup, Station};
use crate::campaign::attachments::Attachments;
use crate::campaign::kind::{Build, Given};
use crate::campaign::scenario::{ArmMode, ArmScenario, Mistake, PointsSource, mistake};
use crate::feasibility::reachability::joint::Bodies;
use crate::math::simd::Simd;

impl Build for ArmSetup {
    type Keys = ArmScenario;

    fn build(given: Given<'_, Self>) -> Result<Self, Mistake> {
        let Given { keys, files, known } = given;
        let station = match known {
            Some(known) if same_station(&known.scenario, keys) => known.station.clone(),
            _ => Arc::new(station_of(keys, files)?),
        };
        let simd = known.map_or_else(Simd::default, |known| known.simd);
        let controller = known.and_then(|known| known.controller.clone());
        let graph = Arc::default();
        Ok(Self { scenario: keys.clone(), attachments: files.clone(), station, simd, controller, graph })
    }

    fn check(given: Given<'_, Self>) -> Result<Self, Vec<Mistake>> {
        check(given.keys, given.files, || Self::build(given))
    }
}

/// Whether two scenarios with the same files describe one station.
fn same_station(a: &ArmScenario, b: &ArmScenario) -> bool {
    // Where points are drawn they are such that the arm can stand at, as the moves between them are to be proven clear.
    let drawn_alike = || {
        let (a_moves, b_moves) = (&a.generate.moves, &b.generate.moves);
        (a.seed, a.generate.mode, a.spec.path) == (b.seed, b.generate.mode, b.spec.path) && a_moves == b_moves
    };
    let drawn = matches!(a.task.points, PointsSource::Drawn(_));
    (&a.robot, &a.world, &a.task) == (&b.robot, &b.world, &b.task) && (!drawn || drawn_alike())
}

/// Builds what a resolved scenario describes.
///
/// # Errors
/// The key whose value makes no arm, tool, work object, obstacle or point.
fn station_of(scenario: &ArmScenario, files: &Attachments) -> Result<Station, Mistake> {
    let mut arm = scenario.robot.resolved()?.build().map_err(|error| mistake("robot", error))?;
    // Gravity is the world's.
    arm.up = scenario.world_from_base()?.rotation.inverse() * Vector3::z();
    let (tool, work_object) = (scenario.tool()?, scenario.work_object()?);
    let cell = cell_of(&scenario.world)?;
    let home = scenario.task.home_deg.map(f64::to_radians);
    if let Some((axis, _)) = arm.outside_limits(&home) {
        let limit = &arm.limits[axis];
        return Err(Mistake {
            key: format!("task.home_deg[{axis}]"),
            value: scenario.task.home_deg[axis].to_string(),
            bound: format!(
                "within axis {}'s bounds, {:.1} … {:.1}°",
                axis + 1,
                limit.lower.to_degrees(),
                limit.upper.to_degrees()
            ),
        });
    }
    let mut station = Station { arm, tool, work_object, cell, points: Vec::new(), home };
    let reach = station.reach();
    // Where the arm cannot stand at home it comes to no point from there.
    let at_home = scenario.generate.mode == ArmMode::Cartesian || {
        let clearance = joint_settings(&station, scenario).clearance;
        Bodies::new(&station.arm, &station.tool, &station.cell, clearance).standing(&home, 0.0).is_none()
    };
    let fits = |pose: &Isometry3<f64>| at_home && stands(&station, scenario, pose);
    station.points = points_of(scenario, files, &station.work_object, reach, fits)?;
    match station.points.iter().position(|point| point.configuration.is_some() && !station.arm.knows_configurations()) {
        Some(index) => Err(Mistake {
            key: format!("task.points[{index}]"),
            value: format!("configuration {:?}", station.points[index].configuration.unwrap_or_default()),
            bound:
                "without a configuration (a table of x_mm,y_mm,z_mm,q1,q2,q3,q4): which posture it means is known of \
                    arms with `opw` alone"
                    .into(),
        }),
        None => Ok(station),
    }
}
