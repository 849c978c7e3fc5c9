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
    /// Its stress: −∞ of what fails without a measured one, which is worse than all that does not fail and no worse
    /// than what else does. No comparison holds where it is NaN and both fail, or neither.
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

    /// Of what came to this end with this stress, where that was measured; NaN where it says nothing: it was not, and
    /// nothing fails. An infinite stress could not be told from a mistake, and counts as not measured.
    pub fn of(fails: bool, stress: Option<f64>) -> Self {
        let without = if fails { f64::NEG_INFINITY } else { f64::NAN };
        Self { fails, stress: stress.filter(|stress| stress.is_finite()).unwrap_or(without) }
    }

    /// The stress as it is told; 0 where none was measured.
    pub fn told(self) -> f64 {
        if self.stress.is_finite() { self.stress } else { 0.0 }
    }

    /// One number in the same order, for searches that know of scores alone: the stress itself of what does not fail,
    /// and numbers above 2⁵⁰⁰ else.
    ///
    /// Bits of positive numbers are in the order of the numbers: those of the stress, counted from 2⁻¹⁰⁰, are added to
    /// those of 2⁷⁰⁰, or taken off where it is negative. Exact for 0 and for magnitudes of 2⁻¹⁰⁰ … 2¹⁰⁰, of which −2¹⁰⁰
    /// stands for −∞; stresses of what does not fail are below 2⁵⁰⁰.
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
        let magnitude = match above.unsigned_abs() {
            0 => 0.0,
            most if above < 0 && most == MOST - LEAST => f64::INFINITY,
            bits => f64::from_bits(LEAST + bits),
        };
        Self { fails: true, stress: if above < 0 { -magnitude } else { magnitude } }
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn scores_are_in_the_order_of_ranks_and_lead_back_to_them() {
        let stresses = [f64::NEG_INFINITY, -1e9, -0.3, -1e-6, 0.0, 1e-6, 0.3, 0.3f64.next_up(), 2.0, 1e9];
        let of = |fails: bool| stresses.iter().map(move |&stress| Rank { fails, stress });
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

    #[test]
    fn what_fails_has_a_rank_without_a_stress() {
        let crash = Rank::of(true, None);
        assert!(
            crash > Rank::of(false, Some(1e9)) && crash < Rank::of(true, Some(-1e9)) && crash >= Rank::of(true, None)
        );
        assert_eq!((crash, crash.told()), (Rank::of(true, Some(f64::INFINITY)), 0.0));
        let nothing = Rank::of(false, None);
        assert!(nothing.stress.is_nan() && nothing.partial_cmp(&Rank::LEAST).is_none());
        assert_eq!(Rank::of(false, Some(0.3)).told(), 0.3);
    }
}
