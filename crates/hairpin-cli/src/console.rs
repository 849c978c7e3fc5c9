//! The terminal: results on stdout, everything else on stderr, colour and progress only where somebody looks.

use std::borrow::Cow;
use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;
use std::sync::atomic::{AtomicBool, Ordering};

use comfy_table::{CellAlignment, ContentArrangement, Table, presets};
use hairpin::judgement::is_command;
use hairpin_formats::atomic::is_lost;
use hairpin_formats::quote::shortened;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tracing_subscriber::filter::LevelFilter;

/// Whether `-v` was typed.
static VERBOSE: AtomicBool = AtomicBool::new(false);
/// Why results did not get to stdout.
static LOST: OnceLock<String> = OnceLock::new();

/// A line of results, whatever the names in it are: what would begin another is written out, but for blank lines after
/// it. A reader that has gone away (`| head`) is no mistake: what is left to say is not said.
pub(crate) fn say(line: &str) {
    let own = line.trim_end_matches('\n');
    say_text(&format!("{}{}\n", written_out(own, is_command), &line[own.len()..]));
}

/// Lines of results, made of cells that begin none.
pub(crate) fn say_lines(lines: &str) {
    say_text(&format!("{}\n", plain(lines)));
}

/// Text as it is, for pipes.
pub(crate) fn say_text(text: &str) {
    let mut stdout = io::stdout().lock();
    if let Err(cause) = stdout.write_all(text.as_bytes()).and_then(|()| stdout.flush())
        && is_lost(&cause)
    {
        LOST.get_or_init(|| cause.to_string());
    }
}

/// Why results did not get to stdout, where some did not: no space is left, or the device failed.
pub(crate) fn lost() -> Option<&'static str> {
    LOST.get().map(String::as_str)
}

/// A line beside the results; if it is several, the others stand in, as nothing does that hairpin says.
pub(crate) fn warn(line: &str) {
    let _ = writeln!(io::stderr().lock(), "{}", shortened(&plain(line)).replace('\n', "\n    "));
}

/// Lines that have colours of their own, where somebody sees them.
pub(crate) fn warn_in_colour(lines: &str) {
    let _ = writeln!(io::stderr().lock(), "{lines}");
}

/// `text` with what would command the terminal written out: names come from files, and from whoever made these.
fn plain(text: &str) -> Cow<'_, str> {
    written_out(text, |c| is_command(c) && c != '\n' && c != '\t')
}

/// `text` with what `commands` picks written out: `\n`, `\u{1b}`.
fn written_out(text: &str, commands: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&commands) {
        return text.into();
    }
    let mut out = String::with_capacity(text.len() + 8);
    for c in text.chars() {
        if commands(c) { out.extend(c.escape_default()) } else { out.push(c) }
    }
    out.into()
}

/// Whether `NO_COLOR` (no-color.org) allows colour on stderr and somebody sees it.
pub(crate) fn colour_on_stderr() -> bool {
    colour_is_allowed() && io::stderr().is_terminal()
}

fn colour_is_allowed() -> bool {
    std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// How wide the terminal is that stdout goes to, in characters; `None` where it goes to none.
pub(crate) fn width() -> Option<usize> {
    let stdout = io::stdout();
    // A terminal that does not say how wide it is, is as wide as they always were.
    stdout.is_terminal().then(|| terminal_size::terminal_size_of(&stdout).map_or(80, |(width, _)| width.0.into()))
}

/// A verdict on stdout, its outcome in colour where somebody sees it.
pub(crate) fn say_verdict(sentence: &str, exit_code: u8) {
    if width().is_none() || !colour_is_allowed() {
        return say(sentence);
    }
    say_text(&format!("{}\n", in_colour(&written_out(sentence, is_command), exit_code)));
}

/// The words in capitals that a sentence begins with, and its counts, in bold and in the colour of its exit code.
fn in_colour(sentence: &str, exit_code: u8) -> String {
    let colour = match exit_code {
        0 => 32,
        1 => 31,
        _ => 33,
    };
    let counts = |word: &str| word.chars().all(|c| c.is_ascii_uppercase() || c.is_ascii_digit() || c == '/');
    let end: usize = sentence.split_inclusive(' ').take_while(|word| counts(word.trim_end())).map(str::len).sum();
    let (outcome, rest) = sentence.split_at(end);
    let outcome_alone = outcome.trim_end();
    format!("\u{1b}[1;{colour}m{outcome_alone}\u{1b}[0m{}{rest}", &outcome[outcome_alone.len()..])
}

/// Whether more was asked for than is said otherwise.
pub(crate) fn is_verbose() -> bool {
    VERBOSE.load(Ordering::Relaxed)
}

/// `-v` tells what is done, `-vv` with what; `RUST_LOG` (error, warn, info, debug, trace) goes first.
pub(crate) fn chatter(verbose: u8) {
    VERBOSE.store(verbose > 0, Ordering::Relaxed);
    let asked = std::env::var("RUST_LOG").ok().and_then(|level| level.parse::<LevelFilter>().ok());
    let level = asked.unwrap_or(match verbose {
        0 => LevelFilter::WARN,
        1 => LevelFilter::INFO,
        _ => LevelFilter::DEBUG,
    });
    let subscriber = tracing_subscriber::fmt().with_max_level(level).with_writer(io::stderr).without_time();
    // It fails only where there is a subscriber already.
    let _ = subscriber.with_target(false).with_ansi(colour_on_stderr()).try_init();
}

/// A progress bar with the time left, on a terminal's stderr only.
pub(crate) fn progress(what: &'static str, of: usize) -> ProgressBar {
    let target = if io::stderr().is_terminal() { ProgressDrawTarget::stderr() } else { ProgressDrawTarget::hidden() };
    let colour = if colour_on_stderr() { ".cyan/blue" } else { "" };
    let template = format!("{{msg:>10}} {{bar:32{colour}}} {{pos}}/{{len}}{{prefix}}  {{eta}} left");
    let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(of as u64), target).with_style(style).with_message(what)
}

