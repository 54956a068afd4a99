//! How the encoder turns grids into bytes: the flags of every command that sends frames.

use super::settings::defaults;
use clap::{Args, ValueEnum};
use termtrace::internals::encode;

/// Stands below the options in the help.
pub(super) const ENCODING_HELP: &str = "\
The order of cells:
  color    so that colours are reused: the fewest bytes on a plain link
  raster   row by row: more bytes, but a compressor makes the least of them, because each frame resembles the last;
           and less work
  ssh's own setting cannot be seen from here, so a link that compresses has to be told by --compressed-link.
The quality of a picture in motion (what stands still is exact within a second, and text always is):
  exact    every half cell has its colour
  equal    within 0.01 of it in OKLab, which nobody sees, and 44 dB; half the bytes or less
  fast     within 0.02, and 41 dB; fewer still";

#[derive(Args)]
pub(super) struct EncodingArgs {
    #[command(flatten)]
    order: OrderArgs,
    #[command(flatten)]
    pub(super) loss: LossArgs,
}

/// In which order.
#[derive(Args)]
pub(super) struct OrderArgs {
    /// In which order changed cells are sent [default: color; live, raster until the link is found slow]
    #[arg(long, value_name = "ORDER", conflicts_with = "compressed_link")]
    order: Option<OrderArg>,
    /// The link compresses, as ssh -C does: --order raster
    #[arg(long)]
    compressed_link: bool,
}

/// What may be lost on the way.
#[derive(Args)]
pub(super) struct LossArgs {
    #[arg(long, help = defaults::help("quality", "How near a moving picture is to the right one; it decides bytes, not rays"), value_name = "QUALITY")]
    quality: Option<QualityArg>,
    #[arg(long, help = defaults::help("max_rate", "The most bytes per second in the mean, such as 50k or 2M; what is most wrong is sent first"), value_name = "BYTES", value_parser = parse_rate)]
    max_rate: Option<u32>,
}

#[derive(Clone, Copy, ValueEnum)]
enum OrderArg {
    Color,
    Raster,
}

#[derive(Clone, Copy, ValueEnum)]
enum QualityArg {
    Exact,
    Equal,
    Fast,
}

impl EncodingArgs {
    /// Whether anything of it was said.
    pub(super) fn is_given(&self) -> bool {
        self.order().is_some() || self.loss.quality.is_some() || self.loss.max_rate.is_some()
    }

    /// If it was said.
    pub(super) fn order(&self) -> Option<encode::Order> {
        self.order.order()
    }
}

impl OrderArgs {
    /// If it was said.
    pub(super) fn order(&self) -> Option<encode::Order> {
        match self.order {
            Some(OrderArg::Raster) => Some(encode::Order::Raster),
            Some(OrderArg::Color) => Some(encode::Order::Color),
            None => self.compressed_link.then_some(encode::Order::Raster),
        }
    }
}

impl LossArgs {
    /// If it was said.
    pub(super) fn quality(&self) -> Option<encode::Quality> {
        self.quality.map(|quality| match quality {
            QualityArg::Exact => encode::Quality::Exact,
            QualityArg::Equal => encode::Quality::Equal,
            QualityArg::Fast => encode::Quality::Fast,
        })
    }

    /// In bytes per second.
    pub(super) fn max_rate(&self) -> Option<u32> {
        self.max_rate
    }
}

/// A whole number of bytes, with k for thousands or M for millions: from 1,000 on, with which a screen takes seconds.
fn parse_rate(text: &str) -> Result<u32, String> {
    let (digits, unit) = match text.strip_suffix(['k', 'K']) {
        Some(digits) => (digits, 1_000),
        None => text.strip_suffix(['m', 'M']).map_or((text, 1), |digits| (digits, 1_000_000)),
    };
    let rate = digits.parse::<u32>().ok().and_then(|number| number.checked_mul(unit));
    rate.filter(|&rate| rate >= 1_000)
        .ok_or_else(|| "expected bytes per second from 1000 on, such as 50k or 2M".to_owned())
}
