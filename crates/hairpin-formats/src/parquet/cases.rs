//! `waypoints.parquet`: what a campaign generated, one row per waypoint: `case,waypoint,x_m,y_m,z_m,leg_time_s`.

use std::collections::BTreeMap;
use std::path::Path;
use std::sync::Arc;

use arrow::array::{Float64Array, Int64Array, StringArray};
use hairpin::campaign::Case;
use nalgebra::Point3;

use super::table::{Columns, Table, TableError};
use crate::atomic::WriteError;

/// Waypoints of a case, and the planned duration of each leg where there is one.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Route {
    /// Both ends included, m, world frame.
    pub waypoints: Vec<Point3<f64>>,
    /// One per leg, s; empty where nothing was planned.
    pub leg_times: Vec<f64>,
}

/// Writes the routes of all cases. `leg_time_s` belongs to the leg that begins at the row's waypoint.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, cases: &[Case]) -> Result<(), WriteError> {
    let rows = || cases.iter().flat_map(|case| (0..case.waypoints.len()).map(move |i| (case, i)));
    let mut columns = Columns::default();
    columns.push("case", Arc::new(rows().map(|(case, _)| Some(case.id())).collect::<StringArray>()));
    columns.push("waypoint", Arc::new(rows().map(|(_, i)| i as i64).collect::<Int64Array>()));
    for (axis, name) in ["x_m", "y_m", "z_m"].into_iter().enumerate() {
        let values = rows().map(|(case, i)| case.waypoints[i][axis]).collect::<Float64Array>();
        columns.push(name, Arc::new(values));
    }
    let times = rows().map(|(case, i)| case.leg_times.get(i).copied()).collect::<Float64Array>();
    columns.push("leg_time_s", Arc::new(times));
    columns.write(path, "waypoints")
}

/// Reads the routes by case number, the rows of a case in any order.
///
/// # Errors
/// Missing columns, values that are not finite, a waypoint that is missing or twice there.
pub fn read(path: &Path) -> Result<BTreeMap<usize, Route>, TableError> {
    let table = Table::read(path)?;
    let cases = table.cases()?;
    let numbers = table.counts("waypoint")?;
    let position = ["x_m", "y_m", "z_m"].iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let times = table.optional_numbers("leg_time_s")?;
    let mut order: Vec<usize> = (0..table.rows()).collect();
    order.sort_by_key(|&row| (cases[row], numbers[row]));
    let mut routes: BTreeMap<usize, Route> = BTreeMap::new();
    for row in order {
        let route = routes.entry(cases[row]).or_default();
        let next = route.waypoints.len();
        if numbers[row] != next {
            return Err(table.refuse("waypoint", row, numbers[row], format!("{next}: each once, from 0")));
        }
        route.waypoints.push(Point3::new(position[0][row], position[1][row], position[2][row]));
        if let Some(time) = times[row] {
            if time <= 0.0 || route.leg_times.len() != next {
                return Err(table.refuse("leg_time_s", row, time, "> 0, for each leg of the case or for none"));
            }
            route.leg_times.push(time);
        }
    }
    Ok(routes)
}
