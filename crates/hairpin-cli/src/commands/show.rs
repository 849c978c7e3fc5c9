//! `hairpin show terrain`: what an elevation map says, as it was understood.

use hairpin::world::terrain::HoleRule;
use hairpin_formats::terrain::Georeference;
use hairpin_jobs::Problem;
use hairpin_jobs::terrain::{MapSummary, UnitSummary, summarise_map};
use serde_json::json;

use super::terrain::georeference;
use crate::args::{Show, ShowTerrain, Shown};
use crate::console;
use crate::exit::DONE;

/// Runs the command.
pub(crate) fn run(show: &Show) -> Result<u8, Problem> {
    let Shown::Terrain(asked) = &show.what;
    let georeference = Georeference { assume_heights: true, ..georeference(&asked.map, HoleRule::KeepOut) };
    let map = summarise_map(&asked.terrain, &georeference)?;
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
    let MapSummary { columns, rows, cell_m, x_m, y_m, height_m, holes, north_west, .. } = map;
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
    let first = if map.orientation == "north-up" { ", the file's first" } else { "" };
    console::say(&format!("north-west cell{first}: {height:.3} m at ({:.3}, {:.3})", place.0, place.1));
    console::say(&format!(
        "rows      {}, the file's coordinates are of cells' {}",
        map.orientation, map.coordinates_of
    ));
    console::say(&format!("plane     {}", plane(map)));
    console::say(&format!("scale     {}", scale(map)));
    console::say(&format!("units     x and y: {}; heights: {}", unit(&map.unit), unit(&map.height_unit)));
    if map.height_unit.from == "taken" && map.height_unit.metres != 1.0 {
        console::say(
            "          the file does not say what its heights are in: whoever uses the map is asked for height_unit \
             (--terrain-height-unit, world.terrain.height_unit)",
        );
    }
    let none = map.no_data.as_ref().map_or("none said".into(), |value| format!("{value} means no data"));
    let masked = if map.masked { ", cells are masked" } else { "" };
    console::say(&format!("values    height = {} x value + {}; {none}{masked}", map.scale, map.offset));
    console::say(&format!("attitudes are optimistic for wheel bases under {:.3} m", map.coarse_m()));
}

/// Where the map lies on Earth, as far as it is known.
fn plane(map: &MapSummary) -> String {
    let name = map.plane.as_ref().map_or(String::new(), |name| format!(" ({name})"));
    let code = map.epsg.map_or_else(|| "no EPSG code is said".into(), |code| format!("EPSG:{code}"));
    let [east, north] = map.offset_m;
    if map.offset_m == [0.0, 0.0] {
        return format!("{code}{name}");
    }
    format!("{code}{name}; campaigns write x and y relative to ({east}, {north}) m")
}

/// How long a metre of the ground is on the plane.
fn scale(map: &MapSummary) -> String {
    match map.ground_metre {
        Some([x, y]) => format!("a metre of the ground is {x:.4} m along x and {y:.4} m along y, at the map's middle"),
        None => "not known here: metres of the plane are taken for the ground's".into(),
    }
}

/// The unit of a file, and what is done with it.
fn unit(unit: &UnitSummary) -> String {
    let UnitSummary { name, metres, from } = unit;
    let from = match *from {
        "file" => "as the file says",
        "given" => "as was given",
        _ => "which nobody says",
    };
    if *metres == 1.0 { format!("{name}, {from}") } else { format!("{name}, {from}, converted (1 of it = {metres} m)") }
}
