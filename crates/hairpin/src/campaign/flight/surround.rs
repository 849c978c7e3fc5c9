//! Wind and gust that are searched beside the waypoints, as numbers between −1 and 1.
//!
//! ```text
//! place = [wind x, y, z | gust x, y, z, τ]      each part only where it is asked for
//! wind = w_max · place₀₋₂      gust = g_max · place₃₋₅      middle of the gust at (1 + τ)/2 of the flight
//! ```

use crate::campaign::graph::{Plan, into_unit_ball};
use crate::campaign::scenario::{DiscreteGustSection, EnvironmentSection};

/// How many numbers there are: three of the wind, three of the gust and its time.
///
/// 0, 3, 4 or 7.
pub(super) fn coordinates(asked: &EnvironmentSection) -> usize {
    3 * usize::from(asked.wind_m_s.is_some()) + 4 * usize::from(asked.gust_m_s.is_some())
}

/// Takes velocities beyond their bound back to it, along themselves.
///
/// The time is no velocity and is left as it is.
///
/// ‖v‖ ≤ 1 in shares of the bound; |τ| ≤ 1 is the search's own.
pub(super) fn bound(asked: &EnvironmentSection, place: &mut [f64]) {
    let velocities = usize::from(asked.wind_m_s.is_some()) + usize::from(asked.gust_m_s.is_some());
    for velocity in place.chunks_exact_mut(3).take(velocities) {
        into_unit_ball(velocity);
    }
}

/// `plan` in the air at `place`, flown for about `duration` s.
///
/// Wind and gust are their bounds (m/s) times the place; the gust's middle is at (1 + τ)/2 of the duration for its last
/// coordinate τ, and it begins no earlier than the flight.
///
/// The environment of the plan is replaced, its obstacles kept.
///
/// `start_s` is max(0, middle − ½ duration), so that a gust may end after the flight.
pub(super) fn put(asked: &EnvironmentSection, plan: &Plan, place: &[f64], duration: f64) -> Plan {
    let mut environment = plan.environment.clone().unwrap_or_default();
    let mut velocities = place.chunks_exact(3);
    let mut scaled = |bound: f64| velocities.next().map(|unit| [0, 1, 2].map(|axis| bound * unit[axis]));
    if let Some(most) = asked.wind_m_s {
        environment.wind_m_s = scaled(most);
    }
    if let Some(most) = asked.gust_m_s {
        // The last number: the gust's middle lies within the flight.
        let middle = 0.5 * (1.0 + place.last().copied().unwrap_or(0.0)) * duration;
        environment.discrete_gust = scaled(most).map(|velocity_m_s| DiscreteGustSection {
            velocity_m_s,
            start_s: (middle - 0.5 * asked.gust_s).max(0.0),
            duration_s: asked.gust_s,
        });
    }
    Plan { environment: Some(environment), ..plan.clone() }
}
