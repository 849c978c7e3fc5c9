//! Ground that is looked at so often and no more: what bounds the work of a search whose steps are not all alike by a
//! count, which is the same on every machine.

use std::sync::atomic::{AtomicU64, Ordering};

use super::{NoGround, Patch, Terrain};

/// Ground with a number of looks that are left; without any it ends everywhere.
///
/// For one search at a time: looks from several threads at once may be counted as one.
#[derive(Debug)]
pub struct Rationed<'a, T> {
    ground: &'a T,
    left: AtomicU64,
}

impl<'a, T> Rationed<'a, T> {
    /// `ground` for `looks` looks.
    pub fn new(ground: &'a T, looks: u64) -> Self {
        Self { ground, left: AtomicU64::new(looks) }
    }

    /// Looks that are left.
    pub fn left(&self) -> u64 {
        self.left.load(Ordering::Relaxed)
    }

    /// What is spent is told as the edge of the map, so that callers end as they do there.
    fn take(&self, x: f64, y: f64) -> Result<(), NoGround> {
        let left = self.left().checked_sub(1).ok_or(NoGround::OffMap { x, y })?;
        self.left.store(left, Ordering::Relaxed);
        Ok(())
    }
}

impl<T: Terrain> Terrain for Rationed<'_, T> {
    #[inline]
    fn patch(&self, x: f64, y: f64) -> Result<Patch, NoGround> {
        self.take(x, y)?;
        self.ground.patch(x, y)
    }

    #[inline]
    fn tangent(&self, x: f64, y: f64) -> Result<(f64, [f64; 2]), NoGround> {
        self.take(x, y)?;
        self.ground.tangent(x, y)
    }

    #[inline]
    fn height(&self, x: f64, y: f64) -> Result<f64, NoGround> {
        self.take(x, y)?;
        self.ground.height(x, y)
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;
    use crate::world::terrain::Flat;

    #[test]
    fn ground_ends_with_its_looks() {
        let ground = Rationed::new(&Flat, 2);
        assert!(ground.patch(1.0, 2.0).is_ok() && ground.height(1.0, 2.0).is_ok());
        assert_eq!((ground.left(), ground.height(1.0, 2.0)), (0, Err(NoGround::OffMap { x: 1.0, y: 2.0 })));
    }
}
