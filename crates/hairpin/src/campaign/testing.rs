//! A robot for tests of flights.

use serde_json::{Value, json};

/// A quadrotor as scenarios describe it.
pub(super) fn quadrotor() -> Value {
    json!({
        "kind": "quadrotor", "name": "test", "mass_kg": 1.0, "inertia_kg_m2": [0.0049, 0.0049, 0.0069],
        "thrust_coefficient_n_s2": 1.91e-6, "moment_coefficient_n_m_s2": 2.6e-7, "rotor_speed_rad_s": [0.0, 2200.0],
        "max_speed_m_s": 18.0, "clearance_radius_m": 0.23,
        "rotors": [{ "x_m": 0.08, "y_m": 0.08, "spin": 1.0 }, { "x_m": -0.08, "y_m": 0.08, "spin": -1.0 },
            { "x_m": -0.08, "y_m": -0.08, "spin": 1.0 }, { "x_m": 0.08, "y_m": -0.08, "spin": -1.0 }],
    })
}
