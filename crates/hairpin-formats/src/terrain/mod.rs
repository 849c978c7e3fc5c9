//! Elevation maps in: GeoTIFF, ESRI ASCII grid, 16-bit PNG, raw 16-bit rasters and NumPy arrays.

mod ascii;
mod error;
mod georeference;
mod geotiff;
mod keep_out;
mod no_data;
mod numpy;
mod prj;
mod projection;
mod raster;
mod reference;
mod remedy;
mod scale;
mod sidecar;
mod sixteen_bit;
mod told;
mod unit;
mod vertical;

#[cfg(test)]
mod tests;

pub use error::{MOST_CELLS, TerrainError};
pub use georeference::Georeference;
pub use keep_out::{KeepOutError, read_keep_outs};
pub use raster::Layout;
pub use scale::Scale;
pub use sidecar::Sidecars;
pub use told::Told;
pub use unit::{Source, Unit};

use hairpin::world::terrain::{ElevationMap, Grid};
use raster::Raster;
use reference::{Model, Reference, Units};

/// Coordinates beyond (m) are of a plane of the Earth: what lies there gets an origin of its own.
const FAR: f64 = 20_000.0;
/// The origin's coordinates are whole multiples of this, m.
const ROUND: f64 = 1000.0;
/// No ground is higher or deeper, m; heights have 24 bits, steps of 8 mm there.
const HIGHEST: f32 = 1e5;
/// No plane of the Earth has coordinates beyond, m.
const FARTHEST: f64 = 1e8;

/// A map with what its file says of it.
#[derive(Debug, Clone)]
pub struct MapFile {
    /// In metres, from an origin of its own where the file's coordinates are far from theirs.
    pub map: ElevationMap,
    /// What its file says beside that.
    pub told: Told,
}

/// Reads the elevation map `bytes`; the ending of `name` tells the format. `beside` is what lies beside the file.
///
/// # Errors
/// [`TerrainError`].
pub fn read_terrain(
    bytes: &[u8],
    name: &str,
    beside: &Sidecars,
    georeference: &Georeference,
) -> Result<MapFile, TerrainError> {
    let ending = name.rsplit('.').next().unwrap_or_default().to_ascii_lowercase();
    check_given(&ending, georeference)?;
    let mut raster = match ending.as_str() {
        "tif" | "tiff" => geotiff::read(bytes, name).map_err(|error| match error {
            TerrainError::Unplaced => beside.placed_by(name).unwrap_or(error),
            other => other,
        })?,
        "asc" => ascii::read(bytes)?,
        "png" => sixteen_bit::read_png(bytes, georeference)?,
        "raw" | "bin" => sixteen_bit::read_raw(bytes, georeference)?,
        "npy" => numpy::read(bytes, georeference)?,
        _ => return Err(TerrainError::Format),
    };
    beside.check(name, &raster.layout)?;
    if says_itself(&ending) {
        beside.check_place(name, &raster.grid, &raster.layout)?;
    }
    let by_sidecar = if raster.reference.model == Model::Unsaid { beside.reference(name)? } else { None };
    let beside = by_sidecar.is_some();
    let said = match by_sidecar {
        Some(mut said) => {
            said.also_heights_in(raster.reference.height_unit);
            said
        }
        None => raster.reference,
    };
    raster.reference = Reference { placed: !says_itself(&ending), ..said };
    if has_heights_by_key(&ending) {
        raster.reference = Reference { height_unit: None, unknown_heights: None, depth: None, ..raster.reference };
    }
    let Raster { grid, mut heights, reference, layout } = raster;
    let place = |shares: [f64; 2]| {
        let cells = [grid.columns, grid.rows].map(|cells| cells.saturating_sub(1) as f64);
        [0, 1].map(|i| grid.first_center[i] + shares[i] * cells[i] * grid.cell[i])
    };
    let places = [[0.5, 0.5], [0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]].map(place);
    let Units { plane, plane_from, height, height_from, epsg, name, scale, unknown_plane } =
        reference.units(&places, grid.cell, name, georeference)?;
    if !height.is_metre() {
        heights.iter_mut().for_each(|value| *value = (f64::from(*value) * height.metres) as f32);
    }
    // Heights that are none in a unit that nobody says are a question of it.
    let asked = height_from == Source::Taken && !height.is_metre();
    check_heights(&heights, grid.columns).map_err(|error| if asked { TerrainError::UnitOfHeights } else { error })?;
    let in_metres = |length: f64| length * plane.metres;
    let grid = Grid { first_center: grid.first_center.map(in_metres), cell: grid.cell.map(in_metres), ..grid };
    let offset_m = match georeference.offset_m {
        Some(given) => given,
        None => offset_of(&grid),
    };
    let first_center = [0, 1].map(|i| grid.first_center[i] - offset_m[i]);
    check_extent(&grid, first_center)?;
    let map = ElevationMap::new(Grid { first_center, ..grid }, &heights, georeference.holes)?;
    let (unit, unit_from, height_unit, height_unit_from) = (plane, plane_from, height, height_from);
    let told = Told {
        unit,
        unit_from,
        height_unit,
        height_unit_from,
        beside,
        epsg,
        name,
        scale,
        unknown_plane,
        offset_m,
        layout,
    };
    Ok(MapFile { map, told })
}

