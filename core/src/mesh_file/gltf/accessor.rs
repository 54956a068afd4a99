//! The accessors of a glTF file: typed views of a buffer's bytes.

use super::buffers::{BufferView, Buffers};
use super::json::Json;
#[cfg(feature = "draco")]
use crate::memory;
use crate::mesh_file::fault::MeshFault;
use crate::threads;
#[cfg(feature = "draco")]
use draco_core::DataType;
use std::sync::atomic::{AtomicBool, Ordering};

/// The extension that compresses primitives.
pub(super) const DRACO: &str = "KHR_draco_mesh_compression";

/// A glTF accessor: `count` elements, each with `width` components.
pub(super) struct Accessor<'a> {
    json: Json<'a>,
    component: Component,
    width: usize,
    pub(super) count: usize,
    normalized: bool,
    /// The elements' bytes; `None` if the accessor has no buffer view, which makes all components
    /// zero.
    elements: Option<Elements<'a>>,
    sparse: Option<Sparse<'a>>,
    /// Whether many elements may be read on several threads.
    is_parallel: bool,
}

/// The number of elements or triangles from which on they are read on several threads.
// Fewer are read in a millisecond, for which no threads need to be started.
pub(super) const MIN_PARALLEL: usize = 1 << 16;

/// Elements in a buffer view: the first at `offset`, each `stride` bytes after the previous one.
struct Elements<'a> {
    view: BufferView<'a>,
    offset: usize,
    stride: usize,
}

/// The sparse part of an accessor: `values` replace the elements at `indices`.
struct Sparse<'a> {
    indices: Elements<'a>,
    index_component: Component,
    values: Elements<'a>,
    count: usize,
}

#[derive(Clone, Copy, PartialEq, Eq)]
enum Component {
    I8,
    U8,
    I16,
    U16,
    U32,
    F32,
}

impl Component {
    /// Returns the type of the same numbers in Draco.
    #[cfg(feature = "draco")]
    fn draco_type(self) -> DataType {
        match self {
            Self::I8 => DataType::Int8,
            Self::U8 => DataType::Uint8,
            Self::I16 => DataType::Int16,
            Self::U16 => DataType::Uint16,
            Self::U32 => DataType::Uint32,
            Self::F32 => DataType::Float32,
        }
    }

    fn read(json: Json<'_>) -> Result<Self, MeshFault> {
        let field = json.required("componentType")?;
        Ok(match field.index()? {
            // The constants of OpenGL. Signed integers of 32 bits, 5124, are not allowed in glTF.
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5125 => Self::U32,
            5126 => Self::F32,
            other => return Err(field.fault(format!("{other} is not a component type (5120 to 5123, 5125, 5126)"))),
        })
    }

    fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::U32 | Self::F32 => 4,
        }
    }

    fn is_index(self) -> bool {
        matches!(self, Self::U8 | Self::U16 | Self::U32)
    }

    /// Returns the component at the start of `b` as a number. Panics if `b` is shorter than the
    /// component.
    fn number(self, b: &[u8], normalized: bool) -> f32 {
        let (value, largest) = match self {
            Self::F32 => return f32::from_le_bytes([b[0], b[1], b[2], b[3]]),
            Self::I8 => (f32::from(b[0].cast_signed()), 127.0),
            Self::U8 => (f32::from(b[0]), 255.0),
            Self::I16 => (f32::from(i16::from_le_bytes([b[0], b[1]])), 32767.0),
            Self::U16 => (f32::from(u16::from_le_bytes([b[0], b[1]])), 65535.0),
            Self::U32 => (u32::from_le_bytes([b[0], b[1], b[2], b[3]]) as f32, 4_294_967_295.0),
        };
        // As in the glTF specification: -128 and -127 both mean -1.
        if normalized { (value / largest).max(-1.0) } else { value }
    }

    /// Returns the component at the start of `b` as an index. Panics if `b` is shorter than the
    /// component.
    fn index(self, b: &[u8]) -> u32 {
        match self {
            Self::I8 | Self::U8 => u32::from(b[0]),
            Self::I16 | Self::U16 => u32::from(u16::from_le_bytes([b[0], b[1]])),
            Self::U32 | Self::F32 => u32::from_le_bytes([b[0], b[1], b[2], b[3]]),
        }
    }
}

