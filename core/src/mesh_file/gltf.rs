//! glTF 2.0, as JSON and as GLB: the triangles of the default scene, transformed by their nodes,
//! with normals, colours, base colours and base-colour textures, moved by their skins and morph targets.
//!
//! Meshopt compression is decoded, and Draco with the feature `draco`. Perspective cameras and the lights of
//! `KHR_lights_punctual` are read.
//!
//! The first animation of the nodes becomes a [`Motion`](super::motion::Motion); the mesh itself is as at time 0.
//!
//! Not read: animations of skins, morph targets, cameras and lights, orthographic cameras, and other properties of
//! materials than the base colour.

mod accessor;
mod animation;
mod buffers;
#[cfg(feature = "draco")]
mod draco;
mod json;
mod materials;
mod meshopt;
mod moving;
mod nodes;
mod pose;
mod primitives;
mod staging;
mod tree;

use super::MeshFile;
use super::fault::{MeshFault, shown};
use super::left_out::LeftOut;
use super::side_files::SideFiles;
use crate::progress::Meter;
use crate::scene_text::clipped;
use accessor::DRACO;
use buffers::Buffers;
use json::Json;
use serde_json::Value;

/// Reads a glTF file in JSON.
pub(super) fn read_json(bytes: &[u8], side_files: &mut SideFiles<'_>, meter: Meter<'_>) -> Result<MeshFile, MeshFault> {
    read(bytes, 0, None, side_files, meter)
}

/// Reads a GLB file: a header of 12 bytes and chunks, of which the first is JSON and the second may
/// be a buffer.
pub(super) fn read_binary(
    bytes: &[u8],
    side_files: &mut SideFiles<'_>,
    meter: Meter<'_>,
) -> Result<MeshFile, MeshFault> {
    const HEADER: usize = 12;
    let word = |at: usize| bytes.get(at..at + 4).and_then(|word| word.try_into().ok()).map(u32::from_le_bytes);
    let (Some(version), Some(length)) = (word(4), word(8)) else {
        return Err(MeshFault::at_byte(
            bytes.len(),
            "the file ends within the header of 12 bytes that a GLB file begins with",
        ));
    };
    if !bytes.starts_with(b"glTF") {
        return Err(MeshFault::at_byte(0, "a GLB file begins with \"glTF\""));
    }
    if version != 2 {
        return Err(MeshFault::at_byte(4, format!("this is version {version} of GLB; only version 2 is read")));
    }
    // A file longer than its header claims is accepted, and the bytes beyond that length are ignored, unless they are
    // the buffer.
    if length as usize > bytes.len() {
        let found = bytes.len();
        return Err(MeshFault::at_byte(
            8,
            format!("the file was cut short: it should have {length} bytes, and has {found}"),
        ));
    }
    let chunk = |at: usize, kind: &[u8; 4], name: &str| {
        let Some(size) = word(at) else {
            return Err(MeshFault::at_byte(at, format!("the file ends where the {name} chunk should begin")));
        };
        if bytes.get(at + 4..at + 8) != Some(kind) {
            let found = shown(bytes.get(at + 4..at + 8).unwrap_or_default());
            return Err(MeshFault::at_byte(at + 4, format!("this chunk should be {name}, but is {found}")));
        }
        let rest = &bytes[at + 8..];
        rest.get(..size as usize).ok_or_else(|| {
            MeshFault::at_byte(at, format!("this chunk should have {size} bytes, but only {} are left", rest.len()))
        })
    };
    let json = chunk(HEADER, b"JSON", "JSON")?;
    // A chunk starts at a multiple of four bytes. Some writers include the padding in the chunk length before it,
    // others do not.
    let buffer_at = (HEADER + 8 + json.len()).next_multiple_of(4);
    let buffer = match buffer_at {
        at if at < length as usize => Some(chunk(at, b"BIN\0", "BIN")?),
        // Some writers state a length without the buffer. Other bytes there are no part of the file.
        at if bytes.get(at + 4..at + 8) == Some(b"BIN\0") => Some(chunk(at, b"BIN\0", "BIN")?),
        _ => None,
    };
    read(json, HEADER + 8, buffer, side_files, meter)
}

