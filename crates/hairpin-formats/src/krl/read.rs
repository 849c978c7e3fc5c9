//! Programs read from KRL, line by line.

use hairpin::trajectory::program::{PoseTarget, Tool};
use thiserror::Error;

use super::data::{Position, frame, load, number, position};
use super::lines::{POSITIONS, first_word, is_declaration, name_of, without_comment};
use super::state::{Reader, named};
use super::{CONVENTIONS, JOINT_MOVES};
use crate::banner::NOTICE;
use crate::listing::{Class, Declared, File, Module, Part, Unmodelled, calls, decode};

/// Why a file is no program.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum NoProgram {
    /// No `DEF name ( )` anywhere.
    #[error("no KRL program in it: no line says DEF and a name")]
    Absent,
}

/// Reads a program from its `.src` and the positions from its `.dat`; their lines are counted through.
///
/// # Errors
/// [`NoProgram`]; all else that is not followed is told by line, and the moves before it are certain.
pub fn read(src: File<'_>, dat: Option<File<'_>>) -> Result<Module, NoProgram> {
    let mut reader = Reader::default();
    let text = decode(src.bytes);
    let count = text.matches('\n').count() + 1;
    reader.reading.parts.push(Part { name: src.name.into(), first_line: 1 });
    if let Some(dat) = dat {
        reader.reading.parts.push(Part { name: dat.name.into(), first_line: count + 1 });
        for (index, line) in decode(dat.bytes).split('\n').enumerate() {
            reader.data(count + 1 + index, without_comment(line));
        }
    }
    // Declarations stand before what is executed, wherever they stand.
    for (index, line) in text.split('\n').enumerate() {
        let statement = without_comment(line);
        if is_declaration(statement) {
            reader.data(index + 1, statement);
        }
    }
    let mut state = Where::Before;
    let mut defined = None;
    for (index, line) in text.split('\n').enumerate() {
        let number = index + 1;
        if state == Where::Head {
            match line.trim().strip_prefix(';') {
                Some(comment) => {
                    reader.head(comment);
                    continue;
                }
                None => state = Where::Within,
            }
        }
        let statement = without_comment(line);
        let word = first_word(statement).to_ascii_uppercase();
        match (word.as_str(), state) {
            _ if statement.is_empty() => {}
            ("DEF" | "GLOBAL", Where::Before) if defined.is_none() && name_of(statement).is_some() => {
                defined = Some(number);
                reader.reading.program.name = name_of(statement).unwrap_or_default();
                state = Where::Head;
            }
            ("END", Where::Within) => state = Where::After,
            (_, Where::Within) if !is_declaration(statement) => reader.statement(number, &word, statement),
            (_, Where::After) => reader.reading.mark(number, Class::Unreached, "another routine"),
            _ => {}
        }
    }
    let line = defined.ok_or(NoProgram::Absent)?;
    if state != Where::After {
        reader.reading.cut_short(&text, "END");
    }
    let program = &mut reader.reading.program;
    program.procedure = program.name.clone();
    Ok(reader.reading.done(line))
}

/// Where the lines of a `.src` stand.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Where {
    Before,
    /// Comments right below DEF.
    Head,
    Within,
    /// Behind END.
    After,
}

/// Statements that neither move the arm nor change how it moves.
const HARMLESS: [&str; 11] =
    ["WAIT", "HALT", "CONTINUE", "PULSE", "SIGNAL", "ANOUT", "ANIN", "DIGIN", "MSGNOTIFY", "CWRITE", "SWRITE"];

/// System data that has nothing to do with motion.
const HARMLESS_DATA: [&str; 6] = ["$OUT", "$ADVANCE", "$ANOUT", "$TIMER", "$FLAG", "$CYCFLAG"];

/// Functions that give a value and do nothing, and words that may stand before brackets.
const VALUES: [&str; 32] = [
    "ABS",
    "ACOS",
    "AND",
    "ATAN2",
    "B_AND",
    "B_EXOR",
    "B_NOT",
    "B_OR",
    "COS",
    "DELAY",
    "EXOR",
    "FOR",
    "FORWARD",
    "INVERSE",
    "MAXIMUM",
    "MINIMUM",
    "NOT",
    "ON",
    "OR",
    "ROUND",
    "SEC",
    "SIN",
    "SQRT",
    "STRADD",
    "STRCLEAR",
    "STRCOMP",
    "STRCOPY",
    "STRDECLLEN",
    "STRFIND",
    "STRLEN",
    "TAN",
    "VARSTATE",
];

/// What a statement calls that is not known to give a value alone.
fn called<'s>(word: &str, statement: &'s str) -> Option<&'s str> {
    // Behind the statement's own word, and behind system data, brackets are its arguments.
    let is_quiet = |name: &&str| [word].iter().chain(&VALUES).any(|known| name.eq_ignore_ascii_case(known));
    calls(statement).into_iter().find(|name| !is_quiet(name))
}

impl Reader {
    fn head(&mut self, comment: &str) {
        let comment = comment.strip_prefix(' ').unwrap_or(comment).trim_end();
        if comment != NOTICE && !CONVENTIONS.contains(&comment) && !comment.starts_with(JOINT_MOVES) {
            self.reading.header.push(comment.into());
        }
    }

