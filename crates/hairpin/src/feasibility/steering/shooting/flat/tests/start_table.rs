//! Start values by table.

use super::super::{Control, Settings, Status, forward};
use super::BOUNDS;
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::math::random::hashed_unit;
use crate::trajectory::drive::{Motion, Segment};
use crate::trajectory::start_table::{ENTRIES, StartTable, StartTableError};

/// Bounds of a vehicle ten times as large as the unit one that steers as well as it.
const LARGE: Curvatures = Curvatures { most: 0.1, most_rate: 0.01 };

fn table() -> &'static StartTable {
    static TABLE: std::sync::OnceLock<StartTable> = std::sync::OnceLock::new();
    TABLE.get_or_init(|| StartTable::generate(&BOUNDS).expect("a vehicle"))
}

fn asked(seed: u64, unit: f64, bent: f64) -> Query {
    let draw = |k: u64, scale: f64| scale * (2.0 * hashed_unit(seed, &[k]) - 1.0);
    let goal = Goal {
        x: unit * (4.0 + draw(0, 4.0)),
        y: unit * draw(1, 4.0),
        yaw: draw(2, 2.0),
        curvature: draw(3, bent) / unit,
    };
    Query { start_curvature: draw(4, bent) / unit, goal }
}

#[test]
fn tables_lose_no_answer_and_cost_few_steps() {
    let plain = Settings::default();
    let looked_up = Settings { table: Some(table()), ..plain };
    for (bounds, unit, bent) in [(BOUNDS, 1.0, 0.0), (BOUNDS, 1.0, 0.5), (LARGE, 10.0, 0.0)] {
        let (mut steps, mut more, mut solved) = ([0; 2], 0, [0; 2]);
        for seed in 0..2000 {
            let query = asked(seed, unit, bent);
            let answers = [&plain, &looked_up].map(|settings| forward(&query, &bounds, settings));
            for (i, answer) in answers.iter().enumerate() {
                solved[i] += usize::from(answer.status == Status::Ok);
                steps[i] += answer.iterations;
            }
            let length = answers.map(|answer| answer.segments.iter().map(Segment::length_m).sum::<f64>());
            more += usize::from(length[1] > 1.26 * length[0]);
        }
        assert!(solved[1] >= solved[0] && solved[0] == 2000 && more == 0, "{solved:?} {more}");
        // Dubins' words are as good a start as neighbours are; what the table finds is not looked for twice.
        assert!(100 * steps[1] < 115 * steps[0], "{steps:?}");
    }
}

#[test]
fn mirrored_queries_have_mirrored_answers_with_a_table_too() {
    let settings = Settings { table: Some(table()), ..Settings::default() };
    for seed in 0..200 {
        let query = asked(seed, 1.0, 0.5);
        let Goal { x, y, yaw, curvature } = query.goal;
        let other = Query {
            start_curvature: -query.start_curvature,
            goal: Goal { x, y: -y, yaw: -yaw, curvature: -curvature },
        };
        let (left, right) = (forward(&query, &BOUNDS, &settings), forward(&other, &BOUNDS, &settings));
        assert_eq!((left.status, left.iterations), (right.status, right.iterations), "seed {seed}");
        for (a, b) in left.segments.iter().zip(right.segments.iter()) {
            assert!(a.length_m() == b.length_m() && a.curvature_at(0.1) == -b.curvature_at(0.1), "seed {seed}");
        }
    }
    // A cubic stays one.
    let cubic = Settings { control: Control::Cubic, ..settings };
    let arc = forward(&asked(3, 1.0, 0.5), &BOUNDS, &cubic);
    let Some(Motion::Arc { curvature, .. }) = arc.segments.first().map(|first| first.motion) else { panic!("{arc:?}") };
    assert!(arc.status == Status::Ok && curvature[4].abs() + curvature[5].abs() < 1e-12, "{arc:?}");
}

#[test]
fn numbers_that_are_no_table_are_refused_by_name() {
    let whole = table().entries().to_vec();
    assert_eq!(StartTable::new(1.0, whole.clone()).as_ref(), Ok(table()));
    assert_eq!(StartTable::new(1.0, whole[1..].to_vec()), Err(StartTableError::Count { found: ENTRIES - 1 }));
    assert_eq!(StartTable::new(0.0, whole.clone()), Err(StartTableError::Steering { value: 0.0 }));
    for (number, value, field) in
        [(0, f32::INFINITY, "c0"), (3, -1.0, "length"), (3, 1e9, "length"), (4, 50.0, "turn"), (2, f32::NAN, "c2")]
    {
        let mut entries = whole.clone();
        let first = entries.iter().position(|entry| entry[3] > 0.0).expect("an arc");
        entries[first][number] = value;
        let error = StartTable::new(1.0, entries).expect_err(field).to_string();
        assert!(error.contains(&format!("entry {first}, {field} = ")), "{error}");
    }
    assert!(StartTable::generate(&Curvatures { most: 1.0, most_rate: f64::NAN }).is_err());
}
