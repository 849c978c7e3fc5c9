//! The C door, from both sides: its entries as C calls them, and C and C++ that are compiled against the header.

mod called;
mod drives;
mod header;
mod loads_and_tracks;
mod other_drives;
mod page;
mod refused;
