//! The table of what was detected about the terminal.

use crate::cli::settings::Settings;
use serde_json::{Value, json};
use std::fmt::Write;
use std::time::Duration;
use termtrace::internals::capabilities::{Detected, Findings, HalfBlocks, Hints, Replies, SafeQueries, Shifts, Source};
use termtrace::internals::text::visible_lines;
use termtrace::{CellMode, Colors};

/// The outcome of the queries to the terminal.
#[derive(Clone, Copy)]
pub(super) enum QueryOutcome {
    /// Standard input or output is not a terminal.
    NoTerminal,
    /// All replies arrived; the last one after this time, or zero if no query was sent.
    Answered(Duration),
    /// The last reply did not arrive within [`QUERY_TIMEOUT`](super::QUERY_TIMEOUT).
    TimedOut,
}

/// The inputs of the report that `termtrace doctor` prints.
pub(super) struct DoctorReport<'a> {
    pub(super) settings: &'a Settings,
    pub(super) hints: &'a Hints,
    pub(super) findings: &'a Findings,
    pub(super) replies: &'a Replies,
    pub(super) outcome: QueryOutcome,
}

pub(super) fn text(report: &DoctorReport<'_>) -> String {
    let term = report.hints.variable("TERM").unwrap_or_default();
    let version = env!("CARGO_PKG_VERSION");
    let mut text = format!("{}\n", report.verdict());
    let _ = writeln!(text, "This terminal (TERM={term}): capabilities and their sources; termtrace {version}");
    for (what, value, source) in report.rows() {
        let _ = writeln!(text, "{what:<20}  {value:<28}  {source}");
    }
    // Made printable, because TERM and the locale come from the environment and may contain escape sequences.
    visible_lines(&text)
}

/// Returns the rows of the report as JSON.
pub(super) fn as_json(report: &DoctorReport<'_>) -> Value {
    let rows = report.rows().into_iter();
    let rows = rows.map(|(name, value, source)| json!({ "name": name, "value": value, "source": source }));
    json!({
        "verdict": report.verdict(),
        "term": report.hints.variable("TERM"),
        "version": env!("CARGO_PKG_VERSION"),
        "capabilities": rows.collect::<Vec<_>>(),
    })
}

