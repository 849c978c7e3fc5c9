//! NumPy arrays: two dimensions of floats in metres, rows from the north, NaN where there is no data.

use npyz::{NpyFile, Order};

use super::error::TerrainError;
use super::georeference::{Georeference, placed};
use super::raster::{Layout, Raster, bounded};
use super::reference::Reference;

pub(super) fn read(bytes: &[u8], georeference: &Georeference) -> Result<Raster, TerrainError> {
    let broken = |error: &dyn std::fmt::Display| TerrainError::Broken(format!("no readable NumPy array: {error}"));
    if georeference.height_m.is_some() {
        return Err(TerrainError::Unwanted { key: "height_m" });
    }
    let array = NpyFile::new(bytes).map_err(|error| broken(&error))?;
    let (rows, columns) = match *array.shape() {
        [rows, columns] => (rows, columns),
        ref shape => {
            return Err(TerrainError::Broken(format!("an array of shape {shape:?}: rows and columns are needed")));
        }
    };
    let (columns, rows) = bounded(columns, rows)?;
    // The data must be there before room for it is taken.
    if (columns * rows) > bytes.len() {
        let said = format!("the header says {rows} x {columns} heights, the file has {} bytes", bytes.len());
        return Err(TerrainError::Broken(said));
    }
    let order = array.order();
    let heights: Vec<f32> = match array.try_data::<f32>() {
        Ok(data) => data.collect::<Result<_, _>>().map_err(|error| broken(&error))?,
        Err(array) => match array.try_data::<f64>() {
            Ok(data) => data.map(|h| h.map(|h| h as f32)).collect::<Result<_, _>>().map_err(|error| broken(&error))?,
            Err(array) => {
                let found = format!("an array of {}: float32 or float64 in metres is needed", array.dtype().descr());
                return Err(TerrainError::Broken(found));
            }
        },
    };
    let heights = match order {
        Order::C => heights,
        Order::Fortran => (0..rows * columns).map(|i| heights[i % columns * rows + i / columns]).collect(),
    };
    let (reference, layout) = (Reference::default(), Layout::default());
    Ok(Raster { grid: placed(columns, rows, georeference)?, heights, reference, layout })
}
