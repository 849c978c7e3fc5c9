//! The floors inside of `campaign`: keys, what a case is, the seam of kinds, the kinds, the jobs, the report.

use std::collections::BTreeMap;

use super::circles::Needs;
use super::floors::starts_with;
use super::house::House;

/// The rooms from the ground up: each knows only rooms of the floors below its own, so those of one floor do not know
/// each other.
pub(crate) const ROOMS: &[&[&str]] = &[
    // What was typed, and values that know nothing else.
    &["digits", "testing", "stop", "curve", "case_number", "bounds", "answers", "failures"],
    &["scenario"],
    &["boat::keys"],
    // All keys are one sum: the table of the kinds.
    &["scenario::kinds"],
    &["user_code", "convoy"],
    &["vary", "user_score", "user_target", "user_controller", "baseline"],
    // What a case and its runs are.
    &["implausible"],
    &["full_rate"],
    &["case"],
    &["clock", "learn", "influence", "passage", "placement", "own_controller"],
    // What files hold beside the keys.
    &["tally", "attachments"],
    // What the kinds have in common.
    &["check"],
    &["graph"],
    // What the kinds are asked.
    &["kind"],
    // The kinds.
    &["flight", "drive", "arm", "boat"],
    // A scenario becomes a setup: the one `match`.
    &["setup"],
    &["missed", "impossible", "attitude"],
    &["callers_code", "chance", "coverage", "goals", "gravity", "hidden", "states"],
    // The jobs.
    &["mission", "judge", "rank"],
    &["landed", "flown"],
    &["executor", "samples"],
    &["execute", "counted"],
    &["calibrate", "fit", "trial", "verify", "verdict", "select", "compare", "shrink", "passes"],
    &["generate"],
    &["explain", "assumptions"],
    // What is told of it all.
    &["report"],
];

/// Floor and name of the room of a module below `campaign`; a room may have a longer name: `jobs::generate`.
pub(crate) fn room(module: &str) -> Option<(usize, &'static str)> {
    let below = module.strip_prefix("hairpin::campaign::")?;
    let of =
        |floor: &'static [&str]| floor.iter().filter(|room| starts_with(below, room)).max_by_key(|room| room.len());
    ROOMS.iter().enumerate().find_map(|(floor, rooms)| of(rooms).map(|room| (floor + 1, *room)))
}

/// Every import of a room from its own floor or above, by the two files: what must be cut.
pub(crate) fn breaches(house: &House, needs: &Needs) -> Vec<String> {
    let mut found = BTreeMap::new();
    for ((from, to), names) in needs {
        let (own, other) = (&house.files[*from], &house.files[*to]);
        let (Some((floor, room)), Some((above, needed))) = (room(&own.module), room(&other.module)) else { continue };
        if room != needed && above >= floor {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            found.insert(
                (own.path.clone(), other.path.clone()),
                format!(
                    "{} needs {} for {}: {room} on floor {floor} must not know {needed} on floor {above}",
                    own.path,
                    other.path,
                    names.join(", ")
                ),
            );
        }
    }
    found.into_values().collect()
}
