//! Executions dealt to rounds and graphs, as evenly as whole numbers allow.
//!
//! Sums are exact: places 0 … parts − 1 get `total` together, each ⌊total/parts⌋ or one more, and the ones are
//! spread.

/// What place `place` of `parts` gets of `total`.
///
/// ⌊total (place + 1) / parts⌋ − ⌊total place / parts⌋.
pub(super) fn dealt(total: u64, parts: u64, place: u64) -> u64 {
    until(total, parts, place + 1) - until(total, parts, place)
}

/// How many of what place `place` gets are every second of all.
pub(super) fn every_second(total: u64, parts: u64, place: u64) -> u64 {
    until(total, parts, place + 1) / 2 - until(total, parts, place) / 2
}

/// What the places before `place` get together.
fn until(total: u64, parts: u64, place: u64) -> u64 {
    (u128::from(total) * u128::from(place) / u128::from(parts)) as u64
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::{dealt, every_second};

    #[test]
    fn all_is_dealt_and_evenly() {
        for (total, parts) in [(0, 3), (7, 3), (400, 4), (5, 8), (u64::MAX, 7)] {
            let shares: Vec<u64> = (0..parts).map(|place| dealt(total, parts, place)).collect();
            assert_eq!(shares.iter().map(|share| u128::from(*share)).sum::<u128>(), u128::from(total));
            let (least, most) = (shares.iter().min().unwrap(), shares.iter().max().unwrap());
            assert!(most - least <= 1, "{shares:?}");
            let halves: Vec<u64> = (0..parts).map(|place| every_second(total, parts, place)).collect();
            assert_eq!(halves.iter().map(|half| u128::from(*half)).sum::<u128>(), u128::from(total / 2));
            assert!(halves.iter().zip(&shares).all(|(half, share)| half <= share), "{halves:?}");
        }
    }
}
