//! The records of an MCAP file, with their places: the outermost ones are cut here, so that a spoiled one is told by
//! its byte and takes no room; what is in chunks is unpacked by the crate `mcap`, within bounds.

use mcap::records::op;
use mcap::sans_io::linear_reader::{LinearReadEvent, LinearReader, LinearReaderOptions};

use super::super::error::{Fault, Place};
use crate::foreign;

pub(in super::super) const MAGIC: &[u8] = b"\x89MCAP0\r\n";
/// Bytes of a chunk at most, packed and unpacked: recorders make them a hundred times smaller.
const MOST_CHUNK: usize = 128_000_000;
/// Bytes that one packed byte may stand for, and what a small chunk may have beside: more is no recorder's.
const MOST_PACKED: usize = 1_000;
const SMALL_CHUNK: usize = 1_000_000;
/// Operation and length before each record.
const HEAD: usize = 9;
/// Broken chunks that are told one by one.
const TOLD: usize = 5;

/// What is read of a record.
#[derive(Debug)]
pub(super) enum Record<'a> {
    Schema {
        id: u16,
        name: String,
    },
    Channel {
        id: u16,
        schema: u16,
        topic: String,
        encoding: String,
    },
    /// `offset` is that of the message, or of the chunk that it is in.
    Message {
        channel: u16,
        received_ns: u64,
        offset: usize,
        data: &'a [u8],
    },
}

type Take<'t> = dyn FnMut(Record<'_>) -> Result<(), Fault> + 't;

/// The records of a file.
#[derive(Debug)]
pub(super) struct Records<'a> {
    bytes: &'a [u8],
    notes: Vec<String>,
    broken: usize,
}

impl<'a> Records<'a> {
    pub(super) fn of(bytes: &'a [u8]) -> Result<Self, Fault> {
        Ok(Self { bytes, notes: Vec::new(), broken: 0 })
    }

    /// Hands over all records that are read, in the order of the file.
    pub(super) fn each(&mut self, take: &mut Take) -> Result<(), Fault> {
        self.declare(take)?;
        let mut at = MAGIC.len();
        loop {
            let Some((operation, body)) = self.record(at) else {
                let what = format!("byte {at}: the file ends within a record; read as far as that");
                self.notes.push(what);
                return Ok(());
            };
            match operation {
                op::DATA_END | op::FOOTER => return Ok(()),
                op::CHUNK => self.unpack(at, body, take)?,
                0 => return Err(broken(at, "a record of the operation 0, which there is not")),
                _ => hand(operation, body, at, take)?.unwrap_or_else(|what| self.tell(at, &what)),
            }
            at += HEAD + body.len();
        }
    }

    /// Hands over schemas and channels that stand outside of chunks: the summary at the end repeats those of a chunk
    /// that is spoiled.
    fn declare(&self, take: &mut Take) -> Result<(), Fault> {
        let mut at = MAGIC.len();
        while let Some((operation, body)) = self.record(at) {
            if matches!(operation, op::SCHEMA | op::CHANNEL) {
                // What is wrong with one is told where it stands.
                drop(hand(operation, body, at, take)?);
            }
            at += HEAD + body.len();
        }
        Ok(())
    }

    fn record(&self, at: usize) -> Option<(u8, &'a [u8])> {
        let (operation, rest) = self.bytes.get(at..)?.split_first()?;
        let (length, rest) = rest.split_first_chunk()?;
        let length = usize::try_from(u64::from_le_bytes(*length)).ok()?;
        Some((*operation, rest.get(..length)?))
    }

    fn tell(&mut self, at: usize, what: &str) {
        self.broken += 1;
        if self.broken <= TOLD {
            self.notes.push(format!("byte {at}: {what}; the record is not read"));
        }
    }

