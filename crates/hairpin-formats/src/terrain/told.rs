//! What a map's file says of itself, as it was understood.

use super::raster::Layout;
use super::scale::Scale;
use super::unit::{Source, Unit};

/// What a file says beside its heights.
#[derive(Debug, Clone, PartialEq)]
pub struct Told {
    /// Unit of x and y in the file; the map is in metres.
    pub unit: Unit,
    /// Where that is known from.
    pub unit_from: Source,
    /// Unit of heights in the file.
    pub height_unit: Unit,
    /// Where that is known from.
    pub height_unit_from: Source,
    /// Whether the plane is told beside the file, not in it.
    pub beside: bool,
    /// EPSG code of the plane.
    pub epsg: Option<u32>,
    /// What the plane is called.
    pub name: String,
    /// How long a metre of the ground is on the plane at the map's middle; `None` where its projection is not known,
    /// and where it has none: its metres are then taken for the ground's.
    pub scale: Option<Scale>,
    /// What the file's plane of the Earth is called where its projection is not known; `None` of a yard's own plane
    /// too, whose metres are the ground's.
    pub unknown_plane: Option<String>,
    /// Taken off the file's coordinates, m: the map's x is the easting less the first, its y the northing less the
    /// second.
    pub offset_m: [f64; 2],
    /// How the heights are laid out and written.
    pub layout: Layout,
}
