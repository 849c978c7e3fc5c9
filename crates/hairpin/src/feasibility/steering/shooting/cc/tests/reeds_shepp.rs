//! Plain Reeds and Shepp curves by their 48 words, as an oracle: curvature may jump, so that none of continuous
//! curvature is shorter.
//!
//! J. A. Reeds and L. A. Shepp, Optimal paths for a car that goes both forwards and backwards, Pacific J. Math. 145
//! (1990).

use std::f64::consts::{FRAC_PI_2, PI, TAU};

use crate::feasibility::steering::shooting::cc::{Gears, steer};
use crate::feasibility::steering::shooting::query::{Curvatures, Goal, Query};
use crate::math::random::hashed_unit;

/// A piece of radius 1: to which side (+1 left, 0 straight, −1 right), and how far, < 0 in reverse.
type Piece = (f64, f64);

/// Into [−π, π).
fn wrap(angle: f64) -> f64 {
    (angle + PI).rem_euclid(TAU) - PI
}

fn polar(x: f64, y: f64) -> (f64, f64) {
    (x.hypot(y), y.atan2(x))
}

/// First and last turn of words of four, whose middle ones are u and v.
fn outer(u: f64, v: f64, xi: f64, eta: f64, yaw: f64) -> (f64, f64) {
    let delta = wrap(u - v);
    let (a, b) = (u.sin() - delta.sin(), u.cos() - delta.cos() - 1.0);
    let turned = (eta * a - xi * b).atan2(xi * a + eta * b);
    let behind = 2.0 * (delta.cos() - v.cos() - u.cos()) + 3.0 < 0.0;
    let first = wrap(if behind { turned + PI } else { turned });
    (first, wrap(first - u + v - yaw))
}

/// The words that begin with a turn to the left, driven forward; all others are their images.
fn words(x: f64, y: f64, yaw: f64, take: &mut dyn FnMut(&[Piece])) {
    let (sin, cos) = yaw.sin_cos();
    // The goal's circles to the left and to the right from that to the left of the start.
    let (same, other) = ((x - sin, y - 1.0 + cos), (x + sin, y - 1.0 - cos));
    let (rho, theta) = polar(same.0, same.1);
    take(&[(1.0, theta), (0.0, rho), (1.0, wrap(yaw - theta))]);
    if rho <= 4.0 {
        let u = -2.0 * (0.25 * rho).asin();
        let t = wrap(theta + 0.5 * u + PI);
        take(&[(1.0, t), (-1.0, u), (1.0, wrap(yaw - t + u))]);
    }
    if rho >= 2.0 {
        let r = (rho * rho - 4.0).sqrt();
        let t = wrap(theta + r.atan2(-2.0));
        take(&[(1.0, t), (-1.0, -FRAC_PI_2), (0.0, 2.0 - r), (1.0, wrap(yaw - FRAC_PI_2 - t))]);
    }
    let (rho, theta) = polar(other.0, other.1);
    if rho >= 2.0 {
        let u = (rho * rho - 4.0).sqrt();
        let t = wrap(theta + 2.0_f64.atan2(u));
        take(&[(1.0, t), (0.0, u), (-1.0, wrap(t - yaw))]);
        let u = 4.0 - u;
        let (xi, eta) = other;
        let t = wrap(((4.0 - u) * xi - 2.0 * eta).atan2(-2.0 * xi + (u - 4.0) * eta));
        take(&[(1.0, t), (-1.0, -FRAC_PI_2), (0.0, u), (1.0, -FRAC_PI_2), (-1.0, wrap(t - yaw))]);
    }
    let (rho_turned, t) = polar(-other.1, other.0);
    if rho_turned >= 2.0 {
        take(&[(1.0, t), (-1.0, -FRAC_PI_2), (0.0, 2.0 - rho_turned), (-1.0, wrap(t + FRAC_PI_2 - yaw))]);
    }
    let near = 0.25 * (2.0 + rho);
    if near <= 1.0 {
        let u = near.acos();
        let (t, v) = outer(u, -u, other.0, other.1, yaw);
        take(&[(1.0, t), (-1.0, u), (1.0, -u), (-1.0, v)]);
    }
    let near = (20.0 - rho * rho) / 16.0;
    if (0.0..=1.0).contains(&near) {
        let u = -near.acos();
        if u >= -FRAC_PI_2 {
            let (t, v) = outer(u, u, other.0, other.1, yaw);
            take(&[(1.0, t), (-1.0, u), (1.0, u), (-1.0, v)]);
        }
    }
}

