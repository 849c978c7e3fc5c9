//! KUKA's KRL, a `.src` and a `.dat`, out and in: mm and degrees, A B C about z, y, x.
//!
//! What is written reads back to the same moves, and those are written as the same bytes. Of other programs the moves
//! up to the first line that says more are certain.

mod data;
mod lines;
mod moves;
mod phrases;
mod read;
mod state;
mod write;

#[cfg(test)]
mod tests;

pub use read::{NoProgram, read};
pub use write::{Files, KrlError, LONGEST_NAME, Settings, files, slower};

/// What names of positions begin with: the X keeps them clear of keywords, as the controller's own editor does.
const PREFIX: &str = "X";
/// What names of positions begin with that had none.
const UNNAMED: &str = "XAT";
/// What is said at the head of every program.
const CONVENTIONS: [&str; 2] = [
    "Positions in $BASE, mm and degrees; A about z, B about the new y, C about the new x.",
    "Status and turn (S, T) are not known and not given: joint moves to a pose keep those of the move before.",
];
/// How what is said of joint moves begins.
const JOINT_MOVES: &str = "Joint moves run at";
