//! Files whose names say that they are no recordings: what was planned, or what autopilots are told.

use super::super::log::Source;

/// Words between a name's dots that say so, of our own exports and of others' copies of them.
const PLANNED: [&str; 4] = ["planned", "plan", "setpoints", "poly4d"];

/// Whether a file is called after what was planned: `0000.planned.csv`, `monday.plan.csv`, and `0000.ref.tum` of our
/// own exports. Others call the truth that they measured a reference.
pub fn is_planned(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let parts: Vec<&str> = name.split('.').collect();
    let [case, between @ .., _] = &parts[..] else { return false };
    let is_case = case.len() >= 4 && case.bytes().all(|byte| byte.is_ascii_digit());
    between.iter().any(|word| PLANNED.contains(word)) || (is_case && name.ends_with(".ref.tum"))
}

/// Who says where it was, by the file's name.
pub(super) fn source(name: &str) -> Source {
    if is_planned(name) { Source::Asked } else { Source::Untold }
}

#[cfg(test)]
mod tests {
    use super::is_planned;

    #[test]
    fn plans_are_told_by_their_names() {
        for name in ["0000.planned.csv", "12345.ref.tum", "0000.Planned.CSV", "0000.setpoints.csv", "m.plan.tum"] {
            assert!(is_planned(name), "{name}");
        }
        for name in ["0000-0.csv", "0000.exec.tum", "mocap.ref.tum", "planned.csv", "plan.tum", "a.csv", "0000", ""] {
            assert!(!is_planned(name), "{name}");
        }
    }
}
