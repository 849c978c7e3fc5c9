//! `hairpin steer`: boundary-value drives, one from the command line or many from a file.

mod batch;
mod single;

use std::time::Duration;

use hairpin::campaign::scenario::{CircleSection, KeepOutSection, PolygonSection};
use hairpin::feasibility::steering::shooting::SPEED_PRECISION;
use hairpin::world::terrain::HoleRule;
use hairpin_jobs::steer::{Effort, Pace, SteerSettings, Vehicle, make_start_table};
use hairpin_jobs::{Problem, Watch};
use serde_json::json;

use super::terrain::georeference;
use crate::args::{KeepOutFlags, NoData, StartTable, Steer};
use crate::exit::DONE;
use crate::{console, settings};

/// Runs the command: 0 when everything was answered; one question alone is 3 when it is infeasible, 5 when it is open.
pub(crate) fn run(steer: &Steer, watch: &dyn Watch) -> Result<u8, Problem> {
    settings::take_threads(&steer.threads);
    let vehicle = Vehicle::new(&of_flags(steer), watch)?;
    match (&steer.queries, &steer.to) {
        (Some(queries), _) => batch::run(steer, &vehicle, queries, watch),
        (None, Some(to)) => single::run(steer, &vehicle, to, watch),
        (None, None) => Err(Problem::input("give a goal, --to X,Y,YAW, or a file of them, --queries Q.csv")),
    }
}

/// Makes a vehicle's table of start values.
pub(crate) fn make_table(asked: &StartTable) -> Result<u8, Problem> {
    let made = make_start_table(&asked.rover, &asked.out)?;
    if asked.json {
        let mut object = json!(made);
        object["exit_code"] = DONE.into();
        console::say(&object.to_string());
    } else {
        console::say(&format!(
            "{}: arcs to {} of {} goals, {} bytes, {:.2} s",
            asked.out.display(),
            made.arcs,
            made.goals,
            made.bytes,
            made.seconds
        ));
    }
    Ok(DONE)
}

/// What the flags say of the vehicle, of where it drives and of how drives are looked for.
fn of_flags(steer: &Steer) -> SteerSettings {
    let holes = match steer.no_data {
        NoData::Error => HoleRule::Error,
        NoData::KeepOut => HoleRule::KeepOut,
        NoData::Fill => HoleRule::Fill,
    };
    let effort = &steer.effort;
    SteerSettings {
        rover: steer.rover.clone(),
        kinematics: steer.kinematics.into(),
        pace: Pace {
            control: steer.control.into(),
            v0: steer.v0,
            vf: steer.vf,
            cruise: steer.cruise,
            acceleration: steer.acceleration,
            most_steps: steer.max_steps,
            time_step: steer.time_step_s,
            speed_precision: effort.tolerance_speed_m_s.unwrap_or(SPEED_PRECISION),
        },
        terrain: steer.terrain.as_ref().map(|path| (path.clone(), georeference(&steer.map, holes))),
        keep_out: steer.keep_out.keep_out.clone(),
        places: places(&steer.keep_out),
        cost: steer.cost.into(),
        effort: Effort {
            tolerance_yaw: effort.tolerance_yaw_rad,
            tolerance_curvature: effort.tolerance_curvature_1_m,
            iterations: effort.iterations,
            step_scale: effort.step_scale,
            start_table: effort.start_table.clone(),
        },
        time_limit: steer.time_limit_ms.map(|ms| Duration::from_secs_f64(ms * 1e-3)),
        reversals: steer.reversals,
        turns: steer.turns,
    }
}

/// The places that the flags give, called after them.
fn places(flags: &KeepOutFlags) -> Vec<KeepOutSection> {
    let circles = flags.keep_out_circle.iter().enumerate().map(|(number, &[x, y, radius_m])| KeepOutSection {
        name: format!("--keep-out-circle {number}"),
        circle: Some(CircleSection { center_m: [x, y], radius_m }),
        polygon: None,
    });
    let polygons = flags.keep_out_polygon.iter().enumerate().map(|(number, corners)| KeepOutSection {
        name: format!("--keep-out-polygon {number}"),
        circle: None,
        polygon: Some(PolygonSection { points_m: corners.0.clone() }),
    });
    circles.chain(polygons).collect()
}