impl<'a> Elements<'a> {
    /// Returns `count` elements of `size` bytes, after checking that they lie within the buffer
    /// view that `json` names; `None` if it names none.
    fn new(
        json: Json<'a>,
        size: usize,
        count: usize,
        buffers: &mut Buffers<'a, '_>,
    ) -> Result<Option<Self>, MeshFault> {
        let Some(view) = json.field("bufferView")? else { return Ok(None) };
        let view = buffers.view(view)?;
        let offset = json.index_or("byteOffset", 0)?;
        let stride = view.stride.unwrap_or(size);
        // Checked arithmetic, because the numbers come from the file. The last element takes `size` bytes, not a whole
        // stride.
        let last = count.saturating_sub(1).checked_mul(stride);
        let end = last.and_then(|last| last.checked_add(offset)?.checked_add(size));
        let length = view.bytes().len();
        if count > 0 && end.is_none_or(|end| end > length) {
            let message = format!("{count} elements of {size} bytes do not fit into their buffer view of {length}");
            return Err(json.fault(message));
        }
        // With such a stride elements would overlap, which glTF does not allow.
        if stride < size && count > 1 {
            return Err(json.fault(format!("elements of {size} bytes lie only {stride} bytes apart (byteStride)")));
        }
        Ok(Some(Self { view, offset, stride }))
    }

    fn element_bytes(&self, i: usize) -> &[u8] {
        &self.view.bytes()[self.offset + i * self.stride..]
    }
}

impl<'a> Accessor<'a> {
    /// Returns the accessor with this index.
    pub(super) fn read(index: Json<'a>, buffers: &mut Buffers<'a, '_>) -> Result<Self, MeshFault> {
        let (_, json) = index.item_of(buffers.root(), "accessors")?;
        let component = Component::read(json)?;
        let kind = json.required("type")?;
        let width = match kind.string()? {
            "SCALAR" => 1,
            "VEC2" => 2,
            "VEC3" => 3,
            "VEC4" => 4,
            "MAT4" => 16,
            _ => return Err(kind.fault("expected SCALAR, VEC2, VEC3, VEC4 or MAT4")),
        };
        let count = json.required("count")?.index()?;
        let elements = Elements::new(json, width * component.size(), count, buffers)?;
        // Elements without a buffer view take no bytes of the file, so its size does not limit their number.
        if elements.is_none() && count > buffers.max_elements() {
            return Err(json.fault(format!("{count} elements of zeros are too many for a file of this size")));
        }
        let sparse = match json.field("sparse")? {
            Some(sparse) => Some(Sparse::read(sparse, width * component.size(), count, buffers)?),
            None => None,
        };
        let (normalized, is_parallel) = (json.is_true("normalized")?, buffers.is_parallel());
        Ok(Self { json, component, width, count, normalized, elements, sparse, is_parallel })
    }

    /// Returns the accessor of a primitive's attribute `name`, whose elements may be compressed.
    #[cfg_attr(not(feature = "draco"), allow(unused_variables, reason = "only Draco compresses primitives"))]
    pub(super) fn of_attribute(
        primitive: Json<'a>,
        name: &'static str,
        index: Json<'a>,
        buffers: &mut Buffers<'a, '_>,
    ) -> Result<Self, MeshFault> {
        #[cfg(feature = "draco")]
        if let Some(compressed) = primitive.extension(DRACO)?
            && let Some(id) = compressed.required("attributes")?.field(name)?
        {
            // Decoded first, as the size of what is decoded limits the number of elements.
            let decoded = buffers.primitive(compressed)?;
            let accessor = Self::read(index, buffers)?;
            let missing = || id.fault("the compressed data has no such attribute, or not for every vertex");
            let attribute = u32::try_from(id.index()?).ok().and_then(|id| decoded.attribute(id)).ok_or_else(missing)?;
            let stride = attribute.value_size();
            if stride != accessor.width * accessor.component.size()
                || attribute.data_type() != accessor.component.draco_type()
            {
                return Err(accessor.fault("the compressed elements are of another type than the accessor"));
            }
            // Many vertices may share a value, which the limits of the decoder count once.
            memory::check(decoded.vertex_count().saturating_mul(stride)).map_err(|error| accessor.fault(error))?;
            let bytes = attribute.bytes().ok_or_else(missing)?;
            let elements = Elements { view: BufferView::of(bytes), offset: 0, stride };
            return Ok(Self { elements: Some(elements), count: decoded.vertex_count(), sparse: None, ..accessor });
        }
        Self::read(index, buffers)
    }

