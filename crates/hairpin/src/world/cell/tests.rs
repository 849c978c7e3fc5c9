use nalgebra::Point3;
use rand::RngExt;

use super::*;
use crate::math::outward::Interval;
use crate::math::random::stream;

fn words(text: &str) -> Words {
    Words::parse(text, 1.0).unwrap_or_else(|error| panic!("{text}: {error}"))
}

#[test]
fn words_mean_what_they_say() {
    for (text, inside, outside) in [
        ("x^2 + y^2 < 190^2 and z < 480", [100.0, 100.0, 479.0], [100.0, 100.0, 480.0]),
        ("-x^2 + 2*y/4 - -1 >= 0", [1.0, 0.0, 0.0], [1.1, 0.0, 0.0]),
        ("not (x < 1 or y < 1)", [1.0, 1.0, 0.0], [0.9, 1.0, 0.0]),
        ("0 < x < y <= 2", [1.0, 2.0, 0.0], [1.0, 2.1, 0.0]),
        ("max(abs(x), abs(y)) <= 1.5e0 AND min(z, 3) > .5", [-1.5, 1.0, 1.0], [-1.6, 1.0, 1.0]),
        ("sqrt((x - 1)^2 + y^2) < 2", [2.9, 0.0, 9.0], [3.1, 0.0, 9.0]),
        ("((x) < 1) and (((y < 1)))", [0.0; 3], [0.0, 1.0, 0.0]),
        ("x < 1 or y < 1 and z < 1", [0.0, 5.0, 5.0], [5.0, 0.0, 5.0]),
        ("2^3^0 < 9 and x > 1", [2.0; 3], [1.0; 3]),
    ] {
        if text.contains("^3^") {
            assert!(Words::parse(text, 1.0).is_err(), "towers of powers are ambiguous");
            continue;
        }
        let parsed = words(text);
        assert!(parsed.holds(inside) && !parsed.holds(outside), "{text}");
        for (point, truth) in [(inside, true), (outside, false)] {
            let told = parsed.holds_on(point.map(Interval::point));
            assert!(told.is_none_or(|told| told == truth), "{text} at {point:?}: {told:?}");
        }
        assert_eq!(parsed.text(), text);
    }
    // In millimetres: 0.1 m are 100 mm.
    let mm = Words::parse("x < 100.5", 1000.0).unwrap();
    assert!(mm.holds([0.1, 0.0, 0.0]) && !mm.holds([0.101, 0.0, 0.0]));
    for text in ["y/x > 0 or y/x <= 0", "not y/x > 0", "not (y/x <= 0 and z < 1)"] {
        assert!(!words(text).holds([0.0; 3]), "{text}: nothing is true of no number");
    }
    assert!(words("not y/x > 0 or z < 1").holds([0.0; 3]), "what decides by itself decides");
}

#[test]
fn mistakes_are_told_with_their_column() {
    for (text, column, expected) in [
        ("", 1, "a number"),
        ("x + 1", 6, "a comparison"),
        ("x < 1 and", 10, "a number"),
        ("x < 1 &", 7, "a number"),
        ("x <> 1", 4, "a number"),
        ("(x < 1", 7, "`)`"),
        ("x < 1) or y < 2", 6, "the end"),
        ("w < 1", 1, "a number, x, y, z, sqrt"),
        ("sin(x) < 1", 1, "sqrt, abs, min, max"),
        ("min(x) < 1", 6, "`,`"),
        ("x^y < 1", 3, "a whole number"),
        ("x^2.5 < 1", 3, "a whole number"),
        ("(x < 1) + 2 < 3", 13, "not a comparison"),
        ("x and y < 1", 12, "a comparison"),
        ("1.2.3 < x", 1, "a number"),
        ("ä < 1", 1, "a number"),
        ("x < § 1", 5, "a number"),
    ] {
        let error = Words::parse(text, 1.0).expect_err(text);
        assert!(error.column == column && error.expected.contains(expected), "{text:?}: {error}");
    }
    let deep = format!("{}x{} < 1", "(".repeat(300), ")".repeat(300));
    assert!(Words::parse(&deep, 1.0).unwrap_err().expected.contains("fewer parentheses"));
    assert!(Words::parse(&format!("{}x < 1", "-".repeat(500)), 1.0).unwrap_err().expected.contains("fewer"));
    assert!(Words::parse(&format!("x{} < 1", "+x".repeat(600)), 1.0).unwrap_err().expected.contains("at most 1000"));
}

#[test]
fn numbers_that_are_no_region() {
    let field = |region: Result<Region, crate::world::WorldError>| region.unwrap_err().field;
    assert_eq!(field(Region::cylinder([0.0; 3], [0.0; 3], 1.0)), "cylinder.b_m");
    assert_eq!(field(Region::cylinder([0.0; 3], [0.0, 0.0, f64::NAN], 1.0)), "cylinder.b_m");
    assert_eq!(field(Region::cylinder([0.0; 3], [0.0, 0.0, 1.0], -1.0)), "cylinder.radius_m");
    assert_eq!(field(Region::half_space([0.0; 3], 1.0)), "half_space.normal");
    assert_eq!(field(Region::half_space([0.0, 0.0, 1.0], f64::INFINITY)), "half_space.offset_m");
    assert_eq!(field(Region::beyond([0.0; 3], 0.0)), "reach.radius_m");
}

/// The distance to a cylinder against the least of many samples.
#[test]
fn distances_to_cylinders_are_the_least_of_samples() {
    let mut random = stream(12);
    for case in 0..400 {
        let mut point = || Point3::from(nalgebra::Vector3::from_fn(|_, _| random.random_range(-1.0..1.0f64)));
        let (from, to, a, b) = (point(), point(), point(), point());
        let radius = 0.05 + 0.3 * (point().x.abs());
        let cylinder = Region::cylinder(from.into(), to.into(), radius).unwrap();
        let told = cylinder.segment_distance(&a, &b).unwrap();
        let axis = to - from;
        let sample = |t: f64| {
            let w = a + (b - a) * t - from;
            let along = w.dot(&axis) / axis.norm();
            let out = ((w - axis * (w.dot(&axis) / axis.norm_squared())).norm() - radius).max(0.0);
            let end = (along - axis.norm()).max(-along).max(0.0);
            end.hypot(out)
        };
        let least = (0..=4000).map(|i| sample(f64::from(i) / 4000.0)).fold(f64::INFINITY, f64::min);
        let error = told.max(0.0) - least;
        assert!(error < 1e-9 && error > -1e-3, "case {case}: {told} {least}");
    }
}

#[test]
fn words_leave_room_or_do_not() {
    let region = Region::Words(Words::parse("x^2 + y^2 < 190^2 and z < 480", 1000.0).unwrap());
    let (a, b) = (Point3::new(0.4, -0.3, 0.3), Point3::new(0.4, 0.3, 0.3));
    assert!(region.is_clear(&a, &b, 0.1) && !region.meets(&a, &b, 0.1));
    assert!(!region.is_clear(&a, &b, 0.22) && region.meets(&a, &b, 0.22));
    assert!(region.segment_distance(&a, &b).is_none());
    let through = (Point3::new(0.4, 0.0, 0.3), Point3::new(-0.4, 0.0, 0.3));
    assert!(!region.is_clear(&through.0, &through.1, 0.0) && region.meets(&through.0, &through.1, 0.0));
}
