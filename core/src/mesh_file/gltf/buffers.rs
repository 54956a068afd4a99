//! The buffers of a glTF file: in the GLB file, in side files, or in `data:` URIs.

#[cfg(feature = "draco")]
use super::draco::{self, Decoded};
use super::json::Json;
use super::meshopt::{self, Elements, Filter, Mode};
use crate::memory;
#[cfg(feature = "draco")]
use crate::mesh_file::MAX_MESH_BYTES;
use crate::mesh_file::MAX_TRIANGLES;
use crate::mesh_file::fault::{MeshFault, shown, shown_path};
use crate::mesh_file::left_out::LeftOut;
use crate::mesh_file::side_files::{SideFiles, side_file_path};
use base64::Engine;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::rc::Rc;

/// All buffers of a glTF file, each read on first use.
pub(super) struct Buffers<'a, 'b> {
    root: Json<'a>,
    glb: Option<&'a [u8]>,
    side_files: &'a mut SideFiles<'b>,
    read: HashMap<usize, Bytes<'a>>,
    files: HashMap<PathBuf, Rc<[u8]>>,
    /// The decoded bytes of compressed buffer views, and their total number.
    decompressed: HashMap<usize, Rc<[u8]>>,
    decompressed_size: usize,
    /// The primitives that are compressed with Draco, by their buffer views.
    #[cfg(feature = "draco")]
    primitives: HashMap<usize, Rc<Decoded>>,
    /// Total number of bytes of the JSON, and of the buffers and images read or decoded so far, for
    /// [`max_elements`](Self::max_elements).
    size: usize,
}

/// The kind of data that a URI names.
#[derive(Clone, Copy)]
enum Resource {
    /// A buffer. If its file is missing, the mesh has no shape: that is an error.
    Buffer,
    /// An image. If its file is missing, only colours are missing: that may be a warning.
    Picture,
}

/// The bytes of a buffer or an image.
#[derive(Clone)]
pub(super) enum Bytes<'a> {
    Glb(&'a [u8]),
    Read(Rc<[u8]>),
}

impl std::ops::Deref for Bytes<'_> {
    type Target = [u8];
    fn deref(&self) -> &[u8] {
        match self {
            Self::Glb(bytes) => bytes,
            Self::Read(bytes) => bytes,
        }
    }
}

/// A glTF buffer view: a range of a buffer's bytes.
#[derive(Clone)]
pub(super) struct BufferView<'a> {
    buffer: Bytes<'a>,
    start: usize,
    end: usize,
    /// The bytes from the start of an element to that of the next; `None` if elements are
    /// contiguous.
    pub(super) stride: Option<usize>,
}

impl BufferView<'_> {
    /// Returns a view of all these bytes.
    #[cfg(feature = "draco")]
    pub(super) fn of(bytes: Vec<u8>) -> Self {
        Self { start: 0, end: bytes.len(), buffer: Bytes::Read(bytes.into()), stride: None }
    }

    pub(super) fn bytes(&self) -> &[u8] {
        &self.buffer[self.start..self.end]
    }
}

impl<'a, 'b> Buffers<'a, 'b> {
    /// Returns the buffers of the document `root`, whose JSON has `size` bytes. `glb` is the BIN
    /// chunk of a GLB file.
    pub(super) fn new(root: Json<'a>, size: usize, glb: Option<&'a [u8]>, side_files: &'a mut SideFiles<'b>) -> Self {
        let size = size + glb.map_or(0, <[u8]>::len);
        Self {
            root,
            glb,
            side_files,
            read: HashMap::new(),
            files: HashMap::new(),
            decompressed: HashMap::new(),
            decompressed_size: 0,
            #[cfg(feature = "draco")]
            primitives: HashMap::new(),
            size,
        }
    }

