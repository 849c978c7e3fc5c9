//! Which paths and methods a Rust source text mentions: enough of the language's grammar for that, and no more.

/// A path as it was written, made absolute, or a method that is called.
pub(crate) struct Seen {
    /// `hairpin::world::World`, `std::fs`, `println!`, `.sin`.
    pub(crate) path: String,
    /// Line, from 1.
    pub(crate) line: usize,
    /// Whether it stands in code that only tests compile.
    pub(crate) in_test: bool,
}

#[derive(Debug, Clone, PartialEq)]
enum Token {
    Word(String),
    PathSeparator,
    Other(char),
}

/// The paths of `text`, which is the module called `module`.
pub(crate) fn read(module: &str, text: &str) -> Vec<Seen> {
    let tokens = tokens(text);
    let test_file = module.split("::").any(|part| part == "tests");
    let mut reader = Reader { module: module.split("::").map(str::to_owned).collect(), seen: Vec::new() };
    // Inline modules that are open: the depth of their braces, and whether only tests compile them.
    let mut open: Vec<(usize, bool)> = Vec::new();
    let (mut depth, mut test_attribute, mut i) = (0, false, 0);
    while i < tokens.len() {
        let in_test = test_file || open.iter().any(|(_, test)| *test);
        match &tokens[i].0 {
            Token::Other('#') if spells(&tokens[i..], &["#", "[", "cfg", "(", "test", ")", "]"]) => {
                test_attribute = true;
                i += 7;
            }
            Token::Word(word) if word == "mod" && spells(tokens.get(i + 2..).unwrap_or_default(), &["{"]) => {
                if let Some((Token::Word(name), _)) = tokens.get(i + 1) {
                    reader.module.push(name.clone());
                }
                depth += 1;
                open.push((depth, std::mem::take(&mut test_attribute)));
                i += 3;
            }
            Token::Word(word) if word == "use" => {
                let in_test = std::mem::take(&mut test_attribute) || in_test;
                i = reader.tree(&tokens, i + 1, &mut Vec::new(), in_test);
            }
            Token::Word(_) => {
                i = reader.path(&tokens, i, in_test);
            }
            Token::Other('.') if i > 0 && tokens[i - 1].0 != Token::Other('.') => {
                if let Some((Token::Word(name), line)) = tokens.get(i + 1)
                    && spells(tokens.get(i + 2..).unwrap_or_default(), &["("])
                {
                    reader.seen.push(Seen { path: format!(".{name}"), line: *line, in_test });
                    i += 1;
                }
                i += 1;
            }
            Token::PathSeparator if matches!(tokens.get(i + 1), Some((Token::Word(_), _))) => {
                i = reader.path(&tokens, i + 1, in_test);
            }
            Token::Other('{') => {
                depth += 1;
                i += 1;
            }
            Token::Other('}') => {
                if open.last().is_some_and(|(at, _)| *at == depth) {
                    open.pop();
                    reader.module.pop();
                }
                depth = depth.saturating_sub(1);
                i += 1;
            }
            Token::Other(';') => {
                test_attribute = false;
                i += 1;
            }
            _ => i += 1,
        }
    }
    reader.seen
}

struct Reader {
    module: Vec<String>,
    seen: Vec<Seen>,
}

impl Reader {
    /// A use tree that begins at `i` below `prefix`; returns where it ends.
    fn tree(&mut self, tokens: &[(Token, usize)], mut i: usize, prefix: &mut Vec<String>, in_test: bool) -> usize {
        let (kept, line) = (prefix.len(), tokens.get(i).map_or(0, |token| token.1));
        let mut branched = false;
        while let Some((token, _)) = tokens.get(i) {
            match token {
                Token::Word(word) if word == "as" => i += 1, // the alias follows and says nothing
                Token::Word(word) => {
                    let alias = i > 0 && tokens[i - 1].0 == Token::Word("as".into());
                    if !alias {
                        prefix.push(word.clone());
                    }
                }
                Token::Other('{') => {
                    branched = true;
                    i += 1;
                    while tokens.get(i).is_some_and(|token| token.0 != Token::Other('}')) {
                        i = self.tree(tokens, i, prefix, in_test);
                        if tokens.get(i).is_some_and(|token| token.0 == Token::Other(',')) {
                            i += 1;
                        }
                    }
                }
                Token::Other(',' | '}' | ';') => break,
                _ => {}
            }
            if token != &Token::Word("as".into()) {
                i += 1;
            }
        }
        if !branched && prefix.len() > kept {
            self.note(prefix.clone(), line, in_test);
        }
        prefix.truncate(kept);
        i
    }

