//! The whole command line with a controller of one's own in it, which takes the place of whatever command a scenario
//! names: `cargo run --example 09_own_command -- stress demo-quadrotor --set 'execute.controller="command: spring"'`.

use std::process::ExitCode;
use std::sync::Arc;

use hairpin::campaign::user_controller::{Turns, UserSteering};
use hairpin::campaign::{CallersCode, UserCode};
use serde_json::{Value, json};

/// A spring to the next waypoint and a damper, turned so many seconds apart.
struct Spring(f64);

impl UserCode for Spring {
    fn trouble(&self) -> Option<String> {
        None
    }

    fn try_out(&self) -> Result<(), String> {
        Ok(())
    }

    fn stop(&self) {}
}

impl UserSteering for Spring {
    fn period(&self) -> f64 {
        self.0
    }

    fn begin(self: Arc<Self>, mission: Value) -> Result<Box<dyn Turns>, String> {
        let waypoints = serde_json::from_value(mission["waypoints_m"].clone());
        Ok(Box::new(Run(waypoints.map_err(|error| error.to_string())?)))
    }
}

/// A run over its waypoints.
struct Run(Vec<[f64; 3]>);

impl Turns for Run {
    fn turn(&mut self, _t_s: f64, state: &Value, reference: &Value) -> Result<Value, String> {
        let next = reference["next"].as_u64().unwrap_or(0) as usize;
        let target = self.0[next.min(self.0.len() - 1)];
        let of = |key: &str, axis: usize| state[key][axis].as_f64().unwrap_or(0.0);
        let pull = |axis: usize| (target[axis] - of("p_m", axis)).clamp(-4.0, 4.0) - 2.0 * of("v_m_s", axis);
        Ok(json!({ "a_m_s2": [pull(0), pull(1), pull(2)] }))
    }

    fn finish(self: Box<Self>) {}
}

fn main() -> ExitCode {
    let controller = Arc::new(|period: f64| Arc::new(Spring(period)) as Arc<dyn UserSteering>);
    let code = CallersCode { controller: Some(controller), ..CallersCode::default() };
    hairpin_cli::run_with(std::env::args_os(), code).into()
}
