//! `--map`: what the commands that make pictures show of the scene.

use super::outcome::{CommandResult, Failure};
use super::settings::defaults;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::num::NonZeroU32;
use termtrace::{Map, Sampling};

/// Stands below the options in the help.
pub(super) const MAP_HELP: &str = "\
Maps (--map); all but the first trace one ray per pixel:
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
pub(super) struct MapArgs {
    #[arg(long, help = defaults::help("map", "The shaded picture, or a map of the scene"), value_name = "MAP", value_parser = map_parser(), hide_possible_values = true)]
    map: Option<Map>,
}

fn map_parser() -> impl TypedValueParser<Value = Map> {
    PossibleValuesParser::new(Map::ALL.map(Map::name)).map(|name| Map::named(&name).unwrap_or_default())
}

impl MapArgs {
    pub(super) fn map(&self) -> Map {
        self.map.unwrap_or_default()
    }

    /// Refuses more samples than one for each pixel where the map has no use for them.
    pub(super) fn check_samples(&self, sampling: Sampling) -> CommandResult {
        let map = self.map();
        if map.refines() || sampling == Sampling::Each(NonZeroU32::MIN) {
            return Ok(());
        }
        let name = map.name();
        Err(Failure::Usage(format!("--samples is for the shaded picture: --map {name} has one ray for each pixel")))
    }
}
