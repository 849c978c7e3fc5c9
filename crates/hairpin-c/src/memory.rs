//! Pointers of a caller's, looked at before they are read: NULL, out of place or of impossible size is refused. That
//! they lead to what the header says is the caller's word.

use std::mem::MaybeUninit;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::slice;

use crate::refusal::{HAIRPIN_INVALID, HAIRPIN_NULL, HAIRPIN_TOO_SMALL, Refused};

/// A pointer that can be one to a `T`.
fn sound<T>(place: *const T, name: &str) -> Result<(), Refused> {
    if place.is_null() {
        return Err(Refused::new(HAIRPIN_NULL, format_args!("`{name}` is NULL")));
    }
    if !place.is_aligned() {
        let bound = align_of::<T>();
        return Err(Refused::new(HAIRPIN_INVALID, format_args!("`{name}` = {place:p}: must be a multiple of {bound}")));
    }
    Ok(())
}

/// What `place` leads to.
///
/// # Safety
/// Where it is not NULL it leads to a `T` that nobody changes for as long as the answer is used.
pub(crate) unsafe fn given<'a, T>(place: *const T, name: &str) -> Result<&'a T, Refused> {
    sound(place, name)?;
    // SAFETY: it is not NULL, lies as it must, and leads to a `T` by the caller's word.
    Ok(unsafe { &*place })
}

/// The `len` values from `place` on; none wherever that is if `len` is 0.
///
/// # Safety
/// Where `len` is not 0 as many values lie there, which nobody changes for as long as the answer is used.
pub(crate) unsafe fn many<'a, T>(place: *const T, len: usize, name: &str) -> Result<&'a [T], Refused> {
    if len == 0 {
        return Ok(&[]);
    }
    sound(place, name)?;
    possible::<T>(len, name)?;
    // SAFETY: it is not NULL, lies as it must, is no larger than memory can be, and holds as many by the caller's word.
    Ok(unsafe { slice::from_raw_parts(place, len) })
}

/// A number of values that can lie in memory: what was negative in C is none.
fn possible<T>(len: usize, name: &str) -> Result<(), Refused> {
    if len.checked_mul(size_of::<T>().max(1)).is_none_or(|bytes| bytes > isize::MAX.unsigned_abs()) {
        return Err(Refused::new(HAIRPIN_INVALID, format_args!("{len} values of `{name}`: more than memory can hold")));
    }
    Ok(())
}

/// A caller's memory for results: what lies there is never read.
pub(crate) struct Room<'a, T> {
    places: &'a mut [MaybeUninit<T>],
    name: &'static str,
}

impl<'a, T> Room<'a, T> {
    /// Room for `len` values at `place`; for none wherever that is if `len` is 0.
    ///
    /// # Safety
    /// Where `len` is not 0 as many values may be written there, by nobody else for as long as the room is used.
    pub(crate) unsafe fn new(place: *mut T, len: usize, name: &'static str) -> Result<Self, Refused> {
        if len == 0 {
            return Ok(Self { places: &mut [], name });
        }
        sound(place, name)?;
        possible::<T>(len, name)?;
        // SAFETY: it is not NULL, lies as it must, is no larger than memory can be, and is this call's alone by the
        // caller's word. Values that need not be valid may lie anywhere.
        let places = unsafe { slice::from_raw_parts_mut(place.cast::<MaybeUninit<T>>(), len) };
        Ok(Self { places, name })
    }

    /// Writes `values` from the beginning on.
    ///
    /// # Errors
    /// HAIRPIN_TOO_SMALL where they are more than there is room for; then none is written.
    pub(crate) fn fill(&mut self, values: impl ExactSizeIterator<Item = T>) -> Result<(), Refused> {
        let (room, wanted, name) = (self.places.len(), values.len(), self.name);
        if wanted > room {
            let sentence = format_args!("room for {room} values of `{name}`: {wanted} are needed");
            return Err(Refused::new(HAIRPIN_TOO_SMALL, sentence));
        }
        self.places.iter_mut().zip(values).for_each(|(place, value)| {
            place.write(value);
        });
        Ok(())
    }

    /// Whether there is any.
    pub(crate) fn is_wanted(&self) -> bool {
        !self.places.is_empty()
    }
}

/// Room for one value.
///
/// # Safety
/// Where it is not NULL a `T` may be written there, by nobody else for as long as the room is used.
pub(crate) unsafe fn result<'a, T>(place: *mut T, name: &'static str) -> Result<Room<'a, T>, Refused> {
    // SAFETY: handed on.
    unsafe { Room::new(place, 1, name) }
}

/// Writes the one value of a [`result`].
pub(crate) fn put<T>(mut room: Room<'_, T>, value: T) -> Result<(), Refused> {
    room.fill(std::iter::once(value))
}

/// Hands `value` to the caller, who gives it back to [`free`].
pub(crate) fn handle<T>(room: Room<'_, *mut T>, value: T) -> Result<(), Refused> {
    put(room, Box::into_raw(Box::new(value)))
}

/// Takes back what [`handle`] gave; NULL is nothing.
///
/// # Safety
/// It came from [`handle`] and nobody uses it any more.
pub(crate) unsafe fn free<T>(handle: *mut T) {
    if handle.is_null() {
        return;
    }
    // SAFETY: it came from a box, is the last use of it by the caller's word.
    let owned = unsafe { Box::from_raw(handle) };
    // Nothing here panics when it is dropped; if it did, C must not see it.
    let _ = catch_unwind(AssertUnwindSafe(move || drop(owned)));
}
