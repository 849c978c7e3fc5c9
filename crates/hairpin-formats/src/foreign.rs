//! Decoders of other people, which meet bytes from anywhere: a panic in one is a broken file, not our end, and no
//! mistake of ours to be reported.

use std::cell::Cell;
use std::panic::{AssertUnwindSafe, catch_unwind};

thread_local! {
    static CALLED: Cell<u32> = const { Cell::new(0) };
}

/// The call of a decoder panicked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Panicked;

/// What `decode` gives, or that it panicked. It must decode on this thread.
pub(crate) fn call<T>(decode: impl FnOnce() -> T) -> Result<T, Panicked> {
    CALLED.set(CALLED.get() + 1);
    let answer = catch_unwind(AssertUnwindSafe(decode));
    CALLED.set(CALLED.get() - 1);
    answer.map_err(|_| Panicked)
}

/// Whether a panic on this thread would be such a decoder's: who tells of panics keeps silent about it.
pub fn is_called() -> bool {
    CALLED.get() > 0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_answer_and_whose_it_is_is_known() {
        assert!(!is_called());
        assert_eq!(call(|| (is_called(), call(is_called))), Ok((true, Ok(true))));
        assert_eq!(call(|| -> u32 { panic!("someone else's") }), Err(Panicked));
        assert!(!is_called());
    }
}
