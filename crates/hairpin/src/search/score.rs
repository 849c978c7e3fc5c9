//! Scores by hand: what is called stressful of a leg.
//!
//! Pure numbers but for `Ground`, and hypotheses: which of them predicts what a controller handles badly is measured
//! (EXPERIMENTS.md), and differs from controller to controller. `random` and the `high-velocity` family are the paper's
//! (Hildebrandt et al., ISSTA 2020), the others ours.

use std::f64::consts::{FRAC_PI_2, PI};

use thiserror::Error;

use super::objective::{Additive, ByTurn, LegView, Objective};
use crate::feasibility::reach::LegFeatures;
use crate::math::power::{power, square};
use crate::math::random::hashed_unit;

/// The scores that have names.
///
/// With Λ_T = 1 − |α − T|/T: 1 at the turn T, 0 straight on, and at T = 90° also 0 for a leg straight back. α in [0,
/// π]; on a first leg 0.
///
/// On a leg straight on the part of the turn is 0: products vanish there, sums keep their speed. Speeds in m/s, v_max
/// the top speed by which they are divided, ε = asin(climb/length) the elevation of a leg, so that sin ε is used as
/// it is and no angle is formed.
///
/// ```
/// use hairpin::feasibility::reach::LegFeatures;
/// use hairpin::search::{Additive, LegView, Score};
///
/// // A right angle, left at half of the top speed: ½ + 1.
/// let features = LegFeatures { v_out: 10.0, turn: std::f64::consts::FRAC_PI_2, ..LegFeatures::default() };
/// let leg = LegView { candidates: &[], from: 1, to: 2, duration: 1.0, features };
/// assert_eq!(Score::named("high-velocity-90", 0, 20.0)?.own(&leg), 1.5);
/// # Ok::<(), hairpin::search::ScoreMistake>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Score {
    /// A uniform number in [0, 1) per pair of waypoints, a pure function of `seed` and the two indices.
    Random {
        /// Seed of the graph's scores.
        seed: u64,
    },
    /// v_out / v_max.
    HighVelocity {
        /// Speed that scores 1, m/s.
        v_max: f64,
    },
    /// v_out / v_max + 1 − |α − T|/T, or with `product` v_out / v_max · (1 − |α − T|/T), α the turn angle.
    HighVelocityTurn {
        /// Speed that scores 1, m/s.
        v_max: f64,
        /// T: the turn angle that scores 1, rad.
        turn: f64,
        /// Whether the two parts are multiplied.
        product: bool,
    },
    /// v_in/v_max · v_out/v_max · (1 − |α − 90°|/90°): a right angle that is entered and left fast, so that the robot
    /// is carried out of it.
    FastCorner {
        /// Speed that scores 1, m/s.
        v_max: f64,
    },
    /// v_out / (v_in + v_max/20) · (1 − |α − 90°|/90°): a short leg, and a long one across it. A robot that passes
    /// waypoints at a distance goes on from beside the short leg; v_max/20 keeps legs that are all but nothing from
    /// outdoing those that lead somewhere.
    ShortLeg {
        /// Speed that scores 1, m/s.
        v_max: f64,
    },
    /// (v_out/v_max)² + 1 − |α − 90°|/90°: a few legs as long as they can be, for what many long ones would add, and
    /// right angles all along.
    HighEnergyTurn {
        /// Speed that scores 1, m/s.
        v_max: f64,
    },
    /// (n(v_out)² · min(v_in/(0.3 v_max), 1) · (1 − |α − 180°|/180°))⁴ + (1.4 n(v_in)² · v_out/v_max · |sin ε_out| · (1
    /// − |α − 90°|/90°))⁴, n(u) = min(u/v, v/u), v = v_max/16: fast into a leg back that is so short that the
    /// acceptance radius lets both its ends pass at once, and from there a long climb or dive across it. Two legs make
    /// one such place, so it is for sums; of fourth powers, since one place with both legs right strays farther than
    /// several with both half right.
    CutCorner {
        /// Speed that scores 1, m/s.
        v_max: f64,
    },
    /// v_out/v_max · cos ε_out · |sin ε_out − sin ε_in| · (1 − |α − 180°|/180°), ε the elevation of a leg: back, and
    /// over from a climb to a descent or the other way, with a long way across.
    Crest {
        /// Speed that scores 1, m/s.
        v_max: f64,
    },
    /// What the reach set itself found the leg to demand: [`LegFeatures::ground`].
    Ground,
}

