//! The floors hold: every path to another room in every source file is read, and held to who may know whom.
//!
//! Read are `use` trees and paths that start with `crate`, `self`, `super`, `hairpin` or a std module that the
//! library must not know. A variant that a room re-exports from its `mod.rs` cannot be told from the room's own.

#[path = "layers/paths.rs"]
mod paths;

use std::path::{Path, PathBuf};

use paths::{Seen, read};

/// Floor of each room of the library; a room imports only from lower floors.
const FLOORS: &[(&str, u8)] = &[
    ("math", 1),
    ("world", 2),
    ("robot", 3),
    ("trajectory", 4),
    ("feasibility", 5),
    ("simulation", 5),
    ("judgement", 5),
    ("search", 6),
    ("verification", 6),
    ("campaign", 7),
];

/// What a room must never know although the floors allow it. A longer path forbids only what lies below it.
const NEVER: &[(&str, &[&str])] = &[
    ("trajectory", &["world"]),
    ("judgement", &["robot", "world"]),
    ("search", &["world", "simulation", "judgement"]),
    (
        "verification",
        &[
            "feasibility",
            "simulation",
            "robot",
            "trajectory",
            "math::integrate",
            "math::minimum_snap",
            "math::polynomial",
        ],
    ),
];

/// What the numerics never touch outside tests: files, the clock, the process, threads, printing, global randomness.
const OUTSIDE: &[&str] = &[
    "std::fs",
    "std::env",
    "std::process",
    "std::net",
    "std::thread",
    "std::io",
    "std::time::Instant",
    "std::time::SystemTime",
    "rand::rng",
    "rand::random",
    "println!",
    "print!",
    "eprintln!",
    "eprint!",
    "dbg!",
];

/// What may give other bits on another machine: what the standard library leaves to the machine's C library or to the
/// compiler, and products that only some machines fuse with a sum. `libm` and `math::power` give the same everywhere.
const MACHINE_DEPENDENT: &[&str] = &[
    "sin", "cos", "sin_cos", "tan", "asin", "acos", "atan", "atan2", "sinh", "cosh", "tanh", "asinh", "acosh", "atanh",
    "exp", "exp2", "exp_m1", "ln", "ln_1p", "log", "log2", "log10", "powf", "powi", "cbrt", "hypot", "mul_add",
];

/// Functions of nalgebra and of other libraries that call those.
const MACHINE_DEPENDENT_ABOVE: &[&str] = &[
    ".angle",
    ".angle_to",
    ".euler_angles",
    ".scaled_axis",
    ".axis_angle",
    ".slerp",
    ".try_slerp",
    ".lerp_slerp",
    ".try_lerp_slerp",
    ".rotation_to",
    ".powf",
    ".svd",
    ".symmetric_eigen",
    "UnitQuaternion::new",
    "Rotation3::new",
    "UnitQuaternion::from_euler_angles",
    "UnitQuaternion::from_axis_angle",
    "UnitQuaternion::from_scaled_axis",
    "UnitQuaternion::rotation_between",
    "Rotation3::from_euler_angles",
    "Rotation3::from_axis_angle",
    "Rotation3::rotation_between",
    "statrs",
];

/// Modules whose numbers are only looked at.
const SHOWN: &[&str] = &["hairpin::campaign::report", "hairpin_formats::report", "hairpin_lab::bench"];

/// Variants of one thing, by the module that holds them: none imports another.
const VARIANTS: &[(&str, &[&str])] = &[
    // What drives on the ground is made of what a rover is made of.
    ("hairpin::robot", &["quadrotor", "rover", "arm"]),
    ("hairpin::robot::ground", &["differential_drive", "car"]),
    ("hairpin::feasibility::reach", &["none", "sphere", "hull", "witness"]),
    ("hairpin::search", &["beam", "exact", "uniform", "in_loop"]),
    (
        "hairpin::simulation::controllers",
        &["unstable_waypoint", "stable_waypoint", "fixed_velocity", "minimum_snap", "geometric", "anafi"],
    ),
    ("hairpin::campaign", &["flight", "drive", "arm"]),
    (
        "hairpin_formats",
        &[
            "csv",
            "junit",
            "parquet",
            "tum",
            "waypoints",
            "mesh",
            "urdf",
            "terrain",
            "executor",
            "rapid",
            "krl",
            "urscript",
            "joint_trajectory",
        ],
    ),
];

