//! What logs of arms may tell: each servo's lag, and how late the program begins.
//!
//! ```text
//! q̇_k = (u_k − q_k)/τ_k       τ_k: one lag a servo, s;   u_k(t − delay): set points of the plan
//! outputs: the six joint angles, rad
//! ```
//!
//! Lags are looked for in 0 … 0.5 s and the delay in 0 … 2 s, with derivatives over ±3 ms and a second start 30 ms
//! above what the scenario has. Logs need 2 s of motion and 20 samples a second at least.

use serde_json::{Value, json};

use super::ArmSetup;
use crate::campaign::kind::{Adjustable, Fittable, Output, Sampling};
use crate::simulation::Acceptance;

const OUTPUTS: [(Output, usize); 6] = [
    (Output::Joint(0), 0),
    (Output::Joint(1), 1),
    (Output::Joint(2), 2),
    (Output::Joint(3), 3),
    (Output::Joint(4), 4),
    (Output::Joint(5), 5),
];
/// Names and fields of the servos' lags.
const LAGS: [(&str, &str); 6] = [
    ("lag of axis 1", "lag_1_s"),
    ("lag of axis 2", "lag_2_s"),
    ("lag of axis 3", "lag_3_s"),
    ("lag of axis 4", "lag_4_s"),
    ("lag of axis 5", "lag_5_s"),
    ("lag of axis 6", "lag_6_s"),
];

/// Programs go by the clock: a delay of the whole of one and an offset of the log's clock are the same.
pub(super) fn fittable(setup: &ArmSetup) -> Result<Fittable, String> {
    if setup.controller.is_some() {
        return Err("the virtual controller must run the programs: of others hairpin has no model".into());
    }
    let lags = setup.lags();
    let lag = |(axis, (name, field)): (usize, (&'static str, &'static str))| Adjustable {
        name,
        field,
        unit: "s",
        keys: vec![(format!("robot.joints.lag_s[{axis}]"), 1.0)],
        value: lags[axis],
        bounds: [0.0, 0.5],
        step: 0.003,
        other: lags[axis] + 0.03,
        doubt: None,
    };
    let late = setup.scenario.execute.faults.start_delay_s;
    let delay = Adjustable {
        name: "delay",
        field: "start_delay_s",
        unit: "s",
        keys: vec![("execute.faults.start_delay_s".into(), 1.0)],
        value: late,
        bounds: [0.0, 2.0],
        step: 0.003,
        other: late + 0.03,
        doubt: Some("late stamps and longer stops look like it, and its intervals did not hold on drawn arms"),
    };
    let calm =
        [("execute.noise_mm", json!(0.0)), ("execute.logs", Value::Null), ("execute.log_clock", json!("as-recorded"))];
    Ok(Fittable {
        calm: calm.into_iter().map(|(key, value)| (key.to_owned(), value)).collect(),
        spelt: vec![("robot.joints.lag_s".into(), json!(lags))],
        derives: false,
        numbers: LAGS.into_iter().enumerate().map(lag).chain([delay]).collect(),
        outputs: &OUTPUTS,
        axes: 3,
        undescribed: "an arm, a clock or a program is between them that none of these numbers describes",
        unit: ("mm", 1e3),
        sampling: Sampling {
            least_s: 2.0,
            least_hz: 20.0,
            period: 0.02,
            stretch: 0.5,
            whole_legs: false,
            start_m: Some(0.05),
        },
        acceptance: Acceptance::Sphere,
        tried: "12 drawn arms, an IRB 120 with lags of 10 to 60 ms",
        // Programs have one, the virtual controller.
        untried: None,
        timed: true,
    })
}
