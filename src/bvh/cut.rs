//! The choice of a cut between the items of a node, by the surface area heuristic.
//!
//! The heuristic takes the cut of least expected cost (Goldsmith and Salmon 1987), here among the cuts between a few
//! bins along each axis (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007).

use crate::bounds::Bounds;
use crate::lanes::LANES;
use glam::Vec3;
use std::array::from_fn;

/// A box as two rows of four numbers, which fit the CPU's registers.
// With these rows, two passes over the items instead of five, and leaves of eight items, building the dragon's tree
// took 0.6 of the time.
#[derive(Clone, Copy)]
#[repr(align(16))]
pub(super) struct Rows {
    pub(super) min: [f32; 4],
    pub(super) max: [f32; 4],
}

impl Rows {
    const EMPTY: Self = Self { min: [f32::INFINITY; 4], max: [f32::NEG_INFINITY; 4] };

    #[inline(always)]
    fn grow(&mut self, other: &Self) {
        // The compiler turns comparisons of four numbers at a time into MINPS and MAXPS; `f32::min` would also check
        // for NaN.
        for at in 0..4 {
            self.min[at] = if other.min[at] < self.min[at] { other.min[at] } else { self.min[at] };
            self.max[at] = if other.max[at] > self.max[at] { other.max[at] } else { self.max[at] };
        }
    }

    /// Returns the center of the box, times two.
    #[inline(always)]
    fn doubled_center(&self) -> [f32; 4] {
        from_fn(|at| self.min[at] + self.max[at])
    }

    pub(super) fn bounds(&self) -> Bounds {
        let [x, y, z, _] = self.min;
        let [to_x, to_y, to_z, _] = self.max;
        Bounds { min: Vec3::new(x, y, z), max: Vec3::new(to_x, to_y, to_z) }
    }
}

/// A box with its index, which is stored as the bits of the fourth minimum: no computation uses
/// that number.
pub(super) type Item = Rows;

pub(super) fn item((number, bounds): (u32, &Bounds)) -> Item {
    let [x, y, z] = bounds.min.to_array();
    let [to_x, to_y, to_z] = bounds.max.to_array();
    Rows { min: [x, y, z, f32::from_bits(number)], max: [to_x, to_y, to_z, 0.0] }
}

/// The largest number of boxes in a leaf, which are tested together.
const MAX_LEAF_BOXES: usize = LANES;

/// The largest depth of a tree.
// The depth bounds the recursion of the build and the stacks of the traversal.
const MAX_DEPTH: usize = 96;

/// The depth up to which cuts may be unbalanced.
// Deeper cuts halve the items, so that no path is longer than `MAX_DEPTH`: even 2^32 items can be halved only 32 times.
const FREE_DEPTH: usize = MAX_DEPTH - 34;

/// The bounds of some items.
#[derive(Clone, Copy)]
pub(super) struct ItemBounds {
    pub(super) boxes: Rows,
    /// The bounds of the items' centers, times two.
    middles: Rows,
}

impl ItemBounds {
    const NOTHING: Self = Self { boxes: Rows::EMPTY, middles: Rows::EMPTY };

    pub(super) fn of(items: &[Item]) -> Self {
        let mut bounds = Self::NOTHING;
        for item in items {
            bounds.grow(item);
        }
        bounds
    }

    #[inline(always)]
    fn grow(&mut self, item: &Item) {
        let middle = item.doubled_center();
        self.boxes.grow(item);
        self.middles.grow(&Rows { min: middle, max: middle });
    }
}

/// A cut: the number of items before it, and the bounds of the items on each side.
pub(super) struct Halves {
    pub(super) cut: usize,
    pub(super) bounds: [ItemBounds; 2],
}

impl Halves {
    pub(super) fn cut_at(cut: usize, items: &[Item]) -> Self {
        Self { cut, bounds: [ItemBounds::of(&items[..cut]), ItemBounds::of(&items[cut..])] }
    }
}

/// Chooses a cut and partitions the items by it; `None` if they fit into a leaf.
pub(super) fn cut(items: &mut [Item], bounds: &ItemBounds, depth: usize) -> Option<Halves> {
    if items.len() <= MAX_LEAF_BOXES {
        return None;
    }
    let plane = if depth < FREE_DEPTH { Cut::cheapest(items, &bounds.middles) } else { None };
    // There is no plane if all centers coincide or the node is too deep. Any half of the items will do then.
    let Some(Cut { bin, before, .. }) = plane else { return Some(Halves::cut_at(items.len() / 2, items)) };
    Some(partition(items, |item| bin.index_of(item) < before))
}

