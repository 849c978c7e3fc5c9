//! Which file needs which, and where that goes round in a circle.
//!
//! A file needs the file that defines what it imports or mentions, whatever re-exports lie between. So the `mod.rs` of
//! a folder that only declares and re-exports is a face: it needs nothing, and whoever imports through it needs what
//! is behind. Only what is compiled without tests counts.

use std::collections::{BTreeMap, BTreeSet};

use super::house::{File, Found, House};

/// What each file needs of each other one: names, by the indices of both files.
pub(crate) type Needs = BTreeMap<(usize, usize), BTreeSet<String>>;

pub(crate) fn needs(house: &House) -> Needs {
    let mut needs = Needs::new();
    for (from, file) in house.files.iter().enumerate().filter(|(_, file)| !file.in_test) {
        for found in used(house, file) {
            if let Found::Item { name, .. } = &found
                && let Some(to) = house.file_of(&found).filter(|to| *to != from)
            {
                needs.entry((from, to)).or_default().insert(name.clone());
            }
        }
    }
    needs
}

/// What the code of `file` mentions, and what it imports for itself: a trait may be used without being mentioned.
fn used(house: &House, file: &File) -> Vec<Found> {
    let mentions = file.outline.mentions.iter().filter(|mention| !mention.in_test);
    let mut used: Vec<Found> = mentions.flat_map(|mention| house.mentioned(file, mention)).collect();
    for module in &file.outline.modules {
        let own = module.imports.iter().filter(|import| !import.in_test && !import.public && import.name.is_some());
        used.extend(own.flat_map(|import| house.follow(&module.path, &import.path)));
    }
    used
}

/// The largest sets of files in which each one needs, by way of others, each other one.
pub(crate) fn circles(needs: &Needs) -> Vec<BTreeSet<usize>> {
    let mut ahead: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    let mut back: BTreeMap<usize, Vec<usize>> = BTreeMap::new();
    for (from, to) in needs.keys() {
        ahead.entry(*from).or_default().push(*to);
        back.entry(*to).or_default().push(*from);
    }
    // Kosaraju: what is reached backwards from the last that is left, forwards.
    let (mut left, mut order) = (BTreeSet::new(), Vec::new());
    for start in ahead.keys() {
        leave(*start, &ahead, &mut left, &mut order);
    }
    let mut taken = BTreeSet::new();
    let mut circles = Vec::new();
    for start in order.into_iter().rev() {
        let mut circle = Vec::new();
        leave(start, &back, &mut taken, &mut circle);
        if circle.len() > 1 {
            circles.push(circle.into_iter().collect());
        }
    }
    circles
}

/// Everything new that is reached from `start`, each after all that is reached from it.
fn leave(start: usize, next: &BTreeMap<usize, Vec<usize>>, seen: &mut BTreeSet<usize>, order: &mut Vec<usize>) {
    if !seen.insert(start) {
        return;
    }
    for to in next.get(&start).into_iter().flatten() {
        leave(*to, next, seen, order);
    }
    order.push(start);
}

/// Each need inside of a circle, in words.
pub(crate) fn told(house: &House, needs: &Needs, circle: &BTreeSet<usize>) -> Vec<String> {
    let inside = needs.iter().filter(|((from, to), _)| circle.contains(from) && circle.contains(to));
    inside
        .map(|((from, to), names)| {
            let names: Vec<&str> = names.iter().map(String::as_str).collect();
            format!("{} needs {} for {}", house.files[*from].path, house.files[*to].path, names.join(", "))
        })
        .collect()
}
