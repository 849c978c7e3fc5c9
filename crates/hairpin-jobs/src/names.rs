//! Some of many names, for a line.

/// Names that a line has room for.
const LISTED: usize = 8;
/// Names that a sentence has room for.
const MOST: usize = 12;

/// `0003, 0007 and 12 more`: as many of `names` as a line has room for.
pub fn listed(names: &[String]) -> String {
    let more = names.len().saturating_sub(LISTED);
    let first = names[..names.len() - more].join(", ");
    if more == 0 { first } else { format!("{first} and {more} more") }
}

/// `the cases 0001, 0003, … 0999`, of things called `what`: of many the first ones and the last.
pub(crate) fn named(names: &[String], what: &str) -> String {
    match names {
        [] => format!("no {what}s"),
        [one] => format!("the {what} {one} alone"),
        [some @ .., last] if names.len() > MOST => format!("the {what}s {}, … {last}", some[..MOST - 1].join(", ")),
        all => format!("the {what}s {}", all.join(", ")),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn many_names_are_counted() {
        let names: Vec<String> = (0..10).map(|n| n.to_string()).collect();
        assert_eq!(listed(&names[..8]), "0, 1, 2, 3, 4, 5, 6, 7");
        assert_eq!(listed(&names), "0, 1, 2, 3, 4, 5, 6, 7 and 2 more");
    }
}
