//! Reading of the numbers of a PLY body, as text or binary.

use super::header::{Element, Property, PropertyType, ScalarType};
use crate::mesh_file::builder::MeshBuilder;
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::left_out::LeftOut;
use crate::mesh_file::pieces::parse_in_order;
use crate::mesh_file::text::TextCursor;
use crate::progress::Meter;
use std::ops::{ControlFlow, Range};

/// A reader of a PLY body, which consists of rows of numbers. It is a generic parameter, not a
/// trait object, so that reading a number is inlined: a body has millions.
pub(super) trait RowReader: Clone + Send + Sync {
    /// Starts reading row number `row` of the element, counted from 0.
    fn begin_row(&mut self, element: &Element<'_>, row: u32) -> Result<(), MeshFault>;
    /// Checks that a row ends after its last number.
    fn end_row(&mut self, element: &Element<'_>) -> Result<(), MeshFault>;
    /// Reads a number, which must be finite.
    fn number(&mut self, kind: ScalarType) -> Result<f32, MeshFault>;
    /// Reads a number, which may be infinite or NaN.
    fn any_number(&mut self, kind: ScalarType) -> Result<f32, MeshFault>;
    /// Passes the next row without reading it. Returns false if its end is unknown.
    ///
    /// `row_size` is the [size](Element::row_size) of a row in a binary file.
    fn pass_row(&mut self, element: &Element<'_>, row_size: Option<usize>) -> bool;
    /// Skips the row that begins at `start`, a byte offset, after a fault within it.
    fn skip_row(&mut self, element: &Element<'_>, start: usize) -> Result<(), MeshFault>;
    /// Reads an integer of a type that is not a float.
    fn integer(&mut self, kind: ScalarType) -> Result<i64, MeshFault>;
    /// Skips `count` numbers of a type.
    fn skip(&mut self, kind: ScalarType, count: usize) -> Result<(), MeshFault>;
    /// Returns the byte offset of the next number, for [`fault`](Self::fault).
    fn position(&self) -> usize;
    /// Returns a fault at a byte offset that [`position`](Self::position) has returned.
    fn fault(&self, position: usize, message: String) -> MeshFault;
    /// Returns the number of bytes of the body that are not read yet.
    fn bytes_left(&self) -> usize;
    /// Returns the fewest bytes that a row of these properties can take.
    fn least_size(&self, properties: &[Property<'_>]) -> usize;

    /// Skips the numbers of properties.
    fn skip_properties(&mut self, properties: &[Property<'_>]) -> Result<(), MeshFault> {
        properties.iter().try_for_each(|property| match property.shape {
            PropertyType::Scalar(kind) => self.skip(kind, 1),
            PropertyType::List { length, item } => {
                let length = self.length(length)?;
                self.skip(item, length)
            }
        })
    }

    /// Reads the length of a list, which must not be negative.
    fn length(&mut self, kind: ScalarType) -> Result<usize, MeshFault> {
        let position = self.position();
        let length = self.integer(kind)?;
        usize::try_from(length).map_err(|_| self.fault(position, format!("a list cannot have {length} items")))
    }
}

/// The state of reading the body of a PLY file.
pub(super) struct Body<'a, 'm, R> {
    pub(super) rows: R,
    pub(super) mesh: MeshBuilder,
    pub(super) left_out: &'m mut LeftOut<'a>,
    pub(super) meter: Meter<'m>,
}

/// Rows of an element that follow each other, and the mesh that is made of them.
pub(super) struct Piece<'p, 'a, R> {
    pub(super) rows: R,
    pub(super) mesh: MeshBuilder,
    pub(super) left_out: &'p mut LeftOut<'a>,
}

/// Part of an element: the reader at its first row, the numbers of its rows, and their byte
/// offsets.
struct Part<R> {
    rows: R,
    range: Range<u32>,
    offsets: Range<usize>,
}

impl<'a, R: RowReader> Body<'a, '_, R> {
    /// Reads all rows of an element, in pieces that are joined in their order.
    ///
    /// `read` reads a row of a piece, with a value that lasts as long as the piece, and `leave_out` is called with the
    /// index in its piece of each faulty row.
    pub(super) fn each_row<S: Default>(
        &mut self,
        element: &Element<'_>,
        read: impl Fn(&mut Piece<'_, 'a, R>, &mut S) -> Result<(), MeshFault> + Sync,
        leave_out: impl Fn(&mut MeshBuilder, usize) + Sync,
    ) -> Result<(), MeshFault> {
        let Self { rows, mesh, left_out, meter } = self;
        let parts = parts(element, rows, meter.piece_bytes());
        let parse = |part: &Part<R>, left_out: &mut LeftOut<'a>| {
            let mut piece = Piece { rows: part.rows.clone(), mesh: MeshBuilder::default(), left_out };
            let mut scratch = S::default();
            let read = part.range.clone().try_for_each(|row| {
                piece.rows.begin_row(element, row)?;
                let start = piece.rows.position();
                if let Err(fault) = read(&mut piece, &mut scratch).and_then(|()| piece.rows.end_row(element)) {
                    piece.left_out.leave_out(fault)?;
                    piece.rows.skip_row(element, start)?;
                    leave_out(&mut piece.mesh, (row - part.range.start) as usize);
                }
                Ok(())
            });
            ((piece.rows, piece.mesh), read)
        };
        parse_in_order(
            &parts,
            |part| part.offsets.clone(),
            (&mut **left_out, meter),
            parse,
            |_, (after, piece)| {
                *rows = after;
                let material = mesh.current_material();
                mesh.append(piece, material).map(ControlFlow::Continue)
            },
        )
    }
}

/// Cuts the rows of an element into parts of about `size` bytes.
///
/// Where the rows cannot be told apart, the last part has the rest of them.
fn parts<R: RowReader>(element: &Element<'_>, rows: &R, size: usize) -> Vec<Part<R>> {
    let mut parts = Vec::new();
    let (mut next, mut first) = (rows.clone(), 0);
    let row_size = element.row_size();
    while first < element.count {
        let (start, mut row) = (next.clone(), first);
        while row < element.count && next.position() - start.position() < size {
            if !next.pass_row(element, row_size) {
                row = element.count;
                break;
            }
            row += 1;
        }
        let offsets = start.position()..next.position();
        parts.push(Part { rows: start, range: first..row, offsets });
        first = row;
    }
    parts
}

/// A text body, in which each line is a row.
#[derive(Clone)]
pub(super) struct AsciiRows<'a> {
    text: TextCursor<'a>,
    /// Whether a backslash may continue a line, so that a row may be more than a line.
    may_continue: bool,
}

impl<'a> AsciiRows<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { text: TextCursor::starting_at(bytes, at), may_continue: bytes[at..].contains(&b'\\') }
    }
}

impl RowReader for AsciiRows<'_> {
    #[inline]
    fn begin_row(&mut self, element: &Element<'_>, row: u32) -> Result<(), MeshFault> {
        if self.text.go_to_statement() {
            return Ok(());
        }
        let Element { name, count, .. } = element;
        Err(MeshFault::in_text(
            self.text.at(),
            format!("the file ends after {row} of {count} rows of the element {name}"),
        ))
    }

    #[inline]
    fn end_row(&mut self, element: &Element<'_>) -> Result<(), MeshFault> {
        if self.text.is_at_line_end() {
            self.text.skip_line();
            return Ok(());
        }
        Err(self.text.expected(&format!("the end of this row of the element {}", element.name)))
    }

    #[inline]
    fn number(&mut self, _kind: ScalarType) -> Result<f32, MeshFault> {
        self.text.number()
    }

    #[inline]
    fn any_number(&mut self, _kind: ScalarType) -> Result<f32, MeshFault> {
        self.text.any_number()
    }

    fn pass_row(&mut self, _element: &Element<'_>, _row_size: Option<usize>) -> bool {
        let has_row = !self.may_continue && self.text.go_to_statement();
        if has_row {
            self.text.skip_line();
        }
        has_row
    }

    fn skip_row(&mut self, _element: &Element<'_>, start: usize) -> Result<(), MeshFault> {
        self.text = self.text.cursor_at(start);
        self.text.skip_line();
        Ok(())
    }

    #[inline]
    fn integer(&mut self, _kind: ScalarType) -> Result<i64, MeshFault> {
        self.text.integer()
    }

    fn skip(&mut self, _kind: ScalarType, count: usize) -> Result<(), MeshFault> {
        for _ in 0..count {
            if self.text.word().is_empty() {
                return Err(self.text.expected("a number"));
            }
        }
        Ok(())
    }

    fn position(&self) -> usize {
        self.text.at()
    }

    fn fault(&self, position: usize, message: String) -> MeshFault {
        let mut text = self.text.cursor_at(position);
        // `position` was taken before the blanks that separate this word from the previous one.
        text.skip_blanks();
        MeshFault::in_text(text.at(), message)
    }

    fn bytes_left(&self) -> usize {
        self.text.left()
    }

    /// Returns two bytes per number: a digit and a blank.
    fn least_size(&self, properties: &[Property<'_>]) -> usize {
        2 * properties.len()
    }
}

/// A binary body, in which rows follow each other without gaps and each number has the size of its
/// type.
// The byte order is a constant, so that it is not tested for each number.
#[derive(Clone)]
pub(super) struct BinaryRows<'a, const BIG_ENDIAN: bool> {
    bytes: &'a [u8],
    at: usize,
}

impl<'a, const BIG_ENDIAN: bool> BinaryRows<'a, BIG_ENDIAN> {
    pub(super) fn new(bytes: &'a [u8], at: usize) -> Self {
        Self { bytes, at }
    }

