//! What an arm's scenario names rather than holds: its cloud of points, a table of costs.

use std::path::PathBuf;
use std::sync::Arc;

use hairpin::campaign::Attached;
use hairpin::campaign::attachments::{CloudPoint, CostMatrix};
use hairpin::campaign::scenario::CostTable;
use hairpin::trajectory::program::{Move, Program};
use nalgebra::Isometry3;

use super::attached::{InFile, Wrong, attached, ending};
use super::whole::read_file;
use crate::bounds::check_table;
use crate::checksum::sha256;
use crate::{cloud, costs, rapid};

/// Reads the cloud in `file`, `task.points`. A resolved scenario's is `cloud.ENDING`, which a campaign folder holds.
pub(super) fn cloud(
    file: &mut String,
    checksum: &mut Option<String>,
    in_object: bool,
    find: &dyn Fn(&str) -> PathBuf,
) -> Result<Attached<[CloudPoint]>, Wrong> {
    let wrong = |bound: String| Wrong { key: "task.points".into(), value: file.clone(), bound, at: None };
    let bytes = read_file(&find(file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let ending = ending(file);
    let read = points_of(&bytes, &ending, in_object).and_then(|points| {
        cloud::check_extent(&points)?;
        Ok(points)
    });
    let read = read.map_err(|Refused { line, why }| Wrong {
        at: Some(InFile::boxed(file, &bytes, line.unwrap_or(1))),
        ..wrong(why)
    })?;
    let points = read.iter().map(|point| CloudPoint {
        mm: (point.position.coords * 1000.0).into(),
        q1_q4: point.orientation.map(|q| [q.w, q.i, q.j, q.k]),
        configuration: point.configuration,
    });
    let sum = sha256(&bytes);
    if let Some(given) = checksum.as_ref().filter(|given| **given != sum) {
        let bound = format!("the checksum of `{file}`, which is {sum}: it is another cloud");
        return Err(Wrong { key: "task.checksum".into(), value: given.clone(), bound, at: None });
    }
    let name = format!("cloud.{ending}");
    let cloud = attached(points.collect(), bytes, &name, file);
    (*file, *checksum) = (name, Some(sum));
    Ok(cloud)
}

/// Where the point stands that `key` means, `task.points[3]`, in the file of its cloud.
pub(super) fn row_of(cloud: &Attached<[CloudPoint]>, key: &str) -> Option<Box<InFile>> {
    let row: usize = key.strip_prefix("task.points[")?.split(']').next()?.parse().ok()?;
    // What was taken once is taken again, whatever frame it is in.
    let points = points_of(&cloud.bytes, &ending(&cloud.name), true).ok()?;
    Some(InFile::boxed(&cloud.given, &cloud.bytes, points.get(row)?.line))
}

/// Why a file is no cloud, and on which of its lines.
struct Refused {
    line: Option<usize>,
    why: String,
}

impl Refused {
    fn whole(why: impl ToString) -> Self {
        Self { line: None, why: why.to_string() }
    }
}

impl From<cloud::CloudError> for Refused {
    fn from(error: cloud::CloudError) -> Self {
        Self { line: error.line(), why: error.to_string() }
    }
}

/// The points of a file with this ending.
fn points_of(bytes: &[u8], ending: &str, in_object: bool) -> Result<Vec<cloud::CloudPoint>, Refused> {
    if matches!(ending, "mod" | "sys" | "prg") { of_module(bytes, in_object) } else { of_csv(bytes) }
}

fn of_csv(bytes: &[u8]) -> Result<Vec<cloud::CloudPoint>, Refused> {
    check_table(bytes).map_err(Refused::whole)?;
    let text = std::str::from_utf8(bytes);
    let text = text.map_err(|error| Refused::whole(format!("must be UTF-8 text: {error}")))?;
    Ok(cloud::parse(text)?)
}

/// The robtargets that a module declares; unless they are said to be `in_object`, none that it meets in another frame
/// than the base.
fn of_module(bytes: &[u8], in_object: bool) -> Result<Vec<cloud::CloudPoint>, Refused> {
    let module = rapid::read(bytes, &rapid::Options::default()).map_err(Refused::whole)?;
    if let Some(elsewhere) = elsewhere(&module.program).filter(|_| !in_object) {
        return Err(elsewhere);
    }
    let targets = module
        .targets
        .iter()
        .map(|declared| (declared.line, declared.name.as_str(), declared.target.as_ref().map_err(String::as_str)));
    Ok(cloud::from_targets(targets)?)
}

/// The first robtarget that a program meets in a work object which is not the base, in words.
fn elsewhere(program: &Program) -> Option<Refused> {
    let object = |one: &Move| program.work_objects.get(one.work_object);
    let aside = |one: &&Move| object(one).is_some_and(|object| object.base_from_object() != Isometry3::identity());
    let moves = program.moves.iter().filter(aside);
    let (one, name) = moves.flat_map(|one| one.motion.poses().map(move |to| (one, to.name.as_deref()))).next()?;
    let why = format!(
        "line {}: robtarget `{}` is met in work object `{}`, and points are taken to be in the base: give its frame in \
         world.wobj and say task.points_in.frame = \"wobj\"",
        one.line.unwrap_or_default(),
        name.unwrap_or("in place"),
        object(one)?.name
    );
    Some(Refused { line: one.line, why })
}

/// Reads the table of costs. A resolved scenario's is `costs.csv`.
pub(super) fn costs(table: &mut CostTable, find: &dyn Fn(&str) -> PathBuf) -> Result<Attached<CostMatrix>, Wrong> {
    let file = table.table.clone();
    let wrong = |bound: String| Wrong { key: "generate.cost.table".into(), value: file.clone(), bound, at: None };
    let path = find(&file);
    let bytes = read_file(&path).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let read = costs::read(&path).map_err(|error| {
        let at = error.line().map(|line| InFile::boxed(&file, &bytes, line));
        Wrong { at, ..wrong(error.to_string()) }
    })?;
    let unit = 1.0 / read.scale() as f64;
    table.table = "costs.csv".into();
    let matrix = CostMatrix { points: read.points, costs: read.costs, unit };
    Ok(attached(Arc::new(matrix), bytes, &table.table, &file))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn robtargets_of_another_frame_than_the_base_are_not_taken_for_its_own() {
        let text = "MODULE c\nTASK PERS wobjdata wT := [FALSE,TRUE,\"\",[[0,0,100],[1,0,0,0]],[[0,0,0],[1,0,0,0]]];\n\
            CONST robtarget a := [[300,0,300],[0,0,1,0],[0,0,0,0],[9E9,9E9,9E9,9E9,9E9,9E9]];\n\
            PROC main()\n  MoveJ a, v200, fine, tool0 \\WObj:=wT;\nENDPROC\nENDMODULE\n";
        let told = of_module(text.as_bytes(), false).err().unwrap();
        assert!(told.why.starts_with("line 5: robtarget `a` is met in work object `wT`"), "{}", told.why);
        assert_eq!(told.line, Some(5));
        assert_eq!(of_module(text.as_bytes(), true).ok().unwrap().len(), 1);
        let in_base = text.replace("\\WObj:=wT", "");
        assert_eq!(of_module(in_base.as_bytes(), false).ok().unwrap().len(), 1);
    }
}
