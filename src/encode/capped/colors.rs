//! The palette of a frame under a limit: few colours, as far apart as the exchange rate allows.
//!
//! The halves' colours are counted in bins. The fullest bin first, a bin's mean becomes a colour unless one is near
//! (leader clustering, Hartigan 1975). Colours that few halves would miss are then dropped, and the others moved to the
//! mean of their halves (Lloyd 1982).

use super::{ActiveCell, ExchangeRate};
use crate::color::Srgb8;
use crate::grid::PackedInk;
use std::cmp::Reverse;

/// Largest number of colours; half as many are used if the byte limit leaves few cells to write.
// With 127 colours at every rate, a slowly moving picture never came nearer than 38 dB. With 255 at every rate, a fast
// one loses 0.5 dB, as more colours mean more changes of the pen. A colour's number takes eight bits in the results of
// `nearest_two` and in the keys of pairs.
pub(super) const MAX_COLORS: usize = 255;

/// The number of slots of the hash table of bins, a power of two.
const SLOTS: usize = 1 << 14;

/// Colours compared at a time.
const LANES: usize = 8;

#[derive(Default)]
pub(super) struct Palette {
    colors: Vec<PackedInk>,
    /// The colours in blocks, as [`Self::nearest_two`] compares them.
    blocks: Vec<Block>,
    bins: Vec<Bin>,
    /// The hash table of the bins: the index of a bin, or `u16::MAX` for an empty slot.
    slots: Vec<u16>,
    /// The bin of each half of the active cells.
    bin_of_half: Vec<u16>,
    /// The indices of the bins, the fullest first.
    fullest: Vec<u16>,
}

/// Some colours of the palette, channel by channel.
#[derive(Clone, Copy)]
struct Block {
    r: [f32; LANES],
    g: [f32; LANES],
    b: [f32; LANES],
    index: [f32; LANES],
}

impl Block {
    /// A block without colours: its entries are farther away than any colour.
    const EMPTY: Self = Self { r: [1e4; LANES], g: [1e4; LANES], b: [1e4; LANES], index: [0.0; LANES] };
}

/// The greatest distance in the units of [`Palette::nearest_two`]: 256 times a squared distance.
const FARTHEST: f32 = (1 << 24) as f32 - 256.0;

/// A bin: similar colours of halves, with their number, sum and mean.
struct Bin {
    key: u32,
    count: u32,
    sum: [u32; 3],
    mean: [i32; 3],
    nearest: [u8; 2],
}

/// The sums over all halves that have the same colour of the palette.
#[derive(Clone, Copy, Default)]
struct Share {
    count: u32,
    sum: [u32; 3],
    /// The error that dropping the colour would add.
    loss: f32,
}

impl Palette {
    /// Chooses the palette for some cells, and sets the colours nearest to their halves.
    ///
    /// `radius` is the least squared distance of two colours of the palette: the last frame's on entry, this frame's on
    /// return.
    pub(super) fn choose(&mut self, active: &mut [ActiveCell], rate: ExchangeRate, radius: &mut f32) {
        self.fill_bins(active, rate);
        self.lead(rate, radius);
        for _ in 0..2 {
            self.find_nearest();
            self.improve(rate);
        }
        self.find_nearest();
        for (cell, bins) in active.iter_mut().zip(self.bin_of_half.chunks_exact(2)) {
            cell.nearest = [0, 1].map(|half| self.bins[usize::from(bins[half])].nearest);
        }
    }

