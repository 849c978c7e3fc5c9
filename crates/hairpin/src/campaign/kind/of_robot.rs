//! What a kind of robots answers, all of it.

use std::any::Any;
use std::fmt::Debug;
use std::sync::Arc;

use super::{Act, Claim, Same, Say};
use crate::campaign::own_controller::AnyController;
use crate::math::simd::Simd;

/// A robot in its world, with the scenario that describes both.
///
/// Behind an `Arc` in [`Setup`](crate::campaign::setup::Setup): immutable, shared by threads and by draws.
pub(in crate::campaign) trait Kind: Claim + Act + Say + Any + Debug + Send + Sync {
    /// The same at another version of the kernels, carried out by a controller of the caller's own if one is given;
    /// `None` if that is one for another kind of robot.
    fn with(&self, simd: Simd, controller: Option<&AnyController>) -> Option<Arc<dyn Kind>>;
}

impl dyn Kind {
    /// Itself, where it is a `T`.
    ///
    /// The one way to what a kind alone has; counted by the test of layers.
    pub(in crate::campaign) fn own<T: Any>(&self) -> Option<&T> {
        (self as &dyn Any).downcast_ref()
    }

    /// Itself, for another setup of its kind.
    pub(in crate::campaign) fn same(&self) -> Same<'_> {
        Same::of(self)
    }
}
