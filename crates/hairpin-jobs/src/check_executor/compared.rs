//! How far two flights of the same mission are from each other.

use hairpin::trajectory::{Flight, Track};

/// Two flights of the same mission.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Difference {
    /// Whether they are the same to the bit.
    pub same: bool,
    /// Poses of the first and of the second.
    pub poses: [usize; 2],
    /// The largest distance of two poses of the same number, m.
    pub position_m: f64,
    /// The first one's time there, s.
    pub at_s: f64,
    /// The largest difference of their times, s.
    pub time_s: f64,
}

impl Difference {
    /// Of `b` from `a`.
    pub(super) fn between(a: &Flight, b: &Flight) -> Self {
        let pairs =
            || (0..a.track.len().min(b.track.len())).map(|i| (i, (a.track.position(i) - b.track.position(i)).norm()));
        let farthest = pairs().fold((0, 0.0), |far, one| if one.1 > far.1 { one } else { far });
        let (times, others) = (a.track.times(), b.track.times());
        Self {
            same: a.ended == b.ended && bits(&a.track) == bits(&b.track),
            poses: [a.track.len(), b.track.len()],
            position_m: farthest.1,
            at_s: times.get(farthest.0).copied().unwrap_or_default(),
            time_s: times.iter().zip(others).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max),
        }
    }

    /// In a sentence's part.
    pub(super) fn in_words(&self) -> String {
        let [a, b] = self.poses;
        let count = if a == b { String::new() } else { format!("{b} poses after {a}, ") };
        if self.same {
            "the same to the bit".into()
        } else if self.position_m == 0.0 && a == b {
            format!("places are the same, times differ by up to {:.3} s, or attitudes or velocities do", self.time_s)
        } else {
            format!("{count}up to {:.3} m apart (t = {:.2} s)", self.position_m, self.at_s)
        }
    }
}

/// Every number of a track.
fn bits(track: &Track) -> Vec<u64> {
    let poses = track.poses().iter().flat_map(|pose| {
        let (place, turn) = (pose.translation.vector, pose.rotation.coords);
        [place.x, place.y, place.z, turn.x, turn.y, turn.z, turn.w]
    });
    let columns = track.channels().iter().flat_map(|channel| channel.values.iter().copied());
    track.times().iter().copied().chain(poses).chain(columns).map(f64::to_bits).collect()
}
