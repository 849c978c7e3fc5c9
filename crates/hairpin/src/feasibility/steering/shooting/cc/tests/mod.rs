//! Closed forms, plain Dubins curves as the limit, symmetry, and random families integrated by quadrature.

mod reeds_shepp;

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use super::super::query::{Curvatures, Goal, Query};
use super::{Gears, Path, steer};
use crate::trajectory::drive::{Gear, Motion, Segment};

const UNIT: Curvatures = Curvatures { most: 1.0, most_rate: 1.0 };

fn query(k0: f64, x: f64, y: f64, yaw: f64, kf: f64) -> Query {
    Query { start_curvature: k0, goal: Goal { x, y, yaw, curvature: kf } }
}

fn segments(path: &Path) -> Vec<Segment> {
    let mut all = Vec::new();
    path.segments(|segment| all.push(segment));
    all
}

fn length(query: &Query, bounds: &Curvatures, gears: Gears) -> f64 {
    steer(query, bounds, gears).unwrap().length_m()
}

/// End of the segments by Simpson's rule on exact headings: x, y, yaw.
fn end(segments: &[Segment]) -> [f64; 3] {
    let [mut x, mut y, mut yaw] = [0.0f64; 3];
    for segment in segments {
        let Motion::Arc { length_m, curvature } = segment.motion else { panic!("no turns in place here") };
        let sign = segment.gear.sign();
        let heading = |s: f64| {
            let sum = (0..6).rev().fold(0.0, |sum, i| sum * s + curvature[i] / (i + 1) as f64);
            yaw + sign * sum * s
        };
        let pieces = if curvature == [0.0; 6] { 2 } else { 2 * (30 + (length_m * 20.0) as usize) };
        let h = length_m / pieces as f64;
        for i in 0..=pieces {
            let weight = if i == 0 || i == pieces { 1.0 } else { [2.0, 4.0][i % 2] };
            let at = heading(i as f64 * h);
            x += sign * weight * h / 3.0 * at.cos();
            y += sign * weight * h / 3.0 * at.sin();
        }
        yaw = heading(length_m);
    }
    [x, y, yaw]
}

/// Panics unless `path` solves `query` within `bounds` in the allowed gears.
fn check(query: &Query, bounds: &Curvatures, gears: Gears, path: &Path) {
    let segments = segments(path);
    let [x, y, yaw] = end(&segments);
    let goal = &query.goal;
    let off = (x - goal.x).hypot(y - goal.y);
    assert!(off < 1e-7, "{off} m off: {query:?} {bounds:?} {segments:?}");
    assert!((0.5 * (yaw - goal.yaw)).sin().abs() < 1e-8, "yaw: {query:?} {segments:?}");
    let total: f64 = segments.iter().map(Segment::length_m).sum();
    assert!((total - path.length_m()).abs() < 1e-9 * (1.0 + total), "{total} {}", path.length_m());
    let straight = segments.len() == 1 && total == 0.0;
    let mut before: Option<(f64, Gear)> = (!straight).then_some((query.start_curvature, segments[0].gear));
    for segment in &segments {
        let Motion::Arc { length_m, curvature } = segment.motion else { panic!("no turns in place here") };
        let (from, to) = (segment.curvature_at(0.0), segment.curvature_at(length_m));
        assert!(from.abs().max(to.abs()) <= bounds.most, "{query:?} {segment:?}");
        assert!(curvature[1].abs() <= bounds.most_rate, "{query:?} {segment:?}");
        if let Some((at, gear)) = before {
            assert!(gear != segment.gear || (at - from).abs() < 1e-9, "jump to {segment:?} in {segments:?}");
        }
        if let Gears::Only(gear) = gears {
            assert_eq!(segment.gear, gear);
        }
        before = Some((to, segment.gear));
    }
    let first = segments[0].curvature_at(0.0);
    let last = segments.last().map_or(0.0, |s| s.curvature_at(s.length_m()));
    assert!(straight || ((first - query.start_curvature).abs() < 1e-9 && (last - goal.curvature).abs() < 1e-9));
}

/// A stream of numbers in [0, 1) from a seed (splitmix64).
fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state = state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        ((z ^ (z >> 31)) >> 11) as f64 / (1u64 << 53) as f64
    }
}