/// Entry speed of `short-leg` that halves it, over the top speed.
const SHORT: f64 = 0.05;
/// Speed of the short leg that `cut-corner` looks for, over the top speed: 1.75 m in a step of 1 s at 28 m/s, beside an
/// acceptance radius of 1 m.
const CUT: f64 = 1.0 / 16.0;
/// Speed over the top speed from which a way into the short leg is fast enough.
const FAST: f64 = 0.3;
/// Makes the way out of the short leg count about as much as the way in: a climb or dive of 45° at the top speed scores
/// 1.
const OUT: f64 = 1.4;

/// Why there is no such score.
///
/// The `Display` form names the value and what is allowed, for the command line and for TOML alike.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum ScoreMistake {
    /// No score has this name.
    #[error("no score is called `{name}`; must be one of {}", Score::NAMES.join(", "))]
    Unknown {
        /// The name as given.
        name: String,
    },
    /// The top speed scales the score.
    #[error("top speed {v_max} m/s; must be a finite number above 0")]
    TopSpeed {
        /// The value as given, m/s.
        v_max: f64,
    },
}

impl Score {
    /// All names.
    /// As they are typed in a scenario. [`Score::Ground`] is none of them: drives and boats come
    /// to it by names of their own.
    pub const NAMES: [&'static str; 11] = [
        "random",
        "high-velocity",
        "high-velocity-90",
        "high-velocity-180",
        "high-velocity-90-product",
        "high-velocity-180-product",
        "high-energy-90",
        "fast-corner",
        "short-leg",
        "cut-corner",
        "crest",
    ];

    /// The names of those that say what is stressful.
    ///
    /// In the order of [`Score::NAMES`].
    pub fn by_hand() -> impl Iterator<Item = &'static str> {
        Self::NAMES.into_iter().filter(|name| *name != "random")
    }

    /// The score called `name`. `v_max` (m/s) is the farthest sampled end ÷ step; `seed` is that of `random`.
    ///
    /// # Errors
    /// An unknown name; a top speed that is no positive number.
    ///
    /// `random` takes any `v_max`, as it does not use it; the others take any `seed`.
    ///
    /// [`ScoreMistake::Unknown`] comes before [`ScoreMistake::TopSpeed`].
    pub fn named(name: &str, seed: u64, v_max: f64) -> Result<Self, ScoreMistake> {
        let score = match name {
            "random" => return Ok(Score::Random { seed }),
            "high-velocity" => Score::HighVelocity { v_max },
            "high-velocity-90" => Score::HighVelocityTurn { v_max, turn: FRAC_PI_2, product: false },
            "high-velocity-180" => Score::HighVelocityTurn { v_max, turn: PI, product: false },
            "high-velocity-90-product" => Score::HighVelocityTurn { v_max, turn: FRAC_PI_2, product: true },
            "high-velocity-180-product" => Score::HighVelocityTurn { v_max, turn: PI, product: true },
            "high-energy-90" => Score::HighEnergyTurn { v_max },
            "fast-corner" => Score::FastCorner { v_max },
            "short-leg" => Score::ShortLeg { v_max },
            "cut-corner" => Score::CutCorner { v_max },
            "crest" => Score::Crest { v_max },
            _ => return Err(ScoreMistake::Unknown { name: name.into() }),
        };
        if !(v_max.is_finite() && v_max > 0.0) {
            return Err(ScoreMistake::TopSpeed { v_max });
        }
        Ok(score)
    }
}

impl Objective for Score {
    type Memory = ();

    fn start(&self) {}

