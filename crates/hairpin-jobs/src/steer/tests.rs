//! Questions answered without a binary.

use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};

use hairpin_formats::steering::Status;

use super::*;
use crate::testing::Told;
use crate::{Unwatched, Watch};

fn generic() -> Vehicle {
    Vehicle::new(&SteerSettings { rover: "generic".into(), ..SteerSettings::default() }, &Unwatched).unwrap()
}

#[test]
fn a_question_is_answered_and_summed_up() {
    let vehicle = generic();
    let asked = Question { to: [4.0, 1.0, 0.5, 0.0], ..Question::default() }.asked();
    let answered = vehicle.answer(&asked);
    assert_eq!(answered.status, Status::Ok);
    let summary = vehicle.summary(&asked, &answered);
    assert_eq!(summary.profile.unwrap().kind, "constant");
    assert!(vehicle.remedies(&asked, &answered).nearest.is_none());
}

/// Of a scenario its robot drives, and whose ground it is is said.
#[test]
fn a_scenario_gives_its_robot() {
    let asked = Question { to: [4.0, 1.0, 0.5, 0.0], ..Question::default() }.asked();
    let length = |rover: &str, told: &Told| {
        let settings = SteerSettings { rover: rover.into(), ..SteerSettings::default() };
        let vehicle = Vehicle::new(&settings, told).unwrap();
        let answered = vehicle.answer(&asked);
        assert_eq!(answered.status, Status::Ok, "{rover}");
        answered.drive.unwrap().1.length
    };
    let silent = Told::default();
    let alone = length("rocky8", &silent);
    assert!(silent.0.into_inner().unwrap().is_empty());
    let place = tempfile::tempdir().unwrap();
    let own = place.path().join("own.toml");
    fs::write(&own, "kind = \"rover\"\nname = \"own\"\n[limits]\ncurvature_1_m = 0.5\n").unwrap();
    let scenario = place.path().join("scenario.toml");
    for (robot, name, same) in [("\"rocky8\"", "rocky8", true), ("\"own.toml\"", "own", false)] {
        fs::write(&scenario, format!("hairpin = 1\nrobot = {robot}\n[world]\nterrain = {{ file = \"no.tif\" }}\n"))
            .unwrap();
        let told = Told::default();
        assert_eq!(length(&scenario.display().to_string(), &told) == alone, same, "{robot}");
        let told = told.0.into_inner().unwrap().join("\n");
        assert!(told.contains(&format!("the robot alone is taken, `{name}`: on level ground")), "{told}");
    }
    assert_eq!(length("demo-rover", &Told::default()), alone);
    for (text, words) in [
        ("hairpin = 1\n[task]\nlength = 3\n", "`robot` is missing"),
        ("hairpin = 1\nrobot = \"anafi\"\n", "no rover"),
        ("hairpin = 1\nrobot = \"none.toml\"\n", "none.toml"),
    ] {
        fs::write(&scenario, text).unwrap();
        let settings = SteerSettings { rover: scenario.display().to_string(), ..SteerSettings::default() };
        let refused = Vehicle::new(&settings, &Unwatched).map(|_| ()).unwrap_err().to_string();
        assert!(refused.contains(words), "{text}: {refused}");
    }
}

#[test]
fn frames_ask_the_same_question() {
    let enu = Question { from: Some([1.0, 2.0, 0.3, 0.1]), to: [5.0, 3.0, 0.8, 0.0], ..Question::default() }.asked();
    let quarter = std::f64::consts::FRAC_PI_2;
    let ned = Question {
        from: Some([2.0, 1.0, quarter - 0.3, -0.1]),
        to: [3.0, 5.0, quarter - 0.8, 0.0],
        frame: hairpin_formats::steering::Frame::Ned,
        ..Question::default()
    };
    let goals = enu.goal.into_iter().zip(ned.asked().goal);
    assert!(goals.into_iter().all(|(a, b)| (a - b).abs() < 1e-12));
    let back = goal_in_the_map(&ned.asked(), &[enu.goal[0], enu.goal[1], enu.goal[2], 0.0]);
    assert!(back.into_iter().zip(ned.to).all(|(a, b)| (a - b).abs() < 1e-12), "{back:?}");
}

