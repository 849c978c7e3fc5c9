//! Messages as protocol buffers (protobuf.dev, "Encoding"): a tag and a value for each field that is not zero.

/// A message that grows.
#[derive(Debug, Default, Clone)]
pub(super) struct Message(Vec<u8>);

/// Kinds of values on the wire.
const VARINT: u64 = 0;
const FIXED64: u64 = 1;
const LENGTH: u64 = 2;

impl Message {
    fn varint(&mut self, mut value: u64) {
        while value >= 0x80 {
            self.0.push(value as u8 | 0x80);
            value >>= 7;
        }
        self.0.push(value as u8);
    }

    fn tag(&mut self, field: u32, kind: u64) {
        self.varint(u64::from(field) << 3 | kind);
    }

    pub(super) fn integer(mut self, field: u32, value: u64) -> Self {
        if value != 0 {
            self.tag(field, VARINT);
            self.varint(value);
        }
        self
    }

    pub(super) fn double(mut self, field: u32, value: f64) -> Self {
        if value.to_bits() != 0 {
            self.tag(field, FIXED64);
            self.0.extend(value.to_le_bytes());
        }
        self
    }

    pub(super) fn bytes(mut self, field: u32, value: &[u8]) -> Self {
        self.tag(field, LENGTH);
        self.varint(value.len() as u64);
        self.0.extend(value);
        self
    }

    pub(super) fn string(self, field: u32, value: &str) -> Self {
        if value.is_empty() { self } else { self.bytes(field, value.as_bytes()) }
    }

    pub(super) fn message(self, field: u32, value: &Self) -> Self {
        self.bytes(field, &value.0)
    }

    pub(super) fn messages(self, field: u32, values: impl IntoIterator<Item = Self>) -> Self {
        values.into_iter().fold(self, |message, value| message.message(field, &value))
    }

    /// Numbers of 32 bits, packed.
    pub(super) fn fixed32(self, field: u32, values: impl IntoIterator<Item = u32>) -> Self {
        let packed: Vec<u8> = values.into_iter().flat_map(u32::to_le_bytes).collect();
        if packed.is_empty() { self } else { self.bytes(field, &packed) }
    }

    pub(super) fn doubles<const N: usize>(self, values: [f64; N]) -> Self {
        (1..).zip(values).fold(self, |message, (field, value)| message.double(field, value))
    }

    pub(super) fn into_bytes(self) -> Vec<u8> {
        self.0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The examples of the format's page: field 1 = 150, field 2 = "testing", field 3 = the first.
    #[test]
    fn published_bytes() {
        let first = Message::default().integer(1, 150);
        assert_eq!(first.0, [0x08, 0x96, 0x01]);
        let text = Message::default().string(2, "testing");
        assert_eq!(text.0, [0x12, 0x07, 0x74, 0x65, 0x73, 0x74, 0x69, 0x6e, 0x67]);
        assert_eq!(Message::default().message(3, &first).0, [0x1a, 0x03, 0x08, 0x96, 0x01]);
        assert!(Message::default().integer(1, 0).double(2, 0.0).string(3, "").0.is_empty());
    }
}
