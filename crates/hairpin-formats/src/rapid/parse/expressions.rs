//! Expressions and arguments, with RAPID's precedence: `* / DIV MOD`, `+ -`, comparisons, AND, and last OR, XOR, NOT.

use super::{Parsed, Parser};
use crate::rapid::lex::Word;
use crate::rapid::syntax::{Argument, Expression, Path, Step};

type Level = fn(&mut Parser) -> Parsed<Expression>;

impl Parser {
    pub(super) fn expression(&mut self) -> Parsed<Expression> {
        self.deeper(|parser| parser.chain(&[], &["OR", "XOR"], Self::conjunction))
    }

    fn conjunction(&mut self) -> Parsed<Expression> {
        if self.take_keyword("NOT") {
            let of = Box::new(self.deeper(Self::conjunction)?);
            return Ok(Expression::Unary { sign: "NOT", of });
        }
        self.chain(&[], &["AND"], Self::relation)
    }

    fn relation(&mut self) -> Parsed<Expression> {
        if self.take_keyword("NOT") {
            let of = Box::new(self.deeper(Self::relation)?);
            return Ok(Expression::Unary { sign: "NOT", of });
        }
        self.chain(&["=", "<>", "<=", ">=", "<", ">"], &[], Self::sum)
    }

    fn sum(&mut self) -> Parsed<Expression> {
        self.chain(&["+", "-"], &[], Self::product)
    }

    fn product(&mut self) -> Parsed<Expression> {
        self.chain(&["*", "/"], &["DIV", "MOD"], Self::primary)
    }

    /// Operands of `level` joined by any of the signs and keywords, from left to right.
    fn chain(&mut self, signs: &[&'static str], keywords: &[&'static str], level: Level) -> Parsed<Expression> {
        let first = level(self)?;
        let mut rest = Vec::new();
        loop {
            let sign = signs.iter().copied().find(|sign| self.is_sign(sign)).or_else(|| self.keyword_of(keywords));
            let Some(sign) = sign else { break };
            self.advance();
            rest.push((sign, level(self)?));
        }
        Ok(if rest.is_empty() { first } else { Expression::Chain { first: Box::new(first), rest } })
    }

    fn primary(&mut self) -> Parsed<Expression> {
        if self.take_sign("-") {
            let of = Box::new(self.deeper(Self::primary)?);
            // A literal keeps its sign, so that aggregates of numbers are numbers.
            return Ok(match *of {
                Expression::Number(value) => Expression::Number(-value),
                _ => Expression::Unary { sign: "-", of },
            });
        }
        if self.take_sign("+") {
            return self.deeper(Self::primary);
        }
        if self.take_sign("(") {
            let inner = self.expression()?;
            self.expect_sign(")")?;
            return Ok(inner);
        }
        if self.take_sign("[") {
            let mut all = vec![self.expression()?];
            while self.take_sign(",") {
                all.push(self.expression()?);
            }
            self.expect_sign("]")?;
            return Ok(Expression::Aggregate(all));
        }
        match self.word().clone() {
            Word::Number(value) => {
                self.advance();
                Ok(Expression::Number(value))
            }
            Word::Text(text) => {
                self.advance();
                Ok(Expression::Text(text))
            }
            Word::Name(name) if name.eq_ignore_ascii_case("TRUE") || name.eq_ignore_ascii_case("FALSE") => {
                self.advance();
                Ok(Expression::Bool(name.eq_ignore_ascii_case("TRUE")))
            }
            Word::Name(name) if !is_keyword(&name) => {
                self.advance();
                if self.take_sign("(") {
                    let arguments = self.arguments(")")?;
                    self.expect_sign(")")?;
                    return Ok(Expression::Call { name, arguments });
                }
                Ok(Expression::Path(Path { name, steps: self.steps()? }))
            }
            _ => Err(self.expected("a value")),
        }
    }

    /// `{1, 2}.trans.x` behind a name.
    pub(super) fn steps(&mut self) -> Parsed<Vec<Step>> {
        let mut steps = Vec::new();
        loop {
            if self.take_sign("{") {
                let mut all = vec![self.expression()?];
                while self.take_sign(",") {
                    all.push(self.expression()?);
                }
                self.expect_sign("}")?;
                steps.push(Step::Element(all));
            } else if self.take_sign(".") {
                steps.push(Step::Component(self.expect_name()?.to_ascii_lowercase()));
            } else {
                return Ok(steps);
            }
        }
    }

    /// Arguments up to `end`, which stays. Commas may be missing before a `\`.
    pub(super) fn arguments(&mut self, end: &str) -> Parsed<Vec<Argument>> {
        let mut all = Vec::new();
        loop {
            if self.is_sign(end) {
                return Ok(all);
            }
            if self.take_sign("\\") {
                let name = self.expect_name()?.to_ascii_lowercase();
                if self.take_sign("?") {
                    let parameter = Path { name: self.expect_name()?, steps: Vec::new() };
                    all.push(Argument::IfGiven { name, parameter: Expression::Path(parameter) });
                } else {
                    let value = if self.take_sign(":=") { Some(self.expression()?) } else { None };
                    all.push(Argument::Named { name, value });
                }
            } else {
                let value = self.expression()?;
                // `name := value` without a backslash is how some write optional arguments of functions.
                match (&value, self.is_sign(":=")) {
                    (Expression::Path(path), true) if path.steps.is_empty() => {
                        let name = path.name.to_ascii_lowercase();
                        self.advance();
                        let value = Some(self.expression()?);
                        all.push(Argument::Named { name, value });
                    }
                    _ => all.push(Argument::Placed(value)),
                }
            }
            if !self.take_sign(",") && !self.is_sign("\\") && !self.is_sign(end) {
                return Err(self.expected(&format!("`,` or `{end}`")));
            }
        }
    }
}

/// Keywords that end an expression, so that a missing operand does not swallow a block.
fn is_keyword(name: &str) -> bool {
    crate::rapid::names::RESERVED.iter().any(|reserved| name.eq_ignore_ascii_case(reserved))
}
