//! Reduction of the number of colours in a lossy frame, within the tolerance.
//!
//! A palette is chosen by greedy set cover (Johnson 1974): first the colour that most half cells can take, then the one
//! that most of the remaining half cells can take, and so on. Pairs of palette colours are then chosen in the same way,
//! because all cells of one pair are written without a change of the pen.
//!
//! All lists are in memory that is kept from frame to frame, and nothing large is sorted by comparison: with a vector
//! for each colour and such sorts, these took more than half of the time of a frame.

use super::halves::{Halves, Tolerance, squared_difference};
use super::numbering::Numbering;
use crate::color::{Oklab, Srgb8};
use crate::grid::{HalfBlocks, PackedInk};
use std::ops::Range;

/// Largest number of palette colours that are considered for a half cell.
// More would hardly save bytes, and the number of possible pairs grows with the square.
const MAX_CHOICES: usize = 4;

/// Number of colours, nearest in lightness on either side, with which each colour is compared.
// In pictures, nearly all colours within the tolerance are among these. In noise many more are within it: without this
// limit and two others, a frame of noise took 192 times ratatui's time; with them it takes 21 times.
const LIGHTNESS_NEIGHBOURS: usize = 24;

/// The number of steps of lightness by which colours are sorted.
const LIGHTNESS_STEPS: usize = 4096;

/// The number that marks the end of a linked list.
const NONE: u32 = u32::MAX;

/// The working memory of the reduction.
#[derive(Default)]
pub(super) struct Reduction {
    /// The distinct colours of the cells and of the pen, in the order in which they are found.
    found: Numbering,
    found_oklab: Vec<Oklab>,
    /// The index in `colors` of each found colour; at first the step of its lightness.
    places: Vec<u32>,
    /// The distinct colours, sorted by the steps of their lightness.
    colors: Vec<Srgb8>,
    oklab: Vec<Oklab>,
    /// The number of halves that want each colour.
    halves: Vec<u32>,
    /// The index of the colour that each half wants.
    wanted: Vec<u32>,
    /// Two colours within the tolerance of each other.
    near: Vec<[u32; 2]>,
    /// The palette colours that may replace each colour, those that replace the most halves first.
    choices: Vec<Choices>,
    possible: Vec<PossiblePair>,
    /// Working memory for sorting `possible`.
    sorted: Vec<PossiblePair>,
    counts: Vec<u32>,
    /// The pairs that several cells can show.
    pairs: Vec<[u32; 2]>,
    /// The pair of each cell.
    chosen: Vec<[u32; 2]>,
    sets: Sets,
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
    /// Replaces the cells' colours by palette colours within the tolerance.
    ///
    /// With [`HalfBlocks::Either`] a pair of colours counts as the same pair in either order. The pen's colours are
    /// also candidates for the palette.
    pub(super) fn snap(
        &mut self,
        cells: &mut [Halves],
        pen: [PackedInk; 2],
        tolerance: Tolerance,
        half_blocks: HalfBlocks,
    ) {
        self.list_colors(cells, pen);
        self.find_near(tolerance);
        self.choose_colors();
        self.list_possible_pairs(cells.len(), half_blocks);
        self.choose_pairs(cells.len());
        for (at, cell) in cells.iter_mut().enumerate() {
            *cell = self.snapped(at, *cell, half_blocks);
        }
    }

    /// Returns the palette colours of the cell at index `at`, exchanged if that is more exact.
    fn snapped(&self, at: usize, cell: Halves, half_blocks: HalfBlocks) -> Halves {
        let pair = self.chosen[at];
        let [a, b] = pair.map(|index| self.colors[index as usize]);
        let choices = |half: usize| &self.choices[self.wanted[2 * at + half] as usize];
        let fits = |pair: [u32; 2]| (0..2).all(|half| choices(half).as_slice().contains(&pair[half]));
        let error = |halves: Halves| squared_difference(halves[0], cell[0]) + squared_difference(halves[1], cell[1]);
        let flipped = half_blocks == HalfBlocks::Either
            && fits([pair[1], pair[0]])
            && (!fits(pair) || error([b, a]) < error([a, b]));
        if flipped { [b, a] } else { [a, b] }
    }

