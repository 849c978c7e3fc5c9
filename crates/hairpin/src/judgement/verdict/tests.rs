use super::*;
use crate::judgement::Chosen;

fn violation(what: &str, value: f64, limit: f64) -> Violation {
    Violation { what: what.into(), value, limit, unit: "m".into(), at: 12.34, leg: 4 }
}

const HOW: &[&str] = &["simulated", "anafi stand-in", "minimum-snap"];
const WITNESSED: &[Claim] = &[Claim { word: "witnessed", count: 200 }];

fn with<'a>(failed: usize, value: &'a Violation) -> Judged<'a> {
    let worst = Some(Worst { case: "0117", value, saturation: Some(0.31) });
    let chosen = Chosen::AtRandom;
    Judged { how: HOW, runs: 5, cases: 200, failed, worst, chosen, claims: WITNESSED, ..Judged::default() }
}

/// A violation is one whatever was not flown, and what was not is told.
#[test]
fn runs_that_were_not_flown_are_told_beside_a_violation() {
    let far = violation("deviation", 0.65, 0.5);
    let told = |failed| verdict(&Judged { unflown: [3, 1000], ..with(failed, &far) }).sentence;
    assert!(told(3).contains("; 3 of 1000 runs not flown; all 200 witnessed"), "{}", told(3));
    assert!(!told(0).contains("not flown"), "{}", told(0));
    assert!(!verdict(&with(3, &far)).sentence.contains("not flown"));
}

#[test]
fn a_search_whose_executions_failed_is_no_pass() {
    let value = violation("deviation", 0.3, 0.5);
    let searched = Judged { search_failed: [31, 80], search_trouble: "boom", ..with(0, &value) };
    let told = verdict(&searched);
    let words = "EXECUTOR FAILED 31/80 executions of the search (boom): not counted as pass or fail; 200 judged (";
    assert!(told.exit_code == 4 && told.sentence.starts_with(words), "{told:?}");
    // Cases come before what was tried for them, and violations before both; what is left is told beside them.
    let cases = verdict(&Judged { executor_failed: 4, ..searched });
    assert!(cases.exit_code == 4 && cases.sentence.starts_with("EXECUTOR FAILED 4/200: "), "{cases:?}");
    let fails = verdict(&Judged { failed: 3, ..searched });
    assert!(fails.exit_code == 1 && fails.sentence.starts_with("FAIL 3/200 "), "{fails:?}");
    for told in [cases, fails] {
        assert!(told.sentence.contains("; executor failed in 31/80 executions of the search"), "{told:?}");
    }
}

#[test]
fn what_was_cut_short_fails_or_decides_nothing() {
    let near = violation("deviation", 0.41, 0.5);
    let cut = Judged { undone: 12, cut: Some("cut short: 12 of 200 cases not executed"), ..with(0, &near) };
    let open = verdict(&cut);
    assert_eq!(open.exit_code, 5);
    assert!(open.sentence.starts_with("INCONCLUSIVE 0/200 "), "{open:?}");
    assert!(open.sentence.contains("no violation in 188 cases"), "{open:?}");
    assert!(open.sentence.contains("; cut short: 12 of 200 cases not executed; "), "{open:?}");
    let far = violation("deviation", 0.65, 0.5);
    let failed = verdict(&Judged { failed: 1, worst: with(1, &far).worst, ..cut });
    assert!(failed.exit_code == 1 && failed.sentence.starts_with("FAIL 1/200 "), "{failed:?}");
    assert!(failed.sentence.contains("12 of 200 cases not executed"), "{failed:?}");
    // Nobody asked for anything, and not all of it was done.
    assert_eq!(verdict(&Judged { limited: false, ..cut }).exit_code, 5);
}

#[test]
fn fail_reads_as_designed() {
    let verdict = verdict(&with(3, &violation("deviation", 0.65, 0.5)));
    assert_eq!(
        verdict.sentence,
        "FAIL 3/200 (simulated, anafi stand-in, minimum-snap, 5 runs each): worst 0.65 m > 0.50 m, case 0117, \
         t = 12.34 s, leg 4→5, rotors saturated 31 %; share 1.5 % [0.3, 4.3]; all 200 witnessed"
    );
    assert_eq!(verdict.exit_code, 1);
}

#[test]
fn pass_states_the_upper_bound() {
    let verdict = verdict(&with(0, &violation("deviation", 0.4999, 0.5)));
    assert_eq!(
        verdict.sentence,
        "PASS 200/200 (simulated, anafi stand-in, minimum-snap, 5 runs each): worst 0.4999 m ≤ 0.5000 m, \
         case 0117, t = 12.34 s, leg 4→5, rotors saturated 31 %; no violation in 200 cases: share at most 1.5 % \
         (3/N, 95 %); all 200 witnessed"
    );
    assert_eq!(verdict.exit_code, 0);
}