    fn extend(&self, (): &(), leg: &LegView<'_>) -> (f64, ()) {
        let LegFeatures { v_in, v_out, turn: alpha, length, climb, slope_in, .. } = leg.features;
        let sharp = |turn: f64| 1.0 - (alpha - turn).abs() / turn;
        let slope = || if length > 0.0 { climb / length } else { 0.0 };
        let score = match *self {
            Score::Random { seed } => hashed_unit(seed, &[leg.from.into(), leg.to.into()]),
            Score::HighVelocity { v_max } => v_out / v_max,
            Score::HighVelocityTurn { v_max, turn, product } => {
                let (fast, sharp) = (v_out / v_max, sharp(turn));
                if product { fast * sharp } else { fast + sharp }
            }
            Score::HighEnergyTurn { v_max } => square(v_out / v_max) + sharp(FRAC_PI_2),
            Score::FastCorner { v_max } => v_in / v_max * (v_out / v_max) * sharp(FRAC_PI_2),
            Score::ShortLeg { v_max } => v_out / (v_in + SHORT * v_max) * sharp(FRAC_PI_2),
            Score::CutCorner { v_max } => {
                let near = |speed: f64| {
                    let share = speed / (CUT * v_max);
                    square(share.min(1.0 / share))
                };
                let back = near(v_out) * (v_in / (FAST * v_max)).min(1.0) * sharp(PI);
                let across = OUT * near(v_in) * (v_out / v_max) * slope().abs() * sharp(FRAC_PI_2);
                power(back, 4) + power(across, 4)
            }
            Score::Crest { v_max } => {
                let slope = slope();
                let across = (1.0 - slope * slope).max(0.0).sqrt();
                v_out / v_max * across * (slope - slope_in).abs() * sharp(PI)
            }
            Score::Ground => leg.features.ground,
        };
        (score, ())
    }
}

impl Additive for Score {
    fn own(&self, leg: &LegView<'_>) -> f64 {
        self.extend(&(), leg).0
    }

    fn is_timeless(&self) -> bool {
        true
    }

