//! Size, samples and scale of frames: the flags of `frame`, `record` and `explain`.

use super::outcome::{CommandResult, Failure};
use clap::Args;
use std::num::NonZeroU32;
use termtrace::export::Format;
use termtrace::internals::capabilities::{CELL_ASPECT_RANGE, USUAL_CELL_ASPECT};
use termtrace::{CellMode, Resolution, Sampling};

/// The use of a frame, which decides its size and samples where no flag does.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum FrameKind {
    /// A frame as cells, or a golden frame of any format.
    // The sizes of golden frames are promised: users' tests rely on them.
    Cells,
    /// A picture file that is not a golden frame.
    Picture,
    /// An animated GIF.
    Gif,
}

impl FrameKind {
    /// Returns the kind of a frame in a file of this format.
    pub(super) fn for_format(format: Format) -> Self {
        if format.has_pixels() { Self::Picture } else { Self::Cells }
    }

    /// Returns the default resolution; `None` if the default size is 80x24 cells.
    fn default_resolution(self) -> Option<Resolution> {
        match self {
            Self::Cells => None,
            Self::Picture => Some(Resolution::square(1280, 800)),
            // With this size the orbit of three_spheres takes 4 MB.
            Self::Gif => Some(Resolution::square(480, 300)),
        }
    }

    fn default_samples(self, mode: CellMode) -> Sampling {
        match self {
            Self::Cells => mode.default_sampling(),
            Self::Picture | Self::Gif => Sampling::BEST,
        }
    }
}

/// The flags for the size of a frame.
#[derive(Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct SizeArgs {
    /// The frame's size in cells [default: 80x24]
    #[arg(long, value_name = "COLSxROWS", value_parser = parse_size, conflicts_with = "pixels")]
    size: Option<(u32, u32)>,
    /// Size in pixels [default: PNG 1280x800, GIF 480x300]
    ///
    /// In a frame of cells, each cell has two pixels, one above the other; with --glyphs shape two by four,
    /// with sextants four by six, with blocks, octants and braille four by eight.
    #[arg(long, value_name = "WxH", value_parser = parse_size)]
    pixels: Option<(u32, u32)>,
    /// A cell's height over its width
    #[arg(long, value_name = "A", default_value_t = USUAL_CELL_ASPECT, value_parser = parse_cell_aspect)]
    #[arg(hide_short_help = true)]
    cell_aspect: f32,
}

#[derive(Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct PictureArgs {
    #[command(flatten)]
    size: SizeArgs,
    /// Rays per pixel; best: 1 to 64 [default: 1; PNG, GIF: best]
    ///
    /// The first ray goes through the centre of the pixel. best traces one ray, and up to 64 at edges. The default for
    /// blocks, octants, sextants and braille is one ray for each block of 2 by 2 pixels, and one per pixel in the
    /// blocks with the highest contrast, at most 9 of 32.
    #[arg(long, value_name = "N|best", value_parser = parse_samples)]
    samples: Option<Sampling>,
    /// Picture files: draw each pixel as N by N pixels of the file [default: 1]
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=256), hide_short_help = true)]
    scale: Option<u32>,
}

impl SizeArgs {
    pub(super) fn resolution(&self, mode: CellMode) -> Result<Resolution, Failure> {
        self.resolution_with_default((80, 24), self.cell_aspect, mode)
    }

    /// Returns the resolution that the flags give, or else that of `default_size`, in columns and
    /// rows.
    fn resolution_with_default(
        &self,
        default_size: (u32, u32),
        cell_aspect: f32,
        mode: CellMode,
    ) -> Result<Resolution, Failure> {
        let (across, down) = mode.pixels_per_cell();
        let (columns, rows) = self.size.unwrap_or(default_size);
        let (width, height) = self.pixels.unwrap_or((columns.saturating_mul(across), rows.saturating_mul(down)));
        // The numbers of columns and rows of a `Grid` are u16.
        let limit = u32::from(u16::MAX);
        if width > across * limit || height > down * limit {
            return Err(too_large(width.into(), height.into()));
        }
        let pixel_aspect = cell_aspect * across as f32 / down as f32;
        let resolution = Resolution::new(width, height).and_then(|square| square.with_pixel_aspect(pixel_aspect));
        resolution.map_err(|_| too_large(width.into(), height.into()))
    }
}

