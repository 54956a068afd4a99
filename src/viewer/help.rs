//! The help and the short list of keys in the status line. Both are made from the bindings in force.

use super::layers::{Canvas, Layer, Level};
use super::look::{self, Look};
use crate::control::{Bindings, Command, Direction, Key, Mode, Toward};
use crossterm::event::KeyCode;
use ratatui_core::buffer::Buffer;
use ratatui_core::layout::{Margin, Rect};
use ratatui_core::widgets::Widget;
use ratatui_widgets::block::Block;
use ratatui_widgets::clear::Clear;
use ratatui_widgets::paragraph::Paragraph;
use std::collections::HashSet;
use unicode_width::UnicodeWidthStr;

/// Space between two columns.
const GAP: usize = 2;

/// Cells beside the text: the border and a blank on each side.
const FRAME: (u16, u16) = (4, 2);

/// Keys and their meaning.
type Row = (String, &'static str);

/// The open page of the help.
pub(super) struct HelpPanel {
    page: usize,
}

impl HelpPanel {
    /// Returns the first page.
    pub(super) const FIRST: Self = Self { page: 0 };

    /// Returns the next page; `None` after the last one, and where the screen has no room for any.
    pub(super) fn next(&self, bindings: &Bindings, modes: &[Mode], screen: Rect) -> Option<Self> {
        let pages = Help::new(bindings, modes, screen).pages();
        let page = self.page + 1;
        (page < pages && look::has_room(screen)).then_some(Self { page })
    }
}

impl Layer for HelpPanel {
    fn level(&self) -> Level {
        Level::Help
    }

    fn draw(&mut self, canvas: &mut Canvas<'_>) {
        if canvas.has_room() {
            let help = Help::new(canvas.bindings, canvas.modes, canvas.screen());
            let area = help.area(self.page, canvas.screen());
            canvas.lay(area, |look, area, buffer| help.draw(self.page, look, area, buffer));
        } else {
            canvas.write_line(&no_room(), canvas.foot(0));
        }
    }
}

/// The help laid out for a screen size: in as few columns as hold it all, otherwise in pages.
struct Help {
    title: String,
    /// Pages of columns of lines.
    pages: Vec<Vec<Vec<String>>>,
}

impl Help {
    /// Lays out the keys of these modes, topmost first.
    fn new(bindings: &Bindings, modes: &[Mode], screen: Rect) -> Self {
        let room = [screen.width.saturating_sub(FRAME.0), screen.height.saturating_sub(FRAME.1)].map(usize::from);
        let modes_said: Vec<_> = modes.iter().filter(|mode| **mode != Mode::Always).map(|mode| mode.name()).collect();
        Self { title: modes_said.join(", "), pages: pages(&rows(bindings, modes), room) }
    }

    /// Returns the number of pages.
    fn pages(&self) -> usize {
        self.pages.len()
    }

    /// Returns a page, or the last one if there are fewer.
    fn page(&self, page: usize) -> &[Vec<String>] {
        self.pages.get(page).or(self.pages.last()).map_or(&[], Vec::as_slice)
    }

    fn title(&self, page: usize) -> String {
        match self.pages() {
            0 | 1 => format!(" keys: {} ", self.title),
            pages => format!(" keys: {}, page {} of {pages} ", self.title, (page + 1).min(pages)),
        }
    }

    /// Returns the panel's area: in the middle, as large as its text, at most the screen.
    fn area(&self, page: usize, screen: Rect) -> Rect {
        let columns = self.page(page);
        let text = columns.iter().map(|column| width(column)).sum::<usize>() + GAP * columns.len().saturating_sub(1);
        let lines = columns.iter().map(Vec::len).max().unwrap_or(0) as u16;
        let width = (text as u16 + FRAME.0).max(self.title(page).width() as u16 + 2).min(screen.width);
        let height = (lines + FRAME.1).min(screen.height);
        Rect::new((screen.width - width) / 2, (screen.height - height) / 2, width, height)
    }

    fn draw(&self, page: usize, look: Look, area: Rect, buffer: &mut Buffer) {
        Clear.render(area, buffer);
        Block::bordered().border_set(look.border()).title(self.title(page)).style(look.style()).render(area, buffer);
        let mut rest = area.inner(Margin::new(2, 1));
        for column in self.page(page) {
            Paragraph::new(column.join("\n")).style(look.style()).render(rest, buffer);
            let taken = (width(column) + GAP).min(rest.width.into()) as u16;
            rest = Rect { x: rest.x + taken, width: rest.width - taken, ..rest };
        }
    }
}

/// The message where the screen has no room for the help.
fn no_room() -> String {
    let (columns, rows) = look::LEAST;
    format!("help needs {columns}x{rows}")
}

/// Returns the keys in force and their meaning. A key that a higher mode binds is left out below. Of several keys for
/// one command, such as digits, the first and the last are listed.
fn rows(bindings: &Bindings, modes: &[Mode]) -> Vec<Row> {
    let mut taken = HashSet::new();
    let mut rows = Vec::new();
    for row in modes.iter().flat_map(|&mode| bindings.of(mode)) {
        let keys: Vec<_> = row.keys.iter().filter(|key| taken.insert(**key)).map(Key::to_string).collect();
        if !keys.is_empty() {
            rows.push((keys.join(" "), row.command.does()));
        }
    }
    rows.push(("Shift".to_owned(), "with a movement: faster"));
    let alike = rows.chunk_by(|(_, does), (_, next)| does == next);
    alike.map(|rows| (joined(rows), rows[0].1)).collect()
}

fn joined(rows: &[Row]) -> String {
    match rows {
        [(first, _), .., (last, _)] => format!("{first}..{last}"),
        _ => rows.iter().map(|(label, _)| label.as_str()).collect(),
    }
}

/// Breaks the rows into as few columns as fit on one page; if these are too wide together, into fewer, and pages.
fn pages(rows: &[Row], [columns, lines]: [usize; 2]) -> Vec<Vec<Vec<String>>> {
    let lines = lines.max(1);
    let needed = rows.len().div_ceil(lines).max(1);
    let laid_out = |count: usize| {
        let lines = if count == needed { rows.len().div_ceil(count) } else { lines };
        let pages = rows.chunks(lines * count).map(|page| page.chunks(lines).map(column).collect::<Vec<_>>());
        pages.collect::<Vec<_>>()
    };
    let fits = |page: &Vec<Vec<String>>| page.iter().map(|column| width(column) + GAP).sum::<usize>() <= columns + GAP;
    (2..=needed).rev().map(laid_out).find(|pages| pages.iter().all(fits)).unwrap_or_else(|| laid_out(1))
}

/// Returns a line for each row.
fn column(rows: &[Row]) -> Vec<String> {
    let labels = rows.iter().map(|(label, _)| label.width()).max().unwrap_or(0);
    rows.iter().map(|(label, does)| format!("{label}{:1$}  {does}", "", labels - label.width())).collect()
}

fn width(lines: &[String]) -> usize {
    lines.iter().map(|line| line.width()).max().unwrap_or(0)
}

/// Returns the mode's name and as many of its important keys as fit.
pub(super) fn line(bindings: &Bindings, modes: &[Mode], room: usize) -> String {
    let Some(&mode) = modes.first() else { return String::new() };
    let always = [(&[Command::Help][..], "help"), (&[Command::Quit], "leave")];
    let mut line = format!(" {}", mode.name());
    for (commands, does) in always.into_iter().chain(matter(mode).iter().copied()) {
        if let Some(keys) = keys(bindings, modes, commands) {
            let item = format!("   {keys} {does}");
            if line.width() + item.width() < room {
                line += &item;
            }
        }
    }
    line
}

/// Returns the important commands of a mode, with a word for each.
fn matter(mode: Mode) -> &'static [(&'static [Command], &'static str)] {
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
        Mode::Fly => {
            &[(&[Command::ChangeMode], "orbit"), (MOVE, "move"), (LOOK, "look"), (&[Command::Explain], "explain")]
        }
        Mode::Orbit => &[
            (&[Command::ChangeMode], "fly"),
            (AROUND, "turn"),
            (&[Command::Nearer, Command::Farther], "distance"),
            (&[Command::Explain], "explain"),
        ],
        Mode::Explain => &[
            (POINT, "another pixel"),
            (&[Command::ScrollUp, Command::ScrollDown], "more"),
            (&[Command::Close], "close"),
        ],
        Mode::Light => &[
            (LIGHT, "move it"),
            (&[Command::Close], "done"),
            (&[Command::LightBack], "back"),
            (&[Command::LightFarther, Command::LightNearer], "distance"),
        ],
        Mode::Export | Mode::Keep | Mode::Always => &[],
    }
}

