//! What the picture's cells are made of: the flags of the commands that show cells.

use super::settings::defaults;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueEnum};
use termtrace::internals::capabilities::{ColorChoice, GlyphChoice, Hints, terminfo_colors};
use termtrace::{CellMode, Colors, Glyphs};

const CELL_HELP: &str = "\
The colours (--color):
  auto       as many as the terminal has, by NO_COLOR, CLICOLOR_FORCE, FORCE_COLOR, COLORTERM, its own answer,
             terminfo and TERM; termtrace doctor says who said what
  always     the same, but at least 16 and whatever NO_COLOR says
  never      none: no escape sequence says anything of colours
  truecolor, 256, 16
             just these; of few colours the picture is mixed by dithering
What stands in the cells (--glyphs):
  auto       half blocks; shape where there is no colour, the locale is not UTF-8, or a block is not one column wide";

/// Stands below the options in the help.
pub(super) fn after_help() -> String {
    Glyphs::ALL
        .iter()
        .fold(CELL_HELP.to_owned(), |text, glyphs| format!("{text}\n  {:<9}  {}", glyphs.name(), glyphs.help()))
}

#[derive(Args)]
pub(super) struct CellArgs {
    #[arg(long, help = defaults::help("color", "Which colours the picture may have"), value_name = "WHICH")]
    color: Option<ColorArg>,
    #[arg(long, help = defaults::help("glyphs", "What its cells are made of"), value_name = "KIND", value_parser = glyph_parser())]
    glyphs: Option<GlyphChoice>,
}

#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
enum ColorArg {
    Auto,
    Always,
    Never,
    Truecolor,
    #[value(name = "256")]
    Indexed256,
    #[value(name = "16")]
    Indexed16,
}

/// What leaves the choice to the terminal, or to the format of the file.
const AUTO: &str = "auto";

fn glyph_parser() -> impl TypedValueParser<Value = GlyphChoice> {
    let names = Glyphs::ALL.iter().map(|glyphs| glyphs.name());
    PossibleValuesParser::new([AUTO].into_iter().chain(names)).map(|name| Glyphs::from_name(&name))
}

impl CellArgs {
    /// Whether anything of it was said.
    pub(super) fn is_given(&self) -> bool {
        self.color.is_some() || self.glyphs.is_some()
    }

    /// Whether colours were asked for.
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

    /// What is wanted of a terminal, and what the environment tells of it.
    pub(super) fn hints(&self, cell_aspect: Option<f32>) -> Hints {
        let mut hints = Hints::gather(&|name| std::env::var(name).ok(), &terminfo_colors);
        hints.color = self.color_choice();
        hints.glyphs = self.glyph_choice();
        hints.cell_aspect = cell_aspect;
        hints
    }

    /// For a file or a pipe, of which the environment says nothing: in these colours if any will do. Without colours it is
    /// the ramp, which is the text that people compare.
    pub(super) fn mode_for_file(&self, auto: Colors) -> CellMode {
        let colors = match self.color_choice() {
            ColorChoice::Auto => auto,
            ColorChoice::Always => Colors::Truecolor,
            ColorChoice::Never => Colors::None,
            ColorChoice::Exactly(colors) => colors,
        };
        let auto = if colors == Colors::None { Glyphs::Ramp } else { Glyphs::Half };
        CellMode { glyphs: self.glyph_choice().unwrap_or(auto), colors }
    }
}
