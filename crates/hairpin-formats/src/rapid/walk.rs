//! What lies in what: the one walk over statements and values, for whoever looks without executing.

use super::syntax::{Argument, Expression, Path, Statement, Step, What};

impl Expression {
    /// The values that it is made of, from left to right: elements, operands, what a function is given, indices.
    pub(super) fn parts(&self) -> Vec<&Expression> {
        match self {
            Self::Number(_) | Self::Bool(_) | Self::Text(_) => Vec::new(),
            Self::Aggregate(parts) => parts.iter().collect(),
            Self::Path(path) => path.indices().collect(),
            Self::Call { arguments, .. } => arguments.iter().filter_map(Argument::value).collect(),
            Self::Unary { of, .. } => vec![&**of],
            Self::Chain { first, rest } => {
                std::iter::once(&**first).chain(rest.iter().map(|(_, operand)| operand)).collect()
            }
        }
    }
}

impl Path {
    /// Its indices, from left to right.
    pub(super) fn indices(&self) -> impl Iterator<Item = &Expression> {
        self.steps.iter().flat_map(|step| match step {
            Step::Element(indices) => indices.as_slice(),
            Step::Component(_) => &[],
        })
    }
}

impl Argument {
    /// What is handed over; `None` of a switch.
    pub(super) fn value(&self) -> Option<&Expression> {
        match self {
            Self::Placed(value) | Self::IfGiven { parameter: value, .. } => Some(value),
            Self::Named { value, .. } => value.as_ref(),
        }
    }
}

impl Statement {
    /// The values that it computes itself, but for what a call hands over: what is assigned, conditions, bounds.
    pub(super) fn values(&self) -> Vec<&Expression> {
        match &self.what {
            What::Assign { value, .. } => vec![value],
            What::LateCall { name, .. } => vec![name],
            What::If { branches, .. } => branches.iter().map(|(condition, _)| condition).collect(),
            What::While { condition, .. } => vec![condition],
            What::For { bounds, step, .. } => bounds.iter().chain(step).collect(),
            What::Test { of, cases, .. } => {
                std::iter::once(of).chain(cases.iter().flat_map(|(values, _)| values)).collect()
            }
            What::Return(value) => value.iter().collect(),
            What::Call { .. }
            | What::Exit
            | What::Label
            | What::Goto(_)
            | What::Connect(_)
            | What::Harmless(_)
            | What::Broken(_) => Vec::new(),
        }
    }
}

/// Blocks within a statement.
pub(super) fn inner(statement: &Statement) -> Vec<&[Statement]> {
    match &statement.what {
        What::If { branches, otherwise } => {
            branches.iter().map(|(_, body)| body.as_slice()).chain([otherwise.as_slice()]).collect()
        }
        What::Test { cases, otherwise, .. } => {
            cases.iter().map(|(_, body)| body.as_slice()).chain([otherwise.as_slice()]).collect()
        }
        What::While { body, .. } | What::For { body, .. } => vec![body.as_slice()],
        _ => Vec::new(),
    }
}

/// Calls `seen` with every statement of the block and of the blocks within.
pub(super) fn each(block: &[Statement], seen: &mut impl FnMut(&Statement)) {
    for statement in block {
        seen(statement);
        inner(statement).into_iter().for_each(|block| each(block, seen));
    }
}
