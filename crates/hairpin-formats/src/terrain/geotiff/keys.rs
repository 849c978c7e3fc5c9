//! The GeoKeys: what the coordinates are. Numbers of keys and their values: OGC 19-008r4, annex B.

use tiff::tags::Tag;

use super::decoder::Tiff;
use crate::epsg::definition;
use crate::terrain::prj;
use crate::terrain::projection::{self, Projection};
use crate::terrain::reference::{Model, Reference};
use crate::terrain::unit::Unit;
use crate::terrain::vertical::{Depth, Vertical, is_depth, system};

const MODEL_TYPE: u16 = 1024;
const RASTER_TYPE: u16 = 1025;
const CITATION: u16 = 1026;
const GEODETIC: u16 = 2048;
const GEODETIC_CITATION: u16 = 2049;
const ANGULAR_UNIT: u16 = 2054;
const ANGULAR_UNIT_SIZE: u16 = 2055;
const SEMI_MAJOR_AXIS: u16 = 2057;
const PROJECTED: u16 = 3072;
const PROJECTED_CITATION: u16 = 3073;
const LINEAR_UNIT: u16 = 3076;
const LINEAR_UNIT_SIZE: u16 = 3077;
const METHOD: u16 = 3075;
const PARALLELS: [u16; 2] = [3078, 3079];
// Of the natural origin, of the false one, of the centre, and straight down from the pole.
const LONGITUDES: [u16; 4] = [3080, 3084, 3088, 3095];
const LATITUDES: [u16; 3] = [3081, 3085, 3089];
const EASTINGS: [u16; 3] = [3082, 3086, 3090];
const NORTHINGS: [u16; 3] = [3083, 3087, 3091];
const SCALES: [u16; 2] = [3092, 3093];
const INVERSE_FLATTENING: u16 = 2059;
/// What Esri's well-known text stands behind, where no key has the method.
const ESRI: &str = "ESRI PE String = ";
const VERTICAL: u16 = 4096;
const VERTICAL_CITATION: u16 = 4097;
const VERTICAL_UNIT: u16 = 4099;

/// As if it were not there.
const UNDEFINED: u16 = 0;
const PIXEL_IS_AREA: u16 = 1;
const PIXEL_IS_POINT: u16 = 2;
/// "User-defined": what follows says it.
const OWN: u16 = 32767;

pub(super) struct Keys {
    pub(super) reference: Reference,
    /// Whether a tie point names a cell's centre, not its corner.
    pub(super) at_centers: bool,
    /// A raster type that is neither of areas nor of points.
    pub(super) unknown_raster: Option<u16>,
}

/// The keys of a file; one without any says nothing.
pub(super) fn read(tiff: &mut Tiff<'_>) -> Keys {
    let directory = tiff.get_tag_u16_vec(Tag::GeoKeyDirectoryTag).unwrap_or_default();
    let numbers = tiff.get_tag_f64_vec(Tag::GeoDoubleParamsTag).unwrap_or_default();
    let texts = tiff.get_tag_ascii_string(Tag::GeoAsciiParamsTag).unwrap_or_default();
    let table = Table { directory: &directory, numbers: &numbers, texts: &texts };
    let projected = table.code(PROJECTED);
    let model = match table.short(MODEL_TYPE) {
        Some(1) => Model::Projected,
        Some(2) => Model::Geographic,
        Some(3) => Model::Geocentric,
        _ if projected.is_some() => Model::Projected,
        _ if table.code(GEODETIC).is_some() => Model::Geographic,
        _ => Model::Unsaid,
    };
    let epsg = if model == Model::Projected { projected } else { table.code(GEODETIC) };
    let citations = if model == Model::Projected { PROJECTED_CITATION } else { GEODETIC_CITATION };
    let name = table.text(citations).or_else(|| table.text(CITATION)).unwrap_or_default();
    let degrees = match table.short(ANGULAR_UNIT) {
        Some(9101) => 1f64.to_degrees(),
        Some(9105 | 9106) => 0.9,
        Some(OWN) => table.number(ANGULAR_UNIT_SIZE).map_or(1.0, f64::to_degrees),
        _ => 1.0,
    };
    let radius = table.number(SEMI_MAJOR_AXIS);
    let plane = Reference { model, epsg: epsg.map(u32::from), name, degrees, radius, ..Reference::default() };
    let plane = of_plane(&table, plane);
    let projection = if projected.is_none() { projection(&table, &plane) } else { None };
    let reference = heights(&table, Reference { projection, ..plane });
    let raster = table.short(RASTER_TYPE);
    let unknown_raster = raster.filter(|kind| !matches!(*kind, UNDEFINED | PIXEL_IS_AREA | PIXEL_IS_POINT));
    Keys { reference, at_centers: raster == Some(PIXEL_IS_POINT), unknown_raster }
}

/// With the unit of x and y.
fn of_plane(table: &Table<'_>, plane: Reference) -> Reference {
    let Some(code) = table.code_or_own(LINEAR_UNIT) else { return plane };
    let unit = match code {
        OWN => table.number(LINEAR_UNIT_SIZE).and_then(Unit::of_length),
        code => Unit::of_code(code),
    };
    let unknown_unit = unit.is_none().then(|| format!("ProjLinearUnits = {code}"));
    Reference { unit, unknown_unit, ..plane }
}

