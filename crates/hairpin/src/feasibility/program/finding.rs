//! What an arm cannot do of a program, and the sentence that says so.

use std::fmt;

use crate::robot::arm::{Margin, Singularity};

/// Why a move cannot be executed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Fault {
    /// No joint angles reach the pose.
    OutOfReach {
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
    /// Start, point on the way and end give no arc.
    NoArc,
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
}

impl Fault {
    /// Its name, for machines.
    pub fn kind(&self) -> &'static str {
        match self {
            Self::OutOfReach { .. } => "reach",
            Self::JointLimit { .. } => "limit",
            Self::Singular { .. } => "singularity",
            Self::NoArc => "arc",
            Self::NoSuchConfiguration { .. } | Self::ArrivesOtherwise { .. } => "configuration",
        }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let percent = |at: f64| format!("at {:.0} % of the move", 100.0 * at);
        let list = |[a, b, c, d]: [i32; 4]| format!("[{a},{b},{c},{d}]");
        match *self {
            Self::OutOfReach { at } => write!(f, "out of reach {}", percent(at)),
            Self::JointLimit { axis, angle, bound, at } => {
                let (sign, angle, bound) =
                    (if angle > bound { '>' } else { '<' }, angle.to_degrees(), bound.to_degrees());
                write!(f, "axis {} at {angle:.1}° {sign} {bound:.1}° {}", axis + 1, percent(at))
            }
            Self::Singular { margin, least, at } => {
                let measure = match margin.of {
                    Singularity::Wrist => "|sin axis 5|",
                    Singularity::Elbow => "|sin elbow|",
                    Singularity::Shoulder => "distance from axis 1 over length",
                    Singularity::Chain => "1/‖J⁻¹‖",
                };
                write!(f, "{} singularity: {measure} = {:.3} < {least:.3} {}", margin.of, margin.value, percent(at))
            }
            Self::NoArc => f.write_str("start, point on the way and end give no arc"),
            Self::NoSuchConfiguration { demanded } => {
                write!(f, "no posture within the limits has the configuration {}", list(demanded))
            }
            Self::ArrivesOtherwise { demanded, arrives } => {
                write!(f, "arrives in the configuration {}, the target demands {}", list(arrives), list(demanded))
            }
        }
    }
}

/// Another configuration in which the move fits.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Fit {
    /// At the move's end.
    pub configuration: [i32; 4],
    /// Least distance of any axis from its bounds, rad.
    pub margin: f64,
}

/// A move that the arm cannot execute.
#[derive(Debug, Clone, PartialEq)]
pub struct Finding {
    /// Index of the move.
    pub index: usize,
    /// Line of the file, from 1.
    pub line: Option<usize>,
    /// Name of where the move begins.
    pub from: Option<String>,
    /// Name of its end.
    pub to: Option<String>,
    /// Why.
    pub fault: Fault,
    /// The configuration that was tried.
    pub tried: Option<[i32; 4]>,
    /// A configuration that would do.
    pub fit: Option<Fit>,
}

impl Finding {
    /// The reason and what would help, without line and names.
    pub fn reason(&self) -> String {
        let Some(fit) = self.fit else { return self.fault.to_string() };
        let names = ["cf1", "cf4", "cf6", "cfx"];
        let other = |index: &usize| self.tried.is_none_or(|tried| tried[*index] != fit.configuration[*index]);
        let change = |index: usize| format!("{} = {}", names[index], fit.configuration[index]).replace('-', "−");
        let changes: Vec<_> = (0..4).filter(other).map(change).collect();
        let with = if changes.is_empty() {
            "on another turn of an axis".into()
        } else {
            format!("with {}", changes.join(", "))
        };
        format!("{}; {with} it fits by {:.1}°", self.fault, fit.margin.to_degrees())
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if let Some(line) = self.line {
            write!(f, "line {line}: ")?;
        }
        let named = |name: &Option<String>, nameless: &str| name.clone().unwrap_or_else(|| nameless.into());
        let (from, to) = (named(&self.from, "(before)"), named(&self.to, "(in place)"));
        write!(f, "UNREACHABLE {from}→{to}: {}", self.reason())
    }
}
