//! Which tokens of a text stand in patterns that decide: of `match`, `let`, `if let`, `while let` and `matches!`.

use super::text::{Text, Token};

/// For every token that stands in a pattern, the token that begins the question: `match`, `let`, `matches`.
pub(crate) fn patterns(text: &Text) -> Vec<Option<usize>> {
    let mut asked = vec![None; text.tokens.len()];
    for i in 0..text.tokens.len() {
        let ranges = match text.word(i) {
            Some("match") => arms(text, i),
            Some("let") => vec![(i + 1, text.find(i + 1, text.tokens.len(), |at| binds(text, at) || text.is(at, ';')))],
            Some("matches") if text.is(i + 1, '!') => {
                let end = text.closing.get(i + 2).copied().unwrap_or(i);
                vec![(text.find(i + 3, end, |at| text.is(at, ',')), end)]
            }
            _ => Vec::new(),
        };
        for (from, to) in ranges {
            asked.iter_mut().take(to).skip(from).for_each(|of| *of = Some(i));
        }
    }
    asked
}

/// Whether `=` stands at `at`, and neither `==`, `=>` nor `..=`.
fn binds(text: &Text, at: usize) -> bool {
    text.is(at, '=') && !text.is(at - 1, '.') && !text.is(at + 1, '=') && !text.is(at + 1, '>')
}

/// Where the patterns of the `match` at `i` are, without their guards.
fn arms(text: &Text, i: usize) -> Vec<(usize, usize)> {
    let open = text.find(i + 1, text.tokens.len(), |at| text.is(at, '{') || text.is(at, ';'));
    let mut arms = Vec::new();
    if !text.is(open, '{') {
        return arms;
    }
    let (end, mut at) = (text.closing[open], open + 1);
    while at < end {
        let arrow = text.find(at, end, |at| text.is(at, '=') && text.is(at + 1, '>'));
        let guard = text.find(at, arrow, |at| text.tokens[at] == Token::Word("if".into()));
        arms.push((at, guard));
        at = arrow + 2;
        at = match text.is(at, '{') {
            true => text.closing[at] + 1,
            false => text.find(at, end, |at| text.is(at, ',')),
        };
        if text.is(at, ',') {
            at += 1;
        }
    }
    arms
}
