//! What a scenario of drives names rather than holds: its elevation map; and its frame, which becomes that of the map.

use std::path::PathBuf;
use std::sync::Arc;

use hairpin::campaign::scenario::{DriveScenario, Frame, KeyPath, MapUnit, TerrainSection};
use hairpin::campaign::{Attached, Scenario};
use hairpin::world::terrain::ElevationMap;

use super::attached::{Wrong, attached, ending};
use super::whole::read_file;
use crate::checksum::sha256;
use crate::frames::other_yaw;
use crate::terrain::{Georeference, MapFile, Sidecars, Unit, read_terrain};

/// Reads the map as `terrain` says. A resolved scenario's map is `terrain.ENDING`, which a campaign folder holds.
pub(super) fn read(
    terrain: &mut TerrainSection,
    find: &dyn Fn(&str) -> PathBuf,
) -> Result<(TerrainSection, Attached<ElevationMap>), Wrong> {
    let file = terrain.file.clone().unwrap_or_default();
    let wrong = |bound: String| Wrong { key: "world.terrain.file".into(), value: file.clone(), bound, at: None };
    let path = find(&file);
    let bytes = read_file(&path).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let georeference = Georeference {
        cell_m: terrain.cell_m,
        height_m: terrain.height_m,
        origin_m: terrain.origin_m,
        columns: terrain.columns,
        epsg: terrain.epsg,
        unit: terrain.unit,
        height_unit: terrain.height_unit,
        offset_m: terrain.offset_m,
        holes: terrain.no_data.into(),
        ..Georeference::default()
    };
    let beside = Sidecars::beside(&path);
    let MapFile { map, told } = read_terrain(&bytes, &file, &beside, &georeference).map_err(|error| {
        let key = error.key().map_or_else(|| "world.terrain.file".into(), |key| format!("world.terrain.{key}"));
        Wrong { key, value: file.clone(), bound: error.to_string(), at: None }
    })?;
    let checksum = sha256(&bytes);
    if let Some(given) = terrain.checksum.as_ref().filter(|given| **given != checksum) {
        let bound = format!("the checksum of `{file}`, which is {checksum}: it is another map");
        return Err(Wrong { key: "world.terrain.checksum".into(), value: given.clone(), bound, at: None });
    }
    let name = format!("terrain.{}", ending(&file));
    let map = attached(Arc::new(map), bytes, &name, &file);
    terrain.file = Some(name);
    terrain.epsg = told.epsg;
    if told.beside {
        // What lies beside the file is not in the copy of a campaign: keys say it there.
        terrain.unit = kept("unit", terrain.unit, &told.unit)?;
        terrain.height_unit = kept("height_unit", terrain.height_unit, &told.height_unit)?;
    }
    // Of what lay beside the file a campaign's copy knows this alone.
    terrain.unknown_plane = told.unknown_plane.or(terrain.unknown_plane.take());
    terrain.offset_m = terrain.offset_m.or(Some(told.offset_m).filter(|offset| *offset != [0.0, 0.0]));
    terrain.checksum = Some(checksum);
    Ok((terrain.clone(), map))
}

/// The key by which a campaign's copy of a map has the unit that lay beside the file; none for metres, which are taken.
fn kept(key: &str, given: Option<MapUnit>, told: &Unit) -> Result<Option<MapUnit>, Wrong> {
    if given.is_some() || told.is_metre() {
        return Ok(given);
    }
    told.as_given().map(Some).ok_or_else(|| Wrong {
        key: format!("world.terrain.{key}"),
        value: told.name.clone(),
        bound: "m, ft or us-ft where it is said beside the file, which a campaign's copy of it has not: write the map in metres"
            .into(),
        at: None,
    })
}

/// Whether the poses of `scenario` are in its map's own coordinates, should these turn out to be far from their zero.
pub(super) fn in_own_coordinates(scenario: &mut Scenario) -> bool {
    scenario.named().map.is_some_and(|terrain| terrain.offset_m.is_none())
}

