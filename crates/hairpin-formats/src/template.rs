//! What `hairpin new KIND` writes: the shipped scenario of that name, a commented file that runs as it is; of a robot
//! that a binary brings along that of its kind, with it in it.

use crate::library;

/// The kinds there is a commented file for.
pub const KINDS: &[&str] = &["quadrotor", "arm", "rover", "car", "differential-drive", "boat"];

/// All that there is a commented file for: kinds, and robots that were brought along.
pub fn names() -> Vec<&'static str> {
    KINDS.iter().copied().chain(library::brought()).collect()
}

/// The text of `KIND.toml`; `None` for a kind that is none of [`KINDS`].
pub fn template(kind: &str) -> Option<&'static str> {
    let kind = KINDS.iter().find(|known| **known == kind)?;
    library::scenarios().find(|shipped| shipped.name == *kind).map(|shipped| shipped.text)
}

/// The text of `NAME.toml` for a robot that is known by name; `None` where none is.
pub fn of_robot(name: &str) -> Option<String> {
    let robot = library::robots().find(|robot| robot.name == name)?;
    let text = template(&library::kind_of(robot.text)?)?;
    let line = text.lines().find(|line| line.starts_with("robot = \""))?;
    let (_, after) = line.strip_prefix("robot = \"")?.split_once('"')?;
    Some(text.replacen(line, &format!("robot = \"{name}\"{after}"), 1))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_robots_file_is_that_of_its_kind_with_it_in_it() {
        let (own, kind) = (of_robot("flightgoggles").unwrap(), template("quadrotor").unwrap());
        let other = |(a, b): &(&str, &str)| a != b;
        let lines: Vec<_> = own.lines().zip(kind.lines()).filter(other).collect();
        assert!(lines.len() == 1 && lines[0].0.starts_with("robot = \"flightgoggles\""), "{lines:?}");
        assert_eq!(of_robot("quadrotor"), None);
    }
}
