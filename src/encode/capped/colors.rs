//! The palette of a frame under a limit: few colours, as far apart as the exchange rate allows.
//!
//! The halves' colours are counted in bins. The fullest bin first, a bin's mean becomes a colour unless one is near
//! (leader clustering, Hartigan 1975). Colours that few halves would miss are then dropped, and the others moved to the
//! mean of their halves (Lloyd 1982).

use super::{ActiveCell, Channels, ExchangeRate, square};
use crate::grid::PackedInk;
use crate::lanes::{F32x8, LANES, Lanes, Mask, SimdKernel, Vector};
use crate::simd::dispatch;
use glam::Vec3;
use std::cmp::Reverse;

/// Largest number of colours; half as many are used if the byte limit leaves few cells to write.
// With 127 colours at every rate, a slowly moving picture never came nearer than 38 dB. With 255 at every rate, a fast
// one loses 0.5 dB, as more colours mean more changes of the pen. A colour's number takes eight bits in the distances
// of `FindTwoNearest` and in the keys of pairs.
pub(super) const MAX_COLORS: usize = 255;

/// The number of slots of the hash table of bins, a power of two.
const SLOTS: usize = 1 << 14;

#[derive(Default)]
pub(super) struct FramePalette {
    colors: PaletteColors,
    bins: Vec<Bin>,
    /// The hash table of the bins: the index of a bin, or `u16::MAX` for an empty slot.
    slots: Vec<u16>,
    /// The bin of each half of the active cells.
    bin_of_half: Vec<u16>,
    /// The indices of the bins, the fullest first.
    fullest: Vec<u16>,
}

/// The colours of a palette.
#[derive(Default)]
struct PaletteColors {
    channels: Vec<Channels>,
    /// The colours in blocks of eight, as they are compared.
    blocks: Vec<Block>,
}

/// Eight colours of the palette: 16 times each channel, and their indices.
// Squared distances are then multiples of 256, to which the index is added: the least sum is that of the nearest
// colour. An f32 has 24 bits for both.
#[derive(Clone, Copy)]
struct Block {
    channels: Vector<F32x8>,
    index: F32x8,
}

impl Block {
    /// A block without colours: its entries are farther away than any colour.
    const EMPTY: Self = {
        let far = F32x8([1e5; LANES]);
        Self { channels: Vector { x: far, y: far, z: far }, index: F32x8::ZERO }
    };

    /// Returns 256 times the squared distances from a colour, at most [`FARTHEST`].
    #[inline(always)]
    fn scaled_squared_distances<N: Lanes>(&self, color: Vector<N>) -> N {
        let difference = self.channels.load::<N>() - color;
        difference.dot(difference).min(N::splat(FARTHEST))
    }
}

/// The greatest distance: 256 times a squared distance.
const FARTHEST: f32 = (1 << 24) as f32 - 256.0;

/// Returns 16 times the channels of a colour in all lanes.
#[inline(always)]
fn splat_scaled<N: Lanes>([r, g, b]: [i32; 3]) -> Vector<N> {
    Vector { x: N::splat((16 * r) as f32), y: N::splat((16 * g) as f32), z: N::splat((16 * b) as f32) }
}

/// Finds the two nearest colours of each bin.
struct FindTwoNearest<'a> {
    blocks: &'a [Block],
    bins: &'a mut [Bin],
}

impl SimdKernel for FindTwoNearest<'_> {
    type Output = ();

    #[inline(always)]
    fn run<N: Lanes>(self) {
        let farthest = N::splat(FARTHEST);
        for bin in self.bins {
            let color = splat_scaled::<N>(bin.mean);
            let (mut first, mut second) = (farthest, farthest);
            for block in self.blocks {
                let distance = block.scaled_squared_distances(color) + N::load(&block.index);
                second = second.min(first.max(distance));
                first = first.min(distance);
            }
            let nearest = first.store().reduce_min();
            // The second nearest is the first one of another lane, or the second one of this lane.
            let others = N::select(first.le(N::splat(nearest)), second, first);
            let next = others.store().reduce_min();
            bin.nearest = [nearest as u32 as u8, if next < FARTHEST { next } else { nearest } as u32 as u8];
        }
    }
}

