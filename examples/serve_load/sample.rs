//! A visitor whose screen is compared with the pictures that it should show.

use crate::FRAME_END;
use glam::Vec3;
use std::num::NonZeroU16;
use std::path::Path;
use termtrace::internals::cell;
use termtrace::{CellMode, Grid, Ink, Map, Painter, Pose, Sampling, Scene, Size, Srgb8};
use vt100::Color;

/// One of this many frames is compared, because a picture with all samples takes some milliseconds.
const STEP: usize = 10;

/// A screen that is compared with the picture from the eye that its status line tells.
///
/// The eye has two decimals, which alone leaves a difference.
pub(crate) struct Sample {
    scene: Scene,
    size: Size,
    painter: Painter,
    screen: vt100::Parser,
    /// The number of frames so far.
    frames: usize,
    /// The PSNR of each compared frame, in decibels.
    pub(crate) psnr: Vec<f64>,
}

impl Sample {
    /// Returns an empty screen for a view of the scene at `path`.
    ///
    /// `None`: the scene cannot be loaded, or the screen has no cell.
    pub(crate) fn new(path: &Path, (columns, rows): (u32, u32)) -> Option<Self> {
        let size = Size::new(columns.try_into().ok()?, rows.try_into().ok()?);
        let screen = vt100::Parser::new(NonZeroU16::new(size.rows)?, NonZeroU16::new(size.columns)?, 0);
        let (scene, painter) = (Scene::load(path).ok()?, Painter::new(CellMode::HALF_BLOCK));
        Some(Self { scene, size, painter, screen, frames: 0, psnr: Vec::new() })
    }

    /// Shows bytes of the server, and compares the screen after each tenth frame.
    pub(crate) fn take(&mut self, mut data: &[u8]) {
        while let Some(at) = data.windows(FRAME_END.len()).position(|window| window == FRAME_END) {
            let (frame, others) = data.split_at(at + FRAME_END.len());
            self.screen.process(frame);
            self.frames += 1;
            if self.frames.is_multiple_of(STEP) {
                let psnr = self.compare();
                self.psnr.extend(psnr);
            }
            data = others;
        }
        self.screen.process(data);
    }

    /// Returns the PSNR of the picture, or `None` if the status line tells no eye.
    fn compare(&mut self) -> Option<f64> {
        let wanted = self.wanted()?;
        let columns = self.size.columns;
        let (mut sum, mut count) = (0.0, 0_u32);
        for row in 0..self.size.rows {
            let halves: Option<Vec<_>> = (0..columns).map(|column| self.halves(row, column)).collect();
            // Rows with text are left out.
            for (column, shown) in halves.into_iter().flatten().enumerate() {
                let cell = wanted.at(usize::from(row) * usize::from(columns) + column);
                let wanted = [cell.bg, cell.fg].map(srgb_of_ink);
                let wanted = if cell.glyph == ' ' { [wanted[0]; 2] } else { wanted };
                for (a, b) in shown.into_iter().flatten().zip(wanted.into_iter().flatten()) {
                    let difference = f64::from(a) - f64::from(b);
                    sum += difference * difference;
                    count += 1;
                }
            }
        }
        (count > 0).then(|| 10.0 * libm::log10(255.0 * 255.0 / (sum / f64::from(count)).max(1e-9)))
    }

    /// Returns the picture from the eye that the status line tells.
    fn wanted(&mut self) -> Option<Grid> {
        let text = self.screen.screen().contents();
        let numbers = text.lines().find_map(|line| Some(line.split_once("eye ")?.1.to_owned()))?;
        let eye: Vec<f32> = numbers.split_whitespace().map_while(|number| number.parse().ok()).collect();
        let eye = Vec3::from(<[f32; 3]>::try_from(eye.get(..3)?).ok()?);
        // It turns about its target.
        let pose = Pose { eye, ..self.scene.camera().pose() };
        let camera = self.scene.camera().with_pose(pose).ok()?;
        let resolution = cell::resolution(CellMode::HALF_BLOCK, self.size, 2.0).ok()?;
        Some(self.painter.trace(Map::Shaded, &self.scene, &camera, resolution, Sampling::BEST))
    }

    /// Returns the colours of the upper and the lower half of a cell; `None` for text.
    fn halves(&self, row: u16, column: u16) -> Option<[[u8; 3]; 2]> {
        let cell = self.screen.screen().cell(row, column)?;
        let [fg, bg] = [cell.fgcolor(), cell.bgcolor()].map(srgb_of_color);
        match cell.contents() {
            "▄" => Some([bg?, fg?]),
            "▀" => Some([fg?, bg?]),
            " " | "" => Some([bg?, bg?]),
            _ => None,
        }
    }
}

fn srgb_of_ink(ink: Ink) -> [u8; 3] {
    let Ink::Rgb(Srgb8 { r, g, b }) = ink else { return [0; 3] };
    [r, g, b]
}

/// Returns a colour as xterm has it; `None` for the terminal's own ones.
fn srgb_of_color(color: Color) -> Option<[u8; 3]> {
    match color {
        Color::Rgb(r, g, b) => Some([r, g, b]),
        Color::Idx(index @ 16..=231) => {
            let level = |step: u8| if step == 0 { 0 } else { 55 + 40 * step };
            let index = index - 16;
            Some([index / 36, index / 6 % 6, index % 6].map(level))
        }
        Color::Idx(index @ 232..) => Some([8 + 10 * (index - 232); 3]),
        Color::Idx(_) | Color::Default => None,
    }
}
