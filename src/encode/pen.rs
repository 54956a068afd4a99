//! The pen: the colours and attributes that the terminal would write with now, and what it costs to change them.

use super::numbers::{band_digits, digits, write_bands, write_number};
use crate::grid::{Attributes, Cell, Glyph, Ink};
use std::mem;

/// The colours and attributes that the terminal would write with now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pen {
    pub(super) fg: Ink,
    pub(super) bg: Ink,
    pub(super) underline: Ink,
    pub(super) attributes: Attributes,
}

impl Pen {
    /// Back to the terminal's own colours, said even if they hold already.
    pub(crate) fn reset(&mut self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(b"\x1b[0m");
        *self = Self::default();
    }

    /// The cell's character in its colours, for a file; only what differs from the pen is said, one colour at a time: what
    /// saves bytes on a screen does not change files.
    pub(crate) fn write_cell(&mut self, cell: &Cell, bytes: &mut Vec<u8>) {
        let wanted = self.as_it_stands(cell);
        self.become_pen(Self { fg: self.before_colors(wanted.attributes).fg, ..wanted }, bytes);
        self.become_pen(wanted, bytes);
        write_glyph(&cell.glyph, bytes);
    }

    /// The pen with which the cell is to be written. A plain space of the colour that the pen has for glyphs is cheapest
    /// with the pen's two colours exchanged: to say so takes four bytes, to say the colour again, as the one behind, about
    /// nineteen.
    #[inline]
    pub(super) fn wanted_by(&self, cell: &Cell) -> Self {
        // Nearly every cell of a picture.
        if cell.glyph != ' ' && cell.attributes.is_empty() && self.attributes.is_empty() {
            return Self { fg: cell.fg, bg: cell.bg, ..*self };
        }
        self.wanted_by_any(cell)
    }

    /// The same for any cell.
    fn wanted_by_any(&self, cell: &Cell) -> Self {
        if self.can_be_exchanged_for(cell) { self.wanted_by_space(cell) } else { self.as_it_stands(cell) }
    }

    /// The same for such a space.
    fn wanted_by_space(&self, cell: &Cell) -> Self {
        let plain = self.as_it_stands(cell);
        let exchanged = Self { attributes: Attributes::REVERSED, ..*self };
        if self.cost_of(&exchanged) < self.cost_of(&plain) { exchanged } else { plain }
    }

    /// Whether a space looks like the cell when the pen's two colours are exchanged. The terminal's own colour for glyphs
    /// cannot be said behind them.
    fn can_be_exchanged_for(&self, cell: &Cell) -> bool {
        is_plain_space(cell)
            && self.fg == cell.bg
            && cell.bg != Ink::Default
            && Attributes::REVERSED.contains(self.attributes)
    }

    /// The pen of the cell as the grid has it. The colour of a plain space's character is not seen, nor that of a line
    /// that is not drawn: nothing is said for their sake.
    fn as_it_stands(&self, cell: &Cell) -> Self {
        let mut pen = self.before_colors(cell.attributes);
        pen.bg = cell.bg;
        if !is_plain_space(cell) {
            pen.fg = cell.fg;
        }
        if is_underlined(cell) {
            pen.underline = cell.underline;
        }
        pen
    }

    /// The pen once the attributes are these: terminals disagree on how to switch single ones off, so all is switched off
    /// first, colours too, which is understood everywhere. Only for the exchange of the two colours they all know an off
    /// of its own.
    pub(super) fn before_colors(self, attributes: Attributes) -> Self {
        let from = if self.starts_anew(attributes) { Self::default() } else { self };
        Self { attributes, ..from }
    }

    /// Whether all is switched off on the way to these attributes.
    fn starts_anew(&self, attributes: Attributes) -> bool {
        !Attributes::REVERSED.contains(self.attributes ^ attributes)
    }

