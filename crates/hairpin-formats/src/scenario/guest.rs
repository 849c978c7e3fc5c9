//! A scenario that lies in a campaign's folder may have come with it from elsewhere: what it names must lie there too.

use std::path::{Path, PathBuf};

use hairpin::campaign::scenario::{CONTROLLER_KEY, LEARNED, Named, PYTHON, TARGET_KEY, Target};

use super::attached::Wrong;
use super::tree::{Node, NodeKind};
use super::write::read_made_by;
use crate::bounds::{self, MOST_TEXT_BYTES};
use crate::folder::{SCENARIO, inside, is_written_to};
use crate::library;

/// Whose names are held to their folder.
#[derive(Clone, Copy)]
pub(super) struct Guest<'a> {
    /// The folder.
    folder: &'a Path,
    /// Keys with other values, as the user typed them: these are his own names.
    sets: &'a [(String, String)],
}

impl<'a> Guest<'a> {
    /// The scenario in `folder`, but for what `sets` change.
    pub(super) fn new(folder: &'a Path, sets: &'a [(String, String)]) -> Self {
        Self { folder, sets }
    }

    /// What of `named` leads out of the folder.
    pub(super) fn wrong(&self, named: &Named<'_>) -> Vec<Wrong> {
        names(named)
            .into_iter()
            .filter_map(|(key, name)| Some(Wrong { bound: self.refusal(&name)?, key, value: name, at: None }))
            .collect()
    }

    /// Where the robot or the base world of the scenario `root` is a file that does not lie in the folder: its key, the
    /// name, and why not.
    pub(super) fn wrong_part(&self, root: &Node) -> Option<(&'static str, String, String)> {
        let parts =
            [("robot", root.get("robot")), ("world.base", root.get("world").and_then(|world| world.get("base")))];
        parts.into_iter().find_map(|(key, node)| {
            let NodeKind::Text(name) = &node?.kind else { return None };
            let shipped = library::robots().chain(library::worlds()).any(|shipped| shipped.name == name);
            let why = if shipped { None } else { self.refusal(name) };
            Some((key, name.clone(), why?))
        })
    }

    /// Why a name is refused, if it is.
    fn refusal(&self, name: &str) -> Option<String> {
        if self.sets.iter().any(|(_, value)| value.contains(name)) {
            return None;
        }
        inside(self.folder, name).err()
    }
}

/// The folder of a campaign whose own scenario `name_or_path` is; `None` where it is anything else.
pub fn kept_in(name_or_path: &str) -> Option<PathBuf> {
    let path = Path::new(name_or_path);
    if path.file_name()? != SCENARIO || !path.is_file() {
        return None;
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let made = || bounds::read_text(path, MOST_TEXT_BYTES).is_ok_and(|text| read_made_by(&text).is_some());
    (is_written_to(folder) || made()).then(|| folder.to_owned())
}

/// Every file that a scenario names, by its key.
fn names(named: &Named<'_>) -> Vec<(String, String)> {
    let Named { map, cloud, in_object: _, costs, meshes, score, target, controller, baseline } = named;
    let mut all: Vec<(String, String)> = Vec::new();
    let mut add = |key: &str, name: &str| all.push((key.to_owned(), name.to_owned()));
    if let Some(file) = map.as_ref().and_then(|map| map.file.as_ref()) {
        add("world.terrain.file", file);
    }
    if let Some((file, _)) = cloud {
        add("task.points", file);
    }
    if let Some(costs) = costs {
        add("generate.cost.table", &costs.table);
    }
    for mesh in meshes {
        if let Some(file) = mesh.file.as_ref() {
            add(&mesh.key, file);
        }
    }
    if let Some((key, score)) = score
        && let Some(file) = [LEARNED, PYTHON].iter().find_map(|kind| score.strip_prefix(kind))
    {
        add(key, file);
    }
    if let Some(Target::Python(file)) = target {
        add(TARGET_KEY, file);
    }
    if let Some(file) = controller.as_ref().and_then(|steering| steering.file()) {
        add(CONTROLLER_KEY, file);
    }
    if let Some(baseline) = baseline {
        add("spec.regression.baseline", &baseline.baseline);
    }
    all
}