/// Makes colours of the means of bins, the fullest first, unless one is within the radius.
///
/// The radius is for halves of weight 1, and smaller for heavier ones.
///
/// Returns whether the palette has room for all of them.
struct ChooseLeaders<'a> {
    fullest: &'a [u16],
    bins: &'a [Bin],
    colors: &'a mut PaletteColors,
    radius: f32,
    most: usize,
}

impl SimdKernel for ChooseLeaders<'_> {
    type Output = bool;

    #[inline(always)]
    fn run<N: Lanes>(self) -> bool {
        let Self { fullest, bins, colors, radius, most } = self;
        for &bin in fullest {
            let &Bin { count, weight, mean, .. } = &bins[usize::from(bin)];
            // The weighted error that a near colour may leave is the same for all bins.
            let radius = radius * count as f32 / weight;
            // Distances are capped at `FARTHEST`, so with a larger radius all colours count as near.
            let limit = N::splat(if 256.0 * radius < FARTHEST { 256.0 * radius } else { FARTHEST });
            let color = splat_scaled::<N>(mean);
            let mut is_near = false;
            for block in &colors.blocks {
                is_near = block.scaled_squared_distances(color).le(limit).any();
                if is_near {
                    break;
                }
            }
            if !is_near {
                if colors.channels.len() == most {
                    return false;
                }
                colors.push(mean);
            }
        }
        true
    }
}

impl PaletteColors {
    /// Removes all colours.
    fn clear(&mut self) {
        self.channels.clear();
        self.blocks.clear();
    }

    /// Adds a colour.
    fn push(&mut self, channels: [i32; 3]) {
        let index = self.channels.len();
        if index.is_multiple_of(LANES) {
            self.blocks.push(Block::EMPTY);
        }
        let channels = channels.map(|channel| channel as f32);
        if let Some(block) = self.blocks.last_mut() {
            block.channels.put(index % LANES, 16.0 * Vec3::from(channels));
            block.index.0[index % LANES] = index as f32;
        }
        self.channels.push(channels);
    }
}

/// A bin: similar colours of halves, with their number, sum and mean.
struct Bin {
    key: u32,
    count: u32,
    /// The sum of the weights of the halves' errors.
    weight: f32,
    sum: [u32; 3],
    mean: [i32; 3],
    nearest: [u8; 2],
}

/// The sums over all halves that have the same colour of the palette.
#[derive(Clone, Copy, Default)]
struct Share {
    count: u32,
    sum: [u32; 3],
    /// The weighted error that dropping the colour would add.
    loss: f32,
}

impl FramePalette {
    /// Chooses the palette for some cells, and sets the colours nearest to their halves.
    ///
    /// `radius` is the least squared distance of two colours of the palette: the last frame's on entry, this frame's on
    /// return.
    pub(super) fn choose(&mut self, active: &mut [ActiveCell], rate: ExchangeRate, radius: &mut f32) {
        self.fill_bins(active, rate);
        self.choose_leaders(rate, radius);
        for _ in 0..2 {
            self.find_two_nearest();
            self.prune_and_recenter(rate);
        }
        self.find_two_nearest();
        for (cell, bins) in active.iter_mut().zip(self.bin_of_half.chunks_exact(2)) {
            cell.nearest = [0, 1].map(|half| self.bins[usize::from(bins[half])].nearest);
        }
    }

    /// Sets the colours of the palette.
    #[cfg(all(test, unit_tests))]
    pub(super) fn set_colors(&mut self, colors: &[[i32; 3]]) {
        self.colors.clear();
        for &channels in colors {
            self.colors.push(channels);
        }
    }

    /// Returns a colour of the palette.
    #[inline]
    pub(super) fn color(&self, index: u8) -> Channels {
        self.colors.channels[usize::from(index)]
    }

    /// Counts the colours of the halves in bins, whose size grows with the exchange rate.
    fn fill_bins(&mut self, active: &[ActiveCell], rate: ExchangeRate) {
        // With 5 or 6 bits per channel, the mean squared error within a bin is 16 or 4: at most the error that a cell
        // must lose at these rates to be written.
        let bits = if rate > 40.0 {
            5
        } else if rate > 2.0 {
            6
        } else {
            7
        };
        self.slots.clear();
        self.slots.resize(SLOTS, u16::MAX);
        self.bins.clear();
        self.bin_of_half.clear();
        for (color, weight) in active.iter().flat_map(|cell| cell.wanted.map(|color| (color, cell.weight))) {
            let bin = self.bin(color, bits);
            let Bin { count, weight: sum_of_weights, sum, .. } = &mut self.bins[usize::from(bin)];
            *count += 1;
            *sum_of_weights += weight;
            for (sum, channel) in sum.iter_mut().zip(color.channels()) {
                *sum += u32::from(channel);
            }
            self.bin_of_half.push(bin);
        }
        for bin in &mut self.bins {
            bin.mean = bin.sum.map(|sum| ((sum + bin.count / 2) / bin.count).cast_signed());
        }
    }