/// The projection that the keys define, or the text in their citations.
fn projection(table: &Table<'_>, plane: &Reference) -> Option<String> {
    let Some(method) = table.short(METHOD).filter(|method| !matches!(*method, UNDEFINED | OWN)) else {
        let (_, text) = table.texts.split_once(ESRI)?;
        return prj::read(text.split('|').next()?.trim()).ok()?.projection;
    };
    let first = |keys: &[u16]| keys.iter().find_map(|key| table.number(*key));
    let angle = |keys: &[u16]| first(keys).map(|angle| angle * plane.degrees);
    let metres = plane.unit.as_ref().map_or(1.0, |unit| unit.metres);
    let length = |keys: &[u16]| first(keys).map(|length| length * metres);
    let of_code = || {
        let words = definition(u32::from(table.code(GEODETIC)?))?.split_whitespace();
        let body = ["+a=", "+b=", "+R=", "+rf=", "+ellps=", "+datum="];
        Some(words.filter(|word| body.iter().any(|key| word.starts_with(key))).collect::<Vec<_>>().join(" "))
    };
    let own = plane.radius.map(|radius| projection::body(radius, table.number(INVERSE_FLATTENING).unwrap_or(0.0)));
    let found = Projection {
        method: projection::of_number(method),
        lat_0: angle(&LATITUDES),
        lon_0: angle(&LONGITUDES),
        parallels: PARALLELS.map(|key| angle(&[key])),
        scale: first(&SCALES),
        false_origin: [length(&EASTINGS), length(&NORTHINGS)],
        body: own.or_else(of_code).unwrap_or_default(),
    };
    found.text()
}

/// With the unit of heights; the key of the unit goes before that of the system, as GDAL has it.
fn heights(table: &Table<'_>, plane: Reference) -> Reference {
    let (code, by_unit) = (table.code(VERTICAL), table.code_or_own(VERTICAL_UNIT));
    let unit = by_unit.and_then(Unit::of_code);
    let known = code.map(system);
    let metres = |of: &Unit| unit.as_ref().unwrap_or(of).metres;
    let depth = match &known {
        Some(Vertical::Down(of)) => Some(Depth { said: said(VERTICAL_NAME, code), metres: metres(of) }),
        _ => table.text(VERTICAL_CITATION).filter(|name| is_depth(name)).map(|name| {
            let said = format!("\"{name}\"");
            Depth { said, metres: metres(&Unit::metre()) }
        }),
    };
    let (height_unit, unknown_heights) = match (known, by_unit) {
        (Some(Vertical::Unknown), _) | (Some(Vertical::Datum), None) => (None, Some(said(VERTICAL_NAME, code))),
        (_, Some(_)) if unit.is_none() => (None, Some(said("VerticalUnits", by_unit))),
        (Some(Vertical::Up(of)), None) => (Some(of), None),
        _ => (unit, None),
    };
    Reference { height_unit, unknown_heights, depth, ..plane }
}

const VERTICAL_NAME: &str = "VerticalCS";

fn said(key: &str, code: Option<u16>) -> String {
    format!("{key} = {}", code.unwrap_or_default())
}

/// A header of four numbers, then (key, tag of the value, count, value or place) each.
struct Table<'t> {
    directory: &'t [u16],
    numbers: &'t [f64],
    texts: &'t str,
}

impl Table<'_> {
    fn entry(&self, key: u16, tag: Tag) -> Option<(usize, usize)> {
        let tag = if tag == Tag::GeoKeyDirectoryTag { 0 } else { tag.to_u16() };
        let entry = self.directory.chunks_exact(4).skip(1).find(|entry| entry[0] == key && entry[1] == tag)?;
        Some((usize::from(entry[2]), usize::from(entry[3])))
    }

    fn short(&self, key: u16) -> Option<u16> {
        self.entry(key, Tag::GeoKeyDirectoryTag).map(|(_, value)| value as u16)
    }

    /// A code of the registry, or that of what the file defines itself.
    fn code_or_own(&self, key: u16) -> Option<u16> {
        self.short(key).filter(|code| *code != 0)
    }

    /// A code of the registry.
    fn code(&self, key: u16) -> Option<u16> {
        self.short(key).filter(|code| !matches!(*code, 0 | OWN))
    }

    fn number(&self, key: u16) -> Option<f64> {
        let (_, at) = self.entry(key, Tag::GeoDoubleParamsTag)?;
        self.numbers.get(at).copied()
    }

    fn text(&self, key: u16) -> Option<String> {
        let (count, at) = self.entry(key, Tag::GeoAsciiParamsTag)?;
        let text = self.texts.get(at..at + count).or_else(|| self.texts.get(at..))?;
        // Texts end at a bar; a line break in one would break the line that tells it.
        let text: String = text.trim_end_matches(['|', '\0']).chars().filter(|c| !c.is_control()).take(200).collect();
        Some(text).filter(|text| !text.is_empty())
    }
}
