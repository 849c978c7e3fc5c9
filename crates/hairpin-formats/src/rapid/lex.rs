//! The words of a module. RAPID is free of lines: what counts is where each word begins.

use crate::listing::At;

/// One word.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Word {
    /// A name or keyword as it is written.
    Name(String),
    /// A number.
    Number(f64),
    /// A string without its quotes.
    Text(String),
    /// `:=`, `<=`, `;` and so on.
    Sign(&'static str),
    /// Anything else.
    Stray(char),
    /// The end of the file.
    End,
}

/// A word and its place.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Token {
    /// The word.
    pub(super) word: Word,
    /// Where it begins.
    pub(super) at: At,
}

/// A comment without its `!`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Comment {
    /// Its line.
    pub(super) line: usize,
    /// Its text.
    pub(super) text: String,
}

/// Signs, longest first.
const SIGNS: [&str; 26] = [
    ":=", "<=", ">=", "<>", ";", ",", ":", "(", ")", "[", "]", "{", "}", "+", "-", "*", "/", "=", "<", ">", "\\", ".",
    "?", "|", "%", "&",
];

/// Words of a file at most: those of a hundred thousand moves with their targets in place.
pub(super) const MOST_WORDS: usize = 5_000_000;

/// The first [`MOST_WORDS`] words, `End` last, and all comments; the first line counts as `first_line`.
pub(super) fn lex(text: &str, first_line: usize) -> (Vec<Token>, Vec<Comment>) {
    let mut reader = Reader { rest: text, at: At { line: first_line, column: 1 }, comments: Vec::new() };
    let mut tokens = Vec::new();
    loop {
        reader.skip();
        let at = reader.at;
        let word = reader.word();
        let end = word == Word::End || tokens.len() == MOST_WORDS;
        tokens.push(Token { word: if end { Word::End } else { word }, at });
        if end {
            return (tokens, reader.comments);
        }
    }
}

struct Reader<'a> {
    rest: &'a str,
    at: At,
    comments: Vec<Comment>,
}

impl<'a> Reader<'a> {
    fn peek(&self) -> Option<char> {
        self.rest.chars().next()
    }

    /// Takes `bytes` bytes, which end where a character ends.
    fn take(&mut self, bytes: usize) -> &'a str {
        let (taken, rest) = self.rest.split_at(bytes);
        for c in taken.chars() {
            if c == '\n' {
                self.at = At { line: self.at.line + 1, column: 1 };
            } else {
                self.at.column += 1;
            }
        }
        self.rest = rest;
        taken
    }

    fn take_while(&mut self, keep: impl Fn(char) -> bool) -> &'a str {
        self.take(self.rest.find(|c| !keep(c)).unwrap_or(self.rest.len()))
    }

    /// Blanks and comments. Lines between modules that begin with `%%%` are headers of backups.
    fn skip(&mut self) {
        loop {
            self.take_while(char::is_whitespace);
            let line = self.at.line;
            if self.rest.starts_with("%%%") {
                let within = self.rest[3..].find("%%%").map_or(self.rest.len(), |at| at + 6);
                self.take(within);
            } else if self.rest.starts_with('!') {
                let text = self.take_while(|c| c != '\n' && c != '\r')[1..].to_owned();
                self.comments.push(Comment { line, text });
            } else {
                return;
            }
        }
    }

    fn word(&mut self) -> Word {
        let Some(first) = self.peek() else { return Word::End };
        if first.is_alphabetic() || first == '_' {
            return Word::Name(self.take_while(|c| c.is_alphanumeric() || c == '_').into());
        }
        let after = self.rest[first.len_utf8()..].chars().next();
        if first.is_ascii_digit() || (first == '.' && after.is_some_and(|c| c.is_ascii_digit())) {
            return self.number();
        }
        if first == '"' {
            return self.text();
        }
        match SIGNS.into_iter().find(|sign| self.rest.starts_with(sign)) {
            Some(sign) => {
                self.take(sign.len());
                Word::Sign(sign)
            }
            None => {
                self.take(first.len_utf8());
                Word::Stray(first)
            }
        }
    }

    /// Decimal, or hexadecimal, octal and binary after 0x, 0o, 0b.
    fn number(&mut self) -> Word {
        let lower = self.rest.get(..2).map(str::to_ascii_lowercase);
        let radix = match lower.as_deref() {
            Some("0x") => 16,
            Some("0o") => 8,
            Some("0b") => 2,
            _ => 10,
        };
        if radix != 10 {
            self.take(2);
            let digits = self.take_while(|c| c.is_ascii_alphanumeric());
            return i64::from_str_radix(digits, radix).map_or(Word::Stray('0'), |value| Word::Number(value as f64));
        }
        let mut end = self.digits_from(0);
        if self.rest[end..].starts_with('.') {
            end = self.digits_from(end + 1);
        }
        if self.rest[end..].starts_with(['e', 'E']) {
            let sign = usize::from(self.rest[end + 1..].starts_with(['+', '-']));
            let after = self.digits_from(end + 1 + sign);
            if after > end + 1 + sign {
                end = after;
            }
        }
        let value = self.take(end).parse::<f64>().ok().filter(|value| value.is_finite());
        value.map_or(Word::Stray('0'), Word::Number)
    }

    /// Where the digits that begin at `from` end.
    fn digits_from(&self, from: usize) -> usize {
        from + self.rest[from..].bytes().take_while(u8::is_ascii_digit).count()
    }

    /// A string; `""` and `\\` stand for one of them, `\` and two hexadecimal digits for a byte. It ends with its line
    /// at the latest, so that a missing quote spoils one line only.
    fn text(&mut self) -> Word {
        self.take(1);
        let mut text = String::new();
        while let Some(c) = self.peek().filter(|c| *c != '\n' && *c != '\r') {
            self.take(c.len_utf8());
            match (c, self.peek()) {
                ('"', Some('"')) | ('\\', Some('\\')) => {
                    self.take(1);
                    text.push(c);
                }
                ('"', _) => return Word::Text(text),
                ('\\', _) => match self.rest.get(..2).and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
                    Some(byte) => {
                        self.take(2);
                        text.push(char::from(byte));
                    }
                    None => text.push(c),
                },
                _ => text.push(c),
            }
        }
        Word::Stray('"')
    }
}
