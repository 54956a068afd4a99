//! `--color`, `--glyphs` and `--background`: the colours and glyphs that a command prints.

use super::help::capitalized;
use super::settings::defaults;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use termtrace::internals::capabilities::{ColorChoice, GlyphChoice, Hints, terminfo_colors};
use termtrace::{CellMode, Colors, Glyphs, Painter};

#[derive(Args)]
#[command(next_help_heading = "Cells")]
pub(super) struct CellArgs {
    #[arg(long, value_name = "WHICH", hide_short_help = true)]
    #[arg(help = defaults::help("color", "Colours to draw with"))]
    color: Option<ColorArg>,
    #[arg(long, value_name = "KIND", value_parser = glyph_parser(), hide_short_help = true)]
    #[arg(help = defaults::help("glyphs", "Characters to draw with"))]
    glyphs: Option<GlyphChoice>,
    #[arg(long, value_name = "WHICH", hide_short_help = true)]
    #[arg(help = defaults::help("background", "The terminal's background, for characters without colours and ascii"))]
    background: Option<BackgroundArg>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum BackgroundArg {
    /// As the terminal reports, or dark
    Auto,
    /// Light: the darkest parts get the densest characters
    Light,
    /// Dark: the lightest parts get the densest characters
    Dark,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
#[allow(clippy::doc_markdown, reason = "the help shows these texts as they are")]
enum ColorArg {
    /// As many as the terminal supports, by NO_COLOR, CLICOLOR_FORCE, FORCE_COLOR, COLORTERM,
    /// its own reply, terminfo and TERM; termtrace doctor shows which of them decided
    Auto,
    /// As auto, but at least 16 colours, even if NO_COLOR is set
    Always,
    /// No colours, and no escape sequences for them
    Never,
    /// 24-bit colours
    Truecolor,
    /// 256 colours, mixed in pairs
    #[value(name = "256")]
    Indexed256,
    /// 16 colours, mixed in pairs
    #[value(name = "16")]
    Indexed16,
}

/// The value of `--color` and `--glyphs` that leaves the choice to the terminal or the file format.
const AUTO: &str = "auto";
const AUTO_HELP: &str =
    "Half blocks; ascii if there is no colour, spaces if the locale is not UTF-8 or a block is not one column wide";

pub(super) fn glyph_parser() -> impl TypedValueParser<Value = GlyphChoice> {
    let kinds = Glyphs::ALL.iter().map(|glyphs| PossibleValue::new(glyphs.name()).help(capitalized(glyphs.help())));
    let auto = PossibleValue::new(AUTO).help(AUTO_HELP);
    PossibleValuesParser::new([auto].into_iter().chain(kinds)).map(|name| Glyphs::from_name(&name))
}

impl CellArgs {
    /// Returns whether `--color`, `--glyphs` or `--background` is given.
    pub(super) fn is_given(&self) -> bool {
        self.color.is_some() || self.glyphs.is_some() || self.background.is_some()
    }

    /// Returns a painter for a file, a pipe or a terminal that is not queried.
    pub(super) fn painter(&self, mode: CellMode) -> Painter {
        Painter::new(mode).with_light_background(self.light_background().unwrap_or(false))
    }

    fn light_background(&self) -> Option<bool> {
        self.background.filter(|&choice| choice != BackgroundArg::Auto).map(|choice| choice == BackgroundArg::Light)
    }

    /// Returns whether `--color` requires colours: neither `auto` nor `never`.
    pub(super) fn wants_color(&self) -> bool {
        !matches!(self.color_choice(), ColorChoice::Auto | ColorChoice::Never)
    }

    fn color_choice(&self) -> ColorChoice {
        match self.color {
            None | Some(ColorArg::Auto) => ColorChoice::Auto,
            Some(ColorArg::Always) => ColorChoice::Always,
            Some(ColorArg::Never) => ColorChoice::Never,
            Some(ColorArg::Truecolor) => ColorChoice::Exactly(Colors::Truecolor),
            Some(ColorArg::Indexed256) => ColorChoice::Exactly(Colors::Indexed256),
            Some(ColorArg::Indexed16) => ColorChoice::Exactly(Colors::SIXTEEN),
        }
    }

    fn glyph_choice(&self) -> GlyphChoice {
        self.glyphs.flatten()
    }

    /// Returns the hints from which a terminal's capabilities are detected: these flags, and
    /// environment variables.
    pub(super) fn detection_hints(&self, cell_aspect: Option<f32>) -> Hints {
        let mut hints = Hints::gather(&|name| std::env::var(name).ok(), &terminfo_colors);
        hints.color = self.color_choice();
        hints.glyphs = self.glyph_choice();
        hints.cell_aspect = cell_aspect;
        hints.light_background = self.light_background();
        hints
    }

    /// Returns the cell mode for a file or pipe, which does not depend on the environment.
    ///
    /// `auto` is the set of colours if `--color` is `auto`.
    pub(super) fn mode_for_file(&self, auto: Colors) -> CellMode {
        let colors = match self.color_choice() {
            ColorChoice::Auto => auto,
            ColorChoice::Always => Colors::Truecolor,
            ColorChoice::Never => Colors::None,
            ColorChoice::Exactly(colors) => colors,
        };
        let auto = if colors == Colors::None { Glyphs::Ascii } else { Glyphs::Half };
        CellMode { glyphs: self.glyph_choice().unwrap_or(auto), colors }
    }
}
