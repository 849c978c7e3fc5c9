//! Many queries from a file, answered into another, or to whoever shows them.

use std::io::BufReader;
use std::path::Path;

use hairpin_formats::bounds;
use hairpin_formats::steering::{self, KeptAnswer, QueryFile};

use super::batch::Batch;
use super::run::Run;
use super::vehicle::Vehicle;
use crate::watch::Steps;
use crate::{Problem, Watch};

/// Drives of a file that are drawn at most.
const MOST_DRAWN: usize = 500;

/// Where the rows of answers go.
pub enum Answers<'a> {
    /// Into this file, which is there once all are, or as many as there were when it was stopped.
    File(&'a Path),
    /// Likewise, behind those that it has already.
    Resumed(&'a Path),
    /// To whoever shows them, as they come.
    Shown(&'a mut (dyn FnMut(&str) + Send)),
}

impl Vehicle {
    /// Answers the queries of the file at `path`; the first drives are kept to be drawn, if `drawn`.
    ///
    /// # Errors
    /// A file cannot be read or written; it was asked to stop: what is done is kept then.
    pub fn answer_file(
        &self,
        path: &Path,
        answers: Answers<'_>,
        drawn: bool,
        watch: &dyn Watch,
    ) -> Result<Batch, Problem> {
        if let Answers::File(out) | Answers::Resumed(out) = &answers
            && same_file(path, out)
        {
            let bound = "another file: the answers would take the place of the queries";
            return Err(Problem::input(format!("--out {}: must be {bound}", out.display())));
        }
        let QueryFile { columns, blocks, count } =
            QueryFile::at(path).map_err(|error| Problem::of_file(path, error))?;
        if !columns.ignored.is_empty() {
            watch.warn(&format!(
                "Warning: {}: columns without meaning here: {}",
                path.display(),
                columns.ignored.join(", ")
            ));
        }
        let (kept, out) = match &answers {
            Answers::Resumed(out) if out.exists() => (kept_in(out)?, Some(*out)),
            Answers::Resumed(out) | Answers::File(out) => (Vec::new(), Some(*out)),
            Answers::Shown(_) => (Vec::new(), None),
        };
        let steps = Steps::new(watch, "queries", kept.len().min(count), count);
        let most_drawn = if drawn { MOST_DRAWN } else { 0 };
        let run = Run { vehicle: self, path, columns: &columns, kept: &kept, most_drawn, steps: &steps, watch };
        let batch = match answers {
            Answers::File(out) | Answers::Resumed(out) => run.write_into(blocks, out),
            Answers::Shown(show) => {
                show(&steering::head());
                run.all(blocks, &mut |text| {
                    show(&String::from_utf8_lossy(text));
                    Ok(())
                })
            }
        }?;
        drop(steps);
        if let Some(twice) = batch.twice() {
            watch.warn(&format!("Warning: {}: {twice}", path.display()));
        }
        if batch.queries < count {
            let done = format!("{} of {count} queries answered", batch.queries);
            return Err(Problem::Interrupted(match out.filter(|_| batch.queries > 0) {
                Some(out) => format!("{done}, in {}; the same command with --resume goes on", out.display()),
                None => format!("{done}; nothing is written to go on from"),
            }));
        }
        if most_drawn > 0 && count > MOST_DRAWN {
            watch.warn(&format!("--plot draws the first {MOST_DRAWN} queries"));
        }
        Ok(batch)
    }
}

/// Whether both are one file that is there.
fn same_file(a: &Path, b: &Path) -> bool {
    a.canonicalize().is_ok_and(|a| b.canonicalize().is_ok_and(|b| a == b))
}

/// The answers that `out` has.
fn kept_in(out: &Path) -> Result<Vec<KeptAnswer>, Problem> {
    let kept = bounds::open(out, u64::MAX).and_then(|file| steering::kept_answers(BufReader::new(file)));
    kept.map_err(|error| Problem::of_file(out, error))
}
