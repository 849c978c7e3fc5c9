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

/// Three windy runs a case, and random cases beside them, in `place`/`name`.
fn windy(place: &tempfile::TempDir, name: &str, more: &[(&str, &str)]) -> std::path::PathBuf {
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    let mut settings = CampaignSettings { out: Some(place.path().join(name)), ..small(place) };
    settings.sets.extend([set("execute.repeat", "3"), set("execute.baseline", "5")]);
    settings.sets.push(set("vary", "{ \"world.wind_m_s\" = { uniform = [[-2, -2, 0], [2, 2, 0]] } }"));
    settings.sets.extend(more.iter().map(|(key, value)| set(key, value)));
    generate(&settings, &Unwatched).unwrap();
    let folder = settings.out.unwrap();
    execute(&ExecuteSettings { folder: folder.clone(), ..ExecuteSettings::default() }, &Unwatched).unwrap();
    folder
}

/// Which run is called the worst depends on all that is limited; how far a case deviates does not, whichever limits
/// stand beside the deviation's, and whenever they were set.
#[test]
fn the_largest_deviation_is_that_of_all_runs_whatever_else_is_limited() {
    let place = tempfile::tempdir().unwrap();
    let set = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    // All runs break both limits; the first by deviation, the second by far more of the acceleration.
    let (far, both) = ("0.0001", [("spec.deviation.max_m", "50"), ("spec.acceleration", "{ max_m_s2 = 0.001 }")]);
    let one = windy(&place, "one", &[("spec.deviation.max_m", far)]);
    let alone = judge(&one, &[]).unwrap().judgement;
    let later = judge(&one, &both.map(|(key, value)| set(key, value))).unwrap().judgement;
    let two = windy(&place, "two", &both);
    let at_once = judge(&two, &[]).unwrap().judgement;
    let most = |judgement: &Judgement| -> Vec<f64> {
        judgement.results.iter().map(|result| result.measured().unwrap().max_deviation).collect()
    };
    assert_eq!(most(&alone), most(&at_once));
    assert_eq!(most(&alone), most(&later));
    let told = |judgement: &Judgement| judgement.baseline.as_ref().map(|of| (of.mean, of.worst, of.max, of.median));
    assert!(told(&alone).is_some());
    assert_eq!(told(&alone), told(&at_once), "two limits from the start");
    assert_eq!(told(&alone), told(&later), "and afterwards");
    // The rows still are about the run that is worst by what is limited.
    for (alone, other) in alone.results.iter().zip(&at_once.results) {
        assert_eq!(alone.measures.as_ref().unwrap().max_deviation, alone.measured().unwrap().max_deviation);
        assert_eq!(other.violations[0].what, "acceleration");
        assert!(other.measures.as_ref().unwrap().max_deviation <= other.measured().unwrap().max_deviation);
    }
    // What is read back is what was judged.
    let read = open_to_read(&two).unwrap().folder.read_results().unwrap();
    assert_eq!(read, at_once.results);
    // The same runs, judged by another limit beside, are no regression.
    let compared = crate::compare::compare(&one, &two, 0.0).unwrap().comparison;
    assert!(compared.metrics.iter().all(|metric| metric.change == "none" && metric.median_difference == 0.0));
    assert_eq!((compared.better, compared.worse, compared.unchanged), (0, 0, 2));
}

/// Rows that were kept are within 0.1 mm of what was flown: what is nearer to its limit decides nothing, on either
/// side.
#[test]
fn what_is_within_what_kept_rows_leave_open_decides_nothing() {
    let (_place, folder) = executed();
    let by = |limit: f64| {
        let spec = format!("{{ max_m = {limit}, from = \"leg\", corner_m = 0.25 }}");
        judge(&folder, &[("spec.deviation".to_owned(), spec)]).unwrap().judgement
    };
    let of_first = |judgement: &Judgement| judgement.results[0].clone();
    let value = of_first(&by(50.0)).measures.unwrap().max_deviation;
    for (more, status) in
        [(-2e-4, "fail"), (-5e-5, "inconclusive"), (5e-5, "inconclusive"), (2e-4, "pass"), (-1e-9, "inconclusive")]
    {
        let result = of_first(&by(value + more));
        assert_eq!(result.status.word(), status, "{more}: {:?}", result.message);
        let told = result.message.unwrap_or_default();
        let side = if more < 0.0 { " > " } else { " ≤ " };
        assert_eq!(
            told.contains("measured of the rows that are kept, within 0.1 mm"),
            status == "inconclusive",
            "{told}"
        );
        assert!(status != "inconclusive" || (told.contains("run 0: deviation ") && told.contains(side)), "{told}");
    }
    // By the reference that it was flown by it is measured of all rows, and decides.
    let (_place, folder) = executed();
    let exact = judge(&folder, &[]).unwrap().judgement.results[0].measures.clone().unwrap().max_deviation;
    let limit = ("spec.deviation.max_m".to_owned(), format!("{}", exact + 5e-5));
    assert_eq!(judge(&folder, &[limit]).unwrap().judgement.results[0].status.word(), "pass");
}

/// A table whose statuses were set to `pass` is believed by nobody who tells a verdict.
#[test]
fn a_pass_that_its_own_measures_contradict_is_refused() {
    let (_place, folder) = executed();
    judge(&folder, &[("spec.deviation.max_m".to_owned(), "0.0001".to_owned())]).unwrap();
    let work = open_to_read(&folder).unwrap();
    let cases = work.folder.read_cases().unwrap();
    let results = work.folder.read_results().unwrap();
    let all_pass = |violations: bool| -> Vec<CaseResult> {
        let pass = |result: &CaseResult| CaseResult {
            status: Status::Pass,
            violations: result.violations.iter().filter(|_| violations).cloned().collect(),
            ..result.clone()
        };
        results.iter().map(pass).collect()
    };
    let refused = || {
        let told = [report(&folder, &[], None).map(drop), crate::compare::compare(&folder, &folder, 0.0).map(drop)];
        told.map(|told| told.unwrap_err().to_string())
    };
    work.folder.write_results(&cases, &all_pass(true)).unwrap();
    for told in refused() {
        assert!(told.contains("`status`") && told.contains("fail, as `violation_what` has deviation"), "{told}");
    }
    work.folder.write_results(&cases, &all_pass(false)).unwrap();
    for told in refused() {
        assert!(told.contains("case 0000 is `pass`, and its own measures are not: ") && told.contains("> "), "{told}");
    }
}
