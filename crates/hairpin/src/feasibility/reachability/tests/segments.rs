use nalgebra::{Point3, Vector3};
use rand::RngExt;

use super::super::*;
use super::exact::{self, Place};
use crate::math::random::{Stream, named_seed, stream};
use crate::math::simd::Simd;
use crate::world::Shape;
use crate::world::cell::{Cell, Part, Region, Words};

fn place(p: &Place) -> Point3<f64> {
    Point3::new(p[0] as f64, p[1] as f64, p[2] as f64)
}

fn integers(random: &mut Stream, most: i128) -> Place {
    std::array::from_fn(|_| random.random_range(-most..=most))
}

fn cell(regions: Vec<Region>) -> Cell {
    let parts = regions.into_iter().enumerate().map(|(i, region)| Part { name: format!("part {i}"), region });
    Cell { parts: parts.collect() }
}

/// What a graph of two points, and so the filter, says of a segment: the third must be far from all.
fn filtered(region: &Region, a: &Point3<f64>, b: &Point3<f64>, radius: f64) -> (bool, bool) {
    let settings = CartesianSettings { radius, ..Default::default() };
    let graph = cartesian(&[*a, *b], &cell(vec![region.clone()]), &settings);
    let undecided = matches!(graph.refusal(0, 1), Some(Refusal::ToolMeets { undecided: true, .. }));
    (graph.is_free(0, 1), undecided)
}

/// A segment that passes a ball of integer radius closely, or exactly touches it: its ends lie on a line at the ball's
/// own distance from the centre, plus a little.
fn near_tangent(random: &mut Stream, centre: &Place, radius: i128, most: i128) -> (Place, Place) {
    let axis = random.random_range(0..3);
    let (next, last) = ((axis + 1) % 3, (axis + 2) % 3);
    let (mut a, mut b) = (*centre, *centre);
    let off = radius + random.random_range(-1..=1) * i128::from(random.random_bool(0.5));
    (a[axis], b[axis]) = (a[axis] + off, b[axis] + off);
    (a[next], b[next]) = (a[next] - random.random_range(0..=most), b[next] + random.random_range(0..=most));
    let tilt = random.random_range(-most..=most);
    (a[last], b[last]) = (a[last] - tilt, b[last] + tilt);
    (a, b)
}

/// Two hundred thousand segments, random and nearly touching: what is proven is never otherwise in exact arithmetic,
/// and nearly all is proven.
#[test]
fn proofs_never_contradict_exact_arithmetic() {
    let mut random = stream(named_seed(7, "segments", 0));
    let (mut undecided, mut touching, mut clear) = (0, 0, 0);
    let total = 20_000;
    for case in 0..total {
        let scale = [40, 3000, 1 << 20][case % 3];
        let centre = integers(&mut random, scale);
        let radius = random.random_range(1..=scale);
        let (a, b) = match case % 4 {
            0 => near_tangent(&mut random, &centre, radius, scale),
            1 => {
                let a = integers(&mut random, scale);
                (a, a)
            }
            _ => (integers(&mut random, scale), integers(&mut random, scale)),
        };
        let other: Place = std::array::from_fn(|k| centre[k] + random.random_range(1..=scale));
        let normal = loop {
            let normal = integers(&mut random, 50);
            if normal != [0; 3] {
                break normal;
            }
        };
        let offset = random.random_range(-5 * scale..=5 * scale);
        let (grown, own) = if case % 2 == 0 && radius > 1 { (1, radius - 1) } else { (0, radius) };
        let centre_f: [f64; 3] = place(&centre).into();
        let ball = Region::Shape(Shape::sphere(centre_f, own as f64).unwrap());
        let half: [f64; 3] = std::array::from_fn(|k| (other[k] - centre[k]) as f64);
        let middle: [f64; 3] = std::array::from_fn(|k| (other[k] + centre[k]) as f64 / 2.0);
        let cuboid = Region::Shape(Shape::cuboid(middle, half).unwrap());
        let floor = Region::half_space(place(&normal).into(), offset as f64).unwrap();
        let beyond = Region::beyond(centre_f, radius as f64).unwrap();
        for (region, radius, truth) in [
            (ball, grown as f64, exact::meets_ball(&a, &b, &centre, radius)),
            (cuboid, 0.0, exact::meets_box(&a, &b, &centre, &other)),
            (floor, 0.0, exact::meets_half_space(&a, &b, &normal, offset)),
            (beyond, 0.0, !exact::stays_inside(&a, &b, &centre, radius)),
        ] {
            let (free, unsure) = filtered(&region, &place(&a), &place(&b), radius);
            assert!(!free || !truth, "case {case}: {a:?} {b:?} called clear of {region:?}");
            assert!(free || unsure || truth, "case {case}: {a:?} {b:?} called a hit of {region:?}");
            let verdict = Obstacle::new(region.clone()).certify(&place(&a), &place(&b), radius);
            match verdict {
                Verdict::Clear => assert!(!truth, "case {case}: {a:?} {b:?} {region:?}"),
                Verdict::Hit { at } => {
                    assert!(truth && (0.0..=1.0).contains(&at), "case {case}: {a:?} {b:?} {region:?}")
                }
                Verdict::Undecided { .. } => {}
            }
            undecided += usize::from(unsure);
            touching += usize::from(truth);
            clear += usize::from(free);
        }
    }
    println!("{clear} clear, {touching} hits, {undecided} undecided");
    assert!(undecided < total / 4 && clear > total && touching > total, "{clear} {touching} {undecided}");
}

