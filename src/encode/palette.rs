//! Reduction of the number of colours in a lossy frame, within the tolerance.
//!
//! A palette is chosen by greedy set cover (Johnson 1974): first the colour that most half cells can take, then the one
//! that most of the remaining half cells can take, and so on. Pairs of palette colours are then chosen in the same way,
//! because all cells of one pair are written without a change of the pen.
//!
//! All lists are in memory that is kept from frame to frame, and nothing large is sorted by comparison: with a vector
//! for each colour and such sorts, these took more than half of the time of a frame.

use super::eights::{ColorList, NEIGHBOURS};
use super::halves::{Halves, Tolerance, squared_differences};
use super::numbering::Numbering;
use crate::grid::{HalfBlocks, PackedInk};

/// Largest number of palette colours that are considered for a half cell.
// More would hardly save bytes, and the number of possible pairs grows with the square.
const MAX_CHOICES: usize = 4;

/// The number of steps of lightness by which colours are sorted.
const LIGHTNESS_STEPS: usize = 4096;

/// The number that marks the end of a linked list.
const NONE: u32 = u32::MAX;

/// The working memory of the reduction of colours.
#[derive(Default)]
pub(super) struct Reduction {
    /// The distinct colours of the cells and of the pen, in the order in which they are found.
    found: Numbering<PackedInk>,
    found_colors: ColorList,
    /// The index in `colors` of each found colour; at first the step of its lightness.
    places: Vec<u32>,
    /// The distinct colours, sorted by the steps of their lightness.
    inks: Vec<PackedInk>,
    colors: ColorList,
    /// The number of halves that want each colour.
    halves: Vec<u32>,
    /// The index of the colour that each half wants.
    wanted: Vec<u32>,
    /// The colours within the tolerance of each other.
    near: Bands,
    /// The palette colours that may replace each colour, those that replace the most halves first.
    choices: Vec<Choices>,
    possible: Vec<PossiblePair>,
    /// Working memory for sorting `possible`.
    sorted: Vec<PossiblePair>,
    counts: Vec<u32>,
    /// The pairs that several cells can show, and these cells.
    pairs: Vec<[u32; 2]>,
    cells_of_pairs: AnySets,
    /// The pair of each cell.
    chosen: Vec<[u32; 2]>,
    cover: Cover,
}

/// The palette colours that may replace a colour.
#[derive(Clone, Copy, Default)]
struct Choices {
    colors: [u32; MAX_CHOICES],
    len: u8,
}

impl Choices {
    fn as_slice(&self) -> &[u32] {
        &self.colors[..usize::from(self.len)]
    }
}

/// A pair of colours that a cell can show.
#[derive(Clone, Copy, Default, PartialEq, Eq)]
struct PossiblePair {
    colors: [u32; 2],
    cell: u32,
}

impl Reduction {
    /// Chooses a palette, and lists for each cell the palette colours that replace its colours,
    /// within the tolerance.
    ///
    /// With [`HalfBlocks::Either`] a pair of colours counts as the same pair in either order. The pen's colours are
    /// also candidates for the palette.
    pub(super) fn snap(
        &mut self,
        cells: &[Halves],
        pen: [PackedInk; 2],
        tolerance: Tolerance,
        half_blocks: HalfBlocks,
        snapped: &mut Vec<Halves>,
    ) {
        self.list_colors(cells, pen);
        // OKLab distance is at least the difference in lightness, so only neighbours in an order by lightness are
        // compared.
        self.colors.compare_with_following(tolerance, &mut self.near.after);
        self.choose_colors();
        self.list_possible_pairs(half_blocks);
        self.choose_pairs(cells.len());
        snapped.clear();
        snapped.extend(cells.iter().enumerate().map(|(at, &cell)| self.snapped(at, cell, half_blocks)));
    }

    /// Returns the palette colours of the cell at index `at`, exchanged if that is more exact.
    fn snapped(&self, at: usize, cell: Halves, half_blocks: HalfBlocks) -> Halves {
        let pair = self.chosen[at];
        let [a, b] = pair.map(|index| self.inks[index as usize]);
        let choices = |half: usize| &self.choices[self.wanted[2 * at + half] as usize];
        let fits = |pair: [u32; 2]| (0..2).all(|half| choices(half).as_slice().contains(&pair[half]));
        let error = |halves: Halves| squared_differences(halves, cell).iter().sum::<u32>();
        let flipped = half_blocks == HalfBlocks::Either
            && fits([pair[1], pair[0]])
            && (!fits(pair) || error([b, a]) < error([a, b]));
        if flipped { [b, a] } else { [a, b] }
    }

