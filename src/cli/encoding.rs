//! How the encoder turns grids into bytes: the flags of every command that sends frames.

use clap::{Args, ValueEnum};
use termtrace::encode;

/// Stands below the options in the help.
pub(super) const EXPLAINED: &str = "\
The order of cells:
  color    so that colours are reused: the fewest bytes on a plain link
  raster   row by row: more bytes, but a compressor makes the least of them, because each frame resembles the last
  ssh's own setting cannot be seen from here, so a link that compresses has to be told by --compressed-link.";

#[derive(Args)]
pub(super) struct EncodingArgs {
    /// In which order changed cells are sent [default: color]
    #[arg(long, value_name = "ORDER", conflicts_with = "compressed_link")]
    order: Option<Order>,
    /// The link compresses, as ssh -C does: --order raster
    #[arg(long)]
    compressed_link: bool,
}

#[derive(Clone, Copy, ValueEnum)]
enum Order {
    Color,
    Raster,
}

impl EncodingArgs {
    /// Whether anything of it was said.
    pub(super) fn is_given(&self) -> bool {
        self.order.is_some() || self.compressed_link
    }

    pub(super) fn order(&self) -> encode::Order {
        match self.order {
            Some(Order::Raster) => encode::Order::Raster,
            None if self.compressed_link => encode::Order::Raster,
            Some(Order::Color) | None => encode::Order::Color,
        }
    }
}
