//! What a caller is told: a code, and a sentence in memory of the caller's. Nothing here takes from the heap, and no
//! panic leaves.

use std::any::Any;
use std::ffi::c_char;
use std::fmt::{self, Write};
use std::panic::{AssertUnwindSafe, catch_unwind};

/// What a call answers: HAIRPIN_OK, or why it did nothing.
pub type Code = i32;

/// Done.
pub const HAIRPIN_OK: Code = 0;
/// A pointer is NULL where something must be.
pub const HAIRPIN_NULL: Code = 1;
/// A number, a size or a text is not what it must be.
pub const HAIRPIN_INVALID: Code = 2;
/// The caller's memory is too small for the result; the answer says how much it takes.
pub const HAIRPIN_TOO_SMALL: Code = 3;
/// The machine lacks what it takes: a thread.
pub const HAIRPIN_SYSTEM: Code = 4;
/// A mistake of hairpin's own, which the message tells.
pub const HAIRPIN_INTERNAL: Code = 5;

/// Bytes of a message, the closing NUL included; longer ones are cut.
pub const HAIRPIN_MESSAGE: usize = 256;

/// Why a call did nothing. Lies in the caller's memory, so that every thread has its own; written by every call that is
/// given one, also where it succeeds.
#[repr(C)]
pub struct Error {
    /// What the call answered.
    pub code: Code,
    /// A sentence in UTF-8 that ends with NUL; empty where it succeeded.
    pub message: [c_char; HAIRPIN_MESSAGE],
}

/// A refusal on its way out.
pub(crate) struct Refused {
    code: Code,
    message: Message,
}

impl Refused {
    pub(crate) fn new(code: Code, sentence: fmt::Arguments<'_>) -> Self {
        let mut message = Message { bytes: [0; HAIRPIN_MESSAGE], len: 0 };
        // What does not fit is cut; this does not fail.
        let _ = message.write_fmt(sentence);
        Self { code, message }
    }

    /// HAIRPIN_INVALID, with the words of an error of the library's.
    pub(crate) fn invalid(error: impl fmt::Display) -> Self {
        Self::new(HAIRPIN_INVALID, format_args!("{error}"))
    }
}

/// A sentence in place; its last byte stays 0.
struct Message {
    bytes: [u8; HAIRPIN_MESSAGE],
    len: usize,
}

impl Write for Message {
    fn write_str(&mut self, text: &str) -> fmt::Result {
        for letter in text.chars() {
            let size = letter.len_utf8();
            // A letter is there whole or not at all, and what follows one that is not is not either.
            let Some(place) = self.bytes[..HAIRPIN_MESSAGE - 1].get_mut(self.len..self.len + size) else {
                return Err(fmt::Error);
            };
            letter.encode_utf8(place);
            self.len += size;
        }
        Ok(())
    }
}

/// Does `work`, tells `error` (nothing where that is NULL) what came of it, and answers with its code.
///
/// # Safety
/// `error` is NULL or may be written.
pub(crate) unsafe fn enter(error: *mut Error, work: impl FnOnce() -> Result<(), Refused>) -> Code {
    // What a panic leaves half done is the work's own, or the caller's result, which is said to be none.
    let came = catch_unwind(AssertUnwindSafe(work)).unwrap_or_else(|panic| Err(internal(&*panic)));
    let Refused { code, message } = came.err().unwrap_or_else(|| Refused::new(HAIRPIN_OK, format_args!("")));
    if !error.is_null() && error.is_aligned() {
        let message = message.bytes.map(|byte| byte as c_char);
        // SAFETY: it is not NULL, lies as it must, and the caller lets it be written. What it held is not read.
        unsafe { error.write(Error { code, message }) };
    }
    code
}

fn internal(panic: &(dyn Any + Send)) -> Refused {
    let said = panic.downcast_ref::<String>().map(String::as_str).or_else(|| panic.downcast_ref::<&str>().copied());
    Refused::new(
        HAIRPIN_INTERNAL,
        format_args!("a mistake of hairpin's own: {}", said.unwrap_or("it does not say which")),
    )
}
