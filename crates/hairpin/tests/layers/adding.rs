//! What CONTRIBUTING.md says of how to add something: its table names files that exist, and counts the lines that name
//! an example of it outside of these files.

use std::collections::{BTreeMap, BTreeSet};

use super::house::{File, Found, House};
use super::outline::What;
use super::sources::project;

/// What stands for the example of a row, besides what the files of its own define.
struct Example {
    /// How the row begins.
    row: &'static str,
    /// Variants of enums, by the enum's path.
    variants: &'static [(&'static str, &'static str)],
    /// Strings.
    words: &'static [&'static str],
}

const EXAMPLES: &[Example] = &[
    Example {
        row: "a kind of robot",
        variants: &[("hairpin::campaign::scenario::kinds::Scenario", "Boat")],
        words: &["boat"],
    },
    Example {
        row: "a format",
        variants: &[("hairpin_cli::args::pipeline::Format", "Tum")],
        words: &["tum", "ref.tum", "exec.tum"],
    },
    Example { row: "a verb", variants: &[("hairpin_cli::args::Command", "Explain")], words: &["explain"] },
    Example {
        row: "a score with a name",
        variants: &[("hairpin::search::score::Score", "FastCorner")],
        words: &["fast-corner"],
    },
    Example { row: "a score of one's own", variants: &[], words: &[] },
    Example {
        row: "a controller of flights",
        variants: &[
            ("hairpin::simulation::controllers::ControllerKind", "Anafi"),
            ("hairpin::simulation::controllers::Pilot", "Anafi"),
        ],
        words: &["anafi"],
    },
    Example {
        row: "a controller on the ground",
        variants: &[
            ("hairpin::simulation::ground::controllers::GroundControllerKind", "Stanley"),
            ("hairpin::simulation::ground::controllers::GroundController", "Stanley"),
            ("hairpin::simulation::ground::controllers::Driver", "Stanley"),
        ],
        words: &["stanley"],
    },
    Example { row: "an executor", variants: &[], words: &["minimal_executor"] },
];

/// A row of the table.
struct Row<'a> {
    what: &'a str,
    own: Vec<&'a str>,
    elsewhere: BTreeMap<String, usize>,
}

/// The rows of the table of `text` whose first cells are those of `EXAMPLES`.
fn rows(text: &str) -> Vec<Row<'_>> {
    let lines = text.lines().skip_while(|line| !line.starts_with("| to add |")).skip(2);
    lines.take_while(|line| line.starts_with('|')).map(row).collect()
}

fn row(line: &str) -> Row<'_> {
    let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
    let ticked = |cell| quoted(cell).into_iter().filter(|(path, _)| path.contains('/')).collect::<Vec<_>>();
    let of = |at: usize| cells.get(at).copied().map(ticked).unwrap_or_default();
    let number =
        |after: &str| after.split(|c: char| !c.is_ascii_digit()).find(|digits| !digits.is_empty())?.parse().ok();
    Row {
        what: cells[0],
        own: of(1).into_iter().map(|(path, _)| path).collect(),
        elsewhere: of(2).into_iter().filter_map(|(path, after)| Some((path.to_owned(), number(after)?))).collect(),
    }
}

/// What stands between ticks in `cell`, and what stands behind it up to the next.
fn quoted(cell: &str) -> Vec<(&str, &str)> {
    let parts: Vec<&str> = cell.split('`').collect();
    parts[1..].chunks(2).map(|pair| (pair[0], pair.get(1).copied().unwrap_or_default())).collect()
}

/// How many lines of each file that is not one of `own` name what these define, or `example`; tests do not count.
fn elsewhere(house: &House, own: &[&str], example: &Example) -> BTreeMap<String, usize> {
    let others = house.files.iter().filter(|file| !file.in_test && !is_own(file, own));
    let counted = others.map(|file| (file.path.clone(), naming(house, file, own, example).len()));
    counted.filter(|(_, lines)| *lines > 0).collect()
}

fn is_own(file: &File, own: &[&str]) -> bool {
    own.iter().any(|path| file.path == *path || (path.ends_with('/') && file.path.starts_with(path)))
}

