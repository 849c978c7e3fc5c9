//! What stands at the head of programs that robots execute: evidence in the caller's words, and what no program goes
//! without.

/// What is told in every program once.
pub const NOTICE: &str = "This is a test program: it is stressful by design, and no safety certificate.";

/// The lines of `header` and the notice as comments that begin with `mark`, in ASCII.
pub(crate) fn comments<'a>(mark: &'a str, header: &'a [String]) -> impl Iterator<Item = String> + 'a {
    let lines = header.iter().map(String::as_str).chain([NOTICE]);
    lines.map(move |line| format!("{mark} {}", plain(line)).trim_end().to_owned())
}

/// The text in ASCII on one line: arrows and dashes by their looks, anything else that is not ASCII as `?`.
pub(crate) fn plain(text: &str) -> String {
    let mut plain = String::new();
    for c in text.chars() {
        match c {
            ' '..='~' => plain.push(c),
            '→' => plain.push_str("->"),
            '–' | '—' | '−' => plain.push('-'),
            '°' => plain.push_str(" deg"),
            '·' | '×' => plain.push('x'),
            '\t' | '\r' | '\n' => plain.push(' '),
            _ => plain.push('?'),
        }
    }
    plain
}
