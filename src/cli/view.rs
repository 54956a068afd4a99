//! What of the scene is shown: the flag of the commands that make pictures.

use super::outcome::{Done, Failure};
use super::settings::defaults;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::num::NonZeroU32;
use termtrace::render::Sampling;
use termtrace::view::View;

/// Stands below the options in the help.
pub(super) const EXPLAINED: &str = "\
What is shown (--view); all but the first trace one ray for each pixel:
  shaded     the light
  lambert    n.l of all lights, at most 1: no colours, no shadows
  depth      how far away it is: white at the eye, half as light at the target's distance, black far away
  normal     (n + 1) / 2 as red, green and blue
  object     a colour for each object
  shadow     dark grey where no light arrives, white where all do
  cost       how many surfaces and nodes of the tree the pixel's rays are tested against: blue 1, green 16, red 256
  facing     the front of surfaces blue, the back red
  contrast   black and white, with lines between objects";

#[derive(Args)]
pub(super) struct ViewArgs {
    #[arg(long, help = defaults::help("view", "What of the scene is shown"), value_name = "VIEW", value_parser = view_parser(), hide_possible_values = true)]
    view: Option<View>,
}

fn view_parser() -> impl TypedValueParser<Value = View> {
    PossibleValuesParser::new(View::ALL.map(View::name)).map(|name| View::named(&name).unwrap_or_default())
}

impl ViewArgs {
    pub(super) fn view(&self) -> View {
        self.view.unwrap_or_default()
    }

    /// Turns away samples that the view makes no use of.
    pub(super) fn check_samples(&self, sampling: Sampling) -> Done {
        let view = self.view();
        if view.refines() || sampling == Sampling::Each(NonZeroU32::MIN) {
            return Ok(());
        }
        let name = view.name();
        Err(Failure::Usage(format!("--samples is for the shaded view: --view {name} has one ray for each pixel")))
    }
}
