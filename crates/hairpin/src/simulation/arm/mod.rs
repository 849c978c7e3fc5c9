//! The virtual controller of arms: a program's moves in, poses every 10 ms out, and what was planned for the judge.
//!
//! [`Plan::new`] lays the path and its time law; [`Plan::execute`] lets servos follow it. Equations:
//! docs/virtual-controller.md.
//!
//! | step | file |
//! | --- | --- |
//! | a program's moves, frames multiplied out | [`Order`], `program` |
//! | curves and the blends between them | `curve`, `path` |
//! | joint angles along them, node by node, one branch | `follow`, `grid` |
//! | x = ṡ² by speeds and accelerations, two passes; an S-curve by averaging | `profile`, `clock` |
//! | the plan as poses, for the judge and for tables | `planned`, `sharp` |
//! | servos a lag behind, faults, noise, a recording | `servo`, `faults`, `execute` |
//! | set points by a controller of the caller's own | `steered` |
//!
//! It shares the arm's kinematics with the claim and none of its bounds between samples: where a program cannot be
//! followed it stops, and says at which move, how far and why ([`Stop`]).
//!
//! ```
//! use hairpin::robot::arm::ArmDescription;
//! use hairpin::simulation::arm::{Order, Plan, PlanSettings, RunSettings, Speed, Target, Zone};
//!
//! let file = serde_json::json!({
//!     "kind": "arm", "name": "IRB 120", "opw": { "a1_mm": 0.0, "a2_mm": -70.0, "c1_mm": 290.0, "c2_mm": 270.0,
//!         "c3_mm": 302.0, "c4_mm": 72.0, "offsets_deg": [0.0, 0.0, -90.0, 0.0, 0.0, 0.0] },
//!     "joints": { "lower_deg": [-165.0, -110.0, -110.0, -160.0, -120.0, -400.0],
//!         "upper_deg": [165.0, 110.0, 70.0, 160.0, 120.0, 400.0],
//!         "speed_deg_s": [250.0, 250.0, 250.0, 320.0, 320.0, 420.0] },
//! });
//! let arm = serde_json::from_value::<ArmDescription>(file)?.build()?;
//! let (start, end) = ([0.0; 6], [0.5, 0.2, 0.0, 0.0, 0.4, 0.0]);
//! let order = Order {
//!     name: "p1".into(),
//!     target: Target::Joints(end),
//!     speed: Speed { tcp: f64::INFINITY, turn: f64::INFINITY },
//!     duration: None,
//!     zone: Zone::Fine,
//!     tool: nalgebra::Isometry3::identity(),
//! };
//! let orders = [order];
//! let plan = Plan::new(&arm, &start, &orders, &PlanSettings::default())?;
//! assert!(plan.stop().is_none());
//! let run = plan.execute(&RunSettings::default(), &[], 1)?;
//! let q1 = run.recording.channel("q1_rad").expect("joints are recorded");
//! assert!((q1[q1.len() - 1] - 0.5).abs() < 1e-3);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```

mod clock;
mod curve;
mod execute;
mod faults;
mod follow;
mod grid;
mod order;
mod path;
mod plan;
mod planned;
mod profile;
mod program;
mod servo;
mod settings;
mod sharp;
mod steered;

#[cfg(feature = "unit-tests")]
mod tests;

pub use execute::{Run, Status};
pub use faults::Fault;
pub use follow::{Reason, Stop};
pub use order::{Order, Speed, Target, Zone};
pub use plan::{Load, Plan};
pub use settings::{Noise, PlanSettings, RunSettings, Shape};
pub use steered::{ArmCommand, ArmState, JointPlan, Steering};
