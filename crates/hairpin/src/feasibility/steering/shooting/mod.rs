//! Boundary-value trajectories of ground vehicles: find controls whose motion ends where it was asked to.
//!
//! [`generate()`] is the one call: a [`families::Problem`] (query, speeds, direction of travel), a [`Control`], bounds
//! and [`solve::Choices`]. On the ground, [`rough::solve()`] shapes with it and [`rough::predict()`] integrates.
//!
//! What T. Howard's user guide of the rover trajectory generator (2006) lets one set, with its default, and what became
//! of it:
//!
//! - `SetXPrecision`, `SetYPrecision` (0.01 m): [`Precision::position`], the distance √(δx² + δy²), so that each is
//!   kept; `tolerance_m` of files, `--tolerance-m`.
//! - `SetYawPrecision` (0.01 rad): [`Precision::yaw`], `--tolerance-yaw-rad`.
//! - `SetKPrecision` (0.01 1/m): [`Precision::curvature`], `--tolerance-curvature-1-m`.
//! - `SetVPrecision` (0.01 m/s): [`SPEED_PRECISION`], `--tolerance-speed-m-s`: what speeds at the ends are held to;
//!   profiles meet it by construction.
//! - `SetMaxIterations` (20): [`flat::Settings::iterations`] (20), [`families::Settings::iterations`] (60, of each
//!   start), [`rough::Settings::iterations`] (30 predictions); `--iterations` sets all three.
//! - `SetConvergenceRate` (1.0): [`flat::Settings::step_scale`], [`families::Settings::step_scale`],
//!   [`rough::Settings::step_scale`]; `--step-scale` sets all three.
//! - `SetTimeStep` (0.001 s): of what is exported, `campaign::states::Followed::time_step`, `--time-step-s`; solving
//!   takes the steps of [`rough::Steps`], which agree with 1 ms within a tenth of the precision, by test.
//! - `SetMaximumNumberSteps` (10 000): `campaign::states::Followed::most_steps`, `--max-steps`.
//! - `SetVehicleModel` (generic): [`Rover`](crate::robot::rover::Rover), from a file.
//! - `SetVehicleControls` (fifth order): the value of [`Control`], `--control`.
//! - `SolveTrajectory`: [`generate()`], [`rough::solve()`].
//! - `GetVehicleControls`: [`Generated::solution`] as segments, [`Generated::parameters`] as the family has them.
//! - `GetPath`, `exportPath` (on): `campaign::states::Followed::on`, only where it is called; `--path FILE.csv`.
//! - `setHeuristic` (on, a table of 15.7 MB): off, for start values are Dubins' words, computed in a microsecond.
//!   [`StartTable`](crate::trajectory::start_table::StartTable) (180 kB) through [`flat::Settings::table`],
//!   `--start-table`; `StartTable::generate` and `hairpin start-table` make it.
//! - `displayDebug` (on): the observer of [`generate()`]; `RUST_LOG=debug` on the command line. The library prints
//!   nothing.
//! - `DynamicsResponse`, `EvalSuspension` (identity): [`Response`](crate::robot::rover::Response),
//!   [`Suspension`](crate::robot::rover::Suspension).
//!
//! ```text
//! x′ = cos θ    y′ = sin θ    θ′ = κ(s; p)          |κ| ≤ κ_max, |κ′| ≤ κ′_max        s in [0, L]
//! find (p, L) with (x, y, θ, κ)(L) = goal
//! ```
//!
//! | room | what it finds | how |
//! | --- | --- | --- |
//! | [`flat`] | one arc of fifth order, or a chain of clothoids | a few Newton steps from Dubins' words |
//! | [`cc`] | lines, arcs, clothoids, with cusps | in closed form, always |
//! | [`families`] | splines, polynomials of time, (v, ω), turning directions | one shooting for all |
//! | [`solve`](mod@solve) | the one answer among them | arcs unless they go a long way round |
//! | [`rough`] | commands on real ground | the flat goal is moved until the prediction ends right |
//! | [`nearest`] | the nearest goal that can be reached | bisection |
//!
//! Flat and rough solving take nothing from the heap and read no clock; work is bounded in counts
//! (`tests/library/flight_software.rs`). After T. Howard and A. Kelly, IJRR 26(2), 2007, whose optimisation over
//! control parameters this is, with the start value, the step control and the bounds done otherwise.

pub mod cc;
mod control;
pub mod families;
pub mod flat;
mod generate;
pub mod nearest;
pub(in crate::feasibility::steering) mod preference;
pub mod query;
pub mod rough;
pub mod solve;

pub use control::Control;
pub use generate::{Generated, generate, generate_among};
pub use query::{Curvatures, Goal, Precision, Query, Refusal};

/// What the speed at the end of a drive may differ by from what was asked, m/s.
pub const SPEED_PRECISION: f64 = 0.01;
