//! Who knows which name: what is LOCAL its own module alone, all else every module of the program.

use std::collections::BTreeMap;

use crate::rapid::syntax::Home;

/// Things by their names, in lower case.
#[derive(Clone)]
pub(super) struct Scope<T> {
    shared: BTreeMap<String, T>,
    /// Of each module.
    local: Vec<BTreeMap<String, T>>,
}

impl<T> Scope<T> {
    /// Of so many modules, without names.
    pub(super) fn new(modules: usize) -> Self {
        Self { shared: BTreeMap::new(), local: (0..modules).map(|_| BTreeMap::new()).collect() }
    }

    fn names(&mut self, home: Home) -> &mut BTreeMap<String, T> {
        match self.local.get_mut(home.module) {
            Some(local) if home.local => local,
            _ => &mut self.shared,
        }
    }

    /// Puts a thing under the name; what was there before gives way.
    pub(super) fn insert(&mut self, home: Home, name: String, thing: T) {
        self.names(home).insert(name, thing);
    }

    /// Whether both have the same things, names by names as `agree` says of what is shared and of what each module has.
    pub(super) fn agrees(
        &self,
        other: &Self,
        agree: impl Fn(&BTreeMap<String, T>, &BTreeMap<String, T>) -> bool,
    ) -> bool {
        let local = self.local.iter().zip(&other.local);
        agree(&self.shared, &other.shared) && local.into_iter().all(|(one, other)| agree(one, other))
    }

    /// What the name means anywhere.
    pub(super) fn all(&self, name: &str) -> impl Iterator<Item = &T> {
        std::iter::once(&self.shared).chain(&self.local).filter_map(move |names| names.get(name))
    }

    /// What the name means in a module.
    pub(super) fn get(&self, module: usize, name: &str) -> Option<&T> {
        self.local.get(module).and_then(|local| local.get(name)).or_else(|| self.shared.get(name))
    }

    /// The same, to be changed.
    pub(super) fn get_mut(&mut self, module: usize, name: &str) -> Option<&mut T> {
        let local = self.local.get_mut(module).and_then(|local| local.get_mut(name));
        local.or_else(|| self.shared.get_mut(name))
    }
}
