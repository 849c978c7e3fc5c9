//! Two setups of one kind: that of the plan, and that of a run or of a world with less in it.

use std::any::Any;

/// A setup of the same kind as the one that it is given to: draws change no robot's kind.
///
/// Made by [`Kind::same`](super::Kind) only, so that its promise is the caller's to keep in one place.
#[derive(Clone, Copy)]
pub(in crate::campaign) struct Same<'a>(&'a dyn Any);

impl<'a> Same<'a> {
    pub(super) fn of(setup: &'a dyn Any) -> Self {
        Self(setup)
    }

    /// It itself.
    ///
    /// # Panics
    /// If it is of another kind: our mistake.
    pub(in crate::campaign) fn setup<T: Any>(self) -> &'a T {
        self.0.downcast_ref().unwrap_or_else(|| unreachable!("draws change no robot's kind"))
    }
}
