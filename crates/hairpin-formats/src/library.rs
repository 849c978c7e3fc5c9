//! The shipped robots, worlds, scenarios and sheets of experiments, embedded in the binary and found by name; beside
//! them the robots that a binary of another crate brings along.

use std::path::Path;
use std::sync::OnceLock;

/// Robots of the binary's own. Whatever the process reads knows them, as it does those that are shipped.
static BROUGHT: OnceLock<Vec<Shipped>> = OnceLock::new();

/// A shipped file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Shipped {
    /// Name without folder and ending: `anafi`.
    pub name: &'static str,
    /// Path below `data`: `robots/quadrotor/anafi.toml`; of a sheet below the root.
    pub path: &'static str,
    /// What it says.
    pub text: &'static str,
}

/// (kind, name, path below `data`, text), sorted by path within each kind.
const FILES: &[(&str, &str, &str, &str)] = include!(concat!(env!("OUT_DIR"), "/shipped.rs"));

/// Has the robots of `files`, name and text, beside those that are shipped, from now on. Of two calls in one process
/// the first one's count. What a text says of its robot is read, and wrong where it is, when the robot is asked for.
///
/// # Errors
/// A name that is shipped or comes twice, or is none; a text that is no TOML or without a `kind` that is known.
pub fn bring(files: &[(&'static str, &'static str)]) -> Result<(), String> {
    let mut brought: Vec<Shipped> = Vec::new();
    for &(name, text) in files {
        let mut taken = of_kind("robots").chain(of_kind("scenarios")).chain(brought.iter().copied());
        if name.is_empty() || taken.any(|known| known.name == name) {
            return Err(format!("robot `{name}`: must have a name of its own, which nothing shipped has"));
        }
        let Some(folder) = kind_of(text).and_then(|kind| folder_of(&kind)) else {
            return Err(format!("robot `{name}`: must be the text of a robot's file, with a `kind` that is known"));
        };
        brought.push(Shipped { name, path: Box::leak(format!("{folder}/{name}.toml").into_boxed_str()), text });
    }
    // It fails only where robots were brought before: those stay.
    let _ = BROUGHT.set(brought);
    Ok(())
}

/// The names of robots that were brought along.
pub fn brought() -> impl Iterator<Item = &'static str> {
    BROUGHT.get().into_iter().flatten().map(|robot| robot.name)
}

/// All shipped robots, sorted by path, and behind them those that were brought along.
pub fn robots() -> impl Iterator<Item = Shipped> {
    of_kind("robots").chain(BROUGHT.get().into_iter().flatten().copied())
}

/// What a robot's file says that its robot is.
pub(crate) fn kind_of(text: &str) -> Option<String> {
    let table = text.parse::<toml::Table>().ok()?;
    Some(table.get("kind")?.as_str()?.to_owned())
}

/// The folder that robots of a kind are shipped in.
fn folder_of(kind: &str) -> Option<&'static str> {
    let same = of_kind("robots").find(|robot| kind_of(robot.text).as_deref() == Some(kind))?;
    Path::new(same.path).parent()?.to_str()
}

/// The shipped quadrotors, sorted by path.
pub fn quadrotors() -> impl Iterator<Item = Shipped> {
    robots().filter(|robot| robot.path.starts_with("robots/quadrotor/"))
}

/// The shipped rovers, sorted by path.
pub fn rovers() -> impl Iterator<Item = Shipped> {
    robots().filter(|robot| robot.path.starts_with("robots/rover/"))
}

/// The shipped vehicles that `steer` drives, sorted by path.
pub fn ground() -> impl Iterator<Item = Shipped> {
    robots().filter(|robot| ["robots/ground/", "robots/rover/"].iter().any(|folder| robot.path.starts_with(folder)))
}

/// The shipped arms, sorted by path.
pub fn arms() -> impl Iterator<Item = Shipped> {
    robots().filter(|robot| robot.path.starts_with("robots/arm/"))
}

/// The shipped cars, sorted by path.
pub fn cars() -> impl Iterator<Item = Shipped> {
    on_the_ground("car")
}

/// The shipped differential drives, sorted by path.
pub fn differential_drives() -> impl Iterator<Item = Shipped> {
    on_the_ground("differential-drive")
}

/// Those of one folder, told apart by what their files say.
fn on_the_ground(kind: &'static str) -> impl Iterator<Item = Shipped> {
    let is = move |robot: &Shipped| kind_of(robot.text).as_deref() == Some(kind);
    robots().filter(|robot| robot.path.starts_with("robots/ground/")).filter(is)
}

/// All shipped worlds, sorted by path.
pub fn worlds() -> impl Iterator<Item = Shipped> {
    of_kind("worlds")
}

/// All shipped scenarios, sorted by path.
pub fn scenarios() -> impl Iterator<Item = Shipped> {
    of_kind("scenarios")
}

/// The sheets of all experiments, sorted by path.
pub fn experiments() -> impl Iterator<Item = Shipped> {
    of_kind("experiments")
}

fn of_kind(wanted: &'static str) -> impl Iterator<Item = Shipped> {
    let files = FILES.iter().filter(move |(kind, ..)| *kind == wanted);
    files.map(|&(_, name, path, text)| Shipped { name, path, text })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_within_a_kind() {
        for kind in [robots().collect::<Vec<_>>(), worlds().collect(), scenarios().collect()] {
            let mut names: Vec<_> = kind.iter().map(|file| file.name).collect();
            names.sort_unstable();
            names.dedup();
            assert_eq!(names.len(), kind.len(), "{names:?}");
        }
        assert!(worlds().any(|world| world.name == "winding-corridor" && world.text.contains("size_m")));
    }

    #[test]
    fn robots_that_are_brought_have_names_and_kinds_of_their_own() {
        let fine = quadrotors().next().unwrap().text;
        for (name, text, told) in [
            ("anafi", fine, "of its own"),
            ("boat", fine, "of its own"),
            ("", fine, "of its own"),
            ("own", "kind = \"submarine\"", "`kind`"),
            ("own", "kind = ", "`kind`"),
        ] {
            let refused = bring(&[(name, text)]).unwrap_err();
            assert!(refused.contains(told), "{name}: {refused}");
        }
        assert!(bring(&[("own", fine), ("own", fine)]).unwrap_err().contains("of its own"));
        assert_eq!(folder_of("car"), Some("robots/ground"));
    }
}
