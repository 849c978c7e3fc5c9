//! What a scenario of drives names rather than holds: its elevation map; and its frame, which becomes that of the map.

use std::path::PathBuf;
use std::sync::Arc;

use hairpin::campaign::scenario::{DriveScenario, Frame, TerrainSection};
use hairpin::campaign::{Attached, Scenario};
use hairpin::world::terrain::ElevationMap;

use super::attached::{Wrong, attached, ending};
use super::whole::read_file;
use crate::checksum::sha256;
use crate::frames::other_yaw;
use crate::terrain::{Georeference, read_terrain};

/// Reads the map as `terrain` says. A resolved scenario's map is `terrain.ENDING`, which a campaign folder holds.
pub(super) fn read(
    terrain: &mut TerrainSection,
    find: &dyn Fn(&str) -> PathBuf,
) -> Result<(TerrainSection, Attached<ElevationMap>), Wrong> {
    let file = terrain.file.clone().unwrap_or_default();
    let wrong = |bound: String| Wrong { key: "world.terrain.file".into(), value: file.clone(), bound };
    let bytes = read_file(&find(&file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let georeference = Georeference {
        cell_m: terrain.cell_m,
        height_m: terrain.height_m,
        origin_m: terrain.origin_m,
        columns: None,
        holes: terrain.no_data.into(),
    };
    let map = read_terrain(&bytes, &file, &georeference).map_err(|error| wrong(error.to_string()))?;
    let checksum = sha256(&bytes);
    if let Some(given) = terrain.checksum.as_ref().filter(|given| **given != checksum) {
        let bound = format!("the checksum of `{file}`, which is {checksum}: it is another map");
        return Err(Wrong { key: "world.terrain.checksum".into(), value: given.clone(), bound });
    }
    let name = format!("terrain.{}", ending(&file));
    let map = attached(Arc::new(map), bytes, &name, &file);
    terrain.file = Some(name);
    terrain.checksum = Some(checksum);
    Ok((terrain.clone(), map))
}

/// Turns the poses of a file in another frame into the map's own.
pub(super) fn turn(scenario: &mut Scenario) {
    if let Some(drive) = scenario.own_mut::<DriveScenario>().filter(|drive| drive.world.frame == Frame::Ned) {
        turn_poses(drive);
    }
}

/// From x north, y east, yaw clockwise from north to x east, y north, yaw counter-clockwise from east.
fn turn_poses(scenario: &mut DriveScenario) {
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
