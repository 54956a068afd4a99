//! The numbers of the body, as text or binary.

use super::header::{Element, Property, Shape, Type};
use crate::mesh_file::fault::Fault;
use crate::mesh_file::text::Text;
use crate::progress::Meter;

/// A body: rows of numbers.
pub(super) trait Rows {
    /// Starts a row; `row` counts from 0.
    fn begin(&mut self, element: &Element<'_>, row: u32) -> Result<(), Fault>;
    /// Ends a row after all its numbers.
    fn end(&mut self, element: &Element<'_>) -> Result<(), Fault>;
    /// Reads a finite number.
    fn number(&mut self, kind: Type) -> Result<f32, Fault>;
    /// Reads an integer, whose type is not a float.
    fn integer(&mut self, kind: Type) -> Result<i64, Fault>;
    /// Skips numbers.
    fn skip(&mut self, kind: Type, count: usize) -> Result<(), Fault>;
    /// Returns the position, for `fault`.
    fn place(&self) -> usize;
    /// Returns a fault at a position.
    fn fault(&self, place: usize, message: String) -> Fault;
    /// Returns the number of bytes left.
    fn left(&self) -> usize;
    /// Returns the least size of a row in bytes.
    fn least_size(&self, properties: &[Property<'_>]) -> usize;

    /// Reads the length of a list, which must not be negative.
    fn length(&mut self, kind: Type) -> Result<usize, Fault> {
        let place = self.place();
        let length = self.integer(kind)?;
        usize::try_from(length).map_err(|_| self.fault(place, format!("a list has no {length} items")))
    }
}

/// A text body, where a row is a line.
pub(super) struct Ascii<'a> {
    text: Text<'a>,
    meter: Meter<'a>,
}

impl<'a> Ascii<'a> {
    pub(super) fn new(bytes: &'a [u8], at: usize, meter: Meter<'a>) -> Self {
        Self { text: Text::from(bytes, at), meter }
    }
}

impl Rows for Ascii<'_> {
    #[inline]
    fn begin(&mut self, element: &Element<'_>, row: u32) -> Result<(), Fault> {
        if self.text.go_to_statement() {
            return Ok(self.meter.reach(self.text.at())?);
        }
        let Element { name, count, .. } = element;
        Err(Fault::in_text(self.text.at(), format!("the file ends after {row} of {count} rows of the element {name}")))
    }

    #[inline]
    fn end(&mut self, element: &Element<'_>) -> Result<(), Fault> {
        if self.text.is_at_line_end() {
            self.text.skip_line();
            return Ok(());
        }
        Err(self.text.expected(&format!("the end of this row of the element {}", element.name)))
    }

    #[inline]
    fn number(&mut self, _kind: Type) -> Result<f32, Fault> {
        self.text.number()
    }

    #[inline]
    fn integer(&mut self, _kind: Type) -> Result<i64, Fault> {
        self.text.integer()
    }

    fn skip(&mut self, _kind: Type, count: usize) -> Result<(), Fault> {
        for _ in 0..count {
            if self.text.word().is_empty() {
                return Err(self.text.expected("a number"));
            }
        }
        Ok(())
    }

    fn place(&self) -> usize {
        self.text.at()
    }

    fn fault(&self, place: usize, message: String) -> Fault {
        let mut text = self.text.back_at(place);
        text.skip_blanks();
        Fault::in_text(text.at(), message)
    }

    fn left(&self) -> usize {
        self.text.left()
    }

    /// A digit and a blank for each number.
    fn least_size(&self, properties: &[Property<'_>]) -> usize {
        2 * properties.len()
    }
}

/// A binary body, where rows are contiguous and numbers have the size of their type.
pub(super) struct Binary<'a, const BIG_ENDIAN: bool> {
    bytes: &'a [u8],
    at: usize,
    meter: Meter<'a>,
}

impl<'a, const BIG_ENDIAN: bool> Binary<'a, BIG_ENDIAN> {
    pub(super) fn new(bytes: &'a [u8], at: usize, meter: Meter<'a>) -> Self {
        Self { bytes, at, meter }
    }

    #[inline]
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Fault> {
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
    fn cut_short(&self) -> Fault {
        Fault::at_byte(self.bytes.len(), "the file ends within a row; it was cut short")
    }

    #[inline]
    fn value(&mut self, kind: Type) -> Result<f64, Fault> {
        Ok(match kind {
            Type::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Type::F64 => f64::from_le_bytes(self.take()?),
            kind => self.integer(kind)? as f64,
        })
    }
}

impl<const BIG_ENDIAN: bool> Rows for Binary<'_, BIG_ENDIAN> {
    #[inline]
    fn begin(&mut self, element: &Element<'_>, row: u32) -> Result<(), Fault> {
        if self.at < self.bytes.len() {
            return Ok(self.meter.reach(self.at)?);
        }
        let Element { name, count, .. } = element;
        Err(Fault::at_byte(self.at, format!("the file ends after {row} of {count} rows of the element {name}")))
    }

    #[inline]
    fn end(&mut self, _element: &Element<'_>) -> Result<(), Fault> {
        Ok(())
    }

    #[inline]
    fn number(&mut self, kind: Type) -> Result<f32, Fault> {
        let place = self.at;
        let value = self.value(kind)?;
        let single = value as f32;
        if single.is_finite() {
            return Ok(single);
        }
        let what = if value.is_finite() { "is too large: numbers go up to 3.4e38" } else { "is not a finite number" };
        Err(self.fault(place, format!("{value:e} {what}")))
    }

    #[inline]
    fn integer(&mut self, kind: Type) -> Result<i64, Fault> {
        Ok(match kind {
            Type::I8 => i64::from(i8::from_le_bytes(self.take()?)),
            Type::U8 => i64::from(u8::from_le_bytes(self.take()?)),
            Type::I16 => i64::from(i16::from_le_bytes(self.take()?)),
            Type::U16 => i64::from(u16::from_le_bytes(self.take()?)),
            Type::I32 => i64::from(i32::from_le_bytes(self.take()?)),
            Type::U32 => i64::from(u32::from_le_bytes(self.take()?)),
            // Floats never get here: the header refuses them where an integer is required.
            Type::F32 => f32::from_le_bytes(self.take()?) as i64,
            Type::F64 => f64::from_le_bytes(self.take()?) as i64,
        })
    }

    fn skip(&mut self, kind: Type, count: usize) -> Result<(), Fault> {
        let end = kind.size().checked_mul(count).and_then(|size| self.at.checked_add(size));
        self.at = end.filter(|&end| end <= self.bytes.len()).ok_or_else(|| self.cut_short())?;
        Ok(())
    }

    fn place(&self) -> usize {
        self.at
    }

    fn fault(&self, place: usize, message: String) -> Fault {
        Fault::at_byte(place, message)
    }

    fn left(&self) -> usize {
        self.bytes.len() - self.at
    }

    fn least_size(&self, properties: &[Property<'_>]) -> usize {
        let least = |shape| match shape {
            Shape::Scalar(kind) => Type::size(kind),
            Shape::List { length, .. } => length.size(),
        };
        properties.iter().map(|property| least(property.shape)).sum()
    }
}
