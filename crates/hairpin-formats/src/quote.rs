//! What is quoted of files in messages, cut to what a reader can take in: a cell may be megabytes long.

use std::borrow::Cow;

use hairpin::judgement::is_command;

/// Characters of a word that are quoted whole: as many as paths may have, and some.
const LONGEST_WORD: usize = 1_000;
/// What is left of a longer one.
const OF_WORD: usize = 60;
/// Characters of a text that are quoted whole.
const LONGEST: usize = 20_000;
/// What is left of the beginning of a longer one: where it is …
const OF_BEGINNING: usize = 2_000;
/// … and of its end: what it must be.
const OF_END: usize = 1_000;

/// `text` with words and a middle that nobody would read left out, and how much that was: `aaa… (3000000 characters)`.
pub fn shortened(text: &str) -> Cow<'_, str> {
    if text.len() <= LONGEST_WORD {
        return text.into();
    }
    let text = with_short_words(text);
    let characters = text.chars().count();
    if characters <= LONGEST {
        return text;
    }
    let beginning: String = text.chars().take(OF_BEGINNING).collect();
    let end: String = text.chars().skip(characters - OF_END).collect();
    let left_out = characters - OF_BEGINNING - OF_END;
    format!("{beginning}… ({left_out} characters left out) …{end}").into()
}

fn with_short_words(text: &str) -> Cow<'_, str> {
    let long = |word: &str| word.len() > LONGEST_WORD && word.chars().count() > LONGEST_WORD;
    if !text.split(char::is_whitespace).any(long) {
        return text.into();
    }
    let mut out = String::new();
    for piece in text.split_inclusive(char::is_whitespace) {
        let word = piece.trim_end_matches(char::is_whitespace);
        if long(word) {
            // Whoever quotes it closes the quotes behind it.
            let closing = word.trim_end_matches(['`', '"', '\'', ',', ':', ';', ')', '.', ']']).len();
            out.extend(word.chars().take(OF_WORD));
            out += &format!("… ({} characters)", word[..closing].chars().count());
            out += if word.len() - closing <= OF_WORD { &word[closing..] } else { "" };
        } else {
            out += word;
        }
        out += &piece[word.len()..];
    }
    out.into()
}

/// `text` as a shell takes it for one word.
pub fn shell_word(text: &str) -> Cow<'_, str> {
    shlex::try_quote(text).unwrap_or(Cow::Borrowed(text))
}

/// As much of a cell as a message holds.
pub fn cell(text: &str) -> String {
    const MOST: usize = 80;
    if text.chars().nth(MOST).is_none() { text.into() } else { text.chars().take(MOST).chain(['…']).collect() }
}

/// A name on one line, whatever is in it: what would begin another line, or command a terminal, is written out.
pub fn on_one_line(name: &str) -> Cow<'_, str> {
    if !name.contains(is_command) {
        return name.into();
    }
    name.chars().map(|c| if is_command(c) { c.escape_default().to_string() } else { c.to_string() }).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_short_stays_and_what_is_long_says_how_long_it_was() {
        for whole in ["", "a.csv, line 2, column `x_m`: `abc`, must be a number", &"a ".repeat(9_000)] {
            assert_eq!(shortened(whole), *whole);
        }
        let cell = "9".repeat(3_000_000);
        let told = shortened(&format!("a.csv, line 2: `{cell}`, must be a number")).into_owned();
        let start = format!("a.csv, line 2: `{}… (3000001 characters)`, must be a number", "9".repeat(59));
        assert_eq!(told, start);
        let rows = "1 2 3\n".repeat(500_000);
        let told = shortened(&format!("a.csv: `{rows}`, must be a number")).into_owned();
        assert!(told.len() < 4_000 && told.starts_with("a.csv: `1 2 3") && told.ends_with("`, must be a number"));
        assert!(told.contains("characters left out"));
        assert!(shortened(&"ü".repeat(5_000)).len() < 200);
    }

    #[test]
    fn names_begin_no_line() {
        assert_eq!(on_one_line("rock"), "rock");
        assert_eq!(on_one_line("a\nPASS\u{1b}"), "a\\nPASS\\u{1b}");
        assert_eq!(on_one_line("a\u{202e}SSAP"), "a\\u{202e}SSAP");
    }
}
