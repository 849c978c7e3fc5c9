//! Which of the eight solutions, and which quadrants: the configuration numbers that controllers keep beside a pose.
//!
//! A pose alone does not say how an arm reaches it. Controllers keep these four numbers beside each target and refuse a
//! move whose end has others: ABB, "Technical reference manual: RAPID Instructions, Functions and Data types",
//! confdata.

use std::f64::consts::FRAC_PI_2;
use std::fmt;

use super::joints::Joints;

/// Which of the eight inverse solutions of an arm with a spherical wrist.
///
/// For signs of +1 the three bits are the signs of f, sin e and sin θ5 in [`super::Opw`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct Branch {
    /// The wrist centre lies behind axis 1.
    pub behind_axis_1: bool,
    /// The wrist centre lies behind the line of the lower arm.
    pub behind_lower_arm: bool,
    /// Axis 5 is negative.
    pub axis_5_negative: bool,
}

impl Branch {
    /// cfx, 0 to 7: 4 for behind axis 1, 2 for behind the lower arm, 1 for a negative axis 5.
    pub fn cfx(self) -> u8 {
        4 * u8::from(self.behind_axis_1) + 2 * u8::from(self.behind_lower_arm) + u8::from(self.axis_5_negative)
    }

    /// The branch of a cfx; only the three lowest bits count.
    pub fn from_cfx(cfx: u8) -> Self {
        Self { behind_axis_1: cfx & 4 != 0, behind_lower_arm: cfx & 2 != 0, axis_5_negative: cfx & 1 != 0 }
    }
}

/// The four numbers of a robtarget: quadrants cf1, cf4, cf6 = ⌊q_k / 90°⌋ of axes 1, 4, 6, and cfx.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub struct Configuration {
    /// Quadrant of axis 1.
    pub cf1: i32,
    /// Quadrant of axis 4.
    pub cf4: i32,
    /// Quadrant of axis 6.
    pub cf6: i32,
    /// Which of the eight solutions.
    pub cfx: u8,
}

/// Angles this little (rad) below a quadrant's border count as on it, so that the rounding of an inverse does not.
const BORDER: f64 = 1e-9;

impl Configuration {
    /// Of the joint angles `q` (rad) in a branch.
    pub fn of(q: &Joints, branch: Branch) -> Self {
        let quadrant = |angle: f64| ((angle + BORDER) / FRAC_PI_2).floor() as i32;
        Self { cf1: quadrant(q[0]), cf4: quadrant(q[3]), cf6: quadrant(q[5]), cfx: branch.cfx() }
    }

    /// The four numbers in the order of a robtarget.
    pub fn numbers(&self) -> [i32; 4] {
        [self.cf1, self.cf4, self.cf6, i32::from(self.cfx)]
    }
}

impl fmt::Display for Configuration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "[{},{},{},{}]", self.cf1, self.cf4, self.cf6, self.cfx)
    }
}
