//! The book in docs/: every link of it leads somewhere, and every command of a guide runs, in the order in
//! which it stands there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use pulldown_cmark::{Event, Options, Parser, Tag, TagEnd};

use crate::commands::told;

/// The sources of hairpin.
const TOP: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/../..");

/// Runs every command of the `sh` blocks of a page of docs/, one after the other in one folder, as a shell runs them;
/// each must come to the exit code that the comment behind it names (`# exit code 1`), or to 0. A line that ends in
/// `\` goes on in the next.
pub(crate) fn run_page(page: &str) {
    let text = fs::read_to_string(Path::new(TOP).join("docs").join(page)).unwrap_or_else(|e| panic!("{page}: {e}"));
    let place = tempfile::tempdir().unwrap();
    let commands = commands(&text);
    assert!(!commands.is_empty(), "{page} has no commands");
    for line in commands {
        run_line(page, place.path(), &line);
    }
    // A picture that its commands make is what the page shows.
    let shown = Path::new(TOP).join("docs").join(page);
    for picture in links(&text).into_iter().filter(|link| link.ends_with(".svg")) {
        let [made, shown] = [place.path().join(&picture), shown.with_file_name(&picture)]
            .map(|file| fs::read_to_string(&file).unwrap_or_else(|e| panic!("{page}: {}: {e}", file.display())));
        let new = Path::new(env!("CARGO_TARGET_TMPDIR")).join(&picture);
        if made != shown {
            fs::write(&new, made).unwrap();
            panic!("{page}: {picture} is not what its commands make now, which is {}", new.display());
        }
    }
}

/// Runs a line of a page as a shell does, in the folder `here`, and says what it said on both streams. The comment
/// behind it names its exit code (`# exit code 1`, `# exit 1`), or it is 0.
pub(crate) fn run_line(page: &str, here: &Path, line: &str) -> String {
    let bin = Path::new(env!("CARGO_BIN_EXE_hairpin")).parent().unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    let mut shell = Command::new("sh");
    shell.args(["-e", "-c", line]).current_dir(here).env("PATH", &path).env("HAIRPIN_REPOSITORY", TOP);
    shell.env("XDG_STATE_HOME", here.join(".state"));
    let wanted = line.split_once("# ").map_or(0, |(_, comment)| exit_code(comment));
    let (code, out, error) = told(&mut shell);
    assert_eq!(code, wanted, "{page}: {line}\n{out}{error}");
    assert!(!error.contains("hairpin's own"), "{page}: {line}\n{error}");
    out + &error
}

fn exit_code(comment: &str) -> i32 {
    let named = ["exit code ", "exit "].iter().find_map(|word| Some(comment.split_once(word)?.1));
    named.and_then(|code| code.split(|c: char| !c.is_ascii_digit()).next()?.parse().ok()).unwrap_or(0)
}

/// The lines of all `sh` blocks.
fn commands(text: &str) -> Vec<String> {
    let mut lines = Vec::new();
    let (mut inside, mut whole) = (false, String::new());
    for line in text.lines() {
        if line.starts_with("```") {
            inside = line == "```sh";
        } else if inside && !line.trim().is_empty() {
            whole += line;
            if !whole.ends_with('\\') {
                lines.push(std::mem::take(&mut whole));
            } else {
                whole.pop();
            }
        }
    }
    lines
}

/// Where the links of a page lead: `[words](there)` and `![words](there)`, none to elsewhere.
fn links(text: &str) -> Vec<String> {
    let mut found = Vec::new();
    let mut rest = text;
    while let Some((_, after)) = rest.split_once("](") {
        let Some((link, after)) = after.split_once(')') else { break };
        rest = after;
        if !link.contains("://") && !link.starts_with("mailto:") {
            found.push(link.to_owned());
        }
    }
    found
}

/// All files below `folder` with this ending.
fn files(folder: &Path, ending: &str) -> BTreeSet<PathBuf> {
    let mut all = BTreeSet::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(files(&path, ending));
        } else if path.extension().is_some_and(|of| of == ending) {
            all.insert(path);
        }
    }
    all
}

#[test]
fn every_page_is_in_the_summary_and_what_is_named_is_there() {
    let docs = Path::new(TOP).join("docs");
    let summary = fs::read_to_string(docs.join("SUMMARY.md")).unwrap();
    let listed: Vec<PathBuf> = links(&summary).into_iter().map(PathBuf::from).collect();
    let within = |page: PathBuf| page.strip_prefix(&docs).unwrap().to_owned();
    let mut all: BTreeSet<PathBuf> = files(&docs, "md").into_iter().map(within).collect();
    all.remove(Path::new("SUMMARY.md"));
    assert_eq!(listed.iter().cloned().collect::<BTreeSet<_>>(), all, "docs/SUMMARY.md lists the pages of docs/");
    assert_eq!(listed.len(), all.len(), "a page stands twice in docs/SUMMARY.md");
    for link in links(&fs::read_to_string(Path::new(TOP).join("README.md")).unwrap()) {
        let file = link.split('#').next().unwrap();
        assert!(Path::new(TOP).join(file).exists(), "README.md: {link} leads nowhere");
    }
    // What lies outside of the book is named from the top of the sources.
    for page in all {
        let text = fs::read_to_string(docs.join(&page)).unwrap();
        let named = text.split('`').filter(|name| name.starts_with("examples/") && !name.contains([' ', '*', '{']));
        for name in named {
            assert!(Path::new(TOP).join(name).exists(), "{}: there is no {name}", page.display());
        }
    }
}

