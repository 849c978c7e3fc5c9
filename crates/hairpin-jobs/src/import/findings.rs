//! What is said of moves that cannot be executed.

use hairpin::feasibility::program::Finding;
use hairpin_formats::listing::Module;

use super::follow::Follow;

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
}

/// What a controller would stop at, and what the arm cannot do, of the moves that are certain, in their order.
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
    for problem in certain.problems() {
        let place = problem.place();
        let index = place.map_or(0, |place| place.index);
        let from = index.checked_sub(1).and_then(|before| certain.moves.get(before));
        let file = place.and_then(|place| file_of(place.index));
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
        };
        found.push((finding.index, new));
    }
    found.sort_by_key(|(index, _)| *index);
    found.into_iter().map(|(_, finding)| finding).collect()
}