/// Where pieces lead to: x, y, yaw.
fn end(pieces: &[Piece]) -> [f64; 3] {
    let [mut x, mut y, mut yaw] = [0.0_f64; 3];
    for &(side, metres) in pieces {
        let next = yaw + side * metres;
        if side == 0.0 {
            (x, y) = (x + metres * yaw.cos(), y + metres * yaw.sin());
        } else {
            (x, y) = (x + side * (next.sin() - yaw.sin()), y - side * (next.cos() - yaw.cos()));
        }
        yaw = next;
    }
    [x, y, yaw]
}

/// The shortest curve of radius 1, each word held to where it leads; and how many led there.
fn shortest(x: f64, y: f64, yaw: f64) -> (f64, usize) {
    let (mut best, mut valid) = (f64::INFINITY, 0);
    let (sin, cos) = yaw.sin_cos();
    // Driven from the goal back to the start, the pieces are the same in the other order.
    let back = (x * cos + y * sin, x * sin - y * cos);
    for (turned, (x0, y0)) in [(false, (x, y)), (true, back)] {
        for (reverse, side) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
            words(reverse * x0, side * y0, reverse * side * yaw, &mut |pieces| {
                let mut pieces: Vec<Piece> = pieces.iter().map(|(to, s)| (side * to, reverse * s)).collect();
                if turned {
                    pieces.reverse();
                }
                let [ex, ey, heading] = end(&pieces);
                if (ex - x).abs() + (ey - y).abs() + (0.5 * (heading - yaw)).sin().abs() < 1e-8 {
                    valid += 1;
                    best = best.min(pieces.iter().map(|(_, s)| s.abs()).sum());
                }
            });
        }
    }
    (best, valid)
}

fn drawn(seed: u64) -> [f64; 3] {
    [0, 1, 2].map(|k| (2.0 * hashed_unit(seed, &[k]) - 1.0) * if k < 2 { 5.0 } else { PI })
}

#[test]
fn known_lengths_and_every_goal_has_many_words() {
    for (goal, expected) in
        [([3.0, 0.0, 0.0], 3.0), ([-2.0, 0.0, 0.0], 2.0), ([0.0, 0.0, PI], PI), ([0.0, 0.0, FRAC_PI_2], FRAC_PI_2)]
    {
        let [x, y, yaw] = goal;
        assert!((shortest(x, y, yaw).0 - expected).abs() < 1e-9, "{goal:?}: {}", shortest(x, y, yaw).0);
    }
    for seed in 0..500 {
        let [x, y, yaw] = drawn(seed);
        let (length, valid) = shortest(x, y, yaw);
        assert!(valid >= 8 && length >= x.hypot(y) - 1e-9, "seed {seed}: {valid} words, {length}");
        // Driven back, the way is as long.
        let (sin, cos) = yaw.sin_cos();
        let other = shortest(-cos * x - sin * y, sin * x - cos * y, -yaw).0;
        assert!((length - other).abs() < 1e-8, "seed {seed}: {length} {other}");
    }
}

#[test]
fn no_drive_of_continuous_curvature_is_shorter() {
    let mut ratios = Vec::new();
    for seed in 0..2000 {
        let [x, y, yaw] = drawn(seed);
        let query = Query { start_curvature: 0.0, goal: Goal { x, y, yaw, curvature: 0.0 } };
        let least = shortest(x, y, yaw).0;
        let length = |most_rate: f64| {
            let bounds = Curvatures { most: 1.0, most_rate };
            steer(&query, &bounds, Gears::Both).expect("a path").length_m()
        };
        let (slow, quick) = (length(1.0), length(1e4));
        assert!(slow >= least - 1e-9 && quick >= least - 1e-9, "seed {seed}: {slow} {quick} below {least}");
        ratios.push(quick / least);
    }
    // Where steering takes no way, most are no longer: not all of the 48 words are driven with clothoids.
    ratios.sort_by(f64::total_cmp);
    assert!(ratios[1000] < 1.02 && ratios[1900] < 1.4, "median {}, 95 % {}", ratios[1000], ratios[1900]);
}
