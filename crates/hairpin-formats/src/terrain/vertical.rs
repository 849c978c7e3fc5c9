//! Systems of heights of the EPSG registry (v11.022): which run down, and which unit they have.

use super::unit::Unit;

/// What a code of VerticalCS stands for.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Vertical {
    /// Heights.
    Up(Unit),
    /// Depths, which grow downwards.
    Down(Unit),
    /// A datum or an ellipsoid of GeoTIFF 1.0: heights whose unit is said beside it.
    Datum,
    /// Said, and not known here.
    Unknown,
}

/// Depths that a file's values are said to be.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Depth {
    /// By what.
    pub(super) said: String,
    /// One of their unit, m.
    pub(super) metres: f64,
}

/// Codes, first and last, of systems of heights in metres; 4979 has them above the ellipsoid.
#[rustfmt::skip]
const METRES: &[(u16, u16)] = &[
    (3855, 3855), (3886, 3886), (3900, 3900), (4440, 4440), (4458, 4458), (4979, 4979), (5193, 5193), (5195, 5195),
    (5214, 5214), (5237, 5237), (5317, 5317), (5597, 5597), (5600, 5611), (5613, 5613), (5615, 5621), (5701, 5701),
    (5703, 5705), (5709, 5714), (5716, 5733), (5735, 5738), (5740, 5753), (5755, 5788), (5790, 5799), (5829, 5829),
    (5843, 5843), (5868, 5872), (5874, 5874), (5941, 5941), (6178, 6187), (6638, 6644), (6647, 6647), (6693, 6695),
    (6916, 6916), (7446, 7447), (7651, 7652), (7699, 7700), (7707, 7707), (7832, 7832), (7837, 7837), (7839, 7839),
    (7841, 7841), (7888, 7890), (7962, 7962), (7968, 7968), (7979, 7979), (8089, 8089), (8266, 8267), (8357, 8357),
    (8434, 8434), (8675, 8675), (8690, 8691), (8841, 8841), (8881, 8881), (8904, 8904), (8911, 8911), (9130, 9130),
    (9245, 9245), (9255, 9255), (9274, 9274), (9279, 9279), (9303, 9303), (9335, 9335), (9351, 9351), (9389, 9390),
    (9392, 9402), (9451, 9451), (9458, 9458), (9471, 9471), (9650, 9651), (9663, 9663), (9666, 9666), (9669, 9669),
    (9675, 9675), (9681, 9681), (9721, 9722), (9923, 9923), (9927, 9927), (10190, 10190), (10352, 10354),
    (10482, 10485), (10565, 10565), (10588, 10588), (20000, 20000), (20034, 20036),
];

/// Codes of systems of heights in another unit, and the code of that.
const OTHERS: &[(u16, u16)] = &[
    (5702, 9003),
    (5754, 9095),
    (6130, 9002),
    (6131, 9002),
    (6132, 9002),
    (6360, 9003),
    (8050, 9002),
    (8052, 9003),
    (8228, 9002),
];

/// Codes, first and last, of systems of depths.
#[rustfmt::skip]
const DEPTHS: &[(u16, u16)] = &[
    (5336, 5336), (5612, 5612), (5614, 5614), (5706, 5706), (5715, 5715), (5734, 5734), (5739, 5739), (5789, 5789),
    (5831, 5831), (5861, 5867), (5873, 5873), (6357, 6359), (7976, 7976), (8051, 8051), (8053, 8053), (8358, 8358),
    (8378, 8378), (8897, 8897), (9287, 9288), (9672, 9672), (10150, 10151), (10349, 10349), (10364, 10364),
    (10370, 10379), (10547, 10552), (10649, 10650), (10678, 10678),
];

/// Of them those that are not in metres.
const OTHER_DEPTHS: &[(u16, u16)] =
    &[(5614, 9002), (6358, 9003), (6359, 9003), (8051, 9002), (8053, 9003), (8897, 9002)];

/// What `code` stands for.
pub(super) fn system(code: u16) -> Vertical {
    let within = |ranges: &[(u16, u16)]| ranges.iter().any(|(first, last)| (*first..=*last).contains(&code));
    let other =
        |units: &[(u16, u16)]| units.iter().find(|(of, _)| *of == code).and_then(|(_, unit)| Unit::of_code(*unit));
    if within(DEPTHS) {
        Vertical::Down(other(OTHER_DEPTHS).unwrap_or_else(Unit::metre))
    } else if let Some(unit) = other(OTHERS) {
        Vertical::Up(unit)
    } else if within(METRES) {
        Vertical::Up(Unit::metre())
    } else if (5001..=5199).contains(&code) {
        Vertical::Datum
    } else {
        Vertical::Unknown
    }
}

/// Whether a system of this name has depths.
pub(super) fn is_depth(name: &str) -> bool {
    name.to_ascii_lowercase().contains("depth")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn heights_and_depths_have_the_registrys_units() {
        let told = |code| match system(code) {
            Vertical::Up(unit) => format!("up {}", unit.name),
            Vertical::Down(unit) => format!("down {}", unit.name),
            other => format!("{other:?}"),
        };
        for (code, words) in [
            (5701, "up m"),
            (5703, "up m"),
            (3855, "up m"),
            (7837, "up m"),
            (7968, "up m"),
            (8357, "up m"),
            (5615, "up m"),
            (5702, "up US survey ft"),
            (6360, "up US survey ft"),
            (8052, "up US survey ft"),
            (8228, "up ft"),
            (8050, "up ft"),
            (5754, "up British ft (1936)"),
            (5715, "down m"),
            (6357, "down m"),
            (5614, "down ft"),
            (6358, "down US survey ft"),
            (6359, "down US survey ft"),
            (5103, "Datum"),
            (5700, "Unknown"),
            (9999, "Unknown"),
        ] {
            assert_eq!(told(code), words, "{code}");
        }
    }
}
