//! What a proof costs: a flight of ten legs of 2-3 s.

use hairpin::verification::{Body, Claim, Leg, RotorPlace, Tolerances, open_loop_with_lag, verify};

/// FlightGoggles' numbers (drone.yaml of mit-aera/FlightGoggles).
fn body() -> Body {
    let place = |x, y, spin| RotorPlace { x, y, spin };
    Body {
        mass: 1.0,
        gravity: 9.81,
        inertia: [0.0049, 0.0049, 0.0069],
        rotors: [place(0.08, 0.08, 1.0), place(-0.08, 0.08, -1.0), place(-0.08, -0.08, 1.0), place(0.08, -0.08, -1.0)],
        thrust_coefficient: 1.91e-6,
        moment_coefficient: 2.6e-7,
        rotor_speed: (0.0, 2200.0),
        drag_linear: 0.0,
        drag_quadratic: 0.1,
        aerodynamic_moment: 0.003,
        rotor_time_constant: 0.02,
    }
}

/// Rest to rest legs to and fro: p = a + (b − a)(35 s⁴ − 84 s⁵ + 70 s⁶ − 20 s⁷), s = τ/T.
fn flight(count: usize) -> (Vec<[f64; 3]>, Vec<Leg>) {
    let waypoints: Vec<[f64; 3]> =
        (0..=count).map(|k| [3.0 + 2.0 * (k % 2) as f64, 3.0 + (k % 3) as f64, 3.0 + 0.7 * k as f64]).collect();
    let legs = waypoints.windows(2).enumerate().map(|(k, ends)| {
        let duration = 2.0 + 0.1 * k as f64;
        let shape = [0.0, 0.0, 0.0, 0.0, 35.0, -84.0, 70.0, -20.0];
        let coefficients = std::array::from_fn(|axis| {
            let (from, to) = (ends[0][axis], ends[1][axis]);
            std::array::from_fn(|i| if i == 0 { from } else { (to - from) * shape[i] / f64::powi(duration, i as i32) })
        });
        Leg { duration, coefficients }
    });
    let legs = legs.collect();
    (waypoints, legs)
}

#[divan::bench]
fn verify_ten_legs(bencher: divan::Bencher) {
    let (body, (waypoints, legs)) = (body(), flight(10));
    let claim = Claim { waypoints: &waypoints, legs: &legs };
    assert!(verify(&body, &claim, &Tolerances::default()).ok());
    bencher.bench(|| verify(&body, &claim, &Tolerances::default()));
}

#[divan::bench]
fn open_loop_with_lag_ten_legs(bencher: divan::Bencher) {
    let (body, (waypoints, legs)) = (body(), flight(10));
    let claim = Claim { waypoints: &waypoints, legs: &legs };
    bencher.bench(|| open_loop_with_lag(&body, &claim));
}