    /// Lists the distinct colours, and the index of the one that each half wants.
    fn list_colors(&mut self, cells: &[Halves], pen: [PackedInk; 2]) {
        let Self { found, found_oklab, places, colors, oklab, halves, wanted, counts, .. } = self;
        let key = |Srgb8 { r, g, b }| u64::from(u32::from_be_bytes([0, r, g, b]));
        found.clear(2 * cells.len() + pen.len());
        wanted.clear();
        wanted.extend(cells.iter().flatten().map(|&color| found.add(key(color)) as u32));
        pen.into_iter().filter_map(PackedInk::color).for_each(|color| _ = found.add(key(color)));
        let of_key = |&key: &u64| {
            let [_, r, g, b] = (key as u32).to_be_bytes();
            Srgb8 { r, g, b }
        };
        found_oklab.clear();
        found_oklab.extend(found.keys().iter().map(of_key).map(Oklab::near_srgb8));
        places.clear();
        counts.clear();
        counts.resize(LIGHTNESS_STEPS + 1, 0);
        for &Oklab { l, .. } in found_oklab.iter() {
            let step = ((l * LIGHTNESS_STEPS as f32) as usize).min(LIGHTNESS_STEPS - 1);
            places.push(step as u32);
            counts[step + 1] += 1;
        }
        sum_up(counts);
        colors.clear();
        colors.resize(places.len(), Srgb8::new(0, 0, 0));
        oklab.clear();
        oklab.resize(places.len(), Oklab::default());
        for ((place, key), &lab) in places.iter_mut().zip(found.keys()).zip(found_oklab.iter()) {
            let next = &mut counts[*place as usize];
            (colors[*next as usize], oklab[*next as usize]) = (of_key(key), lab);
            (*place, *next) = (*next, *next + 1);
        }
        halves.clear();
        halves.resize(places.len(), 0);
        for color in wanted {
            *color = places[*color as usize];
            halves[*color as usize] += 1;
        }
    }

    /// Lists the pairs of colours within the tolerance of each other.
    // OKLab distance is at least the difference in lightness, so only neighbours in an order by lightness are compared.
    fn find_near(&mut self, tolerance: Tolerance) {
        let Self { near, colors, oklab, .. } = self;
        near.clear();
        for (a, (&color, &lab)) in colors.iter().zip(oklab.iter()).enumerate() {
            // One step of lightness more, because the colours of a step are not sorted.
            let lightest = lab.l + tolerance.distance + 1.0 / LIGHTNESS_STEPS as f32;
            let others = (a + 1..colors.len()).take(LIGHTNESS_NEIGHBOURS);
            for b in others.take_while(|&b| oklab[b].l <= lightest) {
                if tolerance.is_near(lab, oklab[b]) && squared_difference(color, colors[b]) <= tolerance.square {
                    near.push([a as u32, b as u32]);
                }
            }
        }
    }

    /// Chooses the palette, and for each colour the palette colours that may replace it.
    fn choose_colors(&mut self) {
        let Self { near, colors, halves, choices, sets, cover, .. } = self;
        sets.fill_symmetric(colors.len(), near);
        choices.clear();
        choices.resize(colors.len(), Choices::default());
        cover.choose(sets, halves, |color, members, _| {
            for &half in members {
                let choices = &mut choices[half as usize];
                if usize::from(choices.len) < MAX_CHOICES {
                    choices.colors[usize::from(choices.len)] = color as u32;
                    choices.len += 1;
                }
            }
        });
    }

    /// Lists the pairs of palette colours for each cell, sorted by pair and then by cell.
    fn list_possible_pairs(&mut self, cell_count: usize, half_blocks: HalfBlocks) {
        self.possible.clear();
        for cell in 0..cell_count {
            let [upper, lower] = [0, 1].map(|half| self.choices[self.wanted[2 * cell + half] as usize]);
            for &a in upper.as_slice() {
                for &b in lower.as_slice() {
                    let colors = if half_blocks == HalfBlocks::Either { [a.min(b), a.max(b)] } else { [a, b] };
                    self.possible.push(PossiblePair { colors, cell: cell as u32 });
                }
            }
        }
        // The list is in ascending order of cells already, and counting sorts are stable.
        self.sort_possible_by(1);
        self.sort_possible_by(0);
        self.possible.dedup();
    }

    /// Sorts the possible pairs by the colour at index `place`; the sort is stable.
    fn sort_possible_by(&mut self, place: usize) {
        let Self { possible, sorted, counts, colors, .. } = self;
        counts.clear();
        counts.resize(colors.len() + 1, 0);
        for pair in possible.iter() {
            counts[pair.colors[place] as usize + 1] += 1;
        }
        sum_up(counts);
        sorted.clear();
        sorted.resize(possible.len(), PossiblePair::default());
        for &pair in possible.iter() {
            let place = &mut counts[pair.colors[place] as usize];
            sorted[*place as usize] = pair;
            *place += 1;
        }
        std::mem::swap(possible, sorted);
    }

