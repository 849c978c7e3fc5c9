//! Files and topics whose names say that they are no recordings: what was planned, or what autopilots are told.

use super::log::Source;

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

/// Words in names of topics that are no motions but what motions are to be.
const ASKED: &str = "carrot clicked cmd command commanded commands demand demanded des desired expected fake goal goals \
                     ideal initial lookahead nominal plan planned planner planning plans predicted prediction ref \
                     reference requested setpoint setpoints sp target targets tgt wanted waypoint waypoints wp wps";
/// What is written together with them: `goalpose`, `jointcmd`.
const BODIES: [&str; 8] = ["pose", "position", "odometry", "odom", "path", "states", "state", "joint"];

/// Whether the name of a topic says that it was asked for: `/firefly/command/pose`, `/goal_pose`, `/targetPose2`,
/// `/set_point`, and what PX4 is told (`/fmu/in/…`).
pub(super) fn is_asked(name: &str) -> bool {
    let words = words(name);
    let is = |word: &str| ASKED.split(' ').any(|asked| asked == word);
    let is_beside =
        |word: &str, body: &str| word.strip_suffix(body).is_some_and(is) || word.strip_prefix(body).is_some_and(is);
    words.iter().any(|word| is(word) || BODIES.iter().any(|body| is_beside(word, body)))
        || words.windows(2).any(|pair| pair[0] == "set" && pair[1].starts_with("point") || pair == ["fmu", "in"])
}

/// The words of a name, in small letters: between other signs, between letters and digits, and where a large letter
/// begins one (`goalPose`, `CMDPose`).
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let characters: Vec<char> = name.chars().collect();
    for (i, c) in characters.iter().enumerate() {
        let before = i.checked_sub(1).map_or('/', |before| characters[before]);
        let then_small = characters.get(i + 1).is_some_and(|next| next.is_lowercase());
        let begins = c.is_numeric() != before.is_numeric()
            || c.is_uppercase() && (before.is_lowercase() || before.is_uppercase() && then_small);
        if begins || !c.is_alphanumeric() {
            words.push(String::new());
        }
        if let Some(word) = words.last_mut().filter(|_| c.is_alphanumeric()) {
            word.extend(c.to_lowercase());
        }
    }
    words
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
