use super::*;
use crate::testing::{program, small};
use crate::{Problem, Unwatched};

#[test]
fn cases_are_found_once_and_known_from_then_on() {
    let place = tempfile::tempdir().unwrap();
    let found = generate(&small(&place), &Unwatched).unwrap();
    assert_eq!((found.cases.len(), found.tally.complete), (2, true));
    let again = find_cases(&found.work, Deadline::after(None), Deadline::after(None), &Unwatched).unwrap();
    assert_eq!(again, (found.cases, found.tally));
}

/// Stops after so many executions, and counts them.
#[derive(Debug, Default)]
struct Counting {
    most: Option<usize>,
    seen: std::sync::atomic::AtomicUsize,
}

impl Watch for Counting {
    fn stopped(&self) -> bool {
        let seen = self.seen.load(std::sync::atomic::Ordering::Relaxed);
        self.most.is_some_and(|most| seen >= most)
    }

    fn seen(&self, run: crate::Seen) {
        assert!(run.deviation.is_some());
        self.seen.fetch_add(1, std::sync::atomic::Ordering::Relaxed);
    }
}

#[test]
fn a_search_that_was_stopped_executes_nothing_twice_and_finds_what_it_would_have_found() {
    let [place, other] = [(); 2].map(|()| tempfile::tempdir().unwrap());
    let settings = |place| {
        let mut settings = small(place);
        settings.scenario = crate::testing::small_hull(place.path());
        let search = "{ method = \"worst\", waypoints = 80, cases = 2, executions = 30 }";
        settings.sets.push(("generate.search".into(), search.into()));
        settings
    };
    let whole = Counting::default();
    let uninterrupted = generate(&settings(&other), &whole).unwrap();
    let count = |watch: &Counting| watch.seen.load(std::sync::atomic::Ordering::Relaxed);
    let begun = Counting { most: Some(25), ..Counting::default() };
    let stopped = generate(&settings(&place), &begun).map(|found| found.cases.len());
    assert!(matches!(stopped, Err(Problem::Interrupted(_))), "{stopped:?}");
    let executed = place.path().join("out/executed.tsv");
    assert!(executed.is_file());
    let resumed = CampaignSettings { if_there: crate::work::IfThere::Resume, ..settings(&place) };
    let rest = Counting::default();
    let found = generate(&resumed, &rest).unwrap();
    assert_eq!((&found.cases, &found.tally), (&uninterrupted.cases, &uninterrupted.tally));
    // Runs that choose which draws the search is executed under are no plans of it: there are none here.
    assert!(count(&begun) >= 25 && count(&begun) + count(&rest) == count(&whole), "{begun:?} {rest:?} {whole:?}");
    assert!(!executed.exists(), "nothing is left to go on with");
}

/// What a search has executed until it was stopped is one program's: another goes on with none of it, and loses none.
#[test]
fn a_search_is_gone_on_with_by_the_program_that_began_it() {
    let place = tempfile::tempdir().unwrap();
    let file = place.path().join("sim.py");
    let mut settings = small(&place);
    settings.scenario = crate::testing::small_hull(place.path());
    let search = "{ method = \"worst\", waypoints = 80, cases = 2, executions = 30 }";
    settings.sets.push(("generate.search".into(), search.into()));
    settings.sets.push(program(&file, "name=\"sim 1\""));
    let begun = Counting { most: Some(15), ..Counting::default() };
    let stopped = generate(&settings, &begun).map(|found| found.cases.len());
    assert!(matches!(stopped, Err(Problem::Interrupted(_))), "{stopped:?}");
    let executed = || std::fs::read(place.path().join("out/executed.tsv")).unwrap();
    let before = executed();
    let resumed = CampaignSettings { if_there: crate::work::IfThere::Resume, ..settings };
    program(&file, "name=\"sim 2\"");
    for _ in 0..2 {
        let refused = generate(&resumed, &Unwatched).map(drop).unwrap_err().to_string();
        let told = "`sim 2` without a version; what is kept was executed by `sim 1` without a version";
        assert!(refused.contains(told), "{refused}");
        assert_eq!(executed(), before);
    }
    program(&file, "name=\"sim 1\"");
    let found = generate(&resumed, &Unwatched).unwrap();
    assert_eq!((found.cases.len(), found.tally.complete), (2, true));
    assert_eq!(found.work.folder.read_executor().unwrap().unwrap().name, "sim 1");
}

