//! MTL, the materials of OBJ files: diffuse colours, opacities, emitted light, and their textures.
//!
//! Read are `newmtl`, `Kd` and `map_Kd`, `d`, `Tr` and `map_d`, `Ke` and `map_Ke`.
//! Normal maps are counted as not shown. All other lines are skipped.

use super::fault::{MeshFault, shown_path};
use super::material::MAX_EMISSION;
use super::side_files::{SideFiles, side_file_path};
use super::text::TextCursor;
use super::texture::{self, Sampler, TexelBudget, Texture, TexturePlacement, Wrap};
use super::{CLAY, Emission, MeshMaterial, Opacity};
use crate::color::LinearRgb;
use glam::Vec3;
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The materials of all MTL files that an OBJ file names.
#[derive(Default)]
pub(super) struct Library {
    materials: Vec<MeshMaterial>,
    by_name: HashMap<Box<[u8]>, u32>,
    not_shown: Vec<(u32, &'static str)>,
    files: HashSet<PathBuf>,
    /// Whether an MTL file is missing, so that a material's name may be unknown.
    is_incomplete: bool,
    textures: HashMap<PathBuf, Arc<Texture>>,
    /// The masks, by the addresses of the textures that they are made of, which `textures` keeps.
    masks: HashMap<usize, Arc<Texture>>,
    budget: TexelBudget,
}

impl Library {
    /// Returns the materials, and pairs of a material's index and the part of it that is not shown.
    pub(super) fn into_materials_and_unshown(self) -> (Vec<MeshMaterial>, Vec<(u32, &'static str)>) {
        (self.materials, self.not_shown)
    }

    pub(super) fn index_of(&self, name: &[u8]) -> Option<u32> {
        self.by_name.get(name).copied()
    }

    /// Records that the MTL file at `path` is missing.
    pub(super) fn record_missing(&mut self, path: PathBuf) {
        self.files.insert(path);
        self.is_incomplete = true;
    }

    /// Returns whether an MTL file is missing.
    pub(super) fn is_incomplete(&self) -> bool {
        self.is_incomplete
    }

    /// Returns whether the MTL file at `path` was already read, or is missing.
    pub(super) fn has_file(&self, path: &Path) -> bool {
        self.files.contains(path)
    }
}

/// Reads an MTL file into the library. `path` is relative to the mesh.
pub(super) fn read(
    path: &Path,
    bytes: &[u8],
    side_files: &mut SideFiles<'_>,
    library: &mut Library,
) -> Result<(), MeshFault> {
    library.files.insert(path.to_owned());
    let folder = path.parent().unwrap_or(Path::new(""));
    let name = side_files.name_of(path);
    let text = TextCursor::new(bytes);
    let mut reader = MtlReader { text, folder, side_files, library, has_reflectance: false, has_dissolve: false };
    while reader.text.go_to_statement() {
        let start = reader.text.at();
        if let Err(fault) = reader.statement() {
            // The error names the MTL file, not the OBJ file that refers to it.
            reader.side_files.warn_of(fault.into_error(&name, bytes))?;
            reader.text = reader.text.cursor_at(start);
        }
        reader.text.skip_line();
    }
    Ok(())
}

/// Returns the opacity of a material; `None` if it is opaque.
fn blended(opacity: f32) -> Option<Opacity> {
    (opacity < 1.0).then(|| Opacity { factor: opacity.max(0.0), texture: None })
}

struct MtlReader<'a, 'b> {
    text: TextCursor<'a>,
    folder: &'a Path,
    side_files: &'a mut SideFiles<'b>,
    library: &'a mut Library,
    /// Whether the last material has a `Kd`.
    has_reflectance: bool,
    /// Whether the last material has a `d`, which counts more than a `Tr`.
    has_dissolve: bool,
}

/// The opacity in a texture of opacity below which there is a hole.
const CUTOFF: f32 = 0.5;

/// The reflectance of a material with neither `Kd` nor a texture: light grey. With a texture but no
/// `Kd` the reflectance is 1, which keeps the texture's colours.
const DEFAULT_REFLECTANCE: LinearRgb = LinearRgb::grey(0.8);

impl MtlReader<'_, '_> {
    fn statement(&mut self) -> Result<(), MeshFault> {
        let word = self.text.word();
        let at = self.text.at() - word.len();
        match word {
            b"newmtl" => {
                (self.has_reflectance, self.has_dissolve) = (false, false);
                self.new_material();
            }
            b"Kd" => {
                let reflectance = self.color()?;
                self.last_material(at)?.reflectance = reflectance;
                self.has_reflectance = true;
            }
            b"map_Kd" => {
                let has_reflectance = self.has_reflectance;
                self.last_material(at)?;
                let texture = self.texture();
                let material = self.last_material(at)?;
                if !has_reflectance {
                    let is_shown = matches!(texture, Ok(Some(_)));
                    material.reflectance = if is_shown { LinearRgb::grey(1.0) } else { CLAY };
                }
                material.texture = texture?;
            }
            b"d" => {
                if let Ok(opacity) = self.text.number() {
                    self.last_material(at)?.blended = blended(opacity);
                    self.has_dissolve = true;
                }
            }
            b"Tr" if !self.has_dissolve => {
                // Some programs write 1 for opaque. A surface that is not there would be no use to write.
                if let Some(transparency) = self.text.number().ok().filter(|&transparency| transparency < 1.0) {
                    self.last_material(at)?.blended = blended(1.0 - transparency);
                }
            }
            b"map_d" => {
                self.last_material(at)?;
                if let Some(placement) = self.texture()? {
                    let texture = self.mask(at, &placement.texture)?;
                    let texture = Some(TexturePlacement { texture, ..placement });
                    let opacity = Opacity { factor: 1.0, texture };
                    self.last_material(at)?.holes = opacity.may_be_below(CUTOFF).then_some((opacity, CUTOFF));
                }
            }
            b"Ke" => {
                let light = self.channels(MAX_EMISSION)?;
                self.set_emission(at, |emission| emission.light = light)?;
            }
            b"map_Ke" => {
                self.last_material(at)?;
                if let Some(texture) = self.texture()? {
                    self.set_emission(at, |emission| emission.texture = Some(texture))?;
                }
            }
            b"map_Bump" | b"map_bump" | b"bump" | b"norm" => self.not_shown("normal map"),
            _ => {}
        }
        Ok(())
    }

