//! What an arm's scenario names rather than holds: its cloud of points, a table of costs.

use std::path::PathBuf;
use std::sync::Arc;

use hairpin::campaign::Attached;
use hairpin::campaign::attachments::{CloudPoint, CostMatrix};
use hairpin::campaign::scenario::CostTable;
use hairpin::trajectory::program::{Move, Program};
use nalgebra::Isometry3;

use super::attached::{Wrong, attached, ending};
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
    let wrong = |bound: String| Wrong { key: "task.points".into(), value: file.clone(), bound };
    let bytes = read_file(&find(file)).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let ending = ending(file);
    let module = matches!(ending.as_str(), "mod" | "sys" | "prg");
    let read = if module { of_module(&bytes, in_object) } else { of_csv(&bytes) }.map_err(wrong)?;
    cloud::check_extent(&read).map_err(|error| wrong(error.to_string()))?;
    let points = read.iter().map(|point| CloudPoint {
        mm: (point.position.coords * 1000.0).into(),
        q1_q4: point.orientation.map(|q| [q.w, q.i, q.j, q.k]),
        configuration: point.configuration,
    });
    let sum = sha256(&bytes);
    if let Some(given) = checksum.as_ref().filter(|given| **given != sum) {
        let bound = format!("the checksum of `{file}`, which is {sum}: it is another cloud");
        return Err(Wrong { key: "task.checksum".into(), value: given.clone(), bound });
    }
    let name = format!("cloud.{ending}");
    let cloud = attached(points.collect(), bytes, &name, file);
    (*file, *checksum) = (name, Some(sum));
    Ok(cloud)
}

fn of_csv(bytes: &[u8]) -> Result<Vec<cloud::CloudPoint>, String> {
    check_table(bytes)?;
    let text = std::str::from_utf8(bytes).map_err(|error| format!("must be UTF-8 text: {error}"))?;
    cloud::parse(text).map_err(|error| error.to_string())
}

/// The robtargets that a module declares; unless they are said to be `in_object`, none that it meets in another frame
/// than the base.
fn of_module(bytes: &[u8], in_object: bool) -> Result<Vec<cloud::CloudPoint>, String> {
    let module = rapid::read(bytes, &rapid::Options::default()).map_err(|error| error.to_string())?;
    if let Some(elsewhere) = elsewhere(&module.program).filter(|_| !in_object) {
        return Err(elsewhere);
    }
    let targets = module
        .targets
        .iter()
        .map(|declared| (declared.line, declared.name.as_str(), declared.target.as_ref().map_err(String::as_str)));
    cloud::from_targets(targets).map_err(|error| error.to_string())
}

/// The first robtarget that a program meets in a work object which is not the base, in words.
fn elsewhere(program: &Program) -> Option<String> {
    let object = |one: &Move| program.work_objects.get(one.work_object);
    let aside = |one: &&Move| object(one).is_some_and(|object| object.base_from_object() != Isometry3::identity());
    let moves = program.moves.iter().filter(aside);
    let (one, name) = moves.flat_map(|one| one.motion.poses().map(move |to| (one, to.name.as_deref()))).next()?;
    Some(format!(
        "line {}: robtarget `{}` is met in work object `{}`, and points are taken to be in the base: give its frame in \
         world.wobj and say task.points_in.frame = \"wobj\"",
        one.line.unwrap_or_default(),
        name.unwrap_or("in place"),
        object(one)?.name
    ))
}

/// Reads the table of costs. A resolved scenario's is `costs.csv`.
pub(super) fn costs(table: &mut CostTable, find: &dyn Fn(&str) -> PathBuf) -> Result<Attached<CostMatrix>, Wrong> {
    let file = table.table.clone();
    let wrong = |bound: String| Wrong { key: "generate.cost.table".into(), value: file.clone(), bound };
    let path = find(&file);
    let bytes = read_file(&path).map_err(|why| wrong(format!("cannot be read: {why}")))?;
    let read = costs::read(&path).map_err(|error| wrong(error.to_string()))?;
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
        let told = of_module(text.as_bytes(), false).unwrap_err();
        assert!(told.starts_with("line 5: robtarget `a` is met in work object `wT`"), "{told}");
        assert_eq!(of_module(text.as_bytes(), true).unwrap().len(), 1);
        let in_base = text.replace("\\WObj:=wT", "");
        assert_eq!(of_module(in_base.as_bytes(), false).unwrap().len(), 1);
    }
}
