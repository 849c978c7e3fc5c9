//! What a child writes, read by threads: its stdout as bounded lines, the end of its stderr.

use std::collections::VecDeque;
use std::io::{ErrorKind, Read};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Mutex, PoisonError};
use std::thread;
use std::time::Duration;

use crate::delimited::BYTE_ORDER_MARK;

/// No message of the protocol comes near this, bytes.
pub(super) const LONGEST_LINE: usize = 1 << 20;
/// What is read at once, bytes: as much as a pipe holds.
const CHUNK: usize = 64 << 10;
/// Batches of lines that may wait to be looked at; then the child waits.
const WAITING: usize = 16;
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

/// What the thread that reads hands over: all lines that are there, for one at a time costs a switch of threads each.
enum Batch {
    /// Whole lines; the stream's last may have no end.
    Lines(Vec<u8>),
    /// A line too long, and the end.
    TooLong,
}

/// Lines of a stream, read by a thread of their own; they end with the stream or after a line too long.
#[derive(Debug)]
pub(crate) struct Lines {
    batches: Receiver<Batch>,
    /// The batch that is being looked at, and how far.
    batch: Vec<u8>,
    at: usize,
    /// Whether a line of it was handed on.
    begun: bool,
}

impl Lines {
    /// Those of `stdout`.
    pub(crate) fn of(stdout: impl Read + Send + 'static) -> Self {
        let (sender, batches) = sync_channel(WAITING);
        thread::spawn(move || send_batches(stdout, &sender));
        Self { batches, batch: Vec::new(), at: 0, begun: false }
    }

    /// The next one, if it comes in time.
    pub(crate) fn next(&mut self, timeout: Duration) -> Result<Line, RecvTimeoutError> {
        while self.at >= self.batch.len() {
            match self.batches.recv_timeout(timeout)? {
                Batch::Lines(lines) => (self.batch, self.at) = (lines, 0),
                Batch::TooLong => return Ok(Line::TooLong),
            }
        }
        let rest = &self.batch[self.at..];
        let end = rest.iter().position(|byte| *byte == b'\n').unwrap_or(rest.len());
        self.at += end + 1;
        if end > LONGEST_LINE {
            return Ok(Line::TooLong);
        }
        let mut text = &rest[..end];
        if !std::mem::replace(&mut self.begun, true) {
            // A stream may begin with it, as a file may.
            text = text.strip_prefix(BYTE_ORDER_MARK.encode_utf8(&mut [0; 3]).as_bytes()).unwrap_or(text);
        }
        let kept = text.iter().rposition(|byte| *byte != b'\r').map_or(0, |last| last + 1);
        Ok(Line::Text(text[..kept].to_vec()))
    }
}

fn send_batches(mut stdout: impl Read, sender: &SyncSender<Batch>) {
    let mut chunk = vec![0; CHUNK];
    // What has no end yet.
    let mut open: Vec<u8> = Vec::new();
    loop {
        let read = match stdout.read(&mut chunk) {
            Ok(0) => break,
            Ok(count) => &chunk[..count],
            Err(cause) if cause.kind() == ErrorKind::Interrupted => continue,
            Err(_) => break,
        };
        match read.iter().rposition(|byte| *byte == b'\n') {
            None => open.extend_from_slice(read),
            Some(end) => {
                let mut lines = std::mem::take(&mut open);
                lines.extend_from_slice(&read[..=end]);
                open.extend_from_slice(&read[end + 1..]);
                // It fails where nobody listens any more.
                if sender.send(Batch::Lines(lines)).is_err() {
                    return;
                }
            }
        }
        if open.len() > LONGEST_LINE {
            let _ = sender.send(Batch::TooLong);
            return;
        }
    }
    if !open.is_empty() {
        let _ = sender.send(Batch::Lines(open));
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
