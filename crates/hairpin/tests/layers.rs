//! The house holds: every path in every source file is read, followed to the file that defines what it names, and held
//! to who may know whom.
//!
//! | file of `layers/` | what it holds |
//! | --- | --- |
//! | `floors` | rooms and crates import only downward, variants not each other, and export only their own |
//! | `campaign` | the same of the rooms of `campaign` |
//! | `circles` | no file needs itself by way of others |
//! | `kinds` | what a robot is is asked in one place |
//! | `numerics` | the numerics touch no files, clock or terminal, and give the same bits everywhere |
//! | `width` | comments are as wide as code |
//! | `adding` | CONTRIBUTING.md says truly what there is to do for one more of something |
//!
//! The others read: `text` tokens, `syntax` and `outline` what a file declares and mentions, `house` where that is
//! defined, `seen` the paths that rules look at, `patterns` where a pattern decides. What the tree still breaks is
//! counted in `known`, which may only shrink; `-- --nocapture` prints each such place.

#[path = "layers/adding.rs"]
mod adding;
#[path = "layers/campaign.rs"]
mod campaign;
#[path = "layers/circles.rs"]
mod circles;
#[path = "layers/floors.rs"]
mod floors;
#[path = "layers/forged.rs"]
mod forged;
#[path = "layers/house.rs"]
mod house;
#[path = "layers/kinds.rs"]
mod kinds;
#[path = "layers/known.rs"]
mod known;
#[path = "layers/numerics.rs"]
mod numerics;
#[path = "layers/outline.rs"]
mod outline;
#[path = "layers/patterns.rs"]
mod patterns;
#[path = "layers/seen.rs"]
mod seen;
#[path = "layers/sources.rs"]
mod sources;
#[path = "layers/syntax.rs"]
mod syntax;
#[path = "layers/text.rs"]
mod text;
#[path = "layers/width.rs"]
mod width;

use std::sync::LazyLock;

use circles::{Needs, needs};
use floors::{CRATES, FLOORS, HIDDEN_FROM_FORMATS, NEVER, VARIANTS, floor, room, starts_with};
use house::{File, House};
use known::held;

/// The sources as they are.
static HOUSE: LazyLock<House> = LazyLock::new(|| House::new(&sources::of_crates()));
static NEEDS: LazyLock<Needs> = LazyLock::new(|| needs(&HOUSE));

/// Everything in `file` that the rules about paths forbid, in words.
fn breaches(house: &House, file: &File) -> Vec<String> {
    let why = |path: &seen::Seen| floors::breach(file, path).or_else(|| numerics::breach(file, path));
    let told =
        |path: seen::Seen| why(&path).map(|why| format!("{} line {}: {} ({why})", file.path, path.line, path.path));
    seen::seen(house, file).into_iter().filter_map(told).collect()
}

fn of_all_files(rule: impl Fn(&House, &File) -> Vec<String>) -> Vec<String> {
    HOUSE.files.iter().flat_map(|file| rule(&HOUSE, file)).collect()
}

#[test]
fn the_floors_hold() {
    held("paths against the floors", known::AGAINST_THE_FLOORS, &of_all_files(breaches));
}

#[test]
fn nothing_is_exported_that_comes_from_elsewhere() {
    held("exports of another room's", known::EXPORTED_FROM_ELSEWHERE, &of_all_files(floors::hidden));
}

#[test]
fn the_floors_of_campaign_hold() {
    held("imports against the floors of campaign", known::AGAINST_CAMPAIGN, &campaign::breaches(&HOUSE, &NEEDS));
}

#[test]
fn no_file_needs_itself() {
    let circles = circles::circles(&NEEDS);
    for circle in &circles {
        println!("a circle of {} files:\n  {}", circle.len(), circles::told(&HOUSE, &NEEDS, circle).join("\n  "));
    }
    for member in CRATES {
        let files = circles.iter().flatten().map(|at| &HOUSE.files[*at]);
        let own = files.filter(|file| floors::crate_of(&file.module) == *member);
        let paths: Vec<String> = own.map(|file| file.path.clone()).collect();
        held(&format!("files of {member} in circles"), known::in_circles(member), &paths);
    }
}

#[test]
fn what_a_robot_is_is_asked_in_one_place() {
    let places = kinds::places(&HOUSE);
    let told: Vec<String> = places.iter().map(|place| format!("{}:{} {}", place.path, place.line, place.by)).collect();
    held("places that tell kinds apart", known::TELLING_KINDS_APART, &told);
    held("asked for what one kind alone has", known::ASKED_BY_TYPE, &kinds::asked_by_type(&HOUSE));
}