    pub(super) fn root(&self) -> Json<'a> {
        self.root
    }

    /// Returns whether the file may be parsed on all threads of the current rayon pool.
    pub(super) fn is_parallel(&self) -> bool {
        self.side_files.is_parallel()
    }

    pub(super) fn left_out(&mut self) -> &mut LeftOut<'b> {
        &mut self.side_files.left_out
    }

    /// Warns of a fault that costs colours only; returns the fault if warnings are errors.
    pub(super) fn warn_of(&mut self, fault: MeshFault) -> Result<(), MeshFault> {
        let error = self.side_files.left_out.error_of(fault);
        self.side_files.warn_of(error)
    }

    /// Returns the limit on the triangles, and on the vertices, of a file of this size: one per
    /// byte and a million more. Without it a small file whose nodes repeat a mesh could exhaust memory.
    pub(super) fn max_elements(&self) -> usize {
        self.size.saturating_add(1 << 20).min(MAX_TRIANGLES)
    }

    /// Returns the buffer view with this index.
    pub(super) fn view(&mut self, index: Json<'a>) -> Result<BufferView<'a>, MeshFault> {
        let (number, view) = index.item_of(self.root, "bufferViews")?;
        // Decoded even if the extension is not required: the buffer of the uncompressed bytes may be missing.
        for name in ["EXT_meshopt_compression", "KHR_meshopt_compression"] {
            if let Some(compressed) = view.extension(name)? {
                let buffer = self.decompressed(number, compressed)?;
                let (end, stride) = (buffer.len(), view.field("byteStride")?.map(Json::index).transpose()?);
                return Ok(BufferView { buffer, start: 0, end, stride });
            }
        }
        let buffer = self.buffer(view.required("buffer")?)?;
        let start = view.index_or("byteOffset", 0)?;
        let length = view.required("byteLength")?.index()?;
        let stride = view.field("byteStride")?.map(Json::index).transpose()?;
        let end = start.checked_add(length).filter(|&end| end <= buffer.len()).ok_or_else(|| {
            let size = buffer.len();
            view.fault(format!("{length} bytes from byte {start} on are not in the buffer, which has {size}"))
        })?;
        Ok(BufferView { buffer, start, end, stride })
    }

    /// Returns the decoded bytes of a buffer view, which is compressed with meshopt.
    fn decompressed(&mut self, number: usize, compressed: Json<'a>) -> Result<Bytes<'a>, MeshFault> {
        if let Some(bytes) = self.decompressed.get(&number) {
            return Ok(Bytes::Read(Rc::clone(bytes)));
        }
        let buffer = self.buffer(compressed.required("buffer")?)?;
        let (start, length) = (compressed.index_or("byteOffset", 0)?, compressed.required("byteLength")?.index()?);
        let data = start.checked_add(length).and_then(|end| buffer.get(start..end));
        let data = data.ok_or_else(|| compressed.fault("these bytes are not in the buffer"))?;
        let mode = compressed.required("mode")?;
        let mode = match mode.string()? {
            "ATTRIBUTES" => Mode::Attributes,
            "TRIANGLES" => Mode::Triangles,
            "INDICES" => Mode::Indices,
            _ => return Err(mode.fault("expected ATTRIBUTES, TRIANGLES or INDICES")),
        };
        let filter = match compressed.field("filter")?.map(Json::string).transpose()?.unwrap_or("NONE") {
            "NONE" => Filter::None,
            "OCTAHEDRAL" => Filter::Octahedral,
            "EXPONENTIAL" => Filter::Exponential,
            other => return Err(compressed.fault(format!("the filter {} is not supported", shown(other.as_bytes())))),
        };
        let elements = Elements {
            count: compressed.required("count")?.index()?,
            stride: compressed.required("byteStride")?.index()?,
        };
        // Views may overlap, so that each byte could be decoded many times.
        let size = elements.count.saturating_mul(elements.stride);
        let total = self.decompressed_size.saturating_add(size);
        if total > meshopt::MAX_RATIO.saturating_mul(self.size - self.decompressed_size) {
            return Err(compressed.fault("this part of the file claims more elements than its bytes can hold"));
        }
        memory::check(size).map_err(|error| compressed.fault(error))?;
        let bytes = meshopt::decoded(data, mode, filter, elements)
            .map_err(|what| compressed.fault(format!("this part of the file cannot be decompressed: {what}")))?;
        // A byte may stand for many elements.
        self.decompressed_size += bytes.len();
        self.size += bytes.len();
        let bytes: Rc<[u8]> = bytes.into();
        self.decompressed.insert(number, Rc::clone(&bytes));
        Ok(Bytes::Read(bytes))
    }

    /// Returns a primitive that is compressed with Draco. `compressed` is the extension's value.
    #[cfg(feature = "draco")]
    pub(super) fn primitive(&mut self, compressed: Json<'a>) -> Result<Rc<Decoded>, MeshFault> {
        let index = compressed.required("bufferView")?;
        let (number, _) = index.item_of(self.root, "bufferViews")?;
        if let Some(decoded) = self.primitives.get(&number) {
            return Ok(Rc::clone(decoded));
        }
        let view = self.view(index)?;
        // Views may overlap, so that each byte could be decoded many times.
        let most = draco::MAX_RATIO.saturating_mul(self.size - self.decompressed_size);
        let left = most.saturating_add(1 << 20).saturating_sub(self.decompressed_size).min(MAX_MESH_BYTES);
        let decoded = Decoded::new(view.bytes(), left)
            .map_err(|what| compressed.fault(format!("this part of the file cannot be decompressed: {what}")))?;
        // The attributes are copied, vertex by vertex.
        memory::check(decoded.size().saturating_mul(2)).map_err(|error| compressed.fault(error))?;
        self.decompressed_size += decoded.size();
        self.size += decoded.size();
        let decoded = Rc::new(decoded);
        self.primitives.insert(number, Rc::clone(&decoded));
        Ok(decoded)
    }

    fn buffer(&mut self, index: Json<'a>) -> Result<Bytes<'a>, MeshFault> {
        let (index, buffer) = index.item_of(self.root, "buffers")?;
        if let Some(bytes) = self.read.get(&index) {
            return Ok(bytes.clone());
        }
        let length = buffer.required("byteLength")?.index()?;
        let bytes = match buffer.field("uri")? {
            Some(uri) => {
                let bytes = self.resource(uri, Resource::Buffer)?;
                bytes.ok_or_else(|| buffer.fault("the buffer is missing"))?
            }
            // glTF: only the first buffer may be the BIN chunk.
            None => match self.glb.filter(|_| index == 0) {
                Some(bytes) => Bytes::Glb(bytes),
                None => return Err(buffer.fault("the buffer has no uri, and the file has no BIN chunk for it")),
            },
        };
        // There may be more bytes: a BIN chunk is padded to a multiple of four.
        if bytes.len() < length {
            let found = bytes.len();
            return Err(
                buffer.fault(format!("the buffer should have {length} bytes, and has {found}: it was cut short"))
            );
        }
        self.read.insert(index, bytes.clone());
        Ok(bytes)
    }

    /// Returns the bytes of an image; `None` if its side file is missing.
    pub(super) fn picture(&mut self, uri: Json<'a>) -> Result<Option<Bytes<'a>>, MeshFault> {
        self.resource(uri, Resource::Picture)
    }

    /// Returns the bytes of a URI: a `data:` URI's own, or those of a side file.
    fn resource(&mut self, uri: Json<'a>, kind: Resource) -> Result<Option<Bytes<'a>>, MeshFault> {
        let text = uri.string()?;
        if let Some(data) = text.strip_prefix("data:") {
            return data_of(data).map(|bytes| Some(Bytes::Read(bytes.into()))).map_err(|message| uri.fault(message));
        }
        let path = side_file_path(Path::new(""), &percent_decoded(text)).map_err(|message| uri.fault(message))?;
        // Several buffers and images may name the same file, under different indices.
        if let Some(bytes) = self.files.get(&path) {
            return Ok(Some(Bytes::Read(Rc::clone(bytes))));
        }
        let bytes = match kind {
            Resource::Buffer => self.side_files.read(&path).map(Some),
            Resource::Picture => self.side_files.read_colors(&path, "texture"),
        };
        let Some(bytes) = bytes.map_err(|message| uri.fault(message).of_side_file())? else { return Ok(None) };
        self.size += bytes.len();
        let bytes: Rc<[u8]> = bytes.into();
        self.files.insert(path, Rc::clone(&bytes));
        Ok(Some(Bytes::Read(bytes)))
    }
}

/// Decodes the base64 of a `data:` URI, given the part after `data:`.
fn data_of(data: &str) -> Result<Vec<u8>, String> {
    // URIs often omit the padding at the end of base64, which does not change the bytes.
    const LENIENT: GeneralPurposeConfig =
        GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent);
    let Some((_, encoded)) = data.split_once(";base64,") else {
        return Err("the data: URI lacks \";base64,\"".to_owned());
    };
    let engine = GeneralPurpose::new(&base64::alphabet::STANDARD, LENIENT);
    engine
        .decode(encoded)
        .map_err(|error| format!("the data: URI is not base64: {}", error.to_string().trim_end_matches('.')))
}

/// Decodes percent escapes, such as `%20` for a blank.
fn percent_decoded(uri: &str) -> String {
    let mut bytes = Vec::with_capacity(uri.len());
    // Works on bytes, because one character may take several escapes.
    let mut rest = uri.as_bytes();
    while let [first, after @ ..] = rest {
        let code = after.get(..2).and_then(|digits| std::str::from_utf8(digits).ok());
        if let Some(byte) = code.filter(|_| *first == b'%').and_then(|digits| u8::from_str_radix(digits, 16).ok()) {
            bytes.push(byte);
            rest = &after[2..];
        } else {
            bytes.push(*first);
            rest = after;
        }
    }
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Returns the name of an image for messages: its file, or "the picture" if it is in the mesh file.
pub(super) fn shown_image_name(uri: Option<&str>) -> String {
    match uri.filter(|uri| !uri.starts_with("data:")) {
        Some(uri) => shown_path(uri),
        None => "the picture".to_owned(),
    }
}
