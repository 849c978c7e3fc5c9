//! A file with its channels: messages in the order of their times, in chunks with an index.

use std::collections::BTreeMap;
use std::io::Cursor;
use std::path::Path;

use ::mcap::records::{MessageHeader, Metadata};
use ::mcap::{Compression, WriteOptions};

use super::McapError;
use crate::atomic;

/// Longest time that fits the seconds of ROS' messages.
const LONGEST: f64 = 2_147_483_647.0;

/// A file that is filled and then written at once.
pub(super) struct Writer<'p> {
    path: &'p Path,
    inner: ::mcap::Writer<Cursor<Vec<u8>>>,
    schemas: BTreeMap<&'static str, u16>,
    messages: Vec<Message>,
}

struct Message {
    time_ns: u64,
    channel: u16,
    data: Vec<u8>,
}

impl<'p> Writer<'p> {
    pub(super) fn new(path: &'p Path, profile: &str) -> Result<Self, McapError> {
        // One thread packs: bytes are the same on every machine.
        let options = WriteOptions::new().profile(profile).library(concat!("hairpin ", env!("CARGO_PKG_VERSION")));
        let options = options.compression(Some(Compression::Zstd)).compression_threads(0);
        let inner = options.create(Cursor::new(Vec::new())).map_err(|error| refused(path, &error))?;
        Ok(Self { path, inner, schemas: BTreeMap::new(), messages: Vec::new() })
    }

    /// A channel of messages of the schema `name`, whose text is made where it is the first.
    pub(super) fn channel(
        &mut self,
        topic: &str,
        (name, encoding): (&'static str, &str),
        text: impl FnOnce() -> Vec<u8>,
        message_encoding: &str,
        metadata: &BTreeMap<String, String>,
    ) -> Result<u16, McapError> {
        let path = self.path;
        let schema = match self.schemas.get(name) {
            Some(schema) => *schema,
            None => self.inner.add_schema(name, encoding, &text()).map_err(|error| refused(path, &error))?,
        };
        self.schemas.insert(name, schema);
        self.inner.add_channel(schema, topic, message_encoding, metadata).map_err(|error| refused(path, &error))
    }

    pub(super) fn push(&mut self, channel: u16, time_ns: u64, data: Vec<u8>) {
        self.messages.push(Message { time_ns, channel, data });
    }

    /// The times of a topic in nanoseconds.
    pub(super) fn nanoseconds(&self, topic: &str, times_s: &[f64]) -> Result<Vec<u64>, McapError> {
        let mut before = None;
        let one = |time: &f64| {
            let now = (0.0..LONGEST).contains(time).then(|| (time * 1e9).round() as u64);
            let now = now.filter(|now| before.is_none_or(|before| before < *now));
            before = now;
            now.ok_or_else(|| McapError::Time { path: self.path.into(), topic: topic.into(), value: *time })
        };
        times_s.iter().map(one).collect()
    }

    /// Writes the file.
    pub(super) fn finish(mut self, facts: &[(&str, String)]) -> Result<(), McapError> {
        let path = self.path;
        self.messages.sort_by_key(|message| message.time_ns);
        let mut sequences: BTreeMap<u16, u32> = BTreeMap::new();
        for Message { time_ns, channel, data } in &self.messages {
            let next = sequences.entry(*channel).or_default();
            let header =
                MessageHeader { channel_id: *channel, sequence: *next, log_time: *time_ns, publish_time: *time_ns };
            *next += 1;
            self.inner.write_to_known_channel(&header, data).map_err(|error| refused(path, &error))?;
        }
        let facts = facts.iter().map(|(key, value)| ((*key).to_owned(), value.clone())).collect();
        let metadata = Metadata { name: "hairpin".into(), metadata: facts };
        self.inner.write_metadata(&metadata).map_err(|error| refused(path, &error))?;
        self.inner.finish().map_err(|error| refused(path, &error))?;
        Ok(atomic::write(path, &self.inner.into_inner().into_inner())?)
    }
}

fn refused(path: &Path, error: &::mcap::McapError) -> McapError {
    McapError::Format { path: path.into(), cause: error.to_string() }
}
