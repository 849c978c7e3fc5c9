//! From words to what a module says, by recursive descent. What cannot be understood costs its line, never the file.

mod data;
mod expressions;
mod statements;

use super::lex::{Comment, MOST_WORDS, Token, Word, lex};
use super::syntax::{Handler, Home, Routine, RoutineKind, Source};
use crate::listing::At;

/// Blocks and brackets may be nested this deep.
const DEEPEST: usize = 60;

/// Lines of a file that is RAPID and is not understood, at most.
const MOST_MISTAKES: usize = 10_000;

/// Something in the file that is not RAPID as it is known here.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Mistake {
    pub(super) at: At,
    pub(super) what: String,
    /// Whether it is a statement of a routine, which is told where it is executed.
    pub(super) in_routine: bool,
}

impl Mistake {
    fn new(at: At, what: String) -> Self {
        Self { at, what, in_routine: false }
    }
}

/// What an attempt to understand gives: a mistake ends the line.
type Parsed<T> = Result<T, Mistake>;

/// Puts the modules in `text`, of which the first line counts as `first_line`, into `source`: what was not understood,
/// and the comments.
pub(super) fn parse(text: &str, first_line: usize, source: &mut Source) -> (Vec<Mistake>, Vec<Comment>) {
    let (tokens, comments) = lex(text, first_line);
    let mut parser = Parser { tokens, next: 0, depth: 0, home: Home::default(), mistakes: Vec::new() };
    parser.file(source);
    if parser.tokens.len() > MOST_WORDS {
        let at = parser.tokens[MOST_WORDS].at;
        let what = format!("more than {MOST_WORDS} words: the rest is not read");
        parser.mistakes.push(Mistake::new(at, what));
    }
    (parser.mistakes, comments)
}

struct Parser {
    tokens: Vec<Token>,
    next: usize,
    depth: usize,
    /// Of what is declared just now.
    home: Home,
    mistakes: Vec<Mistake>,
}

impl Parser {
    fn word(&self) -> &Word {
        &self.tokens[self.next].word
    }

    fn at(&self) -> At {
        self.tokens[self.next].at
    }

    /// Takes a word; the end of the file stays.
    fn advance(&mut self) {
        self.next = (self.next + 1).min(self.tokens.len() - 1);
    }

    fn ahead(&self, by: usize) -> &Word {
        &self.tokens[(self.next + by).min(self.tokens.len() - 1)].word
    }

    fn is_sign(&self, sign: &str) -> bool {
        matches!(self.word(), Word::Sign(found) if *found == sign)
    }

    fn is_keyword(&self, keyword: &str) -> bool {
        matches!(self.word(), Word::Name(name) if name.eq_ignore_ascii_case(keyword))
    }

