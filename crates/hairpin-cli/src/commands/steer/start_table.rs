//! `hairpin start-table`, and the table that `hairpin steer` is given.

use std::path::Path;
use std::time::Instant;

use hairpin::feasibility::steering::shooting::Curvatures;
use hairpin::feasibility::steering::shooting::flat::StartTable;
use hairpin::feasibility::steering::shooting::flat::start_table::{NONE, steering};
use hairpin::robot::rover::Rover;
use hairpin_formats::atomic;
use hairpin_formats::scenario::rover_for;
use hairpin_formats::steering::{read_start_table, start_table_bytes};
use serde_json::json;

use crate::args;
use crate::console;
use crate::problem::Problem;

/// A table fits vehicles whose most_rate/most² differs from its own by no more than this share.
const ALIKE: f64 = 0.01;

/// Makes a vehicle's table.
pub(crate) fn make(asked: &args::StartTable) -> Result<u8, Problem> {
    let rover = rover_for(&asked.rover)?;
    let begun = Instant::now();
    let table = StartTable::generate(&bounds(&rover)).map_err(|error| {
        Problem::input(format!("`{}` (limits.curvature_1_m, limits.curvature_rate_1_m2): {error}", rover.name))
    })?;
    let seconds = begun.elapsed().as_secs_f64();
    let bytes = start_table_bytes(&table);
    atomic::write(&asked.out, &bytes)?;
    let goals = table.entries().len();
    let arcs = table.entries().iter().filter(|entry| **entry != NONE).count();
    if asked.json {
        console::say(
            &json!({ "robot": rover.name, "goals": goals, "arcs": arcs, "bytes": bytes.len(), "exit_code": 0 })
                .to_string(),
        );
    } else {
        let out = asked.out.display();
        console::say(&format!("{out}: arcs to {arcs} of {goals} goals, {} bytes, {seconds:.2} s", bytes.len()));
    }
    Ok(0)
}

/// Reads `path`, which must fit `rover`; kept until the program ends.
pub(super) fn load(path: &Path, rover: &Rover) -> Result<&'static StartTable, Problem> {
    let wrong = |error: &dyn std::fmt::Display| Problem::input(format!("--start-table {}: {error}", path.display()));
    let table =
        read_start_table(&std::fs::read(path).map_err(|error| wrong(&error))?).map_err(|error| wrong(&error))?;
    let (its, ours) = (table.steering(), steering(&bounds(rover)));
    if (its / ours - 1.0).abs() > ALIKE {
        return Err(wrong(&format!(
            "made for vehicles with curvature_rate_1_m2 / curvature_1_m² = {its}, `{}` has {ours}",
            rover.name
        )));
    }
    Ok(Box::leak(Box::new(table)))
}

fn bounds(rover: &Rover) -> Curvatures {
    Curvatures { most: rover.limits.curvature, most_rate: rover.limits.curvature_rate }
}
