//! Files of ground vehicles by name or path, with their mistakes told as those of scenarios.

use hairpin::campaign::Mistake;
use hairpin::campaign::scenario::GroundDescription;
use hairpin::robot::rover::Rover;

use super::report::Report;
use super::robot::robot_for;
use crate::library;

/// The ground vehicle that `name_or_path` means, a rover, a car or a differential drive: a robot file, or a shipped
/// robot's name.
///
/// # Errors
/// Nothing of that name, no TOML, another kind of robot, wrong keys and types, values out of bounds.
pub fn rover_for(name_or_path: &str) -> Result<Rover, Report> {
    robot_for(name_or_path, GroundDescription::KINDS, &[], library::ground(), |description: &GroundDescription| {
        description.build().map_err(|error| Mistake { key: error.field, value: error.value, bound: error.bound })
    })
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
        assert!(told("anafi").contains("no rover, car or differential-drive"), "{}", told("anafi"));
        let (car, drive) = (rover_for("car").unwrap(), rover_for("differential-drive").unwrap());
        assert!(!car.limits.turns_in_place && drive.limits.turns_in_place && car.limits.curvature > 1.0);
        for name in ["rocky7", "rocky8", "open-source-rover", "sojourner-like", "four-wheel"] {
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
