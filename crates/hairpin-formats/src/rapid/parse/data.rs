//! Declarations of data and of parameters.

use super::{Parsed, Parser};
use crate::rapid::syntax::{Declaration, Parameter};

impl Parser {
    /// `CONST robtarget p10 := […];`, with `VAR` or `PERS`, `{n, m}` behind the name.
    pub(super) fn declaration(&mut self) -> Parsed<Declaration> {
        let constant = self.is_keyword("CONST");
        self.advance();
        let at = self.at();
        let kind = self.expect_name()?.to_ascii_lowercase();
        let name = self.expect_name()?;
        let mut extents = Vec::new();
        if self.take_sign("{") {
            extents.push(self.expression()?);
            while self.take_sign(",") {
                extents.push(self.expression()?);
            }
            self.expect_sign("}")?;
        }
        let value = if self.take_sign(":=") { Some(self.expression()?) } else { None };
        self.expect_sign(";")?;
        Ok(Declaration { at, home: self.home, constant, kind, name, extents, value })
    }

    /// `(num a, \switch fast | num slow, INOUT robtarget p{*})`
    pub(super) fn parameters(&mut self) -> Parsed<Vec<Parameter>> {
        let mut all = Vec::new();
        self.expect_sign("(")?;
        while !self.take_sign(")") {
            // Behind a `|` the backslash of an alternative may be missing.
            let alternative = self.take_sign("|");
            let optional = self.take_sign("\\") || alternative;
            let returned = match self.keyword_of(&["INOUT", "VAR", "PERS"]) {
                Some(_) => {
                    self.advance();
                    true
                }
                None => false,
            };
            let kind = self.expect_name()?.to_ascii_lowercase();
            let name = self.expect_name()?.to_ascii_lowercase();
            if self.take_sign("{") {
                while self.take_sign("*") || self.take_sign(",") {}
                self.expect_sign("}")?;
            }
            all.push(Parameter { name, kind, optional, returned });
            if !self.take_sign(",") && !self.is_sign(")") && !self.is_sign("\\") && !self.is_sign("|") {
                return Err(self.expected("`,` or `)`"));
            }
        }
        Ok(all)
    }
}
