//! What GDAL writes of a band: its scale, offset and unit, and which value means no data.

use roxmltree::Document;
use tiff::tags::Tag;

use super::decoder::Tiff;
use crate::terrain::error::TerrainError;
use crate::terrain::unit::Unit;

/// GDAL_METADATA, which has no name in the library.
const METADATA: Tag = Tag::Unknown(42112);
/// Numbers beyond make no height.
const LARGEST: f64 = 1e12;

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Band {
    pub(super) scale: f64,
    pub(super) offset: f64,
    pub(super) unit: Option<Unit>,
    pub(super) no_data: Option<f64>,
}

impl Band {
    pub(super) fn height(&self, value: f64) -> f32 {
        // Heights that are not scaled keep their bits.
        if self.scale == 1.0 && self.offset == 0.0 { value as f32 } else { (self.scale * value + self.offset) as f32 }
    }
}

pub(super) fn read(tiff: &mut Tiff<'_>) -> Result<Band, TerrainError> {
    let mut band = Band { scale: 1.0, offset: 0.0, unit: None, no_data: no_data(tiff)? };
    let Ok(text) = tiff.get_tag_ascii_string(METADATA) else { return Ok(band) };
    let text = text.trim_matches(['\0', ' ', '\n']);
    let broken = |what: String| TerrainError::Broken(format!("GDAL_METADATA: {what}"));
    let document = Document::parse(text).map_err(|error| broken(error.to_string()))?;
    let items = document.root_element().children().filter(|node| node.has_tag_name("Item"));
    for item in items.filter(|item| item.attribute("sample").is_none_or(|sample| sample == "0")) {
        let value = item.text().unwrap_or_default().trim();
        let number = || {
            let number = value.parse::<f64>().ok().filter(|number| number.abs() <= LARGEST);
            number.ok_or_else(|| broken(format!("{:?} is no number", value.get(..80).unwrap_or(value))))
        };
        match item.attribute("role").unwrap_or_default() {
            "scale" => band.scale = number()?,
            "offset" => band.offset = number()?,
            "unittype" if !value.is_empty() => {
                let unit = Unit::of_word(value);
                band.unit = Some(unit.ok_or_else(|| broken(format!("heights in {value:?}: no unit of length")))?);
            }
            _ => {}
        }
    }
    if band.scale == 0.0 {
        return Err(broken("the scale is 0".into()));
    }
    Ok(band)
}

fn no_data(tiff: &mut Tiff<'_>) -> Result<Option<f64>, TerrainError> {
    let Ok(text) = tiff.get_tag_ascii_string(Tag::GdalNodata) else { return Ok(None) };
    let text = text.trim_matches(['\0', ' ', '\n']);
    if text.is_empty() {
        return Ok(None);
    }
    match crate::terrain::no_data::parse(text) {
        Some(value) => Ok(Some(value)),
        None => Err(TerrainError::Broken(format!("GDAL_NODATA = {text:?} is no number"))),
    }
}
