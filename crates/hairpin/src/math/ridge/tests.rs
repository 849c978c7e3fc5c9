//! The regression, by closed forms and by the equations that it claims to solve.

use super::monomials::standardised;
use super::*;
use crate::math::random::{stream, unit};

fn rows(count: usize, noise: f64, seed: u64, truth: impl Fn(&[f64]) -> f64) -> Rows {
    let mut rng = stream(seed);
    let mut rows = Rows::default();
    for row in 0..count {
        let inputs = vec![10.0 * unit(&mut rng), 5.0 - unit(&mut rng), 1e4 + unit(&mut rng)];
        rows.values.push(truth(&inputs) + noise * (unit(&mut rng) - 0.5));
        rows.inputs.push(inputs);
        rows.groups.push(row / 5);
    }
    rows
}

#[test]
fn a_polynomial_is_found_again() {
    let truth = |x: &[f64]| 3.0 - 2.0 * x[0] + 0.5 * x[0] * x[0] + 4.0 * (x[2] - 1e4) * x[1];
    let (fitted, validation) = PolynomialRidge::choose(&rows(400, 0.0, 1, truth), 4, 10).unwrap();
    assert!(validation.r2 > 1.0 - 1e-9, "{validation:?}");
    for inputs in [[1.0, 4.3, 1e4 + 0.5], [9.0, 4.9, 1e4 + 0.1]] {
        assert!((fitted.value(&inputs) - truth(&inputs)).abs() < 1e-3, "{}", fitted.value(&inputs));
    }
}

#[test]
fn noise_is_not_explained_and_a_low_degree_wins() {
    let (fitted, validation) = PolynomialRidge::choose(&rows(400, 1.0, 2, |_| 0.0), 4, 10).unwrap();
    assert!(validation.r2 < 0.05, "{validation:?}");
    assert!(fitted.value(&[5.0, 4.5, 1e4]).abs() < 0.2);
    let (fitted, validation) = PolynomialRidge::choose(&rows(600, 1.0, 3, |x| x[0]), 4, 10).unwrap();
    assert_eq!(fitted.degree, 1, "{validation:?}");
    // Variance of x is 100/12, that of the noise 1/12.
    assert!((validation.r2 - (1.0 - 1.0 / 101.0)).abs() < 0.003, "{validation:?}");
}

#[test]
fn weights_solve_the_normal_equations() {
    let rows = rows(50, 3.0, 4, |x| x[0] * x[1]);
    let penalty = 0.1;
    let fitted = PolynomialRidge::of(&rows, 1, penalty).unwrap();
    // Gradient of ‖y − b − Z w‖²/n + λ‖w‖² over standardised inputs, by hand.
    let n = rows.values.len() as f64;
    for input in 0..3 {
        let z = |row: usize| (rows.inputs[row][input] - fitted.centre[input]) / fitted.scale[input];
        let gradient: f64 = (0..50).map(|row| (fitted.value(&rows.inputs[row]) - rows.values[row]) * z(row)).sum();
        let place = fitted.powers.iter().position(|powers| powers[input] == 1).unwrap();
        assert!((gradient / n + penalty * fitted.weights[place]).abs() < 1e-9);
    }
}

#[test]
fn monomials_are_products_by_their_powers() {
    let (centre, scale, range) = ([0.5, 9.0, 1.0, -2.0], [2.0, 0.0, 0.5, 3.0], [[-1.5, 1.5]; 4]);
    let inputs = [1.3, 4.0, 0.2, 11.0];
    let z: Vec<f64> = (0..4).map(|i| standardised(inputs[i], centre[i], scale[i], range[i])).collect();
    assert_eq!(z[3], 1.5);
    for degree in 1..=5 {
        let powers = monomials_of(&scale, degree).unwrap();
        let mut buffer = [[0.0]; MOST_MONOMIALS];
        let count = standardise([&inputs], &centre, &scale, &range, &mut buffer);
        let end = monomials(count, degree, &mut buffer);
        let told = buffer[..end].as_flattened();
        assert_eq!(told.len(), powers.len());
        for (told, powers) in told.iter().zip(&powers) {
            let product: f64 = z.iter().zip(powers).map(|(z, &power)| z.powi(power as i32)).product();
            assert!((told - product).abs() < 1e-12, "{powers:?}: {told}, {product}");
        }
    }
    assert!(monomials_of(&[1.0; 8], 4).is_some_and(|all| all.len() == 494) && monomials_of(&[1.0; 8], 5).is_none());
    assert!(monomials_of(&[0.0; 3], u32::MAX).is_none());
}