    /// The formulas of [`Objective::extend`], of which products and sums with 1 and −0 leave every bit.
    fn by_turn(&self, leg: &LegView<'_>) -> Option<ByTurn> {
        let LegFeatures { v_in, v_out, .. } = leg.features;
        let (best, plain, turning) = match *self {
            Score::HighVelocity { v_max } => (PI, v_out / v_max, 0.0),
            Score::HighVelocityTurn { v_max, turn, product: false } => (turn, v_out / v_max, 1.0),
            Score::HighVelocityTurn { v_max, turn, product: true } => (turn, -0.0, v_out / v_max),
            Score::HighEnergyTurn { v_max } => (FRAC_PI_2, square(v_out / v_max), 1.0),
            Score::FastCorner { v_max } => (FRAC_PI_2, -0.0, v_in / v_max * (v_out / v_max)),
            Score::ShortLeg { v_max } => (FRAC_PI_2, -0.0, v_out / (v_in + SHORT * v_max)),
            Score::Random { .. } | Score::CutCorner { .. } | Score::Crest { .. } | Score::Ground => return None,
        };
        Some(ByTurn { best, plain, turning })
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    fn leg(v_out: f64, turn_deg: f64) -> LegFeatures {
        LegFeatures {
            v_in: 5.0,
            v_out,
            turn: turn_deg.to_radians(),
            length: v_out,
            climb: 0.0,
            slope_in: 0.0,
            ground: 0.0,
        }
    }

    fn score(name: &str, features: LegFeatures) -> f64 {
        let view = LegView { candidates: &[], from: 3, to: 4, duration: 1.0, features };
        Score::named(name, 7, 20.0).unwrap().extend(&(), &view).0
    }

    #[test]
    fn the_authors_formulas() {
        for (name, turn, expected) in [
            ("high-velocity", 90.0, 0.5),
            ("high-velocity-90", 90.0, 1.5),
            ("high-velocity-90", 135.0, 1.0),
            ("high-velocity-90", 0.0, 0.5),
            ("high-velocity-90", 180.0, 0.5),
            ("high-velocity-180", 180.0, 1.5),
            ("high-velocity-180", 45.0, 0.75),
            ("high-velocity-90-product", 45.0, 0.25),
            ("high-velocity-180-product", 0.0, 0.0),
        ] {
            let got = score(name, leg(10.0, turn));
            assert!((got - expected).abs() < 1e-12, "{name} at {turn}°: {got}");
        }
    }

    #[test]
    fn our_own_formulas() {
        // v_max = 20, v_in = 5, v_out = length = 10.
        for (name, turn, expected) in [
            ("high-energy-90", 90.0, 1.25),
            ("high-energy-90", 135.0, 0.75),
            ("fast-corner", 90.0, 0.125),
            ("fast-corner", 135.0, 0.0625),
            ("fast-corner", 180.0, 0.0),
            ("short-leg", 90.0, 10.0 / 6.0),
            ("short-leg", 45.0, 5.0 / 6.0),
        ] {
            let got = score(name, leg(10.0, turn));
            assert!((got - expected).abs() < 1e-12, "{name} at {turn}°: {got}");
        }
        // From a climb of 30° down as steeply: sines 0.5 and −0.5, and back by 120°.
        let over = LegFeatures { climb: -5.0, slope_in: 0.5, ..leg(10.0, 120.0) };
        let expected = 0.5 * 0.75f64.sqrt() * 2.0 / 3.0;
        assert!((score("crest", over) - expected).abs() < 1e-12, "{}", score("crest", over));
        assert_eq!(score("crest", LegFeatures { climb: 10.0, ..over }), 0.0, "nothing across");
        // 1.25 m/s is what it looks for, and 6 m/s are fast: into the short leg by a half turn, out of one of twice
        // that speed by a climb of 30°.
        let short = LegFeatures { v_out: 1.25, length: 1.25, ..leg(1.25, 180.0) };
        let expected = (5.0f64 / 6.0).powi(4);
        assert!((score("cut-corner", short) - expected).abs() < 1e-12, "{}", score("cut-corner", short));
        assert!((score("cut-corner", LegFeatures { v_in: 7.0, ..short }) - 1.0).abs() < 1e-12, "no faster than fast");
        let out = LegFeatures { v_in: 2.5, climb: 5.0, ..leg(10.0, 90.0) };
        let expected = (0.125f64 * 0.125 * 2.5 / 6.0 * 0.5).powi(4) + (1.4f64 * 0.25 * 0.5 * 0.5).powi(4);
        assert!((score("cut-corner", out) - expected).abs() < 1e-12, "{}", score("cut-corner", out));
    }

    #[test]
    fn what_a_turn_adds_is_the_same_to_the_bit() {
        let mut told = 0;
        for name in Score::NAMES {
            let score = Score::named(name, 3, 20.0).expect("a name");
            for (step, v_out) in (0..=180).zip([0.0, 1e-3, 0.7, 5.0, 19.3].into_iter().cycle()) {
                let view =
                    LegView { candidates: &[], from: 1, to: 2, duration: 1.0, features: leg(v_out, f64::from(step)) };
                if let Some(by_turn) = score.by_turn(&view) {
                    assert_eq!(by_turn.at(view.features.turn).to_bits(), score.own(&view).to_bits(), "{name} {step}");
                    told += 1;
                }
            }
        }
        assert_eq!(told, 8 * 181);
    }

    #[test]
    fn random_depends_on_seed_and_waypoints_alone() {
        let at = |seed, from, to, v_out| {
            let view = LegView { candidates: &[], from, to, duration: 1.0, features: leg(v_out, 10.0) };
            Score::Random { seed }.extend(&(), &view).0
        };
        assert_eq!(at(1, 2, 3, 4.0), at(1, 2, 3, 9.0));
        assert_ne!(at(1, 2, 3, 4.0), at(1, 3, 2, 4.0));
        assert_ne!(at(1, 2, 3, 4.0), at(2, 2, 3, 4.0));
    }

    #[test]
    fn every_name_is_known_and_others_are_told_all_of_them() {
        for name in Score::NAMES {
            assert!(Score::named(name, 0, 10.0).is_ok(), "{name}");
        }
        let message = Score::named("fast", 0, 10.0).unwrap_err().to_string();
        assert!(message.contains("`fast`") && message.contains("high-velocity-180-product"), "{message}");
        assert!(Score::named("high-velocity", 0, f64::NAN).is_err());
        assert!(Score::named("high-velocity", 0, 0.0).is_err());
    }
}
