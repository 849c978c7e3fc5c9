//! Bounds of `[execute]`.

use crate::campaign::check::Findings;
use crate::campaign::scenario::ExecuteSection;

/// Integration steps of 10⁻⁵ … 10⁻³ s.
///
/// Latency ≤ 1 s and bandwidth 0.1 … 10 are for controllers of ours; of a program's gains and delays nothing is known.
pub(super) fn check(execute: &ExecuteSection, found: &mut Findings) {
    check_who(execute, found);
    found.repeat(execute.repeat);
    found.flaky(execute.flaky);
    found.baseline(execute.baseline);
    found.above("execute.accept_m", execute.accept_m, 0.0, 1000.0, " m");
    if let Some(limit) = execute.time_limit_s {
        // A run keeps its track: at 100 000 s some GB.
        found.above("execute.time_limit_s", limit, 0.0, 100_000.0, " s");
    }
    // Coarser than 1 kHz the rate loop and the rotor lag are no longer resolved.
    found.from("execute.step_s", execute.step_s, 1e-5, 1e-3, " s");
    found.above("execute.fixed_velocity_m_s", execute.fixed_velocity_m_s, 0.0, 100.0, " m/s");
    if let Some(speed) = execute.goto_speed_m_s {
        found.above("execute.goto_speed_m_s", speed, 0.0, 100.0, " m/s");
    }
    if let Some(bandwidth) = execute.bandwidth {
        found.from("execute.bandwidth", bandwidth, 0.1, 10.0, "");
        let bound = "left out: gains of ours alone are known";
        found.require(execute.controller_in_force().is_some(), "execute.bandwidth", bandwidth, bound);
    }
    if let Some(latency) = execute.latency_s {
        found.from("execute.latency_s", latency, 0.0, 1.0, " s");
        let bound = "left out: a program of yours has its own";
        found.require(execute.command.is_none(), "execute.latency_s", latency, bound);
    }
    found.above("execute.timeout_s", execute.timeout_s, 0.0, 1e6, " s");
    found.processes(execute.processes, execute.workers);
}

/// At most one of controller, command and logs; none of them means the controller `stable-waypoint`.
fn check_who(execute: &ExecuteSection, found: &mut Findings) {
    if let Some(logs) = &execute.logs {
        let bound =
            "left out: `hairpin judge LOGS --campaign OUT` judges logs of flights against a campaign that is there";
        found.require(false, "execute.logs", format!("\"{logs}\""), bound);
        return;
    }
    found.who(execute.controller.as_ref(), execute.control_rate_hz, execute.command.as_deref());
}
