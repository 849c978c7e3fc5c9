//! The grammar of inequations, by recursive descent.
//!
//! ```text
//! either   = both { "or" both }
//! both     = negated { "and" negated }
//! negated  = "not" negated | compared
//! compared = sum { ("<" | "<=" | ">" | ">=") sum }     chains: 10 < z < 20
//! sum      = product { ("+" | "-") product }
//! product  = signed { ("*" | "/") signed }
//! signed   = "-" signed | power
//! power    = atom [ "^" whole number ]
//! atom     = number | x | y | z | "(" either or sum ")" | sqrt(…) | abs(…) | min(…, …) | max(…, …)
//! ```
//!
//! One pass over tokens, no backtracking: a parenthesis may hold a number or a condition, and what it was is asked
//! where it is used. Bounded in tokens and depth, since texts come from strangers.

use thiserror::Error;

use super::condition::{Condition, Term};

/// Why a text is no inequation.
///
/// `Display` says column, expectation and finding, as the command line underlines it.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
#[error("column {column}: expected {expected}, found {found}")]
pub struct WordsError {
    /// Column of the mistake, from 1, in characters.
    pub column: usize,
    /// What could stand there.
    pub expected: String,
    /// What does.
    pub found: String,
}

/// The condition that `text` is.
///
/// At most 1000 tokens, 100 nested parentheses, exponents to 64. Names in any case.
///
/// # Errors
/// [`WordsError`]: the first place that cannot be read.
pub(super) fn condition(text: &str) -> Result<Condition, WordsError> {
    let mut parser = Parser::new(text)?;
    let read = parser.either()?;
    let condition = parser.condition(read)?;
    if parser.next < parser.tokens.len() {
        return Err(parser.expected("the end, and, or, or an operator"));
    }
    Ok(condition)
}

/// A number is what the machine made of the written one.
///
/// Words in lower case, signs by their text.
#[derive(Debug, Clone, PartialEq)]
enum Token {
    Number(f64),
    Word(String),
    Sign(&'static str),
}

/// What a parenthesis may hold.
///
/// What the grammar calls sum and either: told apart when an operator or the whole asks for one of them.
enum Value {
    Term(Term),
    Condition(Condition),
}

/// `next` is the token that is read next, `end` the column behind the text, `depth` that of nesting.
struct Parser {
    /// With the column of each.
    tokens: Vec<(usize, Token)>,
    next: usize,
    end: usize,
    depth: usize,
}

/// Longest signs first.
const SIGNS: [&str; 12] = ["<=", ">=", "<", ">", "+", "-", "*", "/", "^", "(", ")", ","];
/// Parentheses in parentheses, at most.
const DEEPEST: usize = 100;
/// Numbers, names and signs in a text, at most.
const LONGEST: usize = 1000;
/// Largest exponent.
const HIGHEST: u32 = 64;

impl Parser {
    /// Cuts the text into tokens.
    ///
    /// # Errors
    /// A character that begins none, a number that is none, more than 1000 tokens.
    fn new(text: &str) -> Result<Self, WordsError> {
        let characters: Vec<char> = text.chars().collect();
        let (mut tokens, mut at) = (Vec::new(), 0);
        while at < characters.len() {
            let (column, first) = (at + 1, characters[at]);
            let run = |mut holds: Box<dyn FnMut(usize, char) -> bool>| {
                let length = characters[at..].iter().enumerate().take_while(|(i, c)| holds(*i, **c)).count();
                (characters[at..at + length].iter().collect::<String>(), length)
            };
            let wrong = |found: &str| WordsError {
                column,
                expected: "a number, x, y, z, an operator or a parenthesis".into(),
                found: format!("`{found}`"),
            };
            if first.is_whitespace() {
                at += 1;
                continue;
            }
            let sign = SIGNS.iter().find(|sign| characters[at..].iter().take(sign.len()).copied().eq(sign.chars()));
            if let Some(sign) = sign {
                tokens.push((column, Token::Sign(sign)));
                at += sign.len();
            } else if first.is_ascii_digit() || first == '.' {
                let mut before = ' ';
                let (digits, length) = run(Box::new(move |_, c| {
                    let takes = c.is_ascii_digit() || ".eE".contains(c) || ("+-".contains(c) && "eE".contains(before));
                    before = c;
                    takes
                }));
                let value = digits.parse::<f64>().ok().filter(|value| value.is_finite());
                tokens.push((column, Token::Number(value.ok_or_else(|| wrong(&digits))?)));
                at += length;
            } else if first.is_alphabetic() {
                let (word, length) = run(Box::new(|_, c| c.is_alphanumeric() || c == '_'));
                tokens.push((column, Token::Word(word.to_lowercase())));
                at += length;
            } else {
                return Err(wrong(&first.to_string()));
            }
        }
        let parser = Self { next: LONGEST.min(tokens.len()), tokens, end: characters.len() + 1, depth: 0 };
        if parser.tokens.len() > LONGEST {
            return Err(parser.expected("the end: at most 1000 numbers, names and signs"));
        }
        Ok(Self { next: 0, ..parser })
    }

