//! Where it is asked of which kind a robot is: `match`, `let`, `matches!`, `==` on an enum of the kinds, and calls that
//! answer for one kind. Outside the kinds' own rooms there is one place for that.

use std::collections::BTreeMap;

use super::house::{File, Found, House};
use super::outline::{Mention, What};
use super::patterns::patterns;

/// What the kinds, and the commands of each, are called where an enum has a variant for each.
const KINDS: &[&[&str]] =
    &[&["Flight", "Flyer", "Profile"], &["Drive", "Driver", "Ground"], &["Arm", "Program"], &["Boat"]];

/// Sums of data: the module that declares one of them takes it apart for all others.
const DATA: &[&str] = &["hairpin::campaign::case::Witness"];

/// The sum of all kinds' keys. A macro declares it, which no reader of declarations sees.
const KEYS: &str = "Scenario";

/// What hands a macro the table of the kinds, of which a `match` may be made, and the room of the table.
const TABLE: (&str, &str) = ("kinds_of_robots!", "hairpin::campaign::scenario::kinds");

/// What the kinds answer: asking one for its own is asking which it is.
const CALLS: &[&str] = &[".flight", ".drive", ".arm", ".boat"];

/// What asks for the setup or the keys of one kind by their type: for verbs that are about that kind alone.
const OWN: &[&str] = &["own", "own_mut"];

/// Where each kind may know itself.
pub(crate) const ROOMS: &[&str] = &[
    "hairpin::campaign::flight",
    "hairpin::campaign::drive",
    "hairpin::campaign::arm",
    "hairpin::campaign::boat",
    "hairpin::campaign::kind",
    "hairpin::campaign::scenario::flight",
    "hairpin::campaign::scenario::drive",
    "hairpin::campaign::scenario::arm",
];

/// A place that tells kinds apart.
pub(crate) struct Place {
    pub(crate) path: String,
    pub(crate) line: usize,
    /// `match`, `let`, `matches`, `==`, or the method that is called.
    pub(crate) by: String,
    /// Lines of code that name a kind there.
    pub(crate) lines: usize,
}

/// Every such place outside the kinds' own rooms, in order.
pub(crate) fn places(house: &House) -> Vec<Place> {
    house.files.iter().filter(elsewhere).flat_map(|file| of_file(house, file)).collect()
}

fn of_file(house: &House, file: &File) -> Vec<Place> {
    let (text, asked) = (&file.outline.text, patterns(&file.outline.text));
    // By the token that asks: how, and on which lines a kind is named.
    let mut found: BTreeMap<usize, (String, Vec<usize>)> = BTreeMap::new();
    let mut ask = |at: usize, by: &str, line: usize| found.entry(at).or_insert((by.into(), Vec::new())).1.push(line);
    for mention in file.outline.mentions.iter().filter(|mention| !mention.in_test) {
        let end = mention.at + 2 * mention.path.len() - 1;
        if let Some(call) = mention.path.first().filter(|name| CALLS.contains(&name.as_str())) {
            if text.closing[mention.at + 1] == mention.at + 2 {
                ask(mention.at, call, mention.line);
            }
        } else if mention.path == [TABLE.0] && file.module != TABLE.1 {
            ask(mention.at, TABLE.0, mention.line);
        } else if names_a_kind(house, file, mention) {
            let equals = |at: usize| text.is(at, '=') && (text.is(at - 1, '=') || text.is(at - 1, '!'));
            match asked[mention.at] {
                Some(at) => ask(at, text.word(at).unwrap_or_default(), mention.line),
                None if (mention.at > 1 && equals(mention.at - 1)) || equals(end + 1) => {
                    ask(mention.at, "==", mention.line)
                }
                None => {}
            }
        }
    }
    let place = |(at, (by, mut lines)): (usize, (String, Vec<usize>))| {
        lines.dedup();
        Place { path: file.path.clone(), line: text.lines[at], by, lines: lines.len() }
    };
    found.into_iter().map(place).collect()
}

/// Every place outside the kinds' own rooms that asks a setup or a scenario for what one kind alone has, by its type:
/// `own::<ArmSetup>()`.
pub(crate) fn asked_by_type(house: &House) -> Vec<String> {
    let of_file = |file: &&File| {
        let text = &file.outline.text;
        let asks = |mention: &&Mention| {
            let at = mention.at;
            at > 3
                && !mention.in_test
                && text.is(at - 1, '<')
                && text.word(at - 3).is_some_and(|word| OWN.contains(&word))
                && text.is(at - 4, '.')
        };
        let told = |mention: &Mention| format!("{}:{} {}", file.path, mention.line, mention.path.join("::"));
        file.outline.mentions.iter().filter(asks).map(told).collect::<Vec<_>>()
    };
    house.files.iter().filter(elsewhere).collect::<Vec<_>>().iter().flat_map(of_file).collect()
}

/// Whether a file is of the product, and none of the kinds' own.
fn elsewhere(file: &&File) -> bool {
    let within = |room: &&str| file.module == **room || file.module.starts_with(&format!("{room}::"));
    !file.in_test && !ROOMS.iter().any(within)
}

