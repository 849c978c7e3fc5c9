//! Lines of KRL, taken apart.

/// What a move goes to, and how it flies by: `C_DIS` and its kin stand last.
pub(super) fn flight(rest: &str) -> (&str, Option<&str>) {
    let last = |text: &str| text.trim_end().rfind(|c: char| c.is_whitespace() || c == '}').map_or(0, |at| at + 1);
    let mut end = rest.len();
    loop {
        let from = last(&rest[..end]);
        let flies = rest[from..end].get(..2).is_some_and(|begin| begin.eq_ignore_ascii_case("C_"));
        if !flies || from == 0 {
            break;
        }
        end = rest[..from].trim_end().len();
    }
    let how = rest[end..].trim();
    (rest[..end].trim(), (!how.is_empty()).then_some(how))
}

/// Positions between commas that are in no braces.
pub(super) fn split(targets: &str) -> Vec<&str> {
    let (mut parts, mut depth, mut from) = (Vec::new(), 0_usize, 0);
    for (at, c) in targets.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth = depth.saturating_sub(1),
            ',' if depth == 0 => {
                parts.push(targets[from..at].trim());
                from = at + 1;
            }
            _ => {}
        }
    }
    parts.push(targets[from..].trim());
    parts
}

/// The line without its comment and blanks; a `;` between quotes begins none.
pub(super) fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    let end = line.char_indices().find(|(_, c)| {
        quoted ^= *c == '"';
        *c == ';' && !quoted
    });
    let line = line[..end.map_or(line.len(), |(at, _)| at)].trim();
    if line.starts_with('&') { "" } else { line }
}

pub(super) fn first_word(statement: &str) -> &str {
    let end = statement.find(|c: char| !(c.is_alphanumeric() || "_$.".contains(c)));
    &statement[..end.unwrap_or(statement.len())]
}

/// Kinds of positions.
pub(super) const POSITIONS: [&str; 6] = ["E6POS", "POS", "FRAME", "E6AXIS", "AXIS", "E3POS"];

/// `DEF name ( )`: its name.
pub(super) fn name_of(statement: &str) -> Option<String> {
    let mut words = statement.split(|c: char| c.is_whitespace() || c == '(').filter(|word| !word.is_empty());
    let first = words.next()?;
    let first = if first.eq_ignore_ascii_case("GLOBAL") { words.next()? } else { first };
    if !first.eq_ignore_ascii_case("DEF") {
        return None;
    }
    words.next().filter(|name| name.starts_with(char::is_alphabetic)).map(Into::into)
}
