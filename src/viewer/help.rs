//! The help panel and the keys in the status line, both generated from the keymap.

mod rows;

use super::layers::{Canvas, Layer, LayerLevel};
use super::theme::{self, Theme};
use crate::control::{Command, Direction, Key, KeyMode, Keymap, Toward};
use crossterm::event::KeyCode;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::text;
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use rows::{Line, is_arrows, lines, rows};
use unicode_width::UnicodeWidthStr;

/// Blank columns between two columns of the help.
const COLUMN_GAP: usize = 2;

/// Columns and rows of a help panel that are not text: the border, and a blank on the left and
/// right.
const PANEL_BORDER: (u16, u16) = (4, 2);

/// Limit on the characters of the help's filter.
// A filter of this length fits into the help's title on the smallest screen that shows panels.
const MAX_FILTER: usize = 12;

/// The open help. Keys go to it first; characters filter its rows.
pub(super) struct HelpPanel {
    page: usize,
    filter: String,
    /// Words on the current state, such as "on", that follow the description of a command.
    states: Vec<(Command, String)>,
}

/// The effect of a key press on the open help: to close it, turn its pages, or edit its filter.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum HelpKey {
    /// Closes the help.
    Close,
    /// Turns to the next page, and closes the help after the last one.
    Turn,
    /// Turns to the next page.
    Next,
    /// Turns to the previous page.
    Previous,
    /// Adds a character to the filter.
    Type(char),
    /// Deletes the last character of the filter.
    Delete,
    /// Clears the filter.
    Clear,
    /// Changes nothing.
    Nothing,
}

impl HelpPanel {
    /// Returns the open help with all rows, at its first page.
    pub(super) fn new(states: Vec<(Command, String)>) -> Self {
        Self { page: 0, filter: String::new(), states }
    }

    /// Returns the effect of a key that the keymap binds to `meant`.
    ///
    /// While there is a filter, all characters belong to it.
    pub(super) fn effect(&self, code: KeyCode, meant: Option<Command>) -> HelpKey {
        let is_filtered = !self.filter.is_empty();
        match (code, meant) {
            (KeyCode::Char(c), _) if is_filtered && !c.is_control() => HelpKey::Type(c),
            (KeyCode::Esc, _) if is_filtered => HelpKey::Clear,
            (_, Some(Command::Help)) => HelpKey::Turn,
            (KeyCode::Esc, _) | (_, Some(Command::Quit | Command::Close)) => HelpKey::Close,
            (KeyCode::Char(' ') | KeyCode::PageDown | KeyCode::Right | KeyCode::Down | KeyCode::Enter, _) => {
                HelpKey::Next
            }
            (KeyCode::PageUp | KeyCode::Left | KeyCode::Up, _) => HelpKey::Previous,
            (KeyCode::Backspace, _) => HelpKey::Delete,
            // `/`, with which pagers start a search, is ignored: the characters after it are the filter.
            (KeyCode::Char('/'), _) => HelpKey::Nothing,
            (KeyCode::Char(c), _) if !c.is_control() => HelpKey::Type(c),
            _ => HelpKey::Nothing,
        }
    }

    /// Carries out the effect of a key. Returns whether the help stays open.
    pub(super) fn take_key(&mut self, key: HelpKey, keymap: &Keymap, modes: &[KeyMode], screen: Rect) -> bool {
        let pages = self.laid_out(keymap, modes, screen).pages.len();
        match key {
            HelpKey::Close => return false,
            // The key that opens the help turns its pages, and closes it after the last one.
            HelpKey::Turn if self.page + 1 >= pages => return false,
            HelpKey::Turn | HelpKey::Next => self.page = (self.page + 1).min(pages.saturating_sub(1)),
            HelpKey::Previous => self.page = self.page.saturating_sub(1),
            HelpKey::Type(c) if self.filter.chars().count() < MAX_FILTER => self.filter.push(c),
            HelpKey::Delete => drop(self.filter.pop()),
            HelpKey::Clear => self.filter.clear(),
            HelpKey::Type(_) | HelpKey::Nothing => {}
        }
        if matches!(key, HelpKey::Type(_) | HelpKey::Delete | HelpKey::Clear) {
            self.page = 0;
        }
        true
    }

