//! What a map's coordinates are: a plane's, and in which unit, or degrees; and the EPSG code of it.

use super::error::TerrainError;
use super::georeference::Georeference;
use super::remedy::Remedy;
use super::scale::{Scale, scale};
use super::unit::{Source, Unit};
use super::vertical::Depth;
use crate::epsg::{System, definition, system};

/// What the coordinates of a file are, as far as it says.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Reference {
    pub(super) model: Model,
    pub(super) epsg: Option<u32>,
    /// Of x and y.
    pub(super) unit: Option<Unit>,
    pub(super) height_unit: Option<Unit>,
    /// What it says of the unit of x and y that is not known.
    pub(super) unknown_unit: Option<String>,
    /// What it says of heights that is not known.
    pub(super) unknown_heights: Option<String>,
    /// Where its values are depths.
    pub(super) depth: Option<Depth>,
    /// What it is called.
    pub(super) name: String,
    /// Its projection as PROJ has it, where the file defines that itself.
    pub(super) projection: Option<String>,
    /// Degrees in one unit of angle.
    pub(super) degrees: f64,
    /// Semi-major axis of the body, m, where it is said.
    pub(super) radius: Option<f64>,
    /// Whether keys in metres place the cells, whatever the plane's unit.
    pub(super) placed: bool,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Model {
    /// Nothing is said.
    #[default]
    Unsaid,
    /// A plane of the Earth, or of another body.
    Projected,
    /// A yard's own plane, whose metres are the ground's.
    Local,
    /// Longitude and latitude.
    Geographic,
    /// Earth-centred.
    Geocentric,
}

/// What one coordinate and one height are in metres, and what is known of the plane.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Units {
    pub(super) plane: Unit,
    /// Where the unit of the plane is known from.
    pub(super) plane_from: Source,
    pub(super) height: Unit,
    pub(super) height_from: Source,
    pub(super) epsg: Option<u32>,
    pub(super) name: String,
    pub(super) scale: Option<Scale>,
    /// What a plane of the Earth is called whose scale nobody here can compute.
    pub(super) unknown_plane: Option<String>,
}

/// Cells of less (m) on coordinates that could be degrees are of a map in degrees: a minute of arc is 0.017, and no map
/// of ground is as fine.
const FINEST: f64 = 0.05;

impl Reference {
    /// Units and code, of what the file says and what is given; `places`, the map's middle and its corners, and `cell`
    /// are in the file's own unit.
    pub(super) fn units(
        &self,
        places: &[[f64; 2]; 5],
        cell: [f64; 2],
        file: &str,
        given: &Georeference,
    ) -> Result<Units, TerrainError> {
        let center = places[0];
        let as_degrees = if self.degrees > 0.0 { self.degrees } else { 1.0 };
        let geographic = |what: String| {
            let center = center.map(|angle| angle * as_degrees);
            TerrainError::Geographic { what, command: Remedy::project(file, center, self.radius) }
        };
        match self.model {
            Model::Geographic => return Err(geographic(self.called("longitude and latitude"))),
            Model::Geocentric => return Err(geographic(self.called("Earth-centred coordinates"))),
            Model::Unsaid | Model::Projected | Model::Local => {}
        }
        let epsg = same("epsg", self.epsg, given.epsg)?;
        if let Some(Depth { said, metres }) = &self.depth {
            let why = format!("its values are depths ({said}), which grow downwards: heights are needed");
            return Err(TerrainError::Convert { why, command: Remedy::rise(file, *metres, epsg) });
        }
        let by_code = match epsg.map(|code| (code, system(code))) {
            Some((_, System::Plane { metres })) => Unit::of_length(metres),
            Some((code, System::Angles)) => return Err(geographic(format!("EPSG:{code}"))),
            Some((code, System::Unknown)) if self.epsg.is_none() => {
                let (value, bound) = (code.to_string(), "the EPSG code of a plane, such as 32632 of UTM zone 32 north");
                return Err(TerrainError::Wrong { key: "epsg", value, bound });
            }
            Some((_, System::Unknown)) | None => None,
        };
        let said = self.unit.clone().or(by_code).filter(|_| !self.placed);
        // A plane of the registry that is not known here has a unit, and nobody says which.
        let unknown =
            || self.unknown_unit.clone().or(epsg.filter(|_| said.is_none()).map(|code| format!("EPSG:{code}")));
        if let Some(said) = unknown().filter(|_| !self.placed && given.unit.is_none()) {
            return Err(TerrainError::UnknownUnit { key: "unit", said });
        }
        if !self.placed && said.is_none() && given.unit.is_none() && looks_like_degrees(center, cell) {
            return Err(geographic(format!(
                "cells of {} on coordinates like degrees, and no unit said (unit = \"m\" says that they are metres)",
                cell[0]
            )));
        }
        let (plane, plane_from) = told("unit", said, given.unit.map(Unit::from), || Some(Unit::metre()))?;
        let projection = epsg.and_then(definition).or(self.projection.as_deref());
        let in_metres = |place: &[f64; 2]| place.map(|c| c * plane.metres);
        let found = places.map(|place| scale(epsg, &self.name, projection, in_metres(&place)));
        if let Some((place, found)) = (0..).zip(found.iter().flatten()).find(|(_, found)| found.is_stretched()) {
            let what = self.called("a plane that stretches the ground");
            let words = found.scale.in_words();
            let at = if place == 0 { "" } else { " at a corner of the map" };
            let why = format!("{what}, on which a metre of the ground is {words}{at}: project it first");
            return Err(TerrainError::Convert { why, command: Remedy::project(file, found.at, self.radius) });
        }
        if let Some(said) = self.unknown_heights.as_ref().filter(|_| given.height_unit.is_none()) {
            return Err(TerrainError::UnknownUnit { key: "height_unit", said: said.clone() });
        }
        let taken = || (plane.is_metre() || given.assume_heights).then(|| plane.clone());
        let given_height = given.height_unit.map(Unit::from);
        let (height, height_from) = told("height_unit", self.height_unit.clone(), given_height, taken)?;
        let is_unknown = found[0].is_none() && (self.model == Model::Projected || epsg.is_some());
        Ok(Units {
            unknown_plane: is_unknown.then(|| named(epsg, &self.name).unwrap_or_else(|| "without a name".into())),
            plane,
            plane_from,
            height,
            height_from,
            epsg,
            name: self.name.clone(),
            scale: found[0].map(|found| found.scale),
        })
    }

