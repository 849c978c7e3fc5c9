//! Tables of start values: made for a vehicle, and taken for one.

use std::path::Path;
use std::time::Instant;

use hairpin::feasibility::steering::shooting::Curvatures;
use hairpin::feasibility::steering::shooting::flat::steering;
use hairpin::robot::rover::Rover;
use hairpin::trajectory::start_table::{NONE, StartTable};
use hairpin_formats::atomic;
use hairpin_formats::bounds::MOST_BYTES;
use hairpin_formats::folder::refuse_own;
use hairpin_formats::scenario::rover_for;
use hairpin_formats::steering::{read_start_table, start_table_bytes};
use serde::Serialize;

use crate::Problem;

/// A table fits vehicles whose most_rate/most² differs from its own by no more than this share.
const ALIKE: f64 = 0.01;

/// What was made of a vehicle.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MadeTable {
    /// The vehicle's name.
    pub robot: String,
    /// Goals on the table's grid.
    pub goals: usize,
    /// Of these, goals that an arc leads to.
    pub arcs: usize,
    /// Size of the file.
    pub bytes: usize,
    /// What it took, s.
    #[serde(skip)]
    pub seconds: f64,
}

/// Makes the table of `rover`, a shipped one's name or a robot file, and writes it to `out`.
///
/// # Errors
/// No such vehicle; one whose limits make no table; a file that cannot be written.
pub fn make_start_table(rover: &str, out: &Path) -> Result<MadeTable, Problem> {
    refuse_own(out)?;
    let rover = rover_for(rover)?;
    let begun = Instant::now();
    let table = StartTable::generate(&bounds(&rover)).map_err(|error| {
        Problem::input(format!("`{}` (limits.curvature_1_m, limits.curvature_rate_1_m2): {error}", rover.name))
    })?;
    let seconds = begun.elapsed().as_secs_f64();
    let bytes = start_table_bytes(&table);
    atomic::write(out, &bytes)?;
    let goals = table.entries().len();
    let arcs = table.entries().iter().filter(|entry| **entry != NONE).count();
    Ok(MadeTable { robot: rover.name, goals, arcs, bytes: bytes.len(), seconds })
}

/// Reads `path`, which must fit `rover`.
pub(super) fn load(path: &Path, rover: &Rover) -> Result<StartTable, Problem> {
    let wrong = |error: &dyn std::fmt::Display| Problem::input(format!("--start-table {}: {error}", path.display()));
    let table = read_start_table(&hairpin_formats::bounds::read(path, MOST_BYTES).map_err(|error| wrong(&error))?)
        .map_err(|error| wrong(&error))?;
    let (its, ours) = (table.steering(), steering(&bounds(rover)));
    if (its / ours - 1.0).abs() > ALIKE {
        return Err(wrong(&format!(
            "made for vehicles with curvature_rate_1_m2 / curvature_1_m² = {its}, `{}` has {ours}",
            rover.name
        )));
    }
    Ok(table)
}

fn bounds(rover: &Rover) -> Curvatures {
    Curvatures { most: rover.limits.curvature, most_rate: rover.limits.curvature_rate }
}