    /// Returns the mask that a texture gives, made once for all materials.
    fn mask(&mut self, at: usize, texture: &Arc<Texture>) -> Result<Arc<Texture>, MeshFault> {
        let Library { masks, budget, .. } = &mut *self.library;
        let address = Arc::as_ptr(texture).addr();
        if let Some(mask) = masks.get(&address) {
            return Ok(Arc::clone(mask));
        }
        let mask = texture.as_mask(budget).map_err(|what| MeshFault::in_text(at, format!("the mask {what}")))?;
        masks.insert(address, Arc::clone(&mask));
        Ok(mask)
    }

    /// Records a feature of the last material that is not shown.
    fn not_shown(&mut self, what: &'static str) {
        if let Some(last) = self.library.materials.len().checked_sub(1) {
            self.library.not_shown.push((last as u32, what)); // fewer than the file's bytes
        }
    }

    /// Reads `newmtl` and starts a material.
    ///
    /// If two materials have the same name, the later one counts.
    fn new_material(&mut self) {
        let name = self.text.rest_of_line();
        let index = self.library.materials.len() as u32; // fewer than the file's bytes
        self.library.by_name.insert(name.into(), index);
        self.library.materials.push(MeshMaterial::opaque(DEFAULT_REFLECTANCE, None));
    }

    /// Changes the light of the last material.
    ///
    /// A texture of light without a `Ke`, or with a black one, is shown as it is.
    fn set_emission(&mut self, at: usize, change: impl FnOnce(&mut Emission)) -> Result<(), MeshFault> {
        let material = self.last_material(at)?;
        let none = Emission { light: LinearRgb::BLACK, texture: None };
        let mut emission = material.emission.take().unwrap_or(none);
        change(&mut emission);
        if emission.texture.is_some() && emission.light == LinearRgb::BLACK {
            emission.light = LinearRgb::grey(1.0);
        }
        material.emission = (emission.light != LinearRgb::BLACK).then_some(emission);
        Ok(())
    }

    fn last_material(&mut self, at: usize) -> Result<&mut MeshMaterial, MeshFault> {
        let last = self.library.materials.last_mut();
        last.ok_or_else(|| MeshFault::in_text(at, "this line needs a material: newmtl must come before it"))
    }

    /// Reads `Kd r g b`, or `Kd r` for a grey. Values are clamped to 0..=1, not refused, as other
    /// programs do.
    fn color(&mut self) -> Result<LinearRgb, MeshFault> {
        self.channels(1.0)
    }