    /// The code on the way to these attributes that exchanges the two colours, or ends that, where nothing starts anew.
    fn exchange(&self, attributes: Attributes) -> Option<&'static [u8]> {
        if self.attributes == attributes || self.starts_anew(attributes) {
            return None;
        }
        Some(if attributes.contains(Attributes::REVERSED) { b"7" } else { b"27" })
    }

    /// How many bytes [`become_pen`](Self::become_pen) takes.
    pub(super) fn cost_of(&self, wanted: &Self) -> usize {
        self.cost_of_inks(wanted, wanted.ink_lens())
    }

    /// The same where [`ink_lens`](Self::ink_lens) of the wanted pen are known.
    #[inline]
    pub(super) fn cost_of_inks(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        if self.attributes == wanted.attributes {
            self.cost_of_colors(0, wanted, lens)
        } else {
            self.cost_of_all(wanted, lens)
        }
    }

    /// How many bytes it takes to say each of its two colours.
    pub(super) fn ink_lens(&self) -> [usize; 2] {
        [1 + ink_len(self.fg), 1 + ink_len(self.bg)]
    }

    /// The same where attributes change.
    fn cost_of_all(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        if self.starts_anew(wanted.attributes) {
            let codes = attribute_codes(wanted.attributes).count();
            return 4 + 2 * codes + self.before_colors(wanted.attributes).cost_of_colors(0, wanted, lens);
        }
        let exchange = self.exchange(wanted.attributes).map_or(0, |code| 1 + code.len());
        self.cost_of_colors(exchange, wanted, lens)
    }

    /// The same for the colours, and for a code that took so many bytes in their sequence.
    #[inline(always)]
    fn cost_of_colors(&self, code: usize, wanted: &Self, [fg, bg]: [usize; 2]) -> usize {
        let fg = if self.fg == wanted.fg { 0 } else { fg };
        let bg = if self.bg == wanted.bg { 0 } else { bg };
        let underline = if self.underline == wanted.underline { 0 } else { underline_len(wanted.underline) };
        let codes = code + fg + bg;
        underline + if codes == 0 { 0 } else { 2 + codes }
    }

    /// Says what differs: attributes that start anew in one sequence, the colours in another, the line's in a third. (All
    /// in one could be more numbers than some terminals take.)
    pub(super) fn become_pen(&mut self, wanted: Self, bytes: &mut Vec<u8>) {
        if self.starts_anew(wanted.attributes) {
            bytes.extend_from_slice(b"\x1b[0");
            for code in attribute_codes(wanted.attributes) {
                bytes.extend_from_slice(&[b';', code]);
            }
            bytes.push(b'm');
        }
        let from = self.before_colors(wanted.attributes);
        let mut lead: &[u8] = b"\x1b[";
        if let Some(code) = self.exchange(wanted.attributes) {
            bytes.extend_from_slice(mem::replace(&mut lead, b";"));
            bytes.extend_from_slice(code);
        }
        for (from, to, tens) in [(from.fg, wanted.fg, b'3'), (from.bg, wanted.bg, b'4')] {
            if from != to {
                bytes.extend_from_slice(mem::replace(&mut lead, b";"));
                write_ink(to, tens, bytes);
            }
        }
        if lead == b";" {
            bytes.push(b'm');
        }
        if from.underline != wanted.underline {
            write_underline(wanted.underline, bytes);
        }
        *self = wanted;
    }
}

/// Whether nobody can tell the two cells apart.
pub(super) fn look_alike(a: &Cell, b: &Cell) -> bool {
    (a.bg, a.attributes) == (b.bg, b.attributes)
        && a.glyph == b.glyph
        && (a.fg == b.fg || is_plain_space(a))
        && (a.underline == b.underline || !is_underlined(a))
}

/// Whether only the colour behind the character is seen.
pub(super) fn is_plain_space(cell: &Cell) -> bool {
    cell.glyph == ' ' && cell.attributes.is_empty()
}

/// Whether the colour of the line below is seen.
fn is_underlined(cell: &Cell) -> bool {
    cell.attributes.contains(Attributes::UNDERLINED)
}

/// In UTF-8.
pub(super) fn write_glyph(glyph: &Glyph, bytes: &mut Vec<u8>) {
    match glyph {
        Glyph::Char(character) => write_char(*character, bytes),
        Glyph::Cluster(text) => bytes.extend_from_slice(text.as_bytes()),
        Glyph::Covered => {}
        Glyph::Foreign => bytes.push(b' '),
    }
}