    /// Lists the distinct colours, and the index of the one that each half wants.
    fn list_colors(&mut self, cells: &[Halves], pen: [PackedInk; 2]) {
        let Self { found, found_colors, places, inks, colors, halves, wanted, counts, .. } = self;
        found.clear(2 * cells.len() + pen.len());
        wanted.clear();
        wanted.extend(cells.iter().flatten().map(|&ink| found.add(ink) as u32));
        pen.into_iter().filter(|ink| ink.is_rgb()).for_each(|ink| _ = found.add(ink));
        found_colors.fill(found.keys());
        places.clear();
        counts.clear();
        counts.resize(LIGHTNESS_STEPS + 1, 0);
        for lightness in found_colors.lightness() {
            let step = ((lightness * LIGHTNESS_STEPS as f32) as usize).min(LIGHTNESS_STEPS - 1);
            places.push(step as u32);
            counts[step + 1] += 1;
        }
        sum_up(counts);
        inks.clear();
        inks.resize(places.len(), PackedInk::DEFAULT);
        colors.resize(places.len());
        for (at, (place, &ink)) in places.iter_mut().zip(found.keys()).enumerate() {
            let next = &mut counts[*place as usize];
            (*place, *next) = (*next, *next + 1);
            inks[*place as usize] = ink;
            colors.copy(*place as usize, found_colors, at);
        }
        halves.clear();
        halves.resize(places.len(), 0);
        for color in wanted {
            *color = places[*color as usize];
            halves[*color as usize] += 1;
        }
    }

    /// Chooses the palette, and for each colour the palette colours that may replace it.
    fn choose_colors(&mut self) {
        let Self { near, inks, halves, choices, cover, .. } = self;
        choices.clear();
        choices.resize(inks.len(), Choices::default());
        near.fill_masks_and_weigh(halves, &mut cover.gains);
        cover.choose(near, halves, |color, half, _| {
            let choices = &mut choices[half];
            if usize::from(choices.len) < MAX_CHOICES {
                choices.colors[usize::from(choices.len)] = color as u32;
                choices.len += 1;
            }
        });
    }

    /// Lists the pairs of palette colours for each cell, sorted by pair and then by cell.
    fn list_possible_pairs(&mut self, half_blocks: HalfBlocks) {
        self.possible.clear();
        for (cell, halves) in (0..).zip(self.wanted.as_chunks::<2>().0) {
            let [upper, lower] = halves.map(|half| &self.choices[half as usize]);
            for &a in upper.as_slice() {
                for &b in lower.as_slice() {
                    let colors = if half_blocks == HalfBlocks::Either { [a.min(b), a.max(b)] } else { [a, b] };
                    self.possible.push(PossiblePair { colors, cell });
                }
            }
        }
        // The list is in ascending order of cells already, and counting sorts are stable.
        self.sort_possible_by::<1>();
        self.sort_possible_by::<0>();
        self.possible.dedup();
    }

    /// Sorts the possible pairs by the colour at index `PLACE`; the sort is stable.
    fn sort_possible_by<const PLACE: usize>(&mut self) {
        let Self { possible, sorted, counts, inks, .. } = self;
        counts.clear();
        counts.resize(inks.len() + 1, 0);
        for pair in possible.iter() {
            counts[pair.colors[PLACE] as usize + 1] += 1;
        }
        sum_up(counts);
        sorted.clear();
        sorted.resize(possible.len(), PossiblePair::default());
        for &pair in possible.iter() {
            let place = &mut counts[pair.colors[PLACE] as usize];
            sorted[*place as usize] = pair;
            *place += 1;
        }
        std::mem::swap(possible, sorted);
    }