    /// Returns the index of the bin of a colour, a new one if there is none.
    fn bin(&mut self, color: PackedInk, bits: u32) -> u16 {
        let key = color.channels().iter().fold(0, |key, channel| key << bits | u32::from(channel >> (8 - bits)));
        // Multiplicative hashing (Knuth 1973), with linear probing.
        let mut slot = (key.wrapping_mul(0x9e37_79b9) >> (32 - SLOTS.ilog2())) as usize;
        loop {
            let bin = self.slots[slot];
            if bin == u16::MAX {
                break;
            }
            // A table that is three quarters full takes no more bins, because probing a full one takes long: the colour
            // goes to the bin of this slot.
            if self.bins[usize::from(bin)].key == key || self.bins.len() > SLOTS / 4 * 3 {
                return bin;
            }
            slot = (slot + 1) % SLOTS;
        }
        let bin = self.bins.len() as u16;
        self.slots[slot] = bin;
        self.bins.push(Bin { key, count: 0, weight: 0.0, sum: [0; 3], mean: [0; 3], nearest: [0; 2] });
        bin
    }

    /// Fills the palette with means of bins, the fullest first, none within the radius of another.
    fn choose_leaders(&mut self, rate: ExchangeRate, radius: &mut f32) {
        self.fullest.clear();
        self.fullest.extend(0..self.bins.len() as u16);
        self.fullest.sort_unstable_by_key(|&bin| (Reverse(self.bins[usize::from(bin)].count), bin));
        let most = if rate > 3.0 { MAX_COLORS / 2 } else { MAX_COLORS };
        // Each try compares all bins. Starting at a quarter of the last frame's radius, which is mostly near this
        // frame's, keeps the tries few.
        *radius = rate.max(*radius / 4.0);
        // With a fixed radius the fullest bins would fill the palette, and whole regions would have no colour.
        while !self.choose_leaders_within(most, *radius) {
            *radius *= 2.0;
        }
    }

    /// Fills the palette, with no colour within `radius` of another.
    ///
    /// Returns whether the palette has room for all bins that have no colour within the radius.
    fn choose_leaders_within(&mut self, most: usize, radius: f32) -> bool {
        let Self { colors, bins, fullest, .. } = self;
        colors.clear();
        dispatch(ChooseLeaders { fullest, bins, colors, radius, most })
    }

    fn find_two_nearest(&mut self) {
        dispatch(FindTwoNearest { blocks: &self.colors.blocks, bins: &mut self.bins });
    }

    /// Drops the colours without which the error grows the least, and moves the others to the mean
    /// of their halves.
    fn prune_and_recenter(&mut self, rate: ExchangeRate) {
        let mut shares = [Share::default(); MAX_COLORS];
        for bin in &self.bins {
            let mean = bin.mean.map(|channel| channel as f32);
            let [first, second] = bin.nearest.map(|color| square(self.color(color), mean));
            let share = &mut shares[usize::from(bin.nearest[0])];
            share.count += bin.count;
            for (sum, of_bin) in share.sum.iter_mut().zip(bin.sum) {
                *sum += of_bin;
            }
            share.loss += bin.weight * (second - first);
        }
        // A change of the pen to one new colour takes 15 bytes (`pen_len`).
        let is_kept = |share: &Share| share.count > 0 && share.loss >= 15.0 * rate;
        // The colour that most halves have always stays.
        let most = shares.iter().map(|share| share.count).max().unwrap_or(0);
        self.colors.clear();
        for share in shares.iter().filter(|share| share.count > 0 && (is_kept(share) || share.count == most)) {
            self.colors.push(share.sum.map(|sum| ((sum + share.count / 2) / share.count).cast_signed()));
        }
    }
}
