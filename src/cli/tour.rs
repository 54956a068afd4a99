//! `termtrace tour`: the built-in scenes in the order of the lecture, each with its caption.

use super::live::{Opening, ViewArgs, live_source, open_view};
use super::outcome::{CommandResult, write_stdout};
use super::scene_args::CameraArgs;
use super::scene_source::SceneSource;
use super::shipped::ShippedScene;
use clap::{ArgMatches, Args};
use std::io::{self, IsTerminal};

const EXAMPLES: &str = "\
n shows the next scene and p the previous one; ' turns the pages of a caption
and hides it.

Examples:
  termtrace tour
  termtrace tour | less             read the captions";

#[derive(Args)]
#[command(after_long_help = EXAMPLES)]
pub(super) struct TourArgs {
    #[command(flatten)]
    view: ViewArgs,
}

/// Opens the tour in the live view, or prints its captions if standard output is not a terminal.
pub(super) fn run(args: &TourArgs, given: &ArgMatches) -> CommandResult {
    if !io::stdout().is_terminal() {
        return print_captions();
    }
    let sources = || {
        Ok(ShippedScene::all().map(|scene| live_source(SceneSource::Shipped(scene), &CameraArgs::default())).collect())
    };
    open_view(&args.view, given, Opening::Tour(ShippedScene::all().count()), None, sources)
}

fn print_captions() -> CommandResult {
    let mut text = String::new();
    for scene in ShippedScene::all() {
        let loaded = CameraArgs::default().load_scene(&SceneSource::Shipped(scene))?;
        let caption = loaded.caption().map_or("", |caption| caption);
        let gap = if text.is_empty() { "" } else { "\n" };
        text.extend([gap, scene.name, "\n", caption, "\n"]);
    }
    write_stdout(text.as_bytes())
}
