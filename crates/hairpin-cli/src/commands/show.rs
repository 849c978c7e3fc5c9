//! `hairpin show terrain`: what an elevation map says, as it was understood.

use hairpin::world::terrain::HoleRule;
use hairpin_jobs::Problem;
use hairpin_jobs::terrain::{MapSummary, summarise_map};
use serde_json::json;

use super::terrain::georeference;
use crate::args::{Show, ShowTerrain, Shown};
use crate::console;
use crate::exit::DONE;

/// Runs the command.
pub(crate) fn run(show: &Show) -> Result<u8, Problem> {
    let Shown::Terrain(asked) = &show.what;
    let map = summarise_map(&asked.terrain, &georeference(&asked.map, HoleRule::KeepOut))?;
    if asked.json {
        let mut object = json!(map);
        object["exit_code"] = DONE.into();
        console::say(&object.to_string());
    } else {
        in_words(asked, &map);
    }
    Ok(DONE)
}

fn in_words(asked: &ShowTerrain, map: &MapSummary) {
    let MapSummary { columns, rows, cell_m, x_m, y_m, height_m, holes, north_west } = map;
    console::say(&format!(
        "{}: {columns} x {rows} cells of {} x {} m, heights at their centres",
        asked.terrain.display(),
        cell_m[0],
        cell_m[1]
    ));
    console::say(&format!("x (east)  {:.3} .. {:.3} m", x_m[0], x_m[1]));
    console::say(&format!("y (north) {:.3} .. {:.3} m", y_m[0], y_m[1]));
    console::say(&format!("height    {:.3} .. {:.3} m, {holes} cells without data", height_m[0], height_m[1]));
    let height = north_west.height_m.unwrap_or(f32::NAN);
    let place = (north_west.x_m, north_west.y_m);
    console::say(&format!("north-west cell, the file's first: {height:.3} m at ({:.3}, {:.3})", place.0, place.1));
    console::say(&format!("attitudes are optimistic for wheel bases under {:.3} m", map.coarse_m()));
}
