//! What the bytes of a ULog's topics are, as the file itself defines it.

use std::collections::HashMap;

/// Sizes of messages are of sixteen bits.
const LARGEST: usize = u16::MAX as usize;
/// Formats in formats; who goes deeper names itself.
const DEEPEST: usize = 16;

/// A type of the format's own.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Plain {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    I64,
    U64,
    F32,
    F64,
}

impl Plain {
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "int8_t" => Self::I8,
            "uint8_t" | "bool" | "char" => Self::U8,
            "int16_t" => Self::I16,
            "uint16_t" => Self::U16,
            "int32_t" => Self::I32,
            "uint32_t" => Self::U32,
            "int64_t" => Self::I64,
            "uint64_t" => Self::U64,
            "float" => Self::F32,
            "double" => Self::F64,
            _ => return None,
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::I64 | Self::U64 | Self::F64 => 8,
        }
    }
}

#[derive(Debug)]
struct Field {
    name: String,
    kind: Kind,
    count: usize,
}

#[derive(Debug)]
enum Kind {
    Plain(Plain),
    /// Another format.
    Nested(String),
}

/// A number in a topic's data.
#[derive(Debug, Clone, Copy)]
pub(super) struct Slot {
    offset: usize,
    kind: Plain,
}

impl Slot {
    /// The number; integers beyond 2⁵³ are rounded, which no stamp is.
    pub(super) fn read(self, data: &[u8]) -> Option<f64> {
        fn of<const N: usize>(data: &[u8]) -> Option<[u8; N]> {
            data.first_chunk().copied()
        }
        let data = data.get(self.offset..)?;
        Some(match self.kind {
            Plain::I8 => f64::from(i8::from_le_bytes(of(data)?)),
            Plain::U8 => f64::from(u8::from_le_bytes(of(data)?)),
            Plain::I16 => f64::from(i16::from_le_bytes(of(data)?)),
            Plain::U16 => f64::from(u16::from_le_bytes(of(data)?)),
            Plain::I32 => f64::from(i32::from_le_bytes(of(data)?)),
            Plain::U32 => f64::from(u32::from_le_bytes(of(data)?)),
            Plain::I64 => i64::from_le_bytes(of(data)?) as f64,
            Plain::U64 => u64::from_le_bytes(of(data)?) as f64,
            Plain::F32 => f64::from(f32::from_le_bytes(of(data)?)),
            Plain::F64 => f64::from_le_bytes(of(data)?),
        })
    }
}

/// Bytes of a topic's data: all, and all but padding at the end, which writers leave out.
#[derive(Debug, Clone, Copy)]
pub(super) struct Size {
    pub(super) most: usize,
    pub(super) least: usize,
}

/// The formats of a file.
#[derive(Debug, Default)]
pub(super) struct Formats {
    fields: HashMap<String, Vec<Field>>,
    sizes: HashMap<String, Size>,
}

impl Formats {
    /// Takes in a definition, `name:type field;type[n] field;`.
    pub(super) fn define(&mut self, body: &[u8]) -> Result<(), String> {
        let text = std::str::from_utf8(body).map_err(|_| "a format that is no text")?;
        let (name, fields) = text.split_once(':').ok_or("a format without a name")?;
        let fields: Vec<Field> =
            fields.split(';').filter(|field| !field.is_empty()).map(field).collect::<Result<_, _>>()?;
        let known = |c: char| c.is_ascii_alphanumeric() || "_-/".contains(c);
        if name.is_empty() || !name.chars().all(known) || Plain::of(name).is_some() {
            return Err(format!("a format of the name `{}`", name.escape_default()));
        }
        if fields.is_empty() {
            return Err(format!("the format `{name}` has no fields"));
        }
        self.fields.insert(name.into(), fields);
        Ok(())
    }

    /// How large data of a format is.
    pub(super) fn size(&mut self, name: &str) -> Result<Size, String> {
        self.size_within(name, 0)
    }

    fn size_within(&mut self, name: &str, depth: usize) -> Result<Size, String> {
        if let Some(size) = self.sizes.get(name) {
            return Ok(*size);
        }
        if depth > DEEPEST {
            return Err(format!("the format `{name}` holds itself"));
        }
        let nested: Vec<String> = self.nested(name)?;
        for other in nested {
            self.size_within(&other, depth + 1)?;
        }
        let (mut most, mut least) = (0, 0);
        for field in self.fields.get(name).into_iter().flatten() {
            most += self.size_of(field) * field.count;
            if most > LARGEST {
                return Err(format!("the format `{name}` is larger than {LARGEST} bytes"));
            }
            if !field.name.starts_with("_padding") {
                least = most;
            }
        }
        let size = Size { most, least };
        self.sizes.insert(name.into(), size);
        Ok(size)
    }

    fn nested(&self, name: &str) -> Result<Vec<String>, String> {
        let fields = self.fields.get(name).ok_or_else(|| format!("no format is named `{}`", name.escape_default()))?;
        let other = |field: &Field| match &field.kind {
            Kind::Nested(other) => Some(other.clone()),
            Kind::Plain(_) => None,
        };
        Ok(fields.iter().filter_map(other).collect())
    }

    /// What is known of a field's size: of nested ones once they were asked for.
    fn size_of(&self, field: &Field) -> usize {
        match &field.kind {
            Kind::Plain(plain) => plain.size(),
            Kind::Nested(other) => self.sizes.get(other).map_or(0, |size| size.most),
        }
    }

    /// Where a number is in data of a format: `x`, `q` and 2, `current.lat`. The format's size was asked for before.
    pub(super) fn slot(&self, format: &str, path: &str, element: usize) -> Option<Slot> {
        let (first, rest) = path.split_once('.').map_or((path, None), |(first, rest)| (first, Some(rest)));
        let mut offset = 0;
        for field in self.fields.get(format)? {
            if field.name == first {
                return match (&field.kind, rest) {
                    (Kind::Plain(kind), None) if element < field.count => {
                        Some(Slot { offset: offset + element * kind.size(), kind: *kind })
                    }
                    (Kind::Nested(other), Some(rest)) => {
                        let slot = self.slot(other, rest, element)?;
                        Some(Slot { offset: offset + slot.offset, ..slot })
                    }
                    _ => None,
                };
            }
            offset += self.size_of(field) * field.count;
        }
        None
    }
}

/// `type name` or `type[count] name`.
fn field(text: &str) -> Result<Field, String> {
    let wrong = || format!("a format's field `{}`, must be `type name` or `type[count] name`", text.escape_default());
    let (kind, name) = text.trim().split_once(' ').ok_or_else(wrong)?;
    let (kind, count) = match kind.split_once('[') {
        None => (kind, 1),
        Some((kind, count)) => {
            let count = count.strip_suffix(']').and_then(|count| count.parse().ok());
            (kind, count.filter(|count| (1..=LARGEST).contains(count)).ok_or_else(wrong)?)
        }
    };
    if name.is_empty() || kind.is_empty() {
        return Err(wrong());
    }
    let kind = Plain::of(kind).map_or_else(|| Kind::Nested(kind.into()), Kind::Plain);
    Ok(Field { name: name.into(), kind, count })
}