fn naming(house: &House, file: &File, own: &[&str], example: &Example) -> BTreeSet<usize> {
    let mut lines = BTreeSet::new();
    let meant = |found: &Found| {
        let variant = match found {
            Found::Item { module, name, rest } => example.variants.iter().any(|(path, variant)| {
                *path == format!("{module}::{name}") && rest.first().is_some_and(|part| part == variant)
            }),
            _ => false,
        };
        variant || house.file_of(found).is_some_and(|at| is_own(&house.files[at], own))
    };
    for mention in file.outline.mentions.iter().filter(|mention| !mention.in_test) {
        let word = mention.path[0].strip_prefix('"').is_some_and(|word| example.words.contains(&word));
        if word || house.mentioned(file, mention).iter().any(meant) {
            lines.insert(mention.line);
        }
    }
    for module in &file.outline.modules {
        for import in module.imports.iter().filter(|import| !import.in_test) {
            if house.follow(&module.path, &import.path).iter().any(meant) {
                lines.insert(import.line);
            }
        }
        for name in module.names.iter().filter(|name| !name.in_test) {
            let path = format!("{}::{}", module.path, name.name);
            match &name.what {
                What::Module if meant(&Found::Module(path.clone())) => drop(lines.insert(name.line)),
                What::Enum(variants) => {
                    let named = example.variants.iter().filter(|(of, _)| *of == path);
                    lines.extend(named.flat_map(|(_, word)| {
                        variants.iter().filter(move |(variant, _)| variant == word).map(|(_, line)| *line)
                    }));
                }
                _ => {}
            }
        }
    }
    lines
}

/// What is wrong with the table of `text`.
pub(crate) fn mistakes(house: &House, text: &str) -> Vec<String> {
    let rows = rows(text);
    let mut wrong = Vec::new();
    for row in &rows {
        let missing = row.own.iter().filter(|path| !project().join(path).exists());
        wrong.extend(missing.map(|path| format!("{}: there is no {path}", row.what)));
        let Some(example) = EXAMPLES.iter().find(|example| row.what.starts_with(example.row)) else {
            wrong.push(format!("{}: nothing counts it", row.what));
            continue;
        };
        let counted = elsewhere(house, &row.own, example);
        if counted != row.elsewhere {
            let told: Vec<String> = counted.iter().map(|(path, lines)| format!("`{path}` {lines}")).collect();
            wrong.push(format!("{}: its lines elsewhere are {}", row.what, told.join(", ")));
        }
    }
    let rowless = EXAMPLES.iter().filter(|example| !rows.iter().any(|row| row.what.starts_with(example.row)));
    wrong.extend(rowless.map(|example| format!("{}: has no row", example.row)));
    wrong
}

#[test]
fn a_table_that_is_not_true_is_caught() {
    use super::sources::Source;

    let source = |(module, path, text): (&str, &str, &str)| Source {
        module: module.into(),
        path: path.into(),
        text: text.into(),
    };
    let (own, face) = ("crates/hairpin/src/search/score.rs", "crates/hairpin/src/search/mod.rs");
    let naming = "pub mod score;\nuse score::Score;\nfn f(score: Score) {}\n#[cfg(test)]\nuse score::Score as S;\n";
    let modules =
        [("hairpin", "", ""), ("hairpin::search", face, naming), ("hairpin::search::score", own, "pub enum Score {}")];
    let house = House::new(&modules.map(source));
    let example = Example { row: "a score", variants: &[], words: &[] };
    assert_eq!(elsewhere(&house, &[own], &example), BTreeMap::from([(face.to_owned(), 3)]));
    assert_eq!(elsewhere(&house, &["crates/hairpin/src/search/"], &example), BTreeMap::new(), "all of a folder");

    let told = |row: &str| mistakes(&house, &format!("| to add | | |\n| --- | --- | --- |\n{row}\n")).join("\n");
    assert!(told("| an executor | `examples/none.py` | none |").contains("there is no examples/none.py"));
    assert!(
        told("| an executor | a program | `crates/hairpin/src/search/mod.rs` 1 |").contains("its lines elsewhere are")
    );
    assert!(told("| a wish | none | none |").contains("a wish: nothing counts it"));
    assert!(told("| a wish | none | none |").contains("an executor: has no row"));
    assert!(!told("| an executor | a program | none |").contains("an executor"));
}
