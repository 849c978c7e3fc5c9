//! What no robot of the scenario's kind does, as it was found in a motion: it stands with what was measured of a run,
//! whose rows may be left out later.

use crate::math::decimals::that_differ;

/// What was found in all rows of the run of a program of the user's.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Implausible {
    /// What is faster than its kind can be.
    pub speed: Option<Impossible>,
    /// Where it is beyond the tilt that its robot's file bounds or, where that bounds none, has its up axis down.
    pub attitude: Option<Overturned>,
}

/// A mean speed that is beyond any of the robot's.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Impossible {
    /// From when on, s.
    pub from_s: f64,
    /// In how long, s; > 0.
    pub over_s: f64,
    /// How far it came, m.
    pub way_m: f64,
    /// The most that is possible in that time, m/s; > 0.
    pub bound_m_s: f64,
}

impl Impossible {
    /// The mean speed, m/s.
    pub fn speed(&self) -> f64 {
        self.way_m / self.over_s
    }

    /// `31.02 m in 0.0157 s from t = 0.00 s on are 1975.8 m/s, and ten times what its file allows is 70.1 m/s: …`.
    pub fn in_words(&self) -> String {
        let Self { from_s, over_s, way_m, bound_m_s } = self;
        let decimals = that_differ(self.speed(), *bound_m_s, 1..=6);
        format!(
            "{way_m:.2} m in {over_s:.4} s from t = {from_s:.2} s on are {:.decimals$} m/s, and ten times what its file \
             allows is {bound_m_s:.decimals$} m/s: its times or its places are not this robot's",
            self.speed()
        )
    }
}

/// A motion that is told with attitudes that are not its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Overturned {
    /// From when on, s.
    pub at_s: f64,
    /// Angle of its up axis from the vertical there, rad.
    pub tilt_rad: f64,
    /// Whether it is so all the way.
    pub throughout: bool,
}

impl Overturned {
    /// `attitude: upside down (its up axis 180° from the vertical from t = 0.00 s on): …`.
    pub fn in_words(&self) -> String {
        let Self { at_s, tilt_rad, .. } = self;
        let what = if *tilt_rad > std::f64::consts::FRAC_PI_2 { "upside down" } else { "fallen over" };
        format!(
            "attitude: {what} (its up axis {:.0}° from the vertical from t = {at_s:.2} s on): quaternions whose scalar stands \
             first where it is read last, or of a body whose z axis points down, are read so",
            tilt_rad.to_degrees()
        )
    }
}
