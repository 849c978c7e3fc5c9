//! Which hairpin it is.

use std::ffi::{CStr, c_char};

/// The version with the NUL that C ends strings by.
const VERSION: &CStr = match CStr::from_bytes_with_nul(concat!(env!("CARGO_PKG_VERSION"), "\0").as_bytes()) {
    Ok(version) => version,
    Err(_) => c"",
};

/// hairpin's version, as 0.1.0; never to be freed.
// SAFETY: no other library here exports the name.
#[unsafe(no_mangle)]
pub extern "C" fn hairpin_version() -> *const c_char {
    VERSION.as_ptr()
}
