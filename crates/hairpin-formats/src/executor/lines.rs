//! What a child writes, read by threads: its stdout as bounded lines, the end of its stderr.

use std::collections::VecDeque;
use std::io::{ErrorKind, Read};
use std::sync::mpsc::{Receiver, RecvTimeoutError, SyncSender, sync_channel};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::{Duration, Instant};

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
pub(crate) struct Tail(Arc<(Mutex<Kept>, Condvar)>);

#[derive(Debug, Default)]
struct Kept {
    bytes: VecDeque<u8>,
    /// How often something came.
    came: u64,
}

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
            let mut kept = self.open();
            kept.bytes.extend(&buffer[..count]);
            let excess = kept.bytes.len().saturating_sub(TAIL);
            kept.bytes.drain(..excess);
            kept.came += 1;
            self.0.1.notify_all();
        }
    }

    /// Waits until nothing has come for `quiet`, at most `most`: what a child said before a line of its stdout may be
    /// read after it, and of a stream that stays open nothing tells that all is there.
    pub(super) fn settle(&self, quiet: Duration, most: Duration) {
        let until = Instant::now() + most;
        let mut kept = self.open();
        loop {
            let before = kept.came;
            let patience = quiet.min(until.saturating_duration_since(Instant::now()));
            let (now, waited) = self
                .0
                .1
                .wait_timeout_while(kept, patience, |kept| kept.came == before)
                .unwrap_or_else(PoisonError::into_inner);
            kept = now;
            if waited.timed_out() {
                return;
            }
        }
    }

    fn open(&self) -> MutexGuard<'_, Kept> {
        self.0.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Forgets what came so far.
    pub(super) fn clear(&self) {
        self.open().bytes.clear();
    }

    /// What is kept, as text.
    pub(crate) fn text(&self) -> String {
        let kept = self.open();
        let (front, back) = kept.bytes.as_slices();
        String::from_utf8_lossy(&[front, back].concat()).into_owned()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A stream of which each piece comes when it is let go, and which stays open.
    struct Slow(Receiver<&'static [u8]>);

    impl Read for Slow {
        fn read(&mut self, buffer: &mut [u8]) -> std::io::Result<usize> {
            let Ok(piece) = self.0.recv() else { return Ok(0) };
            buffer[..piece.len()].copy_from_slice(piece);
            Ok(piece.len())
        }
    }

    #[test]
    fn what_is_read_late_is_waited_for_and_silence_is_not_for_long() {
        let (send, pieces) = sync_channel(0);
        let (tail, _closed) = Tail::follow(Slow(pieces));
        let begun = Instant::now();
        tail.settle(Duration::from_millis(10), Duration::from_secs(60));
        assert!(tail.text().is_empty() && begun.elapsed() < Duration::from_secs(30));
        let late = thread::spawn(move || {
            for piece in [b"no ".as_slice(), b"map"] {
                thread::sleep(Duration::from_millis(50));
                send.send(piece).unwrap();
            }
            send
        });
        tail.settle(Duration::from_secs(2), Duration::from_secs(60));
        assert_eq!(tail.text(), "no map");
        // Who never stops is not waited for.
        let send = late.join().unwrap();
        thread::spawn(move || {
            while send.send(b".").is_ok() {
                thread::sleep(Duration::from_millis(1))
            }
        });
        tail.settle(Duration::from_secs(60), Duration::from_millis(50));
        assert!(tail.text().starts_with("no map"));
    }
}
