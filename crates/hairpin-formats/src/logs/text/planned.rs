//! Files whose names say that they are no recordings: what was planned, or what autopilots are told.

use super::super::log::Source;

/// Words between a name's dots that say so, of our own exports and of others' copies of them (`0000.planned (1).csv`).
const PLANNED: [&str; 4] = ["planned", "plan", "setpoints", "poly4d"];

/// Whether a file is called after what was planned: `0000.planned.csv`, `monday.plan.csv`, and `0000.ref.tum` of our
/// own exports. Others call the truth that they measured a reference.
pub fn is_planned(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    let parts: Vec<&str> = name.split('.').collect();
    let [case, between @ .., _] = &parts[..] else { return false };
    let is_number = |word: &str| word.len() >= 4 && word.bytes().all(|byte| byte.is_ascii_digit());
    let first = |part: &str| part.split(' ').next().is_some_and(|word| PLANNED.contains(&word));
    // `0000_planned.csv`: of a case's number and a word alone.
    let renamed = case.split_once(['_', '-', ' ']).is_some_and(|(case, word)| is_number(case) && first(word));
    between.iter().any(|part| first(part)) || renamed || (is_number(case) && name.ends_with(".ref.tum"))
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
        for name in [
            "0000.planned.csv",
            "12345.ref.tum",
            "0000.Planned.CSV",
            "0000.setpoints.csv",
            "m.plan.tum",
            "0000.planned (1).csv",
            "0000_planned.csv",
            "0000-plan (2).csv",
        ] {
            assert!(is_planned(name), "{name}");
        }
        for name in ["0000-0.csv", "0000.exec.tum", "mocap.ref.tum", "planned.csv", "plan.tum", "a.csv", "0000", ""] {
            assert!(!is_planned(name), "{name}");
        }
    }
}
