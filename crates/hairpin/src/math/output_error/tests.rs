//! Against what is known in closed form, and by drawing.

use super::*;
use crate::math::random::{standard_normals, stream};

const SAMPLES: usize = 600;
const BLOCK: usize = 30;

/// A decay a·e^(−bt), and noise of AR(1) with coefficient `rho`.
fn measured(seed: u64, rho: f64) -> Vec<f64> {
    let mut random = stream(seed);
    let mut noise = standard_normals::<1>(&mut random)[0];
    (0..SAMPLES)
        .map(|i| {
            noise = rho * noise + (1.0 - rho * rho).sqrt() * standard_normals::<1>(&mut random)[0];
            decay(&[2.0, 0.5], i) + 0.2 * noise
        })
        .collect()
}

fn decay(theta: &[f64], i: usize) -> f64 {
    // Again and again, as legs of a flight are.
    theta[0] * (-theta[1] * 0.1 * (i % 60) as f64).exp()
}

fn objective<'a>(residuals: &'a Residuals<'a>) -> Objective<'a> {
    let block: Vec<usize> = (0..SAMPLES).map(|i| i / BLOCK).collect();
    let begins = (0..SAMPLES / BLOCK).map(|block| block == 0).collect();
    let parameter = |low, high| Parameter { low, high, step: 1e-3 };
    Objective {
        residuals,
        output: vec![0; SAMPLES],
        block,
        begins,
        parameters: vec![parameter(0.1, 10.0), parameter(0.01, 5.0), parameter(-10.0, 10.0)],
    }
}

/// White residuals: the rise of χ²₁ gives the interval that the normal equations' inverse gives.
#[test]
fn with_white_noise_the_profile_is_that_of_least_squares() {
    let y = measured(3, 0.0);
    let residuals = |theta: &[f64]| Some(y.iter().enumerate().map(|(i, y)| y - decay(theta, i)).collect());
    let objective = objective(&residuals);
    let free = [0, 1];
    let at = descend(&objective, &[1.0, 1.0, 0.0], &free).unwrap();
    assert!((at.theta[0] - 2.0).abs() < 0.1 && (at.theta[1] - 0.5).abs() < 0.05, "{:?}", at.theta);
    let spread = spread(&objective, &at, &free).unwrap();
    // Σ (∂f/∂θ)(∂f/∂θ)ᵀ/σ², by hand.
    let s2 = at.value.residuals.iter().map(|r| r * r).sum::<f64>() / SAMPLES as f64;
    let mut h = nalgebra::Matrix2::zeros();
    for i in 0..SAMPLES {
        let t = 0.1 * (i % 60) as f64;
        let e = (-at.theta[1] * t).exp();
        let row = nalgebra::Vector2::new(e, -at.theta[0] * t * e);
        h += row * row.transpose() / s2;
    }
    let inverse = h.try_inverse().unwrap();
    for k in 0..2 {
        assert!((spread.white[(k, k)] / inverse[(k, k)] - 1.0).abs() < 1e-3);
        // The jackknife agrees within what 20 blocks can tell.
        let ratio = spread.covariance[(k, k)] / inverse[(k, k)];
        assert!(ratio > 0.3 && ratio < 3.0, "{ratio}");
        let half = (3.841_459 * inverse[(k, k)]).sqrt();
        let ends = profile(&objective, &at, &free, &spread, (k, 3.841_459));
        for (sign, side) in [-1.0, 1.0].into_iter().zip(ends) {
            let Side::Closed(end) = side else { panic!("{side:?}") };
            assert!((end - at.theta[k] - sign * half).abs() < 0.08 * half, "{end} {} {half}", at.theta[k]);
        }
    }
}

/// Coloured residuals of AR(1) at 0.9: white intervals cover far too rarely, these as often as they say.
#[test]
fn intervals_cover_with_coloured_noise() {
    let (mut held, mut white, draws) = ([0, 0], [0, 0], 200);
    for seed in 0..draws {
        let y = measured(1000 + seed, 0.9);
        let residuals = |theta: &[f64]| Some(y.iter().enumerate().map(|(i, y)| y - decay(theta, i)).collect());
        let objective = objective(&residuals);
        let free = [0, 1];
        let at = descend(&objective, &[1.0, 1.0, 0.0], &free).unwrap();
        let spread = spread(&objective, &at, &free).unwrap();
        // 20 alike would be 20/1.5 · 18/20 = 12: pairs count half. These are not quite alike.
        assert!(spread.freedom.iter().all(|freedom| (8.0..12.5).contains(freedom)), "{:?}", spread.freedom);
        for (k, truth) in [2.0, 0.5].into_iter().enumerate() {
            let off = (at.theta[k] - truth).abs();
            // Student's 97.5 % quantile with 11 degrees of freedom.
            held[k] += usize::from(off <= 2.201 * spread.covariance[(k, k)].sqrt());
            white[k] += usize::from(off <= 1.96 * spread.white[(k, k)].sqrt());
        }
    }
    println!("held {held:?}, as if white {white:?} of {draws}");
    assert!(held.iter().all(|held| (180..=198).contains(held)), "{held:?}");
    assert!(white.iter().all(|white| *white < 140), "{white:?}");
}

