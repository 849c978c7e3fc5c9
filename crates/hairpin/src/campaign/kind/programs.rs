//! Programs: what kinds have whose motion is a list of moves for a controller.
//!
//! Only arms have them. The judge measures such runs move by move (when points are met, how far the path is left),
//! not leg by leg of a straight line.

use crate::campaign::case::Case;
use crate::campaign::learn::MoveFeatures;
use crate::judgement::Violation;
use crate::judgement::moves::Measured;
use crate::trajectory::program::Program;
use crate::trajectory::{PlannedPath, Track};

/// Runs that are measured move by move, and what is known of moves that are not possible.
///
/// Moves are numbered from 0 in the order of the program; positions in m, times in s, whatever the units of the
/// program's language.
pub(in crate::campaign) trait Programs {
    /// The logs whose recordings are the runs, where nothing is executed.
    fn recordings(&self) -> Option<&str>;

    /// A program through all points: what any program can name, it names. Nothing is known of its moves.
    fn naming_all(&self) -> Program;

    /// What its programs call by a name that stands for something else on every controller of their language, in a
    /// sentence; `None` where there is no such thing.
    fn misnamed(&self) -> Option<String>;

    /// The path that deviations are measured from: with the program's zones, which is the one that is `programmed`, or
    /// through its points.
    fn reference(&self, case: &Case, programmed: Option<&PlannedPath>) -> Option<Track>;

    /// The programmed path of `case` with its zones, and where its moves end; `None` where it has none.
    fn programmed(&self, case: &Case) -> Option<PlannedPath>;

    /// What `recording` did on each move of the path, and of logs what they do not show; `None` where it is too short.
    /// Distances of samples are left out, not the moves that they belong to. `reference` is what deviations are
    /// measured from.
    fn measured(&self, programmed: &PlannedPath, recording: &Track, reference: Option<&Track>) -> Option<Measured>;

    /// Why `recording` is of no robot like this one, in a sentence's part: joints beyond what they can do. `None` where
    /// nothing speaks against it.
    fn beyond(&self, recording: &Track) -> Option<String>;

    /// What a search knows of each move of the program of `case`; `None` of those from and to home, on arcs, and
    /// between points of unknown posture.
    fn moves_seen(&self, case: &Case) -> Vec<Option<MoveFeatures>>;

    /// What stands in the way of moves, each in a sentence, where more is known than what is counted as lost.
    fn in_the_way(&self) -> Vec<String>;

    /// Where no program is feasible: why that is not found out, and what key would let it be, in a sentence's part;
    /// `None` where it is.
    fn not_found_out(&self) -> Option<String>;

    /// Seconds that explaining takes at most where nobody says.
    ///
    /// s.
    fn patience(&self) -> f64;

    /// The same violation in the units that programs are written in.
    ///
    /// mm and ms in place of m and s, value and limit alike.
    fn in_their_units(&self, violation: Violation) -> Violation;
}
