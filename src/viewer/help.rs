//! The help panel and the keys in the status line, both generated from the keymap.

use super::layers::{Canvas, Layer, Level};
use super::theme::{self, Theme};
use crate::control::{Command, Direction, Key, KeyMode, Keymap, Toward};
use crossterm::event::KeyCode;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use std::collections::HashSet;
use unicode_width::UnicodeWidthStr;

/// Blank columns between two columns of the help.
const COLUMN_GAP: usize = 2;

/// Columns and rows of a help panel that are not text: the border, and a blank on the left and
/// right.
const PANEL_BORDER: (u16, u16) = (4, 2);

/// A row of the help: keys, and the description of their command.
type KeyRow = (String, &'static str);

/// The open page of the help.
pub(super) struct HelpPanel {
    page: usize,
}

impl HelpPanel {
    /// Returns the first page.
    pub(super) const FIRST: Self = Self { page: 0 };

    /// Returns the next page; `None` after the last one, and where the screen has no room for any.
    pub(super) fn next(&self, keymap: &Keymap, modes: &[KeyMode], screen: Rect) -> Option<Self> {
        let pages = Help::new(keymap, modes, screen).pages();
        let page = self.page + 1;
        // On a screen without room for the help, the next press closes the message about that.
        (page < pages && theme::has_room(screen)).then_some(Self { page })
    }
}

impl Layer for HelpPanel {
    fn level(&self) -> Level {
        Level::Help
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        if canvas.has_room() {
            let help = Help::new(canvas.keymap, canvas.modes, canvas.screen());
            let area = help.area(self.page, canvas.screen());
            canvas.lay(area, |theme, area, buffer| help.draw(self.page, theme, area, buffer));
        } else {
            canvas.write_line(&no_room_message(), canvas.foot(0));
        }
    }
}

/// The help laid out for a screen size: on one page with as few columns as possible, or on several
/// pages.
struct Help {
    title: String,
    /// The lines of each column of each page.
    pages: Vec<Vec<Vec<String>>>,
}

impl Help {
    /// Lays out the help on the keys of these modes, of which the topmost comes first.
    fn new(keymap: &Keymap, modes: &[KeyMode], screen: Rect) -> Self {
        let room = [screen.width.saturating_sub(PANEL_BORDER.0), screen.height.saturating_sub(PANEL_BORDER.1)]
            .map(usize::from);
        // The mode `Always` is left out of the title, because it is always in force.
        let modes_said: Vec<_> =
            modes.iter().filter(|mode| **mode != KeyMode::Always).map(|mode| mode.name()).collect();
        Self { title: modes_said.join(", "), pages: break_into_pages(&key_rows(keymap, modes), room) }
    }

    /// Returns the number of pages.
    fn pages(&self) -> usize {
        self.pages.len()
    }

    /// Returns the columns of a page, or of the last page if there are fewer.
    fn page(&self, page: usize) -> &[Vec<String>] {
        // A larger window or fewer modes may have left fewer pages since this page was opened.
        self.pages.get(page).or(self.pages.last()).map_or(&[], Vec::as_slice)
    }

    fn title(&self, page: usize) -> String {
        match self.pages() {
            0 | 1 => format!(" keys: {} ", self.title),
            pages => format!(" keys: {}, page {} of {pages} ", self.title, (page + 1).min(pages)),
        }
    }

    /// Returns the area of the panel with this page: centred, as large as its text, clipped to the
    /// screen.
    fn area(&self, page: usize, screen: Rect) -> Rect {
        let columns = self.page(page);
        let text =
            columns.iter().map(|column| width(column)).sum::<usize>() + COLUMN_GAP * columns.len().saturating_sub(1);
        let lines = columns.iter().map(Vec::len).max().unwrap_or(0) as u16;
        let width = (text as u16 + PANEL_BORDER.0).max(self.title(page).width() as u16 + 2).min(screen.width);
        let height = (lines + PANEL_BORDER.1).min(screen.height);
        Rect::new((screen.width - width) / 2, (screen.height - height) / 2, width, height)
    }

    fn draw(&self, page: usize, theme: Theme, area: Rect, buffer: &mut Buffer) {
        Clear.render(area, buffer);
        Block::bordered().border_set(theme.border()).title(self.title(page)).style(theme.style()).render(area, buffer);
        let mut rest = area.inner(Margin::new(2, 1));
        for column in self.page(page) {
            Paragraph::new(column.join("\n")).style(theme.style()).render(rest, buffer);
            let taken = (width(column) + COLUMN_GAP).min(rest.width.into()) as u16;
            rest = Rect { x: rest.x + taken, width: rest.width - taken, ..rest };
        }
    }
}

/// Returns the message for screens that are too small for the help.
fn no_room_message() -> String {
    let (columns, rows) = theme::MIN_PANEL_SCREEN;
    format!("help needs {columns}x{rows}")
}

/// Returns the rows of the help: the keys in force in these modes, topmost first, and what they do.
///
/// A key that several modes bind is listed only for the topmost of them. Of several bindings with the same description,
/// such as the digits, only the first and last key are listed.
fn key_rows(keymap: &Keymap, modes: &[KeyMode]) -> Vec<KeyRow> {
    // Keys seen so far. Modes are topmost first, so the first binding of a key is the one in force.
    let mut taken = HashSet::new();
    let mut rows = Vec::new();
    for row in modes.iter().flat_map(|&mode| keymap.of(mode)) {
        let keys: Vec<_> = row.keys.iter().filter(|key| taken.insert(**key)).map(Key::to_string).collect();
        if !keys.is_empty() {
            rows.push((keys.join(" "), row.command.description()));
        }
    }
    // Shift is not in the keymap, because it modifies the movement keys.
    rows.push(("Shift".to_owned(), "hold: moves 4x faster"));
    let alike = rows.chunk_by(|(_, description), (_, next)| description == next);
    alike.map(|rows| (joined_keys(rows), rows[0].1)).collect()
}

fn joined_keys(rows: &[KeyRow]) -> String {
    match rows {
        [(first, _), .., (last, _)] => format!("{first}..{last}"),
        _ => rows.iter().map(|(label, _)| label.as_str()).collect(),
    }
}

/// Breaks the rows into pages of columns of lines, for a room of this many columns and lines of
/// text.
///
/// All rows are on one page if its columns fit beside each other; otherwise there are fewer columns and several pages.
fn break_into_pages(rows: &[KeyRow], [columns, lines]: [usize; 2]) -> Vec<Vec<Vec<String>>> {
    // The screen may be so small that the border leaves no line.
    let lines = lines.max(1);
    let needed = rows.len().div_ceil(lines).max(1);
    let laid_out = |count: usize| {
        let lines = if count == needed { rows.len().div_ceil(count) } else { lines };
        let pages = rows.chunks(lines * count).map(|page| page.chunks(lines).map(aligned_lines).collect::<Vec<_>>());
        pages.collect::<Vec<_>>()
    };
    let fits = |page: &Vec<Vec<String>>| {
        page.iter().map(|column| width(column) + COLUMN_GAP).sum::<usize>() <= columns + COLUMN_GAP
    };
    // As many columns as a single page needs are tried first, because turning pages is worse than short columns.
    (2..=needed).rev().map(laid_out).find(|pages| pages.iter().all(fits)).unwrap_or_else(|| laid_out(1))
}

/// Returns the rows as lines of text, with the descriptions aligned in one column.
fn aligned_lines(rows: &[KeyRow]) -> Vec<String> {
    let labels = rows.iter().map(|(label, _)| label.width()).max().unwrap_or(0);
    rows.iter().map(|(label, description)| format!("{label}{:1$}  {description}", "", labels - label.width())).collect()
}

fn width(lines: &[String]) -> usize {
    lines.iter().map(|line| line.width()).max().unwrap_or(0)
}

/// Returns the keys of the status line: the topmost mode's name, and as many important keys as fit
/// into `room` columns.
pub(super) fn status_line(keymap: &Keymap, modes: &[KeyMode], room: usize) -> String {
    let Some(&mode) = modes.first() else { return String::new() };
    let always = [(&[Command::Help][..], "help"), (&[Command::Quit], "quit")];
    let mut line = format!(" {}", mode.name());
    for (commands, description) in always.into_iter().chain(status_line_keys(mode).iter().copied()) {
        if let Some(keys) = key_names(keymap, modes, commands) {
            let item = format!("   {keys} {description}");
            // An item that does not fit is left out, but a shorter one after it may still fit.
            if line.width() + item.width() < room {
                line += &item;
            }
        }
    }
    line
}

/// Returns the commands that the status line lists for a mode, in groups with a description each.
fn status_line_keys(mode: KeyMode) -> &'static [(&'static [Command], &'static str)] {
    // Commands are in the order in which their keys are usually named: W A S D, and the arrows.
    const MOVE: &[Command] = &[
        Command::Move(Direction::Forward),
        Command::Move(Direction::Left),
        Command::Move(Direction::Back),
        Command::Move(Direction::Right),
    ];
    const LOOK: &[Command] = &[
        Command::Look(Toward::Left),
        Command::Look(Toward::Right),
        Command::Look(Toward::Up),
        Command::Look(Toward::Down),
    ];
    const AROUND: &[Command] = &[
        Command::Around(Toward::Left),
        Command::Around(Toward::Right),
        Command::Around(Toward::Up),
        Command::Around(Toward::Down),
    ];
    const POINT: &[Command] = &[
        Command::Point(Toward::Left),
        Command::Point(Toward::Right),
        Command::Point(Toward::Up),
        Command::Point(Toward::Down),
    ];
    const LIGHT: &[Command] = &[
        Command::MoveLight(Toward::Left),
        Command::MoveLight(Toward::Right),
        Command::MoveLight(Toward::Up),
        Command::MoveLight(Toward::Down),
    ];
    match mode {
        KeyMode::Fly => {
            &[(&[Command::ChangeMode], "orbit"), (MOVE, "move"), (LOOK, "look"), (&[Command::Explain], "explain")]
        }
        KeyMode::Orbit => &[
            (&[Command::ChangeMode], "fly"),
            (AROUND, "turn"),
            (&[Command::Nearer, Command::Farther], "distance"),
            (&[Command::Explain], "explain"),
        ],
        KeyMode::Explain => &[
            (POINT, "move cursor"),
            (&[Command::ScrollUp, Command::ScrollDown], "scroll"),
            (&[Command::Close], "close"),
        ],
        KeyMode::Light => &[
            (LIGHT, "move"),
            (&[Command::Close], "done"),
            (&[Command::LightBack], "reset"),
            (&[Command::LightFarther, Command::LightNearer], "distance"),
        ],
        KeyMode::Export | KeyMode::Keep | KeyMode::Always => &[],
    }
}

/// Returns a key for each command as one text, or `None` if a command has no key; the four arrows
/// become "arrows".
pub(super) fn key_names(keymap: &Keymap, modes: &[KeyMode], commands: &[Command]) -> Option<String> {
    let keys: Option<Vec<Key>> = commands.iter().map(|&command| keymap.key_of(modes, command)).collect();
    let keys = keys?;
    let arrows = [KeyCode::Left, KeyCode::Right, KeyCode::Up, KeyCode::Down].map(Key::named);
    let names: Vec<_> = keys.iter().map(Key::to_string).collect();
    let is_short = names.iter().all(|name| name.width() == 1);
    // The word "arrows" is shorter than the names of the four keys.
    Some(if keys == arrows { "arrows".to_owned() } else { names.join(if is_short { "" } else { " " }) })
}

#[cfg(all(test, unit_tests))]
mod tests;
