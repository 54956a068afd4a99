//! The geometry of a picture: the surface that each eye ray meets, for glyphs with outlines.
//!
//! A cell has two by four pixels, whose first rays give light and geometry. Pixels at an edge get four more rays each,
//! so that outlines are placed to an eighth of a cell's height; this takes a third more rays.

use super::sampling::SampleBatches;
use super::steps::{Buffers, RenderJob, Stage};
use super::tiles::{PIXELS, Tiles};
use super::{Cost, Executor, Rendered, Sampling, render_partial};
use crate::camera::Camera;
use crate::color::LinearRgb;
use crate::framebuffer::{Framebuffer, Resolution};
use crate::lanes::LANES;
use crate::scene::Scene;
use crate::shade;
use glam::Vec3;
use std::num::NonZeroU32;

/// The numbers of pixels in a cell, across and down.
const CELL: [usize; 2] = [2, 4];
/// The numbers of fine facets in a cell with an edge, across and down.
const FINE: [usize; 2] = [2 * CELL[0], 2 * CELL[1]];

/// The surface at the hit of an eye ray: depth, object and normal.
// A facet has twelve bytes. With a normal of three floats, a frame of 200x60 cells would move twice the memory.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Facet {
    /// The depth of the hit, or infinity.
    pub depth: f32,
    /// The object's index, plus 1; 0 without a hit.
    pub object: u32,
    /// The shading normal, in units of 1/127.
    normal: [i8; 3],
    /// The kind of the object: none, bounded, or a level or upright plane.
    pub extent: Extent,
}

/// The kind of object that an eye ray hits: none, a bounded object, or a plane by its inclination.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Extent {
    /// No object: the background.
    Nothing,
    /// A bounded object.
    Bounded,
    /// An unbounded plane within 53 degrees of level: a floor or a ceiling.
    Level,
    /// An unbounded plane that is steeper: a wall.
    Upright,
}

impl Facet {
    /// The background.
    pub const NOTHING: Self = Self { depth: f32::INFINITY, object: 0, normal: [0; 3], extent: Extent::Nothing };

    /// Returns the facet of a hit at `depth` on the object with this index.
    fn of_hit(scene: &Scene, object: u32, normal: Vec3, depth: f32) -> Self {
        let extent = match scene.objects()[object as usize].shape.bounds() {
            Some(_) => Extent::Bounded,
            // Up to 53 degrees from level.
            None if normal.y.abs() > 0.6 => Extent::Level,
            None => Extent::Upright,
        };
        let normal = normal.to_array().map(|coordinate| (coordinate * 127.0) as i8);
        Self { depth, object: object + 1, normal, extent }
    }

    /// Returns whether a neighbouring facet is on another object, or across a crease of the
    /// same bounded object.
    fn may_border(&self, other: &Self) -> bool {
        self.object != other.object || self.extent == Extent::Bounded && self.cosine(other) < CREASE_COSINE
    }

    /// Returns the cosine of the angle between the normals of two facets, exact to two digits.
    pub fn cosine(&self, other: &Self) -> f32 {
        let products = self.normal.iter().zip(other.normal).map(|(&a, b)| i32::from(a) * i32::from(b));
        products.sum::<i32>() as f32 / (127.0 * 127.0)
    }
}

/// The facets of a picture with two by four pixels per cell.
#[derive(Clone, Debug, PartialEq)]
pub struct Geometry {
    /// The picture's width in pixels.
    width: usize,
    /// The facet of each pixel's first ray.
    facets: Vec<Facet>,
    /// The constant term of the threshold of [`jumps`](Self::jumps), in world units.
    least_jump: f32,
    /// For each cell, the index in `fine`, or [`NOT_FINE`].
    // Fine facets are indexed instead of stored for every cell, because few cells have them, and those of one cell take
    // 384 bytes.
    fine_indices: Vec<u32>,
    /// The fine facets of each cell in or beside which an edge may be: four by eight, row by row.
    fine: Vec<[Facet; FINE[0] * FINE[1]]>,
}

/// The entry in `fine_indices` of a cell without fine facets.
const NOT_FINE: u32 = u32::MAX;