#[test]
fn a_file_is_answered_in_its_order() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("q.csv");
    fs::write(&path, "id,x,y,yaw,k0,kf\na,4,1,0.5,0,0\nb,x,1,0,0,0\nc,0.1,0,0,0.9,-0.9\n").unwrap();
    let mut shown = String::new();
    let mut show = |rows: &str| shown.push_str(rows);
    let batch = generic().answer_file(&path, Answers::Shown(&mut show), false, &Unwatched).unwrap();
    assert_eq!((batch.ended(Status::Ok) >= 1, batch.ended(Status::Invalid)), (true, 1));
    let ids: Vec<&str> = shown.lines().filter(|row| row.contains(",0,")).map(|row| &row[..1]).collect();
    assert!(shown.starts_with("id,segment,"), "{shown}");
    assert!(ids.is_sorted() && ["a", "b", "c"].iter().all(|id| ids.contains(id)), "{shown}");
}

/// Their answers could not be told apart, and nobody said so.
#[test]
fn ids_that_stand_twice_are_told_with_both_lines() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("q.csv");
    let told = |text: &str| {
        fs::write(&path, text).unwrap();
        let told = Told::default();
        let batch = generic().answer_file(&path, Answers::Shown(&mut |_| {}), false, &told).unwrap();
        (batch.queries, told.0.into_inner().unwrap().join("\n"))
    };
    let head = "id,x,y,yaw,k0,kf\na,4,1,0.5,0,0\nb,4,1,0.4,0,0\n";
    assert_eq!(told(head), (2, String::new()));
    let (queries, once) = told(&format!("{head}\na,4,1,0.3,0,0\n"));
    assert!(
        queries == 3 && once.ends_with("line 5: id = \"a\", as on line 2: answers do not tell them apart"),
        "{once}"
    );
    // Across blocks that are read at different times, too.
    let many: String = (0..3000).map(|row| format!("q{},x,1,0.5,0,0\n", row % 2999)).collect();
    let (_, twice) = told(&format!("{head}{many}b,4,1,0.3,0,0\n"));
    assert!(
        twice.contains("line 3003: id = \"q0\", as on line 4: ") && twice.ends_with("; 1 more such row"),
        "{twice}"
    );
}

/// Metres of the answer, and how far its replay ends from the goal: m, rad, 1/m.
fn driven(vehicle: &Vehicle, asked: &hairpin_formats::steering::Asked) -> (f64, [f64; 3]) {
    let answered = vehicle.answer(asked);
    assert_eq!(answered.status, Status::Ok, "{asked:?}");
    let (_, replay) = answered.drive.as_ref().unwrap();
    let [x, y, yaw] = replay.error;
    (replay.length, [x.hypot(y), yaw.abs(), replay.error_curvature.abs()])
}

#[test]
fn a_start_that_is_there_already_drives_nothing() {
    let vehicle = generic();
    let of = |to: [f64; 4], tolerance_m| Question { to, tolerance_m, ..Question::default() }.asked();
    for (to, tolerance) in [([0.0; 4], None), ([0.0, 0.0, 0.005, 0.0], None), ([0.05, -0.05, 0.001, 0.0], Some(0.1))] {
        let asked = of(to, tolerance);
        let (length, [off, ..]) = driven(&vehicle, &asked);
        assert!(length == 0.0 && off <= tolerance.unwrap_or(0.01), "{to:?}: {length} {off}");
        let answered = vehicle.answer(&asked);
        let (solution, _) = answered.drive.as_ref().unwrap();
        let arc = hairpin_formats::steering::Piece::Arc { length_m: 0.0, curvature: [0.0; 6], direction: 1 };
        assert_eq!(pieces(solution, asked.k0), [arc]);
        assert!(vehicle.follow(&asked, &answered, Rows::Few).is_none_or(|states| states.states.len() < 3), "{to:?}");
        vehicle.summary(&asked, &answered);
        let remedies = vehicle.remedies(&asked, &answered);
        assert!(remedies.with_reversals_m.is_none() && remedies.nearest.is_none(), "{remedies:?}");
    }
    // One of its tolerances is not enough.
    for to in [[0.0, 0.0, 0.2, 0.0], [0.3, 0.0, 0.0, 0.0], [0.0, 0.0, 0.0, 0.3]] {
        assert!(driven(&vehicle, &of(to, None)).0 > 0.1, "{to:?}");
    }
    // Nor is a place where it must not stand.
    let place = hairpin::campaign::scenario::KeepOutSection {
        name: String::new(),
        circle: Some(hairpin::campaign::scenario::CircleSection { center_m: [0.0, 0.0], radius_m: 1.0 }),
        polygon: None,
    };
    let settings = SteerSettings { rover: "generic".into(), places: vec![place], ..SteerSettings::default() };
    let among = Vehicle::new(&settings, &Unwatched).unwrap();
    assert_eq!(among.answer(&of([0.0; 4], None)).status, Status::Infeasible);
}

