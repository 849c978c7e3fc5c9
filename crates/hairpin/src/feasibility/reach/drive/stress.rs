//! What a leg on the ground demands, as a score: a sum of named terms.

use thiserror::Error;

/// The terms a score on the ground may have, each of one leg; larger is more stressful.
///
/// Numbers without a unit, of the order of 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Term {
    Slope,
    Roll,
    CurvatureChange,
    Slip,
    Speed,
    Reversals,
    Random,
}

impl Term {
    const ALL: [(Self, &'static str); 7] = [
        (Self::Slope, "slope"),
        (Self::Roll, "roll"),
        (Self::CurvatureChange, "curvature-change"),
        (Self::Slip, "slip"),
        (Self::Speed, "speed"),
        (Self::Reversals, "reversals"),
        (Self::Random, "random"),
    ];
}

/// A score of legs on the ground: the sum of its terms, each once.
///
/// | term | of a leg |
/// | --- | --- |
/// | `slope` | max \|climb angle\| along the direction of travel ÷ tilt limit |
/// | `roll` | max \|φ\| ÷ tilt limit |
/// | `curvature-change` | ∫ \|κ′\| ds, jumps at stops included, ÷ (2 κ_max): 1 is one change from lock to lock |
/// | `slip` | mean over the way of √((s₂₀ sin climb)² + (s′₂₀ sin side)²) ÷ sin 20° (of the rover's slip, or 1 each) |
/// | `speed` | distance of the waypoints ÷ (time of the leg × commanded speed) |
/// | `reversals` | changes of gear on the way |
/// | `random` | a uniform number in [0, 1) per pair of waypoints, a pure function of the seed and the two indices |
///
/// Where there is no tilt limit, 90° stands for it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct GroundScore {
    terms: Vec<Term>,
}

impl Default for GroundScore {
    /// `slope+slip`.
    fn default() -> Self {
        Self { terms: vec![Term::Slope, Term::Slip] }
    }
}

/// Terms that no score on the ground has.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error(
    "no score of legs on the ground is called {}; must be one or more of {}, joined by `+`",
    .unknown.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", "),
    GroundScore::TERMS.join(", ")
)]
pub struct UnknownTerms {
    /// Their names as given.
    pub unknown: Vec<String>,
}

/// What was met on a leg, from which its score is made.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Demands {
    /// Largest |climb| over the tilt that scores 1.
    pub(super) slope: f64,
    /// Largest |φ| over the same.
    pub(super) roll: f64,
    /// ∫ |κ′| ds over 2 κ_max.
    pub(super) curvature_change: f64,
    /// Mean share of slip.
    pub(super) slip: f64,
    /// Mean speed as the crow flies over the commanded speed.
    pub(super) speed: f64,
    /// Changes of gear.
    pub(super) reversals: f64,
    /// Uniform in 0 … 1.
    pub(super) random: f64,
}

impl GroundScore {
    /// The names of all terms.
    pub const TERMS: [&'static str; 7] = {
        let mut names = [""; 7];
        let mut i = 0;
        while i < names.len() {
            names[i] = Term::ALL[i].1;
            i += 1;
        }
        names
    };

    /// The score called `name`: terms joined by `+`, blanks around them and repetitions allowed.
    ///
    /// # Errors
    /// All names that are no term.
    pub fn named(name: &str) -> Result<Self, UnknownTerms> {
        let (mut terms, mut unknown) = (Vec::new(), Vec::new());
        for part in name.split('+').map(str::trim) {
            match Term::ALL.iter().find(|(_, known)| *known == part) {
                Some((term, _)) if terms.contains(term) => {}
                Some((term, _)) => terms.push(*term),
                None => unknown.push(part.to_owned()),
            }
        }
        if unknown.is_empty() { Ok(Self { terms }) } else { Err(UnknownTerms { unknown }) }
    }

    /// The score of a leg that demands this.
    pub(super) fn of(&self, demands: &Demands) -> f64 {
        let value = |term: &Term| match term {
            Term::Slope => demands.slope,
            Term::Roll => demands.roll,
            Term::CurvatureChange => demands.curvature_change,
            Term::Slip => demands.slip,
            Term::Speed => demands.speed,
            Term::Reversals => demands.reversals,
            Term::Random => demands.random,
        };
        self.terms.iter().map(value).sum()
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn a_score_is_the_sum_of_its_terms_and_unknown_ones_are_told_all() {
        let demands = Demands {
            slope: 1.0,
            roll: 2.0,
            curvature_change: 4.0,
            slip: 8.0,
            speed: 16.0,
            reversals: 32.0,
            random: 64.0,
        };
        let score = |name: &str| GroundScore::named(name).map(|score| score.of(&demands));
        assert_eq!(score("slope+slip"), Ok(9.0));
        assert_eq!(score(" roll + reversals + roll"), Ok(34.0));
        assert_eq!(score(&GroundScore::TERMS.join("+")), Ok(127.0));
        assert_eq!(GroundScore::default(), GroundScore::named("slope+slip").unwrap());
        let message = score("slope+bumps+fun").unwrap_err().to_string();
        assert!(message.contains("`bumps`, `fun`; must be one or more of slope, roll"), "{message}");
        assert!(score("").is_err() && score("slope+").is_err());
    }
}