/// Rooms of the library that the formats must not see: they know tracks, scenarios, worlds and results.
const HIDDEN_FROM_FORMATS: &[&str] = &["feasibility", "search", "simulation", "verification"];

/// A source file with the name of its module, such as `hairpin::world::sample`.
struct Source {
    module: String,
    text: String,
}

fn sources() -> Vec<Source> {
    let crates = Path::new(env!("CARGO_MANIFEST_DIR")).join("..");
    let mut found = Vec::new();
    for member in std::fs::read_dir(&crates).expect("the crates' folder") {
        let member = member.expect("a crate").path();
        let name = member.file_name().expect("a name").to_string_lossy().replace('-', "_");
        walk(&member.join("src"), &name, &mut found);
    }
    assert!(found.len() > 30, "only {} source files found in {crates:?}", found.len());
    found.sort_by(|a, b| a.module.cmp(&b.module));
    found
}

fn walk(folder: &Path, module: &str, found: &mut Vec<Source>) {
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries {
        let path: PathBuf = entry.expect("an entry").path();
        let stem = path.file_stem().expect("a name").to_string_lossy().into_owned();
        if path.is_dir() {
            walk(&path, &format!("{module}::{stem}"), found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let own = matches!(stem.as_str(), "mod" | "lib" | "main");
            let module = if own { module.to_owned() } else { format!("{module}::{stem}") };
            found.push(Source { module, text: std::fs::read_to_string(&path).expect("a source file") });
        }
    }
}

/// Everything in `source` that the rules forbid.
fn breaches(source: &Source) -> Vec<String> {
    let seen = read(&source.module, &source.text);
    let mut found = Vec::new();
    for path in &seen {
        found.extend(
            outside(source, path)
                .into_iter()
                .chain(upward(source, path))
                .chain(never(source, path))
                .chain(sideways(source, path))
                .chain(machine_dependent(source, path))
                .map(|why| format!("{} line {}: {} ({why})", source.module, path.line, path.path)),
        );
    }
    found
}

/// The room of a module of the library: `world` of `hairpin::world::sample`.
fn room(module: &str) -> Option<&str> {
    let mut parts = module.split("::");
    if parts.next() != Some("hairpin") {
        return None;
    }
    parts.next().filter(|room| FLOORS.iter().any(|(name, _)| name == room))
}

fn floor(room: &str) -> u8 {
    FLOORS.iter().find(|(name, _)| *name == room).map_or(0, |(_, floor)| *floor)
}

fn starts_with(path: &str, prefix: &str) -> bool {
    path.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

fn upward(source: &Source, path: &Seen) -> Option<String> {
    let (own, other) = (room(&source.module)?, room(&path.path)?);
    let wrong = own != other && floor(other) >= floor(own);
    wrong.then(|| format!("{own} on floor {} must not know {other} on floor {}", floor(own), floor(other)))
}

fn never(source: &Source, path: &Seen) -> Option<String> {
    let known = |names: &[&str]| {
        names.iter().find(|name| starts_with(&path.path, &format!("hairpin::{name}"))).map(|name| (*name).to_owned())
    };
    if starts_with(&source.module, "hairpin_formats") {
        return known(HIDDEN_FROM_FORMATS).map(|name| format!("formats must never know {name}"));
    }
    let own = room(&source.module)?;
    let (_, forbidden) = NEVER.iter().find(|(name, _)| *name == own)?;
    known(forbidden).map(|name| format!("{own} must never know {name}"))
}

fn outside(source: &Source, path: &Seen) -> Option<String> {
    let library = starts_with(&source.module, "hairpin") && !path.in_test;
    (library && OUTSIDE.iter().any(|forbidden| starts_with(&path.path, forbidden)))
        .then(|| "the numerics know no files, clock, process, threads, printing or global randomness".to_owned())
}

fn machine_dependent(source: &Source, path: &Seen) -> Option<String> {
    let shown = SHOWN.iter().any(|module| starts_with(&source.module, module));
    let name = path.path.strip_prefix('.').or(path.path.strip_prefix("f64::")).or(path.path.strip_prefix("f32::"));
    let wrong = name.is_some_and(|name| MACHINE_DEPENDENT.contains(&name))
        || MACHINE_DEPENDENT_ABOVE.iter().any(|above| starts_with(&path.path, above));
    (wrong && !shown && !path.in_test).then(|| "its bits depend on the machine: take libm or math::power".to_owned())
}

fn sideways(source: &Source, path: &Seen) -> Option<String> {
    VARIANTS.iter().find_map(|(parent, variants)| {
        let variant = |module: &str| variants.iter().find(|v| starts_with(module, &format!("{parent}::{v}"))).copied();
        let (own, other) = (variant(&source.module)?, variant(&path.path)?);
        (own != other).then(|| format!("{own} and {other} are variants of one thing"))
    })
}

#[test]
fn the_floors_hold() {
    let found: Vec<String> = sources().iter().flat_map(breaches).collect();
    assert!(found.is_empty(), "{} breaches:\n{}", found.len(), found.join("\n"));
}

#[test]
fn every_room_has_a_floor_and_every_floor_a_room() {
    let sources = sources();
    for (name, _) in FLOORS {
        assert!(sources.iter().any(|source| room(&source.module) == Some(name)), "no room {name}");
    }
    for source in &sources {
        let mut parts = source.module.split("::");
        if parts.next() == Some("hairpin")
            && let Some(name) = parts.next()
        {
            assert!(floor(name) > 0, "{} belongs to no floor", source.module);
        }
    }
}

/// A rule about a module that is no more would guard nothing.
#[test]
fn every_module_that_a_rule_names_exists() {
    let sources = sources();
    let exists = |module: &str| sources.iter().any(|source| starts_with(&source.module, module));
    for (parent, variants) in VARIANTS {
        for variant in *variants {
            assert!(exists(&format!("{parent}::{variant}")), "no module {parent}::{variant}");
        }
    }
    let named = NEVER.iter().flat_map(|(_, modules)| *modules).chain(HIDDEN_FROM_FORMATS);
    for module in named {
        assert!(exists(&format!("hairpin::{module}")), "no module hairpin::{module}");
    }
    assert!(SHOWN.iter().all(|module| exists(module)), "a module that only shows is gone");
}

/// Whether `text`, put into `module`, is refused.
fn refused(module: &str, text: &str) -> bool {
    !breaches(&Source { module: module.into(), text: text.into() }).is_empty()
}

#[test]
fn forged_breaches_are_caught() {
    for (module, text) in [
        ("hairpin::world::sample", "use crate::robot::Dynamics;"),
        ("hairpin::math::random", "use crate::{world::World};"),
        ("hairpin::trajectory::track", "fn f(w: &crate::world::World) {}"),
        ("hairpin::simulation::plant", "use crate::{math::random, feasibility::{self, reach::Leg}};"),
        ("hairpin::feasibility::limits", "use crate::simulation as s;"),
        ("hairpin::judgement::measure", "pub use crate :: robot :: quadrotor :: Quadrotor;"),
        ("hairpin::judgement", "use super::simulation::plant;"),
        ("hairpin::judgement::tests", "mod deep { use super::super::super::campaign; }"),
        ("hairpin::search::beam", "use crate::world::World;"),
        ("hairpin::search::beam", "use super::exact::triples;"),
        ("hairpin::search::beam::frontier", "use crate::search::exact;"),
        ("hairpin::verification::replay", "use crate::math::integrate::rk4;"),
        ("hairpin::verification::replay", "use crate::math::{random, integrate::rk4};"),
        ("hairpin::verification::replay", "let f = crate::robot::quadrotor::Quadrotor::derivative;"),
        ("hairpin::verification::replay", "use crate::feasibility::*;"),
        ("hairpin::verification::replay", "use crate::search::beam;"),
        ("hairpin::feasibility::reach::witness", "use super::hull::Polytope;"),
        ("hairpin::feasibility::reach::witness", "use self::super::sphere;"),
        ("hairpin::simulation::controllers::anafi", "use crate::simulation::controllers::geometric::Gains;"),
        ("hairpin::campaign::flight::solve", "use crate::campaign::drive::Site;"),
        ("hairpin::robot::ground::car", "use super::differential_drive::DifferentialDrive;"),
        ("hairpin::campaign::generate", "fn f() { println!(\"done\") }"),
        ("hairpin::campaign::generate", "use std::{fmt, time::Instant};"),
        ("hairpin::campaign::generate", "let text = std::fs::read_to_string(path);"),
        ("hairpin::campaign::generate", "#[cfg(test)] mod tests { fn f() {} } use std::env;"),
        ("hairpin::math::rotation", "let (s, c) = (0.5 * roll).sin_cos();"),
        ("hairpin::math::rotation", "let y = 2.0.powi(3);"),
        ("hairpin::feasibility::reach::sampling", "all.map(f64::exp)"),
        ("hairpin::feasibility::reach::witness", "let turn = incoming .angle(&outgoing);"),
        ("hairpin::feasibility::steering::flatness", "let q = UnitQuaternion::from_euler_angles(roll, pitch, 0.0);"),
        ("hairpin::judgement::statistics", "use statrs::function::beta::beta_reg;"),
        ("hairpin_formats::csv", "use crate::tum::write;"),
        ("hairpin_formats::parquet::track", "use hairpin::search::Beam;"),
        ("hairpin_formats::parquet::track", "use ::hairpin::{trajectory::Track, simulation};"),
    ] {
        assert!(refused(module, text), "not caught in {module}: {text}");
    }
}

#[test]
fn what_is_allowed_passes() {
    for (module, text) in [
        ("hairpin::world::sample", "use crate::math::random::stream; use super::World;"),
        ("hairpin::world::tests", "//! like crate::robot::x\n/// [`crate::robot`] /* crate::robot */"),
        ("hairpin::math::random", "const A: &str = \"crate::world::x\"; const B: &str = r#\"use crate::world;\"#;"),
        ("hairpin::math::random", "fn f<'a>(c: &'a char) -> bool { *c == '\"' } // crate::world"),
        ("hairpin::math", "mod tests { use super::*; } pub mod random; pub(crate) use random::stream;"),
        ("hairpin::verification::replay", "use crate::math::random; use super::body::Body;"),
        ("hairpin::feasibility::reach", "pub mod hull; pub mod witness; pub use self::hull::Hull;"),
        ("hairpin::feasibility::reach::hull", "use crate::feasibility::polytope::Polytope; use super::Reach;"),
        ("hairpin::campaign::generate", "#[cfg(test)] mod tests { use std::time::Instant; } use crate::search::beam;"),
        ("hairpin::campaign::generate::tests", "use std::time::Instant;"),
        ("hairpin::math::rotation", "let s = libm::sin(x).sqrt(); let z = Self { sin, ..exp() }; // x.sin()"),
        ("hairpin::math::rotation", "#[cfg(test)] mod tests { fn f(x: f64) -> f64 { x.sin() } }"),
        ("hairpin::campaign::report::solid", "let x = angle.cos();"),
        ("hairpin_formats::folder", "use crate::{csv, tum}; use hairpin::campaign::Case; use std::fs;"),
    ] {
        let found = breaches(&Source { module: module.into(), text: text.into() });
        assert!(found.is_empty(), "{found:?}");
    }
}