/// Shortest Dubins path of radius 1 by its six words (Shkel and Lumelsky, 2001).
fn dubins(x: f64, y: f64, yaw: f64) -> f64 {
    let wrap = |angle: f64| angle.rem_euclid(TAU);
    let (d, theta) = (x.hypot(y), y.atan2(x));
    let (a, b) = (wrap(-theta), wrap(yaw - theta));
    let (sa, ca, sb, cb, cab) = (a.sin(), a.cos(), b.sin(), b.cos(), (a - b).cos());
    let mut best = f64::INFINITY;
    let mut offer = |square: f64, path: &dyn Fn(f64) -> f64| {
        if square >= 0.0 {
            best = f64::min(best, path(square.sqrt()));
        }
    };
    offer(2.0 + d * d - 2.0 * cab + 2.0 * d * (sa - sb), &|p| {
        let t = (cb - ca).atan2(d + sa - sb);
        wrap(t - a) + p + wrap(b - t)
    });
    offer(2.0 + d * d - 2.0 * cab + 2.0 * d * (sb - sa), &|p| {
        let t = (ca - cb).atan2(d - sa + sb);
        wrap(a - t) + p + wrap(t - b)
    });
    offer(-2.0 + d * d + 2.0 * cab + 2.0 * d * (sa + sb), &|p| {
        let t = (-ca - cb).atan2(d + sa + sb) - (-2.0f64).atan2(p);
        wrap(t - a) + p + wrap(t - b)
    });
    offer(-2.0 + d * d + 2.0 * cab - 2.0 * d * (sa + sb), &|p| {
        let t = (ca + cb).atan2(d - sa - sb) - 2.0f64.atan2(p);
        wrap(a - t) + p + wrap(b - t)
    });
    let mut middle = |cosine: f64, path: &dyn Fn(f64) -> f64| {
        if cosine.abs() <= 1.0 {
            best = f64::min(best, path(TAU - cosine.acos()));
        }
    };
    middle((6.0 - d * d + 2.0 * cab + 2.0 * d * (sa - sb)) / 8.0, &|p| {
        let t = wrap(a - (ca - cb).atan2(d - sa + sb) + p / 2.0);
        t + p + wrap(a - b - t + p)
    });
    middle((6.0 - d * d + 2.0 * cab + 2.0 * d * (sb - sa)) / 8.0, &|p| {
        let t = wrap(-a + (cb - ca).atan2(d + sa - sb) + p / 2.0);
        t + p + wrap(b - a - t + p)
    });
    best
}

#[test]
fn straight_lines_and_pure_turns_are_themselves() {
    for gears in [Gears::Both, Gears::Only(Gear::Forward)] {
        assert_eq!(
            segments(&steer(&query(0.0, 7.5, 0.0, 0.0, 0.0), &UNIT, gears).unwrap()),
            [Segment::straight(7.5, Gear::Forward)]
        );
    }
    let back = steer(&query(0.0, -0.3, 0.0, TAU, 0.0), &UNIT, Gears::Both).unwrap();
    assert_eq!(segments(&back), [Segment::straight(0.3, Gear::Reverse)]);
    assert_eq!(length(&query(0.0, 0.0, 0.0, 0.0, 0.0), &UNIT, Gears::Both), 0.0);
    // A turn of clothoid, arc of 0.8 rad, clothoid: 1 + 0.8 + 1 m and 1.8 rad at unit bounds.
    let turn = [
        Segment::clothoid(1.0, 0.0, 1.0, Gear::Forward),
        Segment::clothoid(0.8, 1.0, 1.0, Gear::Forward),
        Segment::clothoid(1.0, 1.0, 0.0, Gear::Forward),
    ];
    let [x, y, yaw] = end(&turn);
    assert!((yaw - 1.8).abs() < 1e-12);
    let found = steer(&query(0.0, x, y, yaw, 0.0), &UNIT, Gears::Only(Gear::Forward)).unwrap();
    assert!((found.length_m() - 2.8).abs() < 1e-9 && segments(&found).len() == 3, "{found:?}");
    // From arc to arc there is nothing but the arc.
    let (x, y) = (1.3f64.sin(), 1.0 - 1.3f64.cos());
    assert!((length(&query(1.0, x, y, 1.3, 1.0), &UNIT, Gears::Only(Gear::Forward)) - 1.3).abs() < 1e-9);
}

#[test]
fn random_families_end_where_they_must_within_bounds() {
    for gears in [Gears::Both, Gears::Only(Gear::Forward), Gears::Only(Gear::Reverse)] {
        let mut next = uniform(7);
        for i in 0..20_000 {
            let size = [0.05, 1.0, 5.0, 100.0][i % 4];
            let bounds =
                Curvatures { most: [1.0, 1.0, 3.0, 0.2][i / 4 % 4], most_rate: [1.0, 0.05, 20.0, 1.0][i / 16 % 4] };
            let mut between = |from: f64, to: f64| from + (to - from) * next();
            let (x, y, yaw) = (between(-size, size), between(-size, size), between(-PI, PI));
            let bend = if i % 3 == 0 { 0.0 } else { bounds.most };
            let query = query(between(-bend, bend), x, y, yaw, between(-bend, bend));
            let path = steer(&query, &bounds, gears).unwrap_or_else(|| panic!("{i}: {query:?} {bounds:?}"));
            check(&query, &bounds, gears, &path);
        }
    }
}