/// Rows under headers, columns as wide as they need; the first row is the header. No cell begins a line. On a terminal
/// it is as wide as that: columns wrap, and where even that is too wide the last ones are left out.
pub(crate) fn table(rows: &[Vec<String>]) -> String {
    let cell = |cell: &String| written_out(cell, is_command).into_owned();
    let rows: Vec<Vec<String>> = rows.iter().map(|row| row.iter().map(cell).collect()).collect();
    match width() {
        Some(width) => fitting(&rows, width),
        None => unlimited(&rows),
    }
}

/// A table of `width` characters.
fn fitting(rows: &[Vec<String>], width: usize) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let longest_word = |column: usize| {
        let words = rows.iter().filter_map(|row| row.get(column)).flat_map(|cell| cell.split(' '));
        words.map(|word| word.chars().count()).max().unwrap_or(0)
    };
    let mut taken = 0;
    let fit = (0..columns)
        .take_while(|column| {
            taken += longest_word(*column) + if *column > 0 { 2 } else { 0 };
            taken <= width || *column == 0
        })
        .count();
    let mut table = Table::new();
    table.load_style(presets::NOTHING).set_content_arrangement(ContentArrangement::Dynamic);
    table.set_width(u16::try_from(width).unwrap_or(u16::MAX));
    let row = |row: &Vec<String>| row.iter().take(fit).cloned().collect::<Vec<_>>();
    if let Some((header, rows)) = rows.split_first() {
        table.set_header(row(header));
        rows.iter().for_each(|cells| {
            table.add_row(row(cells));
        });
    }
    for (index, column) in table.column_iter_mut().enumerate() {
        column.set_padding((if index > 0 { 2 } else { 0 }, 0));
        column.set_cell_alignment(CellAlignment::Right);
    }
    let left_out = columns - fit;
    let told = if left_out > 0 { format!("\n({left_out} more columns in a wider terminal)") } else { String::new() };
    table.trim_fmt() + &told
}

fn unlimited(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|c| c.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}")).collect();
        cells.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rows() -> Vec<Vec<String>> {
        let row = |cells: &[&str]| cells.iter().map(|cell| (*cell).to_owned()).collect();
        vec![row(&["case", "max deviation m", "ended"]), row(&["0003", "0.65", "done"]), row(&["0011", "0.4", "time"])]
    }

    #[test]
    fn tables_fit_their_width() {
        assert_eq!(unlimited(&rows()).lines().next(), Some("case  max deviation m  ended"));
        for width in [10, 20, 24, 80] {
            let table = fitting(&rows(), width);
            let table: Vec<&str> = table.lines().filter(|line| !line.starts_with('(')).collect();
            assert!(table.iter().all(|line| line.chars().count() <= width), "{width}: {table:#?}");
            assert!(table.iter().any(|line| line.contains("0003")), "{width}: {table:#?}");
        }
        assert!(fitting(&rows(), 80).contains("max deviation m  ended"), "{}", fitting(&rows(), 80));
        assert!(fitting(&rows(), 10).contains("(2 more columns in a wider terminal)"), "{}", fitting(&rows(), 10));
    }

    #[test]
    fn the_outcome_is_in_colour_and_nothing_else() {
        assert_eq!(in_colour("FAIL 3/200 (simulated)", 1), "\u{1b}[1;31mFAIL 3/200\u{1b}[0m (simulated)");
        assert_eq!(in_colour("PASS 4/4 (simulated)", 0), "\u{1b}[1;32mPASS 4/4\u{1b}[0m (simulated)");
        assert_eq!(in_colour("NOTHING FEASIBLE (proof)", 3), "\u{1b}[1;33mNOTHING FEASIBLE\u{1b}[0m (proof)");
    }
}
