//! Numbers for keys, in the order in which the keys are first seen.
//!
//! Own code, because a map of the standard library takes several times as long.

use crate::grid::PackedInk;

/// A key, which is hashed by all of its bits.
pub(super) trait Key: Copy + PartialEq {
    fn bits(self) -> u64;
}

impl Key for PackedInk {
    fn bits(self) -> u64 {
        self.bits().into()
    }
}

impl Key for [PackedInk; 2] {
    fn bits(self) -> u64 {
        u64::from(self[0].bits()) << 32 | u64::from(self[1].bits())
    }
}

/// Distinct keys, each with a number from 0.
#[derive(Clone, Debug)]
pub(super) struct Numbering<K> {
    keys: Vec<K>,
    /// A hash table with open addressing: the number of a key, or `FREE`.
    slots: Vec<u32>,
}

/// The mark of a slot without a key.
const FREE: u32 = u32::MAX;

impl<K> Default for Numbering<K> {
    fn default() -> Self {
        Self { keys: Vec::new(), slots: Vec::new() }
    }
}

impl<K: Key> Numbering<K> {
    /// Removes all keys, and makes room for `count` others.
    pub(super) fn clear(&mut self, count: usize) {
        self.keys.clear();
        self.slots.clear();
        // At most half of the slots are taken, so that searches are short.
        self.slots.resize((2 * count).next_power_of_two().max(2), FREE);
    }

    /// Returns the number of a key, which is given one if it has none.
    ///
    /// [`clear`](Self::clear) must have made room for the key.
    #[inline]
    pub(super) fn add(&mut self, key: K) -> usize {
        self.find(key).unwrap_or_else(|slot| {
            let number = self.keys.len();
            self.slots[slot] = number as u32;
            self.keys.push(key);
            number
        })
    }

    /// Returns the number of a key, if it has one.
    pub(super) fn get(&self, key: K) -> Option<usize> {
        if self.keys.is_empty() { None } else { self.find(key).ok() }
    }

    /// Returns the keys in the order of their numbers.
    pub(super) fn keys(&self) -> &[K] {
        &self.keys
    }

    /// Returns the number of a key or, if it has none, the slot for it.
    #[inline]
    fn find(&self, key: K) -> Result<usize, usize> {
        let last = self.slots.len() - 1;
        // Fibonacci hashing (Knuth 1973). The highest bits are the best mixed ones.
        let bits = key.bits();
        let hash = (bits ^ bits >> 32).wrapping_mul(0x9e37_79b9_7f4a_7c15);
        let mut slot = (hash >> (64 - self.slots.len().trailing_zeros())) as usize;
        loop {
            let number = self.slots[slot];
            if number == FREE {
                return Err(slot);
            }
            if self.keys[number as usize] == key {
                return Ok(number as usize);
            }
            slot = (slot + 1) & last;
        }
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
