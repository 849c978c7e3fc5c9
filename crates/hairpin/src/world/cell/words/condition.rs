//! What an inequation says, as a tree.
//!
//! Evaluated over any [`Real`]: doubles give an answer, intervals give yes, no or unknown for a whole box, so that
//! one tree serves fast tests and proofs.

use crate::math::outward::Real;

/// Built by the parser alone, from comparisons of terms.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Condition {
    /// left < right, or ≤ with `or_equal`.
    Less {
        left: Term,
        right: Term,
        or_equal: bool,
    },
    And(Box<Condition>, Box<Condition>),
    Or(Box<Condition>, Box<Condition>),
    Not(Box<Condition>),
}

/// Axes are 0, 1, 2 for x, y, z, in the unit of the text's key. What is no number is for the comparison to decide.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Term {
    Number(f64),
    Axis(usize),
    Negative(Box<Term>),
    Add(Box<Term>, Box<Term>),
    Subtract(Box<Term>, Box<Term>),
    Multiply(Box<Term>, Box<Term>),
    Divide(Box<Term>, Box<Term>),
    Power(Box<Term>, u32),
    Sqrt(Box<Term>),
    Abs(Box<Term>),
    Min(Box<Term>, Box<Term>),
    Max(Box<Term>, Box<Term>),
}

impl Condition {
    /// Kleene's logic of true, false and unknown.
    ///
    /// `less(left − right, or_equal)` decides a comparison; `None`: unknown.
    ///
    /// Both sides of `and` and `or` are always evaluated.
    pub(super) fn at<N: Real>(&self, p: &[N; 3], less: &impl Fn(N, bool) -> Option<bool>) -> Option<bool> {
        match self {
            Self::Less { left, right, or_equal } => less(left.at(p) - right.at(p), *or_equal),
            Self::Not(inner) => inner.at(p, less).map(|truth| !truth),
            Self::And(a, b) => match (a.at(p, less), b.at(p, less)) {
                (Some(false), _) | (_, Some(false)) => Some(false),
                (Some(true), Some(true)) => Some(true),
                _ => None,
            },
            Self::Or(a, b) => match (a.at(p, less), b.at(p, less)) {
                (Some(true), _) | (_, Some(true)) => Some(true),
                (Some(false), Some(false)) => Some(false),
                _ => None,
            },
        }
    }
}

impl Term {
    /// At the point, or over the box, `p`.
    fn at<N: Real>(&self, p: &[N; 3]) -> N {
        match self {
            Self::Number(value) => N::constant(*value),
            Self::Axis(axis) => p[*axis],
            Self::Negative(a) => -a.at(p),
            Self::Add(a, b) => a.at(p) + b.at(p),
            Self::Subtract(a, b) => a.at(p) - b.at(p),
            Self::Multiply(a, b) => a.at(p) * b.at(p),
            Self::Divide(a, b) => a.at(p) / b.at(p),
            Self::Power(a, n) => power(a.at(p), *n),
            Self::Sqrt(a) => a.at(p).sqrt(),
            Self::Abs(a) => a.at(p).abs(),
            Self::Min(a, b) => a.at(p).min(b.at(p)),
            Self::Max(a, b) => a.at(p).max(b.at(p)),
        }
    }
}

/// xⁿ, even powers by squares, so that they are never negative.
fn power<N: Real>(x: N, n: u32) -> N {
    match n {
        0 => N::constant(1.0),
        1 => x,
        n if n.is_multiple_of(2) => power(x, n / 2).square(),
        n => power(x, n - 1) * x,
    }
}
