//! What a file declares, imports and mentions, read from its tokens in one pass.

use super::syntax::{aliased, implemented, only_tests, tree, variants};
use super::text::{Text, Token};

/// A file, read.
pub(crate) struct Outline {
    /// The file's own module first, then those that are written out in it.
    pub(crate) modules: Vec<Module>,
    pub(crate) mentions: Vec<Mention>,
    pub(crate) text: Text,
}

/// A module and the names in its scope.
pub(crate) struct Module {
    pub(crate) path: String,
    pub(crate) names: Vec<Name>,
    pub(crate) imports: Vec<Import>,
}

/// Something that is declared.
pub(crate) struct Name {
    pub(crate) name: String,
    pub(crate) what: What,
    /// Whether other files can see it.
    pub(crate) public: bool,
    /// Whether only tests compile it.
    pub(crate) in_test: bool,
    pub(crate) line: usize,
}

pub(crate) enum What {
    Module,
    /// With names and lines of its variants.
    Enum(Vec<(String, usize)>),
    /// `type` with the path that it is another name of.
    Alias(Vec<String>),
    /// Nothing lies inside of it, whatever else has its name.
    Function,
    Other,
}

/// A leaf of a `use`.
pub(crate) struct Import {
    /// As written: `super`, `world`, `World`.
    pub(crate) path: Vec<String>,
    /// What it is called here; `None` of `*`.
    pub(crate) name: Option<String>,
    /// Whether it is exported again.
    pub(crate) public: bool,
    pub(crate) in_test: bool,
    /// Whether it stands inside of a function.
    pub(crate) local: bool,
    pub(crate) line: usize,
}

/// A path in code, a method that is called, or a string.
pub(crate) struct Mention {
    /// As written, with `Self` spelled out: `Kind`, `Flight`; a method as `.sin`, a macro `println!`, a string `"tum`.
    pub(crate) path: Vec<String>,
    /// Index of its module.
    pub(crate) module: usize,
    /// Index of its first token.
    pub(crate) at: usize,
    pub(crate) line: usize,
    pub(crate) in_test: bool,
}

/// What a pair of braces holds.
enum Frame {
    Module,
    /// An `impl` of the type with this path.
    Impl(Vec<String>),
    Body,
}

struct Open {
    frame: Frame,
    module: usize,
    in_test: bool,
    /// Brackets other than braces that are open inside.
    inside: usize,
}

struct Reader {
    out: Outline,
    open: Vec<Open>,
    /// What the next brace opens, once an item's name was read.
    next: Option<(Frame, usize)>,
    /// What stands before the next item: whether only tests compile it, and whether it is public.
    in_test: bool,
    public: bool,
}

impl Outline {
    /// Reads `text`, which is the module called `module`.
    pub(crate) fn new(module: &str, text: &str) -> Self {
        let own = Module { path: module.into(), names: Vec::new(), imports: Vec::new() };
        let out = Self { modules: vec![own], mentions: Vec::new(), text: Text::new(text) };
        let in_test = module.split("::").any(|part| part == "tests");
        let root = Open { frame: Frame::Module, module: 0, in_test, inside: 0 };
        let mut reader = Reader { out, open: vec![root], next: None, in_test: false, public: false };
        let mut i = 0;
        while i < reader.out.text.tokens.len() {
            i = reader.step(i);
        }
        reader.out
    }
}

impl Reader {
    fn top(&mut self) -> &mut Open {
        self.open.last_mut().expect("the file itself is never closed")
    }

    fn testing(&self) -> bool {
        self.in_test || self.open.last().is_some_and(|open| open.in_test)
    }

    /// Takes what begins at token `i`; returns where it ends.
    fn step(&mut self, i: usize) -> usize {
        let between_items = self.top().inside == 0;
        let in_body = matches!(self.top().frame, Frame::Body);
        match &self.out.text.tokens[i] {
            Token::Other('#') => self.in_test |= only_tests(&self.out.text, i),
            Token::Other('{') => self.opens(),
            Token::Other('}') => self.closes(),
            Token::Other('(' | '[') => self.top().inside += 1,
            Token::Other(')' | ']') => self.top().inside = self.top().inside.saturating_sub(1),
            Token::Other(';') if between_items => self.ends(),
            Token::Other(',') if between_items && in_body => self.in_test = false,
            Token::Other('.') => return self.method(i),
            Token::Word(_) => return self.word(i),
            Token::Quoted(string) => {
                let path = vec![format!("\"{string}")];
                self.mention(path, i);
            }
            _ => {}
        }
        i + 1
    }

    fn opens(&mut self) {
        let in_test = self.testing();
        let module = self.top().module;
        let (frame, module) = self.next.take().unwrap_or((Frame::Body, module));
        self.open.push(Open { frame, module, in_test, inside: 0 });
        (self.in_test, self.public) = (false, false);
    }

    fn closes(&mut self) {
        if self.open.len() > 1 {
            self.open.pop();
        }
        self.ends();
    }

    fn ends(&mut self) {
        self.next = None;
        (self.in_test, self.public) = (false, false);
    }

