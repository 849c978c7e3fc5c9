//! What a scenario of drives names rather than holds: its elevation map; and its frame, which becomes that of the map.

use std::path::Path;
use std::sync::Arc;

use hairpin::campaign::scenario::{DriveScenario, Frame, TerrainSection};
use sha2::{Digest, Sha256};

use super::place_of;
use super::report::Report;
use super::resolve::read_file;
use super::tree::Node;
use crate::frames::other_yaw;
use crate::terrain::{Georeference, read_terrain};

/// Reads the map and turns poses into the map's frame; mistakes go to `report`.
pub(super) fn resolve(scenario: &mut DriveScenario, base: &Path, root: &Node, report: &mut Report) {
    let terrain = &mut scenario.world.terrain;
    if let Some(file) = terrain.file.clone()
        && terrain.generator.is_none()
        && let Err((key, value, bound)) = read(terrain, &file, base)
    {
        let key = format!("world.terrain.{key}");
        let message = format!("`{key}` = {value:?}: {bound}");
        report.complain(&place_of(root, &key), &key, &value, &bound, message);
    }
    if scenario.world.frame == Frame::Ned {
        turn(scenario);
    }
}

/// Reads the map of a resolved scenario that lies in `folder`, as beside a repro file, or in the folder above.
///
/// # Errors
/// The map cannot be read, or is another one.
pub(super) fn attach(drive: &mut DriveScenario, folder: &Path) -> Result<(), Report> {
    let terrain = &mut drive.world.terrain;
    let Some(file) = terrain.file.clone() else { return Ok(()) };
    let above = folder.join("..");
    let base = if folder.join(&file).is_file() { folder } else { &above };
    read(terrain, &file, base).map_err(|(key, value, bound)| {
        let mut report = Report::default();
        report.complain_of_file(&file, &format!("`world.terrain.{key}` = {value:?}: {bound}"));
        report
    })
}

/// Reads `file`; what is wrong is told as key, value and bound. A resolved scenario's map is `terrain.ENDING`, which a
/// campaign folder holds.
fn read(terrain: &mut TerrainSection, file: &str, base: &Path) -> Result<(), (&'static str, String, String)> {
    let wrong = |bound: String| ("file", file.to_owned(), bound);
    let bytes = read_file(&base.join(file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let georeference = Georeference {
        cell_m: terrain.cell_m,
        height_m: terrain.height_m,
        origin_m: terrain.origin_m,
        columns: None,
        holes: terrain.no_data.into(),
    };
    let map = read_terrain(&bytes, file, &georeference).map_err(|error| wrong(error.to_string()))?;
    let checksum = Sha256::digest(&bytes).iter().map(|byte| format!("{byte:02x}")).collect::<String>();
    if let Some(given) = terrain.checksum.as_ref().filter(|given| **given != checksum) {
        let bound = format!("the checksum of `{file}`, which is {checksum}: it is another map");
        return Err(("checksum", given.clone(), bound));
    }
    let ending = Path::new(file).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    terrain.file = Some(format!("terrain.{ending}"));
    terrain.checksum = Some(checksum);
    terrain.map = Some(Arc::new(map));
    terrain.bytes = Some(bytes.into());
    Ok(())
}

/// From x north, y east, yaw clockwise from north to x east, y north, yaw counter-clockwise from east.
fn turn(scenario: &mut DriveScenario) {
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
    scenario.world.frame = Frame::Enu;
}