#[test]
fn a_detour_gives_way_to_a_goal_within_the_tolerances() {
    let effort = Effort { tolerance_yaw: Some(0.1), ..Effort::default() };
    let settings = SteerSettings { rover: "generic".into(), effort, ..SteerSettings::default() };
    let (lax, strict) = (Vehicle::new(&settings, &Unwatched).unwrap(), generic());
    let exactly = |vehicle: &Vehicle, asked: &_| {
        let answered = vehicle.answer_by(asked, &vehicle.solver());
        answered.drive.filter(|_| answered.status == Status::Ok).map(|(solution, replay)| (solution, replay.length))
    };
    let mut shorter = 0;
    for seed in 0..400_u64 {
        let unit = |i: u64| hairpin::math::random::hashed_unit(seed, &[i]);
        let near = seed % 2 == 0;
        let size = if near { 0.6 } else { 6.0 };
        let to = [size * unit(0), size * (unit(1) - 0.5), 2.0 * (unit(2) - 0.5), 0.4 * (unit(3) - 0.5)];
        let tolerance = if near { 0.1 } else { 0.02 };
        let asked = Question { to, tolerance_m: Some(tolerance), ..Question::default() }.asked();
        let Some((exact, length)) = exactly(&lax, &asked) else { continue };
        let answered = lax.answer(&asked);
        let (solution, replay) = answered.drive.as_ref().unwrap();
        assert!(answered.status == Status::Ok && replay.length <= length, "seed {seed}: {to:?}");
        let [x, y, yaw] = replay.error;
        assert!(x.hypot(y) <= tolerance && yaw.abs() <= 0.1, "seed {seed}: {to:?}: {replay:?}");
        if length <= 1.5 * to[0].hypot(to[1]) {
            assert!(solution.segments == exact.segments || replay.length == 0.0, "seed {seed}: the exact one stays");
        }
        shorter += usize::from(replay.length > 0.0 && replay.length < 0.5 * length);
    }
    assert!(shorter >= 3, "{shorter}");
    // The straight way, where the exact one is a loop of metres.
    for (to, tolerance) in
        [([0.05, 0.0, 0.001, 0.0], 0.1), ([0.3, 0.01, 0.02, 0.0], 0.02), ([0.5, 0.05, 0.0, 0.0], 0.06)]
    {
        let asked = Question { to, tolerance_m: Some(tolerance), ..Question::default() }.asked();
        let (length, [off, turned, _]) = driven(&lax, &asked);
        let straight = to[0].hypot(to[1]);
        assert!(length <= 1.01 * straight && off <= tolerance && turned <= 0.1, "{to:?}: {length} {off} {turned}");
    }
    // Without a way within the tolerances the exact one stays as it is.
    let asked = Question { to: [0.3, 0.5, 0.0, 0.0], ..Question::default() }.asked();
    let (exact, length) = exactly(&strict, &asked).unwrap();
    assert!(length > 2.0);
    assert_eq!(strict.answer(&asked).drive.unwrap().0, exact);
}

/// Stops once it has been asked so often.
struct Stops(AtomicUsize, usize);

impl Watch for Stops {
    fn stopped(&self) -> bool {
        self.0.fetch_add(1, Ordering::Relaxed) >= self.1
    }
}

