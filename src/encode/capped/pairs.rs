//! The pairs of colours of a frame under a limit, and the choice of a pair for each cell.

use super::colors::MAX_COLORS;
use super::pair_colors::{KEYS, PairColors, glyph_len, is_flat};
use super::runs::Runs;
use super::{ActiveCell, ExchangeRate, WrittenCell, channels, error, square};
use crate::color::Srgb8;
use crate::grid::{HalfBlocks, PackedInk};
use std::cmp::Ordering;

/// The index that marks the end of a linked list of [`Way`]s.
const END: u32 = u32::MAX;

/// A way to write a cell, with a certain pair; the ways of a pair form a linked list.
struct Way {
    /// The cell's index among the active ones.
    cell: u32,
    cost: f32,
    /// The index of the next way with the same pair.
    next: u32,
}

/// The number of bytes, beyond those of a glyph, that the gain of a vacated cell is worth: more
/// than a change of the pen.
const VACATED_WORTH: f32 = 40.0;

/// The ways to write cells with a pair, and whether the pair is open.
#[derive(Clone, Copy)]
struct Pair {
    /// The cost that all the pair's ways would save if no other pair were open.
    saving: f32,
    /// The index of the first way.
    first: u32,
    /// The rank of the pair among the open ones, from 0 for the best; `u16::MAX` for other pairs.
    rank: u16,
}

const UNUSED: Pair = Pair { saving: 0.0, first: END, rank: u16::MAX };

/// A pair with which cells are written.
#[derive(Clone, Copy)]
struct OpenPair {
    key: u16,
    /// The error that is removed from the pair's cells.
    gain: f32,
    bytes: f32,
    /// Whether any of the pair's cells is vacated.
    has_vacated: bool,
}

impl OpenPair {
    /// Compares ranks: pairs with vacated cells are first, then those that gain the most per byte.
    // Quotients are compared: with cross-multiplied products the order would not be total. Those of pairs that gain
    // nearly the same, as vacated cells do, are rounded so that three pairs can form a cycle, and sorting may then
    // panic.
    fn cmp_rank(&self, other: &Self) -> Ordering {
        let gain_per_byte = |pair: &Self| pair.gain / pair.bytes;
        let by_gain = gain_per_byte(other).total_cmp(&gain_per_byte(self));
        other.has_vacated.cmp(&self.has_vacated).then(by_gain).then(self.key.cmp(&other.key))
    }
}

#[derive(Default)]
pub(super) struct Pairs {
    ways: Vec<Way>,
    /// The pairs by key.
    table: Vec<Pair>,
    /// The keys of the pairs that have a way.
    used: Vec<u16>,
    open: Vec<OpenPair>,
    runs: Runs,
}

impl Pairs {
    /// Chooses the pair of each cell.
    pub(super) fn choose(&mut self, active: &mut [ActiveCell], colors: &PairColors<'_>, columns: usize) {
        self.collect_ways(active, colors);
        self.open_pairs(active, colors.rate);
        self.runs.choose(active, colors, columns);
        self.rank_pairs(active, colors);
    }

    /// Lists the cells of the first `ranks` pairs and all vacated cells, each colour the mean of
    /// the halves sharing it.
    pub(super) fn list_cells(&self, active: &[ActiveCell], ranks: usize, cells: &mut Vec<WrittenCell>) {
        cells.clear();
        let mut sums = [[0_u32; 4]; MAX_COLORS];
        let is_written = |key: u16| usize::from(self.table[usize::from(key)].rank) < ranks;
        let shown = |cell: &ActiveCell| cell.pair.filter(|&key| cell.is_vacated || is_written(key)).map(|_| cell.shown);
        for (cell, shown) in active.iter().filter_map(|cell| Some((cell, shown(cell)?))) {
            for (color, wanted) in shown.into_iter().zip(cell.wanted) {
                let [r, g, b] = wanted.channels();
                for (sum, value) in sums[usize::from(color)].iter_mut().zip([r, g, b, 1]) {
                    *sum += u32::from(value);
                }
            }
        }
        let means = sums.map(|[r, g, b, count]| {
            let [r, g, b] = [r, g, b].map(|sum| ((sum + count / 2) / count.max(1)) as u8);
            Srgb8 { r, g, b }
        });
        for (cell, shown) in active.iter().filter_map(|cell| Some((cell, shown(cell)?))) {
            let halves = shown.map(|color| PackedInk::rgb(means[usize::from(color)]));
            // The mean is best for all cells that share it, but a single cell may be farther from it than from what it
            // shows, and would raise the error of the frame if the limit left out the others.
            if cell.is_vacated || cell.weight * error(halves.map(channels), cell.channels) < cell.stay {
                cells.push(WrittenCell { at: cell.at, halves });
            }
        }
    }

