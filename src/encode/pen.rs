//! The pen, and the bytes that it takes to switch to another pen.

use super::numbers::{channel_digit_count, digit_count, write_channels, write_number};
use crate::grid::{Attributes, Cell, Glyph, Ink};
use std::mem;

/// The colours and attributes with which the terminal would write now.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Pen {
    pub(super) fg: Ink,
    pub(super) bg: Ink,
    pub(super) underline: Ink,
    pub(super) attributes: Attributes,
}

impl Pen {
    /// Appends a reset to the default colours, even if the pen has them already.
    pub(crate) fn reset(&mut self, bytes: &mut Vec<u8>) {
        bytes.extend_from_slice(b"\x1b[0m");
        *self = Self::default();
    }

    /// Appends a cell for a file: the changes of the pen, one colour at a time, and the glyph.
    // Always in the long form: shorter bytes for a screen must not change users' files.
    pub(crate) fn write_cell(&mut self, cell: &Cell, bytes: &mut Vec<u8>) {
        let wanted = self.plain_pen_for(cell);
        self.write_sgr(Self { fg: self.after_attributes(wanted.attributes).fg, ..wanted }, InkForm::Long, bytes);
        self.write_sgr(wanted, InkForm::Long, bytes);
        write_glyph(&cell.glyph, bytes);
    }

    /// Returns the pen with which to write a cell.
    // A plain space in the pen's glyph colour is cheapest with the two colours exchanged: SGR 7 takes four bytes, the
    // colour again as the background about nineteen. The result looks the same, pixel by pixel, in xterm, kitty,
    // alacritty, st and foot.
    #[inline]
    pub(super) fn pen_for(&self, cell: &Cell) -> Self {
        // Nearly every cell of a picture: the likely question first.
        if cell.glyph != ' ' && cell.attributes.is_empty() && self.attributes.is_empty() {
            return Self { fg: cell.fg, bg: cell.bg, ..*self };
        }
        self.pen_for_any(cell)
    }

    /// Returns the pen for a cell of any kind.
    // Apart from `pen_for`, so that only the test of the common case is inlined.
    fn pen_for_any(&self, cell: &Cell) -> Self {
        if self.can_show_reversed(cell) { self.pen_for_space(cell) } else { self.plain_pen_for(cell) }
    }

    /// Returns the pen for a space that may be written with exchanged colours, if that is cheaper.
    fn pen_for_space(&self, cell: &Cell) -> Self {
        let plain = self.plain_pen_for(cell);
        let exchanged = Self { attributes: Attributes::REVERSED, ..*self };
        if self.switch_cost(&exchanged) < self.switch_cost(&plain) { exchanged } else { plain }
    }

    /// Returns whether a space with the pen's two colours exchanged looks like the cell.
    // The default glyph colour cannot be set as a background, so it cannot be exchanged.
    fn can_show_reversed(&self, cell: &Cell) -> bool {
        is_plain_space(cell)
            && self.fg == cell.bg
            && cell.bg != Ink::Default
            && Attributes::REVERSED.contains(self.attributes)
    }

    /// Returns the pen for a cell without exchanged colours.
    // Colours that are not seen keep the pen's value: the glyph colour of a plain space, the colour of a missing
    // underline.
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

    /// Returns the pen after a switch to these attributes, before its colours are changed.
    // Adding attributes keeps the colours. Terminals disagree on how to switch single attributes off, so everything is
    // reset first, colours too, which is understood everywhere; only for exchanged colours all know a code that ends
    // them (27).
    pub(super) fn after_attributes(self, attributes: Attributes) -> Self {
        let from = if self.needs_reset(attributes) { Self::default() } else { self };
        Self { attributes, ..from }
    }

