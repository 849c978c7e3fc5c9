//! Statements of KRL that have nothing to do with motion, and declarations, each understood to its end: what is left
//! over nobody may read over.

/// Brackets within brackets at most.
const DEEPEST: usize = 60;

/// Functions that give a value and do nothing, in upper case.
const VALUES: [&str; 25] = [
    "ABS",
    "ACOS",
    "ATAN2",
    "COS",
    "FORWARD",
    "INVERSE",
    "MAXIMUM",
    "MINIMUM",
    "ROUND",
    "SIN",
    "SQRT",
    "STRADD",
    "STRCLEAR",
    "STRCOMP",
    "STRCOPY",
    "STRDECLLEN",
    "STRDELETE",
    "STRFIND",
    "STRLEN",
    "STRTOBOOL",
    "STRTOINT",
    "STRTOREAL",
    "STRTOSTRING",
    "TAN",
    "VARSTATE",
];

/// System data that has nothing to do with motion.
const HARMLESS_DATA: [&str; 9] =
    ["$OUT", "$OUT_C", "$ADVANCE", "$ANOUT", "$TIMER", "$TIMER_STOP", "$TIMER_FLAG", "$FLAG", "$CYCFLAG"];

/// Words between values.
const OPERATORS: [&str; 6] = ["AND", "OR", "EXOR", "B_AND", "B_OR", "B_EXOR"];

/// Statements that neither move the arm nor change how it moves.
const HARMLESS: [&str; 10] =
    ["WAIT", "HALT", "CONTINUE", "PULSE", "ANOUT", "ANIN", "DIGIN", "MSGNOTIFY", "CWRITE", "SWRITE"];

/// Whether the statement that begins with `word` (upper case) is one of these, if it is understood to its end.
pub(super) fn may_be_harmless(word: &str) -> bool {
    HARMLESS.contains(&word) || HARMLESS_DATA.contains(&word)
}

/// A statement that [`may_be_harmless`], to its end.
///
/// # Errors
/// What in it is not understood.
pub(super) fn harmless(statement: &str) -> Result<(), String> {
    let mut phrase = Phrase::of(statement);
    let word = phrase.name()?.to_ascii_uppercase();
    match word.as_str() {
        "HALT" | "CONTINUE" => {}
        "WAIT" if phrase.takes_word("SEC") || phrase.takes_word("FOR") => phrase.expression(0)?,
        "ANOUT" | "ANIN" | "DIGIN" if phrase.takes_word("OFF") => drop(phrase.name()?),
        "ANOUT" | "ANIN" | "DIGIN" if phrase.takes_word("ON") => {
            phrase.name()?;
            phrase.expects("=")?;
            phrase.expression(0)?;
            while word == "ANOUT" && ["DELAY", "MINIMUM", "MAXIMUM"].iter().any(|given| phrase.takes_word(given)) {
                phrase.expects("=")?;
                phrase.expression(0)?;
            }
        }
        // What is written to the command channel starts programs.
        "CWRITE" if phrase.rest.to_ascii_uppercase().contains("$CMD") => return Err("`$CMD` is not followed".into()),
        "PULSE" | "MSGNOTIFY" | "CWRITE" | "SWRITE" => {
            phrase.expects("(")?;
            phrase.arguments(0)?;
        }
        _ if HARMLESS_DATA.contains(&word.as_str()) => {
            phrase.indices(0)?;
            phrase.expects("=")?;
            let value = phrase.rest.trim();
            phrase.expression(0)?;
            // Without a move in advance nothing is blended.
            if word == "$ADVANCE" && !["1", "2", "3", "4", "5"].contains(&value) {
                return Err(format!("`$ADVANCE={}` is not followed, must be 1 to 5", value.escape_default()));
            }
        }
        _ => return Err(phrase.left()),
    }
    phrase.end()
}

/// Words that begin a declaration, in upper case.
const DECLARES: [&str; 19] = [
    "DECL", "CONST", "E6POS", "E3POS", "POS", "FRAME", "E6AXIS", "AXIS", "INT", "REAL", "BOOL", "CHAR", "STRUC",
    "ENUM", "SIGNAL", "EXT", "EXTFCT", "EXTP", "EXTFCTP",
];

/// Whether the statement begins as declarations do.
pub(super) fn is_declaration(statement: &str) -> bool {
    let mut phrase = Phrase::of(statement);
    // GLOBAL also stands before DEF and INTERRUPT.
    phrase.takes_word("GLOBAL");
    phrase.name().is_ok_and(|word| DECLARES.iter().any(|known| word.eq_ignore_ascii_case(known)))
}

