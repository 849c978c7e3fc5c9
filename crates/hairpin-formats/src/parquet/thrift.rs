//! The skeleton of Parquet's headers (Thrift's compact protocol): how long they are and what sizes they claim, before a
//! decoder takes room for these.

/// Structures within structures, at most: the format has eight.
const DEEPEST: usize = 24;

/// Bytes of a header, read from the front.
///
/// Footers of a thousand row groups have a million of them: that they end too soon is noted once, and not asked of
/// every byte's caller.
pub(super) struct Walker<'b> {
    bytes: &'b [u8],
    at: usize,
    /// More was asked for than there is, or a number was longer than any.
    is_over: bool,
}

impl<'b> Walker<'b> {
    pub(super) fn new(bytes: &'b [u8]) -> Self {
        Self { bytes, at: 0, is_over: false }
    }

    /// Bytes read so far.
    pub(super) fn position(&self) -> usize {
        self.at
    }

    /// Walks through one structure and hands every whole number in it to `found`, by field; `None`: it is none, or
    /// claims a list or a text longer than the bytes that are left.
    pub(super) fn structure(&mut self, found: &mut dyn FnMut(i64, i64)) -> Option<()> {
        self.fields(0, found)
    }

    fn fields(&mut self, depth: usize, found: &mut dyn FnMut(i64, i64)) -> Option<()> {
        if depth > DEEPEST {
            return None;
        }
        let mut field = 0_i64;
        while !self.is_over {
            let head = self.byte();
            if head == 0 {
                break;
            }
            field = match head >> 4 {
                0 => self.number(),
                step => field.wrapping_add(i64::from(step)),
            };
            let kind = head & 0x0f;
            if let (4..=6, 0) = (kind, depth) {
                let number = self.number();
                found(field, number);
            } else {
                self.value(kind, depth, false)?;
            }
        }
        (!self.is_over).then_some(())
    }

    fn value(&mut self, kind: u8, depth: usize, in_list: bool) -> Option<()> {
        match kind {
            // Truth values are their own kind in a field, and a byte in a list.
            1 | 2 if !in_list => {}
            1..=3 => self.pass(1),
            4..=6 => drop(self.unsigned()),
            7 => self.pass(8),
            8 => {
                let length = self.unsigned();
                self.pass(length);
            }
            9 | 10 => {
                let head = self.byte();
                let size = match head >> 4 {
                    15 => self.unsigned(),
                    size => u64::from(size),
                };
                // Each item takes a byte at least.
                if size > (self.bytes.len() - self.at) as u64 {
                    return None;
                }
                for _ in 0..size {
                    self.value(head & 0x0f, depth + 1, true)?;
                }
            }
            12 => return self.fields(depth + 1, &mut |_, _| ()),
            _ => return None,
        }
        Some(())
    }

    /// The next byte; 0 beyond the end.
    #[inline]
    fn byte(&mut self) -> u8 {
        if self.at >= self.bytes.len() {
            self.is_over = true;
            return 0;
        }
        self.at += 1;
        self.bytes[self.at - 1]
    }

    fn pass(&mut self, bytes: u64) {
        self.is_over |= bytes > (self.bytes.len() - self.at) as u64;
        if !self.is_over {
            self.at += bytes as usize;
        }
    }

    #[inline]
    fn unsigned(&mut self) -> u64 {
        let (mut number, mut shift) = (0_u64, 0);
        while shift < 64 {
            let byte = self.byte();
            number |= u64::from(byte & 0x7f) << shift;
            if byte < 0x80 {
                return number;
            }
            shift += 7;
        }
        self.is_over = true;
        0
    }

    /// Zigzag: the sign is the last bit.
    fn number(&mut self) -> i64 {
        let number = self.unsigned();
        (number >> 1) as i64 ^ -((number & 1) as i64)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_found_by_their_fields() {
        // Field 1: 0; field 2: 300; field 4: a list of two structures; field 20: −1.
        let bytes = [0x15, 0x00, 0x15, 0xd8, 0x04, 0x29, 0x2c, 0x15, 0x02, 0x00, 0x00, 0x05, 0x28, 0x01, 0x00, 0xff];
        let mut found = Vec::new();
        let mut walker = Walker::new(&bytes);
        assert_eq!(walker.structure(&mut |field, number| found.push((field, number))), Some(()));
        assert_eq!((found, walker.position()), (vec![(1, 0), (2, 300), (20, -1)], 15));
        let long = [0x19, 0xfc, 0xff, 0xff, 0xff, 0x7f, 0x00];
        assert_eq!(Walker::new(&long).structure(&mut |_, _| ()), None);
        // A text of 200 bytes, a number of eleven, and nothing more.
        let short: [&[u8]; 4] = [
            &[0x18, 0xc8, 0x01, 0x00],
            &[0x16, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0x00],
            &[0x15],
            &[],
        ];
        assert!(short.iter().all(|bytes| Walker::new(bytes).structure(&mut |_, _| ()).is_none()));
        let deep = [0x1c; 100];
        assert_eq!(Walker::new(&deep).structure(&mut |_, _| ()), None);
    }
}