    /// Returns a fault whose message starts with this accessor's path.
    pub(super) fn fault(&self, message: impl std::fmt::Display) -> MeshFault {
        self.json.fault(message)
    }

    /// Returns the first `N` components of each element; all must be finite.
    pub(super) fn vectors<const N: usize>(&self) -> Result<Vec<[f32; N]>, MeshFault> {
        // More components than `N` are allowed: colours may have an opacity, which is skipped.
        if self.width < N {
            return Err(self.fault(format!("expected elements of {N} numbers, found elements of {}", self.width)));
        }
        // Copied, because the buffers cannot be shared between threads.
        let (component, normalized) = (self.component, self.normalized);
        let has_faults = AtomicBool::new(false);
        let is_faulty = |vector: &[f32; N]| vector.iter().any(|number| !number.is_finite());
        let vector = |bytes: &[u8]| -> [f32; N] {
            let vector = std::array::from_fn(|i| component.number(&bytes[i * component.size()..], normalized));
            if is_faulty(&vector) {
                has_faults.store(true, Ordering::Relaxed);
            }
            vector
        };
        let vectors = self.read_elements([0.0; N], vector);
        // A faulty element may have been replaced by one of the sparse part.
        match has_faults.into_inner().then(|| vectors.iter().position(is_faulty)).flatten() {
            Some(i) => Err(self.fault(format!("element {i} is not finite: {:?}", vectors[i]))),
            None => Ok(vectors),
        }
    }

    /// Returns the elements as indices.
    pub(super) fn indices(&self) -> Result<Vec<u32>, MeshFault> {
        if self.width != 1 || !self.component.is_index() {
            return Err(self.fault("indices are SCALAR and of component type 5121, 5123 or 5125"));
        }
        let component = self.component;
        Ok(self.read_elements(0, |bytes| component.index(bytes)))
    }

    fn read_elements<T: Copy + Send>(&self, zero: T, read: impl Fn(&[u8]) -> T + Send + Sync) -> Vec<T> {
        let mut all = match &self.elements {
            Some(elements) if self.is_parallel && self.count >= MIN_PARALLEL => {
                let (bytes, stride) = (&elements.view.bytes()[elements.offset..], elements.stride);
                threads::map(self.count, |i| read(&bytes[i * stride..]))
            }
            Some(elements) => (0..self.count).map(|i| read(elements.element_bytes(i))).collect(),
            None => vec![zero; self.count],
        };
        if let Some(sparse) = &self.sparse {
            for i in 0..sparse.count {
                all[sparse.index_component.index(sparse.indices.element_bytes(i)) as usize] =
                    read(sparse.values.element_bytes(i));
            }
        }
        all
    }
}

impl<'a> Sparse<'a> {
    fn read(json: Json<'a>, size: usize, elements: usize, buffers: &mut Buffers<'a, '_>) -> Result<Self, MeshFault> {
        let count = json.required("count")?.index()?;
        if count > elements {
            return Err(json.fault(format!("{count} of {elements} elements cannot be replaced")));
        }
        let indices = json.required("indices")?;
        let values = json.required("values")?;
        let index_component = Component::read(indices)?;
        if !index_component.is_index() {
            return Err(indices.fault("indices are of component type 5121, 5123 or 5125"));
        }
        let missing = || json.fault("the indices or values have no bufferView");
        let sparse = Self {
            indices: Elements::new(indices, index_component.size(), count, buffers)?.ok_or_else(missing)?,
            values: Elements::new(values, size, count, buffers)?.ok_or_else(missing)?,
            index_component,
            count,
        };
        // The sparse indices are checked once here, so that indexing in `read_elements` cannot panic.
        let out = (0..count)
            .map(|i| index_component.index(sparse.indices.element_bytes(i)))
            .find(|&i| i as usize >= elements);
        match out {
            Some(index) => Err(indices.fault(format!("index {index} is out of range: there are {elements} elements"))),
            None => Ok(sparse),
        }
    }
}
