//! Rows of a boat's planned motion against its polynomials.

use super::claim::BoatLeg;
use crate::verification::finding::Finding;
use crate::verification::rows::{Clock, PlannedRow, PlannedState, RowTolerances, verify_rows};

/// Holds the rows of a planned motion to the polynomials of `legs`, which are those of a claim that holds: x, y and ψ
/// in the plane z = 0.
///
/// As [`verify_rows`] tells it. Without legs nothing is claimed, and nothing found.
pub fn verify_boat_rows(legs: &[BoatLeg], rows: &[PlannedRow]) -> Vec<Finding> {
    let Some(clock) = Clock::new(legs.iter().map(|leg| leg.duration)) else { return Vec::new() };
    verify_rows(rows, &RowTolerances::default(), [0.0, clock.end], |t| {
        let (leg, tau) = clock.due(t);
        let [x, y, heading] = legs[leg].taylor(tau);
        let (sin, cos) = libm::sincos(0.5 * heading[0]);
        PlannedState {
            leg,
            position: [x[0], y[0], 0.0],
            attitude: Some([cos, 0.0, 0.0, sin]),
            velocity: [x[1], y[1], 0.0],
        }
    })
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// Ahead at 2 m/s, turning at 0.5 rad/s as no boat would.
    #[test]
    fn rows_are_held_to_place_heading_and_velocity() {
        let mut coefficients = [[0.0; 8]; 3];
        (coefficients[0][1], coefficients[2][1]) = (2.0, 0.5);
        let leg = BoatLeg { duration: 4.0, coefficients };
        let row = |k: usize| {
            let (sin, cos) = libm::sincos(0.25 * k as f64);
            PlannedRow {
                t: k as f64,
                leg: Some(0.0),
                position: [2.0 * k as f64, 0.0, 0.0],
                attitude: [cos, 0.0, 0.0, sin],
                velocity: Some([2.0, 0.0, 0.0]),
                gap: 0.0,
            }
        };
        let rows: Vec<PlannedRow> = (0..=4).map(row).collect();
        assert_eq!(verify_boat_rows(&[leg], &rows), []);
        let told = |change: fn(&mut PlannedRow)| {
            let mut rows = rows.clone();
            change(&mut rows[2]);
            verify_boat_rows(&[leg], &rows).into_iter().map(|finding| finding.field).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(told(|row| row.position[0] += 3.0), "legs[0].planned.position");
        assert_eq!(told(|row| row.position[2] += 0.01), "legs[0].planned.position");
        assert_eq!(told(|row| row.attitude = [1.0, 0.0, 0.0, 0.0]), "legs[0].planned.attitude");
        assert_eq!(told(|row| row.velocity = Some([2.1, 0.0, 0.0])), "legs[0].planned.velocity");
    }
}
