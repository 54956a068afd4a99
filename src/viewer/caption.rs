//! The caption of a scene, at the bottom of the picture.

use super::error_panel::wrapped;
use super::help::key_names;
use super::layers::{Canvas, Layer, LayerLevel};
use super::theme::has_room;
use crate::control::Command;
use ratatui_core::layout::Rect;
use ratatui_core::widgets::Widget;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use std::sync::Arc;
use unicode_width::UnicodeWidthStr;

/// Limit on the columns of a line. Longer lines are hard to read.
const MAX_COLUMNS: u16 = 92;

/// A page of a caption.
#[derive(PartialEq)]
pub(super) struct Caption {
    text: Arc<str>,
    /// The number of the scene on the tour, from 1, and the number of all its scenes.
    place: Option<(usize, usize)>,
    /// More keys for the caption's last row on a tour, with what they do.
    more_keys: [(Command, &'static str); 2],
    page: usize,
}

impl Caption {
    /// Returns the first page of the caption `text`, in which each line is a paragraph.
    pub(super) fn new(text: Arc<str>, place: Option<(usize, usize)>, more_keys: [(Command, &'static str); 2]) -> Self {
        Self { text, place, more_keys, page: 0 }
    }

    /// Returns the next page; `None` after the last one.
    pub(super) fn next(self, screen: Rect) -> Option<Self> {
        let page = self.page + 1;
        (page < self.pages(screen).len()).then_some(Self { page, ..self })
    }

    /// Returns the lines of each page on a screen of this size. The row of keys is not included.
    fn pages(&self, screen: Rect) -> Vec<Vec<String>> {
        let width = usize::from(screen.width.min(MAX_COLUMNS).saturating_sub(2)).max(1);
        let rows = caption_rows(screen).saturating_sub(1).max(1);
        let mut pages = vec![Vec::new()];
        for paragraph in self.text.lines() {
            let lines = wrapped(paragraph, width);
            // A paragraph that fits on a page of its own is not divided.
            let left = rows - pages.last().map_or(0, Vec::len);
            if lines.len() > left && lines.len() <= rows {
                pages.push(Vec::new());
            }
            for line in lines {
                match pages.last_mut() {
                    Some(page) if page.len() < rows => page.push(line),
                    _ => pages.push(vec![line]),
                }
            }
        }
        pages.retain(|page| !page.is_empty());
        pages
    }

    /// Returns the row of keys below a page, without the last ones if it does not fit into `width`
    /// columns.
    ///
    /// `page` is counted from 1, up to `pages`.
    fn keys_row(&self, canvas: &Canvas<'_>, [page, pages]: [usize; 2], width: usize) -> String {
        let key =
            |command, does: &str| key_names(canvas.keymap, canvas.modes, &[command]).map(|key| format!("{key} {does}"));
        let turn = if page < pages { format!("more ({page} of {pages})") } else { "hides this".to_owned() };
        let turn = key(Command::Caption, &turn);
        let place = self.place.map(|(number, count)| format!("{number} of {count}"));
        let on_tour = |command, does| self.place.and_then(|_| key(command, does));
        let on = on_tour(Command::NextScene, "next scene");
        let more = self.more_keys.map(|(command, does)| on_tour(command, does));
        let mut parts: Vec<_> = [place, on, turn].into_iter().chain(more).flatten().collect();
        while parts.len() > 1 && parts.join("; ").width() > width {
            parts.pop();
        }
        parts.join("; ")
    }
}

/// Returns the number of a caption's rows: an eighth of the screen, but at least three.
///
/// An eighth covers no object that the picture is about.
fn caption_rows(screen: Rect) -> usize {
    usize::from(screen.height / 8).max(3)
}

impl Layer for Caption {
    fn level(&self) -> LayerLevel {
        LayerLevel::Caption
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let screen = canvas.screen();
        if !has_room(screen) {
            return;
        }
        let mut pages = self.pages(screen);
        // In a larger window there may be fewer pages than when the page was turned.
        let page = self.page.min(pages.len().saturating_sub(1));
        let keys = self.keys_row(canvas, [page + 1, pages.len()], usize::from(screen.width).saturating_sub(2));
        let mut lines = if page < pages.len() { pages.swap_remove(page) } else { Vec::new() };
        lines.push(keys);
        let width = lines.iter().map(|line| line.trim_end().width() as u16 + 2).max().unwrap_or(0).min(screen.width);
        let height = lines.len() as u16;
        let below = canvas.status_rows.max(canvas.note_rows);
        let area = Rect { y: screen.bottom().saturating_sub(below + height), width, height, ..screen };
        canvas.lay(area, |theme, area, buffer| {
            Clear.render(area, buffer);
            let text = lines.iter().map(|line| format!(" {line}")).collect::<Vec<_>>().join("\n");
            Paragraph::new(text).style(theme.style()).render(area, buffer);
        });
    }
}

#[cfg(all(test, unit_tests))]
mod tests;