    /// `DECL E6POS Xp0={…}`.
    fn data(&mut self, line: usize, statement: &str) {
        if !is_declaration(statement) {
            return;
        }
        let mut words: Vec<&str> = statement.split('=').next().unwrap_or_default().split_whitespace().collect();
        words.retain(|word| !["DECL", "GLOBAL", "CONST"].iter().any(|before| word.eq_ignore_ascii_case(before)));
        let is_position =
            words.first().is_some_and(|kind| POSITIONS.iter().any(|known| kind.eq_ignore_ascii_case(known)));
        let (true, [_, name]) = (is_position, &words[..]) else {
            return self.reading.mark(line, Class::Harmless, "");
        };
        let value = match statement.split_once('=') {
            Some((_, value)) => position(value),
            None => Err("has no value".into()),
        };
        match &value {
            Ok(_) => self.reading.mark(line, Class::Understood, ""),
            // It matters where it is used.
            Err(what) => self.reading.mark(line, Class::Harmless, format!("`{name}` {what}")),
        }
        if let Ok(Position::Pose { pose, external, .. }) = &value {
            let named = named(name);
            let target = PoseTarget { external: *external, name: named.clone(), ..PoseTarget::unnamed(*pose) };
            let name = named.unwrap_or_else(|| (*name).into());
            self.reading.targets.push(Declared { line, name, target: Ok(target) });
        }
        self.positions.insert(name.to_ascii_uppercase(), value);
    }

    fn statement(&mut self, line: usize, word: &str, statement: &str) {
        match word {
            "PTP" | "LIN" | "CIRC" => {
                if let Err(what) = self.go(line, word, statement[word.len()..].trim()) {
                    self.reading.mistake(line, what);
                }
            }
            "PTP_REL" | "LIN_REL" | "CIRC_REL" | "SPLINE" | "SPTP" | "SLIN" | "SCIRC" => {
                let doubt = (Some(Unmodelled::Interpolation), format!("{word} is not followed"));
                self.reading.doubt(line, doubt);
            }
            "TRIGGER" => self.reading.doubt(line, (Some(Unmodelled::Triggers), "TRIGGER is not followed".into())),
            "INTERRUPT" => {
                self.reading.doubt(line, (Some(Unmodelled::Interrupts), "INTERRUPT is not followed".into()));
            }
            "BAS" => self.basics(line, statement),
            _ if word.starts_with('$') && statement.contains('=') => self.set(line, statement),
            _ if HARMLESS.contains(&word) => self.aside(line, word, statement),
            _ => self.reading.doubt(line, (None, format!("`{}` is not followed", word.escape_default()))),
        }
    }

    /// What has nothing to do with motion, unless something in it is called that has.
    fn aside(&mut self, line: usize, word: &str, statement: &str) {
        match called(word, statement) {
            None => self.reading.mark(line, Class::Harmless, ""),
            Some(name) => self.reading.doubt(line, (None, format!("`{}` is not followed", name.escape_default()))),
        }
    }

    /// `BAS (#INITMOV,0)`, `BAS (#VEL_PTP,30)`.
    fn basics(&mut self, line: usize, statement: &str) {
        let inside = statement.split_once('(').map_or("", |(_, inside)| inside);
        let what = inside.split([',', ')']).next().unwrap_or_default().trim().to_ascii_uppercase();
        match what.as_str() {
            "#INITMOV" | "#VEL_PTP" | "#ACC_PTP" => self.reading.mark(line, Class::Understood, ""),
            _ => self.reading.doubt(line, (Some(Unmodelled::Speeds), format!("BAS ({what}) is not followed"))),
        }
    }

    fn carry(&mut self, load: Tool) {
        self.load = Some(load);
        if let Some(tool) = self.tool {
            self.tool = Some(self.add_tool(self.reading.program.tools[tool].tcp));
        }
    }

    /// `$TOOL={…}`.
    fn set(&mut self, line: usize, statement: &str) {
        let (name, value) = statement.split_once('=').unwrap_or((statement, ""));
        let (name, value) = (name.trim().to_ascii_uppercase(), value.trim());
        let set = match name.as_str() {
            "$TOOL" => frame(value).map(|tcp| self.tool = Some(self.add_tool(tcp))),
            "$BASE" => frame(value).map(|base| self.base = Some(self.add_base(base))),
            "$VEL.CP" => above_zero(value).map(|speed| self.speed = Some(speed)),
            "$VEL.ORI1" => above_zero(value).map(|speed| self.turning = Some(speed)),
            "$VEL.ORI2" => above_zero(value).map(drop),
            "$APO.CDIS" => above_zero(value).map(|near| self.near = Some(near / 1000.0)),
            "$LOAD" => match load(value) {
                // What is carried from the beginning on is the tool's.
                Ok(carried) if self.reading.program.moves.is_empty() => {
                    self.carry(carried);
                    Ok(())
                }
                _ => {
                    let doubt = (Some(Unmodelled::Payload), "$LOAD is not followed".into());
                    return self.reading.doubt(line, doubt);
                }
            },
            _ if HARMLESS_DATA.iter().any(|known| name.starts_with(known)) => {
                return self.aside(line, "", statement);
            }
            _ if ["$VEL", "$ACC", "$OV_PRO"].iter().any(|known| name.starts_with(known)) => {
                let doubt = (Some(Unmodelled::Speeds), format!("{} is not followed", name.escape_default()));
                return self.reading.doubt(line, doubt);
            }
            _ => return self.reading.doubt(line, (None, format!("{} is not followed", name.escape_default()))),
        };
        match set {
            Ok(()) => self.reading.mark(line, Class::Understood, ""),
            Err(what) => self.reading.doubt(line, (None, format!("{name} {what}"))),
        }
    }
}

fn above_zero(text: &str) -> Result<f64, String> {
    number(text).filter(|value| *value >= 0.0).ok_or_else(|| "is no number that is known".into())
}