#[test]
fn drives_read_as_well() {
    let how: &[&str] = &["simulated", "rocky8 stand-in", "predictive"];
    let of = |value: &Violation| {
        let worst = Some(Worst { case: "0003", value, saturation: None });
        let verdict = verdict(&Judged { how, cases: 20, failed: 1, worst, ..Judged::default() });
        verdict.sentence.split("each): ").nth(1).unwrap().split("; 1 of 20").next().unwrap().to_owned()
    };
    let at = |what: &str, value, limit, unit: &str| Violation {
        what: what.into(),
        value,
        limit,
        unit: unit.into(),
        at: 41.2,
        leg: 2,
    };
    let place = "case 0003, t = 41.20 s, leg 2→3";
    for (value, words) in [
        (at("deviation", 0.31, 0.25, "m"), "worst 0.31 m > 0.25 m"),
        (at("tip-over-margin", 7.2, 10.0, "°"), "worst tip-over margin 7.2° < 10.0°"),
        (at("tip-over-margin", 9.996, 10.0, "°"), "worst tip-over margin 9.996° < 10.000°"),
        (at("tip-over", 41.2, 0.0, "s"), "worst tipped over"),
        (at("belly-contact", 41.2, 0.0, "s"), "worst set its underside on the ground"),
        (at("stuck", 41.2, 0.0, "s"), "worst got stuck"),
        (at("off-map", 41.2, 0.0, "s"), "worst left the map"),
    ] {
        assert_eq!(of(&value), format!("{words}, {place}"));
    }
}

#[test]
fn cases_that_were_not_found_are_told() {
    let value = violation("deviation", 0.65, 0.5);
    let of = |asked| verdict(&Judged { asked, ..with(3, &value) }).sentence;
    assert!(of(250).contains("; 200 of 250 cases asked for were found; all 200 witnessed"), "{}", of(250));
    assert_eq!(of(200), verdict(&with(3, &value)).sentence);
}

#[test]
fn the_interval_decides_against_a_share_limit() {
    let value = violation("clearance", 0.1, 0.3);
    let of = |failed, limit| verdict(&Judged { share_limit: Some(limit), ..with(failed, &value) });
    let straddles = of(3, 0.02);
    assert_eq!(straddles.exit_code, 5);
    assert!(straddles.sentence.starts_with("INCONCLUSIVE 3/200 (simulated"), "{}", straddles.sentence);
    assert!(straddles.sentence.contains("worst clearance 0.10 m < 0.30 m"), "{}", straddles.sentence);
    assert!(straddles.sentence.contains("share 1.5 % [0.3, 4.3], interval straddles the 2 % allowed"));
    let passes = of(3, 0.05);
    assert_eq!(passes.exit_code, 0);
    assert!(passes.sentence.starts_with("PASS 197/200 (") && passes.sentence.contains("within the 5 % allowed"));
    let fails = of(30, 0.05);
    assert_eq!(fails.exit_code, 1);
    assert!(fails.sentence.starts_with("FAIL 30/200 (") && fails.sentence.contains("above the 5 % allowed"));
    // No violation at all, but too few cases to say so of one in a thousand.
    assert_eq!(of(0, 0.001).exit_code, 5);
    assert_eq!((of(1, 0.0).exit_code, of(0, 0.0).exit_code), (1, 0));
}

#[test]
fn of_cases_that_were_searched_the_count_is_told_and_decides() {
    let value = violation("deviation", 0.65, 0.5);
    let of = |failed, share_limit| verdict(&Judged { chosen: Chosen::Searched, share_limit, ..with(failed, &value) });
    let fails = of(3, None);
    assert_eq!(
        fails.sentence,
        "FAIL 3/200 (simulated, anafi stand-in, minimum-snap, 5 runs each): worst 0.65 m > 0.50 m, case 0117, \
         t = 12.34 s, leg 4→5, rotors saturated 31 %; 3 of 200 searched violate; all 200 witnessed"
    );
    let within = of(3, Some(0.02));
    assert!(within.exit_code == 0 && within.sentence.starts_with("PASS 197/200 ("), "{}", within.sentence);
    assert!(within.sentence.contains("3 of 200 searched violate, within the 2 % allowed of them"));
    assert_eq!((of(0, Some(0.001)).exit_code, of(5, Some(0.02)).exit_code), (0, 1));
    for told in [fails, within] {
        assert!(!told.sentence.contains("3/N") && !told.sentence.contains('['), "{}", told.sentence);
    }
    // What was not judged is open, whatever was allowed.
    assert_eq!(verdict(&Judged { inconclusive: 200, ..with(0, &value) }).exit_code, 5);
}

#[test]
fn the_worst_stands_beside_what_nobody_chose() {
    let value = violation("deviation", 3.91, 0.5);
    let by_chance = "random feasible ones 1.22 m in the mean (1.05 to 1.40), 1.90 m at worst of 20";
    let beside = Some(Beside { of: "4 000 flown", by_chance });
    let told = verdict(&Judged { beside, chosen: Chosen::Searched, ..with(3, &value) }).sentence;
    let expected = "worst 3.91 m > 0.50 m, case 0117, t = 12.34 s, leg 4→5, rotors saturated 31 %, of 4 000 flown; random \
                    feasible ones 1.22 m in the mean (1.05 to 1.40), 1.90 m at worst of 20; 3 of 200 searched violate; \
                    all 200 witnessed";
    assert!(told.ends_with(expected), "{told}");
}

