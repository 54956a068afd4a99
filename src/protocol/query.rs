//! The queries that end a frame, by whose replies it is known to have arrived.
//!
//! Every terminal answers [`FENCE`] (DA1), but all its replies are alike: they can only be counted. A terminal that
//! also reports modes which it does not know (DECRQM) repeats their number in the reply. So a mode that does not exist
//! is a sequence number, and a reply that is lost, late, doubled or foreign is recognised.
//!
//! The numbers have three digits, because each digit is one byte more in every frame, and because no terminal is known
//! to use a private mode from 200 to 999. (A cursor position, CPR, would be answered by more terminals, but asking for
//! one of our choosing moves the cursor: 10 to 14 bytes a frame instead of 8, and none in a window of a single row, whose
//! replies are those of Shift+F3.)

use std::ops::RangeInclusive;

/// The query that every terminal answers (DA1).
pub const FENCE: &[u8] = b"\x1b[c";

/// The modes that do not exist.
const NUMBERS: RangeInclusive<u16> = 200..=999;

/// A query whose reply repeats its number: DECRQM of a private mode that does not exist.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tag(u16);

impl Tag {
    /// Asked once in the queries of the start. A terminal that answers it answers all others.
    pub const FIRST: Self = Self(*NUMBERS.start());

    /// The one after this, which is never [`FIRST`](Self::FIRST). There are 799 of them: at 60 frames a second a
    /// number comes again after 13 s.
    pub fn next(self) -> Self {
        Self(if self.0 < *NUMBERS.end() { self.0 + 1 } else { Self::FIRST.0 + 1 })
    }

    /// The tag whose reply tells of this private mode, if one's does.
    pub fn of_mode(mode: u16) -> Option<Self> {
        NUMBERS.contains(&mode).then_some(Self(mode))
    }

    /// The bytes that ask.
    pub fn query(self) -> [u8; 8] {
        let [hundreds, tens, ones] = [self.0 / 100, self.0 / 10 % 10, self.0 % 10].map(|digit| b'0' + digit as u8);
        [0x1b, b'[', b'?', hundreds, tens, ones, b'$', b'p']
    }

    /// The tag that these bytes end with, if they end with one.
    pub(super) fn at_end_of(bytes: &[u8]) -> Option<Self> {
        let &[hundreds, tens, ones] = bytes.strip_suffix(b"$p")?.last_chunk()?;
        let digits = [hundreds, tens, ones].map(|digit| u16::from(digit.wrapping_sub(b'0')));
        let number = digits.iter().try_fold(0, |number, &digit| (digit < 10).then_some(10 * number + digit))?;
        Self::of_mode(number).filter(|tag| bytes.ends_with(&tag.query()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_tag_is_read_back_from_its_query_and_its_reply() {
        let mut tag = Tag::FIRST;
        for _ in 0..799 {
            tag = tag.next();
            assert_ne!(tag, Tag::FIRST);
            let query = [b"frame", &tag.query()[..]].concat();
            assert_eq!(Tag::at_end_of(&query), Some(tag));
            let text = std::str::from_utf8(&query).expect("a query is ASCII");
            let number = text.strip_prefix("frame\x1b[?").and_then(|rest| rest.strip_suffix("$p"));
            assert_eq!(number.and_then(|number| Tag::of_mode(number.parse().ok()?)), Some(tag));
        }
        assert_eq!(tag.next(), Tag::FIRST.next(), "the numbers begin again");
    }

    #[test]
    fn other_queries_are_no_tags() {
        for bytes in
            [&b"\x1b[?2026$p"[..], b"\x1b[?1006$p", b"\x1b[?25$p", b"\x1b[c", b"300$p", b"$p", b"", b"\x1b[?3a0$p"]
        {
            assert_eq!(Tag::at_end_of(bytes), None, "{}", bytes.escape_ascii());
        }
        for mode in [1, 25, 199, 1000, 2026] {
            assert_eq!(Tag::of_mode(mode), None);
        }
    }
}