/// Regions of every kind around the origin, and how far they reach.
fn regions() -> Vec<Region> {
    let corners = |s: f64| -> Vec<[f64; 3]> {
        (0..8).map(|i| [0, 1, 2].map(|k| if i >> k & 1 == 1 { s } else { -s * (1.0 + 0.2 * k as f64) })).collect()
    };
    let faces = [
        [0, 2, 1],
        [1, 2, 3],
        [4, 5, 6],
        [5, 7, 6],
        [0, 1, 4],
        [1, 5, 4],
        [2, 6, 3],
        [3, 6, 7],
        [0, 4, 2],
        [2, 4, 6],
        [1, 3, 5],
        [3, 7, 5],
    ];
    vec![
        Region::Shape(Shape::sphere([0.1, 0.0, -0.1], 0.3).unwrap()),
        Region::Shape(Shape::cuboid([0.1, 0.0, 0.0], [0.3, 0.5, 0.7]).unwrap()),
        Region::Shape(Shape::capsule([-0.3, 0.0, 0.1], [0.3, 0.2, 0.0], 0.15).unwrap()),
        Region::cylinder([0.0, 0.0, -0.3], [0.0, 0.0, 0.4], 0.25).unwrap(),
        Region::cylinder([-0.3, 0.1, -0.2], [0.2, 0.3, 0.3], 0.2).unwrap(),
        Region::half_space([0.1, -0.2, 1.0], -0.2).unwrap(),
        Region::beyond([0.0, 0.1, 0.0], 0.9).unwrap(),
        Region::Shape(Shape::hull(&corners(0.3)).unwrap()),
        Region::Shape(Shape::mesh(&corners(0.35), &faces).unwrap()),
        Region::Words(Words::parse("x^2 + y^2 < 190^2 and z < 480", 1000.0).unwrap()),
    ]
}

/// Floating point and proof agree but for what nearly touches, for every kind of region, grown and not.
#[test]
fn fast_agrees_away_from_contact() {
    let mut random = stream(named_seed(8, "segments", 1));
    for (kind, region) in regions().into_iter().enumerate() {
        let obstacle = Obstacle::new(region.clone());
        let (mut decided, mut differ, mut hits) = (0, 0, 0);
        let cases = if kind >= 7 { 2000 } else { 20_000 };
        for case in 0..cases {
            let mut point = || Point3::from(Vector3::from_fn(|_, _| random.random_range(-1.0..1.0f64)));
            let (a, b) = (point(), point());
            let radius = if case % 2 == 0 { 0.0 } else { 0.08 };
            let fast = region.meets(&a, &b, radius);
            let proven = obstacle.certify(&a, &b, radius);
            let (free, unsure) = filtered(&region, &a, &b, radius);
            match proven {
                Verdict::Undecided { .. } => continue,
                Verdict::Clear => assert!(free, "{kind} case {case}"),
                Verdict::Hit { at } => {
                    assert!(!free || unsure, "{kind} case {case}");
                    hits += 1;
                    if let Some(distance) = region.segment_distance(&(a + (b - a) * at), &(a + (b - a) * at)) {
                        assert!(distance <= radius + 1e-9, "{kind} case {case}: {distance} at {at}");
                    }
                }
            }
            decided += 1;
            differ += usize::from(fast != (proven != Verdict::Clear));
        }
        println!("{kind}: {decided} of {cases} decided, {hits} hits, {differ} differ");
        let most_unsure = if kind == 9 { cases / 10 } else { 2 };
        assert!(cases - decided <= most_unsure && hits > cases / 30 && hits < cases, "{kind}: {decided} {hits}");
        // Words are looked at in samples, hulls' distances are parry's.
        assert!(differ <= if kind == 9 { cases / 100 } else { 0 }, "{kind}: {differ}");
    }
}