impl Geometry {
    /// Returns the geometry of a picture of a single surface.
    pub fn of_one_surface(width: u32, height: u32) -> Self {
        let facet = Facet { depth: 1.0, object: 1, extent: Extent::Bounded, ..Facet::NOTHING };
        let facets = vec![facet; width as usize * height as usize];
        Self::new(Resolution::square(width, height), facets, 0.0)
    }

    fn new(resolution: Resolution, facets: Vec<Facet>, least_jump: f32) -> Self {
        let mut geometry =
            Self { width: resolution.width() as usize, facets, least_jump, fine_indices: Vec::new(), fine: Vec::new() };
        geometry.fine_indices = vec![NOT_FINE; geometry.columns() * geometry.rows()];
        geometry
    }

    /// Returns the geometry of `columns` by `rows` cells; `object` gives the number of the object
    /// at a position in cells, or 0 for the background.
    ///
    /// For tests of outlines, whose edges have to be at exact positions.
    pub fn of_objects(columns: usize, rows: usize, object: impl Fn(f32, f32) -> u32) -> Self {
        let facet = |x: f32, y: f32| match object(x, y) {
            0 => Facet::NOTHING,
            object => Facet { depth: 1.0, object, normal: [0, 0, 127], extent: Extent::Bounded },
        };
        let (width, height) = (CELL[0] * columns, CELL[1] * rows);
        let middle = |at: usize, count: usize| (at as f32 + 0.5) / count as f32;
        let at_pixel = |pixel: usize| facet(middle(pixel % width, CELL[0]), middle(pixel / width, CELL[1]));
        let facets = (0..width * height).map(at_pixel).collect();
        let mut geometry = Self::new(Resolution::square(width as u32, height as u32), facets, 0.0);
        for cell in geometry.cells_with(&geometry.crossed_pixels()) {
            geometry.fine_indices[cell] = geometry.fine.len() as u32;
            let (left, top) = ((cell % columns) as f32, (cell / columns) as f32);
            geometry.fine.push(std::array::from_fn(|at| {
                facet(left + middle(at % FINE[0], FINE[0]), top + middle(at / FINE[0], FINE[1]))
            }));
        }
        geometry
    }

    /// Returns whether this is the geometry of a picture of this size.
    pub fn fits(&self, width: u32, height: u32) -> bool {
        (self.width, self.height()) == (width as usize, height as usize)
    }

    /// Returns the number of cells in a row.
    pub fn columns(&self) -> usize {
        self.width.div_ceil(CELL[0])
    }

    /// Returns the number of rows of cells.
    pub fn rows(&self) -> usize {
        self.height().div_ceil(CELL[1])
    }

    fn height(&self) -> usize {
        self.facets.len() / self.width.max(1)
    }

    /// Returns the facet of the pixel with this index.
    pub fn pixel(&self, index: usize) -> &Facet {
        &self.facets[index]
    }

    /// Returns the facet at a position in pixels; positions beyond the picture are clamped to its
    /// edge.
    fn at_pixel(&self, x: usize, y: usize) -> &Facet {
        self.pixel(y.min(self.height() - 1) * self.width + x.min(self.width - 1))
    }

    /// Returns whether a cell has fine facets: an edge may be in or beside it.
    pub fn has_edge(&self, column: usize, row: usize) -> bool {
        self.fine_indices[row * self.columns() + column] != NOT_FINE
    }

    /// Returns whether both geometries have the same facets in a cell.
    ///
    /// `cell` is the index of the cell, and `pixels` are the indices of its pixels.
    pub fn has_same_facets(&self, other: &Self, cell: usize, pixels: &[usize]) -> bool {
        let fine = |geometry: &Self| geometry.fine.get(geometry.fine_indices[cell] as usize).copied();
        pixels.iter().all(|&pixel| self.facets[pixel] == other.facets[pixel]) && fine(self) == fine(other)
    }

    /// Returns the facet at a position in quarters of a cell's width and eighths of its height.
    pub fn at(&self, x: usize, y: usize) -> &Facet {
        let index = self.fine_indices[y / FINE[1] * self.columns() + x / FINE[0]];
        match self.fine.get(index as usize) {
            Some(facets) => &facets[y % FINE[1] * FINE[0] + x % FINE[0]],
            None => self.at_pixel(x / 2, y / 2),
        }
    }

