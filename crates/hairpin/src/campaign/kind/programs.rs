//! Programs: what kinds have whose motion is a list of moves for a controller.

use crate::campaign::case::Case;
use crate::campaign::learn::MoveFeatures;
use crate::judgement::Violation;
use crate::judgement::moves::Measured;
use crate::trajectory::{PlannedPath, Track};

/// Runs that are measured move by move.
pub(in crate::campaign) trait Programs {
    /// The logs whose recordings are the runs, where nothing is executed.
    fn recordings(&self) -> Option<&str>;

    /// The path that deviations are measured from: with the program's zones, or through its points.
    fn reference(&self, case: &Case) -> Option<Track>;

    /// The programmed path of `case` with its zones, and where its moves end; `None` where it has none.
    fn programmed(&self, case: &Case) -> Option<PlannedPath>;

    /// What `recording` did on each move of the path, and of logs what they do not show; `None` where it is too short.
    /// Distances of samples are left out. `reference` is what deviations are measured from.
    fn measured(&self, programmed: &PlannedPath, recording: &Track, reference: Option<&Track>) -> Option<Measured>;

    /// What a search knows of each move of the program of `case`; `None` of those from and to home, on arcs, and
    /// between points of unknown posture.
    fn moves_seen(&self, case: &Case) -> Vec<Option<MoveFeatures>>;

    /// The same violation in the units that programs are written in.
    fn in_their_units(&self, violation: Violation) -> Violation;
}
