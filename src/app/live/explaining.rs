//! Keys while a pixel is explained.

use super::Live;
use crossterm::event::{KeyCode, KeyEvent, KeyEventKind, KeyModifiers};

/// With Shift the cursor goes so many pixels at once.
const FASTER: i32 = 8;

/// How many lines a page of the panel goes on.
const PAGE: isize = 10;

impl Live {
    /// A key that moves the cursor, or the text beside it; whether it is one.
    pub(super) fn point(&mut self, key: &KeyEvent) -> bool {
        let pixels = if key.modifiers.contains(KeyModifiers::SHIFT) { FASTER } else { 1 };
        let step = match key.code {
            KeyCode::Left => [-pixels, 0],
            KeyCode::Right => [pixels, 0],
            KeyCode::Up => [0, -pixels],
            KeyCode::Down => [0, pixels],
            KeyCode::PageUp | KeyCode::PageDown | KeyCode::Esc => [0; 2],
            _ => return false,
        };
        if key.kind == KeyEventKind::Release {
            return true;
        }
        match key.code {
            KeyCode::PageUp => self.screen.explain(|explaining, _| explaining.scroll(-PAGE)),
            KeyCode::PageDown => self.screen.explain(|explaining, _| explaining.scroll(PAGE)),
            KeyCode::Esc => self.screen.toggle_explaining(),
            _ => self.screen.explain(|explaining, frame| explaining.step(frame, step)),
        }
        true
    }
}
