//! What is said of moves that cannot be executed, once where a loop comes back to it.

use std::collections::HashMap;

use hairpin::campaign::digits::grouped;
use hairpin::feasibility::program::Finding;
use hairpin::trajectory::program::ProgramError;
use hairpin_formats::listing::Module;

use super::follow::Follow;

/// Said of the first joint target of an arm of which nobody says how its controller tells axis 3.
const UNSAID: &str = "joint angles of a type of arm whose controller tells axis 3 against the base, \
    rax_3 = axis 3 + axis 2: whether this one's does is not said, and from here on nothing is followed \
    (joints.j23_coupled = true, or false, of the robot: --set robot.joints.j23_coupled=true)";

/// What is said of one move.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct MoveFinding {
    /// Its file.
    pub file: Option<String>,
    /// Its line there.
    pub line: Option<usize>,
    /// What kind of finding.
    pub kind: &'static str,
    /// Target before.
    pub from: Option<String>,
    /// Its target.
    pub to: Option<String>,
    /// Why it cannot be executed.
    pub reason: String,
    /// All of it in words.
    pub sentence: String,
    /// Whether it rests on bodies that are estimated.
    pub estimated: bool,
    /// Whether on nothing else, so that it is no finding but was not found out.
    pub open: bool,
    /// How often it was found: a loop comes back to its line with the same targets, and other numbers.
    pub count: usize,
    /// The first and the last move of which it was, counted from 1.
    pub moves: [usize; 2],
    /// Why the last of several could not be executed.
    pub last: Option<String>,
}

/// File, line, targets and kind of a finding, what it rests on, and which number it is of.
type What = (Option<String>, Option<usize>, [Option<String>; 2], &'static str, [bool; 2], String);

impl MoveFinding {
    /// What is the same when it comes again.
    fn what(&self) -> What {
        let ends = [self.from.clone(), self.to.clone()];
        // Several numbers of one line are several findings: they differ before the value.
        let field = self.reason.split(" = ").next().filter(|_| self.kind == "program").unwrap_or_default();
        (self.file.clone(), self.line, ends, self.kind, [self.estimated, self.open], field.into())
    }

    /// It in words, with how often it was found.
    pub fn in_words(&self) -> String {
        let Some(last) = &self.last else { return self.sentence.clone() };
        let [from, to] = self.moves;
        format!(
            "{}; {} times, from move {from} to move {to}, the last: {last}",
            self.sentence,
            grouped(self.count as u64)
        )
    }
}

/// `found`, in its order: what comes again is told with the first of it.
fn once(found: impl Iterator<Item = MoveFinding>) -> Vec<MoveFinding> {
    let (mut told, mut places): (Vec<MoveFinding>, HashMap<_, usize>) = (Vec::new(), HashMap::new());
    for one in found {
        match places.get(&one.what()) {
            // What has no line is of the whole program.
            Some(&place) if one.line.is_some() => {
                let first = &mut told[place];
                first.count += one.count;
                first.moves[1] = one.moves[1];
                first.last = Some(one.reason);
            }
            _ => {
                places.insert(one.what(), told.len());
                told.push(one);
            }
        }
    }
    told
}

/// What a controller would stop at, and what the arm cannot do, of the moves that are certain, in their order, each
/// once.
pub(super) fn findings(module: &Module, followed: Option<&Follow>) -> Vec<MoveFinding> {
    let mut certain = module.program.clone();
    certain.moves.truncate(module.certain);
    // Lines are told as those of their own files.
    let lines: Vec<Option<usize>> = certain.moves.iter().map(|m| m.line).collect();
    for m in &mut certain.moves {
        m.line = m.line.map(|line| module.place(line).1);
    }
    let file_of = |index: usize| {
        let line = lines.get(index).copied().flatten()?;
        module.place(line).0.map(|part| part.name.clone())
    };
    let several = module.parts.len() > 1;
    let at = |file: &Option<String>| file.as_ref().filter(|_| several).map_or(String::new(), |file| format!("{file} "));
    let mut found: Vec<(usize, MoveFinding)> = Vec::new();
    // Lines of what no move carries are still counted through all files.
    let refused = module.refused.iter().map(|problem| {
        let mut problem = problem.clone();
        let line = problem.place().and_then(|place| place.line).map(|line| module.place(line));
        if let ProgramError::Value { at, .. } = &mut problem {
            at.line = line.map(|(_, line)| line);
        }
        (problem, line.and_then(|(part, _)| Some(part?.name.clone())))
    });
    let carried = certain.problems().into_iter().map(|problem| {
        let file = problem.place().and_then(|place| file_of(place.index));
        (problem, file)
    });
    for (problem, file) in carried.chain(refused) {
        let place = problem.place();
        let index = place.map_or(0, |place| place.index);
        let from = index.checked_sub(1).and_then(|before| certain.moves.get(before));
        let told = at(&file);
        let finding = MoveFinding {
            file,
            line: place.and_then(|place| place.line),
            kind: "program",
            from: from.and_then(|m| m.motion.name()).map(Into::into),
            to: place.and_then(|place| place.name.clone()),
            reason: problem.to_string(),
            sentence: format!("NOT EXECUTABLE {told}{problem}"),
            estimated: false,
            open: false,
            count: 1,
            moves: [index + 1; 2],
            last: None,
        };
        found.push((index, finding));
    }
    let refused: Vec<usize> = found.iter().map(|(index, _)| *index).collect();
    let parts = followed.and_then(|followed| followed.parts.as_deref()).unwrap_or_default();
    for finding in followed.iter().flat_map(|followed| &followed.checked.findings) {
        // What is no arc has been told.
        if finding.refusal.kind() == "arc" && refused.contains(&finding.index) {
            continue;
        }
        let file = file_of(finding.index);
        let finding = Finding { line: finding.line.map(|line| module.place(line).1), ..finding.clone() };
        let told = at(&file);
        let new = MoveFinding {
            file,
            line: finding.line,
            kind: finding.refusal.kind(),
            from: finding.from.clone(),
            to: finding.to.clone(),
            reason: finding.reason(parts),
            sentence: told + &finding.in_words(parts),
            estimated: finding.estimated.is_some(),
            open: finding.open,
            count: 1,
            moves: [finding.index + 1; 2],
            last: None,
        };
        found.push((finding.index, new));
    }
    if let Some(index) = followed.and_then(|followed| followed.unsaid) {
        let file = file_of(index);
        let m = &certain.moves[index];
        let line = m.line.map_or(String::new(), |line| format!("line {line}: "));
        let to = m.motion.name().map(str::to_owned);
        let sentence = format!("{}{line}INCONCLUSIVE {}: {UNSAID}", at(&file), to.as_deref().unwrap_or("(in place)"));
        let from = index.checked_sub(1).and_then(|before| certain.moves[before].motion.name()).map(Into::into);
        let finding = MoveFinding {
            file,
            line: m.line,
            kind: "joint-target",
            from,
            to,
            reason: UNSAID.into(),
            sentence,
            estimated: false,
            open: true,
            count: 1,
            moves: [index + 1; 2],
            last: None,
        };
        found.push((index, finding));
    }
    found.sort_by_key(|(index, _)| *index);
    once(found.into_iter().map(|(_, finding)| finding))
}
