//! `hairpin show terrain`: what an elevation map says, as it was understood.

use hairpin::world::terrain::{ElevationMap, Grid, HoleRule};
use serde_json::json;

use super::terrain;
use crate::args::{Show, ShowTerrain, Shown};
use crate::console;
use crate::problem::Problem;

/// Runs the command.
pub(crate) fn run(show: &Show) -> Result<u8, Problem> {
    let Shown::Terrain(asked) = &show.what;
    let map = terrain::read(&asked.terrain, &asked.map, HoleRule::KeepOut)?;
    if asked.json {
        as_object(&map)
    } else {
        in_words(asked, &map)
    }
    Ok(0)
}

/// Least and largest height of the cells with data, m.
fn heights(map: &ElevationMap) -> (f32, f32) {
    let Grid { columns, rows, .. } = *map.grid();
    let cells = (0..rows * columns).map(|i| map.cell_height(i / columns, i % columns));
    cells.filter(|h| !h.is_nan()).fold((f32::INFINITY, f32::NEG_INFINITY), |(low, high), h| (low.min(h), high.max(h)))
}

fn as_object(map: &ElevationMap) {
    let Grid { columns, rows, cell, .. } = *map.grid();
    let ((low, high), (min, max)) = (map.extent(), heights(map));
    let corner = map.cell_height(rows - 1, 0);
    let object = json!({
        "columns": columns,
        "rows": rows,
        "cell_m": cell,
        "x_m": [low[0], high[0]],
        "y_m": [low[1], high[1]],
        "height_m": [min, max],
        "holes": map.holes(),
        "north_west": { "x_m": low[0], "y_m": high[1], "height_m": (!corner.is_nan()).then_some(corner) },
        "exit_code": 0,
    });
    console::say(&object.to_string());
}

fn in_words(asked: &ShowTerrain, map: &ElevationMap) {
    let Grid { columns, rows, cell, .. } = *map.grid();
    let ((low, high), (min, max)) = (map.extent(), heights(map));
    let corner = map.cell_height(rows - 1, 0);
    console::say(&format!(
        "{}: {columns} x {rows} cells of {} x {} m, heights at their centres",
        asked.terrain.display(),
        cell[0],
        cell[1]
    ));
    console::say(&format!("x (east)  {:.3} .. {:.3} m", low[0], high[0]));
    console::say(&format!("y (north) {:.3} .. {:.3} m", low[1], high[1]));
    console::say(&format!("height    {min:.3} .. {max:.3} m, {} cells without data", map.holes()));
    console::say(&format!("north-west cell, the file's first: {corner:.3} m at ({:.3}, {:.3})", low[0], high[1]));
    console::say(&format!("attitudes are optimistic for wheel bases under {:.3} m", 2.0 * cell[0].max(cell[1])));
}