#[test]
fn a_file_that_is_stopped_keeps_what_is_done_and_goes_on() {
    let folder = tempfile::tempdir().unwrap();
    let [queries, whole, parts, other] =
        ["q.csv", "whole.csv", "parts.csv", "other.csv"].map(|f| folder.path().join(f));
    let row = |i: u64| {
        let unit = |k: u64| hairpin::math::random::hashed_unit(i, &[k]);
        let bad = if i % 97 == 5 { "x" } else { "" };
        format!("q{i},{bad}{},{},{},0,0\n", 4.0 * unit(0), 2.0 * unit(1) - 1.0, unit(2) - 0.5)
    };
    let text = String::from("id,x,y,yaw,k0,kf\n") + &(0..300).map(row).collect::<String>();
    fs::write(&queries, &text).unwrap();
    let vehicle = generic();
    // What solving took is no result.
    let table = |path: &std::path::Path| -> Vec<String> {
        let text = fs::read_to_string(path).unwrap();
        let cells =
            |row: &str| row.split(',').enumerate().filter(|(i, _)| *i != 6).map(|(_, c)| c.to_owned() + ",").collect();
        text.lines().map(cells).collect()
    };
    let all = vehicle.answer_file(&queries, Answers::File(&whole), false, &Unwatched).unwrap();
    assert_eq!((all.queries, all.wrong.len(), all.ended(Status::Invalid)), (300, 4, 4));
    assert_eq!(all.wrong[1].0, 104, "the line");
    // Nothing is done at once: what stands there stays.
    fs::write(&parts, "mine").unwrap();
    // One thread asks in the queries' order whether to stop.
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    let stop = |after: usize, answers: Answers<'_>| {
        let stops = Stops(AtomicUsize::new(0), after);
        let stopped = alone.install(|| vehicle.answer_file(&queries, answers, false, &stops));
        stopped.expect_err("it is stopped").to_string()
    };
    let told = stop(0, Answers::File(&parts));
    assert!(told.contains("0 of 300") && fs::read_to_string(&parts).unwrap() == "mine", "{told}");
    let told = stop(70, Answers::File(&parts));
    assert!(told.contains("of 300 queries answered") && told.contains("--resume goes on"), "{told}");
    let first = table(&parts);
    let expected = table(&whole);
    assert!(!first.is_empty() && first.len() < expected.len() && expected.starts_with(&first));
    stop(40, Answers::Resumed(&parts));
    assert!(table(&parts).len() > first.len());
    let resumed = vehicle.answer_file(&queries, Answers::Resumed(&parts), true, &Unwatched).unwrap();
    assert_eq!(table(&parts), expected);
    assert_eq!((resumed.queries, resumed.wrong.len()), (all.queries, all.wrong.len()));
    assert_eq!(Status::ALL.map(|status| resumed.ended(status)), Status::ALL.map(|status| all.ended(status)));
    // Other queries, or other tables, are not gone on with.
    fs::write(&other, text.replace("q7,", "r7,")).unwrap();
    let refused = vehicle.answer_file(&other, Answers::Resumed(&parts), false, &Unwatched).unwrap_err().to_string();
    assert!(refused.contains("line 9") && refused.contains("same queries"), "{refused}");
    fs::write(&parts, "mine\n").unwrap();
    assert!(vehicle.answer_file(&queries, Answers::Resumed(&parts), false, &Unwatched).is_err());
    assert_eq!(fs::read_to_string(&parts).unwrap(), "mine\n");
}

fn vehicle(rover: &str, reversals: bool) -> Vehicle {
    Vehicle::new(&SteerSettings { rover: rover.into(), reversals, ..SteerSettings::default() }, &Unwatched).unwrap()
}

/// A question at `speed` at both ends.
fn at(speed: f64, to: [f64; 4]) -> hairpin_formats::steering::Asked {
    let asked = Question { to, ..Question::default() }.asked();
    hairpin_formats::steering::Asked { v0: Some(speed), vf: Some(speed), ..asked }
}

