//! The messages of a ULog, by the published file format (docs.px4.io, "ULog File Format"), over bytes that may be
//! spoiled.
//!
//! A reader of our own: `px4-ulog` 0.6 (the crate that is kept best) stops at the first broken message without saying
//! where, and cannot go on at the next synchronisation message, which is what these are for. Nothing is copied here: a
//! message is a slice of the file, so what it declares takes no room.

use super::super::error::{Fault, Place};

pub(super) const MAGIC: &[u8] = b"ULog\x01\x12\x35";
/// Magic, version, time of start.
const HEADER: usize = 16;
/// Size and type before each message.
const MESSAGE_HEADER: usize = 3;
/// A synchronisation message as it stands in the file: size 8, type S, magic.
const SYNC: &[u8; 11] = b"\x08\x00S\x2f\x73\x13\x20\x25\x0c\xbb\x12";
/// What is in it.
pub(super) const SYNC_MAGIC: &[u8] = SYNC.split_at(MESSAGE_HEADER).1;
/// The first message's bits that say that data was appended; all others say that this reader cannot read the file.
const DATA_APPENDED: u8 = 1;
/// More broken places than this, and the file is none that was only cut or scratched.
const MOST_BREAKS: usize = 100;
/// Broken places that are told one by one.
const TOLD: usize = 5;

/// A message: its type, its place, what is in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Message<'a> {
    pub(super) offset: usize,
    pub(super) kind: u8,
    pub(super) body: &'a [u8],
}

/// The messages of a file in their order, appended ones behind the others.
#[derive(Debug)]
pub(super) struct Messages<'a> {
    bytes: &'a [u8],
    at: usize,
    /// Where the parts end: data may be appended to a file that stops within a message.
    ends: Vec<usize>,
    breaks: Vec<String>,
    broken: usize,
}

impl<'a> Messages<'a> {
    /// The messages behind the file's header and its flags.
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, Fault> {
        if bytes.len() < HEADER {
            return Err(broken(bytes.len(), format!("the file ends within its header of {HEADER} bytes")));
        }
        let mut messages = Self { bytes, at: HEADER, ends: vec![bytes.len()], breaks: Vec::new(), broken: 0 };
        let version = bytes[MAGIC.len()];
        if version > 1 {
            messages.breaks.push(format!("version {version} of ULog: read as version 1"));
        }
        messages.take_flags()?;
        Ok(messages)
    }

    /// The flags, which are the first message where there are any.
    fn take_flags(&mut self) -> Result<(), Fault> {
        let Some((b'B', body)) = self.peek() else { return Ok(()) };
        let Some(flags) = body.get(..40) else {
            return Err(broken(HEADER, format!("flags of {} bytes, must be at least 40", body.len())));
        };
        let unknown = |(place, bits): (usize, &u8)| if place == 0 { bits & !DATA_APPENDED } else { *bits };
        if let Some(place) = flags[8..16].iter().enumerate().position(|byte| unknown(byte) != 0) {
            let what = format!(
                "flags {:#04x} of a newer ULog, which no reader may read that does not know them",
                flags[8 + place]
            );
            return Err(broken(HEADER + MESSAGE_HEADER + 8 + place, what));
        }
        if flags[8] & DATA_APPENDED == 0 {
            return Ok(());
        }
        let mut before = HEADER + MESSAGE_HEADER + body.len();
        for (place, offset) in flags[16..40].chunks_exact(8).enumerate() {
            let offset = offset.iter().rev().fold(0_u64, |sum, byte| sum << 8 | u64::from(*byte));
            let known = usize::try_from(offset).ok().filter(|offset| (before..=self.bytes.len()).contains(offset));
            match known {
                _ if offset == 0 => break,
                Some(offset) => {
                    before = offset;
                    self.ends.insert(self.ends.len() - 1, offset);
                }
                None if offset > self.bytes.len() as u64 => {
                    self.breaks.push(format!("what was appended at byte {offset} is not there: the file is cut"));
                    break;
                }
                None => {
                    let at = HEADER + MESSAGE_HEADER + 16 + 8 * place;
                    return Err(broken(at, format!("data appended at byte {offset}, must be behind byte {before}")));
                }
            }
        }
        Ok(())
    }

    fn peek(&self) -> Option<(u8, &'a [u8])> {
        let end = *self.ends.iter().find(|end| self.at < **end)?;
        let head = self.bytes[self.at..end].get(..MESSAGE_HEADER)?;
        let size = usize::from(u16::from_le_bytes([head[0], head[1]]));
        let from = self.at + MESSAGE_HEADER;
        Some((head[2], self.bytes[from..end].get(..size)?))
    }

    /// The next message; behind a broken one, the next that is whole.
    pub(super) fn next(&mut self) -> Result<Option<Message<'a>>, Fault> {
        while self.ends.last().is_some_and(|end| self.at < *end) {
            let offset = self.at;
            match self.peek() {
                // Of size 0 there is none, and types are letters.
                Some((kind, body)) if !body.is_empty() && kind.is_ascii_uppercase() => {
                    self.at = offset + MESSAGE_HEADER + body.len();
                    return Ok(Some(Message { offset, kind, body }));
                }
                Some((kind, body)) => {
                    self.skip(offset, &format!("no message: size {}, type {kind:#04x}", body.len()))?;
                }
                None => self.skip(offset, "the file ends within a message")?,
            }
        }
        Ok(None)
    }

    /// Goes on at the next synchronisation message behind a broken one, or at what was appended.
    pub(super) fn skip(&mut self, offset: usize, what: &str) -> Result<(), Fault> {
        self.broken += 1;
        if self.broken > MOST_BREAKS {
            return Err(broken(offset, format!("{what}; {MOST_BREAKS} broken messages before it")));
        }
        let end = self.ends.iter().copied().find(|end| offset < *end).unwrap_or(self.bytes.len());
        let sync = self.bytes[offset + 1..end].windows(SYNC.len()).position(|window| window == SYNC);
        self.at = sync.map_or(end, |place| offset + 1 + place);
        if self.broken <= TOLD {
            let then = match sync {
                Some(_) => format!("read on at byte {}, where the log is in step again", self.at),
                None if end < self.bytes.len() => format!("read on at byte {end}, which was appended"),
                None => "read as far as that".into(),
            };
            self.breaks.push(format!("byte {offset}: {what}; {then}"));
        }
        Ok(())
    }

    /// Whether something before was broken, so that what follows may lack its beginning.
    pub(super) fn is_broken(&self) -> bool {
        self.broken > 0
    }

    /// What was broken, in words.
    pub(super) fn into_notes(mut self) -> Vec<String> {
        if self.broken > TOLD {
            self.breaks.push(format!("{} more broken places", self.broken - TOLD));
        }
        self.breaks
    }
}

pub(super) fn broken(offset: usize, what: impl Into<String>) -> Fault {
    Fault::Broken(Place::Byte(offset as u64), what.into())
}
