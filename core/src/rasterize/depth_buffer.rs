//! The nearest object of each pixel, and its depth.

use crate::framebuffer::Resolution;
use crate::lanes::{F32x8, LANES, Lanes};

/// The nearest object of each pixel and its depth, row by row from the upper left.
#[derive(Clone, Debug, PartialEq)]
pub struct DepthBuffer {
    width: u32,
    height: u32,
    /// The depths (the t of the eye rays) of eight pixels in a row; infinite where no object is.
    // Rows are padded to whole groups of eight; the values of the padding are unspecified.
    t: Vec<F32x8>,
    /// The number of the nearest object of each pixel, as passed to `draw`, as the bits of a float.
    objects: Vec<F32x8>,
}

impl DepthBuffer {
    /// Returns a buffer without objects.
    pub(super) fn new(resolution: Resolution) -> Self {
        let (width, height) = (resolution.width(), resolution.height());
        let groups = (width as usize).div_ceil(LANES) * height as usize;
        let (t, objects) = (vec![F32x8([f32::INFINITY; LANES]); groups], vec![F32x8::ZERO; groups]);
        Self { width, height, t, objects }
    }

    /// Returns the object at a pixel and its depth, or `None` if none is visible there.
    pub fn at(&self, x: u32, y: u32) -> Option<(u32, f32)> {
        let (index, lane) = self.place(x, y);
        let t = self.t[index].0[lane];
        (t < f32::INFINITY).then(|| (self.objects[index].0[lane].to_bits(), t))
    }

    /// Returns the number of pixels that show an object, and the sum of their depths.
    pub fn hits_and_depths(&self) -> (u64, f64) {
        let pixels = (0..self.height).flat_map(|y| (0..self.width).map(move |x| (x, y)));
        let seen = pixels.filter_map(|(x, y)| self.at(x, y));
        seen.fold((0, 0.0), |(count, sum), (_, t)| (count + 1, sum + f64::from(t)))
    }

    /// Returns the depth at a pixel; infinite if no object is visible there.
    pub(super) fn t(&self, x: u32, y: u32) -> f32 {
        let (index, lane) = self.place(x, y);
        self.t[index].0[lane]
    }

    /// Draws an object at a pixel, unless a nearer one is there.
    pub(super) fn draw(&mut self, [x, y]: [u32; 2], t: f32, object: u32) {
        let (index, lane) = self.place(x, y);
        if t < self.t[index].0[lane] {
            (self.t[index].0[lane], self.objects[index].0[lane]) = (t, f32::from_bits(object));
        }
    }

    /// Returns the index in `t` and `objects` of the eight pixels that start at column `8 * group`.
    #[inline(always)]
    pub(super) fn group(&self, group: u32, y: u32) -> usize {
        y as usize * (self.width as usize).div_ceil(LANES) + group as usize
    }

    /// Returns the depths of a group.
    #[inline(always)]
    pub(super) fn depths<N: Lanes>(&self, index: usize) -> N {
        N::load(&self.t[index])
    }

    /// Draws an object at the pixels of a group in the mask, unless nearer ones are there.
    #[inline(always)]
    pub(super) fn draw_group<N: Lanes>(&mut self, index: usize, mask: N::Mask, t: N, object: N) {
        let before = N::load(&self.t[index]);
        let is_nearer = mask & t.lt(before);
        self.t[index] = N::select(is_nearer, t, before).store();
        self.objects[index] = N::select(is_nearer, object, N::load(&self.objects[index])).store();
    }

    fn place(&self, x: u32, y: u32) -> (usize, usize) {
        (self.group(x / LANES as u32, y), x as usize % LANES)
    }
}
