//! From keys to the robot and the world that they describe: there is no other way, and so this is the check of them.

use std::sync::Arc;

use super::Kind;
use crate::campaign::attachments::Attachments;
use crate::campaign::scenario::Mistake;

/// What a setup is built from.
///
/// `known` makes draws cheap: a drawn mass leaves the map, the graph of an arm and its meshes as they are.
#[derive(Debug)]
pub(in crate::campaign) struct Given<'a, S: Build> {
    /// The scenario's keys.
    pub(in crate::campaign) keys: &'a Arc<S::Keys>,
    /// What its files hold.
    pub(in crate::campaign) files: &'a Arc<Attachments>,
    /// A setup whose keys describe some of it alike: that is shared with it, not built again.
    pub(in crate::campaign) known: Option<&'a S>,
}

impl<S: Build> Clone for Given<'_, S> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<S: Build> Copy for Given<'_, S> {}

/// What scenarios of one kind describe.
///
/// The only way from keys to a robot; so a scenario that is checked is one that can be built.
pub(in crate::campaign) trait Build: Kind + Sized {
    /// The scenario's keys.
    type Keys;

    /// Builds it from a scenario whose keys were checked before some of them were drawn.
    ///
    /// # Errors
    /// A key whose value makes no robot or no world.
    fn build(given: Given<'_, Self>) -> Result<Self, Mistake>;

    /// The same, and every key that has a bound is looked at.
    ///
    /// # Errors
    /// All keys whose values are out of bounds, in the order of the file.
    fn check(given: Given<'_, Self>) -> Result<Self, Vec<Mistake>>;
}
