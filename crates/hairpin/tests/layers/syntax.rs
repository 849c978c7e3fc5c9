//! The pieces of grammar that declarations are made of: trees of `use`, heads of `impl`, variants, other names.

use super::text::{Text, Token};

/// A leaf of a `use`: its path, what it is called (`None` of `*`), and its line.
pub(crate) type Leaf = (Vec<String>, Option<String>, usize);

/// The feature by which a library has its unit tests within it.
const WITHIN: &str = "unit-tests";

/// Whether the attribute at `i` is `#[cfg(test)]`, `#[cfg(feature = "unit-tests")]` or `#[test]`.
pub(crate) fn only_tests(text: &Text, i: usize) -> bool {
    let (word, of) = (text.word(i + 2), text.word(i + 4));
    let within = || of == Some("feature") && text.tokens.get(i + 6) == Some(&Token::Quoted(WITHIN.to_owned()));
    text.is(i + 1, '[') && (word == Some("test") || (word == Some("cfg") && (of == Some("test") || within())))
}

/// The type that the `impl` implements whose generics or path begin at `i`.
pub(crate) fn implemented(text: &Text, i: usize) -> Vec<String> {
    let end = text.find(i, text.tokens.len(), |i| text.is(i, '{') || text.is(i, ';'));
    let (mut depth, mut path, mut done) = (0_usize, Vec::new(), false);
    for at in i..end {
        match &text.tokens[at] {
            Token::Other('<') => depth += 1,
            Token::Other('>') if !text.is(at - 1, '-') => depth = depth.saturating_sub(1),
            Token::Word(word) if depth == 0 && word == "for" => (path, done) = (Vec::new(), false),
            Token::Word(word) if depth == 0 && word == "where" => done = true,
            Token::Word(word) if depth == 0 && !done && word != "dyn" && word != "mut" && !text.is(at - 1, '\'') => {
                path.push(word.clone());
                done = !text.separates(at + 1);
            }
            _ => {}
        }
    }
    path
}

/// The leaves of the tree of a `use` that begins at `i` below `prefix`: path, name and line; returns where it ends.
pub(crate) fn tree(text: &Text, mut i: usize, prefix: &[String], out: &mut Vec<Leaf>) -> usize {
    let line = text.lines.get(i).copied().unwrap_or_default();
    let mut path = prefix.to_vec();
    let mut alias = None;
    while i < text.tokens.len() {
        match &text.tokens[i] {
            Token::Word(word) if word == "as" => {
                alias = text.word(i + 1).map(str::to_owned);
                i += 1;
            }
            Token::Word(word) if word == "self" && !path.is_empty() => {}
            Token::Word(word) => path.push(word.clone()),
            Token::Other('*') => {
                out.push((path, None, line));
                return i + 1;
            }
            Token::Other('{') => {
                let end = text.closing[i];
                i += 1;
                while i < end {
                    i = tree(text, i, &path, out) + 1;
                }
                return end + 1;
            }
            Token::Other(',' | '}' | ';') => break,
            _ => {}
        }
        i += 1;
    }
    if path.len() > prefix.len() || alias.is_some() || !prefix.is_empty() {
        let name = alias.or_else(|| path.last().cloned());
        out.push((path, name, line));
    }
    i
}

/// The variants of the enum whose name is at `named`.
pub(crate) fn variants(text: &Text, named: usize) -> Vec<(String, usize)> {
    let open = text.find(named, text.tokens.len(), |i| text.is(i, '{'));
    let end = text.closing.get(open).copied().unwrap_or(open);
    let (mut out, mut i) = (Vec::new(), open + 1);
    while i < end {
        if text.is(i, '#') {
            i += 1; // the attribute's brackets are skipped below
        } else if let Some(word) = text.word(i) {
            out.push((word.to_owned(), text.lines[i]));
            i = text.find(i, end, |i| text.is(i, ','));
        }
        i = text.closing.get(i).map_or(end, |closing| closing + 1);
    }
    out
}

/// The path that the `type` whose name is at `named` is another name of; empty of anything but a path.
pub(crate) fn aliased(text: &Text, named: usize) -> Vec<String> {
    let end = text.find(named, text.tokens.len(), |i| text.is(i, ';'));
    let mut i = text.find(named, end, |i| text.is(i, '=')) + 1;
    let mut path = Vec::new();
    while let Some(word) = text.word(i).filter(|_| i < end) {
        path.push(word.to_owned());
        i += if text.separates(i + 1) { 2 } else { end };
    }
    path
}
