//! A witness is proof only if a wrong one is found out: on every shipped robot, one coefficient after the other.

use crate::campaigns::{asked, run, setup};
use hairpin::campaign::generate::Known;
use hairpin::campaign::{Case, Evidence, Witness, verify};
use hairpin::trajectory::Profile;

fn profile_of(case: &mut Case) -> &mut Profile {
    match &mut case.witness {
        Some(Witness::Profile(profile)) => profile,
        other => panic!("not a profile: {other:?}"),
    }
}

#[test]
fn any_coefficient_off_by_a_percent_is_found() {
    for name in ["anafi", "anafi-real", "crazyflie", "flightgoggles", "iris", "paper-flightgoggles", "x500"] {
        let setup = setup(name, 4, asked("witness", "beam", 1));
        let (cases, tally) = run(&setup, &Known::default());
        let case = cases.first().unwrap_or_else(|| panic!("{name}: {tally:?}"));
        assert_eq!(case.evidence, Evidence::Witnessed, "{name}");
        let proof = verify(&setup, case).proof.expect("a proof");
        assert!(proof.findings.is_empty(), "{name}, untouched: {:?}", proof.findings);

        let legs = case.profile().expect("a witness").legs.len();
        let mut tampered = [0; 3];
        for (leg, axis, power) in (0..legs).flat_map(|l| (0..3).flat_map(move |a| (0..8).map(move |p| (l, a, p)))) {
            let mut wrong = case.clone();
            let coefficient = &mut profile_of(&mut wrong).legs[leg].coefficients[axis][power];
            if *coefficient == 0.0 {
                continue;
            }
            *coefficient *= 1.01;
            let proof = verify(&setup, &wrong).proof.expect("a proof");
            assert!(!proof.findings.is_empty(), "{name}: leg {leg}, axis {axis}, power {power} passes");
            tampered[axis] += 1;
        }
        // A septic has four coefficients beside those that rest and level at its start make zero.
        assert!(tampered.iter().all(|count| *count >= 4 * legs), "{name}: {tampered:?} is too few to tell");
    }
}
