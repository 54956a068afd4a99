//! Decoding of BMP, GIF, WebP, DDS and TGA pictures.

use super::samples::{TexelBudget, check_plausible, checked_texture, cut_short, texels_of};
use crate::mesh_file::limits::MAX_TEXELS;
use crate::mesh_file::texture::Texture;
use image::codecs::{bmp::BmpDecoder, dds::DdsDecoder, gif::GifDecoder, tga::TgaDecoder, webp::WebPDecoder};
use image::{ColorType, ImageDecoder, ImageError, ImageResult, Limits};
use std::io::{Cursor, ErrorKind};

/// The formats that the crate `image` decodes.
#[derive(Clone, Copy)]
pub(super) enum OtherFormat {
    Bmp,
    Gif,
    WebP,
    Dds,
    Tga,
}

impl OtherFormat {
    /// Returns the format of a picture by its first bytes.
    pub(super) fn recognised(bytes: &[u8]) -> Option<Self> {
        match bytes {
            [b'B', b'M', ..] => Some(Self::Bmp),
            [b'G', b'I', b'F', b'8', ..] => Some(Self::Gif),
            [b'R', b'I', b'F', b'F', _, _, _, _, b'W', b'E', b'B', b'P', ..] => Some(Self::WebP),
            [b'D', b'D', b'S', b' ', ..] => Some(Self::Dds),
            // TGA has no signature: these bytes are the kind of its palette (none or one), the kind of the picture, and
            // the number of bits per pixel.
            [_, 0 | 1, 1..=3 | 9..=11, _, _, _, _, _, _, _, _, _, _, _, _, _, 8 | 15 | 16 | 24 | 32, ..] => {
                Some(Self::Tga)
            }
            _ => None,
        }
    }

    fn name(self) -> &'static str {
        match self {
            Self::Bmp => "BMP",
            Self::Gif => "GIF",
            Self::WebP => "WebP",
            Self::Dds => "DDS",
            Self::Tga => "TGA",
        }
    }

    /// Returns which kinds of pictures are read, for a message, if they are few.
    fn kinds(self) -> &'static str {
        if matches!(self, Self::Dds) { ": only DXT1, DXT3 and DXT5 are" } else { "" }
    }

    /// Returns the greatest number of texels that a byte decodes to.
    ///
    /// In BMP and TGA a run of equal texels takes at least two bytes, and has at most 255 and 128 of them. A code of
    /// LZW stands for at most 4096 texels. DDS has at least half a byte per texel. WebP has no limit: a picture of one
    /// colour takes 30 bytes, whatever its size.
    fn most_texels_per_byte(self) -> usize {
        match self {
            Self::Bmp | Self::Tga => 128,
            Self::Gif => 4096,
            Self::WebP => 1 << 16,
            Self::Dds => 2,
        }
    }

    /// Decodes a picture; of an animation, the first frame.
    pub(super) fn decode(self, bytes: &[u8], budget: &mut TexelBudget) -> Result<Texture, String> {
        let reader = || Cursor::new(bytes);
        match self {
            Self::Bmp => self.decode_with(BmpDecoder::new(reader()), bytes, budget),
            Self::Gif => self.decode_with(GifDecoder::new(reader()), bytes, budget),
            Self::WebP => self.decode_with(WebPDecoder::new(reader()), bytes, budget),
            Self::Dds => self.decode_with(DdsDecoder::new(reader()), bytes, budget),
            Self::Tga => self.decode_with(TgaDecoder::new(reader()), bytes, budget),
        }
    }

    fn decode_with<D: ImageDecoder>(
        self,
        decoder: ImageResult<D>,
        bytes: &[u8],
        budget: &mut TexelBudget,
    ) -> Result<Texture, String> {
        let name = self.name();
        let say = |error: ImageError| match error {
            ImageError::IoError(error) if error.kind() == ErrorKind::UnexpectedEof => cut_short(name),
            ImageError::Unsupported(_) => format!("is a {name} picture of a kind that is not read{}", self.kinds()),
            error => format!("is a {name} picture that cannot be read: {error}"),
        };
        let mut decoder = decoder.map_err(say)?;
        let (width, height) = decoder.dimensions();
        budget.spend(width as usize, height as usize)?;
        let texels = width as usize * height as usize;
        check_plausible(texels, bytes, self.most_texels_per_byte(), name)?;
        let mut limits = Limits::no_limits();
        // What the decoder may reserve besides the samples: at most one more picture, such as a frame of an animation.
        limits.max_alloc = Some(8 * MAX_TEXELS as u64);
        decoder.set_limits(limits).map_err(say)?;
        let channels = match decoder.color_type() {
            ColorType::L8 => 1,
            ColorType::La8 => 2,
            ColorType::Rgb8 => 3,
            ColorType::Rgba8 => 4,
            _ => return Err(format!("is a {name} picture with samples that are not read: not of 8 bits")),
        };
        let mut samples = vec![0; texels * channels];
        decoder.read_image(&mut samples).map_err(say)?;
        checked_texture(width, height, texels_of(&samples, channels), name)
    }
}
