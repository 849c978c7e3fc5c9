//! Elevation maps out of a caller's heights.

use std::sync::Arc;

use hairpin::world::terrain::{ElevationMap, Grid as Cells, HoleRule};

use crate::memory::{free, given, handle, many, result};
use crate::refusal::{Code, Error, HAIRPIN_INVALID, Refused, enter};

/// An elevation map. Nothing changes it, so that any number of threads may use it.
pub struct MapHandle {
    pub(crate) map: Arc<ElevationMap>,
}

/// Where the cells of a map lie: x east, y north, m.
#[repr(C)]
pub struct Grid {
    /// Cells along x.
    pub columns: usize,
    /// Cells along y.
    pub rows: usize,
    /// Centre of the cell with least x and y.
    pub first_center_m: [f64; 2],
    /// Edges of a cell along x and y.
    pub cell_m: [f64; 2],
}

/// A map with cells without data is refused.
pub const HAIRPIN_HOLES_REFUSED: i32 = 0;
/// Nothing may touch cells without data.
pub const HAIRPIN_HOLES_KEEP_OUT: i32 = 1;
/// Heights are interpolated over cells without data.
pub const HAIRPIN_HOLES_FILL: i32 = 2;

/// Makes a map; the heights are copied.
///
/// @param grid where the cells lie
/// @param heights_m columns * rows heights, row by row from the north, NaN without data
/// @param holes one of HAIRPIN_HOLES_...
/// @param map the map, to be given back to hairpin_map_free
/// @param error NULL, or where the call says why it did nothing
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_map_new(
    grid: *const Grid,
    heights_m: *const f32,
    holes: i32,
    map: *mut *mut MapHandle,
    error: *mut Error,
) -> Code {
    // SAFETY: `grid` is one and has as many heights, the others are NULL or to be written, as the header has it.
    unsafe {
        enter(error, || {
            let (grid, place) = (given(grid, "grid")?, result(map, "map")?);
            let rule = match holes {
                HAIRPIN_HOLES_REFUSED => HoleRule::Error,
                HAIRPIN_HOLES_KEEP_OUT => HoleRule::KeepOut,
                HAIRPIN_HOLES_FILL => HoleRule::Fill,
                _ => return Err(Refused::new(HAIRPIN_INVALID, format_args!("`holes` = {holes}: must be 0, 1 or 2"))),
            };
            let Grid { columns, rows, first_center_m: first_center, cell_m: cell } = *grid;
            let cells = columns.saturating_mul(rows);
            let heights = many(heights_m, cells, "heights_m")?;
            let map = ElevationMap::new(Cells { columns, rows, first_center, cell }, heights, rule);
            handle(place, MapHandle { map: Arc::new(map.map_err(Refused::invalid)?) })
        })
    }
}

/// Gives a map back; what was made with it goes on. NULL is nothing.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn hairpin_map_free(map: *mut MapHandle) {
    // SAFETY: as above.
    unsafe { free(map) }
}
