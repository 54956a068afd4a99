//! Files in other formats than RON, recognised so that the error message can name the format.

use std::ffi::OsStr;
use std::path::Path;

/// Formats that termtrace does not read, with the extensions of their files.
const ENDINGS: [(&str, &[&str]); 12] = [
    ("FBX", &["fbx"]),
    ("3MF", &["3mf"]),
    ("OFF", &["off"]),
    ("3DS", &["3ds"]),
    ("Collada", &["dae"]),
    ("Blender", &["blend"]),
    ("X3D", &["x3d", "wrl"]),
    ("USD", &["usd", "usda", "usdc", "usdz"]),
    ("STEP", &["step", "stp"]),
    ("IGES", &["iges", "igs"]),
    ("Alembic", &["abc"]),
    ("a picture", &["png", "jpg", "jpeg", "gif", "webp", "bmp", "tga"]),
];

/// Formats that termtrace does not read, with the first bytes of their files.
const STARTS: [(&str, &[u8]); 7] = [
    ("FBX", b"Kaydara FBX"),
    ("OFF", b"OFF\n"),
    ("OFF", b"OFF "),
    ("Blender", b"BLENDER"),
    ("USD", b"PXR-USDC"),
    ("STEP", b"ISO-10303-21"),
    ("a ZIP archive", b"PK\x03\x04"),
];

/// Formats that termtrace reads only if the extension is right, with the first words of their
/// files.
const NAMELESS: [(&str, &[u8]); 6] =
    [("OBJ", b"v "), ("OBJ", b"mtllib "), ("OBJ", b"o "), ("OBJ", b"g "), ("STL", b"solid "), ("OBJ", b"# Blender")];

/// Returns the message about a file in another format than RON; `None` if it may be RON.
pub(super) fn message(name: &str, bytes: &[u8]) -> Option<String> {
    let start = bytes.trim_ascii_start();
    // Contents that may be RON are parsed, whatever the extension of the file.
    if start.is_empty() || start.starts_with(b"(") || start.starts_with(b"//") || start.starts_with(b"/*") {
        return None;
    }
    if let Some((format, _)) = NAMELESS.iter().find(|(_, first)| start.starts_with(first)) {
        let ending = format.to_lowercase();
        return Some(format!("this looks like {format}, which is read from files whose names end in .{ending}"));
    }
    // The extension is checked before the first bytes, because USDZ and 3MF files begin like any ZIP archive.
    let ending = Path::new(name).extension().and_then(OsStr::to_str).unwrap_or_default().to_ascii_lowercase();
    let named = ENDINGS.iter().find(|(_, endings)| endings.contains(&&*ending));
    let format = named.map(|(format, _)| format).or_else(|| {
        let found = STARTS.iter().find(|(_, first)| bytes.starts_with(first));
        found.map(|(format, _)| format)
    })?;
    Some(format!("{format}: not a format termtrace reads; it reads RON, OBJ, STL, PLY, glTF and GLB"))
}
