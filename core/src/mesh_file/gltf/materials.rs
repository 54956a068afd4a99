//! The materials of a glTF file: base colours, opacities, emitted light, and their textures.

use super::buffers::{Buffers, shown_image_name};
use super::json::Json;
use crate::color::LinearRgb;
use crate::mesh_file::fault::MeshFault;
use crate::mesh_file::material::MAX_EMISSION;
use crate::mesh_file::texture::{self, Sampler, TexelBudget, Texture, TexturePlacement, Wrap};
use crate::mesh_file::{CLAY, Emission, MeshMaterial, Opacity};
use glam::Vec3;
use std::collections::HashMap;
use std::sync::Arc;

/// A material, and the number of the texture coordinate set (`TEXCOORD_n`) that it uses.
pub(super) struct Material {
    pub(super) colors: MeshMaterial,
    pub(super) texture_coordinates: usize,
    /// The names of the material's features that are not shown, in the singular.
    pub(super) not_shown: Vec<&'static str>,
}

/// Returns the names of the features of a material that are not shown.
fn not_shown(json: Json<'_>) -> Result<Vec<&'static str>, MeshFault> {
    let mut names = Vec::new();
    if json.field("normalTexture")?.is_some() {
        names.push("normal map");
    }
    Ok(names)
}

/// Returns all materials of the document.
pub(super) fn read(buffers: &mut Buffers<'_, '_>) -> Result<Vec<Material>, MeshFault> {
    let mut reader = MaterialReader { buffers, textures: HashMap::new(), budget: TexelBudget::default() };
    reader.buffers.root().list("materials")?.map(|material| reader.material(material)).collect()
}

struct MaterialReader<'r, 'a, 'b> {
    buffers: &'r mut Buffers<'a, 'b>,
    /// The textures decoded so far, by the index of their image.
    textures: HashMap<usize, Arc<Texture>>,
    budget: TexelBudget,
}

impl<'a> MaterialReader<'_, 'a, '_> {
    fn material(&mut self, json: Json<'a>) -> Result<Material, MeshFault> {
        // Older files use the specular-glossiness extension instead of a base colour.
        let (base, factor, texture) = match json.extension("KHR_materials_pbrSpecularGlossiness")? {
            Some(older) => (Some(older), "diffuseFactor", "diffuseTexture"),
            None => (json.field("pbrMetallicRoughness")?, "baseColorFactor", "baseColorTexture"),
        };
        let white = LinearRgb::grey(1.0);
        let mut material =
            Material { colors: MeshMaterial::opaque(white, None), texture_coordinates: 0, not_shown: not_shown(json)? };
        let mut opacity = 1.0;
        if let Some(base) = base {
            if let Some([r, g, b, a]) = base.numbers::<4>(factor)? {
                let [r, g, b, a] = [r, g, b, a].map(|channel| channel.clamp(0.0, 1.0) as f32);
                material.colors.reflectance = LinearRgb::new(r, g, b);
                opacity = a;
            }
            if let Some(info) = base.field(texture)? {
                if let Some((placement, set)) = self.placement_or_warning(info)? {
                    material.colors.texture = Some(placement);
                    material.texture_coordinates = set;
                } else if material.colors.reflectance == white {
                    // A white factor was meant for the missing texture, and is not the colour of the surface.
                    material.colors.reflectance = CLAY;
                }
            }
        }
        let opacity = Opacity { factor: opacity, texture: material.colors.texture.clone() };
        match json.field("alphaMode")?.map(Json::string).transpose()? {
            Some("MASK") => {
                let cutoff = json.field("alphaCutoff")?.map_or(Ok(0.5), Json::number)? as f32;
                material.colors.holes =
                    (cutoff.is_finite() && opacity.may_be_below(cutoff)).then_some((opacity, cutoff));
            }
            Some("BLEND") => material.colors.blended = opacity.may_be_below(1.0).then_some(opacity),
            _ => {}
        }
        self.read_emission(json, &mut material)?;
        Ok(material)
    }

    /// Reads the light that a material sends out.
    fn read_emission(&mut self, json: Json<'a>, material: &mut Material) -> Result<(), MeshFault> {
        let Some(factor) = json.numbers::<3>("emissiveFactor")?.filter(|&factor| factor != [0.0; 3]) else {
            return Ok(());
        };
        let strength = match json.extension("KHR_materials_emissive_strength")? {
            Some(extension) => extension.field("emissiveStrength")?.map_or(Ok(1.0), Json::number)?,
            None => 1.0,
        };
        let [r, g, b] = factor.map(|channel| (channel * strength).clamp(0.0, MAX_EMISSION.into()) as f32);
        let mut texture = None;
        if let Some(info) = json.field("emissiveTexture")? {
            let placement = self.placement_or_warning(info)?;
            // Vertices keep the texture coordinates of one set only, those of the base colour.
            let has_set = |set: usize| material.colors.texture.is_none() || material.texture_coordinates == set;
            let Some((placement, set)) = placement.filter(|&(_, set)| has_set(set)) else {
                // Most of such textures are black, so that the factor alone would be too bright.
                material.not_shown.push("texture of light");
                return Ok(());
            };
            (texture, material.texture_coordinates) = (Some(placement), set);
        }
        material.colors.emission = Some(Emission { light: LinearRgb::new(r, g, b), texture });
        Ok(())
    }

