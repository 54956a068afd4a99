//! The PLY header: the elements, and the properties of their rows.

use crate::mesh_file::fault::{MeshFault, shown};
use crate::mesh_file::left_out::LeftOut;
use crate::mesh_file::text::TextCursor;

/// A PLY header: the encoding of the body, and the elements in the order of the file.
pub(super) struct Header<'a> {
    pub(super) encoding: Encoding,
    pub(super) elements: Vec<Element<'a>>,
    /// The names of the textures, from comments.
    pub(super) textures: Vec<&'a [u8]>,
    /// The offset in bytes of the body, which follows the header.
    pub(super) end: usize,
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// An element, such as `vertex` or `face`: `count` rows with the same properties.
pub(super) struct Element<'a> {
    pub(super) name: &'a str,
    pub(super) count: u32,
    pub(super) properties: Vec<Property<'a>>,
    /// The byte offset of the element's declaration, for faults.
    pub(super) at: usize,
}

impl Element<'_> {
    /// Returns the size of a row in a binary file; `None` if it differs between rows.
    pub(super) fn row_size(&self) -> Option<usize> {
        let size = |property: &Property<'_>| match property.shape {
            PropertyType::Scalar(kind) => Some(kind.size()),
            PropertyType::List { .. } => None,
        };
        self.properties.iter().map(size).sum()
    }
}

pub(super) struct Property<'a> {
    pub(super) name: &'a str,
    pub(super) shape: PropertyType,
}

impl Property<'_> {
    /// Returns whether the property is a list with the name `name`.
    pub(super) fn is_list(&self, name: &str) -> bool {
        self.name == name && matches!(self.shape, PropertyType::List { .. })
    }

    /// Returns whether the property lists the corners of a face.
    pub(super) fn is_indices(&self) -> bool {
        let is_list = matches!(self.shape, PropertyType::List { item, .. } if !item.is_float());
        is_list && ["vertex_indices", "vertex_index"].contains(&self.name)
    }
}

/// The form of a property: a number, or a list that starts with its length.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum PropertyType {
    Scalar(ScalarType),
    List { length: ScalarType, item: ScalarType },
}

#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum ScalarType {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl ScalarType {
    fn from_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    pub(super) fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// Returns the size in a binary file, in bytes.
    pub(super) fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }
}

impl<'a> Header<'a> {
    pub(super) fn read(bytes: &'a [u8], left_out: &mut LeftOut<'_>) -> Result<Self, MeshFault> {
        let text = TextCursor::new(bytes);
        let mut reader = HeaderReader { text, encoding: None, elements: Vec::new(), textures: Vec::new(), left_out };
        // The format was recognised by these bytes, but the whole line must be `ply`.
        if reader.text.rest_of_line() != b"ply" {
            return Err(MeshFault::in_text(0, "a PLY file begins with a line that says ply"));
        }
        reader.text.skip_line();
        while reader.statement()? {}
        // A byte 10 after a carriage return may be the second half of the line end or the first byte of a binary body.
        // It belongs to the line end only if the first line of the file ended with two bytes as well.
        let line_end = if bytes.get(3..5) == Some(b"\r\n") { 2 } else { 1 };
        let end = (reader.text.at() + line_end).min(bytes.len());
        let encoding = reader.encoding.ok_or_else(|| {
            MeshFault::in_text(
                3,
                "the header lacks its line `format ascii 1.0` (or binary_little_endian, binary_big_endian)",
            )
        })?;
        Ok(Self { encoding, elements: reader.elements, textures: reader.textures, end })
    }
}

struct HeaderReader<'a, 'b, 'c> {
    text: TextCursor<'a>,
    encoding: Option<Encoding>,
    elements: Vec<Element<'a>>,
    textures: Vec<&'a [u8]>,
    left_out: &'c mut LeftOut<'b>,
}

