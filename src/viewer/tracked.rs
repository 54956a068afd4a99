//! A value that knows whether it was changed.

use std::ops::{Deref, DerefMut};

/// A value, and whether anything had the right to change it since it was last seen to. So no method that changes the value
/// has to say so, and none can forget it.
pub(super) struct Tracked<T> {
    value: T,
    is_changed: bool,
}

impl<T> Tracked<T> {
    /// A new value counts as changed.
    pub(super) fn new(value: T) -> Self {
        Self { value, is_changed: true }
    }

    /// Whether the value may have been changed since [`settle`](Self::settle).
    pub(super) fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// Counts as changed from now on: what the value is seen by has changed.
    pub(super) fn touch(&mut self) {
        self.is_changed = true;
    }

    /// The value, to be changed without a word.
    pub(super) fn quietly(&mut self) -> &mut T {
        &mut self.value
    }

    /// Counts as unchanged from now on.
    pub(super) fn settle(&mut self) {
        self.is_changed = false;
    }
}

impl<T> Deref for Tracked<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.value
    }
}

impl<T> DerefMut for Tracked<T> {
    fn deref_mut(&mut self) -> &mut T {
        self.is_changed = true;
        &mut self.value
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whoever_may_change_it_counts() {
        let mut list = Tracked::new(vec![1]);
        assert!(list.is_changed());
        list.settle();
        list.quietly().push(2);
        assert!(list.len() == 2 && !list.is_changed());
        list.push(3);
        assert!(list.is_changed());
    }
}