/// A declaration, to its end.
///
/// # Errors
/// What in it is not understood.
pub(super) fn declaration(statement: &str) -> Result<(), String> {
    let mut phrase = Phrase::of(statement);
    while ["DECL", "GLOBAL", "CONST"].iter().any(|word| phrase.takes_word(word)) {}
    let kind = phrase.name()?.to_ascii_uppercase();
    match kind.as_str() {
        "SIGNAL" => {
            phrase.name()?;
            phrase.variable(0)?;
            if phrase.takes_word("TO") {
                phrase.variable(0)?;
            }
        }
        "ENUM" => {
            phrase.name()?;
            phrase.name()?;
            while phrase.takes(",") {
                phrase.name()?;
            }
        }
        "STRUC" => {
            phrase.name()?;
            phrase.name()?;
            phrase.variable(0)?;
            while phrase.takes(",") {
                // A name of the kind before it, or another kind and a name of that.
                phrase.variable(0)?;
                if phrase.begins_name() {
                    phrase.variable(0)?;
                }
            }
        }
        "EXT" | "EXTFCT" | "EXTP" | "EXTFCTP" => {
            phrase.name()?;
            if kind.starts_with("EXTFCT") {
                phrase.name()?;
            }
            phrase.parameters()?;
        }
        _ => loop {
            let name = phrase.name()?;
            // What the controller has is declared by nobody.
            if name.starts_with('$') {
                return Err(format!("`{}` is not followed", name.escape_default()));
            }
            phrase.indices(0)?;
            if phrase.takes("=") {
                phrase.expression(0)?;
            }
            if !phrase.takes(",") {
                break;
            }
        },
    }
    phrase.end()
}

/// `NAME[1]=…` of a file of data: an element of an array that is declared there, none of the controller's own.
///
/// # Errors
/// What in it is not understood.
pub(super) fn element(statement: &str) -> Result<(), String> {
    let mut phrase = Phrase::of(statement);
    let name = phrase.name().map_err(|_| phrase.left())?;
    if name.starts_with('$') || !phrase.rest.trim_start().starts_with('[') {
        return Err(format!("`{}` is not followed", name.escape_default()));
    }
    phrase.indices(0)?;
    phrase.expects("=")?;
    phrase.expression(0)?;
    phrase.end()
}

/// `DEF name ( )`, `DEFDAT name PUBLIC`, END and ENDDAT: nothing behind them.
///
/// # Errors
/// What stands there.
pub(super) fn frame(statement: &str) -> Result<(), String> {
    let mut phrase = Phrase::of(statement);
    phrase.takes_word("GLOBAL");
    match phrase.name()?.to_ascii_uppercase().as_str() {
        "DEF" => {
            phrase.name()?;
            phrase.parameters()?;
        }
        "DEFDAT" => {
            phrase.name()?;
            phrase.takes_word("PUBLIC");
        }
        _ => {}
    }
    phrase.end()
}

/// `BAS (#VEL_PTP,30)`: what is set, in upper case, and to what, as it is written.
///
/// # Errors
/// What in it is not understood.
pub(super) fn basics(statement: &str) -> Result<(String, String), String> {
    let mut phrase = Phrase::of(statement);
    phrase.name()?;
    phrase.expects("(")?;
    phrase.expects("#")?;
    let what = phrase.name()?.to_ascii_uppercase();
    let mut value = "";
    if phrase.takes(",") {
        let from = phrase.rest;
        phrase.expression(0)?;
        value = from[..from.len() - phrase.rest.len()].trim();
    }
    let value = value.to_owned();
    phrase.expects(")")?;
    phrase.end()?;
    Ok((what, value))
}

/// What is left of a statement.
struct Phrase<'s> {
    rest: &'s str,
}

impl<'s> Phrase<'s> {
    fn of(statement: &'s str) -> Self {
        Self { rest: statement.trim() }
    }

    /// Names a piece of what is left.
    fn left(&self) -> String {
        match self.rest.split_whitespace().next() {
            Some(word) => format!("`{}` is not followed", word.chars().take(40).collect::<String>().escape_default()),
            None => "the statement has no end".into(),
        }
    }

    fn end(&self) -> Result<(), String> {
        if self.rest.trim().is_empty() { Ok(()) } else { Err(format!("{} behind it", self.left())) }
    }

    fn takes(&mut self, sign: &str) -> bool {
        match self.rest.trim_start().strip_prefix(sign) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn expects(&mut self, sign: &str) -> Result<(), String> {
        if self.takes(sign) { Ok(()) } else { Err(self.left()) }
    }

    fn begins_name(&self) -> bool {
        self.rest.trim_start().starts_with(|c: char| c.is_alphabetic() || "_$".contains(c))
    }

    fn name(&mut self) -> Result<&'s str, String> {
        if !self.begins_name() {
            return Err(self.left());
        }
        let rest = self.rest.trim_start();
        let end = rest.find(|c: char| !(c.is_alphanumeric() || "_$".contains(c))).unwrap_or(rest.len());
        self.rest = &rest[end..];
        Ok(&rest[..end])
    }

