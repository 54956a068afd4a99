//! The list of viewers, in which a digit follows one of them.

use super::{LooksAt, OtherViewer, OtherViewers, label};
use crate::viewer::layers::{Canvas, Layer, LayerLevel};
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::text::Line;
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use unicode_width::UnicodeWidthStr;

/// The most viewers on a page: as many as there are digits.
const DIGITS: u16 = 9;

/// The rows that are not for other viewers: the border, the own row, and the row of notes below.
const FIXED_ROWS: u16 = 4;

/// The open list.
pub(super) struct ViewerList {
    viewers: OtherViewers,
    /// The shown page, from 0.
    page: usize,
}

impl ViewerList {
    /// Returns the list at its first page.
    pub(super) fn new(viewers: OtherViewers) -> Self {
        Self { viewers, page: 0 }
    }

    /// Returns the list at its next page, or `None` after the last one.
    pub(super) fn next_page(self, screen: Rect) -> Option<Self> {
        let page = self.shown_page(screen) + 1;
        (page < self.pages(screen)).then_some(Self { page, ..self })
    }

    /// Replaces the viewers.
    pub(super) fn set_viewers(&mut self, viewers: OtherViewers) {
        self.viewers = viewers;
    }

    /// Returns the number of the viewer with this digit on the shown page.
    pub(super) fn number_of(&self, digit: u8, screen: Rect) -> Option<u64> {
        self.rows(screen).get(usize::from(digit).checked_sub(1)?).map(|other| other.number)
    }

    fn rows_per_page(screen: Rect) -> usize {
        screen.height.saturating_sub(FIXED_ROWS).clamp(1, DIGITS).into()
    }

    fn pages(&self, screen: Rect) -> usize {
        self.viewers.others.len().div_ceil(Self::rows_per_page(screen)).max(1)
    }

    /// Returns the shown page: the last one if there are fewer than when the page was turned.
    fn shown_page(&self, screen: Rect) -> usize {
        self.page.min(self.pages(screen) - 1)
    }

    /// Returns the viewers on the shown page.
    fn rows(&self, screen: Rect) -> &[OtherViewer] {
        let pages = self.viewers.others.chunks(Self::rows_per_page(screen));
        pages.into_iter().nth(self.shown_page(screen)).unwrap_or_default()
    }

    fn lines(&self, screen: Rect) -> Vec<String> {
        let rows = self.rows(screen);
        let width = rows.iter().map(|other| other.label().width()).max().unwrap_or(0);
        let mut lines: Vec<_> = (1..)
            .zip(rows)
            .map(|(digit, other)| format!("{digit}  {:width$}  {}", other.label(), words(&other.looks_at)))
            .collect();
        let (number, name) = &self.viewers.own;
        let alone = if self.viewers.others.is_empty() { ", alone here" } else { "" };
        lines.push(format!("   you are {}{alone}", label(*number, name.as_deref())));
        lines
    }
}

/// Returns what a viewer looks at, in words.
fn words(looks_at: &LooksAt) -> String {
    match looks_at {
        LooksAt::Scene(name) => name.to_string(),
        LooksAt::Tour => "in the tour".to_owned(),
        LooksAt::Viewer(number) => format!("with viewer {number}"),
    }
}

impl Layer for ViewerList {
    fn level(&self) -> LayerLevel {
        LayerLevel::Side
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let screen = canvas.screen();
        if !canvas.has_room() {
            return;
        }
        let (lines, pages) = (self.lines(screen), self.pages(screen));
        let page = if pages > 1 { format!(", page {} of {pages}", self.shown_page(screen) + 1) } else { String::new() };
        let title = format!(" {}{page} ", self.viewers.count_line());
        let keys = if self.viewers.others.is_empty() { "" } else { " a digit follows; Esc closes " };
        let text = lines.iter().map(|line| line.width() + 4).max().unwrap_or(0);
        let width = text.max(title.width() + 2).max(keys.width() + 2).min(screen.width.into()) as u16;
        let height = (lines.len() as u16 + 2).min(screen.height);
        // The upper right corner, beside the panel of metadata.
        let area = Rect { x: screen.right() - width, width, height, ..screen };
        canvas.lay(area, |theme, area, buffer| {
            Clear.render(area, buffer);
            let block = Block::bordered().border_set(theme.border()).title(title).title_bottom(keys);
            block.style(theme.style()).render(area, buffer);
            let lines: Vec<_> = lines.into_iter().map(Line::from).collect();
            Paragraph::new(lines).style(theme.style()).render(area.inner(Margin::new(2, 1)), buffer);
        });
    }
}
