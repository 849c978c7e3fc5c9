//! What readers of programs make of a text, whatever its language: the moves that are certain, and what every line
//! means for motion.

mod calls;
mod line;
mod module;
mod reading;
mod text;
mod unmodelled;

pub(crate) use calls::calls;
pub use line::{At, Class, Line};
pub use module::{Declared, File, Found, Module, Part, Procedure};
pub(crate) use reading::{Doubt, Reading, beside};
pub(crate) use text::decode;
pub use unmodelled::Unmodelled;