/// It is the segment, not the line: ends on the border, tangents, no length, inside, wholly inside a closed surface.
#[test]
fn ends_tangents_points_and_insides() {
    let at = |p: [f64; 3]| Point3::from(p);
    let regions = regions();
    let verdict =
        |region: &Region, a: [f64; 3], b: [f64; 3]| Obstacle::new(region.clone()).certify(&at(a), &at(b), 0.0);
    let ball = Region::Shape(Shape::sphere([0.0; 3], 1.0).unwrap());
    let refused = |verdict: Verdict| verdict != Verdict::Clear;
    assert!(refused(verdict(&ball, [2.0, 0.0, 0.0], [1.0, 0.0, 0.0])), "an end on the ball");
    assert_eq!(
        verdict(&ball, [2.0, 0.0, 0.0], [1.0 + 1e-9, 0.0, 0.0]),
        Verdict::Clear,
        "before it: the line would hit"
    );
    assert!(refused(verdict(&ball, [-2.0, 1.0, 0.0], [2.0, 1.0, 0.0])), "a tangent");
    assert_eq!(verdict(&ball, [-2.0, 1.0 + 1e-9, 0.0], [2.0, 1.0 + 1e-9, 0.0]), Verdict::Clear, "a near miss");
    assert!(matches!(verdict(&ball, [-2.0, 1.0 - 1e-9, 0.0], [2.0, 1.0 - 1e-9, 0.0]), Verdict::Hit { .. }));
    for (kind, region) in regions.iter().enumerate() {
        let far = if kind == 6 { [0.0, 0.1, 0.0] } else { [0.9, 0.8, 0.95] };
        let inside = if kind == 6 {
            [0.9, 0.8, 0.95]
        } else if kind == 5 {
            [0.0, 0.0, -0.9]
        } else {
            [0.0, 0.05, 0.0]
        };
        assert_eq!(verdict(region, far, far), Verdict::Clear, "kind {kind}: a point outside");
        assert!(matches!(verdict(region, inside, inside), Verdict::Hit { .. }), "kind {kind}: a point inside");
        let short = inside.map(|c| c + 1e-3);
        assert!(matches!(verdict(region, inside, short), Verdict::Hit { .. }), "kind {kind}: wholly inside");
        assert!(matches!(verdict(region, inside, far), Verdict::Hit { .. }), "kind {kind}: out of it");
        let fast = |a, b| region.meets(&at(a), &at(b), 0.0);
        assert!(fast(inside, short) && fast(inside, far) && !fast(far, far), "kind {kind}");
    }
}

/// Every SIMD level and both directions give the same graph.
#[test]
fn graphs_are_symmetric_and_the_same_at_every_level() {
    let mut random = stream(named_seed(9, "segments", 2));
    let points: Vec<Point3<f64>> =
        (0..60).map(|_| Point3::from(Vector3::from_fn(|_, _| random.random_range(-1.0..1.0)))).collect();
    let cell = cell(regions());
    let graph = |simd| cartesian(&points, &cell, &CartesianSettings { radius: 0.01, simd, level: Level::Certified });
    let (widest, portable) = (graph(Simd::Widest), graph(Simd::Portable));
    assert_eq!(widest, portable);
    let fast = cartesian(&points, &cell, &CartesianSettings { radius: 0.01, level: Level::Fast, ..Default::default() });
    let names: Vec<String> = cell.parts.iter().map(|part| part.name.clone()).collect();
    let mut differ = 0;
    for i in 0..60 {
        assert!(!widest.is_free(i, i) && widest.refusal(i, i).is_none());
        for j in 0..60 {
            assert_eq!(widest.is_free(i, j), widest.is_free(j, i));
            assert_eq!(widest.is_free(i, j) || i == j, widest.refusal(i, j).is_none());
            assert!(!widest.is_free(i, j) || fast.is_free(i, j), "proven clear, but met in floating point");
            differ += usize::from(widest.is_free(i, j) != fast.is_free(i, j));
        }
    }
    let refused = (0..60).find_map(|j| widest.refusal(0, j)).expect("some move from the first point is refused");
    assert!(refused.in_words(&names).to_string().starts_with("the tool's sphere "), "{}", refused.in_words(&names));
    assert!((0.005..0.9).contains(&widest.density()) && differ < 60, "{} {differ}", widest.density());
    assert!(widest.queries_per_pair() > 1.0 && widest.queries_per_pair() <= 10.0);
}