    /// Chooses the pair of each cell, using few distinct pairs.
    fn choose_pairs(&mut self, cell_count: usize) {
        let Self { possible, pairs, chosen, wanted, choices, halves, sets, cover, .. } = self;
        pairs.clear();
        sets.clear();
        // A pair that only one cell can show saves nothing.
        for same in possible.chunk_by(|a, b| a.colors == b.colors).filter(|same| same.len() > 1) {
            pairs.push(same[0].colors);
            sets.push(same.iter().map(|pair| pair.cell));
        }
        // A cell without a shared pair takes, for each half, the colour that the most halves can take.
        chosen.clear();
        chosen.extend(wanted.chunks_exact(2).map(|cell| [0, 1].map(|half| choices[cell[half] as usize].colors[0])));
        halves.clear();
        halves.resize(cell_count, 1);
        cover.choose(sets, halves, |pair, cells, left| {
            for &cell in cells.iter().filter(|&&cell| left[cell as usize] > 0) {
                chosen[cell as usize] = pairs[pair];
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

/// Sets of numbers, in one list.
#[derive(Default)]
struct Sets {
    members: Vec<u32>,
    /// The end of each set in `members`.
    ends: Vec<u32>,
}

impl Sets {
    fn clear(&mut self) {
        self.members.clear();
        self.ends.clear();
    }

    fn push(&mut self, members: impl Iterator<Item = u32>) {
        self.members.extend(members);
        self.ends.push(self.members.len() as u32);
    }

    /// Fills `count` sets: set i has the number i and all numbers that are linked to i.
    fn fill_symmetric(&mut self, count: usize, links: &[[u32; 2]]) {
        self.clear();
        // `ends` first has the number of members of each set, then the set's start, which moves to the end with each
        // added member.
        self.ends.resize(count, 1);
        for &end in links.iter().flatten() {
            self.ends[end as usize] += 1;
        }
        let mut start = 0;
        for end in &mut self.ends {
            start += std::mem::replace(end, start);
        }
        self.members.resize(start as usize, 0);
        let mut add = |set: u32, member: u32| {
            let end = &mut self.ends[set as usize];
            self.members[*end as usize] = member;
            *end += 1;
        };
        (0..count as u32).for_each(|at| add(at, at));
        for &[a, b] in links {
            add(a, b);
            add(b, a);
        }
    }

    fn len(&self) -> usize {
        self.ends.len()
    }

    fn range(&self, set: usize) -> Range<usize> {
        let start = set.checked_sub(1).map_or(0, |before| self.ends[before]);
        start as usize..self.ends[set] as usize
    }

    fn members(&self, set: usize) -> &[u32] {
        &self.members[self.range(set)]
    }
}

/// The working memory of a greedy cover.
// A queue of buckets, one for each gain, in place of a heap: gains only shrink, so that each bucket is complete once
// those above it are done (Minoux 1978).
#[derive(Default)]
struct Cover {
    /// The first set of each bucket.
    heads: Vec<u32>,
    /// The set after each set in its bucket.
    next: Vec<u32>,
    bucket: Vec<u32>,
}

impl Cover {
    /// Chooses sets that together cover all members, greedily by the weight of members not yet
    /// covered.
    ///
    /// Among sets of equal weight, the first one is chosen. Calls `take` with each chosen set, its members and all
    /// weights at that moment, and then sets the weights of its members to 0.
    fn choose(&mut self, sets: &Sets, left: &mut [u32], mut take: impl FnMut(usize, &[u32], &[u32])) {
        let gain = |set: usize, left: &[u32]| sets.members(set).iter().map(|&at| left[at as usize]).sum::<u32>();
        let most = (0..sets.len()).map(|set| gain(set, left)).max().unwrap_or(0);
        self.heads.clear();
        self.heads.resize(most as usize + 1, NONE);
        self.next.clear();
        self.next.resize(sets.len(), NONE);
        for set in 0..sets.len() {
            self.push(set, gain(set, left));
        }
        for promised in (1..=most).rev() {
            self.empty_bucket(promised);
            for at in 0..self.bucket.len() {
                let set = self.bucket[at] as usize;
                let added = gain(set, left);
                if added == promised {
                    take(set, sets.members(set), left);
                    sets.members(set).iter().for_each(|&member| left[member as usize] = 0);
                } else {
                    self.push(set, added);
                }
            }
        }
    }

    fn push(&mut self, set: usize, gain: u32) {
        self.next[set] = std::mem::replace(&mut self.heads[gain as usize], set as u32);
    }

    /// Moves a bucket's sets to `self.bucket`, in ascending order.
    fn empty_bucket(&mut self, gain: u32) {
        self.bucket.clear();
        let mut set = self.heads[gain as usize];
        while set != NONE {
            self.bucket.push(set);
            set = self.next[set as usize];
        }
        self.bucket.sort_unstable();
    }
}
