//! The book in docs/: every page is in its summary, every link leads somewhere, and every command of a guide runs, in
//! the order in which it stands there.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

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

fn pages(folder: &Path, under: &Path) -> BTreeSet<PathBuf> {
    let mut all = BTreeSet::new();
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            all.extend(pages(&path, under));
        } else if path.extension().is_some_and(|ending| ending == "md") {
            all.insert(path.strip_prefix(under).unwrap().to_owned());
        }
    }
    all
}

#[test]
fn every_page_is_in_the_summary_and_every_link_leads_somewhere() {
    let docs = Path::new(TOP).join("docs");
    let summary = fs::read_to_string(docs.join("SUMMARY.md")).unwrap();
    let listed: Vec<PathBuf> = links(&summary).into_iter().map(PathBuf::from).collect();
    let mut all = pages(&docs, &docs);
    all.remove(Path::new("SUMMARY.md"));
    assert_eq!(listed.iter().cloned().collect::<BTreeSet<_>>(), all, "docs/SUMMARY.md lists the pages of docs/");
    assert_eq!(listed.len(), all.len(), "a page stands twice in docs/SUMMARY.md");
    let of_readme = PathBuf::from("../README.md");
    for page in all.iter().chain([&of_readme]) {
        let place = docs.join(page);
        for link in links(&fs::read_to_string(&place).unwrap()) {
            let file = link.split('#').next().unwrap();
            let there = place.parent().unwrap().join(file);
            assert!(file.is_empty() || there.exists(), "{}: {link} leads nowhere", page.display());
        }
    }
}

/// The book itself, where mdbook is at hand.
#[test]
fn the_book_is_built_where_mdbook_is_there() {
    let place = tempfile::tempdir().unwrap();
    let mut mdbook = Command::new("mdbook");
    mdbook.arg("build").arg(Path::new(TOP).join("docs")).arg("--dest-dir").arg(place.path());
    let Ok(output) = mdbook.output() else {
        return eprintln!("no mdbook on the path: only pages and links are checked");
    };
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    assert!(place.path().join("guide/drone.html").is_file());
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
