//! Units of length as maps name them: EPSG codes of units, words, and factors of a projection.

use hairpin::campaign::scenario::MapUnit;

/// A unit of length.
#[derive(Debug, Clone, PartialEq)]
pub struct Unit {
    /// What it is called.
    pub name: String,
    /// One of it, m.
    pub metres: f64,
}

const FOOT: f64 = 0.3048;
const US_SURVEY_FOOT: f64 = 1200.0 / 3937.0;

/// Where a unit is known from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Source {
    /// The file, or what lies beside it.
    File,
    /// A key.
    Given,
    /// Nobody says it: it is taken so.
    Taken,
}

/// Code, name and metres of the EPSG registry's units of length that maps have.
#[rustfmt::skip]
const KNOWN: &[(u16, &str, f64)] = &[
    (9001, "m", 1.0),
    (9002, "ft", FOOT),
    (9003, "US survey ft", US_SURVEY_FOOT),
    (9005, "Clarke's ft", 0.304_797_265_4),
    (9014, "fathom", 1.8288),
    (9030, "nautical mile", 1852.0),
    (9031, "German legal m", 1.000_013_596_5),
    (9036, "km", 1000.0),
    (9041, "Sears' ft", 0.304_799_471_538),
    (9080, "Indian ft", 0.304_799_510_248),
    (9093, "mile", 1609.344),
    (9094, "Gold Coast ft", 0.304_799_710_181),
    (9095, "British ft (1936)", 0.304_800_749_1),
    (9096, "yd", 0.9144),
    (1025, "mm", 0.001),
    (1033, "cm", 0.01),
    (9033, "US survey chain", 79_200.0 / 3937.0),
    (9034, "US survey link", 792.0 / 3937.0),
    (9035, "US survey mile", 6_336_000.0 / 3937.0),
    (9037, "Clarke's yd", 0.914_391_796_2),
    (9038, "Clarke's chain", 20.116_619_516_4),
    (9039, "Clarke's link", 0.201_166_195_164),
    (9040, "Sears' yd", 0.914_398_414_616_029),
    (9042, "Sears' chain", 20.116_765_121_552_632),
    (9043, "Sears' link", 0.201_167_651_215_526),
    (9050, "Benoit's yd (A)", 0.914_399_2),
    (9051, "Benoit's ft (A)", 0.304_799_733_333_333),
    (9052, "Benoit's chain (A)", 20.116_782_4),
    (9053, "Benoit's link (A)", 0.201_167_824),
    (9060, "Benoit's yd (B)", 0.914_399_204_289_812),
    (9061, "Benoit's ft (B)", 0.304_799_734_763_271),
    (9062, "Benoit's chain (B)", 20.116_782_494_375_872),
    (9063, "Benoit's link (B)", 0.201_167_824_943_759),
    (9070, "British ft (1865)", 0.304_800_833_333_333),
    (9081, "Indian ft (1937)", 0.304_798_41),
    (9082, "Indian ft (1962)", 0.304_799_6),
    (9083, "Indian ft (1975)", 0.304_799_5),
    (9084, "Indian yd", 0.914_398_530_744_441),
    (9085, "Indian yd (1937)", 0.914_395_23),
    (9086, "Indian yd (1962)", 0.914_398_8),
    (9087, "Indian yd (1975)", 0.914_398_5),
    (9097, "chain", 20.116_8),
    (9098, "link", 0.201_168),
    (9099, "Sears' yd (truncated)", 0.914_398),
    (9300, "Sears' ft (truncated)", 0.304_799_333_333_333),
    (9301, "Sears' chain (truncated)", 20.116_756),
    (9302, "Sears' link (truncated)", 0.201_167_56),
];

/// Factors that differ by less than this share are of one unit; US survey and international feet differ by 2e-6.
const SAME: f64 = 1e-8;

impl Unit {
    /// The metre.
    pub fn metre() -> Self {
        Self { name: "m".into(), metres: 1.0 }
    }

    /// Whether lengths in it stay as they are.
    pub fn is_metre(&self) -> bool {
        self.metres == 1.0
    }

    /// The word that keys have for it, if they have one.
    pub(crate) fn as_given(&self) -> Option<MapUnit> {
        [MapUnit::M, MapUnit::Ft, MapUnit::UsFt].into_iter().find(|word| Self::from(*word).metres == self.metres)
    }

    /// By its number in the EPSG registry.
    pub(super) fn of_code(code: u16) -> Option<Self> {
        let (_, name, metres) = KNOWN.iter().find(|(known, ..)| *known == code)?;
        Some(Self { name: (*name).into(), metres: *metres })
    }

    /// By its length; `None` for what is none.
    pub(super) fn of_length(metres: f64) -> Option<Self> {
        if !(metres.is_finite() && metres > 0.0) {
            return None;
        }
        let known = KNOWN.iter().find(|(.., known)| (known / metres - 1.0).abs() < SAME);
        Some(match known {
            Some((_, name, metres)) => Self { name: (*name).into(), metres: *metres },
            None => Self { name: format!("unit of {metres} m"), metres },
        })
    }

    /// By a word that writers of rasters have for it.
    pub(super) fn of_word(word: &str) -> Option<Self> {
        let word = word.trim().to_ascii_lowercase().replace(['_', '-'], " ");
        let code = match word.as_str() {
            "m" | "metre" | "metres" | "meter" | "meters" => 9001,
            "ft" | "foot" | "feet" | "international foot" | "international feet" => 9002,
            "us ft" | "ftus" | "us survey foot" | "us survey feet" | "foot us" | "sft" | "usft" => 9003,
            "mm" | "millimetre" | "millimeter" => 1025,
            "cm" | "centimetre" | "centimeter" => 1033,
            "km" | "kilometre" | "kilometer" => 9036,
            "yd" | "yard" => 9096,
            _ => return None,
        };
        Self::of_code(code)
    }
}

impl From<MapUnit> for Unit {
    fn from(given: MapUnit) -> Self {
        let (name, metres) = match given {
            MapUnit::M => ("m", 1.0),
            MapUnit::Ft => ("ft", FOOT),
            MapUnit::UsFt => ("US survey ft", US_SURVEY_FOOT),
        };
        Self { name: name.into(), metres }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_feet_are_told_apart() {
        for (unit, name) in [
            (Unit::of_code(9002), "ft"),
            (Unit::of_code(9003), "US survey ft"),
            (Unit::of_length(0.3048), "ft"),
            (Unit::of_length(0.304_800_609_601_219), "US survey ft"),
            (Unit::of_word("US_survey_foot"), "US survey ft"),
            (Unit::of_word("Foot"), "ft"),
            (Unit::of_word("metre"), "m"),
            (Unit::of_length(0.5), "unit of 0.5 m"),
        ] {
            assert_eq!(unit.unwrap().name, name);
        }
        assert_eq!(Unit::of_word("cubit").or(Unit::of_code(9999)).or(Unit::of_length(-1.0)), None);
        // Over the 300 km of a state's false easting they differ by 60 cm.
        assert!((984_250.0 * (US_SURVEY_FOOT - FOOT) - 0.6).abs() < 1e-3);
    }
}
