//! A program in the loop of a search: asked from many threads, answered at once.

use std::collections::BTreeSet;

use hairpin::campaign::{Case, Executor};

use super::*;

/// Asks for mission number `number`, whose second waypoint tells it from the others.
fn ask(program: &InLoop, number: usize) -> Result<Flight, String> {
    let mut mission = mission(number);
    mission.waypoints[1].y += 0.01 * number as f64;
    let flight = program.fly(&mission.setup, &Case::bare(CaseNumber(0), 0, Vec::new()), &mission)?;
    let there = flight.track.poses()[10].translation.vector;
    assert!((there - mission.waypoints[1].coords).norm() < 1e-9, "the flight of another mission: {there}");
    Ok(flight)
}

#[test]
fn every_mission_is_flown_once_by_as_many_processes_as_there_may_be() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("flown");
    let body = format!("open({:?}, 'a').write(f\"{{os.getpid()}} {{m['case']}}\\n\")\ngood(m)", file.to_str().unwrap());
    let program = InLoop::new(&python(folder.path(), &body), limits(), 2, &|| false);
    for _ in 0..2 {
        std::thread::scope(|scope| {
            for thread in 0..4 {
                let program = &program;
                scope.spawn(move || (0..5).for_each(|number| drop(ask(program, 5 * thread + number).unwrap())));
            }
        });
    }
    assert_eq!((program.last(), program.trouble()), (None, None));
    drop(program);
    let text = fs::read_to_string(file).unwrap();
    let column = |place: usize| text.lines().map(|line| line.split(' ').nth(place).unwrap()).collect::<BTreeSet<_>>();
    assert_eq!((text.lines().count(), column(1).len()), (20, 20), "{text}");
    assert!(column(0).len() <= 2 && column(1).iter().all(|case| case.starts_with("search-")), "{text}");
}

#[test]
fn what_fails_costs_itself_alone() {
    let folder = tempfile::tempdir().unwrap();
    let body = "if m['seed'] % 3 == 0: raise SystemExit('rotor 3 is gone')\nif m['seed'] % 3 == 1: return say(type='error', message='busy')\ngood(m)";
    let program = InLoop::new(&python(folder.path(), body), limits(), 1, &|| false);
    let failed = (0..12).filter(|number| ask(&program, *number).is_err()).count();
    assert_eq!((failed, program.trouble()), (8, None));
    // Seeds count down from a multiple of three: it exits at number 9, flies 10 and is busy at 11.
    assert_eq!(program.last().unwrap().failure, Failure::Reported { message: "busy".into() });
}

/// What a program says of itself may be why it is to fly nothing: it is asked for nothing then.
#[test]
fn who_is_not_wanted_flies_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let asked = folder.path().join("asked");
    let command = python(folder.path(), &format!("open({:?}, 'a').write('x')\ngood(m)", asked.to_str().unwrap()));
    let program = InLoop::new(&command, limits(), 1, &|| false).only_if(&|_| false);
    assert!(!program.is_unwanted(), "nobody knows yet");
    assert!((0..3).all(|number| ask(&program, number).is_err()));
    assert!(program.is_unwanted() && (program.last(), program.trouble()) == (None, None) && !asked.exists());
}

/// The flight of the mission that is asked for counts, whatever follows it: the judgement flies again.
#[test]
fn who_answers_twice_is_never_taken_for_the_next() {
    let folder = tempfile::tempdir().unwrap();
    let program = InLoop::new(&python(folder.path(), "good(m)\nif m['seed'] % 2: good(m)"), limits(), 1, &|| false);
    (0..12).for_each(|number| drop(ask(&program, number).unwrap()));
    // Trusted or not, what never answers twice is heard as well.
    let program = InLoop::new(&python(folder.path(), "good(m)"), limits(), 3, &|| false);
    (0..30).for_each(|number| drop(ask(&program, number).unwrap()));
}

#[test]
fn three_in_a_row_without_an_answer_end_it() {
    let folder = tempfile::tempdir().unwrap();
    let limits = Limits { mission: Duration::from_millis(400), ..limits() };
    let asks = |body: &str| {
        let program = InLoop::new(&python(folder.path(), body), limits, 1, &|| false);
        let told: Vec<_> = (0..6).map(|number| ask(&program, number).map(drop)).collect();
        (told, program.trouble())
    };
    let (told, trouble) = asks("time.sleep(600)");
    let trouble = trouble.unwrap();
    assert_eq!(trouble, "test: it left 3 executions in a row without an answer (execute.timeout_s = 0.4)");
    assert!(told[2].as_ref().unwrap_err().starts_with("time-out"), "{told:?}");
    assert!(told[3..].iter().all(|told| told == &Err("stopped".to_owned())), "{told:?}");
    // One that is answered between begins it anew.
    let (told, trouble) = asks("time.sleep(600) if m['seed'] % 3 else good(m)");
    assert_eq!((told.iter().filter(|told| told.is_ok()).count(), trouble), (2, None), "{told:?}");
}

#[test]
fn a_program_that_does_not_start_is_told() {
    let command: Command = "hairpin-no-such-program --fast".parse().unwrap();
    let program = InLoop::new(&command, limits(), 1, &|| false);
    for _ in 0..3 {
        assert!(ask(&program, 0).unwrap_err().starts_with("cannot start `hairpin-no-such-program`: "));
    }
    assert!(program.trouble().unwrap().starts_with("cannot start "));
    assert_eq!(ask(&program, 0).unwrap_err(), "stopped");
}