/// Whether `mention` is a variant of an enum that has one for each of at least two kinds.
fn names_a_kind(house: &House, file: &File, mention: &Mention) -> bool {
    let of_kinds = |variants: &[(String, usize)]| {
        KINDS.iter().filter(|words| variants.iter().any(|(variant, _)| words.contains(&variant.as_str()))).count() > 1
    };
    if mention.path.windows(2).any(|pair| pair[0] == KEYS && KINDS.iter().any(|words| words.contains(&&*pair[1]))) {
        return true;
    }
    house.mentioned(file, mention).into_iter().any(|found| {
        let Found::Item { module, name, rest } = found else { return false };
        let Some(What::Enum(variants)) = house.declared(&module, &name).map(|declared| &declared.what) else {
            return false;
        };
        let own = module == file.module && DATA.contains(&format!("{module}::{name}").as_str());
        !own && of_kinds(variants)
            && rest.first().is_some_and(|named| variants.iter().any(|(variant, _)| variant == named))
    })
}

#[test]
fn asking_what_a_robot_is_is_counted() {
    let kind = "pub enum Kind<'a> { Flight(&'a F), Drive { x: f64 }, Arm } impl Kind<'_> { fn of(&self) {} }";
    let found = |module: &str, text: &str| {
        let house = super::forged::house(&[("hairpin::campaign::setup", kind), (module, text)]);
        places(&house).into_iter().map(|place| (place.by, place.lines)).collect::<Vec<_>>()
    };
    let one = |by: &str, lines: usize| vec![(by.to_owned(), lines)];
    let import = "use hairpin::campaign::setup::Kind;";
    for (text, expected) in [
        (
            "fn f(k: Kind) { match k {\nKind::Flight(_) => 1,\n\
             Kind::Drive { .. } if x > 2 => {}\n_ => g(|a, b| a), } }",
            one("match", 2),
        ),
        ("fn f(k: Kind) { if let Kind::Arm = k {} }", one("let", 1)),
        ("fn f(k: Kind) { while let Some(Kind::Arm) = k {} }", one("let", 1)),
        ("fn f(k: Kind) { let Kind::Flight(x) = k else { return }; }", one("let", 1)),
        ("fn f(k: Kind) -> bool { matches!(k.of(1, 2), Kind::Flight(..) | Kind::Arm) }", one("matches", 1)),
        ("fn f(k: Kind) -> bool { k == Kind::Arm }", one("==", 1)),
        ("fn f(k: Kind) -> bool { Kind::Arm != k }", one("==", 1)),
        ("use hairpin::campaign::setup::Kind as K; fn f(k: K) { match k { K::Arm => 1, _ => 2 } }", one("match", 1)),
        ("fn f(k: Kind) { use Kind::Arm; match k { Arm => 1, _ => 2 } }", one("match", 1)),
        ("fn f(s: &S) { assert!(s.arm().is_some()) }", one(".arm", 1)),
        ("kinds_of_robots!(built);", one("kinds_of_robots!", 1)),
        ("fn f(s: Scenario) { match s { Scenario::Flight(keys) => 1, _ => 2 } }", one("match", 1)),
        (
            "enum Solver { Flight(F), Drive(D) } impl Solver { fn f(self) { \
             match self { Self::Flight(f) => 1, Self::Drive(d) => 2 } } }",
            one("match", 1),
        ),
    ] {
        for module in ["hairpin_formats::header", "hairpin_cli::folder", "hairpin_jobs::judge"] {
            assert_eq!(found(module, &format!("{import} {text}")), expected, "{module}: {text}");
        }
        let text = format!("{import} {text}").replace("hairpin::", "crate::");
        assert_eq!(found("hairpin::campaign::judge", &text), expected, "{text}");
    }
    for text in [
        "fn f() -> Kind { Kind::Arm }",
        "fn f(k: Kind) { match k { k => g(Kind::Arm), } }",
        "fn f(k: Kind) { let k = Kind::Flight(&x); }",
        "enum Shape { Arm, Leg } fn f(s: Shape) { match s { Shape::Arm => 1, Shape::Leg => 2 } }",
        "fn f(s: &S) { s.arm(2); s.arm; s.drive_to() }",
        "#[cfg(test)] mod tests { use super::Kind; fn f(k: Kind) { assert!(matches!(k, Kind::Arm)) } }",
    ] {
        assert_eq!(found("hairpin_formats::header", &format!("{import} {text}")), Vec::new(), "{text}");
    }
    let witness =
        "pub enum Witness { Profile(P), Drive(D), Program(Q) } fn f(w: W) { if let Witness::Drive(d) = w {} }";
    let elsewhere = "use super::case::Witness; fn f(w: W) { if let Some(Witness::Program(p)) = w {} }";
    let house = super::forged::house(&[("hairpin::campaign::case", witness), ("hairpin::campaign::verify", elsewhere)]);
    assert_eq!(
        places(&house).iter().map(|place| place.path.as_str()).collect::<Vec<_>>(),
        ["hairpin::campaign::verify"]
    );
    let own = "use crate::campaign::setup::Kind; fn f(k: Kind) { match k { Kind::Arm => 1, _ => 2 } }";
    assert_eq!(found("hairpin::campaign::arm::solve", own), Vec::new(), "a kind knows itself");
    assert_eq!(found("hairpin::campaign::army", own), one("match", 1));
}

#[test]
fn asking_by_type_is_counted() {
    let found = |module: &str, text: &str| asked_by_type(&super::forged::house(&[(module, text)])).len();
    let text = "fn f(s: &Setup) { s.own::<ArmSetup>(); s.own_mut::<a::B>(); s.owner::<C>(); own::<D>(); }";
    assert_eq!(found("hairpin_jobs::verify", text), 2);
    assert_eq!(found("hairpin_jobs::verify", &format!("#[cfg(test)] mod tests {{ {text} }}")), 0);
    assert_eq!(found("hairpin::campaign::arm::solve", text), 0, "a kind knows itself");
}
