//! Why a move is refused, with its numbers, and the sentence that says so.

use std::fmt;

use nalgebra::Isometry3;

use super::joint::CircleError;
use crate::math::decimals::that_differ;
use crate::robot::arm::{Arm, Margin, Singularity, body_name};

/// Why a move between two points is not possible.
///
/// Shares are of the move, 0 at its start; angles in rad; axes from 0 inside, from 1 in sentences.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Refusal {
    /// The tool's sphere meets a part of the cell, or could not be proven not to.
    ToolMeets {
        /// Index of the part.
        part: usize,
        /// Neither clear nor a hit could be proven.
        undecided: bool,
    },
    /// An end of a straight move is farther off than the arm with its tool is long.
    BeyondReach {
        /// It was not proven to be, nor to be nearer.
        undecided: bool,
    },
    /// No joint angles reach the pose.
    OutOfReach {
        /// Share of the move.
        at: f64,
    },
    /// Of an arm without a closed inverse no posture within the bounds was found, which is no proof that it has none.
    NotFound {
        /// Share of the move.
        at: f64,
    },
    /// A joint would leave its bounds.
    JointLimit {
        /// From 0.
        axis: usize,
        /// Angle there, rad.
        angle: f64,
        /// The bound that it is beyond, rad.
        bound: f64,
        /// Share of the move.
        at: f64,
    },
    /// The arm would come too near to a singularity.
    Singular {
        /// Which, and how near.
        margin: Margin,
        /// What is asked for.
        least: f64,
        /// Share of the move.
        at: f64,
    },
    /// A link meets a part of the cell, or could not be proven not to.
    Collides {
        /// 0 the base, 1 to 6 the links, 7 the tool.
        link: usize,
        /// Index of the part.
        part: usize,
        /// Share of the move.
        at: f64,
        /// Neither clear nor a hit could be proven.
        undecided: bool,
    },
    /// Two links meet.
    SelfCollides {
        /// The links, the one nearer to the base first.
        links: [usize; 2],
        /// Share of the move.
        at: f64,
        /// Neither clear nor a hit could be proven.
        undecided: bool,
    },
    /// The move arrives on another turn of an axis, or in another branch, than the end point's.
    Configuration {
        /// From 0.
        axis: usize,
        /// Angle at which the move arrives, rad.
        arrives: f64,
        /// Angle of the end point, rad.
        wanted: f64,
    },
    /// The point can be met, but not in the branch in which most others can.
    OtherBranch {
        /// The branch of the others.
        cfx: u8,
    },
    /// Start, point on the way and end give no arc.
    NoArc(CircleError),
    /// The points of an arc have different orientations: what a controller does with that of the point on the way is
    /// its own affair.
    Turned {
        /// The larger angle between the start's orientation and another's, rad.
        turn: f64,
    },
    /// No posture within the limits has the configuration that the target demands.
    NoSuchConfiguration {
        /// \[cf1, cf4, cf6, cfx\] of the target.
        demanded: [i32; 4],
    },
    /// A straight or circular move arrives in another configuration than the target demands.
    ArrivesOtherwise {
        /// \[cf1, cf4, cf6, cfx\] of the target.
        demanded: [i32; 4],
        /// The one in which it arrives.
        arrives: [i32; 4],
    },
    /// The target demands a configuration of an arm of which it is not known what that means.
    UnknownConfiguration {
        /// \[cf1, cf4, cf6, cfx\] of the target.
        demanded: [i32; 4],
    },
    /// In the time that the move is to take an axis would have to be faster than it can.
    TooQuick {
        /// From 0.
        axis: usize,
        /// How far it turns, rad.
        turn: f64,
        /// What the move is to take, s.
        seconds: f64,
        /// The axis' largest speed, rad/s.
        speed: f64,
    },
}

impl Refusal {
    /// Whether it proves nothing: a posture, a configuration or a distance to singularities that was not found out.
    pub fn is_open(&self) -> bool {
        match self {
            Self::UnknownConfiguration { .. } | Self::NotFound { .. } => true,
            Self::Singular { margin, least, .. } => margin.value >= *least,
            _ => false,
        }
    }