/// A row of the table: a capability, its value, and the source that decided the value.
type ReportRow = (&'static str, String, String);

impl DoctorReport<'_> {
    /// Returns whether the program works well here, and otherwise its limits, in a sentence.
    fn verdict(&self) -> String {
        if matches!(self.outcome, QueryOutcome::NoTerminal) {
            return "Not a terminal: this is what the environment and flags say.".to_owned();
        }
        let findings = self.findings;
        let few = |count| format!("{count} colours (--color truecolor if it can show more)");
        let limits = [
            match findings.colors.value {
                Colors::None => Some("no colours".to_owned()),
                Colors::Indexed16(_) => Some(few("16")),
                Colors::Indexed256 => Some(few("256")),
                Colors::Truecolor => None,
            },
            (findings.glyphs.value != CellMode::HALF_BLOCK.glyphs).then(|| "no half blocks".to_owned()),
            // Without measured cells a circle may be an ellipse.
            (findings.cell_aspect.source == Source::Assumed)
                .then(|| "the cell's shape is a guess (--cell-aspect sets it)".to_owned()),
            (!findings.kitty_keyboard.value).then(|| "no key releases, so that a tap is a small step".to_owned()),
            (self.replies.sgr_mouse != Some(true)).then(|| "the mouse is not reported for certain".to_owned()),
        ];
        let limits: Vec<_> = limits.into_iter().flatten().collect();
        if limits.is_empty() {
            return "All is well: truecolor, half blocks, a known cell shape, key releases, the mouse.".to_owned();
        }
        format!("Works, with limits: {}.", limits.join("; "))
    }

    fn rows(&self) -> Vec<ReportRow> {
        let findings = self.findings;
        vec![
            self.queries(),
            self.overridable_row("colours", "color", findings.colors, colors),
            self.locale(),
            self.overridable_row("cells", self.setting_deciding_glyphs(), findings.glyphs, |cells| {
                let at_rest =
                    findings.resting_glyphs.map_or_else(String::new, |it| format!("; at rest {}", it.title()));
                cells.title().to_owned() + &self.block_width() + &at_rest
            }),
            self.overridable_row("cell, height/width", "cell_aspect", findings.cell_aspect, |aspect| {
                format!("{aspect:.3}{}", self.cell_pixels())
            }),
            self.half_blocks(),
            self.background(),
            self.palette(),
            self.synchronized_output(),
            self.yes_no_row("kitty keyboard", findings.kitty_keyboard),
            self.mouse(),
        ]
    }

    /// Returns the row of a capability that the setting `setting` may override.
    fn overridable_row<T>(
        &self,
        what: &'static str,
        setting: &str,
        found: Detected<T>,
        shown: impl FnOnce(T) -> String,
    ) -> ReportRow {
        match found.source {
            Source::User => (what, shown(found.value), self.settings.source(setting).to_string()),
            _ => row(what, found, shown),
        }
    }

    /// Returns the setting that decides the glyphs: `glyphs` if it is set, otherwise `color`,
    /// because without colours other glyphs are used.
    fn setting_deciding_glyphs(&self) -> &'static str {
        if self.hints.glyphs.is_some() { "glyphs" } else { "color" }
    }

    fn queries(&self) -> ReportRow {
        let sent = match self.hints.safe_queries() {
            _ if matches!(self.outcome, QueryOutcome::NoTerminal) => "none: not a terminal",
            SafeQueries::None => "none, because of its name",
            SafeQueries::Console => "those that a console knows",
            SafeQueries::Screen => "those that screen knows",
            SafeQueries::Tmux => "those that tmux knows",
            SafeQueries::All => "all",
        };
        let reply = match self.outcome {
            QueryOutcome::NoTerminal => "-".to_owned(),
            QueryOutcome::Answered(_) if self.hints.safe_queries() == SafeQueries::None => "-".to_owned(),
            QueryOutcome::Answered(after) => format!("replies after {} ms", after.as_millis()),
            QueryOutcome::TimedOut => "replies incomplete after 2 s".to_owned(),
        };
        ("queries sent", sent.to_owned(), reply)
    }

    fn locale(&self) -> ReportRow {
        let (value, source) = match self.hints.locale() {
            Some((name, locale)) => (locale, name.to_owned()),
            None => ("not set: UTF-8 assumed".to_owned(), source_name(Source::Assumed)),
        };
        ("locale", value, source)
    }

    /// Returns the measured width of a half block, such as ", 1 column"; empty if it was not
    /// measured.
    fn block_width(&self) -> String {
        self.replies.block_width.map_or_else(String::new, |width| format!(", {}", columns(width)))
    }

    fn cell_pixels(&self) -> String {
        self.replies.cell_pixels.map_or_else(String::new, |(width, height)| format!(" ({width}x{height} pixels)"))
    }

    fn reply_row(&self, what: &'static str, reply: Option<String>) -> ReportRow {
        match reply {
            Some(reply) => (what, reply, "its reply".to_owned()),
            None => (what, "unknown".to_owned(), self.no_reply().to_owned()),
        }
    }

    fn no_reply(&self) -> &'static str {
        match (self.outcome, self.hints.safe_queries()) {
            (QueryOutcome::NoTerminal, _) | (_, SafeQueries::None) => "not queried",
            (_, SafeQueries::All) => "no reply",
            // A console, screen or tmux is sent only some of the queries, perhaps not the one about this capability.
            _ => "no reply, or not queried",
        }
    }

    fn yes_no_row(&self, what: &'static str, found: Detected<bool>) -> ReportRow {
        if found.source == Source::Assumed {
            return (what, "unknown (assumed no)".to_owned(), self.no_reply().to_owned());
        }
        row(what, found, yes_or_no)
    }

    // In one row with the moves of cells, which need it, so that the report and its card fit into 24 rows.
    fn synchronized_output(&self) -> ReportRow {
        let (what, found) = ("synchronized output", self.findings.synchronized_output);
        match self.findings.shifts.value {
            Shifts::Off => self.yes_no_row(what, found),
            Shifts::Direct | Shifts::ThroughTmux => row(what, found, |_| "yes, and moves cells".to_owned()),
        }
    }

    fn half_blocks(&self) -> ReportRow {
        let Detected { value, source } = self.findings.half_blocks;
        self.yes_no_row("half blocks join", Detected { value: value == HalfBlocks::Either, source })
    }

    fn background(&self) -> ReportRow {
        let found = self.findings.light_background;
        let kind = if found.value { "light" } else { "dark" };
        if found.source == Source::User {
            return self.overridable_row("background", "background", found, |_| kind.to_owned());
        }
        match self.replies.background {
            Some(c) => self.reply_row("background", Some(format!("{kind}, #{:02x}{:02x}{:02x}", c.r, c.g, c.b))),
            None => ("background", format!("unknown (assumed {kind})"), self.no_reply().to_owned()),
        }
    }

    fn palette(&self) -> ReportRow {
        let count = self.replies.sixteen.iter().flatten().count();
        self.reply_row("palette", (count > 0).then(|| format!("{count} of 16 colours known")))
    }

    fn mouse(&self) -> ReportRow {
        let units = match (self.replies.sgr_mouse, self.replies.pixel_mouse) {
            (None, None) => None,
            (cells, pixels) => Some(match (cells.unwrap_or(false), pixels.unwrap_or(false)) {
                (true, true) => "in cells and in pixels",
                (true, false) => "in cells",
                (false, true) => "in pixels",
                (false, false) => "none",
            }),
        };
        self.reply_row("mouse reports", units.map(str::to_owned))
    }
}

fn row<T>(what: &'static str, found: Detected<T>, shown: impl FnOnce(T) -> String) -> ReportRow {
    (what, shown(found.value), source_name(found.source))
}

fn source_name(source: Source) -> String {
    let name = match source {
        Source::User => "the user",
        Source::Variable(name) => name,
        Source::Window => "the window's pixels",
        Source::Reply => "its reply",
        Source::Terminfo => "terminfo",
        Source::Assumed => "assumed",
    };
    name.to_owned()
}

fn colors(colors: Colors) -> String {
    match colors {
        Colors::None => "none",
        Colors::Indexed16(_) => "16",
        Colors::Indexed256 => "256",
        Colors::Truecolor => "truecolor",
    }
    .to_owned()
}

fn columns(count: u16) -> String {
    if count == 1 { "1 column".to_owned() } else { format!("{count} columns") }
}

fn yes_or_no(yes: bool) -> String {
    if yes { "yes" } else { "no" }.to_owned()
}
