//! Every shipped scenario gives the cases that it promises.

use hairpin::campaign::arm::ArmSetup;
use hairpin::campaign::{Evidence, Known, OwnSimulator, Stop, generate};
use hairpin_formats::library;
use hairpin_formats::scenario::setup_for;

/// Cases asked for here; the files ask for more.
const CASES: u64 = 2;
/// Executions a case, where the search executes: they decide which cases are found, not how many.
const EXECUTIONS: u64 = 5;

#[test]
fn every_shipped_scenario_gives_its_cases() {
    for shipped in library::scenarios() {
        let name = shipped.name;
        let arm = setup_for(name, &[]).is_ok_and(|setup| setup.own::<ArmSetup>().is_some());
        let key = if arm { "generate.search.programs" } else { "generate.search.cases" };
        let mut sets = vec![(key.to_owned(), CASES.to_string())];
        let executes = |line: &str| line.starts_with("search") && line.contains("\"worst\"");
        if shipped.text.lines().any(executes) {
            sets.push(("generate.search.executions".to_owned(), EXECUTIONS.to_string()));
        }
        let setup = setup_for(name, &sets).unwrap_or_else(|report| panic!("{name}: {report}"));
        let mut cases = Vec::new();
        let tally = generate(&setup, &Known::default(), &OwnSimulator, &Stop::never(), &mut |new, _| {
            cases.extend_from_slice(new)
        });
        assert_eq!(cases.len() as u64, CASES, "{name}: {} of {CASES} cases, {tally:?}", cases.len());
        for case in &cases {
            if let Some(length) = setup.scenario.length() {
                assert_eq!(case.waypoints.len() as u64, length, "{name}");
            }
            assert_eq!(
                case.evidence == Evidence::Witnessed,
                case.profile().is_some() || case.commands().is_some(),
                "{name}"
            );
            assert_eq!(case.evidence == Evidence::ClearAllLinks, case.program().is_some(), "{name}");
        }
    }
}

/// From corner to centre in one step: the answer is a reason, never another reach set.
#[test]
fn nothing_feasible_is_an_answer_with_its_reason() {
    let sets = [("task.length".to_owned(), "2".to_owned()), ("generate.search.graphs".to_owned(), "3".to_owned())];
    let setup = setup_for("paper-stable", &sets).expect("a sound scenario");
    let mut cases = 0;
    let tally = generate(&setup, &Known::default(), &OwnSimulator, &Stop::never(), &mut |new, _| cases += new.len());
    let verdict = hairpin::campaign::verdict(&setup, &[], (&[], None), &tally);
    assert_eq!((cases, tally.proven_empty, verdict.exit_code), (0, 3, 3));
    assert!(
        verdict.sentence.starts_with("NOTHING FEASIBLE (proof, published): no chain of 2 waypoints"),
        "{verdict:?}"
    );
}
