//! PX4's ULog: positions, attitudes, missions and modes, in the order in which they were logged.

mod formats;
mod heard;
mod mission;
mod odometry;
mod position;
mod projection;
mod selector;
mod series;
mod stream;
mod topic;

use std::collections::BTreeMap;

use super::error::Fault;
use super::log::{Clock, LogFrame, Logged, Source, Span};
use super::samples::Budget;
use formats::{Formats, Size};
use heard::Heard;
use mission::Flown;
use odometry::attitude;
use position::target;
use series::{Series, What, motions};
use stream::{Message, Messages, broken};
use topic::{Finder, seconds};

pub(super) const MAGIC: &[u8] = stream::MAGIC;
/// Dropouts that are kept.
const MOST_DROPOUTS: usize = 100_000;

pub(super) fn read_ulog(bytes: &[u8]) -> Result<Logged, Fault> {
    let mut messages = Messages::of(bytes)?;
    let mut reader = Reader::default();
    while let Some(message) = messages.next()? {
        match reader.take(&message, messages.is_broken()) {
            Ok(()) => {}
            Err(Trouble::Message(what)) if reader.series.is_empty() => return Err(broken(message.offset, what)),
            Err(Trouble::Message(what)) => messages.skip(message.offset, &what)?,
            Err(Trouble::Log(fault)) => return Err(fault),
        }
    }
    Ok(reader.logged(messages.into_notes()))
}

/// Why a message was not taken.
enum Trouble {
    /// It is broken.
    Message(String),
    /// The log cannot be read.
    Log(Fault),
}

impl From<String> for Trouble {
    fn from(what: String) -> Self {
        Self::Message(what)
    }
}

impl From<Fault> for Trouble {
    fn from(fault: Fault) -> Self {
        Self::Log(fault)
    }
}

#[derive(Debug, Default)]
struct Reader {
    formats: Formats,
    series: Vec<Series>,
    /// Series by `msg_id`.
    ids: BTreeMap<u16, usize>,
    /// Series by topic and instance.
    topics: BTreeMap<(String, u8), usize>,
    flown: Flown,
    budget: Budget,
    now_s: f64,
    dropouts: Vec<Span>,
    info: BTreeMap<&'static str, String>,
    unknown: BTreeMap<u8, usize>,
    lost: usize,
}

impl Reader {
    fn take(&mut self, message: &Message, after_break: bool) -> Result<(), Trouble> {
        let body = message.body;
        match message.kind {
            b'F' => self.formats.define(body)?,
            b'A' => self.subscribe(body, after_break)?,
            b'D' => self.data(body, after_break)?,
            b'O' => self.drop_out(body)?,
            b'I' | b'P' => self.inform(body),
            b'S' if body != stream::SYNC_MAGIC => Err("a synchronisation message without its magic".to_owned())?,
            b'B' | b'M' | b'Q' | b'R' | b'L' | b'C' | b'S' => {}
            // Readers must ignore what they do not know.
            other => *self.unknown.entry(other).or_default() += 1,
        }
        Ok(())
    }

    fn subscribe(&mut self, body: &[u8], after_break: bool) -> Result<(), Trouble> {
        let (Some(&[instance, low, high]), Some(name)) = (body.first_chunk(), body.get(3..)) else {
            return Err(format!("a subscription of {} bytes, must be at least 4", body.len()).into());
        };
        let name = std::str::from_utf8(name).map_err(|_| "a subscription to what is no text".to_owned())?;
        let id = u16::from_le_bytes([low, high]);
        if self.ids.contains_key(&id) {
            // What was appended, or read again behind a broken place, may say it again.
            return if after_break { Ok(()) } else { Err(format!("a second subscription with the id {id}").into()) };
        }
        // One that is subscribed to again goes on under another number.
        if let Some(place) = self.topics.get(&(name.to_owned(), instance)) {
            self.ids.insert(id, *place);
            return Ok(());
        }
        let size = self.formats.size(name)?;
        let finder = Finder { formats: &self.formats, name };
        let stamp = finder.needed("timestamp")?;
        let what = What::of(name, &finder)?;
        self.ids.insert(id, self.series.len());
        self.topics.insert((name.into(), instance), self.series.len());
        self.series.push(Series { name: name.into(), instance, size, stamp, heard: Heard::default(), what });
        Ok(())
    }

