//! Arms by name or path, as files of hairpin's own or as URDF, with their mistakes told as those of scenarios.

use std::path::Path;

use hairpin::robot::arm::{Arm, ArmDescription};

use super::report::{Place, Report};
use super::resolve::{Resolver, read_file};
use super::tree::{Kind, Node};
use super::{place_of, shape};
use crate::library;
use crate::urdf::read_urdf;

/// The arm that `name_or_path` means: a shipped robot's name, a robot file, or a URDF file (`.urdf`, `.xml`).
///
/// # Errors
/// Nothing of that name, no TOML or URDF, another kind of robot, wrong keys and types, values out of bounds.
pub fn arm_for(name_or_path: &str) -> Result<Arm, Report> {
    let mut report = Report::default();
    match read(name_or_path, &mut report) {
        Some(arm) if report.is_empty() => Ok(arm),
        _ => Err(report),
    }
}

fn read(name_or_path: &str, report: &mut Report) -> Option<Arm> {
    let is_file = Path::new(name_or_path).is_file();
    if is_file && [".urdf", ".xml"].iter().any(|ending| name_or_path.to_ascii_lowercase().ends_with(ending)) {
        return from_urdf(name_or_path, report);
    }
    if !is_file && library::robots().all(|robot| robot.name != name_or_path) {
        let known: Vec<&str> = library::arms().map(|robot| robot.name).collect();
        let near = shape::nearest(name_or_path, known.iter().copied());
        let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let message =
            format!("`{name_or_path}` is no file and no shipped name: {hint}shipped arms are {}", known.join(", "));
        report.complain_of_file(name_or_path, &message);
        return None;
    }
    let source = report.add_source(name_or_path, "");
    let asked = Place { source, span: 0..0 };
    let root = Resolver { base: Path::new(""), report }.robot_file(name_or_path, &asked)?;
    if let Some(Node { kind: Kind::Text(kind), place, .. }) = root.get("kind")
        && kind != "arm"
    {
        report.complain(place, "kind", kind, "must be \"arm\"", format!("`kind` = \"{kind}\": this robot is no arm"));
        return None;
    }
    shape::check(&schemars::schema_for!(ArmDescription).to_value(), &root, "", report);
    if !report.is_empty() {
        return None;
    }
    let description: ArmDescription = match serde_json::from_value(root.to_value()) {
        Ok(description) => description,
        Err(error) => {
            report.complain(&root.place, "", "", "", format!("this is no arm: {error}"));
            return None;
        }
    };
    match description.build() {
        Ok(arm) => Some(arm),
        Err(error) => {
            let place = place_of(&root, &error.field);
            report.complain(&place, &error.field, &error.value, &format!("must be {}", error.bound), error.to_string());
            None
        }
    }
}

fn from_urdf(path: &str, report: &mut Report) -> Option<Arm> {
    let text = read_file(Path::new(path))
        .and_then(|bytes| String::from_utf8(bytes).map_err(|_| "it is no UTF-8 text".to_owned()));
    let built = text
        .and_then(|text| read_urdf(&text).map_err(|error| error.to_string()))
        .and_then(|description| description.build().map_err(|error| error.to_string()));
    built.map_err(|why| report.complain_of_file(path, &format!("`{path}`: {why}"))).ok()
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
