//! The book in docs/: it is built, every link of it leads somewhere, and every command of a guide runs, in the order in
//! which it stands there.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Arc, Mutex};

use mdbook_driver::MDBook;
use tracing::Level;

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

/// What the builder of the book complains of.
#[derive(Debug, Clone, Default)]
struct Complaints(Arc<Mutex<Vec<u8>>>);

impl Write for Complaints {
    fn write(&mut self, bytes: &[u8]) -> std::io::Result<usize> {
        self.0.lock().unwrap().write(bytes)
    }

    fn flush(&mut self) -> std::io::Result<()> {
        Ok(())
    }
}

/// The book, as `mdbook build docs` makes it: without a warning, and every link of it leads to a page or a file of the
/// book, and to a place that is there.
#[test]
fn the_book_is_built_and_whole() {
    let complaints = Complaints::default();
    let (writer, built) = (complaints.clone(), Path::new(env!("CARGO_TARGET_TMPDIR")).join("book"));
    let told = tracing_subscriber::fmt().with_max_level(Level::WARN).with_writer(move || writer.clone()).finish();
    tracing::subscriber::with_default(told, || {
        let mut book = MDBook::load(Path::new(TOP).join("docs")).unwrap();
        book.config.build.build_dir.clone_from(&built);
        book.build().unwrap();
    });
    assert_eq!(String::from_utf8_lossy(&complaints.0.lock().unwrap()), "");
    let built = built.canonicalize().unwrap();
    let text = |page: PathBuf| (page.clone(), fs::read_to_string(page).unwrap());
    let pages: BTreeMap<PathBuf, String> = files(&built, "html").into_iter().map(text).collect();
    assert!(pages.contains_key(&built.join("guide/drone.html")) && pages.contains_key(&built.join("index.html")));
    let of_the_book = pages.iter().filter(|(page, _)| !page.ends_with("404.html") && !page.ends_with("print.html"));
    for (page, text) in of_the_book {
        for link in [" href=\"", " src=\""].iter().flat_map(|name| text.split(name).skip(1)) {
            let link = link.split('"').next().unwrap();
            assert!(leads_somewhere(&pages, page, link), "{}: {link} leads nowhere", page.display());
        }
    }
}

fn leads_somewhere(pages: &BTreeMap<PathBuf, String>, page: &Path, link: &str) -> bool {
    if ["https://", "http://", "mailto:", "data:"].iter().any(|other| link.starts_with(other)) {
        return true;
    }
    let (file, place) = link.split_once('#').unwrap_or((link, ""));
    let there = if file.is_empty() { page.to_owned() } else { page.parent().unwrap().join(file) };
    let Ok(there) = there.canonicalize() else { return false };
    place.is_empty() || pages.get(&there).is_some_and(|text| text.contains(&format!(" id=\"{place}\"")))
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
