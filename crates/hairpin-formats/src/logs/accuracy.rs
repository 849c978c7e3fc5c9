//! How well a source says that it knows its place.

/// Who claims to know it no better than this knows nothing, m.
const NOWHERE_M: f64 = 1e7;

/// A standard deviation that is told, m: what is no number and what is below 0 says nothing, and endless is much.
pub(super) fn known(deviation: f64) -> Option<f64> {
    (deviation >= 0.0).then(|| deviation.min(NOWHERE_M))
}

/// Horizontal and vertical standard deviation of what is told of both, and whether it was told of one alone, which then
/// counts for both: nothing else is known of the other.
pub(super) fn both(told: [Option<f64>; 2]) -> (Option<[f64; 2]>, bool) {
    match told {
        [Some(across), Some(up)] => (Some([across, up]), false),
        [Some(one), None] | [None, Some(one)] => (Some([one; 2]), true),
        [None, None] => (None, false),
    }
}

/// What is to be told of `count` samples of which only one is told.
pub(super) fn half(name: &str, count: usize) -> Option<String> {
    let what = "tell their accuracy across or up alone, which counts for both";
    (count > 0).then(|| format!("{name}: {count} samples {what}"))
}
