//! What a child writes, read by threads: its stdout as bounded lines, the end of its stderr.

use std::collections::VecDeque;
use std::io::{BufRead, BufReader, Read};
use std::sync::mpsc::{Receiver, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;

/// No message of the protocol comes near this, bytes.
pub(super) const LONGEST_LINE: usize = 1 << 20;
/// Lines that may wait to be looked at; then the child waits.
const WAITING: usize = 256;
/// How much of stderr is kept, bytes.
const TAIL: usize = 64 << 10;

/// What came from stdout.
#[derive(Debug)]
pub(crate) enum Line {
    /// A line without its end.
    Text(Vec<u8>),
    /// More than [`LONGEST_LINE`] bytes without an end.
    TooLong,
}

/// Lines of `stdout`, read by a thread of their own; the channel closes with the stream or after a line too long.
pub(crate) fn read_lines(stdout: impl Read + Send + 'static) -> Receiver<Line> {
    let (sender, receiver) = sync_channel(WAITING);
    thread::spawn(move || send_lines(BufReader::new(stdout), &sender));
    receiver
}

fn send_lines(mut stdout: impl BufRead, sender: &SyncSender<Line>) {
    loop {
        let mut line = Vec::new();
        let read = stdout.by_ref().take(LONGEST_LINE as u64 + 1).read_until(b'\n', &mut line);
        if !matches!(read, Ok(1..)) {
            return;
        }
        let ended = line.last() == Some(&b'\n');
        if !ended && line.len() > LONGEST_LINE {
            // Nobody listens any more when this fails.
            let _ = sender.send(Line::TooLong);
            return;
        }
        while matches!(line.last(), Some(b'\n' | b'\r')) {
            line.pop();
        }
        if sender.send(Line::Text(line)).is_err() {
            return;
        }
    }
}

/// The end of a child's stderr.
#[derive(Debug, Clone, Default)]
pub(crate) struct Tail(Arc<Mutex<VecDeque<u8>>>);

impl Tail {
    /// Reads `stderr` in a thread of its own until it closes. The receiver closes with it.
    pub(crate) fn follow(stderr: impl Read + Send + 'static) -> (Self, Receiver<()>) {
        let tail = Self::default();
        let (open, closed) = sync_channel(0);
        let writer = tail.clone();
        thread::spawn(move || {
            let _open: SyncSender<()> = open;
            writer.fill(stderr);
        });
        (tail, closed)
    }

    fn fill(&self, mut stderr: impl Read) {
        let mut buffer = [0; 4096];
        while let Ok(count @ 1..) = stderr.read(&mut buffer) {
            let mut kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
            kept.extend(&buffer[..count]);
            let excess = kept.len().saturating_sub(TAIL);
            kept.drain(..excess);
        }
    }

    /// Forgets what came so far.
    pub(super) fn clear(&self) {
        self.0.lock().unwrap_or_else(PoisonError::into_inner).clear();
    }

    /// What is kept, as text.
    pub(crate) fn text(&self) -> String {
        let kept = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let (front, back) = kept.as_slices();
        String::from_utf8_lossy(&[front, back].concat()).into_owned()
    }
}
