use super::*;
use crate::feasibility::steering::shooting::flat;
use crate::feasibility::steering::shooting::query::{Curvatures, Precision, Query};
use crate::math::random::hashed_unit;
use crate::robot::rover::{Response, Rover, RoverDescription, Slip, Unsettled};
use crate::trajectory::drive::{Gear, Motion, Planar, Segment, SegmentList};
use crate::world::terrain::generate::{Recipe, generate};
use crate::world::terrain::{ElevationMap, Flat, Function, Grid, HoleRule, NoGround, Patch};

fn shipped(name: &str) -> Rover {
    let path = format!("{}/../../data/robots/rover/{name}.toml", env!("CARGO_MANIFEST_DIR"));
    let text = std::fs::read_to_string(path).expect("a shipped rover");
    toml::from_str::<RoverDescription>(&text).expect("its keys").build().expect("its numbers")
}

fn course<'a, T>(rover: &'a Rover, terrain: &'a T) -> Course<'a, T> {
    Course { rover, terrain, speed: rover.default_speed.into(), direction: 0.0.into(), steps: Steps::default() }
}

fn fine<'a, T>(rover: &'a Rover, terrain: &'a T) -> Course<'a, T> {
    Course { steps: Steps { length: 0.002, angle: 0.002, least: 50 }, ..course(rover, terrain) }
}

fn yard() -> ElevationMap {
    generate(&Recipe {
        size_m: 30.0,
        relief_m: 0.5,
        rock_cover: 0.0,
        crater_area_m2: 40.0,
        seed: 3,
        ..Recipe::default()
    })
    .expect("a yard")
}

fn bounds(rover: &Rover) -> Curvatures {
    Curvatures { most: rover.limits.curvature, most_rate: rover.limits.curvature_rate }
}

fn flat_solver(rover: &Rover) -> impl FnMut(&Query) -> Option<SegmentList> {
    let bounds = bounds(rover);
    let fine = Precision { position: 1e-5, yaw: 1e-5, curvature: 1e-5 };
    let settings = flat::Settings { precision: fine, ..flat::Settings::default() };
    move |query| {
        let query = Query::new(query.start_curvature, query.goal, &bounds).ok()?;
        let answer = flat::forward(&query, &bounds, &settings);
        (answer.status == flat::Status::Ok).then_some(answer.segments)
    }
}

/// A smooth curve within ±0.8 1/m.
fn random_arc(seed: u64, length_m: f64) -> Segment {
    let unit = |i: u64| 2.0 * hashed_unit(seed, &[i]) - 1.0;
    let (a, b) = (0.4 * unit(0), 0.4 * unit(1) / length_m);
    Segment { motion: Motion::Arc { length_m, curvature: [a, b, 0.0, 0.0, 0.0, 0.0] }, gear: Gear::Forward }
}

fn difference(a: &Planar, b: &Planar) -> f64 {
    let yaw = a.yaw - b.yaw;
    (a.x - b.x).hypot(a.y - b.y).max(yaw.sin().atan2(yaw.cos()).abs())
}

#[test]
fn up_a_plane_the_ground_covered_shrinks_by_the_cosine() {
    let slope = Function(|x: f64, _y: f64| Patch { height: 0.5 * x, slope: [0.5, 0.0], bend: [0.0; 3] });
    let rover = shipped("rocky8");
    let level = rover.suspension.settle_cold(&Flat, [0.0; 3]).expect("rest").0.pitch;
    let drive = [Segment::straight(4.0, Gear::Forward)];
    let end = predict(&course(&rover, &slope), &Planar::default(), &drive, |_| {}).expect("a way").end;
    // The body leans by its own pitch on level ground as well.
    let expected = 4.0 * (0.5_f64.atan() - level).cos();
    assert!((end.x - expected).abs() < 1e-9 && end.y.abs() < 1e-9, "{end:?}, not {expected}");
}