/// Moves the items for which `is_first` is true before the others.
// The partition also computes the bounds of both sides: with a separate pass over the items of each node, the build of
// the dragon's tree of 871 k triangles took 1.01 times as long.
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> Halves {
    let (mut start, mut end) = (0, items.len());
    let [mut first, mut last] = [ItemBounds::NOTHING; 2];
    while start < end {
        let item = items[start];
        if is_first(&item) {
            first.grow(&item);
            start += 1;
        } else {
            last.grow(&item);
            end -= 1;
            items.swap(start, end);
        }
    }
    Halves { cut: start, bounds: [first, last] }
}

/// The largest number of bins per axis: the usual 16 (Wald 2007).
const MAX_BINS: usize = 16;

/// The number of items below which [`MAX_BINS`] is halved, as clearing and scanning the bins takes
/// time at each node.
const MIN_ITEMS_FOR_MAX_BINS: usize = 48;

/// The division of an axis into bins of equal size, to which items belong by their centers.
#[derive(Clone, Copy)]
struct Bin {
    axis: usize,
    start: f32,
    scale: f32,
    last: usize,
}

impl Bin {
    fn along(axis: usize, middles: &Rows, bins: usize) -> Option<Self> {
        let extent = middles.max[axis] - middles.min[axis];
        // A little less than the number of bins, so that the largest center falls into the last bin; `min` in
        // `index_of` guards against rounding.
        let scale = bins as f32 * 0.999 / extent;
        let start = middles.min[axis];
        (extent > 0.0 && scale.is_finite()).then_some(Self { axis, start, scale, last: bins - 1 })
    }

    #[inline(always)]
    fn index_of(&self, item: &Item) -> usize {
        let middle = item.min[self.axis] + item.max[self.axis];
        (((middle - self.start) * self.scale) as usize).min(self.last)
    }
}

/// A cut between two bins.
struct Cut {
    bin: Bin,
    /// The index of the first bin after the cut.
    before: usize,
    /// The sum of the [`cost`] of both sides.
    cost: f32,
}

impl Cut {
    fn cheapest(items: &[Item], middles: &Rows) -> Option<Self> {
        let count = if items.len() < MIN_ITEMS_FOR_MAX_BINS { MAX_BINS / 2 } else { MAX_BINS };
        let axes = [0, 1, 2].map(|axis| Bin::along(axis, middles, count));
        let mut bins = [[(Rows::EMPTY, 0_u32); MAX_BINS]; 3];
        for item in items {
            for (bin, bins) in axes.iter().zip(&mut bins) {
                let Some(bin) = bin else { continue };
                let (rows, count) = &mut bins[bin.index_of(item)];
                rows.grow(item);
                *count += 1;
            }
        }
        let planes = axes.into_iter().zip(&bins).filter_map(|(bin, bins)| Self::cheapest_between(bin?, &bins[..count]));
        // Of equal costs the first is taken, so that the tree is the same on every machine.
        planes.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    fn cheapest_between(bin: Bin, bins: &[(Rows, u32)]) -> Option<Self> {
        let mut behind = [(0.0, 0); MAX_BINS];
        let mut sum = (Rows::EMPTY, 0);
        for at in (1..bins.len()).rev() {
            sum.0.grow(&bins[at].0);
            sum.1 += bins[at].1;
            behind[at] = (cost(sum), sum.1);
        }
        let mut sum = (Rows::EMPTY, 0);
        let mut cheapest: Option<Self> = None;
        for before in 1..bins.len() {
            sum.0.grow(&bins[before - 1].0);
            sum.1 += bins[before - 1].1;
            // A cut with all items on one side would make a child without boxes.
            if sum.1 == 0 || behind[before].1 == 0 {
                continue;
            }
            let cost = cost(sum) + behind[before].0;
            if cheapest.as_ref().is_none_or(|cheapest| cost < cheapest.cost) {
                cheapest = Some(Self { bin, before, cost });
            }
        }
        cheapest
    }
}

/// Returns the half area of the box times the expected number of tests below it.
// A leaf's boxes are tested eight at a time, so the number of blocks of eight counts. A sixteenth for each box breaks
// ties between cuts with the same number of blocks. Counting single boxes instead made 18 % more leaves of the dragon's
// 871 k triangles, and 5 % slower rays.
#[inline(always)]
fn cost((rows, count): (Rows, u32)) -> f32 {
    let [x, y, z, _]: [f32; 4] = from_fn(|at| rows.max[at] - rows.min[at]);
    let tests = count.div_ceil(LANES as u32) as f32 + count as f32 / 16.0;
    if count == 0 { 0.0 } else { tests * (x * y + y * z + z * x) }
}
