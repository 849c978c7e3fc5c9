//! What of a path a recording is past and was never near. Samples are aligned with the path in order, and poses of it
//! may be skipped: of a program that comes back to where it was, an arm that stands there has run the whole.

use super::{Look, MILLI, POINTS};
use crate::math::segment::point_distance;

/// An acute corner whose sides are kept to may be cut by so many limits of the path.
const CORNERS: f64 = 3.0;
/// By how much a path without a limit may be cut, m.
const UNLIMITED_M: f64 = 0.1;

impl Look<'_> {
    /// The first of the path that is left out, in a sentence.
    pub(super) fn left_out(&self) -> Option<String> {
        let most = self.hidden.path.map_or(UNLIMITED_M, |limit| CORNERS * limit) + self.hidden.corner;
        let (i, far) = (0..self.recording.len() - 1).find_map(|i| Some((i, self.passed_over(i, most)?)))?;
        let told = |along: f64| {
            let index = self.way.owner(along);
            format!("move {} ({})", index + 1, self.path.moves()[index].name)
        };
        Some(format!(
            "from t = {:.3} s on the log is past what lies between {} and {}, and was {:.1} mm away from it: it was left out",
            self.recording.times()[i],
            told(self.progress[i]),
            told(self.progress[i + 1]),
            MILLI * far
        ))
    }

    /// How far (m) from the chord the path between the places of sample `i` and the next leads, where that is more than
    /// `most` m and what may be hidden between both.
    fn passed_over(&self, i: usize, most: f64) -> Option<f64> {
        let between = self.nearest[i] + 1..self.nearest[i + 1];
        let within = most + self.hidden.between.hidden(i);
        let (from, to) = (self.recording.position(i), self.recording.position(i + 1));
        let off = between.map(|j| (point_distance(&self.way.place(j), &from, &to), j));
        let (far, j) = off.max_by(|a, b| a.0.total_cmp(&b.0)).filter(|(far, _)| *far > within)?;
        // Joints go straight, the tool need not.
        let place = self.way.place(j);
        let chord = self.hidden.between.chord(i, POINTS);
        let near = chord.iter().map(|point| (point - place).norm()).fold(far, f64::min);
        (near > within).then_some(near)
    }
}
