//! How far along a drive its controls are: by metres, by seconds under a speed profile, or by a polynomial of speed.
//!
//! ```text
//! metres        σ = u
//! seconds       σ(u) = s(u T)/L        s the place that the speed profile has come to
//! polynomial    σ(u) = ∫₀ᵘ v / ∫₀¹ v,  v = c₀ + c₁u + c₂u²
//! ```
//!
//! Only the shape of the speed matters to curvature: length and duration cancel, but for trapezoids, whose shape is
//! another one for every length.

use crate::trajectory::speed::Speeds;

/// What the argument u ∈ [0, 1] of controls measures, and σ(u), the share of the metres that is driven by then.
///
/// σ rises from 0 to 1; dσ/du ≥ 0 and is 0 only where the vehicle stands.
#[derive(Debug, Clone, Copy)]
pub(super) enum Clock {
    /// Share of the metres: σ = u.
    Metres,
    /// Share of the seconds.
    Seconds {
        /// Over the whole drive.
        speeds: Speeds,
        /// m.
        length: f64,
        /// s.
        duration: f64,
    },
    /// Share of the seconds, where the speed is c₀ + c₁u + c₂u² up to a factor.
    Polynomial([f64; 3]),
}

impl Clock {
    /// Seconds of `speeds`, which move.
    ///
    /// Length and duration are those of the profile.
    pub(super) fn seconds(speeds: Speeds) -> Self {
        Self::Seconds { speeds, length: speeds.length(), duration: speeds.duration() }
    }

    /// The quadratic speed from `start` to `end` with `middle` half the way between, in time.
    ///
    /// v(0) = start, v(½) = middle, v(1) = end.
    pub(super) fn through(start: f64, middle: f64, end: f64) -> Self {
        Self::Polynomial([start, 4.0 * middle - 3.0 * start - end, 2.0 * (start + end) - 4.0 * middle])
    }

    /// σ(u).
    pub(super) fn share(&self, u: f64) -> f64 {
        match self {
            Self::Metres => u,
            Self::Seconds { speeds, length, duration } => speeds.place_at(u * duration) / length,
            Self::Polynomial([a, b, c]) => u * (a + u * (b / 2.0 + u * c / 3.0)) / (a + b / 2.0 + c / 3.0),
        }
    }

    /// dσ/du.
    ///
    /// 1 of metres; speed over mean speed of the others.
    pub(super) fn pace(&self, u: f64) -> f64 {
        match self {
            Self::Metres => 1.0,
            Self::Seconds { speeds, length, duration } => {
                speeds.speed_at(speeds.place_at(u * duration)) * duration / length
            }
            Self::Polynomial([a, b, c]) => (a + u * (b + u * c)) / (a + b / 2.0 + c / 3.0),
        }
    }

    /// u(σ), the inverse of [`Clock::share`].
    ///
    /// Of polynomials by Newton's steps within a bracket, to the last digits.
    ///
    /// `share` in 0 … 1. Monotone, so that the bracket holds throughout; where the pace is 0 (at rest) the step is a
    /// bisection.
    pub(super) fn at_share(&self, share: f64) -> f64 {
        match self {
            Self::Metres => share,
            Self::Seconds { speeds, length, duration } => {
                if share >= 1.0 {
                    1.0
                } else {
                    speeds.time_at(share * length) / duration
                }
            }
            Self::Polynomial(_) => {
                let (mut low, mut high) = (0.0, 1.0);
                let mut u: f64 = share;
                for _ in 0..60 {
                    let over = self.share(u) - share;
                    if over > 0.0 {
                        high = u
                    } else {
                        low = u
                    }
                    let newton = u - over / self.pace(u).max(1e-12);
                    let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
                    if (next - u).abs() < 1e-16 {
                        break;
                    }
                    u = next;
                }
                u
            }
        }
    }

    /// Where σ(u) is not smooth.
    ///
    /// Of a speed profile its changes of acceleration, as shares of the time; 0 where there is none, which callers
    /// leave out.
    pub(super) fn kinks(&self) -> [f64; 2] {
        match self {
            Self::Seconds { speeds, duration, .. } => speeds.changes().map(|time| time / duration),
            Self::Metres | Self::Polynomial(_) => [0.0; 2],
        }
    }

    /// Whether the vehicle stands at the drive's beginning and at its end, as far as the controls' argument knows.
    ///
    /// A pace below 10⁻⁹ of the mean counts as standing.
    pub(super) fn rests(&self) -> [bool; 2] {
        [self.pace(0.0) <= 1e-9, self.pace(1.0) <= 1e-9]
    }
}
