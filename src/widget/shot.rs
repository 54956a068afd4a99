//! A shot (the inputs of a pane's picture), and the tracer that turns it into cells.

use crate::camera::Camera;
use crate::cell::{self, CellMode, Painter};
use crate::framebuffer::{Resolution, ResolutionError};
use crate::grid::Size;
use crate::maps::{Map, TracedMap};
use crate::progress::{Cancellation, Cancelled};
use crate::render::{Executor, ProgressiveRender, Sampling};
use crate::scene::Scene;
use crate::tone::tone;
use ratatui_core::buffer::Buffer;
use std::num::NonZeroU32;

/// The options of a [`SceneView`](super::SceneView), without its scene.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Options {
    pub(super) map: Map,
    pub(super) cells: CellMode,
    pub(super) cell_aspect: f32,
    pub(super) sampling: Sampling,
}

/// The inputs of a pane's picture: everything that determines it.
#[derive(Clone, Debug)]
pub(super) struct Shot {
    pub(super) scene: Scene,
    pub(super) camera: Camera,
    pub(super) size: Size,
    /// The size of the picture in pixels, derived from that in cells.
    pub(super) resolution: Resolution,
    pub(super) options: Options,
}

impl Shot {
    /// Returns the shot for a pane of this size in cells.
    ///
    /// # Errors
    /// If the pane has more pixels than a picture may have.
    pub(super) fn new(scene: &Scene, camera: &Camera, size: Size, options: Options) -> Result<Self, ResolutionError> {
        let resolution = cell::resolution(options.cells, size, options.cell_aspect)?;
        Ok(Self { scene: scene.clone(), camera: *camera, size, resolution, options })
    }

    /// Returns whether both shots give the same picture.
    // Scenes are compared by identity: comparing two meshes would take longer than the draw call.
    pub(super) fn has_same_picture_as(&self, other: &Self) -> bool {
        let of = |shot: &Self| (shot.camera, shot.size, shot.options);
        self.scene.is_copy_of(&other.scene) && of(self) == of(other)
    }

    /// Returns the samples per pixel of the final picture, if one with one sample per pixel is
    /// shown before it.
    fn refinement_samples(&self) -> Option<NonZeroU32> {
        match self.options.sampling {
            // Only adaptive sampling has this first picture, because it begins with one sample per pixel.
            Sampling::UpTo(samples) if samples > NonZeroU32::MIN && self.options.map.refines() => Some(samples),
            _ => None,
        }
    }
}

/// A shot and the cells of its picture.
#[derive(Debug)]
pub(super) struct RenderedShot {
    pub(super) shot: Shot,
    /// The cells, in a buffer whose area begins at (0, 0).
    pub(super) cells: Buffer,
    /// Whether the picture has all samples that the shot asks for.
    pub(super) is_final: bool,
}

/// A tracer of shots, which keeps the painter with its cache of mixed colours between pictures.
#[derive(Default)]
pub(super) struct PaneTracer {
    painter: Option<Painter>,
}

impl PaneTracer {
    /// Traces a shot and turns the picture into cells.
    pub(super) fn trace(&mut self, shot: Shot) -> RenderedShot {
        // Tracing fails only if its token is cancelled, and nothing else has this new token.
        let seen = traced(&shot, shot.options.sampling, &Cancellation::default()).expect("not cancelled");
        self.rendered(shot, &seen, true)
    }

    /// Traces a shot and passes to `deliver` one picture, or two of which the first has one sample
    /// per pixel.
    ///
    /// The last picture equals that of [`trace`](Self::trace).
    ///
    /// # Errors
    /// [`Cancelled`], if the token is cancelled, which `deliver` may do.
    pub(super) fn trace_progressively(
        &mut self,
        shot: Shot,
        token: &Cancellation,
        mut deliver: impl FnMut(RenderedShot),
    ) -> Result<(), Cancelled> {
        let Some(samples) = shot.refinement_samples() else {
            let seen = traced(&shot, shot.options.sampling, token)?;
            deliver(self.rendered(shot, &seen, true));
            return Ok(());
        };
        // `ProgressiveRender` keeps no geometry, so for cells that show it the final picture is traced from scratch.
        if shot.options.cells.needs_geometry() {
            for (sampling, is_final) in [(Sampling::Each(NonZeroU32::MIN), false), (shot.options.sampling, true)] {
                let seen = traced(&shot, sampling, token)?;
                deliver(self.rendered(shot.clone(), &seen, is_final));
            }
            return Ok(());
        }
        let Shot { scene, camera, .. } = &shot;
        let mut picture = ProgressiveRender::new(camera, shot.resolution);
        for (samples, is_final) in [(NonZeroU32::MIN, false), (samples, true)] {
            let cost = picture.refine_or_cancel(token, scene, samples)?;
            let seen = TracedMap::new(tone(&picture.framebuffer(), scene), cost);
            deliver(self.rendered(shot.clone(), &seen, is_final));
        }
        Ok(())
    }

    fn rendered(&mut self, shot: Shot, seen: &TracedMap, is_final: bool) -> RenderedShot {
        let mode = shot.options.cells;
        // A painter's cache is valid for its mode only.
        let painter = self.painter.take().filter(|painter| painter.mode() == mode);
        let grid = self.painter.insert(painter.unwrap_or_else(|| Painter::new(mode))).grid_of(seen);
        RenderedShot { shot, cells: Buffer::from(&grid), is_final }
    }
}

/// Traces the map that a shot shows, with this sampling.
fn traced(shot: &Shot, sampling: Sampling, token: &Cancellation) -> Result<TracedMap, Cancelled> {
    let Shot { scene, camera, resolution, options, .. } = shot;
    options.cells.trace_for_glyphs(options.map, Executor::Cancellable(token), scene, camera, *resolution, sampling)
}
