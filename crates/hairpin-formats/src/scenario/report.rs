//! What is wrong with a scenario, for people (line, caret, colours) and for machines.

use std::fmt;
use std::ops::Range;

use ariadne::{CharSet, Config, IndexType, Label, ReportKind};
use serde_json::{Value, json};

use super::attached::InFile;
use crate::quote::shortened;

/// Bytes of a line that is shown, with a caret under it.
const LONGEST_LINE: usize = 2_000;

/// A text that mistakes are in: the scenario file, a robot file, one `--set`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct SourceText {
    pub(crate) name: String,
    pub(crate) text: String,
}

/// A stretch of one of the texts, in bytes.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct Place {
    pub(crate) source: usize,
    pub(crate) span: Range<usize>,
}

/// One mistake and where it stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Complaint {
    /// The scenario file, the robot file, or `--set`.
    pub file: String,
    /// Line in that file, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Dotted key; empty where the text is no TOML.
    pub field: String,
    /// The value as given; empty where there is none.
    pub value: String,
    /// What it must be.
    pub bound: String,
    /// The whole mistake in one sentence.
    pub message: String,
    place: Place,
}

/// Mistakes that are told at most: each takes a look at the text before it.
const MOST_COMPLAINTS: usize = 200;

/// All that is wrong with a scenario. Exit code 2.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Report {
    complaints: Vec<Complaint>,
    sources: Vec<SourceText>,
}

impl Report {
    /// The mistakes in the order they were found; never none.
    pub fn complaints(&self) -> &[Complaint] {
        &self.complaints
    }

    /// For people: per mistake the sentence, file, line, and a caret under the value.
    pub fn render(&self, colour: bool) -> String {
        let mut out = Vec::new();
        for complaint in &self.complaints {
            let name = &complaint.file;
            let text = &self.sources[complaint.place.source].text;
            if text.is_empty() {
                // Nothing to point at: an empty file is named; what is said of a whole file names it already.
                let place = if complaint.field.is_empty() { String::new() } else { format!("{name}: ") };
                out.extend(format!("Error: {place}{}\n", complaint.message).into_bytes());
                continue;
            }
            let span = char_boundaries(text, &complaint.place.span);
            if is_unreadable(text, &span) {
                let Complaint { line, column, message, .. } = complaint;
                out.extend(format!("Error: {message}\n   [ {name}:{line}:{column} ]\n").into_bytes());
                continue;
            }
            let config =
                Config::default().with_color(colour).with_index_type(IndexType::Byte).with_char_set(CharSet::Unicode);
            let label = Label::new((name.clone(), span.clone())).with_message(&complaint.bound);
            let report = ariadne::Report::build(ReportKind::Error, (name.clone(), span))
                .with_config(config)
                .with_message(&complaint.message)
                .with_label(label)
                .finish();
            let written = report.write(ariadne::sources([(name.clone(), text)]), &mut out);
            assert!(written.is_ok(), "a vector takes everything that is written");
        }
        String::from_utf8_lossy(&out).lines().map(|line| format!("{}\n", line.trim_end())).collect()
    }

    /// For machines: `[{"file", "line", "column", "field", "value", "bound", "message"}]`.
    pub fn to_json(&self) -> Value {
        let complaints = self.complaints.iter().map(|c| {
            json!({ "file": c.file, "line": c.line, "column": c.column, "field": c.field, "value": c.value,
                "bound": c.bound, "message": c.message })
        });
        Value::Array(complaints.collect())
    }

    /// Adds what is wrong with a file as a whole.
    pub(crate) fn complain_of_file(&mut self, file: &str, message: &str) {
        let source = self.add_source(file, "");
        self.complain(&Place { source, span: 0..0 }, "", "", "", message.to_owned());
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.complaints.is_empty()
    }

    pub(crate) fn add_source(&mut self, name: impl Into<String>, text: impl Into<String>) -> usize {
        self.sources.push(SourceText { name: name.into(), text: text.into() });
        self.sources.len() - 1
    }

    /// Where a line of another file stands, without its end.
    pub(super) fn line_of(&mut self, at: InFile) -> Place {
        let InFile { file, text, line } = at;
        let start = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum::<usize>();
        let length = text[start..].lines().next().map_or(0, str::len);
        Place { source: self.add_source(file, text), span: start..start + length }
    }

    pub(crate) fn source(&self, index: usize) -> &SourceText {
        &self.sources[index]
    }

    /// Adds a mistake: `message` the whole sentence, `bound` the words beside the caret.
    pub(crate) fn complain(&mut self, place: &Place, field: &str, value: &str, bound: &str, message: String) {
        if self.complaints.len() == MOST_COMPLAINTS {
            return;
        }
        let source = &self.sources[place.source];
        let before = &source.text[..char_boundaries(&source.text, &place.span).start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        self.complaints.push(Complaint {
            file: source.name.clone(),
            line: before.matches('\n').count() + 1,
            column: before[line_start..].chars().count() + 1,
            field: shortened(field).into_owned(),
            value: shortened(value).into_owned(),
            bound: shortened(bound).into_owned(),
            message: shortened(&message).into_owned(),
            place: place.clone(),
        });
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.render(false).trim_end())
    }
}

impl std::error::Error for Report {}

/// Whether the line in which `span` begins, or what it spans, is too long for a caret to stand under.
fn is_unreadable(text: &str, span: &Range<usize>) -> bool {
    let start = text[..span.start].rfind('\n').map_or(0, |newline| newline + 1);
    let end = text[span.start..].find('\n').map_or(text.len(), |length| span.start + length).max(span.end);
    end - start > LONGEST_LINE
}

/// The span within the text and on whole characters, at least one character long where there is one.
fn char_boundaries(text: &str, span: &Range<usize>) -> Range<usize> {
    let mut start = span.start.min(text.len());
    while !text.is_char_boundary(start) {
        start -= 1;
    }
    let mut end = span.end.clamp(start, text.len());
    if end == start && end < text.len() {
        end += 1;
    }
    while !text.is_char_boundary(end) {
        end += 1;
    }
    start..end
}
