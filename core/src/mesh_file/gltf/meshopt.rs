//! Decoding of meshopt compression (`EXT_meshopt_compression`): attributes, triangles, indices, and
//! the filters of normals and floats.
//!
//! Our own decoder, because the crate `meshopt` is a binding to C++. The format is that of the extension's
//! specification, appendix A, version 0 of attributes and 1 of indices. Nothing is reserved before the compressed
//! bytes are known to suffice for the elements.

/// The kind of compressed elements.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Mode {
    Attributes,
    Triangles,
    Indices,
}

/// The change of elements after decoding.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Filter {
    None,
    Octahedral,
    Exponential,
}

/// The size of compressed elements when decoded.
#[derive(Clone, Copy)]
pub(super) struct Elements {
    pub(super) count: usize,
    /// Bytes of an element.
    pub(super) stride: usize,
}

const CUT_SHORT: &str = "it was cut short";

/// Greatest number of bytes that a compressed byte decodes to: 16 in a quarter of a byte.
pub(super) const MAX_RATIO: usize = 64;

/// Returns the decoded elements, or the message of a fault.
pub(super) fn decoded(data: &[u8], mode: Mode, filter: Filter, elements: Elements) -> Result<Vec<u8>, &'static str> {
    let Elements { count, stride } = elements;
    match count.checked_mul(stride) {
        Some(size) if size / MAX_RATIO <= data.len() => {}
        _ => return Err(CUT_SHORT),
    }
    let mut bytes = match mode {
        Mode::Attributes => attributes(data, elements)?,
        Mode::Triangles => index_bytes(&triangles(data, count)?, stride)?,
        Mode::Indices => index_bytes(&indices(data, count)?, stride)?,
    };
    match (filter, stride) {
        (Filter::None, _) => {}
        (Filter::Octahedral, 4) => bytes.chunks_exact_mut(4).for_each(unfold_bytes),
        (Filter::Octahedral, 8) => bytes.chunks_exact_mut(8).for_each(unfold_words),
        (Filter::Octahedral, _) => return Err("the filter OCTAHEDRAL wants a stride of 4 or 8 bytes"),
        (Filter::Exponential, _) => bytes.chunks_exact_mut(4).for_each(scale_mantissa),
    }
    Ok(bytes)
}

/// A reader of compressed bytes.
struct Input<'a> {
    bytes: &'a [u8],
}

impl<'a> Input<'a> {
    fn take(&mut self, count: usize) -> Result<&'a [u8], &'static str> {
        let (taken, rest) = self.bytes.split_at_checked(count).ok_or(CUT_SHORT)?;
        self.bytes = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> Result<u8, &'static str> {
        Ok(self.take(1)?[0])
    }

    /// Reads a number of up to five bytes with seven bits each, the lowest first.
    fn number(&mut self) -> Result<u32, &'static str> {
        let mut number = 0;
        for shift in (0..35).step_by(7) {
            let byte = self.byte()?;
            number |= u32::from(byte & 0x7f).wrapping_shl(shift);
            if byte < 0x80 {
                break;
            }
        }
        Ok(number)
    }

    /// Reads the difference of an index to `last`, and returns the index.
    fn index_after(&mut self, last: u32) -> Result<u32, &'static str> {
        Ok(last.wrapping_add(signed(self.number()?)))
    }
}

/// Returns the difference, modulo 2^32, that a number stands for: 0, -1, 1, -2, ...
fn signed(number: u32) -> u32 {
    (number >> 1) ^ (number & 1).wrapping_neg()
}

fn attributes(data: &[u8], Elements { count, stride }: Elements) -> Result<Vec<u8>, &'static str> {
    const GROUP: usize = 16;
    if stride == 0 || stride > 256 || !stride.is_multiple_of(4) {
        return Err("the stride of attributes is a multiple of 4, at most 256");
    }
    // The first element to which others are differences is at the end, in at least 32 bytes.
    let body = data.len().checked_sub(stride.max(32)).ok_or(CUT_SHORT)?;
    let mut input = Input { bytes: &data[..body] };
    if input.byte()? != 0xa0 {
        return Err("its attributes are not of version 0");
    }
    let mut last = data[data.len() - stride..].to_vec();
    let mut elements = vec![0; count * stride];
    let most = (8192 / stride / GROUP * GROUP).min(256);
    for block in elements.chunks_mut(most * stride) {
        let length = block.len() / stride;
        // A block has all first bytes of its elements, then all second bytes, and so on.
        for (k, last) in last.iter_mut().enumerate() {
            let groups = length.div_ceil(GROUP);
            let widths = input.take(groups.div_ceil(4))?;
            for group in 0..groups {
                let deltas = deltas(&mut input, widths[group / 4] >> (group % 4 * 2) & 3)?;
                for (i, delta) in (group * GROUP..length).zip(deltas) {
                    *last = last.wrapping_add((delta >> 1) ^ (delta & 1).wrapping_neg());
                    block[i * stride + k] = *last;
                }
            }
        }
    }
    if input.bytes.is_empty() { Ok(elements) } else { Err("it has more bytes than elements") }
}

