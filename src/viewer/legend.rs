//! The legend of a map in the lowest row; with two maps, one in the corner of each.

use super::layers::{Canvas, Layer, LayerLevel};
use super::theme::Theme;
use crate::capabilities::Colors;
use crate::color::Srgb8;
use crate::maps::cost_color;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::Rect;
use ratatui_core::style::{Color, Style};
use ratatui_core::widgets::Widget;
use ratatui_widgets::paragraph::Paragraph;

/// The layer with the legends of the shown frame's maps.
pub(super) struct Legends;

impl Layer for Legends {
    fn level(&self) -> LayerLevel {
        LayerLevel::Legend
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        for (text, area) in shown_legends(canvas) {
            let colors = canvas.cell_mode.colors;
            canvas.lay(area, |theme, area, buffer| {
                draw(text, theme, area, buffer);
                if text.starts_with("cost:") {
                    draw_cost_bar(colors, area, buffer);
                }
            });
        }
    }
}

/// Returns the legends of the shown frame with their areas on the screen.
pub(super) fn shown_legends<'a>(canvas: &Canvas<'a>) -> Vec<(&'a str, Rect)> {
    let Some(frame) = canvas.frame.filter(|_| canvas.has_room()) else { return Vec::new() };
    let line = if frame.shot.layout.is_wipe() { canvas.wipe } else { 0.5 };
    legend_areas(&frame.legends, line, canvas.row_from_bottom(canvas.status_rows))
}

/// Returns each text with its area, as wide as the text, so that the picture continues beside it.
///
/// If there are two texts, the second one ends at the right edge. `line` is the position of the line between the two
/// pictures, as a share of the width. A text that would cover the other picture is reduced to the map's name, or to
/// nothing.
fn legend_areas(texts: &[String], line: f32, row: Rect) -> Vec<(&str, Rect)> {
    // Legends are ASCII, so a text has as many columns as bytes.
    let width = |text: &str| (text.len() as u16).saturating_add(2);
    let fitting = |text: &'_ str, room: u16| {
        let name = text.split(':').next().unwrap_or_default();
        [text.len(), name.len()].into_iter().find(|&length| length + 2 <= usize::from(room))
    };
    match texts {
        [only] => vec![(only, Rect { width: width(only).min(row.width), ..row })],
        [left, right] => {
            let meet = (line * f32::from(row.width)) as u16;
            let left = fitting(left, meet).map(|length| &left[..length]);
            let right = fitting(right, row.width.saturating_sub(meet + 1)).map(|length| &right[..length]);
            let left = left.map(|text| (text, Rect { width: width(text), ..row }));
            let at_the_edge = |text| Rect { x: row.right() - width(text), width: width(text), ..row };
            left.into_iter().chain(right.map(|text| (text, at_the_edge(text)))).collect()
        }
        _ => Vec::new(),
    }
}

/// The labels of the colour bar of the map `cost`: numbers of tests, four columns for each.
const COSTS: &str = "1   4   16  64  256 1024";

/// Replaces the names of the colours in the legend of the map `cost` by a bar of them.
///
/// The number of tests doubles with every two columns of the bar. A terminal with 16 colours or none keeps the names.
fn draw_cost_bar(colors: Colors, area: Rect, buffer: &mut Buffer) {
    let ink = |Srgb8 { r, g, b }: Srgb8| match colors {
        Colors::Truecolor => Some(Color::Rgb(r, g, b)),
        // The nearest colour of the palette's 6x6x6 cube, whose levels are about 51 apart.
        Colors::Indexed256 => {
            let [r, g, b] = [r, g, b].map(|channel| (u16::from(channel) + 25) / 51);
            Some(Color::Indexed((16 + 36 * r + 6 * g + b) as u8))
        }
        Colors::Indexed16(_) | Colors::None => None,
    };
    let start = area.x + " cost: ".len() as u16;
    for (column, number) in (0_u16..).zip(COSTS.chars()) {
        let color = cost_color(libm::exp2f(0.5 * f32::from(column)).round() as u32);
        // Ten times the luma, with its weights of 0.3, 0.6 and 0.1: 1280 is in the middle, where black and white text
        // have equal contrast.
        let luma = 3 * u32::from(color.r) + 6 * u32::from(color.g) + u32::from(color.b);
        let text = if luma > 1280 { Color::Black } else { Color::White };
        if let Some(background) = ink(color)
            && let Some(cell) = buffer.cell_mut((start + column, area.y))
        {
            cell.set_char(number).set_fg(text).set_bg(background);
        }
    }
    if matches!(colors, Colors::Truecolor | Colors::Indexed256) {
        let rest = area.right().saturating_sub(start + COSTS.len() as u16);
        buffer.set_stringn(start + COSTS.len() as u16, area.y, " tests   ", rest.into(), Style::new());
    }
}

pub(super) fn draw(text: &str, theme: Theme, area: Rect, buffer: &mut Buffer) {
    Paragraph::new(format!(" {text} ")).style(theme.style()).render(area, buffer);
}

#[cfg(all(test, unit_tests))]
mod tests;
