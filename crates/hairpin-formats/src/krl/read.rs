//! Programs read from KRL, line by line.

use hairpin::trajectory::program::{Bound, PoseTarget, Tool};
use thiserror::Error;

use super::data::{Position, frame, load, number, position};
use super::lines::{POSITIONS, first_word, name_of, without_comment};
use super::phrases::{self, is_declaration, may_be_harmless};
use super::state::{Reader, named};
use super::{CONVENTIONS, JOINT_MOVES};
use crate::banner::NOTICE;
use crate::listing::{Class, Declared, File, Module, Part, Procedure, Unmodelled, decode};

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
    let lines: Vec<&str> = text.split('\n').collect();
    let statements: Vec<&str> = lines.iter().map(|line| without_comment(line)).collect();
    let defined = statements.iter().position(|statement| name_of(statement).is_some()).ok_or(NoProgram::Absent)?;
    let is_end = |statement: &&str| first_word(statement).eq_ignore_ascii_case("END");
    let ended = statements[defined..].iter().position(is_end).map(|behind| defined + behind);
    reader.reading.parts.push(Part { name: src.name.into(), first_line: 1 });
    if let Some(dat) = dat {
        reader.reading.parts.push(Part { name: dat.name.into(), first_line: lines.len() + 1 });
        reader.data_file(lines.len() + 1, &decode(dat.bytes));
    }
    let numbered = |from: usize, to: usize| {
        let all = statements[from..to].iter().enumerate().map(move |(index, statement)| (from + index + 1, *statement));
        all.filter(|(_, statement)| !statement.is_empty())
    };
    for (line, statement) in numbered(0, defined) {
        reader.not_followed(line, format!("`{}` stands before DEF", first_word(statement).escape_default()));
    }
    reader.framed(defined + 1, statements[defined]);
    reader.reading.program.name = name_of(statements[defined]).unwrap_or_default();
    let within = ended.unwrap_or(statements.len());
    // Declarations stand before what is executed, wherever they stand.
    for (line, statement) in numbered(defined + 1, within).filter(|(_, statement)| is_declaration(statement)) {
        reader.data(line, statement);
    }
    let comments = lines[defined + 1..within].iter().map_while(|line| line.trim().strip_prefix(';'));
    comments.for_each(|comment| reader.head(comment));
    for (line, statement) in numbered(defined + 1, within).filter(|(_, statement)| !is_declaration(statement)) {
        let word = first_word(statement).to_ascii_uppercase();
        reader.statement(line, &word, statement);
    }
    match ended {
        Some(ended) => {
            reader.framed(ended + 1, statements[ended]);
            reader.others(numbered(ended + 1, statements.len()));
        }
        None => reader.reading.cut_short(&text, "END"),
    }
    let program = &mut reader.reading.program;
    program.procedure = program.name.clone();
    let procedure = Procedure { name: program.name.clone(), line: defined + 1, executed: true };
    Ok(reader.reading.done(vec![procedure]))
}

impl Reader {
    fn head(&mut self, comment: &str) {
        let comment = comment.strip_prefix(' ').unwrap_or(comment).trim_end();
        if comment != NOTICE && !CONVENTIONS.contains(&comment) && !comment.starts_with(JOINT_MOVES) {
            self.reading.header.push(comment.into());
        }
    }

    fn not_followed(&mut self, line: usize, what: String) {
        self.reading.doubt(line, (None, what));
    }

    /// A line that begins or ends a routine or a file of data: nothing stands behind it.
    fn framed(&mut self, line: usize, statement: &str) {
        if let Err(what) = phrases::frame(statement) {
            self.not_followed(line, what);
        }
    }