    /// What is said of heights once more, elsewhere; another unit than before is none.
    pub(super) fn also_heights_in(&mut self, unit: Option<Unit>) {
        match (&self.height_unit, unit) {
            (Some(said), Some(unit)) if said.metres != unit.metres => {
                let both = format!("heights in {} by its keys, in {} by its band", said.name, unit.name);
                (self.height_unit, self.unknown_heights) = (None, Some(both));
            }
            (None, unit) => self.height_unit = unit,
            _ => {}
        }
    }

    fn called(&self, what: &str) -> String {
        named(self.epsg, &self.name).map_or_else(|| what.into(), |name| format!("{what} ({name})"))
    }
}

/// What a plane is called: by its code, else by its name, where it has one.
fn named(epsg: Option<u32>, name: &str) -> Option<String> {
    epsg.map(|code| format!("EPSG:{code}")).or_else(|| (!name.is_empty()).then(|| name.to_owned()))
}

fn looks_like_degrees([x, y]: [f64; 2], cell: [f64; 2]) -> bool {
    let largest = cell[0].max(cell[1]);
    largest > 0.0 && largest < FINEST && x.abs() <= 360.0 && y.abs() <= 90.0
}

/// What the file and a key say of one thing.
fn same(key: &'static str, said: Option<u32>, given: Option<u32>) -> Result<Option<u32>, TerrainError> {
    match (said, given) {
        (Some(said), Some(given)) if said != given => {
            Err(TerrainError::Contradicts { key, given: given.to_string(), said: said.to_string() })
        }
        _ => Ok(said.or(given)),
    }
}

/// The unit that the file says, or that is given, or that is taken.
fn told(
    key: &'static str,
    said: Option<Unit>,
    given: Option<Unit>,
    taken: impl FnOnce() -> Option<Unit>,
) -> Result<(Unit, Source), TerrainError> {
    match (said, given) {
        (Some(said), Some(given)) if said.metres != given.metres => {
            Err(TerrainError::Contradicts { key, given: given.name, said: said.name })
        }
        (Some(said), _) => Ok((said, Source::File)),
        (None, Some(given)) => Ok((given, Source::Given)),
        (None, None) => taken().map(|unit| (unit, Source::Taken)).ok_or(TerrainError::UnitOfHeights),
    }
}