    #[inline]
    fn next_bytes<const N: usize>(&mut self) -> Result<[u8; N], MeshFault> {
        // An array of constant size `N`, so that the compiler reads it with one load.
        let Some(&taken) = self.bytes.get(self.at..).and_then(|rest| rest.first_chunk::<N>()) else {
            return Err(self.cut_short());
        };
        self.at += N;
        let mut taken = taken;
        if BIG_ENDIAN {
            taken.reverse();
        }
        Ok(taken)
    }

    #[cold]
    fn cut_short(&self) -> MeshFault {
        MeshFault::at_byte(self.bytes.len(), "the file ends within a row; it was cut short")
    }

    #[inline]
    fn value(&mut self, kind: ScalarType) -> Result<f64, MeshFault> {
        Ok(match kind {
            ScalarType::F32 => f64::from(f32::from_le_bytes(self.next_bytes()?)),
            ScalarType::F64 => f64::from_le_bytes(self.next_bytes()?),
            // The conversion is exact, because the integers have at most 32 bits.
            kind => self.integer(kind)? as f64,
        })
    }
}

impl<const BIG_ENDIAN: bool> RowReader for BinaryRows<'_, BIG_ENDIAN> {
    #[inline]
    fn begin_row(&mut self, element: &Element<'_>, row: u32) -> Result<(), MeshFault> {
        if self.at < self.bytes.len() {
            return Ok(());
        }
        let Element { name, count, .. } = element;
        Err(MeshFault::at_byte(self.at, format!("the file ends after {row} of {count} rows of the element {name}")))
    }

