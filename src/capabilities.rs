//! What a terminal can show: a plain value, and how the environment tells it.

/// What the screen's cells can be made of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capabilities {
    /// How pixels become cells.
    pub cell_mode: CellMode,
    /// A cell's height over its width, greater than 0.
    pub cell_aspect: f32,
    /// Whether the upper and the lower half block meet in the same line: only then may a picture mix them.
    pub halves_meet: bool,
}

/// How pixels become cells.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CellMode {
    /// Two truecolor pixels, one above the other, in each cell.
    HalfBlock,
    /// A plain character by lightness, in the terminal's own colours.
    Ramp,
}

impl CellMode {
    /// How many pixels a cell wants, across and down.
    pub const fn pixels_per_cell(self) -> (u32, u32) {
        match self {
            Self::HalfBlock | Self::Ramp => (1, 2),
        }
    }
}

/// The aspect of a cell of which nothing is known.
pub const USUAL_CELL_ASPECT: f32 = 2.0;

/// Whether pictures may be coloured, as the user says it.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum ColorChoice {
    /// Where the terminal is likely to show them.
    #[default]
    Auto,
    /// Yes, whatever the environment says.
    Always,
    /// No colour and no block characters.
    Never,
}

/// The cell mode for a terminal, from what the user says and the environment, looked up by name.
///
/// Without colour, half blocks would be a screen full of equal characters; where characters are not UTF-8 they would
/// be garbage. Both then get the ramp.
pub fn cell_mode(choice: ColorChoice, variable: impl Fn(&str) -> Option<String>) -> CellMode {
    let ramp = match choice {
        ColorChoice::Always => false,
        ColorChoice::Never => true,
        ColorChoice::Auto => no_color(&variable) || is_dumb(&variable) || !is_utf8(&variable),
    };
    if ramp { CellMode::Ramp } else { CellMode::HalfBlock }
}

/// The custom of no-color.org: set, and not empty.
fn no_color(variable: impl Fn(&str) -> Option<String>) -> bool {
    variable("NO_COLOR").is_some_and(|value| !value.is_empty())
}

fn is_dumb(variable: impl Fn(&str) -> Option<String>) -> bool {
    variable("TERM").is_some_and(|term| term == "dumb")
}

/// The locale's character set, by POSIX's order of the variables. Where none is set, nobody has said anything against
/// UTF-8, and a terminal of today shows it.
fn is_utf8(variable: impl Fn(&str) -> Option<String>) -> bool {
    let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().filter_map(variable).find(|value| !value.is_empty());
    locale.is_none_or(|locale| {
        let locale = locale.to_ascii_lowercase();
        locale.contains("utf-8") || locale.contains("utf8")
    })
}

/// A cell's height over its width from a window's size in cells and in pixels, where it gives a sensible one.
pub fn cell_aspect(columns: u16, rows: u16, width: u16, height: u16) -> Option<f32> {
    // Cells have whole pixels; a window may be a few pixels larger than its cells.
    let cell_width = width.checked_div(columns)?;
    let cell_height = height.checked_div(rows)?;
    let aspect = f32::from(cell_height) / f32::from(cell_width);
    // Some terminals fill the fields with anything.
    (0.25..=8.0).contains(&aspect).then_some(aspect)
}

/// Whether the two half blocks meet in the same line, from a window's height in cells and in pixels: where a cell has an
/// even number of pixel rows. With an odd number, some terminals give the middle one to either half, others to the
/// glyph, and their mix would show.
pub fn halves_meet(rows: u16, height: u16) -> bool {
    // A remainder may be a border, or say that the figure is no cell's.
    let cell_height = height.checked_div(rows).filter(|cell_height| cell_height * rows == height);
    cell_height.is_some_and(|cell_height| cell_height > 0 && cell_height % 2 == 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mode(choice: ColorChoice, environment: &[(&str, &str)]) -> CellMode {
        cell_mode(choice, |name| environment.iter().find(|(n, _)| *n == name).map(|(_, value)| (*value).to_owned()))
    }

    #[test]
    fn the_environment_decides_unless_the_user_does() {
        use CellMode::{HalfBlock, Ramp};
        use ColorChoice::{Always, Auto, Never};
        for (choice, environment, expected) in [
            (Auto, &[("TERM", "xterm-256color"), ("LANG", "en_US.UTF-8")][..], HalfBlock),
            (Auto, &[], HalfBlock),
            (Auto, &[("LANG", "C.utf8")], HalfBlock),
            (Auto, &[("NO_COLOR", "1")], Ramp),
            (Auto, &[("NO_COLOR", "")], HalfBlock),
            (Auto, &[("TERM", "dumb")], Ramp),
            (Auto, &[("LANG", "C")], Ramp),
            (Auto, &[("LC_ALL", "POSIX"), ("LANG", "en_US.UTF-8")], Ramp),
            (Auto, &[("LC_ALL", ""), ("LANG", "en_US.UTF-8")], HalfBlock),
            (Auto, &[("LC_CTYPE", "de_DE.ISO-8859-1")], Ramp),
            (Always, &[("NO_COLOR", "1"), ("TERM", "dumb")], HalfBlock),
            (Never, &[("TERM", "xterm-kitty")], Ramp),
        ] {
            assert_eq!(mode(choice, environment), expected, "{choice:?} {environment:?}");
        }
    }

    #[test]
    fn halves_meet_in_cells_of_even_height() {
        for (rows, height, expected) in
            [(24, 480, true), (24, 456, false), (24, 24 * 17, false), (24, 497, false), (24, 0, false), (0, 480, false)]
        {
            assert_eq!(halves_meet(rows, height), expected, "{rows} rows in {height} pixels");
        }
    }

    #[test]
    fn cell_aspect_needs_a_sensible_window() {
        for (columns, rows, width, height, expected) in [
            (80, 24, 800, 480, Some(2.0)),
            (80, 24, 800, 456, Some(1.9)),
            (80, 24, 805, 497, Some(2.0)),
            (80, 24, 0, 0, None),
            (0, 0, 800, 480, None),
            (80, 24, 79, 480, None),
            (80, 24, 65535, 24, None),
        ] {
            assert_eq!(cell_aspect(columns, rows, width, height), expected, "{columns}x{rows} in {width}x{height}");
        }
    }
}