impl<'a> HeaderReader<'a, '_, '_> {
    /// Reads a line of the header. Returns `false` after `end_header`, whose line end is left to
    /// the caller.
    fn statement(&mut self) -> Result<bool, MeshFault> {
        if !self.text.go_to_statement() {
            return Err(self.text.expected("end_header"));
        }
        let word = self.text.word();
        let at = self.text.at() - word.len();
        match word {
            b"format" => self.format()?,
            b"element" => self.element(at)?,
            b"property" => self.property(at)?,
            b"comment" => self.comment(),
            b"obj_info" => self.text.skip_line(),
            b"end_header" => {
                self.text.rest_of_line();
                return Ok(false);
            }
            _ => {
                let message =
                    format!("{} is not a keyword of a header (format, element, property, comment)", shown(word));
                self.left_out.leave_out(MeshFault::in_text(at, message))?;
                self.text.skip_line();
            }
        }
        Ok(true)
    }

    /// Reads a comment, which may name a texture as `MeshLab` does: `comment TextureFile t.png`.
    fn comment(&mut self) {
        if self.text.word().eq_ignore_ascii_case(b"TextureFile") {
            self.textures.push(self.text.rest_of_line());
        }
        self.text.skip_line();
    }

    fn format(&mut self) -> Result<(), MeshFault> {
        let word = self.text.word();
        let at = self.text.at() - word.len();
        // The version that follows is not read: there is no other than 1.0.
        self.encoding = Some(match word {
            b"ascii" => Encoding::Ascii,
            b"binary_little_endian" => Encoding::LittleEndian,
            b"binary_big_endian" => Encoding::BigEndian,
            _ => {
                let wanted = "ascii, binary_little_endian or binary_big_endian";
                return Err(MeshFault::in_text(at, format!("unknown format {}; it is {wanted}", shown(word))));
            }
        });
        self.text.skip_line();
        Ok(())
    }

    fn element(&mut self, at: usize) -> Result<(), MeshFault> {
        let name = self.name()?;
        self.text.skip_blanks();
        let count_at = self.text.at();
        let count = self.text.integer()?;
        let Ok(count) = u32::try_from(count) else {
            return Err(MeshFault::in_text(
                count_at,
                format!("{count} rows are not possible: there are 0 to {}", u32::MAX),
            ));
        };
        // The readers use only the first element with a name, so a second one would be ignored silently.
        if matches!(name, "vertex" | "face" | "tristrips") && self.elements.iter().any(|element| element.name == name) {
            return Err(MeshFault::in_text(at, format!("duplicate element {name}")));
        }
        self.elements.push(Element { name, count, properties: Vec::new(), at });
        self.text.end_line()
    }

    fn name(&mut self) -> Result<&'a str, MeshFault> {
        self.text.skip_blanks();
        let at = self.text.at();
        match std::str::from_utf8(self.text.word()) {
            Ok("") => Err(self.text.expected("a name")),
            Ok(name) => Ok(name),
            Err(_) => Err(MeshFault::in_text(at, "this name is not UTF-8")),
        }
    }

    fn property(&mut self, at: usize) -> Result<(), MeshFault> {
        let start = self.text.at();
        let shape = if self.text.word() == b"list" {
            self.text.skip_blanks();
            let length_at = self.text.at();
            let shape = PropertyType::List { length: self.kind()?, item: self.kind()? };
            if matches!(shape, PropertyType::List { length, .. } if length.is_float()) {
                return Err(MeshFault::in_text(length_at, "the length of a list is a whole number (uchar, int, ...)"));
            }
            shape
        } else {
            self.text = self.text.cursor_at(start);
            PropertyType::Scalar(self.kind()?)
        };
        let name = self.name()?;
        let Some(element) = self.elements.last_mut() else {
            return Err(MeshFault::in_text(at, "this property needs an element: one must come before it"));
        };
        element.properties.push(Property { name, shape });
        self.text.end_line()
    }

    fn kind(&mut self) -> Result<ScalarType, MeshFault> {
        let word = self.text.word();
        let at = self.text.at() - word.len();
        ScalarType::from_name(word).ok_or_else(|| {
            let wanted = "char, uchar, short, ushort, int, uint, float or double";
            MeshFault::in_text(at, format!("unknown type {}; it is {wanted}", shown(word)))
        })
    }
}
