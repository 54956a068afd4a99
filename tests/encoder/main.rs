//! The encoder's bytes, judged by the screens of four terminals, and of a real tmux.
//!
//! Frames are random grids, changes, panels and resizes. After each frame every cell of every screen is the wanted one,
//! or, where that is allowed, near it.

mod backend;
mod bytes;
#[path = "../corpus/mod.rs"]
mod corpus;
mod fuzzed;
mod grids;
mod kinds;
mod lossy;
mod memory;
mod near;
mod overlay;
mod pictures;
mod program;
#[path = "../../benches/bytes/scenes.rs"]
mod scenes;
mod screens;
mod sequences;
mod shifted;
mod tmux;
mod watched;
mod widgets;

use grids::{filled, put_at};
use proptest::collection::vec;
use proptest::prelude::*;
use proptest::test_runner::RngAlgorithm;
use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::{Color, Modifier, Style};
use screens::{Clusters, glyph_of};
use termtrace::internals::grid::{Attributes, HalfBlocks};
use termtrace::{Cell, Grid, Ink, Order, Size, Srgb8};
use watched::Watched;

pub(crate) const fn rgb(r: u8, g: u8, b: u8) -> Ink {
    Ink::Rgb(Srgb8::new(r, g, b))
}

/// Returns one of few colours, so that neighbours often share one.
fn ink() -> impl Strategy<Value = Ink> {
    prop_oneof![
        1 => Just(Ink::Default),
        1 => prop::sample::select(vec![Ink::Indexed(1), Ink::Indexed(9), Ink::Indexed(200)]),
        4 => prop::sample::select(vec![rgb(0, 0, 0), rgb(255, 255, 255), rgb(1, 20, 200), rgb(1, 20, 201)]),
        1 => any::<[u8; 3]>().prop_map(|[r, g, b]| rgb(r, g, b)),
    ]
}

/// Returns the bits of text attributes, which are the same in a grid and in ratatui's buffers.
fn attribute_bits() -> impl Strategy<Value = u16> {
    prop_oneof![4 => Just(0), 1 => any::<u16>()]
}

fn cell(texts: &'static [&'static str]) -> impl Strategy<Value = Cell> {
    let looks = (ink(), ink(), ink(), attribute_bits());
    (prop::sample::select(texts), looks).prop_map(|(text, (fg, bg, underline, bits))| Cell {
        glyph: glyph_of(text),
        fg,
        bg,
        underline,
        attributes: Attributes::from_bits_truncate(bits),
    })
}

/// The glyphs of a picture.
const PICTURE: &[&str] = &["▄", " ", "▀"];

/// Returns the glyphs that a grid may have: a picture's, plain and accented letters, wide ones and
/// clusters.
fn anything(clusters: Clusters) -> &'static [&'static str] {
    match clusters {
        Clusters::None => &["▄", "▄", " ", " ", "▀", "a", "@", "é", "│", "世", "🙂"],
        Clusters::Marks => &["▄", " ", "a", "世", "e\u{301}", "o\u{308}\u{323}", "世\u{301}", "❤\u{fe0f}"],
        Clusters::Joined => {
            &["▄", " ", "a", "世", "e\u{301}", "👨\u{200d}👩\u{200d}👧", "🇫🇷", "👍🏽", "1\u{fe0f}\u{20e3}"]
        }
    }
}

/// The most cells of a grid here.
const CELLS: usize = 60;

fn size() -> impl Strategy<Value = Size> {
    (1_u16..=12, 1_u16..=5).prop_map(|(columns, rows)| Size::new(columns, rows))
}

/// A ratatui buffer somewhere over the grid, perhaps beyond its edge, with a line of text.
#[derive(Clone, Debug)]
struct Panel {
    area: Rect,
    text: String,
    style: Style,
}

impl Panel {
    fn buffer(&self) -> Buffer {
        let mut buffer = Buffer::empty(self.area);
        buffer.set_style(self.area, self.style);
        for y in self.area.top()..self.area.bottom() {
            buffer.set_stringn(self.area.x, y, &self.text, self.area.width.into(), self.style);
        }
        buffer
    }
}

fn panel(clusters: Clusters) -> impl Strategy<Value = Panel> {
    let color = prop_oneof![
        Just(Color::Reset),
        prop::sample::select(&[Color::Red, Color::Gray, Color::DarkGray, Color::White][..]),
        any::<u8>().prop_map(Color::Indexed),
        any::<[u8; 3]>().prop_map(|[r, g, b]| Color::Rgb(r, g, b)),
    ];
    let area =
        (0_u16..8, 0_u16..4, 1_u16..9, 1_u16..4).prop_map(|(x, y, width, height)| Rect::new(x, y, width, height));
    let text = vec(prop::sample::select(anything(clusters)), 0..8).prop_map(|text| text.concat());
    let style = (color.clone(), color.clone(), color, attribute_bits()).prop_map(|(fg, bg, line, bits)| {
        let modifier = Modifier::from_bits_truncate(bits);
        Style::new().fg(fg).bg(bg).underline_color(line).add_modifier(modifier)
    });
    (area, text, style).prop_map(|(area, text, style)| Panel { area, text, style })
}

/// The change from one frame to the next.
#[derive(Clone, Debug)]
enum Step {
    /// The same frame again.
    Same,
    /// A frame of which some cells change.
    Change(Vec<(usize, Cell)>),
    /// A frame of which any cell may change.
    Redraw(Vec<Cell>),
    /// A picture with a panel over it; the panel is gone with the next frame.
    Panel(Vec<Cell>, Panel),
    /// A resize of the window.
    Resize(Size, Vec<Cell>),
    /// Bytes of another program on the screen.
    Disturb,
}

