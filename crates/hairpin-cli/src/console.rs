//! The terminal: results on stdout, everything else on stderr, colour and progress only where somebody looks.

use std::borrow::Cow;
use std::io::{self, IsTerminal, Write};
use std::sync::OnceLock;

use hairpin_formats::atomic::is_lost;
use hairpin_formats::quote::shortened;
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use tracing_subscriber::filter::LevelFilter;

/// Why results did not get to stdout.
static LOST: OnceLock<String> = OnceLock::new();

/// A line of results, whatever the names in it are: what would begin another is written out, but for blank lines after
/// it. A reader that has gone away (`| head`) is no mistake: what is left to say is not said.
pub(crate) fn say(line: &str) {
    let own = line.trim_end_matches('\n');
    say_text(&format!("{}{}\n", written_out(own, char::is_control), &line[own.len()..]));
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
    written_out(text, |c| c.is_control() && c != '\n' && c != '\t')
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
    std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty()) && io::stderr().is_terminal()
}

/// `-v` tells what is done, `-vv` with what; `RUST_LOG` (error, warn, info, debug, trace) goes first.
pub(crate) fn chatter(verbose: u8) {
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
    let template = format!("{{msg:>10}} {{bar:32{colour}}} {{pos}}/{{len}}  {{eta}} left");
    let style = ProgressStyle::with_template(&template).unwrap_or_else(|_| ProgressStyle::default_bar());
    ProgressBar::with_draw_target(Some(of as u64), target).with_style(style).with_message(what)
}

/// Rows under headers, columns as wide as they need; the first row is the header. No cell begins a line.
pub(crate) fn table(rows: &[Vec<String>]) -> String {
    let cell = |cell: &String| written_out(cell, char::is_control).into_owned();
    let rows: Vec<Vec<String>> = rows.iter().map(|row| row.iter().map(cell).collect()).collect();
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let width = |column: usize| rows.iter().filter_map(|row| row.get(column)).map(|c| c.chars().count()).max();
    let widths: Vec<usize> = (0..columns).map(|column| width(column).unwrap_or(0)).collect();
    let line = |row: &Vec<String>| {
        let cells: Vec<String> = row.iter().zip(&widths).map(|(cell, &width)| format!("{cell:>width$}")).collect();
        cells.join("  ").trim_end().to_owned()
    };
    rows.iter().map(line).collect::<Vec<_>>().join("\n")
}