    /// Returns whether the depths of three facets in a line are far from linear: a jump or a sharp
    /// bend.
    pub fn jumps(&self, [before, middle, after]: [&Facet; 3]) -> bool {
        let bend = before.depth - 2.0 * middle.depth + after.depth;
        bend.abs() > 0.03 * middle.depth + self.least_jump
    }

    /// Returns the mask of pixels beside which an edge may be.
    fn crossed_pixels(&self) -> Vec<bool> {
        let mut crossed = vec![false; self.facets.len()];
        let (width, height) = (self.width, self.height());
        let mut mark = |x: usize, y: usize| crossed[y * width + x] = true;
        for y in 0..height {
            for x in 0..width {
                let facet = self.at_pixel(x, y);
                for (right, down) in [(1, 0), (0, 1)] {
                    if x + right >= width || y + down >= height {
                        continue;
                    }
                    let next = self.at_pixel(x + right, y + down);
                    let bends = || {
                        facet.extent == Extent::Bounded
                            && x >= right
                            && y >= down
                            && self.jumps([self.at_pixel(x - right, y - down), facet, next])
                    };
                    if facet.may_border(next) || bends() {
                        mark(x, y);
                        mark(x + right, y + down);
                    }
                }
            }
        }
        crossed
    }

    /// Returns the indices of the cells in which at least one pixel is set in the mask `pixels`.
    fn cells_with(&self, pixels: &[bool]) -> Vec<usize> {
        let mut cells = vec![false; self.fine_indices.len()];
        for at in (0..pixels.len()).filter(|&at| pixels[at]) {
            cells[at / self.width / CELL[1] * self.columns() + at % self.width / CELL[0]] = true;
        }
        (0..cells.len()).filter(|&cell| cells[cell]).collect()
    }
}

/// The cosine of the least angle between the normals at a crease, 40 degrees.
pub const CREASE_COSINE: f32 = 0.766;

