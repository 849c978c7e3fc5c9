//! From keys to the robot and the world that they describe: there is no other way, and so this is the check of them.

use super::attachments::Attachments;
use super::scenario::Mistake;

/// What one kind of scenarios describes.
pub(super) trait Build: Sized {
    /// The scenario's keys.
    type Keys;

    /// Builds it from a scenario whose keys were checked before some of them were drawn. What the keys of `known` say
    /// alike is not built again but shared with it.
    ///
    /// # Errors
    /// A key whose value makes no robot or no world.
    fn build(keys: &Self::Keys, files: &Attachments, known: Option<(&Self::Keys, &Self)>) -> Result<Self, Mistake>;

    /// The same, and every key that has a bound is looked at.
    ///
    /// # Errors
    /// All keys whose values are out of bounds, in the order of the file.
    fn check(keys: &Self::Keys, files: &Attachments, known: Option<(&Self::Keys, &Self)>)
    -> Result<Self, Vec<Mistake>>;
}
