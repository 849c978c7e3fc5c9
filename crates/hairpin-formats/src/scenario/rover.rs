//! Rover files by name or path, with their mistakes told as those of scenarios.

use std::path::Path;

use hairpin::robot::rover::{Rover, RoverDescription};

use super::report::{Place, Report};
use super::resolve::Resolver;
use super::tree::{Kind, Node};
use super::{place_of, shape};
use crate::library;

/// The rover that `name_or_path` means: a shipped robot's name, or a robot file.
///
/// # Errors
/// Nothing of that name, no TOML, another kind of robot, wrong keys and types, values out of bounds.
pub fn rover_for(name_or_path: &str) -> Result<Rover, Report> {
    let mut report = Report::default();
    match read(name_or_path, &mut report) {
        Some(rover) if report.is_empty() => Ok(rover),
        _ => Err(report),
    }
}

fn read(name_or_path: &str, report: &mut Report) -> Option<Rover> {
    if !Path::new(name_or_path).is_file() && library::robots().all(|robot| robot.name != name_or_path) {
        let known: Vec<&str> = library::rovers().map(|robot| robot.name).collect();
        let near = shape::nearest(name_or_path, known.iter().copied());
        let hint = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let message =
            format!("`{name_or_path}` is no file and no shipped name: {hint}shipped rovers are {}", known.join(", "));
        report.complain_of_file(name_or_path, &message);
        return None;
    }
    let source = report.add_source(name_or_path, "");
    let asked = Place { source, span: 0..0 };
    let root = Resolver { base: Path::new(""), report }.robot_file(name_or_path, &asked)?;
    if let Some(Node { kind: Kind::Text(kind), place, .. }) = root.get("kind")
        && kind != "rover"
    {
        let message = format!("`kind` = \"{kind}\": this robot is no rover");
        report.complain(place, "kind", kind, "must be \"rover\"", message);
        return None;
    }
    shape::check(&schemars::schema_for!(RoverDescription).to_value(), &root, "", report);
    if !report.is_empty() {
        return None;
    }
    let description: RoverDescription = match serde_json::from_value(root.to_value()) {
        Ok(description) => description,
        Err(error) => {
            report.complain(&root.place, "", "", "", format!("this is no rover: {error}"));
            return None;
        }
    };
    match description.build() {
        Ok(rover) => Some(rover),
        Err(error) => {
            let place = place_of(&root, &error.field);
            report.complain(&place, &error.field, &error.value, &format!("must be {}", error.bound), error.to_string());
            None
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn told(name_or_path: &str) -> String {
        rover_for(name_or_path).unwrap_err().render(false)
    }

    #[test]
    fn shipped_rovers_are_found_and_mistakes_told() {
        let generic = rover_for("generic").unwrap();
        assert_eq!((generic.limits.curvature, generic.limits.curvature_rate, generic.default_speed), (1.0, 1.0, 1.0));
        assert!(told("genric").contains("did you mean `generic`?"), "{}", told("genric"));
        assert!(told("anafi").contains("no rover"));
        for name in ["rocky7", "rocky8", "open-source-rover", "four-wheel"] {
            assert_eq!(rover_for(name).unwrap().name, name);
        }
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("own.toml");
        let file = path.to_str().unwrap();
        let own = "kind = \"rover\"\nname = \"own\"\n[limits]\ncurvature_1_m = 0.5\n";
        std::fs::write(&path, own).unwrap();
        assert_eq!(rover_for(file).unwrap().limits.curvature, 0.5);
        std::fs::write(&path, own.replace("curvature_1_m", "curvatur_1_m")).unwrap();
        assert!(told(file).contains("curvature_1_m") && told(file).contains("own.toml:4"), "{}", told(file));
        for (suspension, said) in [
            ("[suspension]\nkind = \"four-wheels\"", "did you mean `four-wheel`"),
            ("[suspension]\nwheel_radius_m = 0.1", "`suspension.kind` is missing"),
            ("[suspension]\nkind = \"four-wheel\"\npivot_m = [0, 0, 0]", "unknown key `suspension.pivot_m`"),
        ] {
            std::fs::write(&path, format!("{own}{suspension}\n")).unwrap();
            assert!(told(file).contains(said), "{}", told(file));
        }
        std::fs::write(&path, own.replace("0.5", "-0.5")).unwrap();
        assert!(told(file).contains("-0.5"), "{}", told(file));
    }
}
