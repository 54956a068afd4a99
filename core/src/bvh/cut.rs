//! The choice of a cut between the items of a node, by the surface area heuristic.
//!
//! The heuristic takes the cut of least expected cost (Goldsmith and Salmon 1987), here among the cuts between a few
//! bins along each axis (Wald, On fast Construction of SAH-based Bounding Volume Hierarchies, 2007).

use crate::bounds::Bounds;
use crate::lanes::LANES;
use glam::Vec3;
use std::array::from_fn;

/// A box as two rows of four numbers, which fit the CPU's registers.
// The rows, together with two passes over the items instead of five and with leaves of eight items, shortened the build
// of the dragon's tree by 40 %.
#[derive(Clone, Copy)]
#[repr(align(16))]
pub(super) struct BoxRows {
    pub(super) min: [f32; 4],
    pub(super) max: [f32; 4],
}

impl BoxRows {
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

/// A box with its index, whose bits are stored in `min[3]`: no computation uses that number.
pub(super) type Item = BoxRows;

pub(super) fn item((number, bounds): (u32, &Bounds)) -> Item {
    let [x, y, z] = bounds.min.to_array();
    let [to_x, to_y, to_z] = bounds.max.to_array();
    BoxRows { min: [x, y, z, f32::from_bits(number)], max: [to_x, to_y, to_z, 0.0] }
}

/// The largest number of boxes in a leaf, which are tested together.
const MAX_LEAF_BOXES: usize = LANES;

/// The largest depth of a tree.
// The depth bounds the recursion of the build and the stacks of the traversal.
const MAX_DEPTH: usize = 96;

/// The depth from which on each cut halves the number of items, without regard to its cost.
// So no path is longer than `MAX_DEPTH`: even 2^32 items can be halved only 32 times.
const HALVING_DEPTH: usize = MAX_DEPTH - 34;

/// The bounds of some items.
#[derive(Clone, Copy)]
pub(super) struct ItemBounds {
    pub(super) boxes: BoxRows,
    /// The bounds of the items' centers times two, as [`BoxRows::doubled_center`] returns them.
    doubled_centers: BoxRows,
}

impl ItemBounds {
    const NOTHING: Self = Self { boxes: BoxRows::EMPTY, doubled_centers: BoxRows::EMPTY };

    pub(super) fn of(items: &[Item]) -> Self {
        let mut bounds = Self::NOTHING;
        for item in items {
            bounds.grow(item);
        }
        bounds
    }

    #[inline(always)]
    fn grow(&mut self, item: &Item) {
        let center = item.doubled_center();
        self.boxes.grow(item);
        self.doubled_centers.grow(&BoxRows { min: center, max: center });
    }
}

/// A cut: the number of items before it, and the bounds of the items on each side.
pub(super) struct CutSides {
    pub(super) cut: usize,
    pub(super) bounds: [ItemBounds; 2],
}

impl CutSides {
    pub(super) fn cut_at(cut: usize, items: &[Item]) -> Self {
        Self { cut, bounds: [ItemBounds::of(&items[..cut]), ItemBounds::of(&items[cut..])] }
    }
}

/// Chooses a cut and partitions the items by it; `None` if they fit into a leaf.
pub(super) fn cut(items: &mut [Item], bounds: &ItemBounds, depth: usize) -> Option<CutSides> {
    if items.len() <= MAX_LEAF_BOXES {
        return None;
    }
    let plane = if depth < HALVING_DEPTH { Cut::cheapest(items, &bounds.doubled_centers) } else { None };
    // There is no plane if all centers coincide or the node is too deep. Any half of the items will do then.
    let Some(Cut { bins, before, .. }) = plane else { return Some(CutSides::cut_at(items.len() / 2, items)) };
    Some(partition(items, |item| bins.index_of(item) < before))
}

/// Moves the items for which `is_first` is true before the others.
// The partition also computes the bounds of both sides: with a separate pass over the items of each node, the build of
// the dragon's tree of 871 k triangles took 1.01 times as long.
fn partition(items: &mut [Item], is_first: impl Fn(&Item) -> bool) -> CutSides {
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
    CutSides { cut: start, bounds: [first, last] }
}

/// The largest number of bins per axis: the usual 16 (Wald 2007).
// With 32 bins, rays are at most 1 % faster.
const MAX_BINS: usize = 16;

/// The number of items below which [`MAX_BINS`] is halved, as clearing and scanning the bins takes
/// time at each node.
const MIN_ITEMS_FOR_MAX_BINS: usize = 48;

/// The number of items of a node that are sorted into bins: of more, an even selection is.
// Sorting all of them, a file of 2.7 M triangles opens in 1.2 times the CPU time, and rays are as fast.
const MAX_SORTED: usize = 1024;

/// The division of an axis into bins of equal size, to which items belong by their centers.
#[derive(Clone, Copy)]
struct AxisBins {
    axis: usize,
    start: f32,
    scale: f32,
    last: usize,
}

impl AxisBins {
    /// Divides the range of the items' centers along an axis into bins; `None` if they coincide.
    fn divide(axis: usize, doubled_centers: &BoxRows, count: usize) -> Option<Self> {
        let extent = doubled_centers.max[axis] - doubled_centers.min[axis];
        // A little less than the number of bins, so that the largest center falls into the last bin; `min` in
        // `index_of` guards against rounding.
        let scale = count as f32 * 0.999 / extent;
        let start = doubled_centers.min[axis];
        (extent > 0.0 && scale.is_finite()).then_some(Self { axis, start, scale, last: count - 1 })
    }