    /// Chooses the pair of each cell, using few distinct pairs.
    fn choose_pairs(&mut self, cell_count: usize) {
        let Self { possible, pairs, cells_of_pairs, chosen, wanted, choices, halves, cover, .. } = self;
        pairs.clear();
        cells_of_pairs.members.clear();
        cover.gains.clear();
        // A pair that only one cell can show saves nothing.
        for same in possible.chunk_by(|a, b| a.colors == b.colors).filter(|same| same.len() > 1) {
            pairs.push(same[0].colors);
            cells_of_pairs.members.push(same.iter().map(|pair| pair.cell));
            cover.gains.push(same.len() as u32);
        }
        cells_of_pairs.index(cell_count);
        // A cell without a shared pair takes, for each half, the colour that the most halves can take.
        chosen.clear();
        chosen.extend(wanted.chunks_exact(2).map(|cell| [0, 1].map(|half| choices[cell[half] as usize].colors[0])));
        halves.clear();
        halves.resize(cell_count, 1);
        cover.choose(cells_of_pairs, halves, |pair, cell, is_left| {
            if is_left {
                chosen[cell] = pairs[pair];
            }
        });
    }
}

/// Replaces each number by the sum of all numbers up to and including it.
fn sum_up(counts: &mut [u32]) {
    let mut sum = 0;
    for count in counts {
        sum += *count;
        *count = sum;
    }
}

/// Sets of numbers.
trait Sets {
    /// Returns the numbers in a set.
    fn members(&self, set: usize) -> impl Iterator<Item = usize>;

    /// Subtracts a weight from those numbers in `sums` whose sets contain `member`.
    fn subtract(&self, member: usize, weight: u32, sums: &mut [u32]);
}

/// Any sets.
#[derive(Default)]
struct AnySets {
    members: Lists,
    /// For each number, the indices of the sets that contain it.
    sets_with: Lists,
}

impl AnySets {
    /// Lists the sets that contain each number below `count`.
    fn index(&mut self, count: usize) {
        let Self { members, sets_with } = self;
        // `ends` first has the number of sets that contain each number, then the start of each list, which moves to the
        // end with each added set.
        sets_with.ends.clear();
        sets_with.ends.resize(count + 1, 0);
        for &member in &members.items {
            sets_with.ends[member as usize + 1] += 1;
        }
        sum_up(&mut sets_with.ends);
        sets_with.items.clear();
        sets_with.items.resize(members.items.len(), 0);
        for set in 0..members.ends.len() {
            for member in members.list(set) {
                let end = &mut sets_with.ends[member];
                sets_with.items[*end as usize] = set as u32;
                *end += 1;
            }
        }
    }
}

impl Sets for AnySets {
    fn members(&self, set: usize) -> impl Iterator<Item = usize> {
        self.members.list(set)
    }

    fn subtract(&self, member: usize, weight: u32, sums: &mut [u32]) {
        self.sets_with.list(member).for_each(|set| sums[set] -= weight);
    }
}

/// Lists of numbers, one after another in a single vector.
#[derive(Default)]
struct Lists {
    items: Vec<u32>,
    /// The end of each list in `items`.
    ends: Vec<u32>,
}

impl Lists {
    fn clear(&mut self) {
        self.items.clear();
        self.ends.clear();
    }

    fn push(&mut self, items: impl Iterator<Item = u32>) {
        self.items.extend(items);
        self.ends.push(self.items.len() as u32);
    }

    fn list(&self, at: usize) -> impl Iterator<Item = usize> {
        let start = at.checked_sub(1).map_or(0, |before| self.ends[before]);
        self.items[start as usize..self.ends[at] as usize].iter().map(|&item| item as usize)
    }
}

/// A set of neighbours for each number, which contains the number itself.
#[derive(Default)]
struct Bands {
    /// The masks of the neighbours after each number, of which there are at most [`NEIGHBOURS`].
    after: Vec<u32>,
    /// The masks of all neighbours, from [`NEIGHBOURS`] before each number.
    masks: Vec<u64>,
}

impl Bands {
    /// Fills in the masks of all neighbours, and lists the weight of each set.
    fn fill_masks_and_weigh(&mut self, weights: &[u32], sums: &mut Vec<u32>) {
        let Self { after, masks } = self;
        masks.clear();
        masks.extend(after.iter().map(|&mask| (u64::from(mask) << 1 | 1) << NEIGHBOURS));
        sums.clear();
        sums.extend_from_slice(weights);
        for (at, &mask) in after.iter().enumerate() {
            let (masks, next_sums, next_weights) = (&mut masks[at..], &mut sums[at..], &weights[at..]);
            let mut sum = 0;
            for bit in bits(mask.into()) {
                masks[bit + 1] |= 1 << NEIGHBOURS >> (bit + 1);
                next_sums[bit + 1] += weights[at];
                sum += next_weights[bit + 1];
            }
            sums[at] += sum;
        }
    }
}

