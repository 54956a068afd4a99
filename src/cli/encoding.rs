//! `--order`, `--quality` and related flags: how the encoder turns grids into bytes.

use super::settings::defaults;
use clap::{Args, ValueEnum};
use termtrace::internals::encode;

#[derive(Args)]
pub(super) struct EncodingArgs {
    #[command(flatten)]
    order: OrderArgs,
    #[command(flatten)]
    pub(super) loss: LossArgs,
}

/// The flags for the order in which cells are sent.
#[derive(Args)]
#[command(next_help_heading = "Link")]
pub(super) struct OrderArgs {
    /// Order in which changed cells are sent [default: color; live, raster until the link is found
    /// slow]
    #[arg(long, value_name = "ORDER", conflicts_with = "compressed_link", hide_short_help = true)]
    order: Option<OrderArg>,
    /// The link compresses, as ssh -C does: send cells row by row (--order raster)
    ///
    /// Rows compress best, because each frame resembles the last. The program cannot see whether
    /// ssh compresses.
    #[arg(long, hide_short_help = true)]
    compressed_link: bool,
}

/// The flags for lossy encoding.
#[derive(Args)]
#[command(next_help_heading = "Link")]
pub(super) struct LossArgs {
    #[arg(long, value_name = "QUALITY", hide_short_help = true)]
    #[arg(help = defaults::help("quality", "Fidelity of the picture while it moves: lower sends fewer bytes"))]
    quality: Option<QualityArg>,
    #[arg(long, value_name = "BYTES", value_parser = parse_rate, hide_short_help = true)]
    #[arg(help = defaults::help("max_rate", "Limit on the average number of bytes sent per second, such as 50k or 2M"))]
    max_rate: Option<u32>,
}

#[derive(Clone, Copy, ValueEnum)]
enum OrderArg {
    /// By colour, so that colour changes are rare: the fewest bytes on a link without compression
    Color,
    /// Row by row: more bytes, but they compress best, because each frame resembles the last;
    /// less computing
    Raster,
}

/// Values of `--moves`.
#[derive(Clone, Copy, PartialEq, Eq, ValueEnum)]
pub(super) enum MovesArg {
    /// Where the terminal is known to move cells, and shows each frame at once
    Auto,
    /// Never: each changed cell is sent
    Off,
}

/// Values of `--quality`. A still picture is exact within a second, and text always is.
#[derive(Clone, Copy, ValueEnum)]
enum QualityArg {
    /// Every half cell has its exact colour
    Exact,
    // The distances in these texts of the help are those of colours in OKLab.
    /// Within a distance of 0.01, which is invisible, and 44 dB; half the bytes or less
    Equal,
    /// Within 0.02, and 41 dB; fewer bytes still
    Fast,
}

impl EncodingArgs {
    /// Returns whether any of the encoding flags is given.
    pub(super) fn is_given(&self) -> bool {
        self.cell_order().is_some() || self.loss.quality.is_some() || self.loss.max_rate.is_some()
    }

    /// Returns the order of cells, if `--order` or `--compressed-link` is given.
    pub(super) fn cell_order(&self) -> Option<encode::Order> {
        self.order.cell_order()
    }
}

impl OrderArgs {
    /// Returns the order of cells, if `--order` or `--compressed-link` is given.
    pub(super) fn cell_order(&self) -> Option<encode::Order> {
        match self.order {
            Some(OrderArg::Raster) => Some(encode::Order::Raster),
            Some(OrderArg::Color) => Some(encode::Order::Color),
            None => self.compressed_link.then_some(encode::Order::Raster),
        }
    }
}

impl LossArgs {
    /// Returns the value of `--quality`, if given.
    pub(super) fn given_quality(&self) -> Option<encode::Quality> {
        self.quality.map(|quality| match quality {
            QualityArg::Exact => encode::Quality::Exact,
            QualityArg::Equal => encode::Quality::Equal,
            QualityArg::Fast => encode::Quality::Fast,
        })
    }

    /// Returns the value of `--max-rate` in bytes per second, if given.
    pub(super) fn given_max_rate(&self) -> Option<u32> {
        self.max_rate
    }
}

/// Parses a number of bytes per second, such as `50k` or `1M` (k is 1,000, M is 1,000,000). At
/// least 1,000, because at lower rates a single screen would take many seconds.
pub(super) fn parse_rate(text: &str) -> Result<u32, String> {
    let (digits, unit) = match text.strip_suffix(['k', 'K']) {
        Some(digits) => (digits, 1_000),
        None => text.strip_suffix(['m', 'M']).map_or((text, 1), |digits| (digits, 1_000_000)),
    };
    let rate = digits.parse::<u32>().ok().and_then(|number| number.checked_mul(unit));
    rate.filter(|&rate| rate >= 1_000)
        .ok_or_else(|| "expected bytes per second from 1000 on, such as 50k or 2M".to_owned())
}
