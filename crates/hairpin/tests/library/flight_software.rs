//! Fit for flight: once the vehicle and its map are there, solving takes nothing from the heap, asks no clock, starts
//! no thread, and holds no call that is made to panic.

use std::fs;
use std::path::{Path, PathBuf};

use allocation_counter::measure;
use hairpin::campaign::drive::Site;
use hairpin::campaign::goals::{anywhere, flat_goal, ground_goals};
use hairpin::feasibility::steering::shooting::cc::{self, Gears};
use hairpin::feasibility::steering::shooting::flat::{self, Control, Cost};
use hairpin::feasibility::steering::shooting::rough::{Settings, Status, Steps};
use hairpin::feasibility::steering::shooting::solve::{Choices, solve};
use hairpin::feasibility::steering::shooting::{Curvatures, Query};
use hairpin::math::random::stream;
use hairpin::robot::rover::{Response, Rover, RoverDescription, Slip};
use hairpin::trajectory::drive::Gear;
use hairpin::trajectory::start_table::StartTable;
use hairpin::world::terrain::generate::{Recipe, generate};

const BOUNDS: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

/// The shipped rocky8, with `slip_and_lag` or as it is.
fn rocky8(slip_and_lag: bool) -> Rover {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../data/robots/rover/rocky8.toml");
    let text = fs::read_to_string(path).expect("a shipped rover");
    let rover = toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers");
    if !slip_and_lag {
        return rover;
    }
    let slip = Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 };
    let response =
        Response { latency: 0.2, steering_time_constant: 0.2, steering_rate: 30.0_f64.to_radians(), ..rover.response };
    Rover { slip, response, ..rover }
}

#[test]
fn the_counter_counts() {
    assert_eq!(measure(|| drop(std::hint::black_box(vec![1_u8; 100]))).bytes_total, 100);
}

#[test]
fn flat_solving_allocates_nothing() {
    let mut random = stream(21);
    let queries: Vec<Query> = (0..400)
        .map(|i| match i % 3 {
            0 => flat_goal(&mut random, &BOUNDS),
            1 => anywhere(&mut random, &BOUNDS, 0.0),
            _ => anywhere(&mut random, &BOUNDS, 1.0),
        })
        .collect();
    let mut found = 0;
    let heap = measure(|| {
        for query in &queries {
            for control in [Control::Arc, Control::Cubic, Control::Quintic] {
                for cost in [Cost::Any, Cost::Curvature, Cost::Rate] {
                    let settings = flat::Settings { control, cost, ..flat::Settings::default() };
                    found += usize::from(flat::forward(query, &BOUNDS, &settings).status == flat::Status::Ok);
                }
            }
            for (reversals, turns) in [(false, false), (true, false), (false, true)] {
                for gear in [Gear::Forward, Gear::Reverse] {
                    let choices = Choices { gear, reversals, turns, ..Choices::default() };
                    found += solve(query, &BOUNDS, &choices, || false).segments.len();
                }
            }
            found += usize::from(cc::steer(query, &BOUNDS, Gears::Both).is_some());
        }
    });
    assert_eq!(heap.count_total, 0, "{heap:?}");
    assert!(found > 1000);
}

#[test]
fn solving_on_the_ground_allocates_nothing() {
    let recipe =
        Recipe { size_m: 30.0, relief_m: 0.5, crater_area_m2: 40.0, rock_cover: 0.0, seed: 3, ..Recipe::default() };
    let map = generate(&recipe).expect("a map");
    for slip_and_lag in [false, true] {
        let rover = rocky8(slip_and_lag);
        let site = Site::straight(&rover, &map);
        let goals = ground_goals(&site, 60, &mut stream(22));
        let (mut solved, mut refined) = (0, 0);
        let heap = measure(|| {
            for (start, goal) in &goals {
                let answer = site.drive(start, goal, &Settings::default());
                solved += usize::from(answer.status == Status::Ok);
                refined += usize::from(answer.iterations > 8);
                // Where the motion ends at the map's edge, and where a goal is out of the vehicle's bounds.
                let beyond = hairpin::trajectory::drive::Planar { x: start.x + 100.0, ..*goal };
                solved += usize::from(site.drive(start, &beyond, &Settings::default()).status == Status::Ok);
                let _ = site.predict(start, &answer.segments, Steps::default());
            }
        });
        assert_eq!(heap.count_total, 0, "{heap:?}");
        assert!(goals.len() == 60 && solved >= 58, "{solved} solved, {refined} refined");
    }
}

