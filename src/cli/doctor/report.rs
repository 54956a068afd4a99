//! What is known of the terminal, as a table.

use crate::cli::settings::Settings;
use std::fmt::Write;
use std::time::Duration;
use termtrace::Colors;
use termtrace::internals::capabilities::{Detected, Findings, HalfBlocks, Hints, Replies, SafeQueries, Source};
use termtrace::internals::text::visible_lines;

/// How the talk with the terminal went.
#[derive(Clone, Copy)]
pub(super) enum QueryOutcome {
    /// There is no terminal.
    NoTerminal,
    /// The last answer came after that time; at once, where nothing was asked.
    Answered(Duration),
    /// It came too late, or never.
    TimedOut,
}

/// All that is to be told.
pub(super) struct Report<'a> {
    pub(super) settings: &'a Settings,
    pub(super) hints: &'a Hints,
    pub(super) findings: &'a Findings,
    pub(super) replies: &'a Replies,
    pub(super) outcome: QueryOutcome,
}

pub(super) fn text(report: &Report<'_>) -> String {
    let term = report.hints.variable("TERM").unwrap_or_default();
    let version = env!("CARGO_PKG_VERSION");
    let mut text = format!("What this terminal (TERM={term}) can do, and who says so; termtrace {version}\n");
    for (what, value, who) in report.rows() {
        let _ = writeln!(text, "{what:<20}  {value:<28}  {who}");
    }
    // A name is not to steer the terminal that it is printed on.
    visible_lines(&text)
}

type ReportRow = (&'static str, String, String);

impl Report<'_> {
    fn rows(&self) -> Vec<ReportRow> {
        let findings = self.findings;
        vec![
            self.questions(),
            self.set("colours", "color", findings.colors, colors),
            self.locale(),
            self.set("cells", self.chosen_by(), findings.glyphs, |cells| cells.title().to_owned() + &self.width()),
            self.set("cell, height/width", "cell_aspect", findings.cell_aspect, |aspect| {
                format!("{aspect:.3}{}", self.pixels())
            }),
            self.half_blocks(),
            self.background(),
            self.sixteen(),
            self.yes("synchronized output", findings.synchronized_output),
            self.yes("kitty keyboard", findings.kitty_keyboard),
            self.mouse(),
        ]
    }

    /// What the user may have set, by that setting.
    fn set<T>(
        &self,
        what: &'static str,
        setting: &str,
        found: Detected<T>,
        say: impl FnOnce(T) -> String,
    ) -> ReportRow {
        match found.source {
            Source::User => (what, say(found.value), self.settings.source(setting).to_string()),
            _ => row(what, found, say),
        }
    }

    /// The setting that says what stands in cells: without colours it is that of the colours.
    fn chosen_by(&self) -> &'static str {
        if self.hints.glyphs.is_some() { "glyphs" } else { "color" }
    }

    fn questions(&self) -> ReportRow {
        let asked = match self.hints.safe_queries() {
            _ if matches!(self.outcome, QueryOutcome::NoTerminal) => "nothing: there is none here",
            SafeQueries::None => "nothing, by its name",
            SafeQueries::Console => "what a console understands",
            SafeQueries::Screen => "what screen understands",
            SafeQueries::Tmux => "what tmux understands",
            SafeQueries::All => "everything",
        };
        let how = match self.outcome {
            QueryOutcome::NoTerminal => "-".to_owned(),
            QueryOutcome::Answered(_) if self.hints.safe_queries() == SafeQueries::None => "-".to_owned(),
            QueryOutcome::Answered(after) => format!("answered after {} ms", after.as_millis()),
            QueryOutcome::TimedOut => "no end of answers in 2 s".to_owned(),
        };
        ("it was asked", asked.to_owned(), how)
    }

    fn locale(&self) -> ReportRow {
        let (value, who) = match self.hints.locale() {
            Some((name, locale)) => (locale, name.to_owned()),
            None => ("none: taken for UTF-8".to_owned(), source_name(Source::Assumed)),
        };
        ("locale", value, who)
    }

    /// How many columns a half block takes.
    fn width(&self) -> String {
        self.replies.block_width.map_or_else(String::new, |width| format!(", {}", columns(width)))
    }

    fn pixels(&self) -> String {
        self.replies.cell_pixels.map_or_else(String::new, |(width, height)| format!(" ({width}x{height} pixels)"))
    }

    fn answered(&self, what: &'static str, answer: Option<String>) -> ReportRow {
        match answer {
            Some(answer) => (what, answer, "its answer".to_owned()),
            None => (what, "not known".to_owned(), self.no_answer().to_owned()),
        }
    }

    fn no_answer(&self) -> &'static str {
        match (self.outcome, self.hints.safe_queries()) {
            (QueryOutcome::NoTerminal, _) | (_, SafeQueries::None) => "not asked",
            (_, SafeQueries::All) => "no answer",
            _ => "no answer, or not asked",
        }
    }

    fn yes(&self, what: &'static str, found: Detected<bool>) -> ReportRow {
        if found.source == Source::Assumed {
            return (what, "not known: no".to_owned(), self.no_answer().to_owned());
        }
        row(what, found, yes_or_no)
    }

    fn half_blocks(&self) -> ReportRow {
        let Detected { value, source } = self.findings.half_blocks;
        self.yes("half blocks meet", Detected { value: value == HalfBlocks::Either, source })
    }

    fn background(&self) -> ReportRow {
        let kind = if self.findings.light_background.value { "light" } else { "dark" };
        match self.replies.background {
            Some(c) => self.answered("background", Some(format!("{kind}, #{:02x}{:02x}{:02x}", c.r, c.g, c.b))),
            None => ("background", format!("not known: {kind}"), self.no_answer().to_owned()),
        }
    }

    fn sixteen(&self) -> ReportRow {
        let count = self.replies.sixteen.iter().flatten().count();
        self.answered("its 16 colours", (count > 0).then(|| format!("{count} known")))
    }

    fn mouse(&self) -> ReportRow {
        let what = "mouse, by pixels";
        match (self.replies.sgr_mouse, self.replies.pixel_mouse) {
            (None, None) => self.answered(what, None),
            (cells, pixels) => {
                let say = |known: Option<bool>| yes_or_no(known.unwrap_or(false));
                self.answered(what, Some(format!("{}, {}", say(cells), say(pixels))))
            }
        }
    }
}

fn row<T>(what: &'static str, found: Detected<T>, say: impl FnOnce(T) -> String) -> ReportRow {
    (what, say(found.value), source_name(found.source))
}

fn source_name(source: Source) -> String {
    let name = match source {
        Source::User => "the user",
        Source::Variable(name) => name,
        Source::Window => "the window's pixels",
        Source::Reply => "its answer",
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
