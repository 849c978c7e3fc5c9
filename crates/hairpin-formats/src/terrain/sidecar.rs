//! What other programs put beside a raster: `.prj`, what GDAL notes in `.aux.xml`, masks.

use std::path::{Path, PathBuf};

use hairpin::world::terrain::Grid;
use roxmltree::{Document, Node};

use super::error::TerrainError;
use super::no_data;
use super::prj;
use super::raster::Layout;
use super::reference::Reference;
use super::remedy::Remedy;
use crate::bounds::{self, MOST_SIDECAR_BYTES};
use crate::quote;

/// The texts beside a raster's file.
#[derive(Debug, Clone, Default)]
pub struct Sidecars {
    prj: Option<String>,
    aux: Option<String>,
    masked: bool,
    /// What a file is called that places the cells.
    world_file: Option<String>,
}

impl Sidecars {
    /// The texts of a `.prj` and an `.aux.xml`.
    pub fn of(prj: Option<String>, aux: Option<String>) -> Self {
        Self { prj, aux, ..Self::default() }
    }

    /// What lies beside the file at `path`.
    pub fn beside(path: &Path) -> Self {
        let prj = ["prj", "PRJ"].iter().find_map(|ending| text(&path.with_extension(ending)));
        let placed = ["tfw", "TFW", "tifw", "tiffw", "wld"].iter().map(|ending| path.with_extension(ending));
        let world_file = placed.filter(|path| path.is_file()).find_map(|path| path.file_name().map(ToOwned::to_owned));
        let world_file = world_file.map(|name| name.to_string_lossy().into_owned());
        Self { prj, aux: text(&with(path, ".aux.xml")), masked: with(path, ".msk").is_file(), world_file }
    }

    /// What they say of the plane, where the file itself says nothing.
    pub(super) fn reference(&self, file: &str) -> Result<Option<Reference>, TerrainError> {
        let of_aux = self.notes(|notes| Some(notes.child("SRS")?.text()?.to_owned()));
        let Some(text) = self.prj.as_deref().or(of_aux.as_deref()).map(str::trim).filter(|text| !text.is_empty())
        else {
            return Ok(None);
        };
        match prj::read(text) {
            Ok(reference) => Ok(Some(reference)),
            // Older ones are lists of words, which GDAL understands.
            Err(error) => Err(TerrainError::Convert { why: error.to_string(), command: Remedy::rewrite(file, "") }),
        }
    }

    /// Where the cells are placed by a file beside one that says nothing of it: what puts that into it.
    pub(super) fn placed_by(&self, file: &str) -> Option<TerrainError> {
        let name = self.world_file.as_ref()?;
        let why = format!("no georeference in it, but in {name} beside it; this puts it there");
        Some(TerrainError::Convert { why, command: Remedy::rewrite(file, "") })
    }

    /// Refuses another place of the cells of `grid` than the file says, which GDAL believes before the file's own.
    pub(super) fn check_place(&self, file: &str, grid: &Grid, layout: &Layout) -> Result<(), TerrainError> {
        let Some(said) = self.notes(|notes| Some(notes.child("GeoTransform")?.text().unwrap_or_default().to_owned()))
        else {
            return Ok(());
        };
        let own = transform(grid, layout.south_up);
        let other: Option<Vec<f64>> = said.split(',').map(|number| number.trim().parse().ok()).collect();
        if other.is_some_and(|other| same_place(&own, &other, grid)) {
            return Ok(());
        }
        let (said, own) = (quote::cell(said.trim()), own.map(|number| number.to_string()).join(", "));
        let why = format!(
            "an .aux.xml beside the file says GeoTransform {said}, the file {own}; programs differ in which they \
             believe, and this takes GDAL's"
        );
        Err(TerrainError::Convert { why, command: Remedy::rewrite(file, "") })
    }