/// Returns a key for each command, if all have one; for the four arrows, the word "arrows".
pub(super) fn keys(bindings: &Bindings, modes: &[Mode], commands: &[Command]) -> Option<String> {
    let keys: Option<Vec<Key>> = commands.iter().map(|&command| bindings.key_of(modes, command)).collect();
    let keys = keys?;
    let arrows = [KeyCode::Left, KeyCode::Right, KeyCode::Up, KeyCode::Down].map(Key::named);
    let names: Vec<_> = keys.iter().map(Key::to_string).collect();
    let is_short = names.iter().all(|name| name.width() == 1);
    Some(if keys == arrows { "arrows".to_owned() } else { names.join(if is_short { "" } else { " " }) })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::capabilities::CellMode;

    fn all_modes() -> [Vec<Mode>; 4] {
        let under = |mode| vec![mode, Mode::Always];
        let above = |mode| vec![mode, Mode::Fly, Mode::Always];
        [under(Mode::Fly), under(Mode::Orbit), above(Mode::Explain), above(Mode::Light)]
    }

    /// Returns the text of all pages on a screen of this size.
    fn shown(bindings: &Bindings, modes: &[Mode], columns: u16, rows: u16) -> String {
        let screen = Rect::new(0, 0, columns, rows);
        let help = Help::new(bindings, modes, screen);
        let mut text = String::new();
        for page in 0..help.pages() {
            let area = help.area(page, screen);
            assert!(area.right() <= columns && area.bottom() <= rows);
            let mut buffer = Buffer::empty(area);
            help.draw(page, Look::of(CellMode::HALF_BLOCK), area, &mut buffer);
            for y in area.top()..area.bottom() {
                text.extend((area.left()..area.right()).map(|x| buffer[(x, y)].symbol()));
                text.push('\n');
            }
        }
        text
    }

    /// Asserts that the help fits on one page of a common screen.
    #[test]
    fn all_of_it_is_shown_wherever_there_is_room_for_panels() {
        let bindings = Bindings::default();
        for modes in all_modes() {
            for (columns, rows) in [(80, 24), (200, 60), (40, 12), (41, 24), (300, 12)] {
                let text = shown(&bindings, &modes, columns, rows);
                for (keys, does) in super::rows(&bindings, &modes) {
                    let line = text.lines().any(|line| line.contains(&keys) && line.contains(does));
                    assert!(line, "{keys} {does} in {columns}x{rows}:\n{text}");
                }
            }
        }
        for (columns, rows) in [(1, 1), (4, 2), (5, 3), (39, 11)] {
            shown(&bindings, &[Mode::Fly, Mode::Always], columns, rows);
        }
    }

    #[test]
    fn it_goes_by_what_is_bound() {
        let mut bindings = Bindings::default();
        bindings.bind(Mode::Fly, Key::letter('8'), Some(Command::Move(Direction::Forward)));
        bindings.bind(Mode::Fly, Key::letter('w'), None);
        bindings.bind(Mode::Always, Key::letter('o'), None);
        let text = shown(&bindings, &[Mode::Fly, Mode::Always], 80, 24);
        assert!(text.contains("8        ") && text.contains("move forward"), "{text}");
        assert!(!text.contains("picture to a file"), "{text}");
        assert_eq!(keys(&bindings, &[Mode::Fly], &[Command::Move(Direction::Forward)]).as_deref(), Some("8"));
        assert_eq!(keys(&bindings, &[Mode::Fly, Mode::Always], &[Command::Export]), None);
    }

    /// A key bound in a higher mode is not listed for the lower one.
    #[test]
    fn a_key_is_told_of_once() {
        let text = shown(&Bindings::default(), &[Mode::Explain, Mode::Fly, Mode::Always], 80, 24);
        assert_eq!(text.matches("Left").count(), 1, "{text}");
        assert!(text.contains("│ Left      cursor to the left"), "{text}");
    }

    #[test]
    fn the_line_has_as_much_as_fits() {
        let bindings = Bindings::default();
        let fly = [Mode::Fly, Mode::Always];
        let whole = " fly   ? help   q leave   Tab orbit   wasd move   arrows look   x explain";
        assert_eq!(line(&bindings, &fly, 80), whole);
        assert_eq!(line(&bindings, &fly, 40), " fly   ? help   q leave   Tab orbit");
        let explain = line(&bindings, &[Mode::Explain, Mode::Orbit, Mode::Always], 80);
        assert_eq!(explain, " explain   ? help   q leave   arrows another pixel   PageUp PageDown more");
    }
}
