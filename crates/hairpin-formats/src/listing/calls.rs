//! Calls within a line, in languages that are read line by line.

/// The names before brackets, from left to right; what stands between quotes calls nothing.
pub(crate) fn calls(text: &str) -> Vec<&str> {
    let mut names = Vec::new();
    for (part, between) in text.split('"').zip([false, true].into_iter().cycle()) {
        if between {
            continue;
        }
        for (at, _) in part.match_indices('(') {
            let before = part[..at].trim_end();
            let name = before.trim_end_matches(|c: char| c.is_alphanumeric() || "_$.".contains(c));
            let name = &before[name.len()..];
            // Behind a number and behind a sign brackets only hold together.
            if name.starts_with(|c: char| c.is_alphabetic() || "_$".contains(c)) {
                names.push(name);
            }
        }
    }
    names
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_stand_before_brackets() {
        let all: [(&str, &[&str]); 7] = [
            ("", &[]),
            ("sleep(movel(p[9, 0, 0.4, 0, 3.1, 0]))", &["sleep", "movel"]),
            ("textmsg(\"movel(p) \", to_str (2 * (a + b)))", &["textmsg", "to_str"]),
            ("WAIT FOR NOT ($IN[1]) AND (far(2))", &["NOT", "AND", "far"]),
            ("a(\"b(", &["a"]),
            ("(((", &[]),
            ("2 (x) ä(", &["ä"]),
        ];
        for (text, names) in all {
            assert_eq!(calls(text), names, "{text}");
        }
    }
}