/// A page of the book as mdBook reads it.
#[derive(Debug, Default)]
struct Page {
    links: Vec<String>,
    /// The places that its headings are.
    places: BTreeSet<String>,
    /// Tags of HTML, which mdBook hands on as they are; no comments.
    html: Vec<String>,
}

impl Page {
    fn read(text: &str) -> Self {
        let options = Options::ENABLE_TABLES | Options::ENABLE_FOOTNOTES | Options::ENABLE_STRIKETHROUGH;
        let (mut page, mut heading) = (Self::default(), None);
        for event in Parser::new_ext(text, options) {
            match event {
                Event::Start(Tag::Link { dest_url, .. } | Tag::Image { dest_url, .. }) => {
                    page.links.push(dest_url.into_string());
                }
                Event::Start(Tag::Heading { .. }) => heading = Some(String::new()),
                Event::End(TagEnd::Heading(_)) => page.stands(&heading.take().unwrap_or_default()),
                Event::Text(words) | Event::Code(words) => heading.iter_mut().for_each(|heading| *heading += &words),
                Event::Html(tag) | Event::InlineHtml(tag) if !tag.trim_start().starts_with("<!--") => {
                    page.html.push(tag.into_string());
                }
                _ => {}
            }
        }
        page
    }

    /// Letters and digits in small, blanks as hyphens; the second of a name with a number behind it.
    fn stands(&mut self, heading: &str) {
        let letter = |c: char| match c {
            _ if c.is_alphanumeric() || c == '_' || c == '-' => Some(c.to_ascii_lowercase()),
            _ => c.is_whitespace().then_some('-'),
        };
        let name: String = heading.trim().chars().filter_map(letter).collect();
        let mut names = std::iter::once(name.clone()).chain((1..).map(|again| format!("{name}-{again}")));
        let free = names.find(|name| !self.places.contains(name));
        self.places.extend(free);
    }
}

/// Every link of the book leads to a page or a file of the book, and to a place that is there.
#[test]
fn the_book_is_whole() {
    let docs = Path::new(TOP).join("docs").canonicalize().unwrap();
    let read = |path: PathBuf| (path.clone(), Page::read(&fs::read_to_string(path).unwrap()));
    let pages: BTreeMap<PathBuf, Page> = files(&docs, "md").into_iter().map(read).collect();
    assert!(pages.values().map(|page| page.links.len()).sum::<usize>() > 150);
    for (path, page) in &pages {
        assert_eq!(page.html, [""; 0], "{}", path.display());
        for link in &page.links {
            assert!(leads_somewhere(&pages, path, link), "{}: {link} leads nowhere", path.display());
        }
    }
    let twice = Page::read("# A `b` c\n\ntext [there](x.md#y)\n\n## A b c\n\n<b>");
    assert_eq!(twice.places.into_iter().collect::<Vec<_>>(), ["a-b-c", "a-b-c-1"]);
    assert_eq!((twice.links, twice.html), (vec!["x.md#y".to_owned()], vec!["<b>".to_owned()]));
}

fn leads_somewhere(pages: &BTreeMap<PathBuf, Page>, page: &Path, link: &str) -> bool {
    if ["https://", "http://", "mailto:"].iter().any(|other| link.starts_with(other)) {
        return true;
    }
    let (file, place) = link.split_once('#').unwrap_or((link, ""));
    let there = if file.is_empty() { page.to_owned() } else { page.parent().unwrap().join(file) };
    let Ok(there) = there.canonicalize() else { return false };
    // What is not below it is no part of the book.
    let is_within = there.starts_with(Path::new(TOP).join("docs").canonicalize().unwrap());
    is_within && (place.is_empty() || pages.get(&there).is_some_and(|page| page.places.contains(place)))
}

#[test]
fn the_ten_minutes_of_a_drone_run() {
    run_page("guide/drone.md");
}

#[test]
fn the_ten_minutes_of_a_rover_run() {
    run_page("guide/rover.md");
}

#[test]
fn the_ten_minutes_of_a_car_run() {
    run_page("guide/car.md");
}

#[test]
fn the_ten_minutes_of_an_arm_run() {
    run_page("guide/arm.md");
}

#[test]
fn the_ten_minutes_of_an_own_simulator_run() {
    run_page("guide/own-simulator.md");
}

#[test]
fn the_recipes_for_build_servers_run() {
    run_page("guide/ci.md");
}

#[test]
fn the_commands_of_the_page_on_formats_run() {
    run_page("guide/formats.md");
}
