//! The one seam between jobs and kinds of robots: what a kind answers, and nothing else that tells kinds apart.
//!
//! A job (generate, execute, judge, verify, shrink, explain, the report) asks a [`Kind`] and never which one it is. A
//! kind answers in a room of its own (`flight`, `drive`, `arm`), and is chosen once, where a resolved scenario becomes
//! a [`Setup`](super::Setup). Its questions come in three groups, so that what is proven, what is carried out and what
//! is told stay apart:
//!
//! | trait | asks |
//! | --- | --- |
//! | [`Claim`] | what is searched, planned and proven; what was lost, and what would help |
//! | [`Act`] | who carries a mission out, for how long, and what may stand in its way |
//! | [`Say`] | names, words and pictures, and what a run is measured against |
//!
//! What one kind alone has (an arm's graph, a quadrotor's rotors) is asked of its own setup, by the verbs that are
//! about nothing else: [`Setup::own`](super::Setup::own).

mod act;
mod axis;
mod build;
mod claim;
mod drawing;
mod knob;
mod programs;
mod say;
mod solid;

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use super::own_controller::AnyController;
use crate::math::simd::Simd;

pub(super) use act::{Act, LegByLeg, Order};
pub use axis::Axis;
pub(super) use build::{Build, Given};
pub use claim::{PlanError, Verified};
pub(super) use claim::{Claim, Replanner, Solver};
pub use drawing::{Drawing, Relief, Rotor};
pub(super) use knob::{Condition, Knob, Knobs, Standing, Turn};
pub(super) use programs::Programs;
pub use say::{FrameWords, Handed};
pub(super) use say::{Assumptions, Facts, Motion, RobotWords, Say, word};
pub use solid::{Surface, surface};

/// A robot in its world, with the scenario that describes both.
pub(super) trait Kind: Claim + Act + Say + Any + Debug + Send + Sync {
    /// The same at another version of the kernels, carried out by a controller of the caller's own if one is given;
    /// `None` if that is one for another kind of robot.
    fn with(&self, simd: Simd, controller: Option<&AnyController>) -> Option<Arc<dyn Kind>>;
}

impl dyn Kind {
    /// Itself, where it is a `T`.
    pub(super) fn own<T: Any>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }

    /// The `nominal` setup of the same kind as its own: draws change no robot's kind.
    pub(super) fn of_kind<T: Any>(&self) -> &T {
        self.own().unwrap_or_else(|| unreachable!("draws change no robot's kind"))
    }
}
