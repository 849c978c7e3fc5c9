//! How a controller tells axis 3: of an arm whose forearm a parallel rod drives from the base, against the base.
//!
//! ```text
//! rax_3 = θ₃ + θ₂        θ₃ = rax_3 − rax_2        axis 3's own angle θ₃ is against the upper arm, as URDF has it
//! ```
//!
//! ABB's arms with a parallel rod (IRB 2400, 4400, 6400, …) are told so in RAPID's joint targets. ros-industrial's
//! abb_driver converts by that where its parameter `J23_coupled` is true; the IRB 2400's modified Denavit-Hartenberg
//! table has q3 − q2 for axis 3 (doi 10.2478/ama-2025-0064).

use super::Joints;

/// What the controller's angle of axis 3 is.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Coupling {
    /// θ₃ itself.
    #[default]
    Serial,
    /// θ₃ + θ₂.
    Coupled,
    /// Not said, of an arm whose name is that of a type with a parallel rod.
    Unsaid,
}

/// ABB's types of six axes with a parallel rod.
const TYPES: [&str; 9] = ["1400", "1410", "2400", "4400", "4450", "5400", "6400", "6660", "8700"];

impl Coupling {
    /// As a file says it, or as far as the arm's name does.
    pub(super) fn of(given: Option<bool>, name: &str) -> Self {
        match given {
            Some(true) => Self::Coupled,
            Some(false) => Self::Serial,
            None if has_rod(name) => Self::Unsaid,
            None => Self::Serial,
        }
    }

    /// The controller's angles of an arm's own `q`, rad. What is not said is taken for serial.
    pub fn told(self, q: &Joints) -> Joints {
        self.moved(q, 1.0)
    }

    /// The arm's own angles of what its controller tells, rad. What is not said is taken for serial.
    pub fn own(self, told: &Joints) -> Joints {
        self.moved(told, -1.0)
    }

    fn moved(self, q: &Joints, sign: f64) -> Joints {
        let mut moved = *q;
        if self == Self::Coupled {
            moved[2] += sign * q[1];
        }
        moved
    }
}

/// Whether a name has `IRB`, and behind it the number of a type with a parallel rod.
fn has_rod(name: &str) -> bool {
    let name = name.to_ascii_lowercase();
    name.match_indices("irb").any(|(at, word)| {
        let behind = name[at + word.len()..].trim_start_matches([' ', '_', '-']);
        let digits = behind.len() - behind.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        TYPES.contains(&&behind[..digits])
    })
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    #[test]
    fn axis_3_is_told_against_the_base_and_back() {
        let q = [0.1, 1.0, -0.4, 0.2, 0.3, 0.5];
        assert_eq!(Coupling::Coupled.told(&q), [0.1, 1.0, 0.6, 0.2, 0.3, 0.5]);
        let back = Coupling::Coupled.own(&Coupling::Coupled.told(&q));
        assert!(back.iter().zip(&q).all(|(a, b)| (a - b).abs() < 1e-15), "{back:?}");
        for coupling in [Coupling::Serial, Coupling::Unsaid] {
            assert_eq!((coupling.told(&q), coupling.own(&q)), (q, q));
        }
    }

    #[test]
    fn a_type_with_a_rod_is_known_by_its_name_and_a_file_goes_over_it() {
        for name in ["abb_irb2400", "ABB IRB 4400", "irb-6400r", "IRB2400L/16", "abb_irb2400_12_155", "irb_6660"] {
            assert_eq!(Coupling::of(None, name), Coupling::Unsaid, "{name}");
            assert_eq!(Coupling::of(Some(true), name), Coupling::Coupled);
            assert_eq!(Coupling::of(Some(false), name), Coupling::Serial);
        }
        for name in ["IRB 120", "irb1200", "IRB 24000", "irb 6640", "kr2400", "arm", "irb", "IRBü2400"] {
            assert_eq!(Coupling::of(None, name), Coupling::Serial, "{name}");
        }
    }
}