#[test]
fn special_places_have_paths() {
    let places = [0.0, 1e-12, 1e-6, 0.3, 1.0, 2.0, -1.0, -2.0];
    for &x in &places {
        for &y in &places {
            for yaw in [0.0, 1e-12, FRAC_PI_2, PI, -PI, -1e-9] {
                for k in [0.0, 1.0, -1.0, 0.5] {
                    for gears in [Gears::Both, Gears::Only(Gear::Forward)] {
                        let query = query(k, x, y, yaw, -k);
                        check(&query, &UNIT, gears, &steer(&query, &UNIT, gears).unwrap());
                    }
                }
            }
        }
    }
    let far = query(0.0, 1e6, -1e6, 2.0, 0.0);
    assert!(length(&far, &UNIT, Gears::Both) < 1e6 * std::f64::consts::SQRT_2 + 10.0);
}

#[test]
fn lengths_fall_with_the_rate_towards_those_of_dubins() {
    let mut next = uniform(3);
    for i in 0..2000 {
        let mut between = |from: f64, to: f64| from + (to - from) * next();
        let (x, y, yaw) = (between(-6.0, 6.0), between(-6.0, 6.0), between(-PI, PI));
        let query = query(0.0, x, y, yaw, 0.0);
        let lengths = [1.0, 10.0, 1e3, 1e7]
            .map(|most_rate| length(&query, &Curvatures { most: 1.0, most_rate }, Gears::Only(Gear::Forward)));
        let plain = dubins(x, y, yaw);
        assert!((lengths[3] - plain).abs() < 2e-3 || lengths[3] < plain, "{i}: {query:?} {lengths:?} {plain}");
        assert!(
            lengths.iter().all(|length| *length > plain - 1e-9),
            "{i}: shorter than the shortest: {lengths:?} {plain}"
        );
        let cusps = length(&query, &UNIT, Gears::Both);
        assert!(cusps <= lengths[0] + 1e-9 && cusps >= x.hypot(y) - 1e-9, "{i}: {cusps} {lengths:?}");
    }
}

#[test]
fn reeds_and_shepp_appear_where_clothoids_vanish() {
    let bounds = Curvatures { most: 1.0, most_rate: 1e8 };
    // On the spot by 180° and 90° in three arcs: as many radians of arc. A U-turn within one radius: a half turn in
    // all.
    for (x, y, yaw, shortest) in
        [(0.0, 0.0, PI, PI), (0.0, 0.0, FRAC_PI_2, FRAC_PI_2), (-4.0, 0.0, 0.0, 4.0), (0.0, 2.0, PI, PI)]
    {
        let found = length(&query(0.0, x, y, yaw, 0.0), &bounds, Gears::Both);
        assert!((found - shortest).abs() < 1e-3, "{x} {y} {yaw}: {found}, not {shortest}");
    }
}

#[test]
fn mirrored_questions_have_mirrored_answers() {
    let mut next = uniform(11);
    for _ in 0..2000 {
        let mut between = |from: f64, to: f64| from + (to - from) * next();
        let (x, y, yaw) = (between(-5.0, 5.0), between(-5.0, 5.0), between(-PI, PI));
        let (k0, kf) = (between(-1.0, 1.0), between(-1.0, 1.0));
        for gears in [Gears::Both, Gears::Only(Gear::Forward)] {
            let direct = length(&query(k0, x, y, yaw, kf), &UNIT, gears);
            let left_right = length(&query(-k0, x, -y, -yaw, -kf), &UNIT, gears);
            assert!((direct - left_right).abs() < 1e-9, "{direct} {left_right}");
            // Driven from the goal to the start, heading the other way, and mirrored: curvatures keep their signs.
            let (sin, cos) = yaw.sin_cos();
            let seen = (cos * x + sin * y, cos * y - sin * x);
            let from_the_end = length(&query(kf, seen.0, -seen.1, yaw, k0), &UNIT, gears);
            assert!((direct - from_the_end).abs() < 1e-8, "{direct} {from_the_end}");
        }
        let front_back = length(&query(k0, -x, y, -yaw, kf), &UNIT, Gears::Both);
        assert!((length(&query(k0, x, y, yaw, kf), &UNIT, Gears::Both) - front_back).abs() < 1e-9);
    }
}