    /// A path in an expression or type that begins with the word at `i`; returns where it ends.
    fn path(&mut self, tokens: &[(Token, usize)], mut i: usize, in_test: bool) -> usize {
        let line = tokens[i].1;
        let mut parts = Vec::new();
        while let Some((Token::Word(word), _)) = tokens.get(i) {
            parts.push(word.clone());
            i += 1;
            if tokens.get(i).is_some_and(|token| token.0 == Token::PathSeparator) {
                i += 1;
            } else {
                break;
            }
        }
        let bang = tokens.get(i).is_some_and(|token| token.0 == Token::Other('!'));
        if bang && parts.len() == 1 {
            self.seen.push(Seen { path: format!("{}!", parts[0]), line, in_test });
        } else if parts.len() > 1 {
            self.note(parts, line, in_test);
        }
        i
    }

    /// Resolves `crate`, `self` and `super`, and keeps the path.
    fn note(&mut self, parts: Vec<String>, line: usize, in_test: bool) {
        let mut at = match parts[0].as_str() {
            "crate" => self.module[..1].to_vec(),
            "self" | "super" => self.module.clone(),
            _ => Vec::new(),
        };
        for part in parts {
            match part.as_str() {
                "crate" | "self" => {}
                "super" => drop(at.pop()),
                _ => at.push(part),
            }
        }
        self.seen.push(Seen { path: at.join("::"), line, in_test });
    }
}

fn spells(tokens: &[(Token, usize)], wanted: &[&str]) -> bool {
    tokens.len() >= wanted.len()
        && tokens.iter().zip(wanted).all(|((token, _), wanted)| match token {
            Token::Word(word) => word == wanted,
            Token::PathSeparator => *wanted == "::",
            Token::Other(c) => wanted.chars().eq([*c]),
        })
}

/// Words, path separators and other characters with their lines; comments, strings and characters left out.
fn tokens(text: &str) -> Vec<(Token, usize)> {
    let chars: Vec<char> = text.chars().collect();
    let at = |i: usize| chars.get(i).copied().unwrap_or('\0');
    let mut out = Vec::new();
    let mut i = 0;
    let mut line = 1;
    let mut counted = 0;
    while i < chars.len() {
        line += chars[counted..i].iter().filter(|c| **c == '\n').count();
        counted = i;
        let c = chars[i];
        if c == '/' && at(i + 1) == '/' {
            while i < chars.len() && chars[i] != '\n' {
                i += 1;
            }
        } else if c == '/' && at(i + 1) == '*' {
            i = block_comment(&chars, i);
        } else if c == 'r' && (at(i + 1) == '"' || (at(i + 1) == '#' && matches!(at(i + 2), '"' | '#'))) {
            i = raw_string(&chars, i + 1);
        } else if c == '"' {
            i += 1;
            while i < chars.len() && chars[i] != '"' {
                i += if chars[i] == '\\' { 2 } else { 1 };
            }
            i += 1;
        } else if c == '\'' && (at(i + 1) == '\\' || at(i + 2) == '\'') {
            i += if at(i + 1) == '\\' { 3 } else { 2 };
            while i < chars.len() && chars[i] != '\'' {
                i += 1;
            }
            i += 1;
        } else if c.is_alphanumeric() || c == '_' {
            let start = i;
            while at(i).is_alphanumeric() || at(i) == '_' {
                i += 1;
            }
            out.push((Token::Word(chars[start..i].iter().collect()), line));
        } else if c == ':' && at(i + 1) == ':' {
            out.push((Token::PathSeparator, line));
            i += 2;
        } else {
            if !c.is_whitespace() {
                out.push((Token::Other(c), line));
            }
            i += 1;
        }
    }
    out
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
