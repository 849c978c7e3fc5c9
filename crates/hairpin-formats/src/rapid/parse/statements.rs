//! Statements and blocks of them.

use super::{Mistake, Parsed, Parser};
use crate::listing::At;
use crate::rapid::lex::Word;
use crate::rapid::names::RESERVED;
use crate::rapid::syntax::{Expression, Path, Statement, What};

/// Ends of routines: a block that lost its own end ends there at the latest.
const ENDS: [&str; 7] = ["ENDPROC", "ENDFUNC", "ENDTRAP", "ENDMODULE", "PROC", "FUNC", "TRAP"];

impl Parser {
    /// Statements up to one of `ends`, which stays.
    pub(super) fn block(&mut self, ends: &[&'static str]) -> Vec<Statement> {
        let mut all = Vec::new();
        while !matches!(self.word(), Word::End) && self.keyword_of(ends).is_none() && self.keyword_of(&ENDS).is_none() {
            let (at, start) = (self.at(), self.next);
            match self.statement(at) {
                Ok(what) => all.push(Statement { at, what }),
                Err(mistake) => {
                    all.push(Statement { at, what: What::Broken(mistake.what.clone()) });
                    self.mistakes.push(Mistake { in_routine: true, ..mistake });
                    // What lost its end ends with the routine, whose own end stays.
                    if self.keyword_of(&ENDS).is_none() {
                        self.recover(at);
                    }
                    if self.next == start {
                        self.advance();
                    }
                }
            }
        }
        all
    }

    fn statement(&mut self, at: At) -> Parsed<What> {
        if self.take_sign("%") {
            let name = self.expression()?;
            self.expect_sign("%")?;
            let arguments = self.arguments(";")?;
            self.expect_sign(";")?;
            return Ok(What::LateCall { name, arguments });
        }
        if let Some(keyword) = self.keyword_of(&["IF", "WHILE", "FOR", "TEST"]) {
            self.advance();
            return self.deeper(|parser| match keyword {
                "IF" => parser.branches(),
                "WHILE" => parser.loop_while(),
                "FOR" => parser.loop_for(),
                _ => parser.test(),
            });
        }
        let simple = ["RETURN", "EXIT", "GOTO", "RETRY", "TRYNEXT", "RAISE", "CONNECT"];
        if let Some(keyword) = self.keyword_of(&simple) {
            self.advance();
            let what = match keyword {
                "RETURN" => What::Return(if self.is_sign(";") { None } else { Some(self.expression()?) }),
                "EXIT" => What::Exit,
                "GOTO" => What::Goto(self.expect_name()?),
                "CONNECT" => {
                    self.expect_name()?;
                    self.steps()?;
                    self.expect_keyword("WITH")?;
                    What::Connect(self.expect_name()?)
                }
                _ => {
                    while !self.is_sign(";") && self.at().line == at.line {
                        self.advance();
                    }
                    What::Harmless(keyword)
                }
            };
            self.expect_sign(";")?;
            return Ok(what);
        }
        if self.keyword_of(&RESERVED).is_some() {
            return Err(self.expected("an instruction"));
        }
        let name = self.expect_name()?;
        if self.is_sign(":") {
            self.advance();
            return Ok(What::Label);
        }
        // `name{…` and `name.…` can only be assigned to; so can `name :=`.
        if self.is_sign(":=") || self.is_sign("{") || self.is_sign(".") {
            let to = Path { name, steps: self.steps()? };
            self.expect_sign(":=")?;
            let value = self.expression()?;
            self.expect_sign(";")?;
            return Ok(What::Assign { to, value });
        }
        let arguments = self.arguments(";")?;
        self.expect_sign(";")?;
        Ok(What::Call { name, arguments })
    }

    /// `IF a THEN … ELSEIF b THEN … ELSE … ENDIF`, or `IF a` and one statement.
    fn branches(&mut self) -> Parsed<What> {
        let ends = ["ELSEIF", "ELSE", "ENDIF"];
        let condition = self.expression()?;
        if !self.take_keyword("THEN") {
            let at = self.at();
            let what = self.deeper(|parser| parser.statement(at))?;
            return Ok(What::If { branches: vec![(condition, vec![Statement { at, what }])], otherwise: Vec::new() });
        }
        let mut branches = vec![(condition, self.block(&ends))];
        while self.take_keyword("ELSEIF") {
            let condition = self.expression()?;
            self.expect_keyword("THEN")?;
            branches.push((condition, self.block(&ends)));
        }
        let otherwise = if self.take_keyword("ELSE") { self.block(&["ENDIF"]) } else { Vec::new() };
        self.end_of_block("ENDIF")?;
        Ok(What::If { branches, otherwise })
    }

    fn loop_while(&mut self) -> Parsed<What> {
        let condition = self.expression()?;
        self.expect_keyword("DO")?;
        let body = self.block(&["ENDWHILE"]);
        self.end_of_block("ENDWHILE")?;
        Ok(What::While { condition, body })
    }

    fn loop_for(&mut self) -> Parsed<What> {
        let variable = self.expect_name()?;
        self.expect_keyword("FROM")?;
        let from = self.expression()?;
        self.expect_keyword("TO")?;
        let to = self.expression()?;
        let step = if self.take_keyword("STEP") { Some(self.expression()?) } else { None };
        self.expect_keyword("DO")?;
        let body = self.block(&["ENDFOR"]);
        self.end_of_block("ENDFOR")?;
        Ok(What::For { variable, bounds: Box::new([from, to]), step, body })
    }

    fn test(&mut self) -> Parsed<What> {
        let ends = ["CASE", "DEFAULT", "ENDTEST"];
        let of = self.expression()?;
        let (mut cases, mut otherwise) = (Vec::new(), Vec::new());
        while self.take_keyword("CASE") {
            let mut values: Vec<Expression> = vec![self.expression()?];
            while self.take_sign(",") {
                values.push(self.expression()?);
            }
            self.expect_sign(":")?;
            cases.push((values, self.block(&ends)));
        }
        if self.take_keyword("DEFAULT") {
            self.expect_sign(":")?;
            otherwise = self.block(&["ENDTEST"]);
        }
        self.end_of_block("ENDTEST")?;
        Ok(What::Test { of, cases, otherwise })
    }

    /// The end of a block; where it is missing the block is one that was not understood.
    fn end_of_block(&mut self, end: &str) -> Result<(), Mistake> {
        self.expect_keyword(end)?;
        // Some write a semicolon behind it.
        self.take_sign(";");
        Ok(())
    }
}