#[test]
fn driven_wheels_at_their_limit_go_straight() {
    let drive = vehicle("differential-drive", false);
    let round = drive.answer(&at(0.22, [0.0, 0.3, std::f64::consts::PI, 0.0]));
    let limit = round.limit.map(|(limit, _)| limit);
    assert_eq!((round.status, limit), (Status::Infeasible, Some("wheel_speed_m_s")));
    assert_eq!(drive.answer(&at(0.22, [1.0, 0.0, 0.0, 0.0])).status, Status::Ok);
    // Half of the wheels' speed is left to turning, and a tenth of it: |κ| ≤ 12.5 and 1.39 1/m.
    for (speed, most) in [(0.11, 12.5), (0.198, 2.0 * 0.022 / (0.16 * 0.198))] {
        let bent = drive.answer(&at(speed, [0.4, 0.3, 1.5, 0.0]));
        let (_, replay) = bent.drive.as_ref().unwrap();
        assert!(bent.status == Status::Ok && replay.max_curvature <= most * (1.0 + 1e-9), "{replay:?}");
        assert!(replay.max_curvature * 0.08 * speed + speed <= 0.22 * (1.0 + 1e-9), "{replay:?}");
    }
}

#[test]
fn a_car_that_turns_back_comes_to_rest_first() {
    let (backing, plain) = (vehicle("car", true), vehicle("car", false));
    let (mut turned, mut answered) = (0, 0);
    for seed in 0..40_u64 {
        let unit = |i: u64| hairpin::math::random::hashed_unit(seed, &[i]);
        let to = [6.0 * unit(0) - 3.0, 6.0 * unit(1) - 3.0, 6.0 * unit(2) - 3.0, 0.0];
        let asked = at(if seed % 2 == 0 { 1.0 } else { 4.0 }, to);
        let drive = backing.answer(&asked);
        // To be allowed more loses nothing.
        if plain.answer(&asked).status == Status::Ok {
            answered += 1;
            assert_eq!(drive.status, Status::Ok, "seed {seed}: {to:?} {:?}", drive.limit);
        }
        let reversals = drive.drive.as_ref().map_or(0, |(_, replay)| replay.reversals);
        if drive.status != Status::Ok || reversals == 0 {
            continue;
        }
        turned += 1;
        let states = backing.follow(&asked, &drive, Rows::AsAsked).unwrap().states;
        for pair in states.windows(2) {
            let (change, time) = (pair[1].speed - pair[0].speed, pair[1].time - pair[0].time);
            assert!(change.abs() <= 9.51 * time * 1.01 + 1e-3, "seed {seed}: {change} m/s in {time} s");
        }
        let summary = backing.summary(&asked, &drive);
        let most = summary.profile.unwrap().max_acceleration_m_s2.unwrap();
        assert!(most > 1.0 && most <= 9.51 + 1e-9, "{most}");
    }
    assert!(turned > 2 && answered > 10, "{turned} {answered}");
}

#[test]
fn only_what_can_crab_is_asked_to() {
    let aside = Question { to: [3.0, 1.0, 0.2, 0.0], direction: 0.2, ..Question::default() }.asked();
    for (rover, crabs) in
        [("car", false), ("differential-drive", false), ("rocky7", false), ("rocky8", true), ("generic", true)]
    {
        let answered = vehicle(rover, false).answer(&aside);
        let refused = answered.status == Status::Infeasible && answered.limit == Some(("direction_rad", None));
        assert_eq!(refused, !crabs, "{rover}: {:?} {:?}", answered.status, answered.limit);
    }
    let turns = Question { to: [3.0, 1.0, 0.2, 0.0], direction_end: Some(0.1), ..Question::default() }.asked();
    assert_eq!(vehicle("car", false).answer(&turns).status, Status::Infeasible);
}

#[test]
fn rows_beyond_what_can_be_planned_are_told_and_queries_are_kept() {
    let place = tempfile::tempdir().unwrap();
    let path = place.path().join("q.csv");
    let text = "id,x,y,yaw,k0,kf,frame\na,4,1,0.5,0,0,\nb,1e9,1,0,0,0,\nc,4,-2e7,0,0,0,ned\n";
    fs::write(&path, text).unwrap();
    let batch = generic().answer_file(&path, Answers::Shown(&mut |_| {}), false, &Unwatched).unwrap();
    let told: Vec<String> = batch.wrong.iter().map(|(line, wrong)| format!("{line}: {wrong}")).collect();
    assert_eq!(batch.ended(Status::Invalid), 2);
    assert_eq!(
        told,
        [
            "3: x = \"1000000000\": must be finite and within ±1e6 m",
            "4: y = \"-20000000\": must be finite and within ±1e6 m"
        ]
    );
    let refused = generic().answer_file(&path, Answers::File(&path), false, &Unwatched).unwrap_err().to_string();
    assert!(refused.contains("--out") && fs::read_to_string(&path).unwrap() == text, "{refused}");
}

