//! What a refusal is worth where shapes are not all known.

use super::bodies::TOOL;
use crate::feasibility::reachability::Refusal;
use crate::robot::arm::{Arm, Outline, Tool, body_name};

/// What a refusal rests on.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Worth {
    /// What is known.
    Certain,
    /// A body that is estimated: 0 the base, 1 to 6 a link.
    Estimated(usize),
    /// Two bodies of which neither is known: that they meet is not found out.
    Undecidable([usize; 2]),
}

impl Worth {
    /// Of `refusal` of the arm with the tool.
    ///
    /// A tool without a radius has no shape: beside a link that is estimated nothing is known of the two.
    pub fn of(arm: &Arm, tool: &Tool, refusal: &Refusal) -> Self {
        let known = |body: usize| is_known(arm, tool, body);
        match *refusal {
            Refusal::Collides { link, .. } if link != TOOL && !known(link) => Self::Estimated(link),
            Refusal::SelfCollides { links: [a, b], .. } => match (known(a), known(b)) {
                (true, true) => Self::Certain,
                (false, false) => Self::Undecidable([a, b]),
                // That a line meets what is known is certain.
                (false, true) => Self::Estimated(a),
                (true, false) if b == TOOL => Self::Certain,
                (true, false) => Self::Estimated(b),
            },
            _ => Self::Certain,
        }
    }

    /// `estimated: link 2 is a stand-in`; `None` of what is certain.
    pub fn in_words(&self, arm: &Arm) -> Option<String> {
        let is = |body: usize| match arm.links.get(body).map(|link| link.outline) {
            Some(Outline::Around(more)) => {
                format!("{} is up to {:.0} mm larger than its mesh", body_name(body), (1e3 * more).max(1.0))
            }
            Some(_) => format!("{} is a stand-in", body_name(body)),
            None => format!("{} has no radius", body_name(body)),
        };
        match *self {
            Self::Certain => None,
            Self::Estimated(body) => Some(format!("estimated: {}", is(body))),
            Self::Undecidable([a, b]) => {
                Some(format!("estimated: {}, {}; robot.exclude = [[{a}, {b}]] leaves the pair out", is(a), is(b)))
            }
        }
    }
}

/// Whether a body is where it is said to be: 0 the base, 1 to 6 the links, 7 the tool.
pub fn is_known(arm: &Arm, tool: &Tool, body: usize) -> bool {
    match arm.links.get(body) {
        Some(link) => !link.outline.is_estimated(),
        None => tool.radius > 0.0,
    }
}