impl PictureArgs {
    /// Returns the size of a frame of this kind.
    ///
    /// The default is that of `screen`, if given: its columns and rows, and the height of a cell over its width.
    pub(super) fn resolution(
        &self,
        mode: CellMode,
        kind: FrameKind,
        screen: Option<((u32, u32), f32)>,
    ) -> Result<Resolution, Failure> {
        if let Some((cells, aspect)) = screen {
            let given = self.size.cell_aspect;
            let aspect = if given == USUAL_CELL_ASPECT { aspect } else { given };
            return self.size.resolution_with_default(cells, aspect, mode);
        }
        let is_default = self.size.size.is_none() && self.size.pixels.is_none() && self.scale.is_none();
        // The default resolution of a picture file has square pixels, whatever the shape of a cell.
        kind.default_resolution().filter(|_| is_default).map_or_else(|| self.size.resolution(mode), Ok)
    }

    /// Returns the value of `--cell-aspect`: a cell's height over its width.
    pub(super) fn cell_aspect(&self) -> f32 {
        self.size.cell_aspect
    }

    /// Returns the sampling of a frame of this kind; `mode` is that of its cells.
    pub(super) fn samples(&self, kind: FrameKind, mode: CellMode) -> Sampling {
        self.samples.unwrap_or_else(|| kind.default_samples(mode))
    }

    /// Returns the value of `--samples`, if given.
    pub(super) fn given_samples(&self) -> Option<Sampling> {
        self.samples
    }

    /// Returns the value of `--scale`: pixels of the file along the shorter side of a traced pixel.
    pub(super) fn scale(&self) -> u32 {
        self.scale.unwrap_or(1)
    }

    /// Refuses a picture whose file would have too many pixels at the scale of `--scale`.
    pub(super) fn check_scaled_pixel_count(&self, resolution: Resolution) -> CommandResult {
        let [width, height] = resolution.size_in_square_pixels(self.scale());
        check_pixel_count(width, height)
    }

    /// Returns whether `--scale` is given.
    pub(super) fn has_scale(&self) -> bool {
        self.scale.is_some()
    }
}

/// Refuses a picture with more than [`Resolution::MAX_PIXELS`], which memory may not hold.
pub(super) fn check_pixel_count(width: u64, height: u64) -> CommandResult {
    let most = u64::from(Resolution::MAX_PIXELS);
    // Saturating, because a product of two 32-bit sides, each times a scale, may exceed 64 bits.
    if width.saturating_mul(height) > most { Err(too_large(width, height)) } else { Ok(()) }
}

fn too_large(width: u64, height: u64) -> Failure {
    let most = Resolution::MAX_PIXELS;
    Failure::Usage(format!(
        "a frame of {width}x{height} pixels is too large; at most 65535 cells in a row or column, and {most} pixels"
    ))
}

/// Parses a width and a height, both at least 1, such as `80x24`.
pub(super) fn parse_size(text: &str) -> Result<(u32, u32), String> {
    let sides = text.split_once(['x', 'X']).and_then(|(across, down)| Some((across.parse().ok()?, down.parse().ok()?)));
    sides
        .filter(|&(across, down)| across > 0 && down > 0)
        .ok_or_else(|| "expected two whole numbers of at least 1 with an x between them, such as 80x24".to_owned())
}

/// Parses a number of samples per pixel, or `best`.
pub(super) fn parse_samples(text: &str) -> Result<Sampling, String> {
    if text == "best" {
        return Ok(Sampling::BEST);
    }
    let number = text.parse::<NonZeroU32>().ok().filter(|samples| *samples <= Sampling::MAX_SAMPLES);
    number.map(Sampling::Each).ok_or_else(|| "expected a whole number from 1 to 65536, or best".to_owned())
}

/// Parses a cell's height over its width, within limits beyond which text would be unreadable.
pub(super) fn parse_cell_aspect(text: &str) -> Result<f32, String> {
    let aspect = text.parse().ok().filter(|aspect| CELL_ASPECT_RANGE.contains(aspect));
    aspect.ok_or_else(|| "expected a number from 0.1 to 10, such as 2".to_owned())
}