    fn method(&mut self, i: usize) -> usize {
        let text = &self.out.text;
        let range = i > 0 && text.is(i - 1, '.');
        match text.word(i + 1) {
            Some(name) if !range && !text.is(i + 1, '.') => {
                if text.is(i + 2, '(') {
                    let path = vec![format!(".{name}")];
                    self.mention(path, i + 1);
                }
                i + 2
            }
            _ => i + 1,
        }
    }

    fn word(&mut self, i: usize) -> usize {
        let at_items = matches!(self.top().frame, Frame::Module) && self.next.is_none();
        let text = &self.out.text;
        let (word, following) = (text.word(i).unwrap_or_default(), text.word(i + 1));
        match word {
            "pub" => {
                self.public = true;
                if self.out.text.is(i + 1, '(') { self.out.text.closing[i + 1] + 1 } else { i + 1 }
            }
            "use" if !text.is(i + 1, '<') => self.import(i + 1),
            "mod" if following.is_some() => self.module(i),
            "impl" if at_items || (i > 0 && (text.is(i - 1, '}') || text.is(i - 1, ';'))) => {
                let of = implemented(text, i + 1);
                self.next = Some((Frame::Impl(of), self.top().module));
                i + 1
            }
            "macro_rules" if text.is(i + 1, '!') => self.item(i, i + 2),
            "static" if at_items && following == Some("mut") => self.item(i, i + 2),
            "const" if following == Some("fn") => i + 1,
            "fn" | "struct" | "enum" | "union" | "trait" | "type" | "const" | "static" if following.is_some() => {
                if at_items {
                    self.item(i, i + 1)
                } else {
                    i + 2
                }
            }
            _ => self.path(i),
        }
    }

    /// An item whose keyword is at `i` and whose name is at `named`.
    fn item(&mut self, i: usize, named: usize) -> usize {
        let text = &self.out.text;
        let Some(name) = text.word(named).map(str::to_owned) else { return named };
        let what = match text.word(i) {
            Some("enum") => What::Enum(variants(text, named)),
            Some("type") => What::Alias(aliased(text, named)),
            Some("fn") => What::Function,
            _ => What::Other,
        };
        let (line, public, in_test) = (text.lines[i], self.public, self.testing());
        let module = self.top().module;
        self.out.modules[module].names.push(Name { name, what, public, in_test, line });
        self.next = Some((Frame::Body, module));
        named + 1
    }

    fn module(&mut self, i: usize) -> usize {
        let text = &self.out.text;
        let name = text.word(i + 1).unwrap_or_default().to_owned();
        let (line, public, in_test) = (text.lines[i], self.public, self.testing());
        let inline = text.is(i + 2, '{');
        if !inline && !text.is(i + 2, ';') {
            return i + 1;
        }
        let parent = self.top().module;
        let path = format!("{}::{name}", self.out.modules[parent].path);
        self.out.modules[parent].names.push(Name { name, what: What::Module, public, in_test, line });
        if inline {
            self.out.modules.push(Module { path, names: Vec::new(), imports: Vec::new() });
            self.next = Some((Frame::Module, self.out.modules.len() - 1));
        }
        i + 2
    }

    fn import(&mut self, i: usize) -> usize {
        let mut leaves = Vec::new();
        let end = tree(&self.out.text, i, &[], &mut leaves);
        let (public, in_test) = (self.public, self.testing());
        let (local, module) = (matches!(self.top().frame, Frame::Body), self.top().module);
        self.out.modules[module].imports.extend(leaves.into_iter().map(|(path, name, line)| Import {
            path,
            name,
            public,
            in_test,
            local,
            line,
        }));
        end
    }

    /// A path in code whose first word is at `i`.
    fn path(&mut self, i: usize) -> usize {
        let text = &self.out.text;
        let (mut path, mut end) = (Vec::new(), i);
        while let Some(word) = text.word(end) {
            path.push(word.to_owned());
            end += 1;
            if !text.separates(end) || text.word(end + 1).is_none() {
                break;
            }
            end += 1;
        }
        let continues = i > 1 && text.separates(i - 1) && text.is(i - 2, '>');
        let lifetime = i > 0 && text.is(i - 1, '\'');
        let macro_name = path.len() == 1 && text.is(end, '!') && !text.is(end + 1, '=');
        if macro_name {
            path[0].push('!');
            if matches!(self.top().frame, Frame::Module) && self.next.is_none() {
                // What a macro makes of items is in scope as they are.
                self.next = Some((Frame::Module, self.top().module));
            }
        } else if path[0] == "Self"
            && let Some(of) = self.open.iter().rev().find_map(|open| match &open.frame {
                Frame::Impl(of) => Some(of.clone()),
                _ => None,
            })
        {
            path.splice(0..1, of);
        }
        let telling =
            path.len() > 1 || macro_name || path[0].starts_with(char::is_uppercase) || self.out.text.is(end, '(');
        if telling && !continues && !lifetime {
            self.mention(path, i);
        }
        end
    }

    fn mention(&mut self, path: Vec<String>, at: usize) {
        let (module, in_test, line) = (self.top().module, self.testing(), self.out.text.lines[at]);
        self.out.mentions.push(Mention { path, module, at, line, in_test });
    }
}
