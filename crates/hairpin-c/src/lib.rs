//! The C door: what flight and cell software embeds of hairpin, without its files and without its command.
//!
//! | header | what | file |
//! | --- | --- | --- |
//! | `hairpin_steer` | a drive between two states, in the plane or on a map | `steer` |
//! | `hairpin_steer_clear` | the same, around places | `clear` |
//! | `hairpin_follow` | the states along a drive | `follow` |
//! | `hairpin_max_load` | the heaviest path through a table of costs | `max_load` |
//! | `hairpin_judge` | a track against waypoints and limits | `judge` |
//!
//! Every entry takes pointers of a caller that nobody checks: each is looked at before it is read (`memory`), each
//! mistake is a code with a sentence (`refusal`), and a panic ends at the door. Results lie in the caller's memory.
//! `include/hairpin.h` is made of this source by cbindgen, which `tests/c` repeats; docs/c.md is the guide.

#![cfg_attr(not(test), deny(clippy::unwrap_used))] // tests may, what meets users' data may not

mod asked;
pub mod clear;
mod confirm;
pub mod drive;
pub mod follow;
mod ground;
mod held;
pub mod judge;
pub mod map;
pub mod max_load;
pub mod measures;
mod memory;
mod plane;
pub mod refusal;
pub mod rover;
pub mod settings;
pub mod steer;
pub mod track;
pub mod version;
