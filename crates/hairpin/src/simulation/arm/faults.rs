//! What can be made wrong with a virtual arm, to see that the judge finds it.

use nalgebra::Isometry3;

use crate::robot::arm::AXES;
use crate::simulation::SimulationError;

/// One fault. Axes count from 1.
///
/// Each leaves a mark that the oracle must tell apart: lag grows with speed, backlash with reversals, an offset with
/// neither, a delay shifts all later times.
#[derive(Debug, Clone, PartialEq)]
pub enum Fault {
    /// Play of an axis: its link moves only once the drive has crossed it.
    Backlash {
        /// Which axis.
        axis: usize,
        /// Width of the play, rad.
        width: f64,
    },
    /// An axis that turns no faster than this share of its speed limit.
    SlowAxis {
        /// Which axis.
        axis: usize,
        /// 0 … 1.
        share: f64,
    },
    /// The tool's point is elsewhere than the program says: `tcp_from_true_tcp`.
    ToolOffset(Isometry3<f64>),
    /// The arm waits before it sets out for the first time at or after a move (from 0); what is blended into cannot
    /// wait.
    DelayedStart {
        /// The move, from 0.
        order: usize,
        /// How long, s.
        delay: f64,
    },
    /// A servo that lags behind more than the others.
    ExtraLag {
        /// Which axis.
        axis: usize,
        /// Added to the time constant, s.
        lag: f64,
    },
}

impl Fault {
    /// Whether it is one that an arm can have.
    ///
    /// Widths to 1 rad, shares to 1, lags to 10 s, delays to 3600 s, offsets to 10 m.
    ///
    /// # Errors
    /// An axis that is none of 1 … 6, a number out of its bounds.
    pub(super) fn check(&self) -> Result<(), SimulationError> {
        let error = |field, value: String, bound| Err(SimulationError::new(field, value, bound));
        let (axis, number, most) = match self {
            Self::Backlash { axis, width } => (*axis, *width, 1.0),
            Self::SlowAxis { axis, share } => (*axis, *share, 1.0),
            Self::ExtraLag { axis, lag } => (*axis, *lag, 10.0),
            Self::DelayedStart { delay, .. } => (1, *delay, 3600.0),
            Self::ToolOffset(offset) => (1, offset.translation.vector.norm(), 10.0),
        };
        if !(1..=AXES).contains(&axis) {
            return error("fault.axis", axis.to_string(), "1 to 6");
        }
        if matches!(self, Self::SlowAxis { .. }) && number == 0.0 {
            return error("fault.share", number.to_string(), "more than 0: an axis at rest ends no move");
        }
        if (0.0..=most).contains(&number) {
            Ok(())
        } else {
            error("fault", number.to_string(), "at least 0, and no more than an arm can have")
        }
    }
}

/// Play between a drive and its link.
///
/// Hysteresis of a dead band: q ← clamp(q, θ − w/2, θ + w/2).
#[derive(Debug, Clone, Copy)]
pub(super) struct Play {
    half: f64,
    link: f64,
}

impl Play {
    /// In the middle of its width.
    ///
    /// `width` in rad, the whole of it.
    pub(super) fn new(width: f64, angle: f64) -> Self {
        Self { half: 0.5 * width, link: angle }
    }

    /// Where the link is once the drive is at `angle`.
    pub(super) fn follow(&mut self, angle: f64) -> f64 {
        self.link = self.link.clamp(angle - self.half, angle + self.half);
        self.link
    }
}