    /// The records of a chunk, once all of it is known to be as it was written.
    fn unpack(&mut self, at: usize, body: &[u8], take: &mut Take) -> Result<(), Fault> {
        let length = (body.len() as u64).to_le_bytes();
        let mut input = [&[op::CHUNK][..], &length, body].concat();
        let most = body.len().saturating_mul(MOST_PACKED).saturating_add(SMALL_CHUNK).min(MOST_CHUNK);
        let mut options = LinearReaderOptions::default();
        options = options.with_skip_start_magic(true).with_skip_end_magic(true);
        options = options.with_prevalidate_chunk_crcs(true).with_record_length_limit(most);
        let mut reader = LinearReader::new_with_options(options);
        // What goes wrong while records are taken is no decoder's.
        let mut taken = Ok(());
        let unpacked = foreign::call(|| {
            let mut from = 0;
            loop {
                match reader.next_event() {
                    None => return Ok(()),
                    Some(Err(error)) => return Err(error.to_string()),
                    Some(Ok(LinearReadEvent::ReadRequest(need))) => {
                        let size = need.min(input.len() - from);
                        reader.insert(size).copy_from_slice(&input[from..from + size]);
                        reader.notify_read(size);
                        from += size;
                        if from == input.len() {
                            input = Vec::new();
                            from = 0;
                        }
                    }
                    Some(Ok(LinearReadEvent::Record { data, opcode })) => match hand(opcode, data, at, take) {
                        Ok(Ok(())) => {}
                        Ok(Err(what)) => return Err(what),
                        Err(fault) => {
                            taken = Err(fault);
                            return Ok(());
                        }
                    },
                }
            }
        });
        match unpacked {
            Ok(Ok(())) => {}
            Ok(Err(what)) => self.tell(at, &format!("a broken chunk: {what}")),
            Err(foreign::Panicked) => self.tell(at, "a broken chunk"),
        }
        taken
    }

    /// What was broken, in words.
    pub(super) fn into_notes(mut self) -> Vec<String> {
        if self.broken > TOLD {
            self.notes.push(format!("{} more broken records", self.broken - TOLD));
        }
        self.notes
    }
}

/// Hands over one record; what is wrong with it comes back in words. The crate's own parser makes room for whatever
/// length a text is said to have.
fn hand(operation: u8, body: &[u8], at: usize, take: &mut Take) -> Result<Result<(), String>, Fault> {
    let mut fields = Fields(body);
    let record = match operation {
        op::SCHEMA => fields.schema(),
        op::CHANNEL => fields.channel(),
        op::MESSAGE => fields.message(at),
        _ => return Ok(Ok(())),
    };
    match record {
        Some(record) => take(record).map(Ok),
        None => Ok(Err("a record that is shorter than what it says to hold".into())),
    }
}

/// What is left of a record; numbers begin with their lowest byte, texts with their length.
struct Fields<'a>(&'a [u8]);

impl<'a> Fields<'a> {
    fn bytes<const N: usize>(&mut self) -> Option<[u8; N]> {
        let (first, rest) = self.0.split_first_chunk()?;
        self.0 = rest;
        Some(*first)
    }

    fn text(&mut self) -> Option<String> {
        let length = u32::from_le_bytes(self.bytes()?) as usize;
        let text = self.0.get(..length)?;
        self.0 = &self.0[length..];
        std::str::from_utf8(text).ok().map(str::to_owned)
    }

    fn schema(&mut self) -> Option<Record<'a>> {
        Some(Record::Schema { id: u16::from_le_bytes(self.bytes()?), name: self.text()? })
    }

    fn channel(&mut self) -> Option<Record<'a>> {
        let [id, schema] = [u16::from_le_bytes(self.bytes()?), u16::from_le_bytes(self.bytes()?)];
        Some(Record::Channel { id, schema, topic: self.text()?, encoding: self.text()? })
    }

    fn message(&mut self, offset: usize) -> Option<Record<'a>> {
        let channel = u16::from_le_bytes(self.bytes()?);
        let _number: [u8; 4] = self.bytes()?;
        let received_ns = u64::from_le_bytes(self.bytes()?);
        let _sent: [u8; 8] = self.bytes()?;
        Some(Record::Message { channel, received_ns, offset, data: self.0 })
    }
}

fn broken(at: usize, what: &str) -> Fault {
    Fault::Broken(Place::Byte(at as u64), what.into())
}