    /// Where no posture within the bounds puts the flange at `flange` (`base_from_flange`), as far as was looked: of an
    /// arm without a closed inverse that is proven of what is farther off than its lengths add up to, and of nothing
    /// else.
    pub(in crate::feasibility) fn unmet(arm: &Arm, flange: &Isometry3<f64>, at: f64) -> Self {
        if arm.has_closed_inverse() || arm.chain.is_beyond(&flange.translation.vector.into()) {
            Self::OutOfReach { at }
        } else {
            Self::NotFound { at }
        }
    }

    /// The same at another share of the move.
    pub(super) fn shifted(mut self, share: f64) -> Self {
        match &mut self {
            Self::OutOfReach { at }
            | Self::NotFound { at }
            | Self::JointLimit { at, .. }
            | Self::Singular { at, .. }
            | Self::Collides { at, .. }
            | Self::SelfCollides { at, .. } => *at = share,
            Self::ToolMeets { .. }
            | Self::BeyondReach { .. }
            | Self::Configuration { .. }
            | Self::OtherBranch { .. }
            | Self::NoArc(_)
            | Self::Turned { .. }
            | Self::NoSuchConfiguration { .. }
            | Self::ArrivesOtherwise { .. }
            | Self::UnknownConfiguration { .. }
            | Self::TooQuick { .. } => {}
        }
        self
    }

    /// Its name, for machines.
    ///
    /// `collision`, `reach`, `limit`, `singularity`, `arc`, `configuration` or `duration`.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::ToolMeets { .. } | Self::Collides { .. } | Self::SelfCollides { .. } => "collision",
            Self::BeyondReach { .. } | Self::OutOfReach { .. } | Self::NotFound { .. } => "reach",
            Self::JointLimit { .. } => "limit",
            Self::Singular { .. } => "singularity",
            Self::NoArc(_) | Self::Turned { .. } => "arc",
            Self::Configuration { .. }
            | Self::OtherBranch { .. }
            | Self::NoSuchConfiguration { .. }
            | Self::ArrivesOtherwise { .. }
            | Self::UnknownConfiguration { .. } => "configuration",
            Self::TooQuick { .. } => "duration",
        }
    }

    /// Of two reasons against a point the one that came farther: reach, limits, then everything else.
    ///
    /// Two joint limits are compared by how far the angle is beyond, rad; of equals the first stays.
    pub(super) fn or_nearer(self, other: Self) -> Self {
        let rank = |refusal: &Self| match refusal {
            Self::OutOfReach { .. } | Self::NotFound { .. } => 0,
            Self::JointLimit { .. } => 1,
            _ => 2,
        };
        let least = |refusal: &Self| match refusal {
            Self::JointLimit { angle, bound, .. } => (angle - bound).abs(),
            _ => 0.0,
        };
        let nearer = rank(&other) > rank(&self) || (rank(&other) == rank(&self) && least(&other) < least(&self));
        if nearer { other } else { self }
    }

    /// The sentence, with the names of the parts of the cell.
    ///
    /// `parts` in the cell's order; one that is missing is `?`.
    pub fn in_words<'r>(&'r self, parts: &'r [String]) -> InWords<'r> {
        InWords { refusal: self, parts }
    }
}

/// A refusal in words.
pub struct InWords<'r> {
    refusal: &'r Refusal,
    parts: &'r [String],
}

/// Two angles with as many decimals as tell them apart, 1 to 9.
fn degrees(a: f64, b: f64) -> [String; 2] {
    let [a, b] = [a, b].map(f64::to_degrees);
    let decimals = that_differ(a, b, 1..=9);
    [a, b].map(|angle| format!("{angle:.decimals$}°"))
}

