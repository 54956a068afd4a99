//! The pen: the colours and attributes that the terminal would write with now, and what it costs to change them.

use super::numbers::{channel_digit_count, digit_count, write_channels, write_number};
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

    /// The cell's character in its colours, for a file; only what differs from the pen is said, one colour at a time:
    /// what saves bytes on a screen does not change files.
    pub(crate) fn write_cell(&mut self, cell: &Cell, bytes: &mut Vec<u8>) {
        let wanted = self.plain_pen_for(cell);
        self.write_sgr(Self { fg: self.after_attributes(wanted.attributes).fg, ..wanted }, InkForm::Long, bytes);
        self.write_sgr(wanted, InkForm::Long, bytes);
        write_glyph(&cell.glyph, bytes);
    }

    /// The pen with which the cell is to be written. A plain space of the colour that the pen has for glyphs is
    /// cheapest with the pen's two colours exchanged: to say so takes four bytes, to say the colour again, as the one
    /// behind, about nineteen.
    #[inline]
    pub(super) fn pen_for(&self, cell: &Cell) -> Self {
        // Nearly every cell of a picture.
        if cell.glyph != ' ' && cell.attributes.is_empty() && self.attributes.is_empty() {
            return Self { fg: cell.fg, bg: cell.bg, ..*self };
        }
        self.pen_for_any(cell)
    }

    /// The same for any cell.
    fn pen_for_any(&self, cell: &Cell) -> Self {
        if self.can_show_reversed(cell) { self.pen_for_space(cell) } else { self.plain_pen_for(cell) }
    }

    /// The same for such a space.
    fn pen_for_space(&self, cell: &Cell) -> Self {
        let plain = self.plain_pen_for(cell);
        let exchanged = Self { attributes: Attributes::REVERSED, ..*self };
        if self.switch_cost(&exchanged) < self.switch_cost(&plain) { exchanged } else { plain }
    }

    /// Whether a space looks like the cell when the pen's two colours are exchanged. The terminal's own colour for
    /// glyphs cannot be said behind them.
    fn can_show_reversed(&self, cell: &Cell) -> bool {
        is_plain_space(cell)
            && self.fg == cell.bg
            && cell.bg != Ink::Default
            && Attributes::REVERSED.contains(self.attributes)
    }

    /// The pen of the cell as the grid has it. The colour of a plain space's character is not seen, nor that of a line
    /// that is not drawn: nothing is said for their sake.
    fn plain_pen_for(&self, cell: &Cell) -> Self {
        let mut pen = self.after_attributes(cell.attributes);
        pen.bg = cell.bg;
        if !is_plain_space(cell) {
            pen.fg = cell.fg;
        }
        if is_underlined(cell) {
            pen.underline = cell.underline;
        }
        pen
    }

    /// The pen once the attributes are these. Adding some keeps the colours. Terminals disagree on how to switch single
    /// ones off, so all is switched off first, colours too, which is understood everywhere; only for the exchange of
    /// the two colours they all know an off of its own.
    pub(super) fn after_attributes(self, attributes: Attributes) -> Self {
        let from = if self.needs_reset(attributes) { Self::default() } else { self };
        Self { attributes, ..from }
    }

    /// Whether all is switched off on the way to these attributes: where one is lost, or where one that is gained would
    /// not have the effect that it has from nothing. One of the first eight colours that becomes bold, said in its
    /// short form, as it may have been, would be a bright one in many terminals (see [`ink_len`]); and some take bold
    /// and dim, or the speeds of blinking, for one thing, of which the last said counts.
    fn needs_reset(&self, attributes: Attributes) -> bool {
        let (lost, gained) = (self.attributes.difference(attributes), attributes.difference(self.attributes));
        let comes_before = |first, second| gained.contains(first) && self.attributes.contains(second);
        !Attributes::REVERSED.contains(lost)
            || (gained.contains(Attributes::BOLD) && is_basic(self.fg))
            || comes_before(Attributes::BOLD, Attributes::DIM)
            || comes_before(Attributes::SLOW_BLINK, Attributes::RAPID_BLINK)
    }

    /// The codes on the way to these attributes.
    fn attribute_codes(&self, attributes: Attributes) -> impl Iterator<Item = &'static [u8]> {
        let needs_reset = self.needs_reset(attributes);
        let from = if needs_reset { Attributes::empty() } else { self.attributes };
        let off: Option<&[u8]> = match needs_reset {
            true => Some(b"0"),
            false if from.difference(attributes).is_empty() => None,
            false => Some(b"27"),
        };
        off.into_iter().chain(codes_of(attributes.difference(from)))
    }

    /// How many bytes [`switch_to`](Self::switch_to) takes.
    pub(super) fn switch_cost(&self, wanted: &Self) -> usize {
        self.switch_cost_with_lens(wanted, wanted.ink_lens())
    }

    /// The same where [`ink_lens`](Self::ink_lens) of the wanted pen are known.
    #[inline]
    pub(super) fn switch_cost_with_lens(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        // A picture's cells have a colour behind them.
        if wanted.bg == Ink::Default && *wanted == Self::default() {
            return if self == wanted { 0 } else { SGR_RESET.len() };
        }
        if self.attributes == wanted.attributes {
            self.cost_of_colors(0, wanted, lens)
        } else {
            self.cost_with_attributes(wanted, lens)
        }
    }

    /// How many bytes it takes to say each of its two colours.
    pub(super) fn ink_lens(&self) -> [usize; 2] {
        let [fg, bg] = self.ink_forms(InkForm::Short);
        [1 + ink_len(self.fg, fg), 1 + ink_len(self.bg, bg)]
    }

    /// The same where attributes change.
    fn cost_with_attributes(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        let codes = self.attribute_codes(wanted.attributes).map(|code| 1 + code.len()).sum();
        let split = if self.is_split(wanted, InkForm::Short) { 2 } else { 0 };
        self.after_attributes(wanted.attributes).cost_of_colors(codes, wanted, lens) + split
    }

    /// The same for the colours, and for codes that took so many bytes in their sequence.
    #[inline(always)]
    fn cost_of_colors(&self, code: usize, wanted: &Self, [fg, bg]: [usize; 2]) -> usize {
        let fg = if self.fg == wanted.fg { 0 } else { fg };
        let bg = if self.bg == wanted.bg { 0 } else { bg };
        let underline = if self.underline == wanted.underline { 0 } else { underline_len(wanted.underline) };
        let codes = code + fg + bg;
        underline + if codes == 0 { 0 } else { 2 + codes }
    }

    /// Says what differs: the attributes and the colours in one sequence, the line's in another.
    pub(super) fn switch_to(&mut self, wanted: Self, bytes: &mut Vec<u8>) {
        if *self != wanted && wanted == Self::default() {
            bytes.extend_from_slice(SGR_RESET);
            *self = wanted;
        } else {
            self.write_sgr(wanted, InkForm::Short, bytes);
        }
    }

    /// The same in that wording.
    fn write_sgr(&mut self, wanted: Self, form: InkForm, bytes: &mut Vec<u8>) {
        let mut lead: &[u8] = b"\x1b[";
        for code in self.attribute_codes(wanted.attributes) {
            bytes.extend_from_slice(mem::replace(&mut lead, b";"));
            bytes.extend_from_slice(code);
        }
        if self.is_split(&wanted, form) {
            bytes.push(b'm');
            lead = b"\x1b[";
        }
        let from = self.after_attributes(wanted.attributes);
        let [fg, bg] = wanted.ink_forms(form);
        for (from, to, tens, form) in [(from.fg, wanted.fg, b'3', fg), (from.bg, wanted.bg, b'4', bg)] {
            if from != to {
                bytes.extend_from_slice(mem::replace(&mut lead, b";"));
                write_ink(to, tens, form, bytes);
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

    /// Whether the attributes and the colours are more numbers than one sequence may have.
    fn is_split(&self, wanted: &Self, form: InkForm) -> bool {
        let from = self.after_attributes(wanted.attributes);
        let [fg, bg] = wanted.ink_forms(form);
        let numbers = |from: Ink, to: Ink, form| if from == to { 0 } else { ink_parameter_count(to, form) };
        let colors = numbers(from.fg, wanted.fg, fg) + numbers(from.bg, wanted.bg, bg);
        let attributes = self.attribute_codes(wanted.attributes).count();
        attributes > 0 && colors > 0 && attributes + colors > MAX_SGR_PARAMETERS
    }

    /// How its two colours may be said: a bold one of the first eight only in full.
    fn ink_forms(&self, form: InkForm) -> [InkForm; 2] {
        let fg = if self.attributes.contains(Attributes::BOLD) { InkForm::Long } else { form };
        [fg, form]
    }
}

/// All back to the terminal's own.
const SGR_RESET: &[u8] = b"\x1b[m";

/// How many numbers a sequence has at most: some terminals pass over those behind the sixteenth.
const MAX_SGR_PARAMETERS: usize = 16;

/// How one of the first eight colours is said.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InkForm {
    /// In two digits.
    Short,
    /// As any of the 256.
    Long,
}

/// Whether it is one of the first eight colours, which have codes of their own.
fn is_basic(ink: Ink) -> bool {
    matches!(ink, Ink::Indexed(..8))
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
fn write_ink(ink: Ink, tens: u8, form: InkForm, bytes: &mut Vec<u8>) {
    match ink {
        Ink::Default => bytes.extend_from_slice(&[tens, b'9']),
        Ink::Indexed(index) if is_basic(ink) && form == InkForm::Short => {
            bytes.extend_from_slice(&[tens, b'0' + index]);
        }
        Ink::Indexed(index) => {
            bytes.extend_from_slice(&[tens, b'8', b';', b'5', b';']);
            write_number(index.into(), bytes);
        }
        Ink::Rgb(color) => {
            bytes.extend_from_slice(&[tens, b'8', b';', b'2']);
            write_channels([color.r, color.g, color.b], bytes);
        }
    }
}

/// How many bytes [`write_ink`] takes. (The bright ones of the named colours have no short form: not everything that
/// knows `38;5` knows 90 to 97.)
fn ink_len(ink: Ink, form: InkForm) -> usize {
    match ink {
        Ink::Default => 2,
        Ink::Indexed(_) if is_basic(ink) && form == InkForm::Short => 2,
        Ink::Indexed(index) => 5 + digit_count(index.into()),
        Ink::Rgb(color) => 7 + [color.r, color.g, color.b].into_iter().map(channel_digit_count).sum::<usize>(),
    }
}

/// How many numbers it writes.
fn ink_parameter_count(ink: Ink, form: InkForm) -> usize {
    match ink {
        Ink::Default => 1,
        Ink::Indexed(_) if is_basic(ink) && form == InkForm::Short => 1,
        Ink::Indexed(_) => 3,
        Ink::Rgb(_) => 5,
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
            for channel in [color.r, color.g, color.b] {
                bytes.push(b':');
                write_number(channel.into(), bytes);
            }
        }
    }
    bytes.push(b'm');
}

/// How many bytes [`write_underline`] takes.
fn underline_len(ink: Ink) -> usize {
    match ink {
        Ink::Default => 5,
        Ink::Indexed(_) => 3 + ink_len(ink, InkForm::Long),
        Ink::Rgb(_) => 4 + ink_len(ink, InkForm::Long),
    }
}

/// The number of each attributes that is on, in rising order.
fn codes_of(attributes: Attributes) -> impl Iterator<Item = &'static [u8]> {
    const CODES: [(Attributes, &[u8]); 9] = [
        (Attributes::BOLD, b"1"),
        (Attributes::DIM, b"2"),
        (Attributes::ITALIC, b"3"),
        (Attributes::UNDERLINED, b"4"),
        (Attributes::SLOW_BLINK, b"5"),
        (Attributes::RAPID_BLINK, b"6"),
        (Attributes::REVERSED, b"7"),
        (Attributes::HIDDEN, b"8"),
        (Attributes::CROSSED_OUT, b"9"),
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
                pen.switch_to(*to, &mut bytes);
                assert_eq!((pen, bytes.len()), (*to, from.switch_cost(to)), "{from:?} to {to:?}");
            }
        }
    }
}