/// What is taken off the coordinates of a grid, m: nothing where it lies near their zero, else whole kilometres, so
/// that its south-west corner comes near it.
pub fn offset_of(grid: &Grid) -> [f64; 2] {
    let Grid { columns, rows, first_center, cell } = *grid;
    let last = [(columns, 0), (rows, 1)].map(|(cells, i)| first_center[i] + cells.saturating_sub(1) as f64 * cell[i]);
    if first_center.iter().chain(&last).all(|coordinate| coordinate.abs() <= FAR) {
        return [0.0, 0.0];
    }
    first_center.map(|low| (low / ROUND).floor() * ROUND)
}

/// Whether files of this ending say where their cells lie; of all others keys in metres do.
fn says_itself(ending: &str) -> bool {
    matches!(ending, "tif" | "tiff" | "asc")
}

/// Whether a key in metres says what the values of such files mean.
fn has_heights_by_key(ending: &str) -> bool {
    matches!(ending, "png" | "raw" | "bin")
}

/// What the file says itself must not be given.
fn check_given(ending: &str, given: &Georeference) -> Result<(), TerrainError> {
    let says_itself = says_itself(ending);
    let unwanted = [
        ("cell_m", says_itself && given.cell_m.is_some()),
        ("height_m", says_itself && given.height_m.is_some()),
        ("origin_m", says_itself && given.origin_m.is_some()),
        ("columns", !matches!(ending, "raw" | "bin") && given.columns.is_some()),
        // Keys in metres place the others, and say what 16 bits mean.
        ("unit", !says_itself && given.unit.is_some()),
        ("height_unit", has_heights_by_key(ending) && given.height_unit.is_some()),
    ];
    match unwanted.iter().find(|(_, unwanted)| *unwanted) {
        Some((key, _)) => Err(TerrainError::Unwanted { key }),
        None => Ok(()),
    }
}

/// Refuses heights that are no ground: numbers for no data that nothing tells, and other scales.
fn check_heights(heights: &[f32], columns: usize) -> Result<(), TerrainError> {
    let Some(cell) = heights.iter().position(|height| height.abs() > HIGHEST) else { return Ok(()) };
    let (row, column) = (cell / columns, cell % columns);
    Err(TerrainError::Broken(format!(
        "height = {} m in row {row} from the north, column {column}: must be within ±{HIGHEST} m; likely it means no \
         data and nothing says so, or the heights have another scale, unit or datum",
        heights[cell]
    )))
}

fn check_extent(grid: &Grid, first_center: [f64; 2]) -> Result<(), TerrainError> {
    for i in [0, 1] {
        let cells = if i == 0 { grid.columns } else { grid.rows };
        let last = grid.first_center[i] + cells as f64 * grid.cell[i];
        if [grid.first_center[i], last, first_center[i]].iter().any(|at| at.abs() > FARTHEST) {
            let value = format!("{} … {last}", grid.first_center[i]);
            let key = if i == 0 { "x" } else { "y" };
            return Err(TerrainError::Wrong { key, value, bound: "within 1e8 m of the plane's zero" });
        }
    }
    Ok(())
}
