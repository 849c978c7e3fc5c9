//! Where the cells lie, from ModelPixelScale and ModelTiepoint or from ModelTransformation.

use hairpin::world::terrain::Grid;
use tiff::tags::Tag;

use super::decoder::Tiff;
use crate::terrain::error::TerrainError;
use crate::terrain::remedy::Remedy;

pub(super) struct Placed {
    /// In the file's unit.
    pub(super) grid: Grid,
    pub(super) south_up: bool,
}

pub(super) fn read(
    tiff: &mut Tiff<'_>,
    columns: usize,
    rows: usize,
    at_centers: bool,
    file: &str,
) -> Result<Placed, TerrainError> {
    let broken = |text: &str| TerrainError::Broken(text.into());
    let turned = |why: &str| TerrainError::Convert { why: why.into(), command: Remedy::warp(file) };
    let level = |step: f64, rest: &[f64]| (step == 0.0 || step == 1.0) && rest.iter().all(|number| *number == 0.0);
    let in_height = || TerrainError::Convert {
        why: "its georeference has a step or an origin of heights, which some read and some not".into(),
        command: Remedy::rewrite(file, ""),
    };
    // x and y for a column and a row, in cells from the first corner of the raster: at + step · cell.
    let (step, tie, at) =
        match (tiff.get_tag_f64_vec(Tag::ModelPixelScaleTag), tiff.get_tag_f64_vec(Tag::ModelTiepointTag)) {
            (Ok(scale), Ok(tie)) if scale.len() >= 2 && tie.len() >= 6 => {
                if scale[1] < 0.0 {
                    return Err(turned(
                        "its pixel scale along y is negative, which some read as south up and some not",
                    ));
                }
                if !level(scale.get(2).copied().unwrap_or_default(), &[tie[2], tie[5]]) {
                    return Err(in_height());
                }
                if tie.len() > 6 {
                    return Err(turned("several tie points: the raster is not placed by one"));
                }
                ([scale[0], -scale[1]], [tie[0], tie[1]], [tie[3], tie[4]])
            }
            _ => match tiff.get_tag_f64_vec(Tag::ModelTransformationTag) {
                Ok(m) if m.len() == 16 => {
                    if m[1] != 0.0 || m[4] != 0.0 {
                        return Err(turned("the raster is rotated against its coordinates"));
                    }
                    if !level(m[10], &[m[2], m[6], m[8], m[9], m[11]]) {
                        return Err(in_height());
                    }
                    ([m[0], m[5]], [0.0, 0.0], [m[3], m[7]])
                }
                _ => return Err(TerrainError::Unplaced),
            },
        };
    let finite = [step, tie, at].iter().flatten().all(|number| number.is_finite());
    if !finite || step[0] == 0.0 || step[1] == 0.0 {
        return Err(broken("the georeference needs cell sizes that are not 0 and a finite tie point"));
    }
    if step[0] < 0.0 {
        return Err(turned("the raster runs from east to west"));
    }
    let south_up = step[1] > 0.0;
    let to_center = if at_centers { 0.0 } else { 0.5 };
    let west = at[0] + (to_center - tie[0]) * step[0];
    let south_row = if south_up { 0 } else { rows - 1 };
    let south = at[1] + (south_row as f64 + to_center - tie[1]) * step[1];
    Ok(Placed { grid: Grid { columns, rows, first_center: [west, south], cell: [step[0], step[1].abs()] }, south_up })
}