    /// Returns whether a switch to these attributes needs a reset.
    ///
    /// Losing an attribute does, and gaining one that would have another effect than after a reset.
    // Bold makes one of the first eight colours bright in many terminals if the colour was set by its short code (see
    // [`ink_len`]). Some terminals take bold and dim, or the two speeds of blinking, for one attribute, of which the
    // last code counts.
    fn needs_reset(&self, attributes: Attributes) -> bool {
        let (lost, gained) = (self.attributes.difference(attributes), attributes.difference(self.attributes));
        let comes_before = |first, second| gained.contains(first) && self.attributes.contains(second);
        !Attributes::REVERSED.contains(lost)
            || (gained.contains(Attributes::BOLD) && is_basic(self.fg))
            || comes_before(Attributes::BOLD, Attributes::DIM)
            || comes_before(Attributes::SLOW_BLINK, Attributes::RAPID_BLINK)
    }

    /// Returns the SGR parameters of a switch to these attributes.
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

    /// Returns the number of bytes that [`switch_to`](Self::switch_to) appends.
    pub(super) fn switch_cost(&self, wanted: &Self) -> usize {
        self.switch_cost_with_lens(wanted, wanted.ink_lens())
    }

    /// Returns the switch cost, given the [`ink_lens`](Self::ink_lens) of the wanted pen.
    // The lengths were computed up to eight times per cell. Once per cell, a frame takes a quarter fewer instructions:
    // 1.52 million for 80x24 cells that all change, before 2.00.
    #[inline]
    pub(super) fn switch_cost_with_lens(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        // Only cells with the default background can want the default pen, and a picture has none.
        if wanted.bg == Ink::Default && *wanted == Self::default() {
            return if self == wanted { 0 } else { SGR_RESET.len() };
        }
        if self.attributes == wanted.attributes {
            self.cost_of_colors(0, wanted, lens)
        } else {
            self.cost_with_attributes(wanted, lens)
        }
    }

    /// Returns the number of bytes of each of the pen's two colours, with their separators.
    pub(super) fn ink_lens(&self) -> [usize; 2] {
        let [fg, bg] = self.ink_forms(InkForm::Short);
        [1 + ink_len(self.fg, fg), 1 + ink_len(self.bg, bg)]
    }

    /// Returns the switch cost if the attributes change.
    fn cost_with_attributes(&self, wanted: &Self, lens: [usize; 2]) -> usize {
        let codes = self.attribute_codes(wanted.attributes).map(|code| 1 + code.len()).sum();
        let split = if self.is_split(wanted, InkForm::Short) { 2 } else { 0 };
        self.after_attributes(wanted.attributes).cost_of_colors(codes, wanted, lens) + split
    }

    /// Returns the cost of the colours and of attributes that take `code` bytes.
    // Inlined always: it is the innermost step of the choice of half blocks, two to four calls per cell.
    #[inline(always)]
    fn cost_of_colors(&self, code: usize, wanted: &Self, [fg, bg]: [usize; 2]) -> usize {
        let fg = if self.fg == wanted.fg { 0 } else { fg };
        let bg = if self.bg == wanted.bg { 0 } else { bg };
        let underline = if self.underline == wanted.underline { 0 } else { underline_len(wanted.underline) };
        let codes = code + fg + bg;
        underline + if codes == 0 { 0 } else { 2 + codes }
    }

    /// Switches to another pen: one sequence, and another for the underline's colour.
    pub(super) fn switch_to(&mut self, wanted: Self, bytes: &mut Vec<u8>) {
        if *self != wanted && wanted == Self::default() {
            bytes.extend_from_slice(SGR_RESET);
            *self = wanted;
        } else {
            self.write_sgr(wanted, InkForm::Short, bytes);
        }
    }

    /// Appends the sequences of a switch, with colours in the given form.
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

    /// Returns whether attributes and colours have more parameters than one sequence may have.
    fn is_split(&self, wanted: &Self, form: InkForm) -> bool {
        let from = self.after_attributes(wanted.attributes);
        let [fg, bg] = wanted.ink_forms(form);
        let numbers = |from: Ink, to: Ink, form| if from == to { 0 } else { ink_parameter_count(to, form) };
        let colors = numbers(from.fg, wanted.fg, fg) + numbers(from.bg, wanted.bg, bg);
        let attributes = self.attribute_codes(wanted.attributes).count();
        attributes > 0 && colors > 0 && attributes + colors > MAX_SGR_PARAMETERS
    }