/// A number that one block of twenty tells of has one degree of freedom, whatever the other has.
#[test]
fn what_one_block_tells_of_has_one_degree_of_freedom() {
    let y = measured(8, 0.0);
    let only = |theta: &[f64], i: usize| if i / BLOCK == 7 { theta[1] * (i % BLOCK) as f64 * 0.05 } else { 0.0 };
    let one = |theta: &[f64], (i, y): (usize, &f64)| y - decay(&[theta[0], 0.5], i) - only(theta, i);
    let residuals = |theta: &[f64]| Some(y.iter().enumerate().map(|sample| one(theta, sample)).collect());
    let mut objective = objective(&residuals);
    objective.parameters[1] = Parameter { low: -10.0, high: 10.0, step: 1e-3 };
    let free = [0, 1];
    let at = descend(&objective, &[1.0, 0.3, 0.0], &free).unwrap();
    let spread = spread(&objective, &at, &free).unwrap();
    assert!(spread.freedom[1] < 1.1 && spread.freedom[0] > 6.0, "{:?}", spread.freedom);
}

/// Where a step out of the minimum costs much however small it is, the ends are where the curvature has them.
#[test]
fn rough_ground_does_not_close_an_interval_in() {
    let y = measured(3, 0.0);
    let smooth = |theta: &[f64], i: usize| y[i] - decay(theta, i);
    let residuals = |theta: &[f64]| Some((0..SAMPLES).map(|i| smooth(theta, i)).collect());
    let (free, start) = ([0, 1], [1.0, 1.0, 0.0]);
    let centre = descend(&objective(&residuals), &start, &free).unwrap().theta;
    // Beyond what derivatives look at.
    let grain =
        |theta: &[f64], i: usize| if (theta[0] - centre[0]).abs() > 3e-3 { 0.2 - 0.4 * (i % 2) as f64 } else { 0.0 };
    let rough = |theta: &[f64]| Some((0..SAMPLES).map(|i| smooth(theta, i) + grain(theta, i)).collect());
    let objective = objective(&rough);
    let at = descend(&objective, &centre, &free).unwrap();
    let spread = spread(&objective, &at, &free).unwrap();
    let half = (3.84 * spread.white[(0, 0)]).sqrt();
    assert!(half > 0.02, "{half}");
    for (sign, side) in [-1.0, 1.0].into_iter().zip(profile(&objective, &at, &free, &spread, (0, 3.84))) {
        let Side::Closed(end) = side else { panic!("{side:?}") };
        assert!(sign * (end - at.theta[0]) >= 0.999 * half, "{end} {half} about {}", at.theta[0]);
    }
}

/// Of two numbers that act through their sum neither is closed in.
#[test]
fn what_is_confounded_stays_open() {
    let y = measured(5, 0.0);
    let residuals = |theta: &[f64]| {
        let sum = [theta[0] + theta[2], theta[1]];
        Some(y.iter().enumerate().map(|(i, y)| y - decay(&sum, i)).collect())
    };
    let mut objective = objective(&residuals);
    // Wider than the other's, so that it is no bound of that one which closes it in.
    objective.parameters[0] = Parameter { low: -30.0, high: 30.0, step: 1e-3 };
    let free = [0, 1, 2];
    let at = descend(&objective, &[1.0, 1.0, 0.5], &free).unwrap();
    let spread = spread(&objective, &at, &free).unwrap();
    let ends = profile(&objective, &at, &free, &spread, (2, 3.84));
    assert_eq!(ends, [Side::Open(-10.0), Side::Open(10.0)]);
    let ends = profile(&objective, &at, &free, &spread, (1, 3.84));
    assert!(ends.iter().all(|end| matches!(end, Side::Closed(at) if (at - 0.5).abs() < 0.2)), "{ends:?}");
}