    /// Reads one or three channels, and clamps them to 0..=`most`.
    fn channels(&mut self, most: f32) -> Result<LinearRgb, MeshFault> {
        let r = self.text.number()?.clamp(0.0, most);
        if self.text.is_at_line_end() {
            return Ok(LinearRgb::grey(r));
        }
        Ok(LinearRgb::new(r, self.text.number()?.clamp(0.0, most), self.text.number()?.clamp(0.0, most)))
    }

    /// Reads the options and the name of a texture, then its file. `None` if the file is missing.
    fn texture(&mut self) -> Result<Option<TexturePlacement>, MeshFault> {
        let (transform, sampler) = self.options()?;
        let name = self.text.rest_of_line();
        let at = self.text.at() - name.len();
        let name = String::from_utf8_lossy(name);
        let path = side_file_path(self.folder, &name).map_err(|message| MeshFault::in_text(at, message))?;
        // Decoded textures are kept, because materials often share one, and decoding one takes longer than everything
        // else in the file.
        let texture = match self.library.textures.get(&path) {
            Some(texture) => Some(Arc::clone(texture)),
            None => self.load(path, at)?,
        };
        Ok(texture.map(|texture| TexturePlacement { texture, transform, sampler }))
    }

    fn load(&mut self, path: PathBuf, at: usize) -> Result<Option<Arc<Texture>>, MeshFault> {
        let bytes = self.side_files.read_colors(&path, "texture").map_err(|message| {
            MeshFault::in_text(at, format!("the texture is missing: {message}; add the file, or remove this line"))
        })?;
        let Some(bytes) = bytes else { return Ok(None) };
        let name = shown_path(&self.side_files.name_of(&path));
        let texture = texture::decode(&bytes, &mut self.library.budget)
            .map_err(|what| MeshFault::in_text(at, format!("{name} {what}")))?;
        let texture = Arc::new(texture);
        self.library.textures.insert(path, Arc::clone(&texture));
        Ok(Some(texture))
    }

    /// Reads the options between `map_Kd` and the file name: `-s` (scale), `-o` (offset) and
    /// `-clamp` take effect, others are skipped.
    fn options(&mut self) -> Result<([Vec3; 2], Sampler), MeshFault> {
        let (mut scale, mut offset) = ([1.0; 2], [0.0; 2]);
        let mut sampler = Sampler::default();
        loop {
            let start = self.text.at();
            match self.text.word() {
                b"-s" => self.first_two_numbers(&mut scale)?,
                b"-o" => self.first_two_numbers(&mut offset)?,
                b"-t" => self.first_two_numbers(&mut [0.0; 2])?,
                b"-mm" => self.skip_words(2),
                b"-clamp" => sampler.wrap = [if self.text.word() == b"on" { Wrap::Clamp } else { Wrap::Repeat }; 2],
                b"-blendu" | b"-blendv" | b"-cc" | b"-bm" | b"-boost" | b"-texres" | b"-imfchan" | b"-type" => {
                    self.skip_words(1);
                }
                _ => {
                    self.text = self.text.cursor_at(start);
                    break;
                }
            }
        }
        // In MTL files v is measured from the bottom of the image, in a `MeshFile` from its top.
        let v = Vec3::new(0.0, scale[1], 1.0 - scale[1] - offset[1]);
        let u = Vec3::new(scale[0], 0.0, offset[0]);
        if u.is_finite() && v.is_finite() {
            return Ok(([u, v], sampler));
        }
        Err(MeshFault::in_text(self.text.at(), "the texture's scale or offset is too large"))
    }

    fn skip_words(&mut self, count: usize) {
        for _ in 0..count {
            self.text.word();
        }
    }

    /// Reads the one to three numbers of a texture's option, such as `-s` (scale) or `-o` (offset).
    ///
    /// The first two are stored in `values`; the third is for 3D textures and is ignored.
    fn first_two_numbers(&mut self, values: &mut [f32; 2]) -> Result<(), MeshFault> {
        values[0] = self.text.number()?;
        for i in 1..3 {
            let start = self.text.at();
            match (self.text.number(), i) {
                (Ok(value), 1) => values[1] = value,
                (Ok(_), _) => {}
                (Err(_), _) => {
                    self.text = self.text.cursor_at(start);
                    break;
                }
            }
        }
        Ok(())
    }
}
