//! The files that a scenario names: what they hold goes beside its keys, which from then on name the copies of a
//! campaign's folder.

use std::path::{Path, PathBuf};

use hairpin::campaign::scenario::{Named, NamedMesh};
use hairpin::campaign::{Attachments, Resolved, Scenario};

use super::attached::{Wrong, ending};
use super::guest::Guest;
use super::report::Report;
use super::whole::read_file;
use super::{baseline, cell, learned, terrain, user_controller, user_score, user_target};
use crate::bounds::MOST_MESH_PARTS;
use crate::folder::inside;
use crate::mesh::read_mesh;

/// Reads all files of `scenario`, each from where `find` says it lies, and all that is wrong with them. Those of a
/// `guest` must lie in its folder, and its Python stands alone there.
pub(super) fn read(
    scenario: &mut Scenario,
    find: &dyn Fn(&str) -> PathBuf,
    guest: Option<Guest<'_>>,
) -> (Attachments, Vec<Wrong>) {
    let mut wrong = guest.map_or_else(Vec::new, |guest| guest.wrong(&scenario.named()));
    if !wrong.is_empty() {
        return (Attachments::default(), wrong);
    }
    let terms = user_controller::Terms::of(&scenario.executor());
    let Named { map, cloud, in_object, costs, meshes, score, target, controller, baseline } = scenario.named();
    let map = map.and_then(|keys| noting(terrain::read(keys, find), &mut wrong));
    let cloud = cloud.and_then(|(file, checksum)| noting(cell::cloud(file, checksum, in_object, find), &mut wrong));
    let costs = costs.and_then(|table| noting(cell::costs(table, find), &mut wrong));
    let mut parts = 0;
    for keys in meshes {
        noting(mesh(keys, find, &mut parts), &mut wrong);
    }
    let baseline = baseline.and_then(|limit| noting(baseline::attach(limit, find), &mut wrong));
    let mut attachments = Attachments { map, cloud, costs, baseline, ..Attachments::default() };
    if let Some((key, score)) = score {
        attachments.model = noting(learned::read(key, score, find), &mut wrong).flatten();
        attachments.user_score = noting(user_score::read(key, score, find, guest.is_some()), &mut wrong).flatten();
    }
    if let Some(target) = target {
        attachments.user_target = noting(user_target::read(target, find, guest.is_some()), &mut wrong).flatten();
    }
    if let Some(steering) = controller {
        attachments.user_controller =
            noting(user_controller::read(steering, &terms, find, guest.is_some()), &mut wrong);
    }
    (attachments, wrong)
}

fn noting<T>(read: Result<T, Wrong>, wrong: &mut Vec<Wrong>) -> Option<T> {
    read.map_err(|one| wrong.push(one)).ok()
}

/// Reads what a resolved scenario names in `folder`, as beside a repro file, or in the folder above: its map, its
/// cloud.
///
/// # Errors
/// A file cannot be read, or is another one.
pub fn attach(mut scenario: Scenario, folder: &Path) -> Result<Resolved, Report> {
    let find = |file: &str| {
        let here = folder.join(file);
        // A link there is none of the folder's files.
        if here.is_file() { here } else { inside(&folder.join(".."), file).unwrap_or(here) }
    };
    let (attachments, wrong) = read(&mut scenario, &find, Some(Guest::new(folder, &[])));
    let of_score = wrong.iter().find(|wrong| wrong.key == scenario.score_key());
    match of_score.or(wrong.first()) {
        None => Ok(Resolved { scenario, attachments }),
        Some(one) => {
            let mut report = Report::default();
            report.complain_of_file(&one.value, &one.message());
            Err(report)
        }
    }
}

/// `parts` are the vertices and triangles so far.
fn mesh(keys: NamedMesh<'_>, find: &dyn Fn(&str) -> PathBuf, parts: &mut usize) -> Result<(), Wrong> {
    let NamedMesh { key, file, scale, scale_key, per_metre, vertices_key, vertices, triangles } = keys;
    let Some(file) = file.take() else { return Ok(()) };
    let scale = scale.take();
    if let Some(given) = scale.filter(|given| !(*given > 0.0 && given.is_finite())) {
        let key = key.replace(".mesh.file", &format!(".mesh.{scale_key}"));
        return Err(Wrong { key, value: given.to_string(), bound: "a finite number > 0".into(), at: None });
    }
    let wrong = |bound: String| Wrong { key: key.clone(), value: file.clone(), bound, at: None };
    if !vertices.is_empty() || !triangles.is_empty() {
        return Err(wrong(format!("either a file or {vertices_key} and triangles, not both")));
    }
    let bytes = read_file(&find(&file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let read = read_mesh(&bytes, &file).map_err(|error| wrong(error.to_string()))?;
    *parts += read.vertices.len() + read.triangles.len();
    if *parts > MOST_MESH_PARTS {
        let bound =
            format!("with the meshes before it {parts} vertices and triangles, at most {MOST_MESH_PARTS}: simplify it");
        return Err(wrong(bound));
    }
    // Collada says its unit, and is read in metres.
    let scale = scale.unwrap_or(if ending(&file) == "dae" { per_metre } else { 1.0 });
    *vertices = read.vertices.iter().map(|vertex| vertex.map(|part| part * scale)).collect();
    *triangles = read.triangles;
    Ok(())
}