/// Reads 16 bytes that take 0, 2, 4 or 8 bits each. The greatest number of 2 or 4 bits stands for a
/// byte of its own, after the others.
fn deltas(input: &mut Input<'_>, width: u8) -> Result<[u8; 16], &'static str> {
    let mut deltas = [0; 16];
    let bits = match width {
        0 => return Ok(deltas),
        1 => 2,
        2 => 4,
        _ => {
            deltas.copy_from_slice(input.take(16)?);
            return Ok(deltas);
        }
    };
    let packed = input.take(2 * bits)?;
    let own = (1 << bits) - 1;
    for (i, delta) in deltas.iter_mut().enumerate() {
        // The first number is in the highest bits.
        let from_top = (i + 1) * bits;
        *delta = packed[(from_top - 1) / 8] >> ((8 - from_top % 8) % 8) & own;
        if *delta == own {
            *delta = input.byte()?;
        }
    }
    Ok(deltas)
}

/// The last 16 edges and vertices of triangles, to which codes refer.
struct Recent {
    edges: [[u32; 2]; 16],
    edge: usize,
    vertices: [u32; 16],
    vertex: usize,
}

impl Recent {
    fn push_edge(&mut self, edge: [u32; 2]) {
        self.edges[self.edge % 16] = edge;
        self.edge += 1;
    }

    fn push_vertex(&mut self, vertex: u32) {
        self.vertices[self.vertex % 16] = vertex;
        self.vertex += 1;
    }

    /// Returns the edge that was pushed `back + 1` ago.
    fn edge(&self, back: usize) -> [u32; 2] {
        self.edges[(self.edge + 15 - back) % 16]
    }

    /// Returns the vertex that was pushed `back` ago; the last one for 1.
    fn vertex(&self, back: usize) -> u32 {
        self.vertices[(self.vertex + 16 - back) % 16]
    }
}

/// Returns the next vertex that no triangle has used yet.
fn new_vertex(next: &mut u32) -> u32 {
    let vertex = *next;
    *next = next.wrapping_add(1);
    vertex
}

fn triangles(data: &[u8], count: usize) -> Result<Vec<u32>, &'static str> {
    if !count.is_multiple_of(3) {
        return Err("the number of indices is not a multiple of 3");
    }
    let mut input = Input { bytes: data };
    if input.byte()? != 0xe1 {
        return Err("its triangles are not of version 1");
    }
    let codes = input.take(count / 3)?;
    // A table of frequent codes is at the end.
    let body = input.bytes.len().checked_sub(16).ok_or(CUT_SHORT)?;
    let (body, table) = input.bytes.split_at(body);
    input.bytes = body;
    let mut recent = Recent { edges: [[u32::MAX; 2]; 16], edge: 0, vertices: [u32::MAX; 16], vertex: 0 };
    let (mut next, mut last) = (0, 0_u32);
    let mut indices = Vec::with_capacity(count);
    for &code in codes {
        let low = usize::from(code & 15);
        if code < 0xf0 {
            // An edge of an earlier triangle, and a third vertex.
            let [a, b] = recent.edge(usize::from(code >> 4));
            let c = match low {
                0 => new_vertex(&mut next),
                1..=12 => recent.vertex(1 + low),
                13 => last.wrapping_sub(1),
                14 => last.wrapping_add(1),
                _ => input.index_after(last)?,
            };
            if low >= 13 {
                last = c;
            }
            if low == 0 || low >= 13 {
                recent.push_vertex(c);
            }
            recent.push_edge([c, b]);
            recent.push_edge([a, c]);
            indices.extend([a, b, c]);
            continue;
        }
        let is_in_table = code < 0xfe;
        let others = if is_in_table { table[low] } else { input.byte()? };
        if others == 0 && !is_in_table {
            next = 0;
        }
        let kinds = [if code == 0xff { 15 } else { 0 }, usize::from(others >> 4), usize::from(others & 15)];
        // All vertices but those of their own are found before any is pushed.
        let mut corners = kinds.map(|kind| if kind == 0 { new_vertex(&mut next) } else { recent.vertex(kind) });
        for (corner, &kind) in corners.iter_mut().zip(&kinds) {
            if kind == 15 && !is_in_table {
                *corner = input.index_after(last)?;
                last = *corner;
            }
        }
        for (&corner, &kind) in corners.iter().zip(&kinds) {
            if kind == 0 || (kind == 15 && !is_in_table) {
                recent.push_vertex(corner);
            }
        }
        let [a, b, c] = corners;
        recent.push_edge([b, a]);
        recent.push_edge([c, b]);
        recent.push_edge([a, c]);
        indices.extend(corners);
    }
    if input.bytes.is_empty() { Ok(indices) } else { Err("it has more bytes than triangles") }
}

