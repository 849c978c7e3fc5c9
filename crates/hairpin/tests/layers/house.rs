//! All sources, and where each name that one of them mentions is defined: through every `use`, `pub use` and `*`.

use std::collections::{BTreeSet, HashMap, HashSet};

use super::outline::{Import, Mention, Module, Name, Outline, What};
use super::sources::Source;

/// A source, read.
pub(crate) struct File {
    pub(crate) module: String,
    pub(crate) path: String,
    pub(crate) outline: Outline,
    /// Whether only tests compile it.
    pub(crate) in_test: bool,
}

/// Every source file, by what it defines.
pub(crate) struct House {
    pub(crate) files: Vec<File>,
    /// File and index of every module, by its path.
    modules: HashMap<String, (usize, usize)>,
    /// For each module the indices of what its scope has under a name.
    scopes: Vec<Vec<HashMap<String, Scope>>>,
}

#[derive(Default)]
struct Scope {
    names: Vec<usize>,
    imports: Vec<usize>,
}

/// What a path leads to.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Found {
    Module(String),
    /// An item of a module, and what of the path lies inside of it: a variant, a function of its own.
    Item {
        module: String,
        name: String,
        rest: Vec<String>,
    },
    /// Something of another crate.
    Outside,
}

impl Found {
    /// Its path.
    pub(crate) fn path(&self) -> Option<String> {
        match self {
            Found::Module(path) => Some(path.clone()),
            Found::Item { module, name, .. } => Some(format!("{module}::{name}")),
            Found::Outside => None,
        }
    }
}

impl House {
    pub(crate) fn new(sources: &[Source]) -> Self {
        let read = |source: &Source| File {
            module: source.module.clone(),
            path: source.path.clone(),
            outline: Outline::new(&source.module, &source.text),
            in_test: false,
        };
        let mut house = Self { files: sources.iter().map(read).collect(), modules: HashMap::new(), scopes: Vec::new() };
        for (file, read) in house.files.iter().enumerate() {
            for (index, module) in read.outline.modules.iter().enumerate() {
                house.modules.entry(module.path.clone()).or_insert((file, index));
            }
            house.scopes.push(read.outline.modules.iter().map(scope).collect());
        }
        for file in 0..house.files.len() {
            house.files[file].in_test = house.only_tests(&house.files[file].module);
        }
        house
    }

    /// Whether some module above `module` was declared for tests alone.
    fn only_tests(&self, module: &str) -> bool {
        let parts: Vec<&str> = module.split("::").collect();
        (1..parts.len()).any(|depth| {
            parts[depth] == "tests"
                || self.module(&parts[..depth].join("::")).is_some_and(|(_, parent)| {
                    parent
                        .names
                        .iter()
                        .any(|name| name.in_test && matches!(name.what, What::Module) && name.name == parts[depth])
                })
        })
    }

    /// The module with this path, and its file.
    pub(crate) fn module(&self, path: &str) -> Option<(usize, &Module)> {
        let (file, index) = *self.modules.get(path)?;
        Some((file, &self.files[file].outline.modules[index]))
    }

    /// The file that defines what was found.
    pub(crate) fn file_of(&self, found: &Found) -> Option<usize> {
        match found {
            Found::Module(module) | Found::Item { module, .. } => self.modules.get(module).map(|(file, _)| *file),
            Found::Outside => None,
        }
    }

    /// How `module` declares `name`.
    pub(crate) fn declared(&self, module: &str, name: &str) -> Option<&Name> {
        self.module(module)?.1.names.iter().find(|declared| declared.name == name)
    }

    /// What `path` in `module` leads to: of each namespace one. Empty of what the house does not declare.
    pub(crate) fn follow(&self, module: &str, path: &[String]) -> BTreeSet<Found> {
        self.resolve(module, path, &mut HashSet::new())
    }

    /// What `mention` leads to.
    pub(crate) fn mentioned(&self, file: &File, mention: &Mention) -> BTreeSet<Found> {
        self.follow(&file.outline.modules[mention.module].path, &mention.path)
    }

