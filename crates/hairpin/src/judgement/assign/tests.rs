use rand::RngExt;

use super::*;
use crate::math::random::stream;

/// Every rising sequence, tried.
fn by_enumeration(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece]) -> f64 {
    fn rest(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece]) -> f64 {
        let Some(sample) = samples.first() else { return 0.0 };
        (0..pieces.len())
            .map(|j| {
                let own = weights[0] * point_distance(sample, &pieces[j].from, &pieces[j].to).powi(2);
                own + rest(&samples[1..], &weights[1..], &pieces[j..])
            })
            .fold(f64::INFINITY, f64::min)
    }
    rest(samples, weights, pieces)
}

/// Without looking for what can be left out.
fn in_full(samples: &[Point3<f64>], weights: &[f64], pieces: &[Piece]) -> Vec<usize> {
    let (mut assigned, whole) = (vec![0; samples.len()], vec![0..pieces.len(); samples.len()]);
    Problem { samples, weights, pieces, lanes: &Lanes::of(pieces) }.split(0, &whole, 0..pieces.len(), &mut assigned);
    assigned
}

/// Of pieces anywhere, among them some without a length and neighbours that share an end, at every level.
#[test]
fn lanes_have_the_bits_of_one_distance_at_a_time() {
    let mut random = stream(3);
    let mut draw = |most: f64| Point3::from([(); 3].map(|_| random.random_range(-most..most)));
    let mut corners = vec![Point3::origin()];
    while corners.len() < 200 {
        let last = corners[corners.len() - 1];
        corners.push(if corners.len() % 7 == 3 { last } else { last + draw(1.0).coords });
    }
    let pieces: Vec<Piece> =
        corners.windows(2).enumerate().map(|(owner, ends)| Piece { from: ends[0], to: ends[1], owner }).collect();
    let lanes = Lanes::of(&pieces);
    for (i, corner) in corners.iter().enumerate() {
        let p = if i % 3 == 0 { *corner } else { corner + draw(2.0).coords };
        let window = i / 3..pieces.len() - i / 5;
        for simd in [Simd::Widest, Simd::Portable] {
            let mut row = vec![f64::NAN; window.len()];
            lanes.squares(simd, &p, window.clone(), &mut row);
            for (square_of, piece) in row.iter().zip(&pieces[window.clone()]) {
                let alone = square(point_distance(&p, &piece.from, &piece.to));
                assert_eq!(square_of.to_bits(), alone.to_bits(), "{i} {simd:?}: {square_of} {alone}");
            }
        }
    }
}

#[test]
fn the_band_around_a_coarse_assignment_holds_the_best() {
    for seed in 0..6 {
        let mut random = stream(seed);
        // A path that crosses itself, and samples that stray from it by metres and stop in places.
        let (a, b) = (random.random_range(1.0..4.0), random.random_range(1.0..4.0));
        let at = |u: f64| Point3::new(10.0 * libm::sin(a * u), 10.0 * libm::sin(b * u + 1.0), 3.0 * libm::sin(2.0 * u));
        let path: Vec<_> = (0..=600).map(|k| at(f64::from(k) / 100.0)).collect();
        let pieces: Vec<Piece> =
            path.windows(2).enumerate().map(|(owner, p)| Piece { from: p[0], to: p[1], owner }).collect();
        let mut u = 0.0;
        let stray = random.random_range(0.5..6.0);
        let samples: Vec<_> = (0..1500)
            .map(|i| {
                u += if i % 400 > 300 { 0.0 } else { 6.0 / 1100.0 };
                at(u)
                    + nalgebra::Vector3::new(libm::sin(0.02 * f64::from(i)), libm::cos(0.013 * f64::from(i)), 0.3)
                        * stray
            })
            .collect();
        let weights = vec![0.01; samples.len()];
        let lanes = Lanes::of(&pieces);
        let problem = Problem { samples: &samples, weights: &weights, pieces: &pieces, lanes: &lanes };
        let sum = |assigned: &[usize]| assigned.iter().enumerate().map(|(i, j)| problem.cost(i, *j)).sum::<f64>();
        let (band, full) = (monotone(&samples, &weights, &pieces), in_full(&samples, &weights, &pieces));
        assert!(sum(&band) <= sum(&full) * (1.0 + 1e-9), "{seed}: {} {}", sum(&band), sum(&full));
    }
}

#[test]
fn what_is_left_out_is_in_no_best_sequence() {
    for seed in 0..300 {
        let mut random = stream(seed);
        let mut draw = |most: f64| Point3::from([(); 3].map(|_| random.random_range(-most..most)));
        // Ways that cross themselves, stand still and turn back; samples on them, near them, and anywhere.
        let mut corners = vec![Point3::origin()];
        while corners.len() < 40 {
            let last = corners[corners.len() - 1];
            corners.push(if corners.len() % 9 == 5 { corners[corners.len() - 4] } else { last + draw(1.0).coords });
        }
        let pieces: Vec<Piece> =
            corners.windows(2).enumerate().map(|(owner, ends)| Piece { from: ends[0], to: ends[1], owner }).collect();
        let off = [0.0, 1e-3, 0.2, 3.0][seed as usize % 4];
        let samples: Vec<Point3<f64>> = (0..150)
            .map(|i| {
                let at = 38.0 * f64::from(i) / 150.0;
                let (k, share) = (at as usize, at.fract());
                corners[k] + (corners[k + 1] - corners[k]) * share + draw(1.0).coords * off
            })
            .collect();
        let weights: Vec<f64> = (0..150).map(|i| 0.01 * f64::from(1 + i % 3)).collect();
        assert_eq!(monotone(&samples, &weights, &pieces), in_full(&samples, &weights, &pieces), "seed {seed}");
    }
}

#[test]
fn is_the_best_of_all_rising_sequences() {
    for seed in 0..200 {
        let mut random = stream(seed);
        let mut draw = || Point3::from([(); 3].map(|_| random.random_range(-3.0..3.0)));
        let corners: Vec<Point3<f64>> = (0..5).map(|_| draw()).collect();
        let samples: Vec<Point3<f64>> = (0..7).map(|_| draw()).collect();
        let weights: Vec<f64> = (0..7).map(|i| 1.0 + 0.1 * i as f64).collect();
        let pieces: Vec<Piece> =
            corners.windows(2).enumerate().map(|(owner, ends)| Piece { from: ends[0], to: ends[1], owner }).collect();
        let found = monotone(&samples, &weights, &pieces);
        assert!(found.is_sorted(), "seed {seed}: {found:?}");
        let cost: f64 = (0..7)
            .map(|i| weights[i] * point_distance(&samples[i], &pieces[found[i]].from, &pieces[found[i]].to).powi(2))
            .sum();
        let best = by_enumeration(&samples, &weights, &pieces);
        assert!((cost - best).abs() <= 1e-9 * (1.0 + best), "seed {seed}: {cost} {best}");
    }
}
