//! A joint's servo: a lag of first order behind its set points, no faster than the joint may turn.

/// A servo with its time constant.
#[derive(Debug, Clone, Copy)]
pub(super) struct Servo {
    /// τ, s; 0 follows at once.
    lag: f64,
    /// exp(−h/τ) of the step h that it was made for.
    decay: f64,
    /// h.
    step: f64,
    /// Largest |q̇|, rad/s.
    speed: f64,
    /// Where the joint is, rad.
    angle: f64,
}

impl Servo {
    /// At rest at `angle` (rad); `lag` and `step` in s, `speed` in rad/s.
    pub(super) fn new(lag: f64, step: f64, speed: f64, angle: f64) -> Self {
        let decay = if lag > 0.0 { libm::exp(-step / lag) } else { 0.0 };
        Self { lag, decay, step, speed, angle }
    }

    /// Where the joint is, rad.
    pub(super) fn at(&self) -> f64 {
        self.angle
    }

    /// One step, as the set point goes from `from` to `to` at a constant rate ρ. The error e = r − q obeys ė = ρ − e/τ,
    /// so e(h) = ρτ + (e(0) − ρτ) exp(−h/τ), exactly. A joint that would have to turn faster than it may turns as fast
    /// as it may.
    ///
    /// Exact for any step while the rate is not clipped; one that is clipped turns `speed` · step in it and goes on
    /// from there. Angles in rad; NaN stays NaN.
    pub(super) fn follow(&mut self, from: f64, to: f64) -> f64 {
        let steady = (to - from) / self.step * self.lag;
        let error = steady + (from - self.angle - steady) * self.decay;
        let most = self.speed * self.step;
        self.angle += (to - error - self.angle).clamp(-most, most);
        self.angle
    }
}