    /// Returns a colour of the palette.
    pub(super) fn color(&self, index: u8) -> PackedInk {
        self.colors[usize::from(index)]
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
        for color in active.iter().flat_map(|cell| cell.wanted) {
            let bin = self.bin(color, bits);
            let Bin { count, sum, .. } = &mut self.bins[usize::from(bin)];
            *count += 1;
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
        self.bins.push(Bin { key, count: 0, sum: [0; 3], mean: [0; 3], nearest: [0; 2] });
        bin
    }

    /// Fills the palette with means of bins, the fullest first, none within the radius of another.
    fn lead(&mut self, rate: ExchangeRate, radius: &mut f32) {
        self.fullest.clear();
        self.fullest.extend(0..self.bins.len() as u16);
        self.fullest.sort_unstable_by_key(|&bin| (Reverse(self.bins[usize::from(bin)].count), bin));
        let most = if rate > 3.0 { MAX_COLORS / 2 } else { MAX_COLORS };
        // Each try compares all bins. Starting at a quarter of the last frame's radius, which is mostly near this
        // frame's, keeps the tries few.
        *radius = rate.max(*radius / 4.0);
        // With a fixed radius the fullest bins would fill the palette, and whole regions would have no colour.
        while !self.leads_within(most, *radius) {
            *radius *= 2.0;
        }
    }

    /// Returns whether the palette has room for all bins that have no colour within the radius.
    fn leads_within(&mut self, most: usize, radius: f32) -> bool {
        self.clear();
        for at in 0..self.fullest.len() {
            let mean = self.bins[usize::from(self.fullest[at])].mean;
            if !self.colors.is_empty() && (self.nearest_two(mean)[0] >> 8) as f32 <= radius {
                continue;
            }
            if self.colors.len() == most {
                return false;
            }
            self.push(mean);
        }
        true
    }

    /// Returns the two nearest colours: squared distances times 256, plus the indices.
    // The distances are f32, whose 24 bits hold a distance and an index: with integers, SSE2 needs several instructions
    // for a multiplication or a minimum.
    fn nearest_two(&self, color: [i32; 3]) -> [u32; 2] {
        let [r, g, b] = color.map(|channel| channel as f32);
        let min = |a: f32, b: f32| if a < b { a } else { b };
        let max = |a: f32, b: f32| if a > b { a } else { b };
        let (mut first, mut second) = ([FARTHEST; LANES], [FARTHEST; LANES]);
        for block in &self.blocks {
            for lane in 0..LANES {
                let (r, g, b) = (block.r[lane] - r, block.g[lane] - g, block.b[lane] - b);
                let distance = 256.0 * min(r * r + g * g + b * b, FARTHEST / 256.0) + block.index[lane];
                second[lane] = min(second[lane], max(first[lane], distance));
                first[lane] = min(first[lane], distance);
            }
        }
        // The upper half of the lanes is merged into the lower half until one is left: merging lane by lane would take
        // a third of the time.
        let mut lanes = LANES / 2;
        while lanes > 0 {
            for lane in 0..lanes {
                let other = lane + lanes;
                second[lane] = min(min(second[lane], second[other]), max(first[lane], first[other]));
                first[lane] = min(first[lane], first[other]);
            }
            lanes /= 2;
        }
        [first[0] as u32, if second[0] < FARTHEST { second[0] } else { first[0] } as u32]
    }

    /// Removes all colours.
    fn clear(&mut self) {
        self.colors.clear();
        self.blocks.clear();
    }

    /// Adds a colour.
    fn push(&mut self, [r, g, b]: [i32; 3]) {
        let lane = self.colors.len() % LANES;
        if lane == 0 {
            self.blocks.push(Block::EMPTY);
        }
        if let Some(block) = self.blocks.last_mut() {
            (block.r[lane], block.g[lane], block.b[lane]) = (r as f32, g as f32, b as f32);
            block.index[lane] = self.colors.len() as f32;
        }
        self.colors.push(PackedInk::rgb(Srgb8::new(r as u8, g as u8, b as u8)));
    }

    fn find_nearest(&mut self) {
        for at in 0..self.bins.len() {
            let nearest = self.nearest_two(self.bins[at].mean);
            self.bins[at].nearest = nearest.map(|distance| distance as u8);
        }
    }

    /// Drops the colours without which the error grows the least, and moves the others to the mean
    /// of their halves.
    fn improve(&mut self, rate: ExchangeRate) {
        let mut shares = [Share::default(); MAX_COLORS];
        for bin in &self.bins {
            let [first, second] = bin.nearest.map(|color| self.distance(color, bin.mean));
            let share = &mut shares[usize::from(bin.nearest[0])];
            share.count += bin.count;
            for (sum, of_bin) in share.sum.iter_mut().zip(bin.sum) {
                *sum += of_bin;
            }
            share.loss += (bin.count.cast_signed() * (second - first)) as f32;
        }
        // A change of the pen to one new colour takes 15 bytes (`pen_len`).
        let is_kept = |share: &Share| share.count > 0 && share.loss >= 15.0 * rate;
        // The colour that most halves have always stays.
        let most = shares.iter().map(|share| share.count).max().unwrap_or(0);
        self.clear();
        for share in shares.iter().filter(|share| share.count > 0 && (is_kept(share) || share.count == most)) {
            self.push(share.sum.map(|sum| ((sum + share.count / 2) / share.count).cast_signed()));
        }
    }

    fn distance(&self, color: u8, mean: [i32; 3]) -> i32 {
        self.color(color)
            .channels()
            .into_iter()
            .zip(mean)
            .map(|(channel, mean)| (i32::from(channel) - mean).pow(2))
            .sum()
    }
}
