//! What a module says, before anything is executed.

use crate::listing::At;

/// A value to be computed.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Expression {
    Number(f64),
    Bool(bool),
    Text(String),
    /// `[a, b, …]`
    Aggregate(Vec<Expression>),
    /// A variable, perhaps an element of it, perhaps a component of that.
    Path(Path),
    Call {
        name: String,
        arguments: Vec<Argument>,
    },
    Unary {
        sign: &'static str,
        of: Box<Expression>,
    },
    /// Operands from left to right: however many, they lie no deeper.
    Chain {
        first: Box<Expression>,
        rest: Vec<(&'static str, Expression)>,
    },
}

/// `p10{3}.trans.x`
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Path {
    /// As written.
    pub(super) name: String,
    pub(super) steps: Vec<Step>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum Step {
    Element(Vec<Expression>),
    Component(String),
}

/// What is handed to a procedure, function or instruction.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Argument {
    /// By its place.
    Placed(Expression),
    /// `\Name` or `\Name:=value`.
    Named { name: String, value: Option<Expression> },
    /// `\Name?parameter`: given if the caller's parameter was.
    IfGiven { name: String, parameter: Expression },
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Statement {
    pub(super) at: At,
    pub(super) what: What,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) enum What {
    Assign {
        to: Path,
        value: Expression,
    },
    /// An instruction or a procedure: they look the same.
    Call {
        name: String,
        arguments: Vec<Argument>,
    },
    /// `%"name"%` and the like.
    LateCall {
        name: Expression,
        arguments: Vec<Argument>,
    },
    If {
        branches: Vec<(Expression, Vec<Statement>)>,
        otherwise: Vec<Statement>,
    },
    While {
        condition: Expression,
        body: Vec<Statement>,
    },
    For {
        variable: String,
        bounds: Box<[Expression; 2]>,
        step: Option<Expression>,
        body: Vec<Statement>,
    },
    Test {
        of: Expression,
        cases: Vec<(Vec<Expression>, Vec<Statement>)>,
        otherwise: Vec<Statement>,
    },
    Return(Option<Expression>),
    Exit,
    Label,
    Goto(String),
    /// `CONNECT i WITH trap`: the trap's name.
    Connect(String),
    /// RETRY, TRYNEXT, RAISE.
    Harmless(&'static str),
    /// A line that could not be understood.
    Broken(String),
}

/// Where something is declared, and who knows it.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Home {
    /// Index of its module.
    pub(super) module: usize,
    /// Whether its module alone knows it.
    pub(super) local: bool,
}

/// A piece of data.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Declaration {
    pub(super) at: At,
    pub(super) home: Home,
    /// CONST: nothing else is ever assigned.
    pub(super) constant: bool,
    pub(super) kind: String,
    pub(super) name: String,
    /// Extents of an array, innermost last; empty for a single one.
    pub(super) extents: Vec<Expression>,
    pub(super) value: Option<Expression>,
}

#[derive(Debug, Clone, PartialEq)]
pub(super) struct Parameter {
    pub(super) name: String,
    /// `switch` for switches.
    pub(super) kind: String,
    pub(super) optional: bool,
    /// INOUT, VAR or PERS: what is assigned comes back.
    pub(super) returned: bool,
}

/// PROC, FUNC or TRAP.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Routine {
    pub(super) at: At,
    pub(super) home: Home,
    pub(super) kind: RoutineKind,
    /// The kind of data that a function gives.
    pub(super) gives: Option<String>,
    pub(super) name: String,
    pub(super) parameters: Vec<Parameter>,
    pub(super) data: Vec<Declaration>,
    pub(super) body: Vec<Statement>,
    /// Its ERROR, UNDO and BACKWARD parts.
    pub(super) handlers: Vec<Handler>,
}

/// What of a routine is executed where something comes in between.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Handler {
    /// ERROR, UNDO or BACKWARD.
    pub(super) kind: &'static str,
    pub(super) body: Vec<Statement>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum RoutineKind {
    Procedure,
    Function,
    Trap,
}

/// Modules that are one program.
#[derive(Debug, Clone, PartialEq, Default)]
pub(super) struct Source {
    /// Name and line of each.
    pub(super) modules: Vec<(String, usize)>,
    pub(super) data: Vec<Declaration>,
    pub(super) routines: Vec<Routine>,
}
