//! A table of text in blocks of whole records, so that it is never in memory as a whole.

use std::io::{self, Read};

/// Bytes that are read at once.
const PIECE: usize = 1 << 16;

/// Whole records.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Block {
    /// Records before it, the head among them.
    pub before: usize,
    /// The line, from 1, that the first of them begins in or after.
    pub(super) line: u64,
    pub(super) bytes: Vec<u8>,
}

/// The records of a table, in blocks.
#[derive(Debug)]
pub struct Blocks<R> {
    source: R,
    /// What was read from the next block's beginning on.
    bytes: Vec<u8>,
    begin: usize,
    scanned: usize,
    cursor: Cursor,
    line: u64,
    /// Records before the next block, and up to where was scanned.
    before: usize,
    begun: usize,
    ended: bool,
}

/// Where a reader is in a record, as the `csv` crate has it: quotes count where a cell begins, and double ones within.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(super) enum Cursor {
    /// Before a record: at its first byte, or at the line's end before it.
    #[default]
    Between,
    /// At a cell's first byte.
    Cell,
    Bare,
    Quoted,
    /// Behind a quote that closes a cell, or is the first of two.
    Closed,
}

impl Cursor {
    /// Whether `byte` begins a record; the cursor is behind it then.
    pub(super) fn begins(&mut self, byte: u8) -> bool {
        let begins = *self == Self::Between && !matches!(byte, b'\r' | b'\n');
        *self = match (*self, byte) {
            (Self::Quoted, b'"') => Self::Closed,
            (Self::Quoted, _) => Self::Quoted,
            (_, b'\r' | b'\n') => Self::Between,
            (Self::Between | Self::Cell | Self::Closed, b'"') => Self::Quoted,
            (_, b',') => Self::Cell,
            _ => Self::Bare,
        };
        begins
    }
}

impl<R: Read> Blocks<R> {
    /// The table of `source`, after its byte order mark.
    pub(super) fn new(source: R) -> io::Result<Self> {
        let (bytes, cursor) = (Vec::new(), Cursor::Between);
        let (line, before, begun) = (1, 0, 0);
        let mut blocks = Self { source, bytes, begin: 0, scanned: 0, cursor, line, before, begun, ended: false };
        blocks.read_on()?;
        if blocks.bytes.starts_with(b"\xef\xbb\xbf") {
            (blocks.begin, blocks.scanned) = (3, 3);
        }
        Ok(blocks)
    }

    /// The next records, `least` bytes of them or the last; `None` where there are no more.
    ///
    /// # Errors
    /// It cannot be read.
    pub fn take(&mut self, least: usize) -> io::Result<Option<Block>> {
        loop {
            while let Some(byte) = self.bytes.get(self.scanned) {
                let before = self.cursor;
                if self.cursor.begins(*byte) {
                    if self.scanned >= self.begin + least.max(1) {
                        self.cursor = before;
                        return Ok(Some(self.cut(self.scanned)));
                    }
                    self.begun += 1;
                }
                self.scanned += 1;
            }
            if self.ended {
                let left = self.bytes.len() > self.begin;
                return Ok(left.then(|| self.cut(self.bytes.len())));
            }
            self.read_on()?;
        }
    }

    fn read_on(&mut self) -> io::Result<()> {
        self.bytes.drain(..self.begin);
        (self.scanned, self.begin) = (self.scanned - self.begin, 0);
        let known = self.bytes.len();
        self.source.by_ref().take(PIECE as u64).read_to_end(&mut self.bytes)?;
        self.ended = self.bytes.len() < known + PIECE;
        Ok(())
    }

    fn cut(&mut self, end: usize) -> Block {
        let bytes = self.bytes[self.begin..end].to_vec();
        let (line, before) = (self.line, std::mem::replace(&mut self.before, self.begun));
        self.line += bytes.iter().filter(|byte| **byte == b'\n').count() as u64;
        self.begin = end;
        Block { before, line, bytes }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn blocks(text: &str, least: usize) -> Vec<(u64, String)> {
        let mut blocks = Blocks::new(text.as_bytes()).unwrap();
        std::iter::from_fn(|| blocks.take(least).unwrap())
            .map(|block| (block.line, String::from_utf8(block.bytes).unwrap()))
            .collect()
    }

    #[test]
    fn blocks_end_between_records_wherever_quotes_stand() {
        let text = "\u{feff}a,b\r\n\r\n1,\"x\n\"\"y\"\n2,z\"\n\n3,\" \",\"q\"r\n4";
        let all = ["a,b\r\n\r\n", "1,\"x\n\"\"y\"\n", "2,z\"\n\n", "3,\" \",\"q\"r\n", "4"];
        let lines = [1, 3, 5, 7, 8];
        let each: Vec<(u64, String)> = lines.into_iter().zip(all.map(str::to_owned)).collect();
        assert_eq!(blocks(text, 1), each);
        assert_eq!(blocks(text, 12), [(1, all[..2].concat()), (5, all[2..4].concat()), (8, "4".into())]);
        assert_eq!(blocks(text, 1000), [(1, all.concat())]);
        assert_eq!(blocks("1\r2\r\n3", 1), [(1, "1\r".into()), (1, "2\r\n".into()), (2, "3".into())]);
        let mut all = Blocks::new(text.as_bytes()).unwrap();
        let before: Vec<usize> = std::iter::from_fn(|| all.take(12).unwrap()).map(|block| block.before).collect();
        assert_eq!(before, [0, 2, 4]);
        assert!(blocks("", 1).is_empty() && blocks("\u{feff}", 1).is_empty());
    }

    #[test]
    fn long_tables_come_whole() {
        let text: String = (0..30_000).map(|i| format!("{i},\"a\nb\"\n")).collect();
        for least in [1, 5000, 1 << 20] {
            let found = blocks(&text, least);
            assert_eq!(found.iter().map(|(_, text)| text.as_str()).collect::<String>(), text);
            let mut lines = 1;
            for (line, text) in found {
                assert_eq!(line, lines);
                lines += text.matches('\n').count() as u64;
            }
        }
    }
}