    fn data(&mut self, body: &[u8], after_break: bool) -> Result<(), Trouble> {
        let Some((id, data)) = body.split_first_chunk() else {
            return Err(format!("data of {} bytes, must be at least 2", body.len()).into());
        };
        let id = u16::from_le_bytes(*id);
        let Some(place) = self.ids.get(&id) else {
            self.lost += 1;
            return if after_break {
                Ok(())
            } else {
                Err(format!("data with the id {id}, which has no subscription").into())
            };
        };
        let series = &mut self.series[*place];
        let Size { least, most } = series.size;
        if !(least..=most).contains(&data.len()) {
            let what = format!("{} bytes of data of `{}`, must be {most}", data.len(), series.name);
            return Err(what.into());
        }
        let stamp = series.stamp.read(data).unwrap_or(0.0);
        self.now_s = stamp / 1e6;
        series.heard.hear(id, stamp);
        match &mut series.what {
            What::Positions(_, positions) => positions.push(stamp, data, &mut self.budget)?,
            What::Odometry(_, odometry) => odometry.push(stamp, data, &mut self.budget)?,
            What::Attitudes { slots, sample, read } => {
                self.budget.take()?;
                let q = slots.map(|slot| slot.read(data).unwrap_or(f64::NAN));
                if let Some(turn) = attitude(q) {
                    read.push(seconds(stamp, sample.and_then(|slot| slot.read(data))), turn);
                }
            }
            What::Chosen(selector) => selector.push(self.now_s, data, &mut self.budget)?,
            What::Flown(topic) if series.instance == 0 => self.flown.push(topic, self.now_s, data),
            What::Flown(_) | What::Other => {}
        }
        Ok(())
    }

    fn drop_out(&mut self, body: &[u8]) -> Result<(), Trouble> {
        let Some(duration) = body.first_chunk() else {
            return Err("a dropout without its duration".to_owned().into());
        };
        let lasts_s = f64::from(u16::from_le_bytes(*duration)) * 1e-3;
        if self.dropouts.len() < MOST_DROPOUTS {
            self.dropouts.push(Span { from_s: self.now_s, to_s: self.now_s + lasts_s });
        }
        Ok(())
    }

    /// Keeps what is told of the vehicle: a name and a value.
    fn inform(&mut self, body: &[u8]) {
        let Some((length, rest)) = body.split_first() else { return };
        let Some((key, value)) = rest.split_at_checked(usize::from(*length)) else { return };
        let number = value.first_chunk().copied().map(u32::from_le_bytes);
        match (key, number) {
            (b"uint32_t ver_sw_release", Some(release)) => {
                let [_, patch, minor, major] = release.to_le_bytes();
                self.info.insert("release", format!("{major}.{minor}.{patch}"));
            }
            (b"int32_t SDLOG_PROFILE", Some(profile)) => drop(self.info.insert("profile", profile.to_string())),
            _ => {}
        }
    }

    fn logged(self, breaks: Vec<String>) -> Logged {
        let Self { series, flown, dropouts, info, unknown, lost, .. } = self;
        let mut notes = Vec::new();
        if let Some(release) = info.get("release") {
            notes.push(format!("PX4 {release}"));
        }
        if let Some(profile) = info.get("profile") {
            notes.push(format!("SDLOG_PROFILE {profile}"));
        }
        notes.extend(breaks);
        for (kind, count) in unknown {
            notes.push(format!("{count} messages of a type `{}` that is not known", char::from(kind)));
        }
        if lost > 0 {
            notes.push(format!("{lost} messages of data whose subscription was not read"));
        }
        let others = series.iter().filter(|series| matches!(series.what, What::Other)).count();
        if others > 0 {
            notes.push(format!("{others} topics that say nothing of the motion are not read"));
        }
        let best = |source: Source| series.iter().find(|series| series.source() == Some(source) && !series.is_empty());
        let first =
            [Source::MotionCapture, Source::GroundTruth, Source::Estimate, Source::Input].into_iter().find_map(best);
        let origin = first.and_then(Series::reference);
        let frame = match first {
            Some(Series { what: What::Odometry(_, odometry), name, .. }) if odometry.is_frd() => {
                LogFrame::Named(format!("{name} (FRD), its x taken for north"))
            }
            _ => LogFrame::Enu(origin),
        };
        let mut motions = motions(series, origin, &mut notes);
        motions.sort_by_key(|motion| motion.source);
        let progress = flown.progress(|place| origin.map(|origin| target(&origin, place)));
        Logged {
            format: "PX4 ULog",
            clock: Clock::SinceBoot,
            frame,
            motions,
            joints: Vec::new(),
            progress,
            events: flown.into_events(),
            dropouts,
            notes,
        }
    }
}
