//! The messages of a DataFlash log, which describes itself (ArduPilot's `AP_Logger/README.md` and `LogStructure.h`):
//! each begins with two fixed bytes and its type, and FMT says how long messages of a type are and what is in them.

use std::collections::BTreeMap;

use super::super::error::{Fault, Place};

const HEAD: [u8; 2] = [0xa3, 0x95];
/// Head and type.
const HEADER: usize = 3;
/// The type of FMT, which its own description may not change.
const FMT: u8 = 128;
/// Bytes of FMT behind its header: type, length, name, format, labels.
const DESCRIPTION: usize = 1 + 1 + 4 + 16 + 64;
/// The first bytes of each log: the description of FMT itself.
pub(in super::super) const MAGIC: &[u8] = &[0xa3, 0x95, FMT];
const MOST_BREAKS: usize = 100;
/// Broken places that are told one by one.
const TOLD: usize = 5;

/// A type of messages.
#[derive(Debug, Clone)]
pub(super) struct Format {
    pub(super) name: String,
    /// With its header.
    length: usize,
    /// Name, letter, place behind the header.
    fields: Vec<(String, u8, usize)>,
}

/// Fields that are read, with the units that they may have where a log tells them (FMTU; `m`, `n` for m/s, `d` for
/// degrees, `D`, `U` and `h` for degrees of latitude, longitude and heading).
const UNITS: [(&str, &str); 12] = [
    ("Lat", "D"),
    ("Lng", "U"),
    ("Alt", "m"),
    ("PN", "m"),
    ("PE", "m"),
    ("PD", "m"),
    ("VN", "n"),
    ("VE", "n"),
    ("VD", "n"),
    ("Roll", "d"),
    ("Pitch", "d"),
    ("Yaw", "dh"),
];
/// Messages of which they are.
const READ: [&str; 8] = ["POS", "SIM", "XKF1", "NKF1", "AHR2", "GPS", "ATT", "ORGN"];

/// Bytes of a value of a letter.
fn size(letter: u8) -> Option<usize> {
    Some(match letter {
        b'b' | b'B' | b'M' => 1,
        b'h' | b'H' | b'c' | b'C' | b'g' => 2,
        b'i' | b'I' | b'f' | b'e' | b'E' | b'L' | b'n' => 4,
        b'd' | b'q' | b'Q' => 8,
        b'N' => 16,
        b'Z' | b'a' => 64,
        _ => return None,
    })
}

fn text(bytes: &[u8]) -> Option<&str> {
    let end = bytes.iter().position(|byte| *byte == 0).unwrap_or(bytes.len());
    std::str::from_utf8(&bytes[..end]).ok()
}

impl Format {
    fn of(body: &[u8; DESCRIPTION]) -> Option<(u8, Self)> {
        let name = text(&body[2..6])?.to_owned();
        let labels = text(&body[22..])?;
        let mut place = 0;
        let mut fields = Vec::new();
        let mut labels = labels.split(',');
        for letter in text(&body[6..22])?.bytes() {
            fields.push((labels.next().unwrap_or_default().to_owned(), letter, place));
            place += size(letter)?;
        }
        let length = usize::from(body[1]);
        (length == place + HEADER).then_some((body[0], Self { name, length, fields }))
    }
}

impl Format {
    /// What is wrong with the units and multipliers that FMTU gives; letters that stand for hundredths or for 10⁻⁷
    /// degrees have theirs already.
    fn strange(&self, units: &str, multipliers: &str) -> Option<String> {
        let mut given = units.chars().zip(multipliers.chars());
        self.fields.iter().find_map(|(name, letter, _)| {
            let (unit, multiplier) = given.next()?;
            let (_, known) = UNITS.iter().find(|(field, _)| field == name)?;
            let scale = match letter {
                b'c' | b'C' | b'e' | b'E' => 'B',
                b'L' => 'G',
                _ => '0',
            };
            let is_known = known.contains(unit) || "-?".contains(unit);
            let is_plain = multiplier == scale || "-?".contains(multiplier);
            (!is_known || !is_plain).then(|| {
                format!("{}: `{name}` has the unit `{unit}` and the multiplier `{multiplier}`: not read", self.name)
            })
        })
    }
}

/// A message.
#[derive(Debug, Clone, Copy)]
pub(super) struct Message<'a> {
    pub(super) format: &'a Format,
    body: &'a [u8],
}

impl<'a> Message<'a> {
    /// A number in its own unit: letters that stand for hundredths, or for 10⁻⁷ degrees, are taken for what they are.
    pub(super) fn number(&self, name: &str) -> Option<f64> {
        fn of<const N: usize>(data: &[u8]) -> Option<[u8; N]> {
            data.first_chunk().copied()
        }
        let (_, letter, place) = self.format.fields.iter().find(|(field, ..)| field == name)?;
        let data = self.body.get(*place..)?;
        Some(match letter {
            b'b' => f64::from(i8::from_le_bytes(of(data)?)),
            b'B' | b'M' => f64::from(u8::from_le_bytes(of(data)?)),
            b'h' => f64::from(i16::from_le_bytes(of(data)?)),
            b'H' => f64::from(u16::from_le_bytes(of(data)?)),
            b'c' => f64::from(i16::from_le_bytes(of(data)?)) / 100.0,
            b'C' => f64::from(u16::from_le_bytes(of(data)?)) / 100.0,
            b'i' => f64::from(i32::from_le_bytes(of(data)?)),
            b'I' => f64::from(u32::from_le_bytes(of(data)?)),
            b'e' => f64::from(i32::from_le_bytes(of(data)?)) / 100.0,
            b'E' => f64::from(u32::from_le_bytes(of(data)?)) / 100.0,
            b'L' => f64::from(i32::from_le_bytes(of(data)?)) / 1e7,
            b'f' => f64::from(f32::from_le_bytes(of(data)?)),
            b'd' => f64::from_le_bytes(of(data)?),
            b'q' => i64::from_le_bytes(of(data)?) as f64,
            b'Q' => u64::from_le_bytes(of(data)?) as f64,
            _ => return None,
        })
    }