/// Renders a picture with two by four pixels per cell, and its geometry.
///
/// If `executor` is cancelled, both are incomplete.
pub fn render_with_geometry(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> (Rendered, Geometry) {
    let pixel_side = if sampling == Sampling::Coarse { 2 } else { 1 };
    if let Sampling::Coarse | Sampling::Each(NonZeroU32::MIN) | Sampling::UpTo(NonZeroU32::MIN) = sampling {
        // The single ray of a pixel gives both its light and its facet.
        let tiles = Tiles::new(camera, resolution, pixel_side);
        let (pixels, mut cost) = trace_facets(executor, scene, &tiles, Stage::Reflected);
        let mut framebuffer = Framebuffer::new(resolution);
        framebuffer.pixels_mut().iter_mut().zip(&pixels).for_each(|(light, &(traced, _))| *light = traced);
        let (geometry, more) = with_fine_facets(executor, scene, camera, &tiles, pixels);
        cost += more;
        return (Rendered { framebuffer, cost }, geometry);
    }
    let mut rendered = render_partial(executor, scene, camera, resolution, sampling);
    let (geometry, cost) = trace_geometry(executor, scene, camera, resolution, sampling);
    rendered.cost += cost;
    (rendered, geometry)
}

/// Traces the geometry of a picture with two by four pixels per cell.
///
/// If `executor` is cancelled, it is incomplete.
pub fn trace_geometry(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    resolution: Resolution,
    sampling: Sampling,
) -> (Geometry, Cost) {
    let tiles = Tiles::new(camera, resolution, if sampling == Sampling::Coarse { 2 } else { 1 });
    // Facets need no light, so no shadow rays are traced.
    let (pixels, mut cost) = trace_facets(executor, scene, &tiles, Stage::Points);
    let (geometry, more) = with_fine_facets(executor, scene, camera, &tiles, pixels);
    cost += more;
    (geometry, cost)
}

/// Traces the first ray of each pixel: its light, if `last_stage` includes that, and its facet.
fn trace_facets(
    executor: Executor<'_>,
    scene: &Scene,
    tiles: &Tiles,
    last_stage: Stage,
) -> (Vec<(LinearRgb, Facet)>, Cost) {
    let mut pixels = vec![(LinearRgb::BLACK, Facet::NOTHING); tiles.resolution.pixel_count()];
    let batches = SampleBatches::of(0..1);
    let job = RenderJob::new(scene, tiles, last_stage);
    let cost = executor.trace(&job, tiles.split(&mut pixels), |tile, mut part| {
        tile.trace(&batches, |buffers, _, _| {
            for (ray, &pixel) in buffers.pixels.iter().enumerate() {
                // Adding to zero turns -0 into 0. The sums in `uniform` do so too, so the light has the same bits in
                // both.
                let light = buffers
                    .lights
                    .get(ray / LANES)
                    .map_or(LinearRgb::BLACK, |lights| LinearRgb::BLACK + shade::lane_light(lights, ray % LANES));
                tiles.fill_traced_pixel(pixel, (light, facet(scene, buffers, ray)), &mut part);
            }
        });
    });
    (pixels, cost)
}

/// Returns the facet of a ray of the last batch.
fn facet(scene: &Scene, Buffers { points, hits, .. }: &Buffers, ray: usize) -> Facet {
    let (group, lane) = (ray / LANES, ray % LANES);
    points[group]
        .object_and_normal(lane)
        .map_or(Facet::NOTHING, |(object, normal)| Facet::of_hit(scene, object, normal, hits[group].t.0[lane]))
}

/// Returns the geometry of traced pixels, and traces fine facets where an edge may be.
fn with_fine_facets(
    executor: Executor<'_>,
    scene: &Scene,
    camera: &Camera,
    coarse: &Tiles,
    pixels: Vec<(LinearRgb, Facet)>,
) -> (Geometry, Cost) {
    let resolution = coarse.resolution;
    let facets = pixels.into_iter().map(|(_, facet)| facet).collect();
    let mut geometry = Geometry::new(resolution, facets, 0.012 * camera.pose().eye.distance(camera.pose().target));
    // Coarse pictures, with one ray for two by two pixels, are made by machines that are too slow for fine facets.
    if coarse.pixel_side > 1 {
        return (geometry, Cost::default());
    }
    let crossed = geometry.crossed_pixels();
    let (width, fine_size) = (geometry.width, [2 * resolution.width(), 2 * resolution.height()]);
    let fine =
        Resolution::new(fine_size[0], fine_size[1]).and_then(|size| size.with_pixel_aspect(resolution.pixel_aspect()));
    // A picture that would have too many pixels at twice the resolution gets no fine facets.
    let Ok(fine) = fine else { return (geometry, Cost::default()) };
    let tiles = Tiles::new(camera, fine, 1);
    let mut traced = vec![Vec::new(); tiles.count()];
    let batches = SampleBatches::of(0..1);
    let job = RenderJob::new(scene, &tiles, Stage::Points);
    let cost = executor.trace(&job, traced.iter_mut().collect(), |tile, facets: &mut Vec<Facet>| {
        let number = tile.number;
        tile.buffers.active.retain(|&pixel| {
            let [x, y] = tiles.position(number, pixel).map(|at| at as usize);
            crossed[y / 2 * width + x / 2]
        });
        // Tiles without an edge need no memory. Most tiles have none: in the measured scenes 9 to 15 % of the cells
        // have an edge.
        if tile.buffers.active.is_empty() {
            return;
        }
        facets.resize(PIXELS, Facet::NOTHING);
        tile.trace(&batches, |buffers, _, _| {
            for (ray, &pixel) in buffers.pixels.iter().enumerate() {
                facets[usize::from(pixel)] = facet(scene, buffers, ray);
            }
        });
    });
    for cell in geometry.cells_with(&crossed) {
        let (left, top) = (cell % geometry.columns() * FINE[0], cell / geometry.columns() * FINE[1]);
        let facets = std::array::from_fn(|at| {
            let (x, y) = ((left + at % FINE[0]) as u32, (top + at / FINE[0]) as u32);
            let [x, y] = [x.min(fine_size[0] - 1), y.min(fine_size[1] - 1)];
            let coarse = y as usize / 2 * width + x as usize / 2;
            let (tile, pixel) = tiles.tile_and_index([x, y]);
            let fine = traced[tile].get(pixel).filter(|_| crossed[coarse]);
            *fine.unwrap_or(&geometry.facets[coarse])
        });
        geometry.fine_indices[cell] = geometry.fine.len() as u32;
        geometry.fine.push(facets);
    }
    (geometry, cost)
}
