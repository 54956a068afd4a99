//! The command that changes the kind of cells.

use super::Viewer;
use crate::capabilities::Glyphs;

impl Viewer {
    /// Switches to the next kind of cells that the terminal's locale can encode.
    pub(super) fn change_glyphs(&mut self) {
        let (before, size) = (*self.display.capabilities(), self.picture_size());
        self.rest.end();
        let shown = before.cell_mode.glyphs;
        let at = Glyphs::ALL.iter().position(|&glyphs| glyphs == shown).unwrap_or(0);
        // The shown kind itself comes last, so that it stays if the terminal can encode no other.
        let mut others = Glyphs::ALL.iter().cycle().skip(at + 1).take(Glyphs::ALL.len());
        let Some(&next) = others.find(|glyphs| self.options.hints.can_encode(**glyphs)) else { return };
        let choice = self.display.choose_glyphs(Some(next));
        // Kinds with more pixels per cell need more memory for a picture.
        if let Err(error) = self.display.check_memory() {
            self.display.choose_glyphs(choice);
            self.show_note(error.to_string());
            return;
        }
        self.screen.set_capabilities(self.display.capabilities());
        if self.picture_size() != size {
            self.forget_screen();
        }
        self.show_note(format!("{} (--glyphs {next})", next.title()));
    }
}
