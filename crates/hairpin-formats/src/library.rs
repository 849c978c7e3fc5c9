//! The shipped robots, worlds, scenarios and sheets of experiments, embedded in the binary and found by name.

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

/// All shipped robots, sorted by path.
pub fn robots() -> impl Iterator<Item = Shipped> {
    of_kind("robots")
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
    let is = move |robot: &Shipped| {
        let table = robot.text.parse::<toml::Table>().ok();
        table.is_some_and(|table| table.get("kind").and_then(toml::Value::as_str) == Some(kind))
    };
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
}
