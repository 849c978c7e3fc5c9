use super::*;
use crate::testing::small;
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
