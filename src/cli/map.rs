//! `--map`: the shaded picture or a map of the scene, for the commands that make pictures.

use super::outcome::{CommandResult, Failure};
use super::settings::defaults;
use clap::Args;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use std::num::NonZeroU32;
use termtrace::{Map, Sampling};

/// The help text below the options.
pub(super) const MAP_HELP: &str = "\
Maps (--map); all but shaded trace one ray per pixel:
  shaded     the lit picture
  lambert    the sum of n.l over all lights, at most 1: no colours, no shadows
  depth      the distance: white at the eye, half as light at the target's distance, black far away
  normal     (n + 1) / 2 as red, green and blue
  object     one colour per object
  shadow     the lights that reach the surface: dark grey for none, white for all
  cost       the number of surfaces and tree nodes that the pixel's rays are tested against: blue 1, green 16, red 256
  facing     front sides blue, back sides red
  contrast   black and white, with lines between objects";

#[derive(Args)]
pub(super) struct MapArgs {
    #[arg(long, value_name = "MAP", value_parser = map_parser(), hide_possible_values = true)]
    #[arg(help = defaults::help("map", "The shaded picture, or a map of the scene"))]
    map: Option<Map>,
}

fn map_parser() -> impl TypedValueParser<Value = Map> {
    PossibleValuesParser::new(Map::ALL.map(Map::name)).map(|name| Map::named(&name).unwrap_or_default())
}

impl MapArgs {
    pub(super) fn map(&self) -> Map {
        self.map.unwrap_or_default()
    }

    /// Refuses more than one sample per pixel for a map whose values cannot be averaged: the mean
    /// of two object numbers has no meaning.
    pub(super) fn check_samples(&self, given: Option<Sampling>) -> CommandResult {
        let map = self.map();
        if map.refines() || given.is_none_or(|sampling| sampling == Sampling::Each(NonZeroU32::MIN)) {
            return Ok(());
        }
        let name = map.name();
        Err(Failure::Usage(format!("--samples is for the shaded picture: --map {name} traces one ray per pixel")))
    }
}
