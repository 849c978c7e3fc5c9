//! How grave an execution is: what fails is worse than all that only strays, however far.

/// Greater is worse: what fails before what does not, among these by stress.
///
/// The one order of all searches that execute. A run that a crash cut short has the stress of the way until then, and
/// would fall behind what strays farther and comes home.
#[derive(Debug, Clone, Copy, PartialEq, PartialOrd)]
pub struct Rank {
    // Compared in this order.
    /// Whether it came to an end that is worse than any stress: a crash, the world left, a run that stops short.
    pub fails: bool,
    /// Its stress; no comparison holds where it is NaN and both fail, or neither.
    pub stress: f64,
}

/// Bits of 2⁻¹⁰⁰ and of 2¹⁰⁰: stresses of what fails keep all their bits between these.
const LEAST: u64 = (1023 - 100) << 52;
const MOST: u64 = (1023 + 100) << 52;
/// Bits of 2⁷⁰⁰, the score of what fails without stress: such scores lie between 2⁵⁰⁰ and 2⁹⁰⁰.
const MIDDLE: u64 = (1023 + 700) << 52;

impl Rank {
    /// Below all others.
    pub const LEAST: Rank = Rank { fails: false, stress: f64::NEG_INFINITY };

    /// One number in the same order, for searches that know of scores alone: the stress itself of what does not fail,
    /// and numbers above 2⁵⁰⁰ else.
    ///
    /// Bits of positive numbers are in the order of the numbers: those of the stress, counted from 2⁻¹⁰⁰, are added to
    /// those of 2⁷⁰⁰, or taken off where it is negative. Exact for 0 and for magnitudes of 2⁻¹⁰⁰ … 2¹⁰⁰; stresses of
    /// what does not fail are below 2⁵⁰⁰.
    pub fn score(self) -> f64 {
        if !self.fails || self.stress.is_nan() {
            return self.stress;
        }
        let above = (self.stress.abs().to_bits().clamp(LEAST, MOST) - LEAST).cast_signed();
        f64::from_bits(MIDDLE.saturating_add_signed(if self.stress < 0.0 { -above } else { above }))
    }

    /// The rank that [`Self::score`] made `score` of.
    pub fn of_score(score: f64) -> Self {
        let above = score.to_bits().wrapping_sub(MIDDLE).cast_signed();
        if above.unsigned_abs() > MOST - LEAST {
            return Self { fails: false, stress: score };
        }
        let magnitude = if above == 0 { 0.0 } else { f64::from_bits(LEAST + above.unsigned_abs()) };
        Self { fails: true, stress: if above < 0 { -magnitude } else { magnitude } }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scores_are_in_the_order_of_ranks_and_lead_back_to_them() {
        let stresses = [f64::NEG_INFINITY, -1e9, -0.3, -1e-6, 0.0, 1e-6, 0.3, 0.3f64.next_up(), 2.0, 1e9];
        let of = |fails: bool| {
            stresses.iter().filter(move |s| !fails || s.is_finite()).map(move |&stress| Rank { fails, stress })
        };
        let ranks: Vec<Rank> = of(false).chain(of(true)).collect();
        assert!(ranks.is_sorted_by(|a, b| a < b) && ranks.iter().all(|rank| Rank::of_score(rank.score()) == *rank));
        assert!(ranks.iter().map(|rank| rank.score()).is_sorted_by(|a, b| a < b));
        assert!(
            of(false).all(|rank| rank.score().to_bits() == rank.stress.to_bits()),
            "what does not fail is as it is"
        );
        assert_eq!(Rank::of_score(f64::INFINITY), Rank { fails: false, stress: f64::INFINITY });
        assert!(Rank { fails: true, stress: f64::NAN }.score().is_nan());
    }
}
