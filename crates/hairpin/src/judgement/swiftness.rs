//! How fast a robot can be and become, and so how far it can have been from what samples of its way show.

/// How fast a robot can be, and become, whichever way it moves; `None`: not known.
///
/// Bounds of the model. The default knows neither, and nothing is bounded then.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Swiftness {
    /// Largest ‖v‖, m/s.
    pub speed: Option<f64>,
    /// Largest ‖dv/dt‖, m/s².
    pub acceleration: Option<f64>,
}

impl Swiftness {
    /// How far (m) from the straight line between two samples, `span` s and `chord` m apart, it can have been.
    ///
    /// With ‖dv/dt‖ ≤ a: a h²/8. With ‖v‖ ≤ v it was within the ellipse around both samples whose points are no longer
    /// a way than v h, so ½ √((v h)² − c²). +∞ where nothing bounds it, and where the two samples are further apart
    /// than the speed explains, so that it was faster than it can be.
    ///
    /// The lesser of both bounds.
    pub fn bulge(&self, span: f64, chord: f64) -> f64 {
        let by_acceleration = self.acceleration.map_or(f64::INFINITY, |a| a * span * span / 8.0);
        by_acceleration.min(self.by_speed(span, chord))
    }

    /// Samples a second between which nothing bulges by as much as `margin` m; `None` where nothing bounds it, or there
    /// is no margin.
    ///
    /// f = min(√(a / 8m), v / 2m): what [`Self::bulge`] is at most, a Δt²/8 and v Δt/2, solved for 1/Δt.
    pub fn rate(&self, margin: f64) -> Option<f64> {
        let by_acceleration = self.acceleration.map_or(f64::INFINITY, |a| (a / (8.0 * margin)).sqrt());
        let by_speed = self.speed.map_or(f64::INFINITY, |v| v / (2.0 * margin));
        let least = by_acceleration.min(by_speed);
        (margin > 0.0 && least.is_finite()).then_some(least)
    }

    /// By the speed alone, m.
    pub(super) fn by_speed(&self, span: f64, chord: f64) -> f64 {
        let farthest = self.speed.map(|speed| speed * span).filter(|way| *way >= chord);
        farthest.map_or(f64::INFINITY, |way| 0.5 * ((way - chord) * (way + chord)).sqrt())
    }
}

#[cfg(feature = "unit-tests")]
mod tests {
    use super::*;

    /// At the rate that is told, nothing bulges by more than the margin.
    #[test]
    fn rates_decide() {
        for (speed, acceleration) in
            [(None, Some(9.0)), (Some(3.0), None), (Some(3.0), Some(9.0)), (Some(0.1), Some(9.0))]
        {
            let swift = Swiftness { speed, acceleration };
            for margin in [1e-3, 0.2, 5.0] {
                let rate = swift.rate(margin).unwrap();
                assert!((swift.bulge(1.0 / rate, 0.0) - margin).abs() < 1e-12, "{swift:?} {margin}");
            }
            assert_eq!(swift.rate(0.0), None);
        }
        assert_eq!(Swiftness::default().rate(1.0), None);
    }
}