    fn laid_out(&self, keymap: &Keymap, modes: &[KeyMode], screen: Rect) -> Help {
        Help::new(&rows(keymap, modes, &self.states, &self.filter), modes, &self.filter, screen)
    }
}

impl Layer for HelpPanel {
    fn level(&self) -> LayerLevel {
        LayerLevel::Help
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        if canvas.has_room() {
            let help = self.laid_out(canvas.keymap, canvas.modes, canvas.screen());
            // In a larger window there may be fewer pages than when the page was turned.
            let page = self.page.min(help.pages.len().saturating_sub(1));
            let area = help.area(page, canvas.screen());
            canvas.lay(area, |theme, area, buffer| help.draw(page, theme, area, buffer));
        } else {
            canvas.write_line(&theme::needs_room("help"), canvas.row_from_bottom(0));
        }
    }
}

/// The help laid out for a screen size: on one page with as few columns as possible, or on several
/// pages.
struct Help {
    title: String,
    filter: String,
    /// Pages of columns of lines.
    pages: Vec<Vec<Vec<Line>>>,
}

impl Help {
    fn new(rows: &[rows::Row], modes: &[KeyMode], filter: &str, screen: Rect) -> Self {
        let room = [screen.width.saturating_sub(PANEL_BORDER.0), screen.height.saturating_sub(PANEL_BORDER.1)]
            .map(usize::from);
        // The mode `Always` is left out of the title, because it is always in force.
        let modes_said: Vec<_> =
            modes.iter().filter(|mode| **mode != KeyMode::Always).map(|mode| mode.name()).collect();
        let mut lines = lines(rows);
        if lines.is_empty() {
            lines.push(Line::Row("no key does this".to_owned()));
        }
        Self { title: modes_said.join(", "), filter: filter.to_owned(), pages: pages(&lines, room) }
    }

    fn title(&self, page: usize) -> String {
        let filter = if self.filter.is_empty() { String::new() } else { format!(" /{}", self.filter) };
        match self.pages.len() {
            0 | 1 => format!(" keys: {}{filter} ", self.title),
            pages => format!(" keys: {}{filter}, page {} of {pages} ", self.title, page + 1),
        }
    }

    /// Returns the line below the help: the keys that turn, filter and close it.
    ///
    /// Returns the longest version that fits into `room` columns.
    fn keys(&self, room: usize) -> &'static str {
        let lines: &[&str] = match (self.filter.is_empty(), self.pages.len() > 1) {
            (true, true) => &[" Space next page; type to filter; q close ", " Space next page; q close "],
            (true, false) => &[" type to filter; q close "],
            (false, true) => &[" PageDown next page; Esc all keys ", " PageDown next page "],
            (false, false) => &[" Esc all keys "],
        };
        lines.iter().find(|line| line.width() <= room).copied().unwrap_or_default()
    }

    /// Returns the panel's area: in the middle, as large as its text, at most the screen.
    fn area(&self, page: usize, screen: Rect) -> Rect {
        let columns = &self.pages[page];
        let text = columns.iter().map(|column| max_width(column)).sum::<usize>()
            + COLUMN_GAP * columns.len().saturating_sub(1);
        let lines = columns.iter().map(Vec::len).max().unwrap_or(0) as u16;
        let around = self.title(page).width().max(self.keys(usize::from(screen.width) - 2).width());
        let width = (text as u16 + PANEL_BORDER.0).max(around as u16 + 2).min(screen.width);
        let height = (lines + PANEL_BORDER.1).min(screen.height);
        Rect::new((screen.width - width) / 2, (screen.height - height) / 2, width, height)
    }

    fn draw(&self, page: usize, theme: Theme, area: Rect, buffer: &mut Buffer) {
        Clear.render(area, buffer);
        let keys = self.keys(usize::from(area.width) - 2);
        let block = Block::bordered().border_set(theme.border()).title(self.title(page)).title_bottom(keys);
        block.style(theme.style()).render(area, buffer);
        let mut rest = area.inner(Margin::new(2, 1));
        for column in &self.pages[page] {
            let line = |line: &Line| match line {
                Line::Heading(text) => text::Line::styled(text.clone(), theme.heading()),
                Line::Row(text) => text::Line::from(text.clone()),
            };
            let text: Vec<_> = column.iter().map(line).collect();
            Paragraph::new(text).style(theme.style()).render(rest, buffer);
            let taken = (max_width(column) + COLUMN_GAP).min(rest.width.into()) as u16;
            rest = Rect { x: rest.x + taken, width: rest.width - taken, ..rest };
        }
    }
}