    /// The mistake at the next token.
    fn expected(&self, expected: &str) -> WordsError {
        let (column, found) = match self.tokens.get(self.next) {
            Some((column, Token::Number(value))) => (*column, format!("`{value}`")),
            Some((column, Token::Word(word))) => (*column, format!("`{word}`")),
            Some((column, Token::Sign(sign))) => (*column, format!("`{sign}`")),
            None => (self.end, "the end".to_owned()),
        };
        WordsError { column, expected: expected.to_owned(), found }
    }

    /// The next token, if it is one of `signs`.
    fn takes_sign(&mut self, signs: &[&'static str]) -> Option<&'static str> {
        let Some((_, Token::Sign(sign))) = self.tokens.get(self.next) else { return None };
        let sign = signs.iter().find(|wanted| *wanted == sign)?;
        self.next += 1;
        Some(sign)
    }

    /// Whether the next token was `wanted`.
    fn takes_word(&mut self, wanted: &str) -> bool {
        let takes = matches!(self.tokens.get(self.next), Some((_, Token::Word(word))) if word == wanted);
        self.next += usize::from(takes);
        takes
    }

    /// # Errors
    /// A number where a comparison is asked for.
    fn condition(&self, value: Value) -> Result<Condition, WordsError> {
        match value {
            Value::Condition(condition) => Ok(condition),
            Value::Term(_) => Err(self.expected("a comparison: <, <=, > or >=")),
        }
    }

    /// # Errors
    /// A comparison where a number is asked for.
    fn term(&self, value: Value) -> Result<Term, WordsError> {
        match value {
            Value::Term(term) => Ok(term),
            Value::Condition(_) => Err(self.expected("a number before this, not a comparison")),
        }
    }

    /// `either` of the grammar; and so the following, each one rule.
    fn either(&mut self) -> Result<Value, WordsError> {
        let mut left = self.both()?;
        while self.takes_word("or") {
            let right = self.both()?;
            left = Value::Condition(Condition::Or(self.condition(left)?.into(), self.condition(right)?.into()));
        }
        Ok(left)
    }

    fn both(&mut self) -> Result<Value, WordsError> {
        let mut left = self.negated()?;
        while self.takes_word("and") {
            let right = self.negated()?;
            left = Value::Condition(Condition::And(self.condition(left)?.into(), self.condition(right)?.into()));
        }
        Ok(left)
    }

    fn negated(&mut self) -> Result<Value, WordsError> {
        if !self.takes_word("not") {
            return self.compared();
        }
        self.deeper(|parser| {
            let inner = parser.negated()?;
            Ok(Value::Condition(Condition::Not(parser.condition(inner)?.into())))
        })
    }

    /// A chain a < b < c is a < b and b < c; every comparison becomes a < or ≤.
    fn compared(&mut self) -> Result<Value, WordsError> {
        let first = self.sum()?;
        let Some(mut sign) = self.takes_sign(&["<=", ">=", "<", ">"]) else { return Ok(first) };
        let mut left = self.term(first)?;
        let mut all: Option<Condition> = None;
        loop {
            let right = self.sum()?;
            let right = self.term(right)?;
            let (low, high) = if sign.starts_with('<') { (left, right.clone()) } else { (right.clone(), left) };
            let one = Condition::Less { left: low, right: high, or_equal: sign.ends_with('=') };
            let joined = match all {
                Some(before) => Condition::And(before.into(), one.into()),
                None => one,
            };
            let Some(next) = self.takes_sign(&["<=", ">=", "<", ">"]) else { return Ok(Value::Condition(joined)) };
            (sign, left, all) = (next, right, Some(joined));
        }
    }

    fn sum(&mut self) -> Result<Value, WordsError> {
        let mut left = self.product()?;
        while let Some(sign) = self.takes_sign(&["+", "-"]) {
            let right = self.product()?;
            let (a, b) = (self.term(left)?.into(), self.term(right)?.into());
            left = Value::Term(if sign == "+" { Term::Add(a, b) } else { Term::Subtract(a, b) });
        }
        Ok(left)
    }

    fn product(&mut self) -> Result<Value, WordsError> {
        let mut left = self.signed()?;
        while let Some(sign) = self.takes_sign(&["*", "/"]) {
            let right = self.signed()?;
            let (a, b) = (self.term(left)?.into(), self.term(right)?.into());
            left = Value::Term(if sign == "*" { Term::Multiply(a, b) } else { Term::Divide(a, b) });
        }
        Ok(left)
    }

    fn signed(&mut self) -> Result<Value, WordsError> {
        if self.takes_sign(&["-"]).is_none() {
            return self.power();
        }
        self.deeper(|parser| {
            let inner = parser.signed()?;
            Ok(Value::Term(Term::Negative(parser.term(inner)?.into())))
        })
    }

    /// Right of `^` a whole number from 0 to 64: no function of a function.
    fn power(&mut self) -> Result<Value, WordsError> {
        let base = self.atom()?;
        if self.takes_sign(&["^"]).is_none() {
            return Ok(base);
        }
        let base = self.term(base)?;
        match self.tokens.get(self.next) {
            Some((_, Token::Number(n))) if n.fract() == 0.0 && (0.0..=f64::from(HIGHEST)).contains(n) => {
                self.next += 1;
                Ok(Value::Term(Term::Power(base.into(), *n as u32)))
            }
            _ => Err(self.expected("a whole number from 0 to 64")),
        }
    }

    fn atom(&mut self) -> Result<Value, WordsError> {
        let expected = "a number, x, y, z, sqrt, abs, min, max or a parenthesis";
        let Some((_, token)) = self.tokens.get(self.next).cloned() else { return Err(self.expected(expected)) };
        match token {
            Token::Number(value) => {
                self.next += 1;
                Ok(Value::Term(Term::Number(value)))
            }
            Token::Sign("(") => self.deeper(|parser| {
                parser.next += 1;
                let inner = parser.either()?;
                parser.takes_sign(&[")"]).map(|_| inner).ok_or_else(|| parser.expected("`)`"))
            }),
            Token::Word(word) => {
                if let Some(axis) = ["x", "y", "z"].iter().position(|axis| *axis == word) {
                    self.next += 1;
                    return Ok(Value::Term(Term::Axis(axis)));
                }
                if !["sqrt", "abs", "min", "max"].contains(&word.as_str()) {
                    return Err(self.expected(expected));
                }
                self.next += 1;
                self.deeper(|parser| parser.call(&word))
            }
            Token::Sign(_) => Err(self.expected(expected)),
        }
    }

    /// `min` and `max` have two arguments, `sqrt` and `abs` one.
    fn call(&mut self, function: &str) -> Result<Value, WordsError> {
        self.takes_sign(&["("]).ok_or_else(|| self.expected("`(`"))?;
        let first = self.sum()?;
        let first: Box<Term> = self.term(first)?.into();
        let term = if function == "sqrt" {
            Term::Sqrt(first)
        } else if function == "abs" {
            Term::Abs(first)
        } else {
            self.takes_sign(&[","]).ok_or_else(|| self.expected("`,`"))?;
            let second = self.sum()?;
            let second = self.term(second)?.into();
            if function == "min" { Term::Min(first, second) } else { Term::Max(first, second) }
        };
        self.takes_sign(&[")"]).ok_or_else(|| self.expected("`)`"))?;
        Ok(Value::Term(term))
    }

    /// Recursion that ends.
    ///
    /// `not`, a sign, a parenthesis and a call each count as one level; at most 100.
    fn deeper<T>(&mut self, read: impl FnOnce(&mut Self) -> Result<T, WordsError>) -> Result<T, WordsError> {
        if self.depth == DEEPEST {
            return Err(self.expected("fewer parentheses within one another"));
        }
        self.depth += 1;
        let value = read(self);
        self.depth -= 1;
        value
    }
}