    /// Returns the number of ranks: one for each open pair.
    pub(super) fn ranks(&self) -> usize {
        self.open.len()
    }

    /// Returns whether any open pair has a vacated cell.
    pub(super) fn has_vacated(&self) -> bool {
        self.open.iter().any(|open| open.has_vacated)
    }

    /// Returns how many of the best pairs take a share of the bytes of the best `ranks` pairs.
    ///
    /// The number is less than `ranks`.
    pub(super) fn ranks_within_bytes(&self, ranks: usize, share_of_bytes: f32) -> usize {
        let bytes = |open: &[OpenPair]| open.iter().map(|open| open.bytes).sum::<f32>();
        // The bytes of the pairs are estimates. With one per cent less, the frame made of the pairs found here hardly
        // ever exceeds its limit again.
        let mut left = 0.99 * share_of_bytes * bytes(&self.open[..ranks]);
        let fits = |open: &&OpenPair| {
            left -= open.bytes;
            left >= 0.0
        };
        self.open[..ranks - 1].iter().take_while(fits).count()
    }

    /// Offers each cell the pairs of the colours near its halves.
    fn collect_ways(&mut self, active: &mut [ActiveCell], colors: &PairColors<'_>) {
        self.ways.clear();
        self.table.resize(KEYS, UNUSED);
        for key in self.used.drain(..) {
            self.table[usize::from(key)] = UNUSED;
        }
        for (at, cell) in active.iter_mut().enumerate() {
            let [upper, lower] = cell.nearest;
            let near = [upper[0], upper[1], lower[0], lower[1]];
            // Each half's weighted squared difference from each of the four near colours, from which the errors of all
            // pairs follow.
            let near_channels = near.map(|color| colors.palette.color(color));
            let squares = cell.channels.map(|half| near_channels.map(|color| cell.weight * square(color, half)));
            let is_new = |place: usize| !near[..place].contains(&near[place]);
            if cell.is_vacated {
                // The cheapest pair of the nearest colours pays for itself.
                let [a, b] = [upper[0], lower[0]];
                let key = colors.key(a, b);
                cell.stay = colors.cheapest(key, cell).0 + colors.rate * (key_len(key) + VACATED_WORTH);
                cell.cost = cell.stay;
            }
            for a in 0..4 {
                if is_new(a) {
                    self.offer(at, cell.stay, colors.key(near[a], near[a]), squares[0][a] + squares[1][a], colors.rate);
                }
            }
            for a in 0..distinct(&upper).len() {
                for b in 2..2 + distinct(&lower).len() {
                    // If cells may use either half block, (a, b) and (b, a) have the same key, and are offered once.
                    let is_mirrored = colors.half_blocks == HalfBlocks::Either
                        && near[a] > near[b]
                        && lower.contains(&near[a])
                        && upper.contains(&near[b]);
                    if near[a] == near[b] || is_mirrored {
                        continue;
                    }
                    let plain = squares[0][a] + squares[1][b];
                    let flipped = squares[0][b] + squares[1][a];
                    let error = if colors.half_blocks == HalfBlocks::Either { plain.min(flipped) } else { plain };
                    self.offer(at, cell.stay, colors.key(near[a], near[b]), error, colors.rate);
                }
            }
        }
    }