/// In UTF-8.
pub(super) fn write_char(character: char, bytes: &mut Vec<u8>) {
    let mut utf8 = [0; 4];
    bytes.extend_from_slice(character.encode_utf8(&mut utf8).as_bytes());
}

/// The numbers of one colour; the first begins with a 3 for the character's, a 4 for the one behind it.
fn write_ink(ink: Ink, tens: u8, bytes: &mut Vec<u8>) {
    match ink {
        Ink::Default => bytes.extend_from_slice(&[tens, b'9']),
        Ink::Indexed(index) => {
            bytes.extend_from_slice(&[tens, b'8', b';', b'5', b';']);
            write_number(index.into(), bytes);
        }
        Ink::Rgb(color) => {
            bytes.extend_from_slice(&[tens, b'8', b';', b'2']);
            write_bands([color.r, color.g, color.b], bytes);
        }
    }
}

/// How many bytes [`write_ink`] takes.
fn ink_len(ink: Ink) -> usize {
    match ink {
        Ink::Default => 2,
        Ink::Indexed(index) => 5 + digits(index.into()),
        Ink::Rgb(color) => 7 + [color.r, color.g, color.b].into_iter().map(band_digits).sum::<usize>(),
    }
}

/// The colour of the line below, in a sequence of its own and with colons: a terminal that does not know it passes over
/// that, where it would take `58;2` for something and then dim.
fn write_underline(ink: Ink, bytes: &mut Vec<u8>) {
    match ink {
        Ink::Default => bytes.extend_from_slice(b"\x1b[59"),
        Ink::Indexed(index) => {
            bytes.extend_from_slice(b"\x1b[58:5:");
            write_number(index.into(), bytes);
        }
        Ink::Rgb(color) => {
            // The number left out is that of a colour space.
            bytes.extend_from_slice(b"\x1b[58:2:");
            for band in [color.r, color.g, color.b] {
                bytes.push(b':');
                write_number(band.into(), bytes);
            }
        }
    }
    bytes.push(b'm');
}

/// How many bytes [`write_underline`] takes.
fn underline_len(ink: Ink) -> usize {
    match ink {
        Ink::Default => 5,
        Ink::Indexed(_) => 3 + ink_len(ink),
        Ink::Rgb(_) => 4 + ink_len(ink),
    }
}

/// The number of each attributes that is on, in rising order.
fn attribute_codes(attributes: Attributes) -> impl Iterator<Item = u8> {
    const CODES: [(Attributes, u8); 9] = [
        (Attributes::BOLD, b'1'),
        (Attributes::DIM, b'2'),
        (Attributes::ITALIC, b'3'),
        (Attributes::UNDERLINED, b'4'),
        (Attributes::SLOW_BLINK, b'5'),
        (Attributes::RAPID_BLINK, b'6'),
        (Attributes::REVERSED, b'7'),
        (Attributes::HIDDEN, b'8'),
        (Attributes::CROSSED_OUT, b'9'),
    ];
    CODES.into_iter().filter(move |&(flag, _)| attributes.contains(flag)).map(|(_, code)| code)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::color::Srgb8;

    /// What a change costs is what it takes, from any pen to any other.
    #[test]
    fn costs_are_true() {
        let inks = [Ink::Default, Ink::Indexed(7), Ink::Indexed(200), Ink::Rgb(Srgb8::new(0, 10, 100))];
        let reversed = Attributes::REVERSED;
        let attributes =
            [Attributes::empty(), reversed, Attributes::BOLD, Attributes::BOLD | reversed, Attributes::all()];
        let colors = || inks.into_iter().flat_map(|fg| inks.map(|bg| (fg, bg)));
        let looks = || colors().flat_map(|colors| inks.map(|underline| (colors, underline)));
        let pens: Vec<Pen> = looks()
            .flat_map(|((fg, bg), underline)| attributes.map(|attributes| Pen { fg, bg, underline, attributes }))
            .collect();
        for from in &pens {
            for to in &pens {
                let mut bytes = Vec::new();
                let mut pen = *from;
                pen.become_pen(*to, &mut bytes);
                assert_eq!((pen, bytes.len()), (*to, from.cost_of(to)), "{from:?} to {to:?}");
            }
        }
    }
}
