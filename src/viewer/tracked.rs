//! A wrapper that records whether its value may have been changed.

use std::ops::{Deref, DerefMut};

/// A value, and whether it was borrowed mutably since [`mark_unchanged`](Tracked::mark_unchanged).
///
/// So no method that changes the value can forget to set a flag.
pub(super) struct Tracked<T> {
    value: T,
    is_changed: bool,
}

impl<T> Tracked<T> {
    /// Returns a value that counts as changed.
    pub(super) fn new_changed(value: T) -> Self {
        Self { value, is_changed: true }
    }

    /// Returns whether the value may have been changed since
    /// [`mark_unchanged`](Self::mark_unchanged).
    pub(super) fn is_changed(&self) -> bool {
        self.is_changed
    }

    /// Marks the value as changed, because something else that it is drawn with has changed.
    pub(super) fn mark_changed(&mut self) {
        self.is_changed = true;
    }

    /// Returns the value for writing without marking it as changed.
    pub(super) fn quietly(&mut self) -> &mut T {
        &mut self.value
    }

    /// Marks the value as unchanged.
    pub(super) fn mark_unchanged(&mut self) {
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

#[cfg(all(test, unit_tests))]
mod tests;
