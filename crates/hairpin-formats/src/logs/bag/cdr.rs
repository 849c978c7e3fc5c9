//! Numbers and strings as ROS 2 writes them: Common Data Representation of either byte order (OMG DDSI-RTPS 2.3, 10.5;
//! CDR of CORBA 3.3, part 2, 9.3), aligned to their size behind a head of four bytes.

/// What is left of a message, and where in it.
#[derive(Debug, Clone, Copy)]
pub(super) struct Cdr<'a> {
    body: &'a [u8],
    at: usize,
    little: bool,
}

/// Why a message tells nothing.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum NoMessage {
    /// It is shorter than its type, or none of it.
    Broken,
    /// It is one of its type, and its numbers are no place.
    NotFinite,
    /// It is one of its type that tells nothing, and why: `without positions`.
    Unfit(String),
}

type Answer<T> = Result<T, NoMessage>;

impl<'a> Cdr<'a> {
    pub(super) fn of(message: &'a [u8]) -> Answer<Self> {
        let (head, body) = message.split_first_chunk::<4>().ok_or(NoMessage::Broken)?;
        let little = match head[..2] {
            [0, 0] => false,
            [0, 1] => true,
            _ => return Err(NoMessage::Broken),
        };
        Ok(Self { body, at: 0, little })
    }

    fn take<const N: usize>(&mut self) -> Answer<[u8; N]> {
        let from = self.at.next_multiple_of(N);
        let mut bytes = *self.body.get(from..).and_then(|rest| rest.first_chunk()).ok_or(NoMessage::Broken)?;
        self.at = from + N;
        if !self.little {
            bytes.reverse();
        }
        Ok(bytes)
    }

    pub(super) fn u32(&mut self) -> Answer<u32> {
        self.take().map(u32::from_le_bytes)
    }

    pub(super) fn i32(&mut self) -> Answer<i32> {
        self.take().map(i32::from_le_bytes)
    }

    pub(super) fn f64(&mut self) -> Answer<f64> {
        self.take().map(f64::from_le_bytes)
    }

    pub(super) fn numbers<const N: usize>(&mut self) -> Answer<[f64; N]> {
        let mut numbers = [0.0; N];
        for number in &mut numbers {
            *number = self.f64()?;
        }
        Ok(numbers)
    }

    /// A string, whose length counts the zero at its end.
    pub(super) fn string(&mut self) -> Answer<&'a str> {
        let length = self.u32()? as usize;
        let text = self.body.get(self.at..).and_then(|rest| rest.get(..length)).ok_or(NoMessage::Broken)?;
        self.at += length;
        std::str::from_utf8(text.strip_suffix(b"\0").unwrap_or(text)).map_err(|_| NoMessage::Broken)
    }

    /// The length of a sequence of things of this size at least, which must be there.
    pub(super) fn length(&mut self, least: usize) -> Answer<usize> {
        let length = self.u32()? as usize;
        let left = self.body.len().saturating_sub(self.at);
        if length <= left / least { Ok(length) } else { Err(NoMessage::Broken) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_aligned_in_either_order() {
        let little =
            [&[0, 1, 0, 0, 2, 0, 0, 0, b'a', 0, 0, 0][..], &7_u32.to_le_bytes(), &[0; 4], &1.5_f64.to_le_bytes()]
                .concat();
        let big = [&[0, 0, 0, 0, 0, 0, 0, 2, b'a', 0, 9, 9][..], &7_u32.to_be_bytes(), &[9; 4], &1.5_f64.to_be_bytes()]
            .concat();
        for message in [little, big] {
            let mut cdr = Cdr::of(&message).unwrap();
            assert_eq!((cdr.string(), cdr.u32()), (Ok("a"), Ok(7)));
            // Twelve bytes behind the head: the number begins at sixteen.
            assert_eq!((cdr.f64(), cdr.f64()), (Ok(1.5), Err(NoMessage::Broken)));
            let mut cdr = Cdr::of(&message).unwrap();
            assert_eq!(cdr.length(10), Ok(2));
            assert_eq!(Cdr::of(&message).unwrap().length(11), Err(NoMessage::Broken));
        }
        assert!(Cdr::of(&[0, 7, 0, 0, 1]).is_err() && Cdr::of(&[0, 1]).is_err());
    }
}
