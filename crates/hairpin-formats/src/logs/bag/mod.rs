//! ROS 2 bags as MCAP: poses, odometry, paths and joints, whatever their topics are called.

mod cdr;
mod messages;
mod records;
mod rising;
mod topics;

use std::collections::BTreeMap;

use super::error::Fault;
use super::log::{Clock, LogFrame, Logged};
use super::samples::Budget;
use messages::Kind;
use records::{Record, Records};
use topics::Topic;

pub(super) use records::MAGIC;

/// Topics of other kinds that are named one by one.
const NAMED: usize = 10;

pub(super) fn read_mcap(bytes: &[u8]) -> Result<Logged, Fault> {
    let mut records = Records::of(bytes)?;
    let mut bag = Bag::default();
    records.each(&mut |record| bag.take(record))?;
    bag.logged(records.into_notes())
}

#[derive(Debug)]
enum Channel {
    Read(Box<Topic>),
    /// Of another kind, or in another encoding: its name and what it is.
    Other(String),
}

#[derive(Debug, Default)]
struct Bag {
    schemas: BTreeMap<u16, String>,
    channels: BTreeMap<u16, Channel>,
    /// Messages of channels that were not read.
    lost: usize,
    budget: Budget,
}

impl Bag {
    fn take(&mut self, record: Record) -> Result<(), Fault> {
        match record {
            Record::Schema { id, name } => drop(self.schemas.insert(id, name)),
            Record::Channel { id, schema, topic, encoding } if !self.channels.contains_key(&id) => {
                let name = self.schemas.get(&schema).map_or("of no schema", String::as_str);
                let channel = match Kind::of(name) {
                    Some(kind) if encoding == "cdr" => Channel::Read(Box::new(Topic::of(topic, kind))),
                    _ => Channel::Other(format!("{topic} ({name}, {encoding})")),
                };
                self.channels.insert(id, channel);
            }
            Record::Channel { .. } => {}
            Record::Message { channel, received_ns, offset, data } => match self.channels.get_mut(&channel) {
                Some(Channel::Read(topic)) => topic.push(data, received_ns, offset, &mut self.budget)?,
                Some(Channel::Other(_)) => {}
                None => self.lost += 1,
            },
        }
        Ok(())
    }

    fn logged(self, mut notes: Vec<String>) -> Result<Logged, Fault> {
        if self.lost > 0 {
            notes.push(format!("{} messages whose channel was not read", self.lost));
        }
        let (mut topics, mut others) = (Vec::new(), Vec::new());
        for channel in self.channels.into_values() {
            match channel {
                Channel::Read(topic) => topics.push(*topic),
                Channel::Other(told) => others.push(told),
            }
        }
        // Others write MCAP too.
        let format = if topics.is_empty() && !others.is_empty() { "MCAP" } else { "ROS 2 MCAP" };
        // The frame that is told is that of the first.
        topics.sort_by(|a, b| (a.source(), &a.name).cmp(&(b.source(), &b.name)));
        if !others.is_empty() {
            let named = others.iter().take(NAMED).cloned().collect::<Vec<_>>().join(", ");
            let more = if others.len() > NAMED { format!(" and {} more", others.len() - NAMED) } else { String::new() };
            notes.push(format!("topics that are not read: {named}{more}"));
        }
        // All times are of one clock.
        let stampless: Vec<&str> =
            topics.iter().filter(|topic| topic.is_without_stamps()).map(|topic| &topic.name[..]).collect();
        let clock = if stampless.is_empty() { Clock::Header } else { Clock::Receive };
        if clock == Clock::Receive {
            notes.push(format!(
                "no stamps in the headers of {}: times are when messages were recorded",
                stampless.join(", ")
            ));
        }
        let (mut motions, mut joints) = (Vec::new(), Vec::new());
        let mut frame = None;
        for topic in topics {
            let (in_frame, told) = topic.finish(clock, &mut motions, &mut joints);
            notes.extend(told);
            match (&frame, in_frame) {
                (None, Some(first)) => frame = Some(first),
                (Some(first), Some((topic, other))) if first.1 != other => {
                    notes.push(format!(
                        "{topic} is in the frame `{other}`, {} in `{}`: nothing is turned or moved",
                        first.0, first.1
                    ));
                }
                _ => {}
            }
        }
        if motions.len() > 1 {
            let names: Vec<&str> = motions.iter().map(|motion| &motion.name[..]).collect();
            notes.push(format!("several topics of a motion: {}", names.join(", ")));
        }
        Ok(Logged {
            format,
            clock,
            frame: match frame {
                Some((_, frame)) if !frame.is_empty() => LogFrame::Named(frame),
                _ => LogFrame::Untold,
            },
            motions,
            joints,
            progress: Vec::new(),
            events: Vec::new(),
            dropouts: Vec::new(),
            notes,
        })
    }
}