#[test]
fn comments_are_no_wider_than_code() {
    let all = sources::everything();
    let of = |source: &sources::Source| {
        let lines = width::too_long(&source.text);
        lines.into_iter().map(|line| format!("{}:{line}", source.path)).collect::<Vec<_>>()
    };
    held("lines of comments that are too long", known::LONG_COMMENTS, &all.iter().flat_map(of).collect::<Vec<_>>());
}

#[test]
fn contributing_says_what_there_is_to_do() {
    let text = std::fs::read_to_string(sources::project().join("CONTRIBUTING.md")).expect("CONTRIBUTING.md");
    let wrong = adding::mistakes(&HOUSE, &text);
    assert!(wrong.is_empty(), "CONTRIBUTING.md:\n{}", wrong.join("\n"));
}

#[test]
fn manifests_ask_for_nothing_that_their_crate_must_not_know() {
    for member in sources::members() {
        let manifest = std::fs::read_to_string(sources::project().join(format!("crates/{member}/Cargo.toml")));
        let wrong = floors::wrong_dependencies(&member.replace('-', "_"), &manifest.expect("a manifest"));
        assert!(wrong.is_empty(), "{member}: {}", wrong.join("\n"));
    }
}

/// What cannot be followed is held to nothing.
#[test]
fn every_path_into_the_house_leads_somewhere() {
    let ours = |path: &[String]| {
        path.len() > 1 && (["crate", "self", "super"].contains(&path[0].as_str()) || HOUSE.module(&path[0]).is_some())
    };
    for file in &HOUSE.files {
        let mentions = file.outline.mentions.iter().map(|mention| (mention.module, &mention.path, mention.line));
        let modules = file.outline.modules.iter().enumerate();
        let imports =
            modules.flat_map(|(at, module)| module.imports.iter().map(move |leaf| (at, &leaf.path, leaf.line)));
        for (module, path, line) in mentions.chain(imports).filter(|(_, path, _)| ours(path)) {
            let found = HOUSE.follow(&file.outline.modules[module].path, path);
            assert!(!found.is_empty(), "{} line {line}: {} leads nowhere", file.path, path.join("::"));
        }
    }
}

#[test]
fn every_room_has_a_floor_and_every_floor_a_room() {
    let exists = |module: &str| HOUSE.files.iter().any(|file| starts_with(&file.module, module));
    for (name, _) in FLOORS {
        assert!(exists(&format!("hairpin::{name}")), "no room {name}");
    }
    for rooms in campaign::ROOMS {
        rooms
            .iter()
            .for_each(|name| assert!(exists(&format!("hairpin::campaign::{name}")), "no room campaign::{name}"));
    }
    for name in CRATES {
        assert!(exists(name), "{name} is not as the floors of crates have it");
    }
    for file in &HOUSE.files {
        let (member, below) = file.module.split_once("::").unwrap_or((&file.module, ""));
        let member = member.strip_suffix("_binary").unwrap_or(member);
        assert!(CRATES.contains(&member), "{member} belongs to no floor");
        if member == "hairpin" && !below.is_empty() {
            assert!(room(&file.module).is_some_and(|room| floor(room) > 0), "{} belongs to no floor", file.module);
        }
        if starts_with(below, "campaign") && below != "campaign" {
            assert!(campaign::room(&file.module).is_some(), "{} belongs to no floor of campaign", file.module);
        }
    }
}

/// A rule about a module that is no more would guard nothing.
#[test]
fn every_module_that_a_rule_names_exists() {
    let exists = |module: &str| HOUSE.files.iter().any(|file| starts_with(&file.module, module));
    for (parent, variants) in VARIANTS {
        for variant in *variants {
            assert!(exists(&format!("{parent}::{variant}")), "no module {parent}::{variant}");
        }
    }
    for module in NEVER.iter().flat_map(|(_, modules)| *modules).chain(HIDDEN_FROM_FORMATS) {
        assert!(exists(&format!("hairpin::{module}")), "no module hairpin::{module}");
    }
    for module in numerics::SHOWN.iter().chain(kinds::ROOMS).filter(|module| !known::COMING_ROOMS.contains(module)) {
        assert!(exists(module), "no module {module}");
    }
    assert!(!known::COMING_ROOMS.iter().any(|module| exists(module)), "a room has come: take it off the list");
}
