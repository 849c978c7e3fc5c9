//! One arc: curvature as a polynomial of arc length, of third or fifth order.

mod descent;
mod heading;
mod limits;
mod newton;
mod refine;

pub(super) use descent::descend;
pub(super) use heading::Free;
pub(super) use limits::bends;
pub(super) use refine::refine;
