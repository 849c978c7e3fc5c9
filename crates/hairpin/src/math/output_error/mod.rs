//! Output error: the parameters of a simulation whose outputs come nearest to what was measured, and how far they can
//! be told.
//!
//! ```text
//! r(θ) = y − f(θ)                     f: the simulation run freely, so that no measurement enters it but y itself
//! Q(θ) = Σ_g n_g ln(RSS_g(θ)/n_g)     −2 log L of outputs g with standard deviations of their own, these maximised out
//! ```
//!
//! Least squares of the equation error would regress on measured states, which in a closed loop are correlated with
//! what disturbs them: it is biased however long the log. Output error is not, as long as what disturbs is independent
//! of the reference (Ljung, System Identification, 2nd ed., 7.3 and 13.4).
//!
//! Residuals are coloured: Q is not a likelihood but a composite one. Its minimum stays consistent, and its spread is
//! that of blocks of residuals that are as good as independent ([`fn@spread`]); how far Q may rise follows from both
//! ([`fn@profile`]).

mod descend;
mod objective;
mod profile;
mod spread;

pub use descend::{Descent, descend};
pub use objective::{Objective, Parameter, Residuals};
pub use profile::{Side, profile};
pub use spread::{Spread, acting, spread};

#[cfg(feature = "unit-tests")]
mod tests;