    fn takes_word(&mut self, word: &str) -> bool {
        let before = self.rest;
        let is = self.name().is_ok_and(|name| name.eq_ignore_ascii_case(word));
        if !is {
            self.rest = before;
        }
        is
    }

    /// `( … )` without brackets in it; or nothing.
    fn parameters(&mut self) -> Result<(), String> {
        if !self.takes("(") {
            return Ok(());
        }
        let end = self.rest.find(['(', ')', '{', '"', '=']).ok_or_else(|| self.left())?;
        self.rest = &self.rest[end..];
        self.expects(")")
    }

    /// `[1]`, `[1,2]`, `[]`; or nothing.
    fn indices(&mut self, depth: usize) -> Result<(), String> {
        if !self.takes("[") {
            return Ok(());
        }
        self.list("]", depth)
    }

    /// What stands behind `(` of a call.
    fn arguments(&mut self, depth: usize) -> Result<(), String> {
        self.list(")", depth)
    }

    /// Values between commas, of which some may be left out, up to what ends them.
    fn list(&mut self, end: &str, depth: usize) -> Result<(), String> {
        loop {
            if self.takes(end) {
                return Ok(());
            }
            if self.takes(",") {
                continue;
            }
            self.expression(depth + 1)?;
            if !self.takes(",") {
                return self.expects(end);
            }
        }
    }

    /// `$IN[3]`, `XP1.X`.
    fn variable(&mut self, depth: usize) -> Result<(), String> {
        self.name()?;
        self.indices(depth)?;
        while self.takes(".") {
            self.name()?;
            self.indices(depth)?;
        }
        Ok(())
    }

    /// Values with signs between them.
    fn expression(&mut self, depth: usize) -> Result<(), String> {
        if depth > DEEPEST {
            return Err(format!("more than {DEEPEST} brackets within each other"));
        }
        loop {
            while ["-", "+"].iter().any(|sign| self.takes(sign))
                || ["NOT", "B_NOT"].iter().any(|word| self.takes_word(word))
            {}
            self.operand(depth)?;
            let is_joined =
                ["==", "<>", "<=", ">=", "<", ">", "+", "-", "*", "/", ":"].iter().any(|sign| self.takes(sign))
                    || OPERATORS.iter().any(|word| self.takes_word(word));
            if !is_joined {
                return Ok(());
            }
        }
    }

    fn operand(&mut self, depth: usize) -> Result<(), String> {
        if self.takes("(") {
            self.expression(depth + 1)?;
            return self.expects(")");
        }
        if self.takes("{") {
            return self.aggregate(depth + 1);
        }
        if self.takes("#") {
            return self.name().map(drop);
        }
        for quote in ["\"", "'"] {
            if self.takes(quote) {
                let end = self.rest.find(quote).ok_or("a text has no end")?;
                self.rest = &self.rest[end + 1..];
                return Ok(());
            }
        }
        if self.begins_name() {
            let before = self.rest;
            let name = self.name()?;
            if self.takes("(") {
                if !VALUES.iter().any(|known| name.eq_ignore_ascii_case(known)) {
                    return Err(format!("`{}` is not followed", name.escape_default()));
                }
                return self.arguments(depth + 1);
            }
            self.rest = before;
            return self.variable(depth);
        }
        self.number()
    }

    fn number(&mut self) -> Result<(), String> {
        let rest = self.rest.trim_start();
        let digits = |text: &str| text.len() - text.trim_start_matches(|c: char| c.is_ascii_digit()).len();
        let mut end = digits(rest);
        if rest[end..].starts_with('.') {
            end += 1 + digits(&rest[end + 1..]);
        }
        if !rest[..end].contains(|c: char| c.is_ascii_digit()) {
            return Err(self.left());
        }
        if let Some(power) = rest[end..].strip_prefix(['e', 'E']) {
            let signed = power.strip_prefix(['+', '-']).unwrap_or(power);
            if digits(signed) > 0 {
                end = rest.len() - signed.len() + digits(signed);
            }
        }
        self.rest = &rest[end..];
        Ok(())
    }

    /// Behind `{`: `X 1,Y 2}`, `TYPE: TEXT[] "a",INNER {…}}`.
    fn aggregate(&mut self, depth: usize) -> Result<(), String> {
        let before = self.rest;
        if !(self.name().is_ok() && self.takes(":")) {
            self.rest = before;
        }
        loop {
            self.name()?;
            self.indices(depth)?;
            self.expression(depth)?;
            if !self.takes(",") {
                return self.expects("}");
            }
        }
    }
}