    fn resolve(&self, module: &str, path: &[String], seen: &mut HashSet<(String, String)>) -> BTreeSet<Found> {
        let Some((head, rest)) = path.split_first() else { return BTreeSet::new() };
        let (root, parent) = (module.split("::").next().unwrap_or_default(), module.rsplit_once("::"));
        let start = match head.as_str() {
            "crate" => BTreeSet::from([Found::Module(root.into())]),
            "self" => BTreeSet::from([Found::Module(module.into())]),
            "super" => parent.map(|(parent, _)| Found::Module(parent.into())).into_iter().collect(),
            _ => self.in_scope(module, head, true, seen),
        };
        let start = match () {
            () if !start.is_empty() => start,
            () if !head.contains("::") && self.modules.contains_key(head.as_str()) => {
                BTreeSet::from([Found::Module(head.clone())])
            }
            () => return BTreeSet::new(),
        };
        rest.iter().fold(start, |found, part| found.into_iter().flat_map(|at| self.descend(at, part, seen)).collect())
    }

    /// `part` of what was found.
    fn descend(&self, found: Found, part: &str, seen: &mut HashSet<(String, String)>) -> BTreeSet<Found> {
        match found {
            Found::Module(module) if part == "super" => {
                module.rsplit_once("::").map(|(parent, _)| Found::Module(parent.into())).into_iter().collect()
            }
            Found::Module(module) if part == "self" => BTreeSet::from([Found::Module(module)]),
            Found::Module(module) => self.in_scope(&module, part, false, seen),
            Found::Item { module, name, mut rest } => {
                if !self.declared(&module, &name).is_some_and(|declared| !matches!(declared.what, What::Function)) {
                    return BTreeSet::new();
                }
                rest.push(part.into());
                BTreeSet::from([Found::Item { module, name, rest }])
            }
            Found::Outside => BTreeSet::from([Found::Outside]),
        }
    }

    /// What `name` is in the scope of `module`, also by what a function imports for itself if `inside`.
    fn in_scope(
        &self,
        module: &str,
        name: &str,
        inside: bool,
        seen: &mut HashSet<(String, String)>,
    ) -> BTreeSet<Found> {
        let mut found = BTreeSet::new();
        let Some(&(file, index)) = self.modules.get(module) else { return found };
        let declares = &self.files[file].outline.modules[index];
        let scope = self.scopes[file][index].get(name);
        let child = format!("{module}::{name}");
        if self.modules.contains_key(&child) {
            found.insert(Found::Module(child));
        }
        for name in scope.iter().flat_map(|scope| &scope.names).map(|at| &declares.names[*at]) {
            if !matches!(name.what, What::Module) {
                found.insert(Found::Item { module: module.into(), name: name.name.clone(), rest: Vec::new() });
            }
        }
        if !seen.insert((module.into(), name.into())) {
            return found;
        }
        let leaves = |local: bool| {
            let named = scope.iter().flat_map(|scope| &scope.imports).map(|at| &declares.imports[*at]);
            named.filter(move |import| import.local == local)
        };
        for leaf in leaves(false) {
            found.extend(self.imported(module, leaf, seen));
        }
        if found.is_empty() {
            for glob in declares.imports.iter().filter(|import| import.name.is_none() && (inside || !import.local)) {
                let path: Vec<String> = glob.path.iter().cloned().chain([name.to_owned()]).collect();
                found.extend(self.resolve(module, &path, seen));
            }
        }
        if found.is_empty() && inside {
            for leaf in leaves(true) {
                found.extend(self.imported(module, leaf, seen));
            }
        }
        seen.remove(&(module.into(), name.into()));
        found
    }

    /// What a leaf of a `use` in `module` leads to.
    fn imported(&self, module: &str, leaf: &Import, seen: &mut HashSet<(String, String)>) -> BTreeSet<Found> {
        let found = self.resolve(module, &leaf.path, seen);
        if found.is_empty() { BTreeSet::from([Found::Outside]) } else { found }
    }
}

fn scope(module: &Module) -> HashMap<String, Scope> {
    let mut scope: HashMap<String, Scope> = HashMap::new();
    for (at, name) in module.names.iter().enumerate() {
        scope.entry(name.name.clone()).or_default().names.push(at);
    }
    for (at, import) in module.imports.iter().enumerate() {
        if let Some(name) = &import.name {
            scope.entry(name.clone()).or_default().imports.push(at);
        }
    }
    scope
}
