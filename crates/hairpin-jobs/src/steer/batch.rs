//! What became of a file of queries: counted, and its first drives drawn.

use std::collections::HashMap;
use std::collections::hash_map::Entry;
use std::path::Path;

use hairpin_formats::atomic;
use hairpin_formats::folder::refuse_own;
use hairpin_formats::steering::{self, Status, Stretch, Wrong};

use crate::Problem;

/// What became of a file of queries.
#[derive(Debug, Default)]
pub struct Batch {
    /// Queries answered.
    pub queries: usize,
    /// Rows that are no queries: their lines, and why.
    pub wrong: Vec<(u64, Wrong)>,
    counts: [usize; Status::ALL.len()],
    /// What solving those took that have a drive: how many, all of it and the most, µs.
    solved: (usize, f64, f64),
    /// The first drives, and their goals.
    pub(super) drawn: Vec<(Vec<Stretch>, [f64; 3])>,
    /// Rows whose id another has before them, and the first of these.
    again: usize,
    first_again: Option<Again>,
}

/// A row whose id another has before it.
#[derive(Debug)]
struct Again {
    id: Box<str>,
    /// Of the one before, and its own.
    lines: [u64; 2],
}

impl Batch {
    /// Whether there are rows and none of them is a query.
    pub fn nothing_asked(&self) -> bool {
        self.queries > 0 && self.wrong.len() == self.queries
    }

    /// Draws the first drives, seen from above, each from its start.
    ///
    /// # Errors
    /// The file cannot be written.
    pub fn draw(&self, plot: &Path) -> Result<(), Problem> {
        refuse_own(plot)?;
        let lines: Vec<Stretch> = self.drawn.iter().flat_map(|(lines, _)| lines.iter().cloned()).collect();
        let goals: Vec<[f64; 3]> = [[0.0; 3]].into_iter().chain(self.drawn.iter().map(|(_, goal)| *goal)).collect();
        let picture = steering::svg(&lines, &goals).map_err(Problem::input)?;
        Ok(atomic::write(plot, picture.as_bytes())?)
    }

    /// How many queries ended so.
    pub fn ended(&self, status: Status) -> usize {
        self.counts[status as usize]
    }

    /// What solving those took that have a drive, µs: in the mean, and at most.
    pub fn solving_us(&self) -> [f64; 2] {
        let (count, all, most) = self.solved;
        [all / count.max(1) as f64, most]
    }

    /// One more, which took `time_us` if it has a drive.
    pub(super) fn count(&mut self, status: Status, time_us: Option<f64>) {
        self.queries += 1;
        self.counts[status as usize] += 1;
        if let Some(time) = time_us {
            let (count, all, most) = self.solved;
            self.solved = (count + 1, all + time, most.max(time));
        }
    }

    /// Notes what rows are called, of which those before were `met` on their lines.
    pub(super) fn note_ids(&mut self, ids: Vec<(Box<str>, u64)>, met: &mut HashMap<Box<str>, u64>) {
        // Rows without one are wrong for that.
        for (id, line) in ids.into_iter().filter(|(id, _)| !id.is_empty()) {
            match met.entry(id) {
                Entry::Vacant(new) => {
                    new.insert(line);
                }
                Entry::Occupied(old) => {
                    self.again += 1;
                    self.first_again.get_or_insert_with(|| Again { id: old.key().clone(), lines: [*old.get(), line] });
                }
            }
        }
    }

    /// `line 7: id = "a", as on line 3; 2 more such rows`; `None` where each stands once.
    pub(super) fn twice(&self) -> Option<String> {
        let Again { id, lines: [first, again] } = self.first_again.as_ref()?;
        let more = match self.again - 1 {
            0 => String::new(),
            more => format!("; {more} more such row{}", if more == 1 { "" } else { "s" }),
        };
        Some(format!("line {again}: id = {id:?}, as on line {first}: answers do not tell them apart{more}"))
    }

    /// What follows, of which as many are drawn as there is room for.
    pub(super) fn add(&mut self, more: Self, most_drawn: usize) {
        self.queries += more.queries;
        self.again += more.again;
        self.first_again = self.first_again.take().or(more.first_again);
        self.wrong.extend(more.wrong);
        self.counts.iter_mut().zip(more.counts).for_each(|(count, more)| *count += more);
        let ((count, all, most), (others, their, longest)) = (self.solved, more.solved);
        self.solved = (count + others, all + their, most.max(longest));
        self.drawn.extend(more.drawn);
        self.drawn.truncate(most_drawn);
    }
}
