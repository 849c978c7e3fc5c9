use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use hairpin::campaign::answers::{Answer, Executed};
use hairpin_formats::executor::Greeting;

use super::*;

const QUICK: Pace = Pace { beat: Duration::from_millis(10), patience: Duration::from_millis(150) };

/// Asks for three rounds, each of which depends on the answers to the one before, and counts what it executes itself.
fn search(rounds: &Rounds, executed: &AtomicUsize, most: usize) -> Vec<f64> {
    let mut state = 1.0;
    let mut all = Vec::new();
    for round in 0..3_u8 {
        let names: Vec<[u8; 16]> = (0..20).map(|place| [round * 50 + place; 16]).collect();
        let execute = |place: usize| -> Option<Answer> {
            if executed.fetch_add(1, Ordering::Relaxed) >= most {
                return None;
            }
            sleep(Duration::from_millis(1));
            let stress = (state * (place as f64 + 1.7)).sin();
            Some((place % 7 != 3).then(|| Executed {
                trials: vec![(stress, place, 1)],
                behaviour: vec![state],
                fails: false,
            }))
        };
        let stopped = || executed.load(Ordering::Relaxed) > most || rounds.is_in_trouble();
        let answers = rounds.carry_out(&Batch { names: &names, execute: &execute }, &stopped);
        let known: Vec<f64> =
            answers.iter().flatten().map(|answer| answer.as_ref().map_or(-1.0, |ran| ran.trials[0].0)).collect();
        state += known.iter().sum::<f64>();
        all.extend(known);
    }
    all
}

fn joined(folder: &Path, place: u64) -> Rounds {
    Rounds::join(folder, (place, 3), false, QUICK).unwrap()
}

#[test]
fn what_three_share_is_what_one_comes_to_and_nothing_is_executed_twice() {
    let [alone, shared] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let expected = search(&joined(alone.path(), 0), &AtomicUsize::new(0), usize::MAX);
    assert_eq!(expected.len(), 60);
    let counts = [(); 3].map(|()| AtomicUsize::new(0));
    std::thread::scope(|scope| {
        for (place, count) in counts.iter().enumerate() {
            let (folder, expected) = (shared.path(), &expected);
            scope.spawn(move || assert_eq!(&search(&joined(folder, place as u64), count, usize::MAX), expected));
        }
    });
    let counts = counts.map(AtomicUsize::into_inner);
    assert_eq!(counts.iter().sum::<usize>(), 60, "{counts:?}");
    // One that comes late executes nothing, and nobody says any more to be alive.
    let late = AtomicUsize::new(0);
    assert_eq!(search(&joined(shared.path(), 1), &late, usize::MAX), expected);
    assert_eq!(late.into_inner(), 0);
    let names = fs::read_dir(shared.path()).unwrap().map(|entry| entry.unwrap().file_name());
    assert!(names.map(|name| name.to_string_lossy().into_owned()).all(|name| !name.starts_with("alive-")));
}

#[test]
fn what_a_dead_one_had_begun_is_taken_over_and_a_broken_piece_made_again() {
    let [alone, shared] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let expected = search(&joined(alone.path(), 0), &AtomicUsize::new(0), usize::MAX);
    // It dies in the second round, and its leases stay: no word of it is there, or one that never changes.
    search(&joined(shared.path(), 0), &AtomicUsize::new(0), 27);
    fs::write(shared.path().join("alive-dead"), "7").unwrap();
    fs::write(shared.path().join("00002-4.0.lease"), "alive-dead").unwrap();
    fs::write(shared.path().join("00002-5.0.lease"), "").unwrap();
    fs::write(shared.path().join("00000-3.tsv"), "half a pie").unwrap();
    let rest = AtomicUsize::new(0);
    let begun = Instant::now();
    assert_eq!(search(&joined(shared.path(), 2), &rest, usize::MAX), expected);
    assert!(begun.elapsed() > QUICK.patience);
    let rest = rest.into_inner();
    assert!((33..50).contains(&rest), "{rest}");
    assert!(shared.path().join("00002-4.1.lease").is_file());
}

#[test]
fn what_another_search_has_executed_is_not_taken() {
    let place = tempfile::tempdir().unwrap();
    Piece::write(&place.path().join("00000-0.tsv"), &[[77; 16]], &[None]).unwrap();
    let rounds = joined(place.path(), 0);
    search(&rounds, &AtomicUsize::new(0), usize::MAX);
    let problem = rounds.trouble().unwrap().to_string();
    assert!(problem.contains("00000-0.tsv") && problem.contains("answer alike"), "{problem}");
}

/// The program that was started first executes for all, whoever comes later and with whatever.
#[test]
fn shards_with_another_program_execute_nothing() {
    let place = tempfile::tempdir().unwrap();
    let named = |name: &str| Greeting { name: name.into(), ..Greeting::default() };
    let [first, other, third] = [0, 1, 2].map(|number| joined(place.path(), number));
    assert_eq!(first.program().unwrap(), None);
    assert!(first.may(&named("sim 1")) && !other.may(&named("sim 2")) && third.may(&named("sim 1")));
    let refused = other.trouble().unwrap().to_string();
    assert!(refused.contains("`sim 2` without a version") && refused.contains("is of `sim 1`"), "{refused}");
    assert!(!first.is_in_trouble() && !third.is_in_trouble());
    assert_eq!(third.program().unwrap(), Some(named("sim 1")));
}
