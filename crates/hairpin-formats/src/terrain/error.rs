//! Why a file is no elevation map.

use hairpin::world::terrain::MapError;
use thiserror::Error;

/// Cells of a map at most: 400 MB of heights.
pub const MOST_CELLS: u64 = 100_000_000;

/// Why a file is no elevation map.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum TerrainError {
    /// The name says no format.
    #[error("must be named .tif, .tiff, .asc, .png, .raw, .bin or .npy")]
    Format,
    /// The file cannot be understood.
    #[error("{0}")]
    Broken(String),
    /// A GeoTIFF whose tags do not say where its cells lie.
    #[error("no georeference: ModelPixelScale and ModelTiepoint are needed")]
    Unplaced,
    /// What is not read here can be rewritten by GDAL.
    #[error("{why}: {command}")]
    Convert {
        /// What it is.
        why: String,
        /// What makes it readable.
        command: String,
    },
    /// Angles are no plane.
    #[error("geographic: {what}, which are no metres; project it first: {command}")]
    Geographic {
        /// What is known of its coordinates.
        what: String,
        /// What projects it.
        command: String,
    },
    /// Feet in the plane say nothing of heights.
    #[error(
        "height_unit: x and y are not in metres and the file does not say what its heights are in; it must be given: \
         m, ft or us-ft"
    )]
    UnitOfHeights,
    /// The file says a unit that is not known.
    #[error("{key}: the file says {said}, which is not known here; it must be given: m, ft or us-ft")]
    UnknownUnit {
        /// Key of the terrain's table.
        key: &'static str,
        /// What it says.
        said: String,
    },
    /// More cells than are worth reading at once.
    #[error("{columns} x {rows} cells: at most {MOST_CELLS} in all; crop the map first")]
    TooLarge {
        /// Cells along x.
        columns: u64,
        /// Cells along y.
        rows: u64,
    },
    /// The file does not say it, and it was not given.
    #[error("{key}: the file does not say it; it must be given")]
    Missing {
        /// Key of the terrain's table.
        key: &'static str,
    },
    /// The file says it itself.
    #[error("{key}: the file says it itself; it must not be given")]
    Unwanted {
        /// Key of the terrain's table.
        key: &'static str,
    },
    /// The file says something else.
    #[error("{key} = {given}: the file says {said}")]
    Contradicts {
        /// Key of the terrain's table.
        key: &'static str,
        /// Its value.
        given: String,
        /// The file's.
        said: String,
    },
    /// A number is out of bounds.
    #[error("{key} = {value}: must be {bound}")]
    Wrong {
        /// Key of the terrain's table.
        key: &'static str,
        /// Its value.
        value: String,
        /// What it must be.
        bound: &'static str,
    },
    /// The cells are no map.
    #[error(transparent)]
    Map(#[from] MapError),
}

impl TerrainError {
    /// The key of the terrain's table that it is about.
    pub fn key(&self) -> Option<&'static str> {
        match self {
            Self::UnitOfHeights => Some("height_unit"),
            Self::Contradicts { key, .. } | Self::UnknownUnit { key, .. } => Some(key),
            Self::Wrong { key: "epsg", .. } => Some("epsg"),
            _ => None,
        }
    }
}
