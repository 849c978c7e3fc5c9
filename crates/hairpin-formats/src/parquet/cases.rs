//! `waypoints.parquet`: what a campaign generated, one row per waypoint: `case,waypoint,x_m,y_m,z_m,leg_time_s`
//! and, of the leg that begins there, what the search saw of it: `seen_v_in_m_s` … `seen_duration_s`.

use std::collections::BTreeMap;
use std::iter::repeat_n;
use std::path::Path;
use std::sync::Arc;

use arrow_array::{Float64Array, Int64Array, StringArray};
use hairpin::campaign::{Case, CaseNumber, SeenLeg};
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
    /// One per leg; empty where no search saw them.
    pub seen: Vec<SeenLeg>,
}

/// Writes the routes of all cases. `leg_time_s` belongs to the leg that begins at the row's waypoint.
///
/// # Errors
/// The file cannot be written.
pub fn write(path: &Path, cases: &[Case]) -> Result<(), WriteError> {
    let rows = || cases.iter().flat_map(|case| (0..case.waypoints.len()).map(move |i| (case, i)));
    let mut columns = Columns::default();
    let ids: Vec<String> = cases.iter().map(Case::id).collect();
    let ids = cases.iter().zip(&ids).flat_map(|(case, id)| repeat_n(id, case.waypoints.len()));
    columns.push("case", Arc::new(StringArray::from_iter_values(ids)));
    columns.push("waypoint", Arc::new(rows().map(|(_, i)| i as i64).collect::<Int64Array>()));
    for (axis, name) in ["x_m", "y_m", "z_m"].into_iter().enumerate() {
        let values = rows().map(|(case, i)| case.waypoints[i][axis]).collect::<Float64Array>();
        columns.push(name, Arc::new(values));
    }
    let times = rows().map(|(case, i)| case.leg_times.get(i).copied()).collect::<Float64Array>();
    columns.push("leg_time_s", Arc::new(times));
    for (place, name) in SeenLeg::NAMES.into_iter().enumerate() {
        let values = rows().map(|(case, i)| case.seen.get(i).map(|seen| seen.numbers()[place]));
        columns.push(format!("seen_{name}"), Arc::new(values.collect::<Float64Array>()));
    }
    columns.write(path, "waypoints")
}

/// Reads the routes by case number, the rows of a case in any order.
///
/// # Errors
/// Missing columns, values that are not finite, a waypoint that is missing or twice there.
pub fn read(path: &Path) -> Result<BTreeMap<CaseNumber, Route>, TableError> {
    let table = Table::read(path)?;
    let cases = table.cases()?;
    let numbers = table.counts("waypoint")?;
    let position = ["x_m", "y_m", "z_m"].iter().map(|name| table.numbers(name)).collect::<Result<Vec<_>, _>>()?;
    let times = table.optional_numbers("leg_time_s")?;
    let saw = SeenLeg::NAMES.map(|name| format!("seen_{name}"));
    let saw = saw.iter().map(|name| table.numbers_or_none(name)).collect::<Result<Vec<_>, _>>()?;
    let mut order: Vec<usize> = (0..table.rows()).collect();
    order.sort_by_key(|&row| (cases[row], numbers[row]));
    let mut routes: BTreeMap<CaseNumber, Route> = BTreeMap::new();
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
        let mut leg = [0.0; SeenLeg::NAMES.len()];
        if leg.iter_mut().zip(&saw).all(|(number, column)| column[row].map(|value| *number = value).is_some()) {
            if route.seen.len() != next {
                return Err(table.refuse("seen_v_in_m_s", row, leg[0], "given for each leg of the case or for none"));
            }
            route.seen.push(SeenLeg::of(leg));
        }
    }
    Ok(routes)
}
