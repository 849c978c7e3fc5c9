//! A file of URScript as functions and statements, in the order of its lines.

/// A line's part in what holds it.
#[derive(Debug)]
pub(super) enum Part {
    Statement {
        line: usize,
        text: String,
        /// Whether it stands in a block that is no function.
        inside: bool,
    },
    /// A function is defined: its index.
    Function(usize),
}

/// `def name():` … `end`.
#[derive(Debug)]
pub(super) struct Function {
    pub(super) name: String,
    pub(super) line: usize,
    /// Whether it takes arguments.
    pub(super) takes: bool,
    /// The function that it is defined in.
    pub(super) within: Option<usize>,
    pub(super) body: Vec<Part>,
}

/// All of a file.
#[derive(Debug, Default)]
pub(super) struct Blocks {
    pub(super) functions: Vec<Function>,
    /// What stands in no function.
    pub(super) top: Vec<Part>,
    /// Comments before the first function.
    pub(super) head: Vec<String>,
    /// Lines that are no URScript, and why.
    pub(super) mistakes: Vec<(usize, String)>,
    /// Whether the file ends before an `end`.
    pub(super) is_cut: bool,
}

impl Blocks {
    pub(super) fn of(text: &str) -> Self {
        let mut all = Self::default();
        // Functions by their index, other blocks by nothing.
        let mut open: Vec<Option<usize>> = Vec::new();
        for (index, line) in text.split('\n').enumerate() {
            let number = index + 1;
            if all.functions.is_empty() && line.starts_with('#') {
                all.head.push(line.into());
            }
            let statement = without_comment(line);
            let within = open.iter().rev().find_map(|block| *block);
            if statement.is_empty() {
                continue;
            }
            if statement == "end" {
                if open.pop().is_none() {
                    all.mistakes.push((number, "`end` ends nothing".into()));
                }
                continue;
            }
            if let Some((name, takes)) = definition(statement) {
                if takes.is_none() {
                    all.mistakes.push((number, "expected def, a name, its parameters and a colon alone".into()));
                }
                let takes = takes.unwrap_or(true);
                let new = all.functions.len();
                all.functions.push(Function { name, line: number, takes, within, body: Vec::new() });
                all.add(within, Part::Function(new));
                open.push(Some(new));
                continue;
            }
            let inside = open.last().is_some_and(Option::is_none);
            all.add(within, Part::Statement { line: number, text: statement.into(), inside });
            if begins_block(statement) {
                open.push(None);
            }
        }
        all.is_cut = !open.is_empty();
        all
    }

    fn add(&mut self, within: Option<usize>, part: Part) {
        match within.and_then(|index| self.functions.get_mut(index)) {
            Some(function) => function.body.push(part),
            None => self.top.push(part),
        }
    }
}

/// `def name():`: the name, and whether there are parameters; nothing of these where more stands there.
fn definition(statement: &str) -> Option<(String, Option<bool>)> {
    let (name, rest) = statement.strip_prefix("def")?.split_once('(')?;
    let name = name.strip_prefix(char::is_whitespace)?.trim();
    if !name.starts_with(|c: char| c.is_alphabetic() || c == '_') {
        return None;
    }
    let parameters = rest.strip_suffix(':').and_then(|rest| rest.trim_end().strip_suffix(')'));
    let parameters = parameters.filter(|parameters| !parameters.contains([')', '(', '"', ':']));
    Some((name.into(), parameters.map(|parameters| !parameters.trim().is_empty())))
}

/// Whether an `end` belongs to it.
fn begins_block(statement: &str) -> bool {
    let word = statement.split(|c: char| !c.is_alphanumeric()).next().unwrap_or_default();
    statement.ends_with(':') && ["for", "if", "sec", "thread", "while"].contains(&word)
}

/// A statement that is one call and nothing else: its name, and what stands between the brackets.
pub(super) fn call(statement: &str) -> Option<(&str, &str)> {
    let (name, rest) = statement.split_once('(')?;
    let (mut depth, mut quoted) = (1_usize, false);
    let end = rest.char_indices().find(|(_, c)| {
        match c {
            '"' => quoted = !quoted,
            '(' if !quoted => depth += 1,
            ')' if !quoted => depth -= 1,
            _ => {}
        }
        depth == 0
    });
    let (end, _) = end?;
    rest[end + 1..].is_empty().then(|| (name.trim(), &rest[..end]))
}

/// The line without its comment and blanks; a `#` between quotes begins none.
fn without_comment(line: &str) -> &str {
    let mut quoted = false;
    let end = line.char_indices().find(|(_, c)| {
        quoted ^= *c == '"';
        *c == '#' && !quoted
    });
    line[..end.map_or(line.len(), |(at, _)| at)].trim()
}
