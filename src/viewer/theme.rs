//! The colours and borders of layers, and the screen size that they need.

use crate::capabilities::{CellMode, Colors};
use crate::grid::Size;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::style::{Color, Modifier, Style};
use ratatui_core::symbols::border;
use ratatui_core::widgets::Widget;
use ratatui_widgets::paragraph::Paragraph;

/// The colours and characters of panels. They use no colour or block characters if the picture uses
/// none.
#[derive(Clone, Copy)]
pub(super) struct Theme {
    style: Style,
    /// The style of marks on the picture.
    mark: Style,
    border: border::Set<'static>,
    /// The characters of a progress bar, for the part done and the part left.
    bar: [char; 2],
}

impl Theme {
    pub(super) fn for_cell_mode(cell_mode: CellMode) -> Self {
        let style = match cell_mode.colors {
            Colors::Truecolor => Style::new().fg(Color::Rgb(0xe6, 0xe6, 0xe6)).bg(Color::Rgb(0x18, 0x1c, 0x24)),
            // Both greys are of the fixed part of the palette, because the user may have changed the first 16 colours.
            Colors::Indexed256 => Style::new().fg(Color::Indexed(254)).bg(Color::Indexed(234)),
            Colors::Indexed16(_) => Style::new().fg(Color::White).bg(Color::Black),
            Colors::None => Style::new(),
        };
        let (border, bar) =
            if cell_mode.glyphs.has_blocks() { (border::ROUNDED, ['█', '░']) } else { (ASCII_BORDER, ['#', '.']) };
        let mark = match cell_mode.colors {
            // Without colours marks are bold, which `NO_COLOR` allows.
            Colors::None => style.add_modifier(Modifier::BOLD),
            _ => style.fg(Color::LightYellow),
        };
        Self { style, mark, border, bar }
    }

    /// Returns the characters of a progress bar, for the part done and the part left.
    pub(super) fn bar(self) -> [char; 2] {
        self.bar
    }

    pub(super) fn border(self) -> border::Set<'static> {
        self.border
    }

    /// Returns the style of marks on the picture.
    pub(super) fn mark(self) -> Style {
        self.mark
    }

    /// Returns the style of headings in panels; without colours it is the style of text.
    pub(super) fn heading(self) -> Style {
        Style { add_modifier: self.style.add_modifier, ..self.mark }
    }

    /// Returns the style of text in panels.
    pub(super) fn style(self) -> Style {
        self.style
    }
}

const ASCII_BORDER: border::Set<'static> = border::Set {
    top_left: "+",
    top_right: "+",
    bottom_left: "+",
    bottom_right: "+",
    vertical_left: "|",
    vertical_right: "|",
    horizontal_top: "-",
    horizontal_bottom: "-",
};

/// The smallest screen on which panels are shown, in columns and rows.
// The explanation is 39 columns wide, and takes half of the rows of a narrow screen.
pub(super) const MIN_PANEL_SCREEN: (u16, u16) = (40, 12);

/// Returns the message that a panel needs a larger screen.
pub(super) fn needs_room(panel: &str) -> String {
    let (columns, rows) = MIN_PANEL_SCREEN;
    format!("{panel} needs {columns}x{rows}")
}

/// Returns the area of the whole screen.
pub(super) fn area(size: Size) -> Rect {
    Rect::new(0, 0, size.columns, size.rows)
}

/// Returns whether the screen is large enough for panels.
///
/// On a smaller screen panels would hide what they describe.
pub(super) fn has_room(screen: Rect) -> bool {
    screen.width >= MIN_PANEL_SCREEN.0 && screen.height >= MIN_PANEL_SCREEN.1
}

/// Returns the row of the screen that has `below` rows under it.
pub(super) fn row_from_bottom(screen: Rect, below: u16) -> Rect {
    Rect { y: screen.bottom().saturating_sub(1 + below), height: screen.height.min(1), ..screen }
}

/// Writes text into `area`, which is one row.
pub(super) fn draw_line(text: &str, theme: Theme, area: Rect, buffer: &mut Buffer) {
    Paragraph::new(text).style(theme.style).render(area, buffer);
}

#[cfg(all(test, unit_tests))]
mod tests;
