//! What an arm's scenario names rather than holds: its cloud of points, a table of costs, meshes.

use std::path::Path;
use std::sync::Arc;

use hairpin::campaign::learn::NAME;
use hairpin::campaign::scenario::{ArmControllerKind, ArmScenario, CloudPoint, CostMatrix, CostSection, PointsSource};
use sha2::{Digest, Sha256};

use super::baseline;
use super::report::Report;
use super::resolve::read_file;
use super::tree::Node;
use super::{Wrong, place_of};
use crate::folder::BASELINE;
use crate::mesh::read_mesh;
use crate::{cloud, costs, rapid};

/// Reads the files; mistakes go to `report`.
pub(super) fn resolve(scenario: &mut ArmScenario, base: &Path, root: &Node, report: &mut Report) {
    if scenario.execute.logs.is_none() && scenario.execute.controller.is_none() {
        scenario.execute.controller = Some(ArmControllerKind::Virtual);
    }
    for (key, value, bound) in read_files(scenario, base) {
        let message = format!("`{key}` = {value:?}: {bound}");
        report.complain(&place_of(root, &key), &key, &value, &bound, message);
    }
}

/// Reads the files of a resolved scenario that lies in `folder`, as beside a repro file, or in the folder above.
///
/// # Errors
/// A file cannot be read, or is another one.
pub(super) fn attach(scenario: &mut ArmScenario, folder: &Path) -> Result<(), Report> {
    let above = folder.join("..");
    let points = match &scenario.task.points {
        PointsSource::File(file) => Some(file.as_str()),
        PointsSource::List(_) | PointsSource::Drawn(_) => None,
    };
    let table = match &scenario.generate.cost {
        CostSection::Table(table) => Some(table.table.as_str()),
        CostSection::Learned(_) => Some(NAME),
        CostSection::Named(_) | CostSection::Weighted(_) => None,
    };
    let baseline = scenario.spec.regression.as_ref().map(|limit| limit.baseline.as_str());
    let here = [points, table, baseline].into_iter().flatten().all(|file| folder.join(file).is_file());
    match read_files(scenario, if here { folder } else { &above }).into_iter().next() {
        None => Ok(()),
        Some((key, value, bound)) => {
            let mut report = Report::default();
            report.complain_of_file(&value, &format!("`{key}` = {value:?}: {bound}"));
            Err(report)
        }
    }
}

fn read_files(scenario: &mut ArmScenario, base: &Path) -> Vec<Wrong> {
    let results = [points(scenario, base), table(scenario, base), meshes(scenario, base), regression(scenario, base)];
    results.into_iter().filter_map(Result::err).collect()
}

/// Reads the cloud. A resolved scenario's is `cloud.ENDING`, which a campaign folder holds.
fn points(scenario: &mut ArmScenario, base: &Path) -> Result<(), Wrong> {
    let task = &mut scenario.task;
    let PointsSource::File(file) = &task.points else { return Ok(()) };
    let wrong = |bound: String| ("task.points".to_owned(), file.clone(), bound);
    let bytes = read_file(&base.join(file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let ending = Path::new(file).extension().unwrap_or_default().to_string_lossy().to_ascii_lowercase();
    let module = matches!(ending.as_str(), "mod" | "sys" | "prg");
    let read = if module { of_module(&bytes) } else { of_csv(&bytes) }.map_err(wrong)?;
    cloud::check_extent(&read).map_err(|error| wrong(error.to_string()))?;
    let points = read.iter().map(|point| CloudPoint {
        mm: (point.position.coords * 1000.0).into(),
        q1_q4: point.orientation.map(|q| [q.w, q.i, q.j, q.k]),
        configuration: point.configuration,
    });
    let checksum = hex(&bytes);
    if let Some(given) = task.checksum.as_ref().filter(|given| **given != checksum) {
        let bound = format!("the checksum of `{file}`, which is {checksum}: it is another cloud");
        return Err(("task.checksum".into(), given.clone(), bound));
    }
    task.cloud = Some(points.collect());
    task.points = PointsSource::File(format!("cloud.{ending}"));
    task.checksum = Some(checksum);
    task.bytes = Some(bytes.into());
    Ok(())
}

fn of_csv(bytes: &[u8]) -> Result<Vec<cloud::CloudPoint>, String> {
    let text = std::str::from_utf8(bytes).map_err(|error| format!("must be UTF-8 text: {error}"))?;
    cloud::parse(text).map_err(|error| error.to_string())
}

/// The robtargets that a module declares.
fn of_module(bytes: &[u8]) -> Result<Vec<cloud::CloudPoint>, String> {
    let module = rapid::read(bytes, &rapid::Options::default()).map_err(|error| error.to_string())?;
    let targets = module
        .targets
        .iter()
        .map(|declared| (declared.line, declared.name.as_str(), declared.target.as_ref().map_err(String::as_str)));
    cloud::from_targets(targets).map_err(|error| error.to_string())
}

/// Reads the table of costs. A resolved scenario's is `costs.csv`.
fn table(scenario: &mut ArmScenario, base: &Path) -> Result<(), Wrong> {
    let CostSection::Table(table) = &mut scenario.generate.cost else { return Ok(()) };
    let file = table.table.clone();
    let wrong = |bound: String| ("generate.cost.table".to_owned(), file.clone(), bound);
    let bytes = read_file(&base.join(&file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let read = costs::read(&base.join(&file)).map_err(|error| wrong(error.to_string()))?;
    let unit = 1.0 / read.scale() as f64;
    table.table = "costs.csv".into();
    table.costs = Some(Arc::new(CostMatrix { points: read.points, costs: read.costs, unit }));
    table.bytes = Some(bytes.into());
    Ok(())
}

fn meshes(scenario: &mut ArmScenario, base: &Path) -> Result<(), Wrong> {
    for (index, obstacle) in scenario.world.obstacles.iter_mut().enumerate() {
        let Some(mesh) = &mut obstacle.mesh else { continue };
        let Some(file) = mesh.file.take() else { continue };
        let wrong = |bound: String| (format!("world.obstacles[{index}].mesh.file"), file.clone(), bound);
        if !mesh.vertices_mm.is_empty() || !mesh.triangles.is_empty() {
            return Err(wrong("either a file or vertices_mm and triangles, not both".into()));
        }
        let bytes = read_file(&base.join(&file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
        let read = read_mesh(&bytes, &file).map_err(|error| wrong(error.to_string()))?;
        let scale = mesh.scale_mm.take().unwrap_or(1.0);
        mesh.vertices_mm = read.vertices.iter().map(|vertex| vertex.map(|part| part * scale)).collect();
        mesh.triangles = read.triangles;
    }
    Ok(())
}

/// Reads the baseline. A resolved scenario's is `baseline.json`, which a campaign folder holds.
fn regression(scenario: &mut ArmScenario, base: &Path) -> Result<(), Wrong> {
    let Some(limit) = &mut scenario.spec.regression else { return Ok(()) };
    let given = limit.baseline.clone();
    let wrong = |bound: String| ("spec.regression.baseline".to_owned(), given.clone(), bound);
    let (read, bytes) = baseline::read(&base.join(&given)).map_err(wrong)?;
    let checksum = hex(&bytes);
    if let Some(other) = limit.checksum.as_ref().filter(|other| **other != checksum) {
        let bound = format!("the checksum of `{given}`, which is {checksum}: it is another baseline");
        return Err(("spec.regression.checksum".into(), other.clone(), bound));
    }
    limit.baseline = BASELINE.into();
    limit.checksum = Some(checksum);
    limit.read = Some(Arc::new(read));
    limit.bytes = Some(bytes.into());
    Ok(())
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}