#[test]
fn the_heap_of_one_solver_is_its_vehicle_and_its_table() {
    let recipe = Recipe { size_m: 30.0, relief_m: 0.5, crater_area_m2: 40.0, rock_cover: 0.0, ..Recipe::default() };
    let mut ground = None;
    let map = measure(|| ground = Some(generate(&recipe).expect("a map")));
    let map_held = map.bytes_current;
    let ground = ground.expect("a map");
    let grid = ground.grid();
    // The map is data: four bytes a cell and a ring around them, whoever solves on it.
    let cells = (grid.columns + 2) * (grid.rows + 2);
    assert!(map_held.unsigned_abs() < 5 * cells as u64, "{map_held} bytes held for {cells} cells");
    // A workspace: a vehicle from its file, a table of start values, flat and rough solving, until the last answer.
    let workspace = measure(|| {
        let rover = rocky8(true);
        let table = StartTable::generate(&BOUNDS).expect("a vehicle");
        let settings = flat::Settings { table: Some(&table), ..flat::Settings::default() };
        let goal = flat_goal(&mut stream(21), &BOUNDS);
        assert_eq!(flat::forward(&goal, &BOUNDS, &settings).status, flat::Status::Ok);
        let site = Site::straight(&rover, &ground);
        let start = hairpin::trajectory::drive::Planar { x: 15.0, y: 15.0, yaw: 0.3, curvature: 0.0 };
        let goal = hairpin::trajectory::drive::Planar { x: 18.0, y: 16.5, yaw: 0.6, curvature: 0.0 };
        assert!(site.drive(&start, &goal, &Settings::default()).iterations > 0);
    });
    eprintln!("one workspace: {} bytes of heap at most; the map of {cells} cells: {map_held}", workspace.bytes_max);
    // The table is nearly all of it.
    assert!((150_000..500_000).contains(&workspace.bytes_max), "{workspace:?}");
}

/// Rooms that run on board, and the files in them that do not: what is read or made before the drive.
const ROOMS: &[&str] = &[
    "feasibility/steering/shooting",
    "robot/rover",
    "world/terrain",
    "trajectory/drive.rs",
    "trajectory/start_table.rs",
];
const BEFORE: &[&str] = &[
    "robot/rover/body.rs",
    "robot/rover/description.rs",
    "world/terrain/generate.rs",
    "world/terrain/holes.rs",
    "world/terrain/keep_out/",
    "world/terrain/rocks.rs",
    "world/terrain/smooth.rs",
];
/// What solving does not do: threads, clocks, files, the heap, calls made to panic.
const NOT_ON_BOARD: &[&str] = &[
    "std::thread",
    "rayon",
    "Instant",
    "SystemTime",
    "std::fs",
    "std::io",
    "Mutex",
    "Box<",
    "Box::",
    "Rc<",
    "Arc<",
    "String",
    "format!",
    ".to_string()",
    ".to_owned()",
    ".collect",
    "HashMap",
    "BTreeMap",
    ".unwrap()",
    ".expect(",
    "panic!(",
    "Vec<",
    "Vec::",
    "vec![",
    "unreachable!(",
    "todo!(",
    "unimplemented!(",
];
/// Made once, before: the map's table and its errors in words, the vehicle's name; whole missions, which no solver
/// makes.
const MADE_BEFORE: &[(&str, &[&str])] = &[
    ("world/terrain/map.rs", &["Vec<", "Vec::", "vec![", "String", ".to_string()", ".collect"]),
    ("trajectory/start_table.rs", &["Vec<"]),
    ("shooting/flat/tabulate.rs", &["vec!["]),
    ("robot/rover/mod.rs", &["String", "Vec<"]),
    ("robot/rover/body.rs", &["Vec<", "format!"]),
    ("robot/rover/error.rs", &["String", "format!", ".to_string()"]),
    ("trajectory/drive.rs", &["Vec<"]),
];

/// What of `text`, up to its unit tests and without comments, is not for on board.
fn not_on_board(file: &str, text: &str) -> Vec<String> {
    let code = text.split("#[cfg(feature = \"unit-tests\")]\nmod tests {").next().unwrap_or_default();
    let allowed = MADE_BEFORE.iter().find(|(name, _)| file.ends_with(name)).map_or(&[][..], |(_, allowed)| allowed);
    let mut found = Vec::new();
    for (number, line) in code.lines().enumerate() {
        let line = line.split("//").next().unwrap_or_default();
        // Words end where they end: `SegmentVec<` is no `Vec<`.
        let has = |word: &str| {
            line.match_indices(word).any(|(at, _)| {
                !word.starts_with(char::is_alphabetic)
                    || !line[..at].ends_with(|before: char| before.is_alphanumeric() || before == '_')
            })
        };
        for word in NOT_ON_BOARD.iter().filter(|word| has(word) && !allowed.contains(word)) {
            found.push(format!("{file}:{}: {word}", number + 1));
        }
    }
    found
}

fn files(place: &Path, found: &mut Vec<PathBuf>) {
    if place.is_file() {
        return found.push(place.to_path_buf());
    }
    for entry in fs::read_dir(place).expect("a room") {
        let path = entry.expect("an entry").path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() && name != "tests" || name.ends_with(".rs") && name != "tests.rs" {
            files(&path, found);
        }
    }
}

#[test]
fn solver_rooms_hold_no_thread_no_clock_no_heap_and_no_panic() {
    let source = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut all = Vec::new();
    ROOMS.iter().for_each(|room| files(&source.join(room), &mut all));
    assert!(all.len() > 40, "{}", all.len());
    let mut found = Vec::new();
    for path in all {
        let name = path.strip_prefix(&source).expect("below src").to_string_lossy().replace('\\', "/");
        if !BEFORE.iter().any(|before| name.starts_with(before)) {
            found.extend(not_on_board(&name, &fs::read_to_string(&path).expect("a source file")));
        }
    }
    assert!(found.is_empty(), "{}", found.join("\n"));
    // The check sees what it is for.
    let forged =
        "fn f() { let begun = std::time::Instant::now(); }\nfn g(v: Vec<u8>) { v.first().unwrap(); } // Box<\n";
    assert_eq!(not_on_board("x.rs", forged).len(), 3, "{:?}", not_on_board("x.rs", forged));
}
