//! A resolved scenario that is written and read again is the same scenario; and no text makes the reader panic.

use std::path::Path;

use hairpin_formats::scenario::{MadeBy, read_made_by, read_setup, to_toml};
use proptest::prelude::*;

const FINE: &str = include_str!("../fixtures/fine.toml");

fn set(key: &str, value: impl ToString) -> (String, String) {
    (key.to_owned(), value.to_string())
}

fn triple(range: std::ops::Range<f64>) -> impl Strategy<Value = String> {
    prop::array::uniform3(range).prop_map(|p| format!("{p:?}"))
}

/// Overrides of all sections whose values are all within bounds.
fn overrides() -> impl Strategy<Value = Vec<(String, String)>> {
    let space = (triple(100.0..1000.0), 0.0..20.0, triple(20.0..80.0), triple(20.0..80.0));
    let obstacles = prop_oneof![
        Just("[]".to_owned()),
        (triple(90.0..95.0), 0.001..1.0)
            .prop_map(|(c, r)| format!("[{{ sphere = {{ center_m = {c}, radius_m = {r:?} }} }}]")),
        triple(90.0..95.0).prop_map(|b| format!(
            "[{{ name = \"a \\\"b\\\" ü\", capsule = {{ a_m = [99, 99, 99], b_m = {b}, radius_m = 0.25 }} }}]"
        )),
    ];
    let generate = (
        prop_oneof![Just("witness"), Just("hull"), Just("none"), Just("published")],
        prop_oneof![Just("beam"), Just("exact"), Just("uniform")],
        1u64..1000,
        any::<bool>(),
        0.01..10.0,
    );
    let controller = prop_oneof![
        Just(("minimum-snap", 0.5)),
        Just(("geometric", 1.0)),
        Just(("px4-mission", 2.0)),
        (0.01..100.0).prop_map(|speed| ("crazyflie-goto", speed)),
    ];
    let execute = (controller, 1u64..100, 1e-5..1e-3, any::<bool>());
    let seed = 0u64..=i64::MAX as u64;
    (space, obstacles, generate, execute, seed, 1e-300..1e6).prop_map(
        |(space, obstacles, generate, execute, seed, max)| {
            let (size, margin, start, end) = space;
            let (reach, method, waypoints, revisits, step) = generate;
            let ((controller, goto_speed), repeat, physics, noise) = execute;
            vec![
                set("world.obstacles", obstacles),
                set("world.size_m", size),
                set("world.keep_in_margin_m", format!("{margin:?}")),
                set("task.start_m", start),
                set("task.end_m", end),
                set("generate.reach", reach),
                set("generate.timing.step_s", format!("{step:?}")),
                set("generate.search.method", method),
                set("generate.search.waypoints", waypoints),
                set("generate.search.revisits", revisits),
                set("execute.controller", controller),
                set("execute.goto_speed_m_s", format!("{goto_speed:?}")),
                set("execute.repeat", repeat),
                set("execute.step_s", format!("{physics:?}")),
                set("execute.noise", noise),
                set("spec.deviation.max_m", format!("{max:e}")),
                set("seed", seed),
            ]
        },
    )
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 128, ..ProptestConfig::default() })]

    #[test]
    fn written_and_read_again_is_the_same(sets in overrides()) {
        let scenario = read_setup(FINE, "fine.toml", Path::new(""), &sets)
            .map_err(|report| TestCaseError::fail(report.to_string()))?
            .scenario;
        let made_by = MadeBy { version: "1.2.3".into(), root_seed: scenario.seed(), simd: "avx2".into(), settings: None, keys: Vec::new(), clear_within_mm: None };
        let text = to_toml(&scenario, Some(&made_by)).map_err(|error| TestCaseError::fail(error.to_string()))?;
        let again = read_setup(&text, "scenario.toml", Path::new(""), &[])
            .map_err(|report| TestCaseError::fail(report.to_string()))?
            .scenario;
        prop_assert_eq!(&scenario, &again);
        let table: toml::Table = text.parse().expect("any TOML parser reads it");
        prop_assert_eq!(table["made_by"]["simd"].as_str(), Some("avx2"));
        prop_assert_eq!(read_made_by(&text), Some(made_by.clone()));
        prop_assert_eq!(to_toml(&again, Some(&made_by)), Ok(text));
    }

    /// Bytes cut out, doubled, replaced; words of the format thrown in: an answer, never a panic.
    #[test]
    fn no_text_makes_the_reader_panic(
        edits in prop::collection::vec((any::<prop::sample::Index>(), 0usize..12, prop_oneof![
            Just(""), Just("nan"), Just("-1"), Just("[["), Just("]"), Just("{"), Just("}"), Just("\""), Just("é"),
            Just("\n"), Just("= 1e400"), Just("\"\"\""), Just("9223372036854775808"), Just("[vary]\n"), Just("x.y.z"),
            Just("normal = [1, 2]"), Just("1979-05-27"), Just("\\u0000"), Just("\u{0}"),
        ]), 1..6),
        key in "[a-z_.\\[\\]0-9\"]{0,24}", value in "\\PC{0,16}", with_set in any::<bool>(),
    ) {
        let mut text: Vec<char> = FINE.chars().collect();
        for (at, cut, insert) in &edits {
            let at = at.index(text.len() + 1);
            let end = (at + cut).min(text.len());
            text.splice(at..end, insert.chars());
        }
        let sets = if with_set { vec![(key, value)] } else { Vec::new() };
        let text: String = text.into_iter().collect();
        if let Err(report) = read_setup(&text, "fuzzed.toml", Path::new("nowhere"), &sets) {
            prop_assert!(!report.complaints().is_empty());
            for complaint in report.complaints() {
                prop_assert!(complaint.line >= 1 && complaint.column >= 1 && !complaint.message.is_empty());
            }
            prop_assert!(!report.render(true).is_empty());
        }
    }
}