impl Sets for Bands {
    fn members(&self, set: usize) -> impl Iterator<Item = usize> {
        bits(self.masks[set]).map(move |bit| set + bit - NEIGHBOURS as usize)
    }

    // Neighbours are mutual, so the sets that contain `member` are those of its neighbours.
    fn subtract(&self, member: usize, weight: u32, sums: &mut [u32]) {
        let start = member.checked_sub(NEIGHBOURS as usize);
        let Some(window) = start.and_then(|start| sums.get_mut(start..start + 13 * 4)) else {
            return self.members(member).for_each(|set| sums[set] -= weight);
        };
        // Without a loop over bits, whose end would be mispredicted.
        let mut mask = self.masks[member];
        for sums in window.as_chunks_mut::<4>().0 {
            for (lane, sum) in sums.iter_mut().enumerate() {
                *sum -= if mask as u32 & 1 << lane == 0 { 0 } else { weight };
            }
            mask >>= 4;
        }
    }
}

/// Returns the places of the bits that are set, the lowest first.
fn bits(mut mask: u64) -> impl Iterator<Item = usize> {
    std::iter::from_fn(move || {
        let lowest = (mask != 0).then(|| mask.trailing_zeros() as usize);
        mask &= mask.wrapping_sub(1);
        lowest
    })
}

/// The working memory of a greedy cover.
// A queue of buckets, one for each gain, in place of a heap: gains only shrink, so that each bucket is complete once
// those above it are done (Minoux 1978).
#[derive(Default)]
struct Cover {
    /// The weight of each set's members that are not covered.
    gains: Vec<u32>,
    /// For each gain, the first set in its bucket; [`NONE`] if the bucket is empty.
    ///
    /// A set is in the bucket of the gain that it had when it was put there.
    heads: Vec<u32>,
    /// For each set, the next one in its bucket; [`NONE`] for the last.
    next: Vec<u32>,
    /// The sets of the bucket that is being emptied, in ascending order.
    bucket: Vec<u32>,
}

impl Cover {
    /// Chooses sets that together cover all members, greedily by the weight of members not yet
    /// covered.
    ///
    /// `gains` must have the weight of each set. Among sets of equal weight, the first one is chosen. For each member
    /// of a chosen set, calls `take` with the set, the member, and whether the member was uncovered; then sets the
    /// member's weight to 0.
    fn choose(&mut self, sets: &impl Sets, left: &mut [u32], mut take: impl FnMut(usize, usize, bool)) {
        let most = self.gains.iter().copied().max().unwrap_or(0);
        self.heads.clear();
        self.heads.resize(most as usize + 1, NONE);
        self.next.clear();
        self.next.resize(self.gains.len(), NONE);
        // In reverse, so that the buckets are in ascending order.
        (0..self.gains.len()).rev().for_each(|set| self.push(set));
        for promised in (1..=most).rev() {
            self.collect_bucket(promised);
            for at in 0..self.bucket.len() {
                let set = self.bucket[at] as usize;
                if self.gains[set] < promised {
                    self.push(set);
                    continue;
                }
                for member in sets.members(set) {
                    let weight = std::mem::take(&mut left[member]);
                    take(set, member, weight > 0);
                    if weight > 0 {
                        sets.subtract(member, weight, &mut self.gains);
                    }
                }
            }
        }
    }

    /// Puts a set into the bucket of its gain.
    fn push(&mut self, set: usize) {
        self.next[set] = std::mem::replace(&mut self.heads[self.gains[set] as usize], set as u32);
    }

    /// Collects a bucket's sets in `self.bucket`, in ascending order.
    fn collect_bucket(&mut self, gain: u32) {
        self.bucket.clear();
        let mut set = self.heads[gain as usize];
        while set != NONE {
            self.bucket.push(set);
            set = self.next[set as usize];
        }
        self.bucket.sort_unstable();
    }
}