/// A rocker-bogie whose joints may turn by `joint` degrees.
fn rocker_bogie(joint: f64) -> String {
    format!(
        "kind = \"rover\"\nname = \"joints\"\nspeed_m_s = 0.3\n[suspension]\nkind = \"rocker-bogie\"\n\
         wheel_radius_m = 0.13\npivot_m = [0.2415, 0.40, 0.21]\nrocker_wheel_m = [0.576, 0.0, -0.25]\n\
         bogie_joint_m = [-0.2416, 0.0, -0.21]\nbogie_wheels_m = [[0.138, 0.0, -0.04], [-0.138, 0.0, -0.04]]\n\
         [limits]\ncurvature_1_m = 1.0\ncurvature_rate_1_m2 = 1.0\njoint_deg = {joint}\n"
    )
}

/// Over a bump the bogies turn, by more than one of both vehicles can.
#[test]
fn joints_are_held_to_their_limit() {
    let bump = |x: f64| if (6.0..7.0).contains(&x) { 0.15 } else { 0.0 };
    let folder = tempfile::tempdir().unwrap();
    let of = |joint: f64| {
        let file = folder.path().join(format!("{joint}.toml"));
        fs::write(&file, rocker_bogie(joint)).unwrap();
        let asked = Question { from: Some([3.0, 7.0, 0.0, 0.0]), to: [10.0, 7.0, 0.0, 0.0], ..Question::default() };
        let answered = on_map(file.to_str().unwrap(), bump).answer(&asked.asked());
        (answered.status, answered.limit)
    };
    assert_eq!(of(60.0), (Status::Ok, None));
    let (status, limit) = of(1.0);
    let (limit, over) = limit.unwrap();
    assert_eq!((status, limit), (Status::Infeasible, "joint_rad"));
    assert!((0.05..0.8).contains(&over.unwrap()), "{over:?}");
}

/// `rover` on a map of 15 m by 15 m from (0, 0) on, in cells of 0.25 m, whose heights along x (m) are `height`.
fn on_map(rover: &str, height: fn(f64) -> f64) -> Vehicle {
    on_ground(rover, |x, _| height(x))
}

/// The same of heights at x and y.
fn on_ground(rover: &str, height: impl Fn(f64, f64) -> f64) -> Vehicle {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("map.asc");
    let at = |i: u32| 0.25 * f64::from(i);
    let row = |y| (0..60).map(|column| format!("{} ", height(at(column), y))).collect::<String>() + "\n";
    let rows: String = (0..60).rev().map(|i| row(at(i))).collect();
    let head = "ncols 60\nnrows 60\nxllcenter 0\nyllcenter 0\ncellsize 0.25\nNODATA_value -9999\n";
    fs::write(&path, format!("{head}{rows}")).unwrap();
    let holes = hairpin::world::terrain::HoleRule::KeepOut;
    let georeference = hairpin_formats::terrain::Georeference { holes, ..Default::default() };
    let settings = SteerSettings { rover: rover.into(), terrain: Some((path, georeference)), ..Default::default() };
    Vehicle::new(&settings, &Unwatched).unwrap()
}

