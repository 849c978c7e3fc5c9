//! Who may know whom: the floors of the library's rooms, of the crates, and of the rooms of `campaign`.

use super::house::{File, House};
use super::outline::What;
use super::seen::Seen;

/// Floor of each room of the library; a room imports only from lower floors.
pub(crate) const FLOORS: &[(&str, u8)] = &[
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
    ("unit_tests", 8), // all that is below, tested within; nobody knows it
];

/// What a room must never know although the floors allow it. A longer path forbids only what lies below it.
pub(crate) const NEVER: &[(&str, &[&str])] = &[
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

/// Rooms of the library that the formats must not see: they know tracks, scenarios, worlds and results.
pub(crate) const HIDDEN_FROM_FORMATS: &[&str] = &["feasibility", "search", "simulation", "verification"];

/// Variants of one thing, by the module that holds them: none imports another.
pub(crate) const VARIANTS: &[(&str, &[&str])] = &[
    // What drives on the ground is made of what a rover is made of.
    ("hairpin::robot", &["quadrotor", "rover", "arm"]),
    ("hairpin::robot::ground", &["differential_drive", "car"]),
    ("hairpin::feasibility::reach", &["none", "sphere", "hull", "witness"]),
    ("hairpin::search", &["beam", "exact", "uniform", "in_loop"]),
    (
        "hairpin::simulation::controllers",
        &[
            "unstable_waypoint",
            "stable_waypoint",
            "fixed_velocity",
            "minimum_snap",
            "geometric",
            "anafi",
            "px4_mission",
            "crazyflie_goto",
        ],
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

/// The crates from the ground up; each knows only those before it.
pub(crate) const CRATES: &[&str] = &[
    "hairpin_test",
    "hairpin",
    "hairpin_formats",
    "hairpin_jobs",
    "hairpin_lab",
    "hairpin_cli",
    "hairpin_py",
    "hairpin_c",
];

/// What a crate must never know of other people's crates and of the process it runs in.
pub(crate) const FOREIGN: &[(&str, &[&str])] = &[
    ("hairpin", TERMINAL),
    ("hairpin_formats", TERMINAL),
    ("hairpin_jobs", TERMINAL),
    ("hairpin_lab", &["clap", "clap_complete", "ctrlc", "signal_hook"]),
];

/// Who speaks to a person: the command line alone.
const TERMINAL: &[&str] = &[
    "clap",
    "clap_complete",
    "indicatif",
    "ctrlc",
    "signal_hook",
    "println!",
    "print!",
    "eprintln!",
    "eprint!",
    "std::io::stdout",
    "std::io::stdin",
    "std::io::stderr",
    "std::io::IsTerminal",
    "std::process::exit",
];

/// The room of a module of the library: `world` of `hairpin::world::sample`.
pub(crate) fn room(module: &str) -> Option<&str> {
    let mut parts = module.split("::");
    if parts.next() != Some("hairpin") {
        return None;
    }
    parts.next().filter(|room| floor(room) > 0)
}

pub(crate) fn floor(room: &str) -> u8 {
    FLOORS.iter().find(|(name, _)| *name == room).map_or(0, |(_, floor)| *floor)
}

pub(crate) fn starts_with(path: &str, prefix: &str) -> bool {
    path.strip_prefix(prefix).is_some_and(|rest| rest.is_empty() || rest.starts_with("::"))
}

pub(crate) fn crate_of(module: &str) -> &str {
    let root = module.split("::").next().unwrap_or_default();
    root.strip_suffix("_binary").unwrap_or(root)
}

/// Why `file` must not have `path`, by the floors.
pub(crate) fn breach(file: &File, path: &Seen) -> Option<String> {
    upward(&file.module, &path.path)
        .or_else(|| never(&file.module, &path.path))
        .or_else(|| sideways(&file.module, &path.path))
        .or_else(|| between_crates(&file.module, &path.path))
        .or_else(|| foreign(&file.module, path))
}

fn upward(module: &str, path: &str) -> Option<String> {
    let (own, other) = (room(module)?, room(path)?);
    let wrong = own != other && floor(other) >= floor(own);
    wrong.then(|| format!("{own} on floor {} must not know {other} on floor {}", floor(own), floor(other)))
}

fn never(module: &str, path: &str) -> Option<String> {
    let known = |names: &[&str]| {
        names.iter().find(|name| starts_with(path, &format!("hairpin::{name}"))).map(|name| (*name).to_owned())
    };
    if starts_with(module, "hairpin_formats") {
        return known(HIDDEN_FROM_FORMATS).map(|name| format!("formats must never know {name}"));
    }
    let own = room(module)?;
    let (_, forbidden) = NEVER.iter().find(|(name, _)| *name == own)?;
    known(forbidden).map(|name| format!("{own} must never know {name}"))
}

fn sideways(module: &str, path: &str) -> Option<String> {
    VARIANTS.iter().find_map(|(parent, variants)| {
        let variant = |module: &str| variants.iter().find(|v| starts_with(module, &format!("{parent}::{v}"))).copied();
        let (own, other) = (variant(module)?, variant(path)?);
        (own != other).then(|| format!("{own} and {other} are variants of one thing"))
    })
}

fn between_crates(module: &str, path: &str) -> Option<String> {
    let floor = |path: &str| CRATES.iter().position(|name| *name == crate_of(path));
    let (own, other) = (floor(module)?, floor(path)?);
    (other > own).then(|| format!("{} stands below {}", CRATES[own], CRATES[other]))
}

fn foreign(module: &str, path: &Seen) -> Option<String> {
    let (own, never) = FOREIGN.iter().find(|(own, _)| *own == crate_of(module))?;
    let known = never.iter().any(|name| starts_with(&path.path, name));
    (known && !path.in_test).then(|| format!("{own} speaks to no terminal: {} is the command line's", path.path))
}

/// The part of the house that `module` may export from without hiding where something comes from.
fn home(module: &str) -> String {
    let parts: Vec<&str> = module.split("::").collect();
    let depth = match parts[..] {
        ["hairpin", "campaign", ..] => 3,
        ["hairpin", ..] => 2,
        _ => 1,
    };
    parts[..depth.min(parts.len())].join("::")
}

/// Each export of `file` that hides from whoever imports it that it comes from another room or crate.
pub(crate) fn hidden(house: &House, file: &File) -> Vec<String> {
    let home = home(&file.module);
    let mut hidden = Vec::new();
    for module in &file.outline.modules {
        let exports = module.imports.iter().filter(|import| import.public && !import.in_test);
        let exports = exports.map(|import| (&import.path, import.line));
        let aliases =
            module.names.iter().filter(|name| name.public && !name.in_test).filter_map(|name| match &name.what {
                What::Alias(path) => Some((path, name.line)),
                _ => None,
            });
        for (path, line) in exports.chain(aliases) {
            let found = house.follow(&module.path, path);
            let away = found.iter().filter_map(|found| found.path()).find(|path| !starts_with(path, &home));
            hidden
                .extend(away.map(|path| format!("{} line {line}: exports {path}, which is not of {home}", file.path)));
        }
    }
    hidden
}

/// What `manifest` lists under `[dependencies]`.
pub(crate) fn dependencies(manifest: &str) -> Vec<String> {
    let section = manifest.lines().skip_while(|line| line.trim() != "[dependencies]").skip(1);
    let entries = section.take_while(|line| !line.starts_with('[')).filter(|line| !line.trim().is_empty());
    let name = |line: &str| line.split(['.', '=', ' ']).next().unwrap_or_default().replace('-', "_");
    entries.map(name).collect()
}

/// What of the manifest of `member` the floors of crates forbid.
pub(crate) fn wrong_dependencies(member: &str, manifest: &str) -> Vec<String> {
    let seen = |name| Seen { path: name, line: 0, in_test: false };
    let wrong = |seen: &Seen| between_crates(member, &seen.path).or_else(|| foreign(member, seen));
    dependencies(manifest).into_iter().map(seen).filter_map(|seen| wrong(&seen)).collect()
}
