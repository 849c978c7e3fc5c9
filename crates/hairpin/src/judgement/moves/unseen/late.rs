//! How late a recording shows that moves arrived: each arrival lies somewhere between two samples.

use super::{Look, MILLI, OUTLYING};
use crate::judgement::moves::MoveMeasures;

impl Look<'_> {
    /// Why it is open whether an arrival is late, of the first of those; and the latest of all that are late for
    /// certain.
    ///
    /// Late for certain is what even at the sample before it is, on time what the sample after it is; open in between.
    pub(super) fn late(&self, moves: &[MoveMeasures]) -> (Option<String>, Option<usize>) {
        let Some(limit) = self.hidden.late else { return (None, None) };
        let (mut open, mut proven) = (None, None);
        for (index, one) in moves.iter().enumerate() {
            let Some([least, most]) = one.late_between() else { continue };
            if least > limit {
                let by = one.late().unwrap_or(least);
                if proven.is_none_or(|(_, latest)| by > latest) {
                    proven = Some((index, by));
                }
            } else if most > limit && open.is_none() {
                open = Some(self.told_late(index, one, [least, most], limit));
            }
        }
        (open, proven.map(|(index, _)| index))
    }

    fn told_late(&self, index: usize, one: &MoveMeasures, [least, most]: [f64; 2], limit: f64) -> String {
        let (name, times) = (&one.name, self.recording.times());
        let [early, late, limit] = [least, most, limit].map(|seconds| MILLI * seconds);
        let reached = self.progress.partition_point(|progress| *progress < self.targets[index]);
        let Some(before) = reached.checked_sub(1) else {
            return format!(
                "the log begins at t = {:.3} s, behind {name}: it arrived at most {late:.1} ms late, which is not seen, the limit is {limit:.1} ms",
                times[0]
            );
        };
        if self.seconds(before) > OUTLYING * self.usual {
            return format!(
                "{}: {name} arrived between {early:.0} and {late:.0} ms late, the limit is {limit:.0} ms",
                self.gap(before)
            );
        }
        format!(
            "{name} arrived between {early:.1} and {late:.1} ms late, after t = {:.3} s: samples are {:.3} s apart there, the limit is \
             {limit:.1} ms",
            times[before],
            self.seconds(before)
        )
    }
}