impl fmt::Display for InWords<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let part = |index: usize| self.parts.get(index).map_or("?", String::as_str);
        let percent = |at: f64| format!("at {:.0} % of the move", 100.0 * at);
        let (meets, meet) = ("meets", "meet");
        let not_proven = "is not proven clear of";
        let list = |[a, b, c, d]: [i32; 4]| format!("[{a},{b},{c},{d}]");
        match *self.refusal {
            Refusal::ToolMeets { part: index, undecided } => {
                write!(f, "the tool's sphere {} {}", if undecided { not_proven } else { meets }, part(index))
            }
            Refusal::BeyondReach { undecided: false } => {
                f.write_str("out of reach: the tool's sphere leaves the ball that the arm with its tool can come to")
            }
            Refusal::BeyondReach { undecided: true } => {
                f.write_str("the tool's sphere is not proven within the ball that the arm with its tool can come to")
            }
            Refusal::OutOfReach { at } => write!(f, "out of reach {}", percent(at)),
            Refusal::NotFound { at } => {
                write!(f, "no posture within the limits found (no proof that there is none) {}", percent(at))
            }
            Refusal::JointLimit { axis, angle, bound, at } => {
                let sign = if angle > bound { '>' } else { '<' };
                let (axis, [angle, bound]) = (axis + 1, degrees(angle, bound));
                write!(f, "axis {axis} at {angle} {sign} {bound} {}", percent(at))
            }
            Refusal::Singular { margin, least, at } => {
                let measure = match margin.of {
                    Singularity::Wrist => "|sin axis 5|",
                    Singularity::Elbow => "|sin elbow|",
                    Singularity::Shoulder => "distance from axis 1 over length",
                    Singularity::Chain => "1/‖J⁻¹‖",
                };
                let (of, value, at) = (margin.of, margin.value, percent(at));
                if value >= least {
                    return write!(f, "{of} singularity not excluded near {measure} {value:.3} {at}");
                }
                let decimals = that_differ(value, least, 3..=9);
                write!(f, "{of} singularity: {measure} {value:.decimals$} < {least:.decimals$} {at}")
            }
            Refusal::TooQuick { axis, turn, seconds, speed } => {
                let [turn, mean, speed] = [turn, turn / seconds, speed].map(f64::to_degrees);
                write!(
                    f,
                    "in the {seconds} s that it is to take axis {} turns by {turn:.1}°, {mean:.0}°/s: its largest speed is \
                     {speed:.0}°/s",
                    axis + 1
                )
            }
            Refusal::Collides { link, part: index, at, undecided } => {
                let verb = if undecided { not_proven } else { meets };
                write!(f, "{} {verb} {} {}", body_name(link), part(index), percent(at))
            }
            Refusal::SelfCollides { links: [a, b], at, undecided } => {
                let verb = if undecided { "are not proven apart" } else { meet };
                write!(f, "{} and {} {verb} {}", body_name(a), body_name(b), percent(at))
            }
            Refusal::Configuration { axis, arrives, wanted } => {
                let [arrives, wanted] = degrees(arrives, wanted);
                write!(f, "configuration change: axis {} arrives at {arrives}, not {wanted}", axis + 1)
            }
            Refusal::OtherBranch { cfx } => write!(f, "reached in other configurations than cfx {cfx} only"),
            Refusal::NoArc(why) => write!(f, "no arc: {why}"),
            Refusal::Turned { turn } => {
                write!(f, "no arc: the orientations of its points are {:.4}° apart", turn.to_degrees())
            }
            Refusal::NoSuchConfiguration { demanded } => {
                write!(f, "no posture within the limits has the configuration {}", list(demanded))
            }
            Refusal::ArrivesOtherwise { demanded, arrives } => {
                write!(f, "arrives in the configuration {}, the target demands {}", list(arrives), list(demanded))
            }
            Refusal::UnknownConfiguration { demanded } => write!(
                f,
                "the configuration {} is demanded, and which posture that is of an arm without `opw` is not known; \
                 here and from here on the nearest is taken",
                list(demanded)
            ),
        }
    }
}