/// What a vehicle can drive around is no end of its drive, and what lies aside changes nothing.
#[test]
fn holes_in_the_way_are_gone_around() {
    let within = |x: f64, y: f64, at: [f64; 2]| (x - at[0]).abs() < 0.3 && (y - at[1]).abs() < 0.3;
    let asked = Question { from: Some([1.5, 7.0, 0.0, 0.0]), to: [13.5, 7.0, 0.0, 0.0], ..Question::default() }.asked();
    let holes: [&[[f64; 2]]; 4] = [&[[7.5, 7.0]], &[[7.5, 7.0], [7.5, 8.75]], &[[7.5, 7.0], [9.5, 5.5]], &[[8.0, 1.5]]];
    for rover in ["rocky8", "generic"] {
        let plain = on_ground(rover, |_, _| 0.0).answer(&asked);
        for (i, holes) in holes.into_iter().enumerate() {
            let missing = |x, y| holes.iter().any(|at| within(x, y, *at));
            let vehicle = on_ground(rover, |x, y| if missing(x, y) { -9999.0 } else { 0.0 });
            let answered = vehicle.answer(&asked);
            assert_eq!((answered.status, answered.limit), (Status::Ok, None), "{rover} {i}");
            assert!(answered.missed_m().unwrap() < 0.01, "{rover} {i}");
            let (solution, replay) = answered.drive.as_ref().unwrap();
            assert!((12.0..15.0).contains(&replay.length), "{rover} {i}: {} m", replay.length);
            // Without data are 0.25 m and two cells around the middle.
            for state in &vehicle.follow(&asked, &answered, Rows::Few).unwrap().states {
                let out = |at: &[f64; 2]| (state.at.x - at[0]).abs().max((state.at.y - at[1]).abs());
                assert!(holes.iter().all(|at| out(at) > 0.75), "{rover} {i}: {:?}", state.at);
            }
            let same = plain.drive.as_ref().unwrap().0.segments == solution.segments;
            assert_eq!(same, i == 3, "{rover} {i}");
        }
    }
    // A goal in a hole, and a hole from edge to edge.
    for hole in [|x: f64, y: f64| x > 13.3 && y < 8.0, |x: f64, _: f64| (6.0..7.0).contains(&x)] {
        let answered = on_ground("rocky8", |x, y| if hole(x, y) { -9999.0 } else { 0.0 }).answer(&asked);
        assert_eq!(
            (answered.status, answered.limit),
            (Status::Infeasible, Some(("no_data", None))),
            "nowhere to go around"
        );
        assert!(answered.stopped.is_some_and(|stopped| stopped.1 > 1.0));
    }
}

/// Drives went through holes, over cliffs and beyond the edge, and were `ok`.
#[test]
fn what_has_no_suspension_needs_ground_and_level_ground() {
    let level = |_: f64| 100.0;
    let hole = |x: f64| if (6.2..7.3).contains(&x) { -9999.0 } else { 0.0 };
    let cliff = |x: f64| if x < 6.2 { 0.0 } else { 20.0 * (x - 6.2) };
    let plane = |x: f64| 0.16 * x;
    let near = |x: f64| Question { from: Some([3.0, 7.0, 0.0, 0.0]), to: [x, 7.5, 0.0, 0.0], ..Question::default() };
    for rover in ["generic", "car", "differential-drive"] {
        let of = |height: fn(f64) -> f64, x: f64| {
            let (vehicle, asked) = (on_map(rover, height), near(x).asked());
            let answered = vehicle.answer(&asked);
            (answered.status, answered.limit.map(|(limit, _)| limit))
        };
        assert_eq!(of(level, 10.0), (Status::Ok, None), "{rover}");
        assert_eq!(of(hole, 10.0), (Status::Infeasible, Some("no_data")), "{rover}");
        assert_eq!(of(cliff, 10.0), (Status::Infeasible, Some("slope_rad")), "{rover}");
        assert_eq!(of(plane, 10.0), (Status::Infeasible, Some("slope_rad")), "{rover}");
        assert_eq!(of(level, 100.0), (Status::Infeasible, Some("map_edge")), "{rover}");
    }
    let vehicle = on_map("generic", level);
    let asked = near(10.0).asked();
    let states = vehicle.follow(&asked, &vehicle.answer(&asked), Rows::Few).unwrap().states;
    assert!(states.iter().all(|state| (state.settled.z - 100.0).abs() < 1e-6), "it drives on the ground");
    // By the slope itself: atan 0.16 rad, of which 0.01 count as level.
    let steep = on_map("generic", plane).answer(&asked);
    let (_, excess) = steep.limit.unwrap();
    assert!((excess.unwrap() - (0.16f64.atan() - 0.01)).abs() < 1e-3, "{excess:?}");
}
