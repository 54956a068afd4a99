//! The legend of a map in the lowest row; with two maps, one under each.

use super::layers::{Canvas, Layer, Level};
use super::theme::Theme;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::widgets::Widget;
use ratatui_widgets::paragraph::Paragraph;

/// The legends of the shown frame.
pub(super) struct Legends;

impl Layer for Legends {
    fn level(&self) -> Level {
        Level::Legend
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        let legends = canvas.frame.filter(|_| canvas.has_room()).map_or(&[][..], |frame| &frame.legends);
        for (text, area) in legend_areas(legends, canvas.foot(canvas.status_rows)) {
            canvas.lay(area, |theme, area, buffer| draw(text, theme, area, buffer));
        }
    }
}

/// Returns each text with its area, as wide as the text, so that the picture continues beside it.
fn legend_areas(texts: &[String], line: Rect) -> impl Iterator<Item = (&str, Rect)> {
    let count = texts.len().max(1) as u16;
    (0..).zip(texts).map(move |(at, text)| {
        let room = line.width / count;
        // Legends are ASCII, so that bytes are columns.
        let width = (text.len() as u16).saturating_add(2).min(room);
        (text.as_str(), Rect { x: line.x + (line.width * at).div_ceil(count), width, ..line })
    })
}

pub(super) fn draw(text: &str, theme: Theme, area: Rect, buffer: &mut Buffer) {
    Paragraph::new(format!(" {text} ")).style(theme.style()).render(area, buffer);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::viewer::theme::foot;

    #[test]
    fn each_map_has_its_legend_below_it() {
        let screen = Rect::new(0, 0, 81, 24);
        let texts = ["shaded".to_owned(), "depth: white 0, grey 6.41, black far".to_owned()];
        let places: Vec<_> = legend_areas(&texts, foot(screen, 0)).map(|(_, area)| area).collect();
        assert_eq!(places, [Rect::new(0, 23, 8, 1), Rect::new(41, 23, 38, 1)]);
        assert_eq!(foot(screen, 1).y, 22, "above the status line");
        assert_eq!(
            legend_areas(&texts[1..], Rect::new(0, 5, 20, 1)).next(),
            Some((&*texts[1], Rect::new(0, 5, 20, 1)))
        );
    }
}