/// Breaks the lines into columns, and puts on each page as many columns as fit side by side.
fn pages(lines: &[Line], [width_of_page, height]: [usize; 2]) -> Vec<Vec<Vec<Line>>> {
    // The height is at least one row, even on a screen of two rows, all of which the border takes.
    let height = height.max(1);
    let paged = |height: usize| {
        let mut pages: Vec<Vec<Vec<Line>>> = Vec::new();
        let mut taken = 0;
        for column in columns(lines, height) {
            let needed = max_width(&column) + COLUMN_GAP;
            match pages.last_mut() {
                Some(page) if taken + needed <= width_of_page + COLUMN_GAP => page.push(column),
                _ => {
                    pages.push(vec![column]);
                    taken = 0;
                }
            }
            taken += needed;
        }
        pages
    };
    // The least height that needs no more pages or columns, so that the columns are about equally long.
    let shape = |pages: &Vec<Vec<Vec<Line>>>| pages.iter().map(Vec::len).collect::<Vec<_>>();
    let full = paged(height);
    (1..height).map(paged).find(|pages| shape(pages) == shape(&full)).unwrap_or(full)
}

/// Breaks the lines into columns of at most `height` lines. No column ends with a heading.
fn columns(lines: &[Line], height: usize) -> Vec<Vec<Line>> {
    let mut columns = vec![Vec::new()];
    for (at, line) in lines.iter().enumerate() {
        let last = columns.len() - 1;
        let column = &mut columns[last];
        let is_heading = |line: &Line| matches!(line, Line::Heading(_));
        let would_end = is_heading(line) && column.len() + 1 == height && at + 1 < lines.len();
        if column.len() == height || would_end && height > 1 {
            columns.push(vec![line.clone()]);
        } else {
            column.push(line.clone());
        }
    }
    columns
}

fn max_width(lines: &[Line]) -> usize {
    lines.iter().map(|line| line.text().width()).max().unwrap_or(0)
}

/// Returns the keys of the status line: the topmost mode's name, and as many important keys as fit
/// into `room` columns.
pub(super) fn status_line(keymap: &Keymap, modes: &[KeyMode], room: usize) -> String {
    let Some(&mode) = modes.first() else { return String::new() };
    // Help and quit come first, so that even a narrow line has them.
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
            (&[Command::ScrollUp, Command::ScrollDown], "turn pages"),
            (&[Command::Close], "close"),
        ],
        KeyMode::Light => &[
            (LIGHT, "move"),
            (&[Command::Close], "done"),
            (&[Command::LightBack], "reset"),
            (&[Command::LightFarther, Command::LightNearer], "distance"),
        ],
        KeyMode::Orders => &[
            (&[Command::BuildPause], "pause"),
            (&[Command::BuildFaster, Command::BuildSlower], "speed"),
            (&[Command::BuildAgain], "again"),
            (&[Command::Close], "close"),
        ],
        KeyMode::Export | KeyMode::Keep | KeyMode::Always => &[],
    }
}

/// Returns a key for each command as one text, or `None` if a command has no key; the four arrows
/// become "arrows".
pub(super) fn key_names(keymap: &Keymap, modes: &[KeyMode], commands: &[Command]) -> Option<String> {
    let keys: Option<Vec<Key>> = commands.iter().map(|&command| keymap.key_of(modes, command)).collect();
    let keys = keys?;
    let names: Vec<_> = keys.iter().map(Key::to_string).collect();
    let is_short = names.iter().all(|name| name.width() == 1);
    // "arrows" is shorter than the names of the four keys.
    Some(if is_arrows(&keys) { "arrows".to_owned() } else { names.join(if is_short { "" } else { " " }) })
}

#[cfg(all(test, unit_tests))]
mod tests;
