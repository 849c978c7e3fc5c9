//! Arms by name or path, as files of hairpin's own or as URDF, with their mistakes told as those of scenarios.

use hairpin::campaign::Mistake;
use hairpin::robot::arm::{Arm, ArmDescription};

use super::report::Report;
use super::robot::robot_for;
use crate::library;

/// The arm that `name_or_path` means: a shipped robot's name, a robot file, or a URDF file (`.urdf`, `.xml`).
///
/// # Errors
/// Nothing of that name, no TOML or URDF, another kind of robot, wrong keys and types, values out of bounds.
pub fn arm_for(name_or_path: &str) -> Result<Arm, Report> {
    arm_with(name_or_path, &[])
}

/// The same with other values of its keys: `robot.KEY` and the value as typed, of a URDF also those that say how it is
/// read (`robot.tip`, `robot.packages`, …).
///
/// # Errors
/// As [`arm_for`].
pub fn arm_with(name_or_path: &str, sets: &[(String, String)]) -> Result<Arm, Report> {
    robot_for(name_or_path, &["arm"], sets, library::arms(), |description: &ArmDescription| {
        description.build().map_err(|error| Mistake { key: error.field, value: error.value, bound: error.bound })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name_or_path: &str) -> String {
        arm_for(name_or_path).unwrap_err().render(false)
    }

    #[test]
    fn shipped_arms_are_found_and_mistakes_told() {
        for name in ["irb120", "irb1200", "irb4600"] {
            let arm = arm_for(name).unwrap();
            assert_eq!(arm.name, name);
            assert_eq!(arm.estimated, ["capsules", "joints.acceleration_deg_s2"]);
            assert!(arm.caveat.contains("stand-in"));
        }
        assert!(told("irb12").contains("did you mean `irb120`?"), "{}", told("irb12"));
        assert!(told("anafi").contains("no arm"));
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("own.toml");
        let file = path.to_str().unwrap();
        let own = library::arms().next().unwrap().text;
        std::fs::write(&path, own.replace("c2_mm = 270", "c2_mm = -270")).unwrap();
        let line = own.lines().position(|line| line.starts_with("c2_mm")).unwrap() + 1;
        assert!(told(file).contains("-270") && told(file).contains(&format!("own.toml:{line}")), "{}", told(file));
        std::fs::write(&path, own.replace("a2_mm", "a2_m")).unwrap();
        assert!(told(file).contains("a2_mm"), "{}", told(file));
        let broken = folder.path().join("own.urdf");
        std::fs::write(&broken, "<robot name=\"r\"><joint></robot>").unwrap();
        assert!(told(broken.to_str().unwrap()).contains("own.urdf"), "{}", told(broken.to_str().unwrap()));
    }
}
