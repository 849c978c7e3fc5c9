//! Other controls than the usual one, crabs, and places to keep out of.

use allocation_counter::measure;
use hairpin::feasibility::steering::shooting::Control;
use hairpin_c::clear::KeepOutPlace;
use hairpin_c::drive::{HAIRPIN_INFEASIBLE, HAIRPIN_SOLVED, State};
use hairpin_c::settings::{
    HAIRPIN_CONTROL_ARC, HAIRPIN_CONTROL_CUBIC, HAIRPIN_CONTROL_KNOTS, HAIRPIN_CONTROL_QUINTIC,
    HAIRPIN_CONTROL_TIME_POLYNOMIAL, HAIRPIN_CONTROL_TURN_DRIVE_TURN, HAIRPIN_CONTROL_VELOCITY_POLYNOMIAL,
    SteerSettings, hairpin_steer_defaults,
};
use hairpin_formats::steering::{Asked, Status};
use hairpin_jobs::steer::Vehicle;

use crate::called::{Steerer, name, nothing};
use crate::drives::{HERE, asked, bits, bits_of, file, hills, on_the_hills, rover};

/// Questions that a vehicle answers which drives sideways, its heading as it was.
fn sideways() -> Vec<(State, State)> {
    let goal = |i: f64| State { x_m: 3.0 + 0.2 * i, y_m: 2.0 + 0.1 * i, yaw_rad: 0.02 * i, curvature_1_m: 0.0 };
    (0..6).map(f64::from).map(|i| (HERE, goal(i))).collect()
}

#[test]
fn other_controls_and_crabs_are_those_of_the_command_too() {
    let controls = [
        (HAIRPIN_CONTROL_ARC, Control::Arc),
        (HAIRPIN_CONTROL_CUBIC, Control::Cubic),
        (HAIRPIN_CONTROL_TIME_POLYNOMIAL, Control::TimePolynomial),
        (HAIRPIN_CONTROL_KNOTS, Control::Knots),
        (HAIRPIN_CONTROL_VELOCITY_POLYNOMIAL, Control::VelocityPolynomial),
        (HAIRPIN_CONTROL_QUINTIC, Control::Quintic),
    ];
    for (number, control) in controls {
        let (direction_rad, swing_rad) = if number == HAIRPIN_CONTROL_QUINTIC { (0.5, 0.25) } else { (0.0, 0.0) };
        let settings = SteerSettings { control: number, direction_rad, swing_rad, ..hairpin_steer_defaults() };
        let ours = Steerer::new(&file("generic"), None, &settings);
        let mut command = Vehicle::on(rover("generic"), None, None);
        command.pace.control = control;
        let (mut solved, mut compared) = (0, 0);
        for (start, goal) in sideways() {
            let found = ours.ask(&start, &goal);
            let asked = asked(&start, [goal.x_m, goal.y_m, goal.yaw_rad], 0.0);
            let direction_end = Some(direction_rad + swing_rad);
            let theirs = command.answer(&Asked { direction: direction_rad, direction_end, ..asked });
            assert_eq!(found.status == HAIRPIN_SOLVED, theirs.status == Status::Ok, "{number}: {}", name(&found.limit));
            let limit = theirs.limit.map_or(String::new(), |(limit, _)| limit.to_owned());
            assert_eq!(name(&found.limit), limit, "{number}");
            let Some((solution, replay)) = theirs.drive else { continue };
            // The command goes on to nearby goals where the exact one takes a long way round.
            if replay.length == found.length_m {
                assert_eq!(bits(&found), bits_of(&solution.segments), "{number}");
                compared += 1;
            }
            solved += usize::from(found.status == HAIRPIN_SOLVED);
        }
        // An arc chooses neither heading nor curvature, and a cubic has no parameter to spare for the bounds.
        let spare = ![HAIRPIN_CONTROL_ARC, HAIRPIN_CONTROL_CUBIC].contains(&number);
        assert!(compared > 3 && (solved > 0) == spare, "{number}: {compared} {solved}");
    }
}

#[test]
fn places_are_gone_around_or_told() {
    let (grid, heights) = hills();
    let plane = Steerer::new(&file("generic"), None, &hairpin_steer_defaults());
    let ground = Steerer::new(&file("rocky8"), Some((&grid, &heights)), &hairpin_steer_defaults());
    let disc =
        |x: f64, y: f64, radius_m: f64| KeepOutPlace { center_m: [x, y], radius_m, corners_m: nothing(), corners: 0 };
    let corners = [2.0, -0.5, 3.0, -0.5, 2.5, 0.5];
    let triangle = KeepOutPlace { corners_m: corners.as_ptr(), corners: 3, ..disc(0.0, 0.0, 0.0) };
    let (start, goal) = (State { x_m: 6.0, y_m: 10.0, ..HERE }, State { x_m: 16.0, y_m: 10.0, ..HERE });
    let rock = disc(11.0, 10.0, 0.2);
    let ahead = State { x_m: 6.0, ..HERE };
    for (steer, start, goal, place) in [
        (&plane, &HERE, &ahead, disc(3.0, 0.0, 0.5)),
        (&plane, &HERE, &ahead, triangle),
        (&ground, &start, &goal, rock),
    ] {
        let (straight, around) = (steer.ask(start, goal), steer.ask_clear_of(&[place], start, goal));
        assert_eq!((straight.status, around.status), (HAIRPIN_SOLVED, HAIRPIN_SOLVED), "{}", name(&around.limit));
        assert!(around.length_m > straight.length_m, "{} {}", around.length_m, straight.length_m);
        // Without a place it is the same call.
        assert_eq!(bits(&steer.ask_clear_of(&[], start, goal)), bits(&straight));
    }
    // On top of the goal there is no way around.
    let on = plane.ask_clear_of(&[disc(6.0, 0.0, 0.5)], &HERE, &ahead);
    assert_eq!((on.status, name(&on.limit)), (HAIRPIN_INFEASIBLE, "keep_out".into()));
    assert!(on.excess > 0.0 && on.excess <= 0.5 + 1e-6, "{}", on.excess);
}

#[test]
fn none_of_them_takes_from_the_heap() {
    let (grid, heights) = hills();
    for control in 0..7 {
        if control == HAIRPIN_CONTROL_TURN_DRIVE_TURN {
            continue;
        }
        let settings = SteerSettings { control, direction_rad: 0.2, swing_rad: 0.1, ..hairpin_steer_defaults() };
        let plane = Steerer::new(&file("generic"), None, &settings);
        let ground = Steerer::new(&file("rocky8"), Some((&grid, &heights)), &settings);
        let (flat, hilly) = (sideways(), on_the_hills());
        let heap = measure(|| {
            plane.ask(&flat[0].0, &flat[0].1);
            ground.ask(&hilly[1].0, &hilly[1].1);
        });
        assert_eq!(heap.count_total, 0, "{control}: {heap:?}");
    }
}
