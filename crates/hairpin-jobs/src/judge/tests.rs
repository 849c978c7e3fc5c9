use super::*;
use crate::Unwatched;
use crate::execute::{ExecuteSettings, execute};
use crate::generate::generate;
use crate::report::report;
use crate::testing::{executed, generated, small};
use crate::work::CampaignSettings;

/// Of a robot that feels no air: its draws are told as none, and nothing is laid to them.
#[test]
fn draws_that_no_run_felt_are_not_counted() {
    let place = tempfile::tempdir().unwrap();
    let draws = |drag: &str| {
        let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
        let sets = [
            set("generate.search.cases", "1"),
            set("execute.repeat", "4"),
            set("robot.drag_linear_n_s_m", drag),
            set("robot.drag_quadratic_n_s2_m2", drag),
            set("spec.deviation.max_m", "50"),
            set("vary", "{ \"world.wind_m_s\" = { uniform = [[-1, -1, 0], [1, 1, 0]] } }"),
        ];
        let (small, folder) = (small(&place), place.path().join(drag));
        let sets = small.sets.iter().cloned().chain(sets).collect();
        generate(&CampaignSettings { out: Some(folder.clone()), sets, ..small }, &Unwatched).unwrap();
        execute(&ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() }, &Unwatched).unwrap();
        judge(&folder, &[]).unwrap().judgement
    };
    let felt = draws("0.1");
    assert!(felt.verdict.sentence.contains("no violation in 3 draws of `[vary]`"), "{}", felt.verdict.sentence);
    assert!(felt.results[0].draws.is_some() && !felt.influences.is_empty());
    let unfelt = draws("0.0");
    let sentence = &unfelt.verdict.sentence;
    assert!(sentence.contains("what `[vary]` draws is no draw of any run: the robot has no drag"), "{sentence}");
    assert!(!sentence.contains("no violation in") && unfelt.results[0].draws.is_none(), "{sentence}");
    assert!(unfelt.influences.is_empty(), "{:?}", unfelt.influences);
}

/// What a budget left undone is so for every judgement until it was executed; what nobody executed is refused.
#[test]
fn what_a_budget_left_undone_stays_undone() {
    let (_place, folder) = generated();
    let refused = judge(&folder, &[]).map(drop).unwrap_err().to_string();
    assert!(refused.contains("has not been executed"), "{refused}");
    let work = open_to_read(&folder).unwrap();
    let cases = work.folder.read_cases().unwrap();
    let undone = |case: &Case| CaseResult::undone(case.number, Undone::NotExecuted);
    work.folder.write_results(&cases, &cases.iter().map(undone).collect::<Vec<_>>()).unwrap();
    drop(work);
    let judged = judge(&folder, &[]).unwrap().judgement;
    let Verdict { sentence, exit_code, .. } = &judged.verdict;
    assert!(*exit_code == 5 && sentence.contains("2 of 2 cases not executed"), "{sentence}");
    let settings = ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() };
    execute(&settings, &Unwatched).unwrap();
    assert!(!judge(&folder, &[]).unwrap().judgement.verdict.sentence.contains("not executed"));
}

/// It went on without a word, and what the stress stood beside was gone.
#[test]
fn random_cases_that_are_lost_are_told() {
    let (place, folder) = executed();
    let asked = |count: &str| {
        let sets = vec![("execute.baseline".to_owned(), count.to_owned())];
        let settings = ExecuteSettings { folder: folder.clone(), sets, ..ExecuteSettings::default() };
        execute(&settings, &Unwatched).unwrap();
    };
    assert_eq!(judge(&folder, &[]).unwrap().told, Vec::<String>::new(), "none is asked for");
    asked("3");
    let judged = || judge(&folder, &[]).map(|judged| (judged.told, judged.judgement.baseline)).unwrap();
    assert!(matches!(judged(), (told, Some(_)) if told.is_empty()));
    let (file, aside) = (folder.join("baseline.parquet"), place.path().join("aside"));
    std::fs::rename(&file, &aside).unwrap();
    let (told, _) = judged();
    assert!(
        matches!(&told[..], [one] if one.contains("has no baseline.parquet") && one.contains("3 random")),
        "{told:?}"
    );
    assert_eq!(report(&folder, &[], None).unwrap().told, told);
    let again = ExecuteSettings { folder: folder.clone(), resume: true, ..ExecuteSettings::default() };
    execute(&again, &Unwatched).unwrap();
    assert_eq!(std::fs::read(&file).unwrap(), std::fs::read(&aside).unwrap());
}

/// Only deviations and overshoots have a reference; the rest stands as it was measured of all rows.
#[test]
fn another_reference_leaves_what_has_none() {
    let (_place, folder) = executed();
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let before = judge(&folder, &[set("spec.deviation.max_m", "50")]).unwrap().judgement;
    let sets = [set("spec.deviation", "{ max_m = 50, from = \"leg\", corner_m = 0.25 }")];
    let after = judge(&folder, &sets).unwrap();
    let of_all =
        "2 of 2 cases were executed with another reference of deviations: deviations and overshoots of 2 runs are";
    assert!(
        matches!(&after.told[..], [told] if told.starts_with(of_all) && !told.contains("anew")),
        "{:?}",
        after.told
    );
    for (before, after) in before.results.iter().zip(&after.judgement.results) {
        let (before, after) = (before.measures.clone().unwrap(), after.measures.clone().unwrap());
        let free = |m: &hairpin::judgement::Measures| {
            let moments = (m.t_acceleration, m.t_tilt, m.t_clearance);
            (m.max_acceleration, m.max_tilt, m.min_clearance, m.total_time, m.saturation_share, moments)
        };
        assert_eq!(free(&before), free(&after));
        assert_ne!(before.mean_deviation.to_bits(), after.mean_deviation.to_bits());
    }
}

/// Where no rows are kept, none are measured.
#[test]
fn runs_that_are_flown_anew_for_another_reference_are_told() {
    let place = tempfile::tempdir().unwrap();
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let mut settings = small(&place);
    settings.sets.push(set("execute.record", "none"));
    let folder = settings.out.clone().unwrap();
    generate(&settings, &Unwatched).unwrap();
    execute(&ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() }, &Unwatched).unwrap();
    let sets = [set("spec.deviation", "{ max_m = 50, from = \"leg\", corner_m = 0.25 }")];
    let told = judge(&folder, &sets).unwrap().told;
    assert!(
        matches!(&told[..], [told] if told.ends_with(": 2 runs, whose motion was not kept, flown anew")),
        "{told:?}"
    );
}

#[test]
fn a_spec_that_is_set_decides_and_is_kept() {
    let (_place, folder) = executed();
    let judged = |most: &str| {
        let sets = vec![("spec.deviation.max_m".to_owned(), most.to_owned())];
        judge(&folder, &sets).unwrap().judgement.verdict
    };
    let (strict, lax) = (judged("0.0001"), judged("50"));
    assert_eq!((strict.exit_code, lax.exit_code), (1, 0), "{strict:?} {lax:?}");
    let again = judge(&folder, &[]).unwrap();
    assert_eq!(again.judgement.verdict, lax);
    assert!(folder.join("junit.xml").is_file() && !folder.join("repro/0000.json").exists());
}