    pub(super) fn numbers<const N: usize>(&self, names: [&str; N]) -> Option<[f64; N]> {
        let mut numbers = [0.0; N];
        for (number, name) in numbers.iter_mut().zip(names) {
            *number = self.number(name).filter(|number| number.is_finite())?;
        }
        Some(numbers)
    }

    /// The steps of numbers that their letters tell: of integers and of what is made of them; 0 of all others.
    pub(super) fn steps<const N: usize>(&self, names: [&str; N]) -> Option<[f64; N]> {
        let mut steps = [0.0; N];
        for (step, name) in steps.iter_mut().zip(names) {
            let (_, letter, _) = self.format.fields.iter().find(|(field, ..)| field == name)?;
            *step = match letter {
                b'f' | b'd' => 0.0,
                b'c' | b'C' | b'e' | b'E' => 1e-2,
                b'L' => 1e-7,
                _ => 1.0,
            };
        }
        Some(steps)
    }

    pub(super) fn text(&self, name: &str) -> Option<&'a str> {
        let (_, letter, place) = self.format.fields.iter().find(|(field, ..)| field == name)?;
        let of_text = matches!(letter, b'n' | b'N' | b'Z');
        text(self.body.get(*place..)?.get(..size(*letter)?)?).filter(|_| of_text)
    }

    /// Since boot, s.
    pub(super) fn time(&self) -> Option<f64> {
        self.number("TimeUS").map(|time| time / 1e6).or_else(|| self.number("TimeMS").map(|time| time / 1e3))
    }
}

/// Hands over all messages but descriptions, and gives what was broken in words.
pub(super) fn each(bytes: &[u8], mut take: impl FnMut(&Message) -> Result<(), Fault>) -> Result<Vec<String>, Fault> {
    let mut formats: BTreeMap<u8, Format> = BTreeMap::new();
    let (mut at, mut broken, mut notes) = (0, 0, Vec::new());
    while at < bytes.len() {
        let what = match message(bytes, at, &formats) {
            Found::Description(body) => {
                at += HEADER + DESCRIPTION;
                match Format::of(body) {
                    Some((kind, format)) => drop(formats.insert(kind, format)),
                    None if notes.len() < TOLD => {
                        let place = at - HEADER - DESCRIPTION;
                        notes.push(format!("byte {place}: a description of messages that is none"));
                    }
                    None => {}
                }
                continue;
            }
            Found::Message(message) => {
                at += message.format.length;
                if message.format.name != "FMTU" {
                    take(&message)?;
                    continue;
                }
                let units = (message.number("FmtType"), message.text("UnitIds"), message.text("MultIds"));
                let (Some(kind), Some(units), Some(multipliers)) = units else { continue };
                let format = formats.get(&(kind as u8)).filter(|format| READ.contains(&&format.name[..]));
                if let Some(what) = format.and_then(|format| format.strange(units, multipliers)) {
                    notes.push(what);
                    // Its messages are passed over, as those of a name that nobody reads.
                    formats.entry(kind as u8).and_modify(|format| format.name.clear());
                }
                continue;
            }
            Found::Broken(what) => what,
        };
        broken += 1;
        if broken > MOST_BREAKS {
            let what = format!("{what}; {MOST_BREAKS} broken messages before it");
            return Err(Fault::Broken(Place::Byte(at as u64), what));
        }
        let next = in_step(bytes, at + 1, &formats);
        if broken <= TOLD {
            let then = next.map_or("read as far as that".into(), |next| format!("read on at byte {next}"));
            notes.push(format!("byte {at}: {what}; {then}"));
        }
        at = next.unwrap_or(bytes.len());
    }
    if broken > TOLD {
        notes.push(format!("{} more broken places", broken - TOLD));
    }
    Ok(notes)
}

enum Found<'a> {
    Description(&'a [u8; DESCRIPTION]),
    Message(Message<'a>),
    Broken(String),
}

fn message<'a>(bytes: &'a [u8], at: usize, formats: &'a BTreeMap<u8, Format>) -> Found<'a> {
    let ends = || Found::Broken("the log ends within a message".into());
    let Some((head, rest)) = bytes[at..].split_first_chunk::<HEADER>() else { return ends() };
    if head[..2] != HEAD {
        return Found::Broken("no message".into());
    }
    if head[2] == FMT {
        return rest.first_chunk().map_or_else(ends, Found::Description);
    }
    let Some(format) = formats.get(&head[2]) else {
        return Found::Broken(format!("a message of the type {}, which nothing describes", head[2]));
    };
    rest.get(..format.length - HEADER).map_or_else(ends, |body| Found::Message(Message { format, body }))
}

/// Where a message begins behind which another one begins, or nothing more is.
fn in_step(bytes: &[u8], from: usize, formats: &BTreeMap<u8, Format>) -> Option<usize> {
    let length = |at: usize| match bytes.get(at + 2) {
        Some(&FMT) => Some(HEADER + DESCRIPTION),
        Some(kind) => formats.get(kind).map(|format| format.length),
        None => None,
    };
    let begins = |at: usize| bytes[at..].starts_with(&HEAD);
    (from..bytes.len()).find(|at| {
        begins(*at)
            && length(*at)
                .is_some_and(|length| at + length == bytes.len() || at + length < bytes.len() && begins(at + length))
    })
}