    /// Returns [`placement`](Self::placement), or `None` after a warning of its fault.
    fn placement_or_warning(&mut self, info: Json<'a>) -> Result<Option<(TexturePlacement, usize)>, MeshFault> {
        self.placement(info).or_else(|fault| self.buffers.warn_of(fault).map(|()| None))
    }

    /// Returns the texture that `info`, a glTF textureInfo, names, with its placement, and the
    /// number of its texture coordinate set; `None` if the file of the texture is missing.
    fn placement(&mut self, info: Json<'a>) -> Result<Option<(TexturePlacement, usize)>, MeshFault> {
        let (_, texture) = info.required("index")?.item_of(self.buffers.root(), "textures")?;
        // Images in formats other than PNG and JPEG are named by glTF extensions. `decode` recognises the format by the
        // image, and refuses AVIF and Basis Universal with a message about it.
        let mut source = texture.field("source")?;
        for extension in ["EXT_texture_webp", "MSFT_texture_dds", "KHR_texture_basisu", "EXT_texture_avif"] {
            if source.is_none()
                && let Some(other) = texture.extension(extension)?
            {
                source = other.field("source")?;
            }
        }
        let Some(source) = source else { return Err(texture.fault("the texture has no source")) };
        let sampler = sampler_of(texture, self.buffers.root())?;
        let Some(texture) = self.texture(source)? else { return Ok(None) };
        let mut placement = TexturePlacement { sampler, ..TexturePlacement::plain(texture) };
        let mut set = info.index_or("texCoord", 0)?;
        if let Some(transform) = info.extension("KHR_texture_transform")? {
            placement.transform = transform_of(transform)?;
            set = transform.index_or("texCoord", set)?;
        }
        Ok(Some((placement, set)))
    }

    /// Returns an image as a texture; `None` if the image's file is missing.
    fn texture(&mut self, source: Json<'a>) -> Result<Option<Arc<Texture>>, MeshFault> {
        let (index, image) = source.item_of(self.buffers.root(), "images")?;
        if let Some(texture) = self.textures.get(&index) {
            return Ok(Some(Arc::clone(texture)));
        }
        let uri = image.field("uri")?;
        let decoded = match uri {
            Some(uri) => match self.buffers.picture(uri)? {
                Some(bytes) => texture::decode(&bytes, &mut self.budget),
                None => return Ok(None),
            },
            None => texture::decode(self.buffers.view(image.required("bufferView")?)?.bytes(), &mut self.budget),
        };
        let name = shown_image_name(uri.map(Json::string).transpose()?);
        let texture = Arc::new(decoded.map_err(|what| image.fault(format!("{name} {what}")))?);
        self.textures.insert(index, Arc::clone(&texture));
        Ok(Some(texture))
    }
}

/// Returns the sampler of a texture. Its filter for textures that look smaller is not used.
fn sampler_of<'a>(texture: Json<'a>, root: Json<'a>) -> Result<Sampler, MeshFault> {
    let Some(index) = texture.field("sampler")? else { return Ok(Sampler::default()) };
    let (_, json) = index.item_of(root, "samplers")?;
    let wrap = |name: &'static str| {
        // The constants of OpenGL.
        Ok(match json.index_or(name, 10497)? {
            10497 => Wrap::Repeat,
            33071 => Wrap::Clamp,
            33648 => Wrap::Mirror,
            other => return Err(json.fault(format!("{name} {other} is none of 10497, 33071 and 33648"))),
        })
    };
    Ok(Sampler { wrap: [wrap("wrapS")?, wrap("wrapT")?], is_nearest: json.index_or("magFilter", 9729)? == 9728 })
}

/// Reads `KHR_texture_transform`. Returns the rows of a 2 x 3 matrix that scales, then rotates,
/// then translates.
fn transform_of(json: Json<'_>) -> Result<[Vec3; 2], MeshFault> {
    let [offset_u, offset_v] = json.numbers("offset")?.unwrap_or([0.0; 2]);
    let [scale_u, scale_v] = json.numbers("scale")?.unwrap_or([1.0; 2]);
    let angle = json.field("rotation")?.map_or(Ok(0.0), Json::number)?;
    let (sin, cos) = libm::sincos(angle);
    let row = |u: f64, v: f64, offset: f64| Vec3::new(u as f32, v as f32, offset as f32);
    let rows = [row(cos * scale_u, sin * scale_v, offset_u), row(-sin * scale_u, cos * scale_v, offset_v)];
    if rows.iter().all(|row| row.is_finite()) { Ok(rows) } else { Err(json.fault("these numbers are too large")) }
}