    #[inline(always)]
    fn index_of(&self, item: &Item) -> usize {
        let doubled_center = item.min[self.axis] + item.max[self.axis];
        (((doubled_center - self.start) * self.scale) as usize).min(self.last)
    }
}

/// Returns the index of the item that stands for the `count` items of a chunk with this number.
// Always the first one would be in the same column of a height field whose rows are a multiple of chunks.
#[inline(always)]
fn chosen(chunk: usize, count: usize) -> usize {
    // The multiples of the golden ratio are spread evenly (Knuth, The Art of Computer Programming, 6.4).
    let fraction = (chunk as u32).wrapping_mul(0x9E37_79B1);
    ((u64::from(fraction) * count as u64) >> 32) as usize
}

/// A cut between two bins.
struct Cut {
    bins: AxisBins,
    /// The index of the first bin after the cut.
    before: usize,
    /// The sum of the [`cost`] of both sides.
    cost: f32,
}

impl Cut {
    fn cheapest(items: &[Item], doubled_centers: &BoxRows) -> Option<Self> {
        let step = (items.len() / MAX_SORTED).max(1);
        let cheapest = Self::cheapest_for_every(step, items, doubled_centers);
        // The selection may lie in one bin although all items do not.
        if cheapest.is_none() && step > 1 { Self::cheapest_for_every(1, items, doubled_centers) } else { cheapest }
    }

    /// Returns the cheapest cut for one of every `step` items.
    #[inline(always)]
    fn cheapest_for_every(step: usize, items: &[Item], doubled_centers: &BoxRows) -> Option<Self> {
        let count = if items.len() < MIN_ITEMS_FOR_MAX_BINS { MAX_BINS / 2 } else { MAX_BINS };
        let axes = [0, 1, 2].map(|axis| AxisBins::divide(axis, doubled_centers, count));
        let mut contents = [[(BoxRows::EMPTY, 0_u32); MAX_BINS]; 3];
        for (at, items) in items.chunks(step).enumerate() {
            let item = &items[chosen(at, items.len())];
            for (bins, contents) in axes.iter().zip(&mut contents) {
                let Some(bins) = bins else { continue };
                let (rows, count) = &mut contents[bins.index_of(item)];
                rows.grow(item);
                *count += step as u32; // fewer than 2^31 items
            }
        }
        let planes = axes.into_iter().zip(&contents);
        let planes = planes.filter_map(|(bins, contents)| Self::cheapest_between(bins?, &contents[..count]));
        // The first of several equal costs is taken, so that the tree is the same on every machine.
        planes.min_by(|a, b| a.cost.total_cmp(&b.cost))
    }

    fn cheapest_between(bins: AxisBins, contents: &[(BoxRows, u32)]) -> Option<Self> {
        let mut behind = [(0.0, 0); MAX_BINS];
        let mut sum = (BoxRows::EMPTY, 0);
        for at in (1..contents.len()).rev() {
            sum.0.grow(&contents[at].0);
            sum.1 += contents[at].1;
            behind[at] = (cost(sum), sum.1);
        }
        let mut sum = (BoxRows::EMPTY, 0);
        let mut cheapest: Option<Self> = None;
        for before in 1..contents.len() {
            sum.0.grow(&contents[before - 1].0);
            sum.1 += contents[before - 1].1;
            // A cut with all items on one side would make a child without boxes.
            if sum.1 == 0 || behind[before].1 == 0 {
                continue;
            }
            let cost = cost(sum) + behind[before].0;
            if cheapest.as_ref().is_none_or(|cheapest| cost < cheapest.cost) {
                cheapest = Some(Self { bins, before, cost });
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
fn cost((rows, count): (BoxRows, u32)) -> f32 {
    let [x, y, z, _]: [f32; 4] = from_fn(|at| rows.max[at] - rows.min[at]);
    let tests = count.div_ceil(LANES as u32) as f32 + count as f32 / 16.0;
    if count == 0 { 0.0 } else { tests * (x * y + y * z + z * x) }
}