fn step(clusters: Clusters) -> impl Strategy<Value = Step> {
    let anything = anything(clusters);
    prop_oneof![
        1 => Just(Step::Same),
        4 => vec((0..CELLS, cell(anything)), 1..6).prop_map(Step::Change),
        1 => vec(cell(anything), CELLS).prop_map(Step::Redraw),
        2 => (vec(cell(PICTURE), CELLS), panel(clusters)).prop_map(|(cells, panel)| Step::Panel(cells, panel)),
        1 => (size(), vec(cell(anything), CELLS)).prop_map(|(size, cells)| Step::Resize(size, cells)),
        1 => Just(Step::Disturb),
    ]
}

/// A watched encoder, and the grid that it is to show.
pub(crate) struct Stage {
    watched: Watched,
    clusters: Clusters,
    grid: Grid,
}

/// All orders and half blocks.
pub(crate) const WAYS: [(Order, HalfBlocks); 4] = [
    (Order::Raster, HalfBlocks::Lower),
    (Order::Raster, HalfBlocks::Either),
    (Order::Color, HalfBlocks::Lower),
    (Order::Color, HalfBlocks::Either),
];

impl Stage {
    fn new((order, half_blocks): (Order, HalfBlocks), grid: Grid, clusters: Clusters) -> Self {
        Self { watched: Watched::new(order, half_blocks, grid.size(), clusters), clusters, grid }
    }

    /// Returns a stage for each order and half block.
    pub(crate) fn all(grid: &Grid, clusters: Clusters) -> [Self; 4] {
        WAYS.map(|way| Self::new(way, grid.clone(), clusters))
    }

    /// Takes the step, and returns the limit of its bytes.
    fn take(&mut self, step: &Step) -> usize {
        let all = 4 + self.grid.size().cell_count() * MOST_BYTES;
        match step {
            Step::Same => return 0,
            Step::Change(changes) => {
                let count = self.grid.size().cell_count();
                for (place, cell) in changes {
                    put_at(&mut self.grid, place % count, cell);
                }
                // Each panel may also have cut a wide character to its left and to its right; behind a cluster the rest
                // of its row may be written again.
                let cells = if matches!(self.clusters, Clusters::None) { 3 } else { 3 * 12 };
                return changes.len() * cells * MOST_BYTES;
            }
            Step::Redraw(cells) => self.grid = filled(self.grid.size(), cells),
            Step::Panel(cells, panel) => {
                self.grid = filled(self.grid.size(), cells);
                termtrace::lay_over(&mut self.grid, &panel.buffer());
                overlay::assert_lies_over(&self.grid, &filled(self.grid.size(), cells), &panel.buffer());
            }
            Step::Resize(size, cells) => {
                self.watched.resize(*size);
                self.grid = filled(*size, cells);
                return 4 + size.cell_count() * MOST_BYTES;
            }
            Step::Disturb => self.watched.disturb(self.grid.size()),
        }
        all
    }

    /// Sends the wanted grid.
    #[track_caller]
    pub(crate) fn send(&mut self, most: usize) {
        let bytes = self.watched.send(&self.grid);
        assert!(bytes <= most, "{bytes} bytes, at most {most} are needed");
    }
}

/// The longest bytes of a cell: a position, all nine attributes, three colours, a wide cluster that
/// is written on blanks.
const MOST_BYTES: usize = "\x1b[12;12H\x1b[0;1;2;3;4;5;6;7;8;9m\x1b[38;2;255;255;255;48;2;255;255;255m".len()
    + "\x1b[58:2::255:255:255m  \x1b[12;12H👨\u{200d}👩\u{200d}👧".len();

/// Returns a first grid, and the steps after it.
fn story(clusters: Clusters) -> impl Strategy<Value = (Size, Vec<Cell>, Vec<Step>)> {
    (size(), vec(cell(anything(clusters)), CELLS), vec(step(clusters), 1..8))
}

fn assert_told((size, cells, steps): &(Size, Vec<Cell>, Vec<Step>), clusters: Clusters) {
    for mut stage in Stage::all(&filled(*size, cells), clusters) {
        stage.send(4 + size.cell_count() * MOST_BYTES);
        for step in steps {
            let most = stage.take(step);
            stage.send(most);
        }
    }
}

/// Returns the configuration of a property with that many cases.
// Each cell of a grid is generated with a generator of its own. The default one is a copy of 300 bytes, which took half
// of a test's time.
fn config(cases: u32) -> ProptestConfig {
    ProptestConfig {
        failure_persistence: None,
        rng_algorithm: RngAlgorithm::XorShift,
        ..ProptestConfig::with_cases(cases)
    }
}

proptest! {
    #![proptest_config(config(2_000))]

    #[test]
    fn every_terminal_shows_every_frame(story in story(Clusters::None)) {
        assert_told(&story, Clusters::None);
    }

    #[test]
    fn letters_keep_their_marks(story in story(Clusters::Marks)) {
        assert_told(&story, Clusters::Marks);
    }

    #[test]
    fn families_and_flags_stay_together(story in story(Clusters::Joined)) {
        assert_told(&story, Clusters::Joined);
    }
}

#[test]
fn the_fuzzers_corpus_holds() {
    corpus::replay("encoder", fuzzed::hold_for);
}