    /// Refuses what is said of the heights beside the file and not in it.
    pub(super) fn check(&self, file: &str, layout: &Layout) -> Result<(), TerrainError> {
        let convert = |what: &str| {
            let why = format!("{what} beside the file, not in it; this puts it there");
            Err(TerrainError::Convert { why, command: Remedy::rewrite(file, "") })
        };
        if self.masked {
            return convert("cells are masked by a .msk");
        }
        if self.aux.as_deref().is_some_and(|aux| Document::parse(aux).is_err()) {
            let why = "an .aux.xml is beside the file and is no XML, so what it says of heights is not known".into();
            return Err(TerrainError::Convert { why, command: Remedy::rewrite(file, "") });
        }
        let said = |name: &str| {
            self.notes(|notes| {
                let band = notes.children().find(|node| node.has_tag_name("PAMRasterBand"))?;
                Some(band.child(name)?.text()?.trim().to_owned())
            })
        };
        let number = |name: &str| said(name).and_then(|text| no_data::parse(&text));
        if number("Scale").is_some_and(|scale| scale != layout.scale)
            || number("Offset").is_some_and(|offset| offset != layout.offset)
        {
            return convert("a scale or an offset of heights is said by an .aux.xml");
        }
        let same = |value: f64| layout.no_data.is_some_and(|known| known == value || known.is_nan() && value.is_nan());
        if number("NoDataValue").is_some_and(|value| !same(value)) {
            return convert("a value for no data is said by an .aux.xml");
        }
        if said("UnitType").is_some_and(|unit| !matches!(unit.as_str(), "" | "m" | "metre" | "meter")) {
            return convert("a unit of heights is said by an .aux.xml");
        }
        Ok(())
    }

    fn notes<T>(&self, ask: impl FnOnce(Node<'_, '_>) -> Option<T>) -> Option<T> {
        let document = Document::parse(self.aux.as_deref()?).ok()?;
        ask(document.root_element())
    }
}

/// GDAL's six numbers of a grid: x of the first cell's outer corner, along a row, along a column; then those of y.
fn transform(grid: &Grid, south_up: bool) -> [f64; 6] {
    let Grid { rows, first_center: [west, south], cell: [width, height], .. } = *grid;
    let (first, step) = if south_up { (south, height) } else { (south + (rows as f64 - 1.0) * height, -height) };
    [west - 0.5 * width, width, 0.0, first - 0.5 * step, 0.0, step]
}

/// Whether two transformations place all corners of the grid within a hundredth of a cell of each other.
fn same_place(own: &[f64; 6], other: &[f64], grid: &Grid) -> bool {
    let Ok(other) = <&[f64; 6]>::try_from(other) else { return false };
    let (columns, rows) = (grid.columns as f64, grid.rows as f64);
    let corners = [[0.0, 0.0], [columns, 0.0], [0.0, rows], [columns, rows]];
    corners.iter().all(|[column, row]| {
        let at = |of: &[f64; 6], axis: usize| of[3 * axis] + of[3 * axis + 1] * column + of[3 * axis + 2] * row;
        [0, 1].iter().all(|axis| (at(own, *axis) - at(other, *axis)).abs() <= 0.01 * grid.cell[*axis].abs())
    })
}

trait Child<'a, 'i> {
    fn child(&self, name: &str) -> Option<Node<'a, 'i>>;
}

impl<'a, 'i> Child<'a, 'i> for Node<'a, 'i> {
    fn child(&self, name: &str) -> Option<Node<'a, 'i>> {
        self.children().find(|node| node.has_tag_name(name))
    }
}

/// What is there and cannot be read is not understood, as what is no text of its format.
fn text(path: &Path) -> Option<String> {
    let there = path.symlink_metadata().is_ok();
    there.then(|| bounds::read_text(path, MOST_SIDECAR_BYTES).unwrap_or_else(|_| "?".into()))
}

fn with(path: &Path, ending: &str) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(ending);
    PathBuf::from(name)
}