    /// Adds a way to write a cell, unless it costs more than the error if the cell stays.
    fn offer(&mut self, at: usize, stay: f32, key: u16, error: f32, rate: ExchangeRate) {
        let cost = error + rate * key_len(key);
        if cost >= stay {
            return;
        }
        let pair = &mut self.table[usize::from(key)];
        if pair.first == END {
            self.used.push(key);
        }
        pair.saving += stay - cost;
        self.ways.push(Way { cell: at as u32, cost, next: pair.first });
        pair.first = self.ways.len() as u32 - 1;
    }

    /// Opens the pairs that save more than their change of the pen costs, the best first, and gives
    /// each cell the cheapest.
    fn open_pairs(&mut self, active: &mut [ActiveCell], rate: ExchangeRate) {
        let Self { ways, table, used, .. } = self;
        // The key decides between equal savings, so that the frame does not depend on the order of sorting.
        used.sort_unstable_by(|&a, &b| {
            table[usize::from(b)].saving.total_cmp(&table[usize::from(a)].saving).then(a.cmp(&b))
        });
        for &key in used.iter() {
            let pair = table[usize::from(key)];
            let price = rate * pen_len(key);
            // A pair saves at most `saving`, and less once other pairs are open. Later pairs have no larger `saving`,
            // so none of them pays either.
            if pair.saving <= price {
                break;
            }
            let list = || std::iter::successors(ways.get(pair.first as usize), |way| ways.get(way.next as usize));
            let saving: f32 = list().map(|way| (active[way.cell as usize].cost - way.cost).max(0.0)).sum();
            if saving <= price {
                continue;
            }
            for way in list() {
                let cell = &mut active[way.cell as usize];
                if way.cost < cell.cost {
                    (cell.cost, cell.pair) = (way.cost, Some(key));
                }
            }
        }
    }

    /// Gives up pairs that no longer pay for their pen, and ranks the others by what they gain per
    /// byte.
    fn rank_pairs(&mut self, active: &mut [ActiveCell], colors: &PairColors<'_>) {
        self.open.clear();
        for cell in active.iter_mut() {
            let Some(key) = cell.pair else { continue };
            let (error, shown) = colors.cheapest(key, cell);
            cell.shown = shown;
            let pair = &mut self.table[usize::from(key)];
            if pair.rank == u16::MAX {
                pair.rank = self.open.len() as u16;
                self.open.push(OpenPair { key, gain: 0.0, bytes: pen_len(key), has_vacated: false });
            }
            let open = &mut self.open[usize::from(pair.rank)];
            open.gain += cell.stay - error;
            open.has_vacated |= cell.is_vacated;
            open.bytes += (cell.cost - error) / colors.rate;
        }
        self.open.sort_unstable_by(OpenPair::cmp_rank);
        for open in &self.open {
            self.table[usize::from(open.key)].rank = u16::MAX;
        }
        let pays = |open: &OpenPair| open.gain >= colors.rate * (open.bytes - 0.2 * pen_len(open.key));
        self.open.retain(|open| open.has_vacated || pays(open));
        for (rank, open) in (0..).zip(&self.open) {
            self.table[usize::from(open.key)].rank = rank;
        }
        for cell in active.iter_mut() {
            cell.pair = cell.pair.filter(|&key| self.table[usize::from(key)].rank != u16::MAX);
        }
    }
}

/// Returns the two colours, or one if they are the same.
fn distinct(colors: &[u8; 2]) -> &[u8] {
    if colors[0] == colors[1] { &colors[..1] } else { colors }
}

/// Returns the mean number of bytes of a glyph and the move to its cell.
fn key_len(key: u16) -> f32 {
    glyph_len(key) + move_len(key)
}

/// Returns the mean number of bytes of a move to a cell.
fn move_len(key: u16) -> f32 {
    if is_flat(key) { 2.0 } else { 3.0 }
}

/// Returns the mean number of bytes of a change of the pen.
fn pen_len(key: u16) -> f32 {
    // Prices that are off by 40 % change the PSNR by at most 0.2 dB.
    if is_flat(key) { 15.0 } else { 17.0 }
}

#[cfg(all(test, unit_tests))]
mod tests;