    /// The keyword of `keywords` that comes next.
    fn keyword_of(&self, keywords: &[&'static str]) -> Option<&'static str> {
        keywords.iter().copied().find(|keyword| self.is_keyword(keyword))
    }

    fn take_sign(&mut self, sign: &str) -> bool {
        let found = self.is_sign(sign);
        if found {
            self.advance();
        }
        found
    }

    fn take_keyword(&mut self, keyword: &str) -> bool {
        let found = self.is_keyword(keyword);
        if found {
            self.advance();
        }
        found
    }

    fn expect_sign(&mut self, sign: &'static str) -> Parsed<()> {
        if self.take_sign(sign) { Ok(()) } else { Err(self.expected(&format!("`{sign}`"))) }
    }

    fn expect_keyword(&mut self, keyword: &str) -> Parsed<()> {
        if self.take_keyword(keyword) { Ok(()) } else { Err(self.expected(keyword)) }
    }

    fn expect_name(&mut self) -> Parsed<String> {
        match self.word() {
            Word::Name(name) => {
                let name = name.clone();
                self.advance();
                Ok(name)
            }
            _ => Err(self.expected("a name")),
        }
    }

    fn expected(&self, what: &str) -> Mistake {
        let found = match self.word() {
            Word::Name(name) => format!("`{name}`"),
            Word::Number(number) => format!("{number}"),
            Word::Text(_) => "a string".into(),
            Word::Sign(sign) => format!("`{sign}`"),
            Word::Stray('"') => "a string without its second quote".into(),
            Word::Stray(c) => format!("`{}`", c.escape_default()),
            Word::End => "the end of the file".into(),
        };
        Mistake::new(self.at(), format!("expected {what}, found {found}"))
    }

    /// Runs `inner` one level deeper.
    fn deeper<T>(&mut self, inner: impl FnOnce(&mut Self) -> Parsed<T>) -> Parsed<T> {
        if self.depth == DEEPEST {
            return Err(Mistake::new(self.at(), format!("nested more than {DEEPEST} deep")));
        }
        self.depth += 1;
        let result = inner(self);
        self.depth -= 1;
        result
    }

    /// Skips to behind the next `;`, or to the next line if none comes before it ends.
    fn recover(&mut self, from: At) {
        let line = self.at().line.max(from.line);
        while !matches!(self.word(), Word::End) && self.at().line <= line {
            if self.take_sign(";") {
                return;
            }
            self.advance();
        }
    }

    /// All modules of the file.
    fn file(&mut self, source: &mut Source) {
        let before = source.modules.len();
        let mut told = false;
        while !matches!(self.word(), Word::End) {
            // Expressions of a file that is none may hold the word as well; a module has a name.
            if !(self.is_keyword("MODULE") && matches!(self.ahead(1), Word::Name(_))) {
                // Behind a module nothing but another one may stand; of what is left over one mistake tells.
                let over = matches!(self.word(), Word::Name(_) | Word::Number(_) | Word::Text(_));
                if over && source.modules.len() > before && !std::mem::replace(&mut told, true) {
                    self.mistakes.push(self.expected("MODULE or the end of the file"));
                }
                self.advance();
                continue;
            }
            let line = self.at().line;
            self.advance();
            let name = self.expect_name().unwrap_or_default();
            self.home.module = source.modules.len();
            source.modules.push((name, line));
            self.attributes();
            self.module(source);
        }
    }

    /// `(SYSMODULE, NOSTEPIN)`
    fn attributes(&mut self) {
        if self.is_sign("(") {
            while !matches!(self.word(), Word::End) && !self.take_sign(")") {
                self.advance();
            }
        }
    }

    fn module(&mut self, source: &mut Source) {
        loop {
            let at = self.at();
            if matches!(self.word(), Word::End) {
                self.mistakes.push(self.expected("ENDMODULE"));
                return;
            }
            if self.take_keyword("ENDMODULE") {
                return;
            }
            if let Err(mistake) = self.part(source) {
                self.mistakes.push(mistake);
                if self.mistakes.len() >= MOST_MISTAKES {
                    let what = format!("more than {MOST_MISTAKES} lines are not understood: the rest is not read");
                    self.mistakes.push(Mistake::new(at, what));
                    self.next = self.tokens.len() - 1;
                    return;
                }
                self.recover(at);
            }
        }
    }

    fn part(&mut self, source: &mut Source) -> Parsed<()> {
        let start = self.next;
        self.home.local = false;
        loop {
            if self.take_keyword("LOCAL") {
                self.home.local = true;
            } else if !self.take_keyword("TASK") {
                break;
            }
        }
        let at = self.at();
        let kind = match self.keyword_of(&["PROC", "FUNC", "TRAP", "RECORD", "ALIAS", "CONST", "PERS", "VAR"]) {
            Some("PROC") => RoutineKind::Procedure,
            Some("FUNC") => RoutineKind::Function,
            Some("TRAP") => RoutineKind::Trap,
            Some("RECORD") => {
                while !matches!(self.word(), Word::End) && !self.take_keyword("ENDRECORD") {
                    self.advance();
                }
                return Ok(());
            }
            Some("ALIAS") => {
                self.recover(at);
                return Ok(());
            }
            Some(_) => {
                source.data.push(self.declaration()?);
                return Ok(());
            }
            None => {
                let mistake = self.expected("a declaration, PROC, FUNC, TRAP or ENDMODULE");
                if self.next == start {
                    self.advance();
                }
                return Err(mistake);
            }
        };
        self.advance();
        source.routines.push(self.routine(kind, at)?);
        Ok(())
    }

    fn routine(&mut self, kind: RoutineKind, at: At) -> Parsed<Routine> {
        let home = self.home;
        let gives = if kind == RoutineKind::Function { Some(self.expect_name()?.to_ascii_lowercase()) } else { None };
        let name = self.expect_name()?;
        let parameters = if kind == RoutineKind::Trap { Vec::new() } else { self.parameters()? };
        let mut data = Vec::new();
        while self.keyword_of(&["VAR", "CONST", "PERS"]).is_some() {
            let start = self.at();
            match self.declaration() {
                Ok(declaration) => data.push(declaration),
                Err(mistake) => {
                    self.mistakes.push(mistake);
                    self.recover(start);
                }
            }
        }
        let end = match kind {
            RoutineKind::Procedure => "ENDPROC",
            RoutineKind::Function => "ENDFUNC",
            RoutineKind::Trap => "ENDTRAP",
        };
        let ends = [end, "ERROR", "UNDO", "BACKWARD"];
        let body = self.block(&ends);
        let mut handlers = Vec::new();
        while let Some(kind) = self.keyword_of(&ends[1..]) {
            self.advance();
            self.attributes();
            handlers.push(Handler { kind, body: self.block(&ends) });
        }
        // A routine that is cut short keeps what it has.
        if !self.take_keyword(end) {
            self.mistakes.push(self.expected(end));
        }
        Ok(Routine { at, home, kind, gives, name, parameters, data, body, handlers })
    }
}