/// Gives the poses of a file in another frame, or in the map's own coordinates, those of the map as it was read.
///
/// # Errors
/// What cannot be told to be in the map's own coordinates: draws of places, and an origin on Earth. Draws of poses in
/// a file that is not in the map's frame.
pub(super) fn place(scenario: &mut Scenario, own_coordinates: bool) -> Result<(), Wrong> {
    let Some(drive) = scenario.own_mut::<DriveScenario>() else { return Ok(()) };
    if drive.world.frame == Frame::Ned {
        turn_poses(drive)?;
    }
    if own_coordinates { shift_poses(drive) } else { Ok(()) }
}

/// Takes the offset that the map was given off the poses.
fn shift_poses(drive: &mut DriveScenario) -> Result<(), Wrong> {
    let Some([east, north]) = drive.world.terrain.offset_m else { return Ok(()) };
    let given = |key: String, what: &str| {
        let bound = format!(
            "left out, or world.terrain.offset_m = [{east}, {north}] given beside it: the map lies far from its \
             plane's zero, and {what} relative to that point"
        );
        Err(Wrong { key, value: "given".into(), bound, at: None })
    };
    if drive.world.origin.is_some() {
        return given("world.origin".into(), "the origin on Earth is then");
    }
    if let Some(key) = drawn(drive, &["task.start.x_m", "task.start.y_m", "task.end_m", "world.keep_out"]) {
        return given(format!("vary.\"{key}\""), "places are then drawn");
    }
    let place = |p: &mut [f64; 2]| *p = [p[0] - east, p[1] - north];
    let start = &mut drive.task.start;
    (start.x_m, start.y_m) = (start.x_m - east, start.y_m - north);
    drive.task.end_m.iter_mut().for_each(place);
    for keep_out in &mut drive.world.keep_out {
        keep_out.circle.iter_mut().for_each(|circle| place(&mut circle.center_m));
        keep_out.polygon.iter_mut().flat_map(|polygon| &mut polygon.points_m).for_each(place);
    }
    Ok(())
}

/// A key of `[vary]` that draws one of `places`, a part of it or more than it; the size of a keep-out is no place.
fn drawn<'a>(drive: &'a DriveScenario, places: &[&str]) -> Option<&'a String> {
    drive.vary.keys().find(|key| {
        let path = KeyPath::parse(key);
        let parts = path.as_ref().map_or(&[][..], KeyPath::segments);
        let is_of = |place: &&str| parts.iter().zip(place.split('.')).all(|(part, of)| part == of);
        parts.last().is_some_and(|last| last != "radius_m") && places.iter().any(is_of)
    })
}

/// From x north, y east, yaw clockwise from north to x east, y north, yaw counter-clockwise from east.
///
/// What is x afterwards was y, a right angle clockwise of the x that `world.origin` gives the heading of.
///
/// # Errors
/// Draws of poses: they are drawn later, in the frame of the map.
fn turn_poses(scenario: &mut DriveScenario) -> Result<(), Wrong> {
    if let Some(key) = drawn(scenario, &["task.start", "task.end_m", "world.keep_out"]) {
        return Err(Wrong {
            key: format!("vary.\"{key}\""),
            value: "given".into(),
            bound: "left out, or the file's poses in world.frame = \"enu\", in which they are drawn".into(),
            at: None,
        });
    }
    let start = &mut scenario.task.start;
    (start.x_m, start.y_m) = (start.y_m, start.x_m);
    start.yaw_deg = other_yaw(start.yaw_deg.to_radians()).to_degrees();
    start.curvature_1_m = -start.curvature_1_m;
    let place = |p: &mut [f64; 2]| p.swap(0, 1);
    scenario.task.end_m.iter_mut().for_each(place);
    for keep_out in &mut scenario.world.keep_out {
        keep_out.circle.iter_mut().for_each(|circle| place(&mut circle.center_m));
        keep_out.polygon.iter_mut().flat_map(|polygon| &mut polygon.points_m).for_each(place);
    }
    if let Some(origin) = &mut scenario.world.origin {
        origin.x_axis_heading_deg = beside(origin.x_axis_heading_deg);
    }
    scenario.world.frame = Frame::Enu;
    Ok(())
}

/// A right angle clockwise of a heading, °. One that is none stays, to be refused as it was given.
fn beside(heading: f64) -> f64 {
    match heading {
        0.0..270.0 => heading + 90.0,
        270.0..=360.0 => heading - 270.0,
        _ => heading,
    }
}