#[test]
fn what_a_limit_was_not_held_against_is_told_beside_a_pass() {
    let value = violation("deviation", 0.09, 0.1);
    let passed_over = &["14 of 20 legs within corner_m of their waypoints: no deviation judged there".to_owned()];
    let told = verdict(&Judged { passed_over, chosen: Chosen::Searched, ..with(0, &value) });
    let expected = "14 of 20 legs within corner_m of their waypoints: no deviation judged there; all 200 witnessed";
    assert!(told.exit_code == 0 && told.sentence.ends_with(expected), "{}", told.sentence);
}

#[test]
fn draws_of_an_only_case_have_their_share() {
    let value = violation("deviation", 0.65, 0.5);
    let one = Judged { chosen: Chosen::Searched, cases: 1, draws: Some([7, 199]), claims: &[], ..with(1, &value) };
    let told = verdict(&one).sentence;
    let share = "; 1 of 1 searched violate; 7 of 199 draws of `[vary]` violate: share 3.5 % [1.4, 7.1]";
    assert!(told.ends_with(share), "{told}");
}

#[test]
fn a_violation_outranks_a_failed_executor_which_outranks_doubt() {
    let value = violation("deviation", 0.65, 0.5);
    let trouble = "time-out 60 s, stderr kept";
    let base = Judged { executor_failed: 4, trouble, ..with(3, &value) };
    let failed = verdict(&base);
    assert_eq!(failed.exit_code, 1);
    assert!(failed.sentence.contains("; executor failed in 4/200, not counted; all 200 witnessed"));
    let within = Judged { failed: 0, inconclusive: 2, worst: None, ..base };
    let broken = verdict(&within);
    assert_eq!(broken.exit_code, 4);
    assert!(
        broken.sentence.starts_with(
            "EXECUTOR FAILED 4/200 (time-out 60 s, stderr kept): not counted as pass or fail; 194 judged (simulated"
        ),
        "{}",
        broken.sentence
    );
    assert_eq!(verdict(&Judged { executor_failed: 0, ..within }).exit_code, 5);
    let all = verdict(&Judged { executor_failed: 200, failed: 0, trouble, ..with(0, &value) });
    assert_eq!(all.sentence, "EXECUTOR FAILED 200/200 (time-out 60 s, stderr kept): not counted as pass or fail");
    assert_eq!(verdict(&Judged::default()).exit_code, 5);
}

#[test]
fn the_other_sentences() {
    let none = nothing_feasible(
        &["proof", "hull"],
        "no chain of 10 waypoints from start to end",
        Some("length 12, or max_speed 8.0 → 9.3 m/s"),
    );
    assert_eq!(
        none.sentence,
        "NOTHING FEASIBLE (proof, hull): no chain of 10 waypoints from start to end; smallest change: length 12, \
         or max_speed 8.0 → 9.3 m/s"
    );
    assert_eq!(none.exit_code, 3);
    let reset = invalid("0118", &["flown", "log_25.ulg"], "position reset of 1.2 m at t = 8.1 s");
    assert_eq!(reset.sentence, "INVALID 0118 (flown, log_25.ulg): position reset of 1.2 m at t = 8.1 s");
    assert_eq!(reset.exit_code, 5);
    assert_eq!(inconclusive("0117", &["flown"], "x").sentence, "INCONCLUSIVE 0117 (flown): x");
}

#[test]
fn what_nothing_was_asked_of_does_not_pass() {
    let value = violation("crash", 12.34, 0.0);
    let none = Judged { limited: false, worst: None, ..with(0, &value) };
    let unjudged = verdict(&none);
    assert_eq!(
        (unjudged.sentence.as_str(), unjudged.exit_code),
        (
            "UNJUDGED 200 (simulated, anafi stand-in, minimum-snap, 5 runs each): nothing crashed or left the world, no \
             more was asked for: spec = \"none\"; all 200 witnessed",
            0
        )
    );
    let crashed = verdict(&Judged { limited: false, ..with(3, &value) });
    assert!(crashed.exit_code == 1 && crashed.sentence.starts_with("FAIL 3/200 ("), "{}", crashed.sentence);
    assert!(crashed.sentence.contains("worst crash") && crashed.sentence.contains("nothing else was asked for"));
    let broken = verdict(&Judged { executor_failed: 4, ..none });
    assert!(broken.exit_code == 4 && broken.sentence.contains("196 unjudged (simulated"), "{}", broken.sentence);
    assert_eq!(verdict(&Judged { inconclusive: 1, ..none }).exit_code, 5);
}

#[test]
fn a_proof_of_the_best_stands_with_the_evidence() {
    let value = violation("deviation", 0.65, 0.5);
    let proven = verdict(&Judged { proof: Some("optimal"), ..with(3, &value) });
    assert!(proven.sentence.ends_with("; all 200 witnessed, optimal"), "{}", proven.sentence);
}