#[test]
fn an_input_told_twice_is_taken_once() {
    let mut twice = rows(200, 0.0, 5, |x| x[0] * x[0] + x[1]);
    twice.inputs.iter_mut().for_each(|inputs| inputs.push(3.6 * inputs[0] - 1.0));
    let (fitted, _) = PolynomialRidge::choose(&twice, 3, 10).unwrap();
    assert_eq!(fitted.scale[3], 0.0);
    assert!(fitted.powers.iter().all(|powers| powers[3] == 0));
    // Nothing is told by what never differs, though its mean is a little beside it: 0.1 summed up 200 times is not 20.
    twice.inputs.iter_mut().for_each(|inputs| inputs.insert(0, 0.1));
    let (fitted, _) = PolynomialRidge::choose(&twice, 3, 10).unwrap();
    assert!(fitted.scale[0] == 0.0 && fitted.scale[4] == 0.0, "{:?}", fitted.scale);
    assert!(fitted.scale[1..4].iter().all(|scale| *scale > 0.0), "{:?}", fitted.scale);
    let again = PolynomialRidge::of(&twice, fitted.degree, fitted.penalty).unwrap();
    assert_eq!(again, fitted);
}

#[test]
fn beyond_what_was_fitted_counts_as_at_the_edge() {
    let (fitted, _) = PolynomialRidge::choose(&rows(200, 0.0, 5, |x| x[0] * x[0]), 3, 10).unwrap();
    assert_eq!(fitted.value(&[1e6, 4.5, 1e4 + 0.5]), fitted.value(&[2e6, 4.5, 1e4 + 0.5]));
    assert!(fitted.value(&[1e6, 4.5, 1e4 + 0.5]) < 101.0);
}

#[test]
fn what_cannot_be_fitted_is_told() {
    let good = rows(200, 0.0, 6, |x| x[0]);
    let few = Rows { groups: vec![7; 200], ..good.clone() };
    assert_eq!(PolynomialRidge::choose(&few, 3, 10), Err(NoFit::Groups { groups: 1, needed: 10 }));
    let mut broken = good.clone();
    broken.inputs[3][1] = f64::NAN;
    assert!(matches!(PolynomialRidge::choose(&broken, 3, 10), Err(NoFit::NotFinite { row: 3, .. })));
    let mut ragged = good.clone();
    ragged.inputs[5].pop();
    assert_eq!(PolynomialRidge::choose(&ragged, 3, 10), Err(NoFit::Ragged { row: 5, found: 2, expected: 3 }));
    let steep = PolynomialRidge::of(&good, 40, 0.1);
    assert_eq!(steep, Err(NoFit::Degree { degree: 40 }));
    let flat = Rows { inputs: vec![vec![1.0, 2.0]; 200], ..good };
    assert_eq!(PolynomialRidge::choose(&flat, 3, 10), Err(NoFit::Constant));
}

#[test]
fn values_told_together_are_those_told_alone() {
    let mut random = stream(7);
    for degree in [1, 4] {
        let some = rows(200, 0.0, 8, |x| x[0] * x[1] + x[2]);
        let fitted = PolynomialRidge::of(&some, degree, 1e-3).unwrap();
        for _ in 0..50 {
            let inputs: [Vec<f64>; LANES] = std::array::from_fn(|_| {
                vec![12.0 * unit(&mut random), 5.0 - unit(&mut random), 1e4 + unit(&mut random)]
            });
            let together = fitted.values(std::array::from_fn(|lane| inputs[lane].as_slice()));
            assert_eq!(together.map(f64::to_bits), std::array::from_fn(|lane| fitted.value(&inputs[lane]).to_bits()));
        }
    }
}
