//! Every path of a file that the rules look at: as it was written, and where it is defined.

use super::house::{File, Found, House};

/// A path, absolute, or a method that is called.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) struct Seen {
    /// Line, from 1.
    pub(crate) line: usize,
    /// `hairpin::world::World`, `std::fs`, `println!`, `.sin`.
    pub(crate) path: String,
    /// Whether it stands in code that only tests compile.
    pub(crate) in_test: bool,
}

pub(crate) fn seen(house: &House, file: &File) -> Vec<Seen> {
    let mut all = Vec::new();
    for mention in &file.outline.mentions {
        let (module, in_test) = (&file.outline.modules[mention.module].path, mention.in_test || file.in_test);
        let telling = mention.path.len() > 1 || mention.path[0].starts_with('.') || mention.path[0].ends_with('!');
        all.extend(telling.then(|| Seen { path: written(module, &mention.path), line: mention.line, in_test }));
        let defined = house.mentioned(file, mention).iter().filter_map(whole).collect::<Vec<_>>();
        all.extend(defined.into_iter().map(|path| Seen { path, line: mention.line, in_test }));
    }
    for module in &file.outline.modules {
        for import in &module.imports {
            let in_test = import.in_test || file.in_test;
            let defined = house.follow(&module.path, &import.path);
            let paths = defined.iter().filter_map(whole).chain([written(&module.path, &import.path)]);
            all.extend(paths.map(|path| Seen { path, line: import.line, in_test }));
        }
    }
    all.sort();
    all.dedup();
    all
}

/// Where something is defined, with what of it was meant.
fn whole(found: &Found) -> Option<String> {
    match found {
        Found::Item { module, name, rest } => {
            Some([module.clone(), name.clone()].iter().chain(rest).cloned().collect::<Vec<_>>().join("::"))
        }
        other => other.path(),
    }
}

/// `path` with `crate`, `self` and `super` resolved, as `module` says it.
fn written(module: &str, path: &[String]) -> String {
    let mut at: Vec<&str> = match path[0].as_str() {
        "crate" => module.split("::").take(1).collect(),
        "self" | "super" => module.split("::").collect(),
        _ => Vec::new(),
    };
    for part in path {
        match part.as_str() {
            "crate" | "self" => {}
            "super" => drop(at.pop()),
            _ => at.push(part),
        }
    }
    at.join("::")
}
