//! Verdict, cards, table and picture say the same, for each kind of robot and each way to fail.

use hairpin::campaign::report::{self, Pieces, shown};
use hairpin::campaign::{self, Case, CaseNumber, CaseResult, Run, Setup, Status, Tally};
use hairpin::judgement::{LegMeasures, Measures, Violation};
use hairpin::trajectory::{Channel, Ended, Flight, Track};
use hairpin_formats::report::html;
use hairpin_formats::scenario::setup_for;
use nalgebra::{Isometry3, Point3, Translation3};

/// The worst deviation lies elsewhere than the violation: at 3 s, in leg 0.
const DEVIATION_M: f64 = 0.0042;
/// The violation is here.
const AT: f64 = 7.25;

fn case(number: usize) -> Case {
    Case::bare(CaseNumber(number), 1, [[1.0, 1.0, 1.0], [3.0, 1.0, 1.0], [6.0, 1.0, 1.0]].map(Point3::from).to_vec())
}

/// Ten seconds along the waypoints.
fn track() -> Track {
    let times: Vec<f64> = (0..=400).map(|i| 0.025 * f64::from(i)).collect();
    let poses = times.iter().map(|t| Isometry3::from(Translation3::new(1.0 + 0.5 * t, 1.02, 1.0))).collect();
    let legs = times.iter().map(|t| if *t < 4.0 { 0.0 } else { 1.0 }).collect();
    Track::new(times, poses, vec![Channel { name: "leg".into(), values: legs }]).unwrap()
}

fn result(number: usize, deviation: f64, violations: Vec<Violation>) -> CaseResult {
    let measures = Measures {
        max_deviation: if number == 0 { 0.5 * deviation } else { deviation },
        t_worst: 3.0,
        leg_worst: 0,
        legs: vec![LegMeasures::default(); 2],
        total_time: 10.0,
        ..Measures::default()
    };
    CaseResult {
        case: CaseNumber(number),
        status: if violations.is_empty() { Status::Pass } else { Status::Fail },
        run: 0,
        measures: Some(measures),
        of_runs: None,
        ended: "done".into(),
        left_world: None,
        violations,
        elsewhere: vec![],
        drawn: vec![("execute.latency_s".into(), serde_json::json!(0.304_898_373_458_353_97))],
        message: None,
        reruns: None,
        draws: None,
    }
}

/// The page of two cases, of which number 1 violates, or none does.
fn page(setup: &Setup, deviation: f64, violation: Option<Violation>) -> (String, String) {
    let cases = [case(0), case(1)];
    let results = [result(0, deviation, vec![]), result(1, deviation, violation.into_iter().collect())];
    let tally = Tally { graphs: 2, solved: 2, complete: true, ..Tally::default() };
    let verdict = campaign::verdict(setup, &cases, (&results, None), &tally);
    let full = |(case, result): (&Case, &CaseResult)| {
        let flight = Flight { track: track(), ended: Ended::Done, left_world: None, reached: vec![Some(0.0); 3] };
        let run = Run { case: case.number, run: 0, drawn: vec![], outcome: Ok(flight), full_rate: None };
        shown(setup, case, result, track(), Some((&run).into()), &[]).unwrap()
    };
    let data = report::assemble(Pieces {
        setup,
        cases: &cases,
        results: &results,
        tally: Some(&tally),
        verdict: verdict.clone(),
        assumptions: vec![],
        shown: cases.iter().zip(&results).map(full).collect(),
        frame: vec![],
        influences: vec![],
        coverage: None,
        baseline: None,
        random: &[],
        asked: None,
    });
    (verdict.sentence, html(&data))
}

fn between<'a>(text: &'a str, from: &str, to: &str) -> &'a str {
    text.split_once(from).and_then(|(_, rest)| rest.split_once(to)).unwrap_or_else(|| panic!("no {from}")).0
}

fn escaped(text: &str) -> String {
    text.replace('<', "&lt;").replace('>', "&gt;")
}

fn agree(name: &str, setup: &Setup, (value, printed): (Violation, Option<[&str; 2]>)) {
    let (sentence, page) = page(setup, DEVIATION_M, Some(value.clone()));
    let context = format!("{name}: {}", value.what);
    assert!(sentence.contains("case 0001, t = 7.25 s, leg 1→2"), "{context}: {sentence}");
    let finding = match printed {
        Some([number, limit]) => {
            let sign = if matches!(value.what.as_str(), "clearance" | "tip-over-margin") { '<' } else { '>' };
            assert!(sentence.contains(&format!("{number} {sign} {limit}")), "{context}: {sentence}");
            format!("{} {number} {sign} {limit}", value.what.replace('-', " "))
        }
        None => value.event().unwrap(),
    };
    // The cards: what, how much, and where.
    let cards = between(&page, "<section class=\"cards\">", "</section>");
    let first = between(cards, "<p class=\"value\">", "</div>");
    let expected = match printed {
        Some([number, limit]) => format!("{number}</p><p class=\"note\">limit {limit}</p>"),
        None => format!("{finding}</p><p class=\"note\">at t = 7.25 s</p>"),
    };
    assert_eq!(first, expected, "{context}");
    assert!(cards.contains(">0001</p><p class=\"note\">t = 7.25 s, leg 1→2</p>"), "{context}: {cards}");
    // The table.
    let row = between(&page, "data-case=\"0001\"><td>", "</tr>");
    assert!(row.contains(&format!("<td>{} at t=7.25 s</td>", escaped(&finding))), "{context}: {row}");
    // The picture, by what its script is told.
    let json = between(&page, "id=\"data\">", "</script>");
    let drawn: serde_json::Value = serde_json::from_str(json).unwrap();
    let open = &drawn["cases"][drawn["open"].as_u64().unwrap() as usize];
    assert_eq!((open["id"].as_str(), open["at"].as_f64()), (Some("0001"), Some(AT)), "{context}");
    assert_eq!(open["told"], format!("{finding} at t=7.25 s"), "{context}");
    // No number with sixteen digits is told.
    let words = page.split("<script").next().unwrap_or_default();
    assert!(words.contains("execute.latency_s = 0.305") && !words.contains("0.30489837"), "{context}");
}

