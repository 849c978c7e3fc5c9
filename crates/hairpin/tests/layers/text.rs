//! A Rust source text as tokens: enough of the language's grammar to tell code from comments and strings.

use std::collections::BTreeSet;

/// A word, a string, `::`, or any other character of code.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Token {
    Word(String),
    Quoted(String),
    PathSeparator,
    Other(char),
}

/// The code of a text, and where its comments are.
#[derive(Default)]
pub(crate) struct Text {
    pub(crate) tokens: Vec<Token>,
    /// Line of every token, from 1.
    pub(crate) lines: Vec<usize>,
    /// For every opening bracket its closing one; for all other tokens themselves.
    pub(crate) closing: Vec<usize>,
    /// Lines on which some comment stands.
    pub(crate) comments: BTreeSet<usize>,
}

impl Text {
    pub(crate) fn new(text: &str) -> Self {
        let mut out = Self::default();
        let chars: Vec<char> = text.chars().collect();
        let (mut line, mut counted, mut i) = (1, 0, 0);
        while i < chars.len() {
            line += newlines(&chars[counted..i]);
            counted = i;
            i = out.take(&chars, i, line);
        }
        out.match_brackets();
        out
    }

    /// Takes what begins at `i`; returns where it ends.
    fn take(&mut self, chars: &[char], mut i: usize, line: usize) -> usize {
        let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
        match (chars[i], at(i + 1)) {
            ('/', '/') => {
                self.comments.insert(line);
                i + chars[i..].iter().take_while(|c| **c != '\n').count()
            }
            ('/', '*') => {
                let end = block_comment(chars, i);
                self.comments.extend(line..=line + newlines(&chars[i..end]));
                end
            }
            ('r', '"') => raw_string(chars, i + 1),
            ('r', '#') if matches!(at(i + 2), '"' | '#') => raw_string(chars, i + 1),
            ('"', _) => {
                let end = quoted(chars, i + 1, '"');
                self.push(Token::Quoted(chars[i + 1..end - 1].iter().collect()), line);
                end
            }
            ('\'', '\\') => quoted(chars, i + 1, '\''),
            ('\'', _) if at(i + 2) == '\'' => i + 3,
            (c, _) if c.is_alphanumeric() || c == '_' => {
                let word: String = chars[i..].iter().take_while(|c| c.is_alphanumeric() || **c == '_').collect();
                i += word.chars().count();
                self.push(Token::Word(word), line);
                i
            }
            (':', ':') => {
                self.push(Token::PathSeparator, line);
                i + 2
            }
            (c, _) => {
                if !c.is_whitespace() {
                    self.push(Token::Other(c), line);
                }
                i + 1
            }
        }
    }

    fn push(&mut self, token: Token, line: usize) {
        self.closing.push(self.tokens.len());
        self.tokens.push(token);
        self.lines.push(line);
    }

    fn match_brackets(&mut self) {
        let mut open = Vec::new();
        for (i, token) in self.tokens.iter().enumerate() {
            match token {
                Token::Other('(' | '[' | '{') => open.push(i),
                Token::Other(')' | ']' | '}') => {
                    if let Some(opening) = open.pop() {
                        self.closing[opening] = i;
                    }
                }
                _ => {}
            }
        }
    }

    /// The word at `i`, if one is there.
    pub(crate) fn word(&self, i: usize) -> Option<&str> {
        match self.tokens.get(i) {
            Some(Token::Word(word)) => Some(word),
            _ => None,
        }
    }

    /// Whether the character `c` stands at `i`.
    pub(crate) fn is(&self, i: usize, c: char) -> bool {
        self.tokens.get(i) == Some(&Token::Other(c))
    }

    /// Whether `::` stands at `i`.
    pub(crate) fn separates(&self, i: usize) -> bool {
        self.tokens.get(i) == Some(&Token::PathSeparator)
    }

    /// The first token from `i` on and before `end`, outside of further brackets, at which `found` holds; else `end`.
    pub(crate) fn find(&self, mut i: usize, end: usize, found: impl Fn(usize) -> bool) -> usize {
        while i < end && !found(i) {
            i = self.closing[i] + 1;
        }
        i.min(end)
    }
}

fn newlines(chars: &[char]) -> usize {
    chars.iter().filter(|c| **c == '\n').count()
}

/// Where the string or character ends whose text begins at `i`.
fn quoted(chars: &[char], mut i: usize, quote: char) -> usize {
    while i < chars.len() && chars[i] != quote {
        i += if chars[i] == '\\' { 2 } else { 1 };
    }
    (i + 1).min(chars.len())
}

/// Where the block comment that begins at `i` ends; they nest.
fn block_comment(chars: &[char], mut i: usize) -> usize {
    let mut depth = 0;
    while i < chars.len() {
        match (chars[i], chars.get(i + 1)) {
            ('/', Some('*')) => {
                depth += 1;
                i += 2;
            }
            ('*', Some('/')) => {
                depth -= 1;
                i += 2;
                if depth == 0 {
                    break;
                }
            }
            _ => i += 1,
        }
    }
    i
}

/// Where the raw string whose hashes or quote begin at `i` ends.
fn raw_string(chars: &[char], mut i: usize) -> usize {
    let hashes = chars[i..].iter().take_while(|c| **c == '#').count();
    i += hashes + 1;
    while i < chars.len() {
        if chars[i] == '"' && chars[i + 1..].iter().take_while(|c| **c == '#').count() >= hashes {
            return i + 1 + hashes;
        }
        i += 1;
    }
    i
}
