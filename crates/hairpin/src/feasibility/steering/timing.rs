//! How long legs may take: one fixed step, or a ladder of times of which the shortest feasible is taken.

/// Leg times in s.
///
/// `Ladder` takes the shortest feasible rung: legs as fast as they can be, to a ratio.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum LegTiming {
    /// Every leg takes this long.
    ///
    /// s, > 0.
    Step(f64),
    /// A geometric ladder from `shortest` to `longest`, both included, neighbours no more than `ratio` apart.
    /// Feasibility is not monotone in the time where ends have velocities, so every rung is tried, shortest first.
    Ladder {
        /// First rung.
        shortest: f64,
        /// Last rung.
        longest: f64,
        /// Largest quotient of neighbouring rungs, > 1.
        ratio: f64,
    },
}

impl LegTiming {
    /// Neighbouring rungs at most a fifth apart: a leg is no more than that slower than it has to be, and 0.8 … 4 s
    /// takes 10 rungs.
    pub const RATIO: f64 = 1.2;

    /// The ladder from `shortest` to `longest` (s) with the ratio [`Self::RATIO`].
    pub fn ladder(shortest: f64, longest: f64) -> Self {
        LegTiming::Ladder { shortest, longest, ratio: Self::RATIO }
    }

    /// Shortest and longest leg time, s.
    ///
    /// A ladder whose ends are the wrong way round is one rung, its `shortest`.
    pub fn range(&self) -> (f64, f64) {
        match *self {
            LegTiming::Step(step) => (step, step),
            LegTiming::Ladder { shortest, longest, .. } => (shortest, longest.max(shortest)),
        }
    }

    /// The rungs in rising order, s.
    ///
    /// T_k = shortest · (longest/shortest)^(k/n), k = 0 … n, n the least whole number for which neighbours are no more
    /// than `ratio` apart. At most 10 001 rungs; ratios below 1.001 count as that. Ends that are equal, reversed or no
    /// numbers give the one rung `shortest`, whatever it is: durations are refused where legs are judged.
    pub fn rungs(&self) -> Vec<f64> {
        match *self {
            LegTiming::Step(step) => vec![step],
            LegTiming::Ladder { shortest, ratio, .. } => {
                let longest = self.range().1;
                let gaps =
                    (libm::log(longest / shortest) / libm::log(ratio.max(1.001)) - 1e-9).ceil().clamp(0.0, 10_000.0);
                if !(gaps > 0.0 && gaps.is_finite()) {
                    return vec![shortest];
                }
                // The last rung is the limit itself, not what rounding makes of it.
                let rung = |k: usize| shortest * libm::pow(longest / shortest, k as f64 / gaps);
                (0..gaps as usize).map(rung).chain([longest]).collect()
            }
        }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn ladders_rise_geometrically_between_their_ends() {
        let rungs = LegTiming::ladder(0.8, 4.0).rungs();
        assert_eq!((rungs.len(), rungs[0], rungs[9]), (10, 0.8, 4.0));
        assert!(rungs.windows(2).all(|w| w[1] > w[0] && w[1] / w[0] < 1.2 + 1e-12));
        assert_eq!(LegTiming::ladder(1.0, 1.0).rungs(), vec![1.0]);
        assert_eq!(LegTiming::Step(1.5).rungs(), vec![1.5]);
    }
}