/// A broken simulator is told as one also where the time is over before all of the search was in vain.
#[cfg(unix)]
#[test]
fn a_program_that_flew_nothing_in_its_time_has_failed() {
    let place = tempfile::tempdir().unwrap();
    let program = r#"while read -r line; do case "$line" in
        *'"hello"'*) echo '{"type":"ready","protocol":1,"name":"broken"}';;
        *'"mission"'*) echo '{"type":"error","message":"no licence"}';;
        *'"bye"'*) exit;;
    esac; done"#;
    std::fs::write(place.path().join("broken.sh"), program).unwrap();
    let mut settings = small(&place);
    settings.scenario = crate::testing::small_hull(place.path());
    let search = "{ method = \"worst\", waypoints = 80, cases = 2, executions = 100000 }";
    let command = format!("'sh {}'", place.path().join("broken.sh").display());
    settings.sets.push(("generate.search".into(), search.into()));
    settings.sets.push(("execute.command".into(), command));
    settings.time_limit_s = Some(0.6);
    let Err(Problem::Executor(told)) = generate(&settings, &Unwatched).map(|_| ()) else { panic!("it flew") };
    assert!(told.starts_with("broken: none of ") && told.contains("no licence"), "{told}");
}

#[test]
fn a_proof_that_is_out_of_time_is_claimed_no_more_until_it_is_there() {
    let place = tempfile::tempdir().unwrap();
    let mut settings = small(&place);
    settings.scenario = "arm".into();
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    // More points than a table of all subsets is for: a tree of bounds is what its proof is made of.
    settings.sets = vec![set("task.points", "{ count = 20 }"), set("generate.search", "{ programs = 1 }")];
    let work = plan(&settings, &Unwatched).unwrap().begin().unwrap();
    let (endless, over) = (Deadline::after(None), Deadline::after(Some(0.0)));
    let (cases, tally) = find_cases(&work, endless, over, &Unwatched).unwrap();
    assert_eq!((tally.complete, tally.cut.as_deref(), cases[0].gap()), (false, Some(UNPROVEN), None));
    assert!(!work.folder.file("optimum.json").exists());
    // Whoever looks at it says so: it is no pass, and the budget has cut it.
    let budget = crate::Budget::of(Some(3600.0), None);
    assert_eq!(budget.cut_of_search(&work.setup.scenario, &cases, &tally).as_deref(), Some(UNPROVEN));
    assert_eq!(budget.spent().unwrap().cut, [UNPROVEN]);
    let (proven, tally) = find_cases(&work, endless, endless, &Unwatched).unwrap();
    assert_eq!((tally.complete, tally.cut, proven[0].gap()), (true, None, Some(0.0)));
    assert!(work.folder.file("optimum.json").is_file());
}

#[test]
fn who_stops_it_is_told_and_may_go_on() {
    struct Stopped;
    impl Watch for Stopped {
        fn stopped(&self) -> bool {
            true
        }
    }
    let place = tempfile::tempdir().unwrap();
    let stopped = generate(&small(&place), &Stopped).map(|found| found.cases.len());
    assert!(matches!(stopped, Err(Problem::Interrupted(_))), "{stopped:?}");
    let settings = CampaignSettings { if_there: crate::work::IfThere::Resume, ..small(&place) };
    assert_eq!(generate(&settings, &Unwatched).unwrap().cases.len(), 2);
}