    /// Returns the forms of the glyph's and the background's colour.
    // A bold glyph needs the long form: the short one would be shown bright in many terminals.
    fn ink_forms(&self, form: InkForm) -> [InkForm; 2] {
        let fg = if self.attributes.contains(Attributes::BOLD) { InkForm::Long } else { form };
        [fg, form]
    }
}

/// The shortest reset of all attributes and colours.
const SGR_RESET: &[u8] = b"\x1b[m";

/// Largest number of parameters in a sequence.
// Some terminals ignore those after the sixteenth.
const MAX_SGR_PARAMETERS: usize = 16;

/// The form of the sequence for one of the first eight colours.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum InkForm {
    /// The short form: 30 to 37, or 40 to 47.
    Short,
    /// The long form: `38;5;N` or `48;5;N`.
    Long,
}

/// Returns whether a colour is one of the first eight, which have a short form.
fn is_basic(ink: Ink) -> bool {
    matches!(ink, Ink::Indexed(..8))
}

/// Returns whether two cells look the same in every terminal.
pub(super) fn look_alike(a: &Cell, b: &Cell) -> bool {
    (a.bg, a.attributes) == (b.bg, b.attributes)
        && a.glyph == b.glyph
        && (a.fg == b.fg || is_plain_space(a))
        && (a.underline == b.underline || !is_underlined(a))
}

/// Returns whether only the background of a cell is visible.
pub(super) fn is_plain_space(cell: &Cell) -> bool {
    cell.glyph == ' ' && cell.attributes.is_empty()
}

/// Returns whether the underline of a cell is visible.
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

/// Appends the SGR parameters of a colour; they begin with `tens`: 3 for glyphs, 4 for backgrounds.
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

/// Returns the number of bytes that [`write_ink`] appends.
// Colours 8 to 15 have no short form: not every terminal that knows `38;5` knows 90 to 97.
fn ink_len(ink: Ink, form: InkForm) -> usize {
    match ink {
        Ink::Default => 2,
        Ink::Indexed(_) if is_basic(ink) && form == InkForm::Short => 2,
        Ink::Indexed(index) => 5 + digit_count(index.into()),
        Ink::Rgb(color) => 7 + [color.r, color.g, color.b].into_iter().map(channel_digit_count).sum::<usize>(),
    }
}

/// Returns the number of SGR parameters that [`write_ink`] appends.
fn ink_parameter_count(ink: Ink, form: InkForm) -> usize {
    match ink {
        Ink::Default => 1,
        Ink::Indexed(_) if is_basic(ink) && form == InkForm::Short => 1,
        Ink::Indexed(_) => 3,
        Ink::Rgb(_) => 5,
    }
}

/// Appends the colour of the underline.
// In a sequence of its own and with colons: a terminal that does not know it ignores the sequence, but would take the
// parameters of `58;2` for others, and the 2 for dim.
fn write_underline(ink: Ink, bytes: &mut Vec<u8>) {
    match ink {
        Ink::Default => bytes.extend_from_slice(b"\x1b[59"),
        Ink::Indexed(index) => {
            bytes.extend_from_slice(b"\x1b[58:5:");
            write_number(index.into(), bytes);
        }
        Ink::Rgb(color) => {
            // The empty parameter is the colour space.
            bytes.extend_from_slice(b"\x1b[58:2:");
            for channel in [color.r, color.g, color.b] {
                bytes.push(b':');
                write_number(channel.into(), bytes);
            }
        }
    }
    bytes.push(b'm');
}

/// Returns the number of bytes that [`write_underline`] appends.
fn underline_len(ink: Ink) -> usize {
    match ink {
        Ink::Default => 5,
        Ink::Indexed(_) => 3 + ink_len(ink, InkForm::Long),
        Ink::Rgb(_) => 4 + ink_len(ink, InkForm::Long),
    }
}

/// Returns the SGR codes of these attributes in rising order.
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

#[cfg(all(test, unit_tests))]
mod tests;