/// Parses the JSON and reads its mesh. `at` is the offset of the JSON in a GLB file, 0 otherwise.
fn read(
    json: &[u8],
    at: usize,
    glb_buffer: Option<&[u8]>,
    side_files: &mut SideFiles<'_>,
    mut meter: Meter<'_>,
) -> Result<MeshFile, MeshFault> {
    meter.report_indeterminate()?;
    let text = json.strip_prefix(b"\xef\xbb\xbf").unwrap_or(json);
    // The JSON chunk of a GLB file is padded with spaces, but some programs take NUL.
    let text = &text[..text.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1)];
    check_count(text)?;
    let document: Value = serde_json::from_slice(text).map_err(|error| syntax_fault(&error, json, text, at))?;
    let root = Json::root(&document)?;
    check_version(root)?;
    side_files.left_out.not_shown("extension (not an object)", json::count_faulty_extensions(&document));
    check_extensions(root, &mut side_files.left_out)?;
    nodes::read(root, &mut Buffers::new(root, json.len(), glb_buffer, side_files), &mut meter)
}

/// Limits on the number of objects, and of items of lists and objects, in a JSON document. A parsed
/// object takes 600 bytes and an item 32: `{}` takes 300 times its size as text, so a file of 2 GiB could exhaust any
/// memory.
const MAX_OBJECTS: usize = 1 << 20;
const MAX_ITEMS: usize = 16 << 20;

/// Refuses a document with too many values, before it is parsed.
fn check_count(json: &[u8]) -> Result<(), MeshFault> {
    // Brackets and commas within strings are counted as well, which is harmless: real files are far below the limits.
    let count = |wanted: &[u8]| json.iter().filter(|byte| wanted.contains(byte)).count();
    if count(b"{") > MAX_OBJECTS || count(b"[,") > MAX_ITEMS {
        let message = format!("the JSON has more than {MAX_OBJECTS} objects or {MAX_ITEMS} items, too many to be read");
        return Err(MeshFault::of_file(message));
    }
    Ok(())
}

/// Converts a syntax error of the JSON: with line and column in a text file, with the byte offset
/// in a GLB file.
fn syntax_fault(error: &serde_json::Error, json: &[u8], text: &[u8], offset: usize) -> MeshFault {
    let line_start = text.split_inclusive(|&byte| byte == b'\n').take(error.line().saturating_sub(1)).map(<[u8]>::len);
    let place = if json.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 }
        + line_start.sum::<usize>()
        + error.column().saturating_sub(1);
    // serde_json ends its message with a position; the fault has a position of its own, in the whole file.
    let (full, told) = (error.to_string(), format!(" at line {} column {}", error.line(), error.column()));
    let message = format!("this is not JSON: {}", full.strip_suffix(&told).unwrap_or(&full));
    if offset == 0 { MeshFault::in_text(place, message) } else { MeshFault::at_byte(offset + place, message) }
}

fn check_version(root: Json<'_>) -> Result<(), MeshFault> {
    let Some(asset) = root.field("asset")? else {
        return Err(MeshFault::of_file("this JSON is not glTF: it lacks asset: {version: \"2.0\"}"));
    };
    let version = asset.required("version")?;
    // Some programs write the version as a number, not as a string.
    let text =
        version.number().map_or_else(|_| version.string().map(str::to_owned), |number| Ok(number.to_string()))?;
    if text == "2" || text.starts_with("2.") {
        return Ok(());
    }
    Err(version.fault(format!("this is glTF {text}; only 2.0 is read")))
}

/// The extensions that a file may require, and that are not counted as not shown.
///
/// They have no effect on the picture, or their effect is shown, or it is counted elsewhere.
const SHOWN_EXTENSIONS: [&str; 14] = [
    "EXT_meshopt_compression",
    "KHR_meshopt_compression",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_lights_punctual",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_specular",
    "KHR_texture_basisu",
    "EXT_texture_webp",
    "EXT_texture_avif",
    "MSFT_texture_dds",
    "KHR_xmp_json_ld",
];

fn is_shown(extension: &str) -> bool {
    SHOWN_EXTENSIONS.contains(&extension) || cfg!(feature = "draco") && extension == DRACO
}

/// Refuses a file that requires an unsupported extension, because it would be drawn wrong.
///
/// An unsupported extension that is used but not required is counted as not shown.
fn check_extensions(root: Json<'_>, left_out: &mut LeftOut<'_>) -> Result<(), MeshFault> {
    for extension in root.list("extensionsRequired")? {
        let name = extension.string()?;
        // Extensions of materials change how light is reflected, not the shape: without them a picture is still useful.
        // Textures that cannot be read are reported where a material names them.
        if !name.starts_with("KHR_materials_") && !is_shown(name) {
            let what = match name {
                DRACO => "its triangles are compressed with Draco",
                _ => "it may not be drawn without it",
            };
            let name = shown(name.as_bytes());
            return Err(extension.fault(format!("the extension {name} is not supported: {what}; export it without")));
        }
    }
    for extension in root.list("extensionsUsed")? {
        let name = extension.string()?;
        if !is_shown(name) {
            left_out.not_shown(format!("extension ({})", clipped(name)), 1);
        }
    }
    Ok(())
}