#[test]
fn in_the_plane_a_clothoid_and_a_turn_end_as_in_closed_form() {
    let rover = shipped("generic");
    let pi = std::f64::consts::PI;
    // κ = πs over 1 m: Fresnel's integrals.
    let clothoid = [Segment::clothoid(1.0, 0.0, pi, Gear::Forward)];
    let end = predict(&fine(&rover, &Flat), &Planar::default(), &clothoid, |_| {}).expect("a way").end;
    assert!((end.x - 0.779_893_4).abs() < 1e-5 && (end.y - 0.438_259_1).abs() < 1e-5, "{end:?}");
    let turn = [
        Segment { motion: Motion::Turn { angle_rad: pi / 2.0 }, gear: Gear::Forward },
        Segment::straight(2.0, Gear::Reverse),
    ];
    let end = predict(&course(&rover, &Flat), &Planar::default(), &turn, |_| {}).expect("a way").end;
    assert!(end.x.abs() < 1e-12 && (end.y + 2.0).abs() < 1e-12 && (end.yaw - pi / 2.0).abs() < 1e-12, "{end:?}");
}

#[test]
fn coarse_steps_agree_with_fine_ones_within_a_tenth_of_the_precision() {
    let yard = yard();
    for name in ["rocky8", "rocky7", "four-wheel"] {
        let rover = shipped(name);
        let mut worst = 0.0_f64;
        for seed in 0..60 {
            let unit = |i: u64| hashed_unit(seed, &[100 + i]);
            let start = Planar { x: 8.0 + 14.0 * unit(0), y: 8.0 + 14.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
            let drive = [random_arc(seed, 1.0 + 5.0 * unit(3))];
            let coarse = predict(&course(&rover, &yard), &start, &drive, |_| {});
            let fine = predict(&fine(&rover, &yard), &start, &drive, |_| {});
            let (Ok(coarse), Ok(fine)) = (coarse, fine) else { continue };
            worst = worst.max(difference(&coarse.end, &fine.end));
        }
        assert!(worst < 1e-3, "{name}: {worst}");
    }
}

#[test]
fn goals_that_were_driven_are_found_again_on_rough_ground() {
    let (yard, rover) = (yard(), shipped("rocky8"));
    let (mut asked, mut found, mut predictions) = (0, 0, 0);
    for seed in 0..200 {
        let unit = |i: u64| hashed_unit(seed, &[200 + i]);
        let drive = [random_arc(seed, 1.0 + 5.0 * unit(3))];
        let at = Planar { x: 8.0 + 14.0 * unit(0), y: 8.0 + 14.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
        let start = Planar { curvature: drive[0].curvature_at(0.0), ..at };
        let Ok(driven) = predict(&fine(&rover, &yard), &start, &drive, |_| {}) else { continue };
        if driven.tilt.0 > 0.52 {
            continue;
        }
        asked += 1;
        let answer = solve(
            &course(&rover, &yard),
            &start,
            &driven.end,
            &bounds(&rover),
            &Settings::default(),
            &mut flat_solver(&rover),
        );
        predictions += answer.iterations;
        let replayed = predict(&fine(&rover, &yard), &start, &answer.segments, |_| {});
        let met = replayed.is_ok_and(|r| difference(&r.end, &driven.end) < 0.01);
        assert!(answer.status != Status::Ok || met, "seed {seed}: {answer:?}");
        found += usize::from(answer.status == Status::Ok);
    }
    println!("{found} of {asked} found with {:.1} predictions each", f64::from(predictions) / asked as f64);
    assert!(asked > 100 && found * 1000 >= asked * 990, "{found} of {asked}");
}

#[test]
fn slip_delay_and_lag_are_met_as_well() {
    let yard = yard();
    let rover = Rover {
        slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 },
        response: Response {
            latency: 0.2,
            steering_time_constant: 0.2,
            steering_rate: 30.0_f64.to_radians(),
            steered_axle: 0.47,
            ..Response::default()
        },
        ..shipped("rocky8")
    };
    let (mut asked, mut found, mut bent) = (0, 0, 0);
    for seed in 0..200 {
        let unit = |i: u64| hashed_unit(seed, &[300 + i]);
        let drive = [random_arc(seed, 2.0 + 4.0 * unit(3))];
        let at = Planar { x: 9.0 + 12.0 * unit(0), y: 9.0 + 12.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
        let start = Planar { curvature: drive[0].curvature_at(0.0), ..at };
        let Ok(driven) = predict(&fine(&rover, &yard), &start, &drive, |_| {}) else { continue };
        if driven.tilt.0 > 0.52 {
            continue;
        }
        asked += 1;
        let answer = solve(
            &course(&rover, &yard),
            &start,
            &driven.end,
            &bounds(&rover),
            &Settings::default(),
            &mut flat_solver(&rover),
        );
        found += usize::from(answer.status == Status::Ok);
        let met = |p: &Prediction| difference(&p.end, &driven.end) < 0.01;
        assert!(answer.status != Status::Ok || answer.prediction.is_some_and(|p| met(&p)), "seed {seed}: {answer:?}");
        bent += usize::from(answer.iterations > 8);
        for segment in answer.segments.iter() {
            let (step, Curvatures { most, most_rate }) = (segment.length_m() / 50.0, bounds(&rover));
            let at = |i: i32| segment.curvature_at(step * f64::from(i));
            let kept = (0..=50).all(|i| at(i).abs() <= most * (1.0 + 1e-8));
            let rate_kept = (0..50).all(|i| (at(i + 1) - at(i)).abs() <= most_rate * step * (1.0 + 1e-8) + 1e-12);
            assert!(kept && rate_kept, "seed {seed}: {segment:?}");
        }
    }
    println!("{found} of {asked} found, {bent} of them with many predictions");
    assert!(asked > 50 && bent > 0 && found * 1000 >= asked * 995, "{found} of {asked}, {bent}");
}

#[test]
fn on_level_ground_the_flat_answer_is_the_answer() {
    let rover = shipped("generic");
    let goal = Planar { x: 4.0, y: 1.0, yaw: 0.5, curvature: 0.0 };
    let answer = solve(
        &course(&rover, &Flat),
        &Planar::default(),
        &goal,
        &bounds(&rover),
        &Settings::default(),
        &mut flat_solver(&rover),
    );
    // One prediction finds it, and nothing on its way asks for another look.
    assert_eq!((answer.status, answer.iterations), (Status::Ok, 1));
    let flat = flat_solver(&rover)(&Query {
        start_curvature: 0.0,
        goal: crate::feasibility::steering::shooting::Goal { x: 4.0, y: 1.0, yaw: 0.5, curvature: 0.0 },
    });
    assert_eq!(Some(answer.segments), flat);
}

#[test]
fn ground_that_ends_is_said() {
    let (yard, rover) = (yard(), shipped("rocky8"));
    let start = Planar { x: 28.0, y: 15.0, yaw: 0.0, curvature: 0.0 };
    let goal = Planar { x: 34.0, ..start };
    let answer =
        solve(&course(&rover, &yard), &start, &goal, &bounds(&rover), &Settings::default(), &mut flat_solver(&rover));
    assert!(matches!(answer.status, Status::Blocked(_)), "{answer:?}");
    let nothing = Planar { x: f64::NAN, ..start };
    assert!(predict(&course(&rover, &yard), &nothing, &[random_arc(0, 1.0)], |_| {}).is_err());
}

#[test]
fn whenever_it_ends_the_best_so_far_is_no_worse_than_before() {
    let (yard, rover) = (yard(), shipped("rocky8"));
    let rover = Rover { response: Response { latency: 0.2, ..rover.response }, ..rover };
    let course = course(&rover, &yard);
    let (mut bent, mut asked) = (0, 0);
    for seed in 0..40 {
        let unit = |i: u64| hashed_unit(seed, &[400 + i]);
        let start = Planar { x: 9.0 + 12.0 * unit(0), y: 9.0 + 12.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
        // Goals at the rim of what a forward drive can do.
        let (sin, cos) = start.yaw.sin_cos();
        let goal = Planar {
            x: start.x + 1.8 * cos - (1.0 + unit(3)) * sin,
            y: start.y + 1.8 * sin + (1.0 + unit(3)) * cos,
            yaw: start.yaw + 1.5 * unit(4),
            curvature: 0.0,
        };
        let mut last = f64::INFINITY;
        for budget in [0, 1, 2, 3, 4, 5, 7, 9, 12, 16, 22, 30, 45, 60, 90, 200] {
            let asked_before = std::cell::Cell::new(0);
            let over = || {
                asked_before.set(asked_before.get() + 1);
                asked_before.get() > budget
            };
            let settings = Settings::default();
            let mut steer = flat_solver(&rover);
            let answer = solve_until(&course, &start, &goal, &bounds(&rover), &settings, &mut steer, &over);
            assert!(answer.iterations <= budget + 1, "seed {seed}: {} predictions after {budget}", answer.iterations);
            bent += u32::from(answer.iterations > 30);
            let residual = match answer.status {
                Status::Ok => 0.2,
                Status::NotConverged { residual } => residual,
                Status::Blocked(_) | Status::Unreachable => f64::INFINITY,
            };
            if last.is_finite() {
                asked += 1;
                assert!(residual <= last.max(0.8), "seed {seed}, {budget} predictions: {residual} after {last}");
            }
            last = residual;
        }
    }
    assert!(asked > 300 && bent > 0, "{asked} asked, {bent} bent");
}

#[test]
fn a_drive_that_begins_in_reverse_stands_until_its_first_command_acts() {
    let (yard, rover) = (yard(), shipped("rocky8"));
    let rover = Rover { response: Response { latency: 0.5, ..rover.response }, ..rover };
    let course = Course { speed: 0.3.into(), ..course(&rover, &yard) };
    let start = Planar { x: 15.0, y: 15.0, yaw: 0.4, curvature: 0.1 };
    assert_eq!(Waiting::Stands.over(&course, &start), Ok(start));
    let on = Waiting::GoesOn.over(&course, &start).expect("a way");
    assert!((on.x - start.x).hypot(on.y - start.y) > 0.12 && on.curvature == start.curvature, "{on:?}");
    let bounds = bounds(&rover);
    let mirrored = |query: &Query| {
        let goal = query.goal;
        let asked = crate::feasibility::steering::shooting::Goal { x: -goal.x, yaw: -goal.yaw, ..goal };
        flat_solver(&rover)(&Query { goal: asked, ..*query }).map(|mut segments| {
            segments.iter_mut().for_each(|segment| segment.gear = Gear::Reverse);
            segments
        })
    };
    let goal = Planar { x: 12.2, y: 14.2, yaw: 0.5, curvature: 0.0 };
    let answer = solve(&course, &start, &goal, &bounds, &Settings::default(), &mut { mirrored });
    assert_eq!(answer.status, Status::Ok);
    assert!(answer.segments.iter().all(|segment| segment.gear == Gear::Reverse), "{:?}", answer.segments);
    // Nothing is driven before and nothing is commanded after.
    let end = predict(&course, &start, &answer.segments, |_| {}).expect("a way").end;
    assert!(difference(&end, &goal) < 0.01, "{end:?}");
}

#[test]
fn costs_fall_and_goals_and_bounds_stay() {
    let yard = yard();
    let rover = Rover { slip: Slip { at_20_deg: 0.3, side_at_20_deg: 0.15 }, ..shipped("rocky8") };
    let course = course(&rover, &yard);
    let total = |cost: GroundCost, start: &Planar, segments: &SegmentList| {
        let mut along = super::cost::Along::new(&course, cost, segments);
        predict(&course, start, segments, |driven| along.add(driven)).expect("a way");
        along.total()
    };
    let mut all = 0;
    for cost in [GroundCost::Curvature, GroundCost::Rate, GroundCost::Tilt, GroundCost::Slip, GroundCost::Energy] {
        let (mut asked, mut cheaper, mut saved) = (0, 0, 0.0);
        for seed in 0..12 {
            let unit = |i: u64| hashed_unit(seed, &[500 + i]);
            let drive = [random_arc(seed, 3.0 + 3.0 * unit(3))];
            let at = Planar { x: 9.0 + 12.0 * unit(0), y: 9.0 + 12.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
            let start = Planar { curvature: drive[0].curvature_at(0.0), ..at };
            let Ok(driven) = predict(&fine(&rover, &yard), &start, &drive, |_| {}) else { continue };
            let ask = |cost| {
                let settings = Settings { cost, ..Settings::default() };
                solve(&course, &start, &driven.end, &bounds(&rover), &settings, &mut flat_solver(&rover))
            };
            let (plain, cheap) = (ask(GroundCost::Any), ask(cost));
            if plain.status != Status::Ok {
                continue;
            }
            asked += 1;
            assert_eq!(cheap.status, Status::Ok, "seed {seed}");
            let (before, after) = (total(cost, &start, &plain.segments), total(cost, &start, &cheap.segments));
            assert!(after <= before * (1.0 + 1e-12), "{cost:?}, seed {seed}: {after} after {before}");
            saved += 1.0 - after / before;
            cheaper += usize::from(after < 0.995 * before);
            let end = predict(&fine(&rover, &yard), &start, &cheap.segments, |_| {}).expect("a way").end;
            assert!(difference(&end, &driven.end) < 0.01, "{cost:?}, seed {seed}: {end:?}");
            for segment in cheap.segments.iter() {
                let Curvatures { most, most_rate } = bounds(&rover);
                let step = segment.length_m() / 50.0;
                let at = |i: i32| segment.curvature_at(step * f64::from(i));
                assert!((0..=50).all(|i| at(i).abs() <= most * (1.0 + 1e-8)), "{cost:?}, seed {seed}");
                assert!((0..50).all(|i| (at(i + 1) - at(i)).abs() <= most_rate * step * (1.0 + 1e-8) + 1e-12));
            }
        }
        println!("{cost:?}: {cheaper} of {asked} cheaper, {:.1} % in the mean", 100.0 * saved / f64::from(asked));
        all += cheaper;
        assert!(asked >= 8, "{cost:?}: {asked}");
    }
    assert!(all >= 15, "{all} of 60 cheaper");
}

#[test]
fn on_mirrored_ground_mirrored_goals_have_mirrored_drives() {
    let (yard, rover) = (yard(), shipped("rocky8"));
    // South and north change places about the middle row.
    let grid = *yard.grid();
    let heights: Vec<f32> = (0..grid.rows)
        .flat_map(|row| (0..grid.columns).map(move |column| (row, column)))
        .map(|(row, column)| yard.cell_height(row, column))
        .collect();
    let mirrored = ElevationMap::new(grid, &heights, HoleRule::Error).expect("a map");
    let (low, high) = yard.extent();
    let across = |place: &Planar| Planar {
        y: low[1] + high[1] - place.y,
        yaw: -place.yaw,
        curvature: -place.curvature,
        ..*place
    };
    let ask = |map: &ElevationMap, start: &Planar, goal: &Planar| {
        solve(&course(&rover, map), start, goal, &bounds(&rover), &Settings::default(), &mut flat_solver(&rover))
    };
    let mut found = 0;
    for seed in 0..40 {
        let unit = |i: u64| hashed_unit(seed, &[600 + i]);
        let drive = [random_arc(seed, 1.0 + 5.0 * unit(3))];
        let at = Planar { x: 8.0 + 14.0 * unit(0), y: 8.0 + 14.0 * unit(1), yaw: 6.0 * unit(2), curvature: 0.0 };
        let start = Planar { curvature: drive[0].curvature_at(0.0), ..at };
        let Ok(driven) = predict(&fine(&rover, &yard), &start, &drive, |_| {}) else { continue };
        let (left, right) = (ask(&yard, &start, &driven.end), ask(&mirrored, &across(&start), &across(&driven.end)));
        if left.status != Status::Ok {
            continue;
        }
        found += 1;
        assert_eq!((left.status, left.iterations), (right.status, right.iterations), "seed {seed}");
        assert_eq!(left.segments.len(), right.segments.len(), "seed {seed}");
        for (a, b) in left.segments.iter().zip(right.segments.iter()) {
            let same = (a.length_m() - b.length_m()).abs() < 1e-6
                && (0..=10).all(|i| {
                    let s = 0.1 * f64::from(i) * a.length_m();
                    (a.curvature_at(s) + b.curvature_at(s)).abs() < 1e-6
                });
            assert!(same, "seed {seed}: {a:?} {b:?}");
        }
        let ends = [left.prediction, right.prediction].map(|prediction| prediction.expect("a motion").end);
        assert!(difference(&across(&ends[0]), &ends[1]) < 1e-6, "seed {seed}: {ends:?}");
    }
    assert!(found >= 25, "{found}");
}

#[test]
fn maps_are_handed_over_in_memory_with_what_is_unknown() {
    // Rows from the north, heights in metres, a mask of unknown cells as no numbers.
    let grid = Grid { columns: 120, rows: 80, first_center: [100.0, 50.0], cell: [0.1, 0.1] };
    let unknown = |x: f64, y: f64| (105.0..105.6).contains(&x) && y < 54.0;
    let heights: Vec<f32> = (0..grid.rows)
        .rev()
        .flat_map(|row| (0..grid.columns).map(move |column| (100.0 + 0.1 * column as f64, 50.0 + 0.1 * row as f64)))
        .map(|(x, y)| if unknown(x, y) { f32::NAN } else { (0.05 * x + 0.1 * (1.3 * y).sin()) as f32 })
        .collect();
    let map = ElevationMap::new(grid, &heights, HoleRule::KeepOut).expect("a map");
    let rover = shipped("rocky7");
    let start = Planar { x: 102.0, y: 52.0, yaw: 0.0, curvature: 0.0 };
    let ask = |goal: &Planar| {
        solve(&course(&rover, &map), &start, goal, &bounds(&rover), &Settings::default(), &mut flat_solver(&rover))
    };
    let beside = ask(&Planar { x: 104.0, y: 52.5, yaw: 0.3, curvature: 0.0 });
    assert_eq!(beside.status, Status::Ok, "{beside:?}");
    let through = ask(&Planar { x: 108.0, y: 52.0, yaw: 0.0, curvature: 0.0 });
    let Status::Blocked(Blocked { cause: Cause::Unsettled(Unsettled::NoGround(NoGround::Hole { x, .. })), .. }) =
        through.status
    else {
        panic!("{:?}", through.status)
    };
    assert!((104.8..105.8).contains(&x), "{x}");
    // The mask's holes are filled where that was asked for.
    let filled = ElevationMap::new(grid, &heights, HoleRule::Fill).expect("a map");
    let goal = Planar { x: 108.0, y: 52.0, yaw: 0.0, curvature: 0.0 };
    let over =
        solve(&course(&rover, &filled), &start, &goal, &bounds(&rover), &Settings::default(), &mut flat_solver(&rover));
    assert!(over.status == Status::Ok && filled.is_filled(105.3, 52.0), "{over:?}");
}