    /// What stands behind the routine that is followed: others.
    fn others<'s>(&mut self, statements: impl Iterator<Item = (usize, &'s str)>) {
        let mut inside = false;
        for (line, statement) in statements {
            let mut words = statement.split(|c: char| c.is_whitespace() || c == '(');
            let first = words.next().unwrap_or_default().to_ascii_uppercase();
            let word = if first == "GLOBAL" { words.next().unwrap_or_default().to_ascii_uppercase() } else { first };
            inside |= ["DEF", "DEFFCT"].contains(&word.as_str());
            match inside {
                true => self.reading.mark(line, Class::Unreached, "another routine"),
                false => self.not_followed(line, format!("`{}` stands in no routine", word.escape_default())),
            }
            inside &= !["END", "ENDFCT"].contains(&word.as_str());
        }
    }

    /// A `.dat` whose first line counts as `first`.
    fn data_file(&mut self, first: usize, text: &str) {
        let (mut begun, mut ended) = (false, false);
        for (index, line) in text.split('\n').enumerate() {
            let (line, statement) = (first + index, without_comment(line));
            let word = first_word(statement).to_ascii_uppercase();
            match word.as_str() {
                _ if statement.is_empty() => {}
                "DEFDAT" if !begun => {
                    begun = true;
                    self.framed(line, statement);
                }
                "ENDDAT" if begun && !ended => {
                    ended = true;
                    self.framed(line, statement);
                }
                _ if !begun || ended => {
                    self.not_followed(line, format!("`{}` stands beside DEFDAT and ENDDAT", word.escape_default()));
                }
                _ if is_declaration(statement) => self.data(line, statement),
                _ => match phrases::element(statement) {
                    Ok(()) => self.reading.mark(line, Class::Harmless, ""),
                    Err(what) => self.not_followed(line, what),
                },
            }
        }
        if !ended {
            let last = text.trim_end().matches('\n').count();
            self.reading.mistake(first + last, "the file ends before ENDDAT: it was cut short".into());
        }
    }

    /// `DECL E6POS Xp0={…}`.
    fn data(&mut self, line: usize, statement: &str) {
        if let Err(what) = phrases::declaration(statement) {
            return self.not_followed(line, what);
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
        let twice = self.positions.insert(name.to_ascii_uppercase(), value).is_some();
        if twice {
            self.positions.insert(name.to_ascii_uppercase(), Err("is declared twice".into()));
        }
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
            // A global one; other declarations are none of the statements.
            "INTERRUPT" | "GLOBAL" => {
                self.reading.doubt(line, (Some(Unmodelled::Interrupts), "INTERRUPT is not followed".into()));
            }
            "BAS" => self.basics(line, statement),
            _ if may_be_harmless(word) => match phrases::harmless(statement) {
                Ok(()) => self.reading.mark(line, Class::Harmless, ""),
                Err(what) => self.not_followed(line, what),
            },
            _ if word.starts_with('$') && statement.contains('=') => self.set(line, statement),
            _ => self.not_followed(line, format!("`{}` is not followed", word.escape_default())),
        }
    }

    /// `BAS (#INITMOV,0)`, `BAS (#VEL_PTP,30)`.
    fn basics(&mut self, line: usize, statement: &str) {
        let (what, value) = match phrases::basics(statement) {
            Ok(said) => said,
            Err(what) => return self.not_followed(line, what),
        };
        let field = match what.as_str() {
            "INITMOV" => return self.reading.mark(line, Class::Understood, ""),
            "VEL_PTP" => "BAS (#VEL_PTP)",
            "ACC_PTP" => "BAS (#ACC_PTP)",
            _ => {
                let doubt = (Some(Unmodelled::Speeds), format!("BAS (#{what}) is not followed"));
                return self.reading.doubt(line, doubt);
            }
        };
        match self.rate((line, field), &value, Bound::PERCENT) {
            Ok(_) => self.reading.mark(line, Class::Understood, ""),
            Err(what) => self.not_followed(line, format!("{field} {what}")),
        }
    }

    /// A number that controllers hold to a bound; nothing where it is beyond, which is told with its line.
    fn rate(&mut self, at: (usize, &'static str), text: &str, bound: Bound) -> Result<Option<f64>, String> {
        let value = number(text).ok_or("is no number that is known")?;
        self.reading.hold(at.0, at.1, value, bound);
        Ok(bound.holds(value).then_some(value))
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
            // What no controller takes has been told: moves need not tell it again.
            "$VEL.CP" => self
                .rate((line, "$VEL.CP"), value, Bound::KRL_SPEED)
                .map(|speed| self.speed = Some(speed.unwrap_or(f64::INFINITY))),
            "$VEL.ORI1" => {
                self.rate((line, "$VEL.ORI1"), value, Bound::TURNING).map(|speed| self.turning = speed.or(self.turning))
            }
            "$VEL.ORI2" => self.rate((line, "$VEL.ORI2"), value, Bound::TURNING).map(drop),
            "$APO.CDIS" => self
                .rate((line, "$APO.CDIS"), value, Bound::NOT_NEGATIVE)
                .map(|near| self.near = Some(near.unwrap_or(0.0) / 1000.0)),
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
