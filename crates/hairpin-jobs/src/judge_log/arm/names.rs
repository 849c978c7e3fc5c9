//! Which joints of a log are which axes of the arm: by the names of its file, else by their numbers; never guessed.

use hairpin::robot::arm::AXES;
use hairpin_formats::controller_log::JointColumns;
use hairpin_formats::quote::shortened;

use super::found::JointsTold;

/// Where each axis is in a log whose joints are called `names`.
///
/// # Errors
/// Neither all of the arm's `own` names are there, nor one stem with the numbers 1 to 6: both lists in a sentence.
pub(super) fn axes(names: &[String], own: &[String; AXES]) -> Result<([usize; AXES], JointsTold), String> {
    let at = |name: &str| names.iter().position(|found| found == name);
    let by_name: Option<Vec<usize>> = own.iter().map(|name| at(name)).collect();
    let numbered = || {
        // `left_joint_1` … `left_joint_6`: one stem, and only one.
        let stem = |name: &String| name.strip_suffix('1').map(str::to_owned);
        let six = |stem: &String| (1..=AXES).map(|axis| at(&format!("{stem}{axis}"))).collect::<Option<Vec<usize>>>();
        let mut found: Vec<Vec<usize>> = names.iter().filter_map(stem).filter_map(|stem| six(&stem)).collect();
        if found.len() == 1 { found.pop() } else { None }
    };
    let is_by_name = by_name.is_some();
    let found: Option<[usize; AXES]> = by_name.or_else(numbered).and_then(|places| places.try_into().ok());
    let Some(found) = found else {
        return Err(format!(
            "its joints are {}; this arm's are {} (`joint_names` of its file), or six of one stem numbered from 1 to 6: \
             none is taken for another",
            shortened(&names.join(", ")),
            own.join(", ")
        ));
    };
    let mut order: Vec<usize> = found.to_vec();
    order.sort_unstable();
    let named = |places: &[usize]| places.iter().map(|place| names[*place].clone()).collect::<Vec<_>>();
    let others = names.iter().enumerate().filter(|(place, _)| !found.contains(place));
    let told = JointsTold {
        names: named(&found),
        order: named(&order),
        by_name: is_by_name,
        unit: "rad",
        others: others.map(|(_, name)| name.clone()).collect(),
    };
    Ok((found, told))
}

/// The joints of a table, whose columns are numbered and say their unit.
pub(super) fn of_columns(columns: &JointColumns) -> JointsTold {
    let degrees = columns.axes.iter().filter(|name| name.ends_with("_deg")).count();
    let unit = match degrees {
        0 => "rad",
        AXES => "deg",
        _ => "rad and deg",
    };
    let (order, others) = (columns.order.clone(), columns.others.clone());
    JointsTold { names: columns.axes.to_vec(), order, by_name: false, unit, others }
}
