//! What the tree still breaks. Each number may only shrink, and when less is left it must: so nothing new comes in, and
//! what is cut stays cut. All of them end at 0, the places that tell kinds apart at 1.

/// Paths that the floors of rooms and crates forbid.
pub(crate) const AGAINST_THE_FLOORS: usize = 0;
/// Exports of what another room or crate defines.
pub(crate) const EXPORTED_FROM_ELSEWHERE: usize = 0;
/// Imports, by file, that the floors of `campaign` forbid.
pub(crate) const AGAINST_CAMPAIGN: usize = 0;
/// Places outside the kinds' own rooms where it is asked what a robot is.
pub(crate) const TELLING_KINDS_APART: usize = 1;
/// Verbs that are about what one kind of robot alone has.
pub(crate) const ASKED_BY_TYPE: usize = 17;
/// Lines with a comment beyond column 120.
pub(crate) const LONG_COMMENTS: usize = 0;

/// Files in circles, by crate.
const IN_CIRCLES: &[(&str, usize)] = &[];

pub(crate) fn in_circles(member: &str) -> usize {
    IN_CIRCLES.iter().find(|(name, _)| *name == member).map_or(0, |(_, known)| *known)
}

/// Rooms that rules name before they are built.
pub(crate) const COMING_ROOMS: &[&str] = &[];

/// Prints what was `found` against `rule`, and holds it to the number that is `known`.
pub(crate) fn held(rule: &str, known: usize, found: &[String]) {
    println!("{rule}: {}\n{}", found.len(), found.join("\n"));
    assert!(
        found.len() <= known,
        "{rule}: {} where {known} are known; see the list above for the new ones",
        found.len()
    );
    assert!(
        found.len() == known,
        "{rule}: only {} are left of {known}: lower the number in layers/known.rs",
        found.len()
    );
}

#[test]
fn a_number_holds_exactly() {
    let found = ["one".to_owned(), "two".to_owned()];
    held("a rule", 2, &found);
    for wrong in [1, 3] {
        assert!(std::panic::catch_unwind(|| held("a rule", wrong, &found)).is_err(), "{wrong} held");
    }
}
