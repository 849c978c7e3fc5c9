use hairpin::trajectory::{Ended, Flight, Track};
use nalgebra::Isometry3;

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