/// Every way to fail: events, and limits with how they are printed in m and in mm.
fn ways(mm: bool) -> Vec<(Violation, Option<[&'static str; 2]>)> {
    let of = |what: &str, value, limit, unit: &str| Violation {
        what: what.into(),
        value,
        limit,
        unit: unit.into(),
        at: AT,
        leg: 1,
    };
    let events = ["crash", "tip-over", "belly-contact", "stuck", "halted", "off-map", "left-world"];
    let mut all: Vec<_> = events.iter().map(|what| (of(what, AT, 0.0, "s"), None)).collect();
    all.extend(["stalled", "unfinished"].map(|what| (of(what, 2.0, 3.0, "waypoints"), None)));
    let long = |what, metres: f64, limit: f64, in_m, in_mm| match mm {
        true => (of(what, 1e3 * metres, 1e3 * limit, "mm"), Some(in_mm)),
        false => (of(what, metres, limit, "m"), Some(in_m)),
    };
    all.extend([
        long("deviation", 0.015, 0.01, ["0.015 m", "0.010 m"], ["15.00 mm", "10.00 mm"]),
        long("overshoot", 0.65, 0.5, ["0.65 m", "0.50 m"], ["650.00 mm", "500.00 mm"]),
        long("clearance", 0.1, 0.25, ["0.10 m", "0.25 m"], ["100.00 mm", "250.00 mm"]),
        (of("tip-over-margin", 7.2, 10.0, "°"), Some(["7.2°", "10.0°"])),
        (of("acceleration", 31.0, 25.0, "m/s²"), Some(["31.00 m/s²", "25.00 m/s²"])),
        (of("total-time", 61.0, 60.0, "s"), Some(["61.00 s", "60.00 s"])),
        (of("late", 12.5, 8.0, "ms"), Some(["12.50 ms", "8.00 ms"])),
    ]);
    all
}

#[test]
fn verdict_cards_table_and_picture_agree() {
    for kind in ["quadrotor", "rover", "car", "arm", "boat"] {
        let setup = setup_for(kind, &[]).unwrap();
        for way in ways(kind == "arm") {
            agree(kind, &setup, way);
        }
        passing(kind);
    }
}

/// Where nothing is violated the largest deviation is told, in the unit and with the digits of its limit, or as many as
/// show that it keeps it, or that there is any.
fn passing(kind: &str) {
    let key = match kind {
        "arm" => "spec.path.max_mm",
        "rover" | "car" => "spec.limits.path_deviation_m",
        _ => "spec.deviation.max_m",
    };
    for [deviation, limit, told, of] in [
        ["0.0183", "0.025", "0.018", "0.025"],
        ["0.02496", "0.025", "0.02496", "0.02500"],
        ["0.0042", "0.5", "0.0042", "0.5000"],
        ["0.31", "0.5", "0.31", "0.50"],
    ] {
        let unit = if kind == "arm" { "mm" } else { "m" };
        let setup = setup_for(kind, &[(key.into(), limit.into())]).unwrap();
        let metres = deviation.parse::<f64>().unwrap() / if kind == "arm" { 1e3 } else { 1.0 };
        let (sentence, page) = page(&setup, metres, None);
        let context = format!("{kind}: {told} {unit} within {of}");
        let place = "case 0001, t = 3.00 s, leg 0→1";
        assert!(sentence.contains(&format!("worst {told} {unit} ≤ {of} {unit}, {place}")), "{context}: {sentence}");
        let card = format!("<p class=\"value\">{told} {unit}</p><p class=\"note\">limit {of} {unit}</p>");
        assert!(page.contains(&card), "{context}: no {card}");
        let row = between(&page, "data-case=\"0001\"><td>", "</tr>");
        assert!(row.contains(&format!("pass</span></td><td>{told}</td><td>3.00</td>")), "{context}: {row}");
        assert!(page.contains(&format!(">max deviation {unit}<")), "{context}: the table's unit");
        assert!(page.contains(&format!(">0001 · {told} {unit} · pass<")), "{context}: the list of cases");
        let drawn: serde_json::Value = serde_json::from_str(between(&page, "id=\"data\">", "</script>")).unwrap();
        let open = &drawn["cases"][drawn["open"].as_u64().unwrap() as usize];
        assert_eq!(open["told"], format!("largest deviation {told} {unit} at t=3.00 s"), "{context}");
        assert_eq!(drawn["limit"].as_f64(), limit.parse().ok(), "{context}");
        // What the view itself writes has so many decimals, and more by the same rule.
        assert_eq!(drawn["digits"], if limit == "0.025" { 3 } else { 2 }, "{context}");
        let distribution = between(&page, "<table class=\"spread\">", "</table>");
        assert!(distribution.contains(&format!("<td>{told}</td>")), "{context}: {distribution}");
    }
}