    #[inline]
    fn end_row(&mut self, _element: &Element<'_>) -> Result<(), MeshFault> {
        Ok(())
    }

    #[inline]
    fn number(&mut self, kind: ScalarType) -> Result<f32, MeshFault> {
        let position = self.at;
        let value = self.value(kind)?;
        let single = value as f32;
        if single.is_finite() {
            return Ok(single);
        }
        let what = if value.is_finite() { "is too large: numbers go up to 3.4e38" } else { "is not a finite number" };
        Err(self.fault(position, format!("{value:e} {what}")))
    }

    #[inline]
    fn any_number(&mut self, kind: ScalarType) -> Result<f32, MeshFault> {
        Ok(self.value(kind)? as f32)
    }

    fn pass_row(&mut self, element: &Element<'_>, row_size: Option<usize>) -> bool {
        match row_size {
            Some(size) => self.skip(ScalarType::U8, size).is_ok(),
            None => self.skip_properties(&element.properties).is_ok(),
        }
    }

    fn skip_row(&mut self, element: &Element<'_>, start: usize) -> Result<(), MeshFault> {
        self.at = start;
        self.skip_properties(&element.properties)
    }

    #[inline]
    fn integer(&mut self, kind: ScalarType) -> Result<i64, MeshFault> {
        Ok(match kind {
            ScalarType::I8 => i64::from(i8::from_le_bytes(self.next_bytes()?)),
            ScalarType::U8 => i64::from(u8::from_le_bytes(self.next_bytes()?)),
            ScalarType::I16 => i64::from(i16::from_le_bytes(self.next_bytes()?)),
            ScalarType::U16 => i64::from(u16::from_le_bytes(self.next_bytes()?)),
            ScalarType::I32 => i64::from(i32::from_le_bytes(self.next_bytes()?)),
            ScalarType::U32 => i64::from(u32::from_le_bytes(self.next_bytes()?)),
            // Unreachable: the header refuses float types where an integer is required.
            ScalarType::F32 => f32::from_le_bytes(self.next_bytes()?) as i64,
            ScalarType::F64 => f64::from_le_bytes(self.next_bytes()?) as i64,
        })
    }

    fn skip(&mut self, kind: ScalarType, count: usize) -> Result<(), MeshFault> {
        // The count comes from the file and may overflow.
        let end = kind.size().checked_mul(count).and_then(|size| self.at.checked_add(size));
        self.at = end.filter(|&end| end <= self.bytes.len()).ok_or_else(|| self.cut_short())?;
        Ok(())
    }

    fn position(&self) -> usize {
        self.at
    }

    fn fault(&self, position: usize, message: String) -> MeshFault {
        MeshFault::at_byte(position, message)
    }

    fn bytes_left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn least_size(&self, properties: &[Property<'_>]) -> usize {
        let least = |shape| match shape {
            PropertyType::Scalar(kind) => ScalarType::size(kind),
            PropertyType::List { length, .. } => length.size(),
        };
        properties.iter().map(|property| least(property.shape)).sum()
    }
}