fn indices(data: &[u8], count: usize) -> Result<Vec<u32>, &'static str> {
    // Four bytes at the end are padding.
    let body = data.len().checked_sub(4).ok_or(CUT_SHORT)?;
    let mut input = Input { bytes: &data[..body] };
    if input.byte()? != 0xd1 {
        return Err("its indices are not of version 1");
    }
    // Each takes at least a byte.
    if count > body {
        return Err(CUT_SHORT);
    }
    // Each index is a difference to the last one of one of two sequences.
    let mut last = [0_u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let number = input.number()?;
        let last = &mut last[(number & 1) as usize];
        *last = last.wrapping_add(signed(number >> 1));
        indices.push(*last);
    }
    if input.bytes.is_empty() { Ok(indices) } else { Err("it has more bytes than indices") }
}

/// Returns the indices as numbers of 2 or 4 bytes, of which 2 bytes drop the high ones.
fn index_bytes(indices: &[u32], stride: usize) -> Result<Vec<u8>, &'static str> {
    match stride {
        2 => Ok(indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect()),
        4 => Ok(indices.iter().flat_map(|index| index.to_le_bytes()).collect()),
        _ => Err("the stride of indices is 2 or 4 bytes"),
    }
}

/// Replaces the point of an octahedron by that of the sphere, in units of 1/127.
fn unfold_bytes(element: &mut [u8]) {
    let components = [0, 1, 2].map(|i| f32::from(element[i].cast_signed()));
    for (byte, value) in element.iter_mut().zip(unfolded(components, 127.0)) {
        *byte = (value as i8).cast_unsigned();
    }
}

/// Does the same as [`unfold_bytes`] in units of 1/32767.
fn unfold_words(element: &mut [u8]) {
    let components = [0, 1, 2].map(|i| f32::from(i16::from_le_bytes([element[2 * i], element[2 * i + 1]])));
    for (word, value) in element.chunks_exact_mut(2).zip(unfolded(components, 32767.0)) {
        word.copy_from_slice(&(value as i16).to_le_bytes());
    }
}

/// Returns a rounded vector of length `unit`. `one` is the unit in which x and y are.
fn unfolded([x, y, one]: [f32; 3], unit: f32) -> [f32; 3] {
    let z = one - x.abs() - y.abs();
    let fold = (-z).max(0.0);
    let [x, y] = [x, y].map(|v| if v >= 0.0 { v - fold } else { v + fold });
    let scale = unit / (x * x + y * y + z * z).sqrt();
    // Half away from zero; a cast to an integer drops the rest, and makes 0 of NaN.
    [x, y, z].map(|v| v * scale + if v >= 0.0 { 0.5 } else { -0.5 })
}

/// Replaces a mantissa of 24 bits and an exponent of 8 by a float.
fn scale_mantissa(element: &mut [u8]) {
    let word = i32::from_le_bytes([element[0], element[1], element[2], element[3]]);
    let value = libm::scalbn(f64::from(word << 8 >> 8), word >> 24) as f32;
    element.copy_from_slice(&value.to_le_bytes());
}

#[cfg(all(test, unit_tests))]
mod tests;
