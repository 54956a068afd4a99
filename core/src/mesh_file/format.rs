//! Recognition of a mesh file's format by its content.

use super::fault::{MeshFault, shown};
use super::{obj, stl};
use std::path::Path;

/// The formats that can be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum MeshFormat {
    Obj,
    StlText,
    StlBinary,
    Ply,
    Gltf,
    Glb,
}

/// First bytes of formats that are not supported, each with the end of the error message. The order
/// matters: `<?xml` comes before `<`.
const OTHERS: [(&[u8], &str); 15] = [
    (b"\x1f\x8b", "is gzip-compressed: unpack it first (gunzip)"),
    (b"BZh", "is bzip2-compressed: unpack it first (bunzip2)"),
    (b"\xfd7zXZ\0", "is xz-compressed: unpack it first (unxz)"),
    (b"\x28\xb5\x2f\xfd", "is zstd-compressed: unpack it first (unzstd)"),
    (
        b"PK\x03\x04",
        "is a ZIP archive (as 3MF and USDZ files are): unpack it first, or export it as OBJ, STL, PLY or glTF",
    ),
    (b"7z\xbc\xaf\x27\x1c", "is a 7z archive: unpack it first"),
    (b"version https://git-lfs", "is only a pointer of Git LFS to the file: fetch it with `git lfs pull`"),
    (b"\x89PNG", "is a PNG picture, not a mesh"),
    (b"\xff\xd8\xff", "is a JPEG picture, not a mesh"),
    (b"GIF8", "is a GIF picture, not a mesh"),
    (b"%PDF", "is a PDF document, not a mesh"),
    (b"Kaydara FBX", "is an FBX file: export it as OBJ, STL, PLY or glTF"),
    (b"BLENDER", "is a Blender file: export it as OBJ, STL, PLY or glTF"),
    (b"<?xml", "is XML (COLLADA or X3D?): export it as OBJ, STL, PLY or glTF"),
    (b"<", "is a web page or XML, not a mesh; was the right link downloaded?"),
];

const READ: &str = "OBJ, STL, PLY, glTF and GLB files are read";

impl MeshFormat {
    /// Returns the name of the format, for people. In lower case, it is the extension of its files.
    pub(super) fn name(self) -> &'static str {
        match self {
            Self::Obj => "OBJ",
            Self::StlText | Self::StlBinary => "STL",
            Self::Ply => "PLY",
            Self::Gltf => "glTF",
            Self::Glb => "GLB",
        }
    }
}

/// Returns the format of the bytes. The file name's extension counts only if the content does not
/// decide, because downloads are often misnamed.
///
/// `stated` is the extension of the format that the user states, which takes precedence over both.
pub(super) fn recognised(name: &str, stated: Option<&str>, bytes: &[u8]) -> Result<MeshFormat, MeshFault> {
    // A text may start with a byte order mark and blank lines.
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes).trim_ascii_start();
    if text.is_empty() {
        return Err(MeshFault::of_file(format!("the file is empty; {READ}")));
    }
    // Even if the user states that the file is STL, the content tells whether it is text or binary.
    let is_possible = |format: &MeshFormat| stated.is_none_or(|stated| format.name().eq_ignore_ascii_case(stated));
    if let Some(format) = by_content(bytes, text).filter(is_possible) {
        return Ok(format);
    }
    // These other formats are tested before the extension is used: a compressed file may still be named `.stl`.
    if let Some((_, what)) = OTHERS.iter().find(|(start, _)| bytes.starts_with(start)) {
        return Err(MeshFault::of_file(format!("this {what}")));
    }
    match stated.map_or_else(|| by_ending(name), of_ending) {
        // An STL file whose content did not show its form: text, for example with a comment before `solid`, or else
        // binary with a wrong size.
        Some(MeshFormat::StlBinary) if is_text(bytes) => Ok(MeshFormat::StlText),
        format => format.ok_or_else(|| MeshFault::of_file(not_known(name, bytes))),
    }
}

fn by_content(bytes: &[u8], text: &[u8]) -> Option<MeshFormat> {
    match bytes {
        [b'p', b'l', b'y', b'\r' | b'\n', ..] => Some(MeshFormat::Ply),
        _ if bytes.starts_with(b"glTF") => Some(MeshFormat::Glb),
        // Binary formats before text: the header of a binary STL file may contain anything, even "solid".
        _ if stl::size_fits(bytes) => Some(MeshFormat::StlBinary),
        _ if text.starts_with(b"{") => Some(MeshFormat::Gltf),
        _ if is_stl_text(text) => Some(MeshFormat::StlText),
        _ if is_obj(text) => Some(MeshFormat::Obj),
        _ => None,
    }
}

/// Returns whether the bytes start with the word `solid`, and are text.
fn is_stl_text(text: &[u8]) -> bool {
    let begins = text.get(..5).is_some_and(|word| word.eq_ignore_ascii_case(b"solid"));
    let ends_word = text.get(5).is_none_or(u8::is_ascii_whitespace);
    begins && ends_word && is_text(text)
}

/// Returns whether the first 512 bytes are all possible in text.
// A binary STL file may begin with "solid" too, but its count and its first floats contain bytes that are never part of
// UTF-8 or Latin text.
fn is_text(bytes: &[u8]) -> bool {
    // Old programs end a text with NUL.
    let end = bytes.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    end > 0 && bytes[..end].iter().take(512).all(|byte| (b'\t'..0xf8).contains(byte))
}

/// Returns whether the first line with content starts with an OBJ keyword.
fn is_obj(text: &[u8]) -> bool {
    let lines = text.split(|byte| b"\r\n".contains(byte)).map(<[u8]>::trim_ascii);
    let mut statements = lines.filter(|line| !line.is_empty() && !line.starts_with(b"#")).map(first_word);
    statements.next().is_some_and(obj::is_statement)
}

fn first_word(line: &[u8]) -> &[u8] {
    line.split(u8::is_ascii_whitespace).next().unwrap_or_default()
}

/// Returns the format by the file name's extension, in upper or lower case.
pub(super) fn by_ending(name: &str) -> Option<MeshFormat> {
    of_ending(&Path::new(name).extension()?.to_str()?.to_ascii_lowercase())
}

fn of_ending(ending: &str) -> Option<MeshFormat> {
    Some(match ending {
        "obj" => MeshFormat::Obj,
        "stl" => MeshFormat::StlBinary,
        "ply" => MeshFormat::Ply,
        "gltf" => MeshFormat::Gltf,
        "glb" => MeshFormat::Glb,
        _ => return None,
    })
}

fn not_known(name: &str, bytes: &[u8]) -> String {
    let ending = match Path::new(name).extension() {
        Some(ending) => format!("neither its ending {}", shown(ending.to_string_lossy().as_bytes())),
        None => "neither its name, which has no ending,".to_owned(),
    };
    format!(
        "this is not a known mesh format: {ending} nor its first bytes {} tell the format; {READ}",
        shown(&bytes[..bytes.len().min(8)])
    )
}
