//! Families of controls beside the flat solver's own: curvature by spline knots, as a polynomial of time, or as the
//! ratio of two velocities that are polynomials of time; and each with a direction of travel that turns along the
//! drive.
//!
//! All are linear in their parameters, κ(u) = Σ pᵢ Bᵢ(u), and differ in the functions Bᵢ and in what u measures; so one
//! shooting solves them all (`descend`), from the flat solver's answer and from Dubins' words, whose turns say which
//! ways around there are. What is answered are polynomials of arc length: exact where the family is of that kind,
//! otherwise fitted.
//!
//! | family | u | Bᵢ(u) |
//! | --- | --- | --- |
//! | arc length | s/L | Legendre's Pᵢ(2u − 1) |
//! | time | t/T | Legendre's Pᵢ(2u − 1) |
//! | knots | s/L | the natural spline through unit i |
//! | velocities | t/T | Pᵢ(2u − 1)/v(u) |

mod basis;
mod clock;
mod descend;
mod found;
mod grid;
mod landing;
mod parameters;
mod pieces;
mod problem;
mod search;
mod settings;
mod start;

pub use parameters::Parameters;
pub use problem::{Among, Answer, Iteration, Problem};
pub use search::{solve, solve_among};
pub use settings::Settings;
