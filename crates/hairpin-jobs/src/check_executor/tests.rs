use hairpin::trajectory::{Ended, Flight, Track};
use nalgebra::Isometry3;

use super::flown::tell;
use super::*;
use crate::Unwatched;

#[test]
fn what_cannot_be_started_is_told_and_the_rest_not_checked() {
    let settings =
        CheckExecutorSettings { command: "hairpin-no-such-program".into(), ..CheckExecutorSettings::default() };
    let checked = check_executor(&settings, &Unwatched).unwrap();
    let words: Vec<&str> = checked.steps.iter().map(Step::word).collect();
    assert_eq!(
        words,
        ["mistake", "not-checked", "not-checked", "not-checked", "not-checked", "not-checked", "not-checked"]
    );
    assert!(checked.verdict.exit_code == 4 && checked.greeting.is_none());
    let empty = CheckExecutorSettings { command: " ".into(), ..settings };
    assert!(matches!(check_executor(&empty, &Unwatched), Err(Problem::Scenario(_) | Problem::Input(_))));
}

#[test]
fn flights_are_compared_to_the_bit() {
    let flight = |places: &[f64]| {
        let times = (0..places.len()).map(|i| i as f64).collect();
        let poses = places.iter().map(|x| Isometry3::translation(*x, 0.0, 0.0)).collect();
        let track = Track::new(times, poses, Vec::new()).unwrap();
        Flight { track, ended: Ended::Done, left_world: None, reached: Vec::new() }
    };
    let first = flight(&[0.0, 1.0, 2.0]);
    assert!(Difference::between(&first, &flight(&[0.0, 1.0, 2.0])).same);
    let other = Difference::between(&first, &flight(&[0.0, 1.0 + f64::EPSILON, 2.0]));
    assert!(!other.same && other.position_m > 0.0 && other.at_s == 1.0, "{other:?}");
    let shorter = Difference::between(&first, &flight(&[0.0, 1.5]));
    assert_eq!((shorter.same, shorter.poses, shorter.position_m, shorter.at_s), (false, [3, 2], 0.5, 1.0));
}

/// A program that says `done` and was not everywhere, or was too late.
#[test]
fn each_waypoint_that_was_left_out_is_told_and_so_is_who_comes_late() {
    let strict = vec![("spec.deviation.max_m".to_owned(), "0.5".to_owned())];
    let settings = CheckExecutorSettings { command: "true".into(), sets: strict, ..CheckExecutorSettings::default() };
    let setup = setup_of(&settings, &Unwatched).unwrap();
    let mission = a_mission(&setup, &settings, &Unwatched).unwrap();
    assert_eq!(mission.waypoints.len(), 4);
    // Straight from waypoint to waypoint of those that are visited, fifty poses each.
    let flown = |visited: &[usize], ended: Ended, end: f64, reached: Vec<Option<f64>>| {
        let places: Vec<Isometry3<f64>> = visited
            .windows(2)
            .flat_map(|pair| {
                let (a, b) = (mission.waypoints[pair[0]], mission.waypoints[pair[1]]);
                (0..50).map(move |k| a + (b - a) * (f64::from(k) / 49.0))
            })
            .map(|p| Isometry3::translation(p.x, p.y, p.z))
            .collect();
        let times = (0..places.len()).map(|k| end * k as f64 / places.len() as f64).collect();
        let track = Track::new(times, places, Vec::new()).unwrap();
        let mut step = Step::new("mission");
        tell(&mut step, &mission, &Flight { track, ended, left_world: None, reached }, 0.1);
        step.mistakes().map(str::to_owned).collect::<Vec<_>>()
    };
    // As far as nothing else is near: whichever of the mission's waypoints are.
    let far = |k: usize| (mission.waypoints[k] - mission.waypoints[k - 1]).norm() > 2.0 * mission.accept;
    assert!((1..4).all(far), "{:?}", mission.waypoints);
    let all = vec![Some(0.0), Some(1.0), Some(2.0), Some(3.0)];
    assert_eq!(flown(&[0, 1, 2, 3], Ended::Done, 10.0, all), Vec::<String>::new());
    let told = flown(&[0, 2, 3], Ended::Done, 10.0, vec![Some(0.0), None, Some(2.0), Some(3.0)]);
    assert!(told.len() == 1 && told[0].contains("waypoint 1 of 0 to 3 was never reached: "), "{told:?}");
    let told = flown(&[0, 3], Ended::Done, 10.0, vec![Some(0.0), None, None, Some(3.0)]);
    assert!(told.len() == 2 && told[1].contains("waypoint 2 of 0 to 3 was never reached: "), "{told:?}");
    let told = flown(&[0, 1, 2, 3], Ended::Time, 1.2 * mission.time_limit, vec![Some(0.0), Some(1.0), Some(2.0), None]);
    assert!(
        told.len() == 1 && told[0].starts_with("comes to the last waypoint only after time_limit_s = "),
        "{told:?}"
    );
}
