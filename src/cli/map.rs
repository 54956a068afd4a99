//! `--map`: the shaded picture or a map of the scene, for the commands that make pictures.

use super::help::capitalized;
use super::outcome::{CommandResult, Failure};
use super::settings::defaults;
use clap::Args;
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use std::num::NonZeroU32;
use termtrace::{Map, Sampling};

/// Each map and what it shows. All but the first trace one ray per pixel.
const MAPS: [(Map, &str); Map::ALL.len()] = [
    (Map::Shaded, "the lit picture"),
    (Map::Lambert, "the sum of n.l over all lights, at most 1: no colours, no shadows"),
    (Map::Depth, "the distance: white at the eye, half as light at the target's distance, black far away"),
    (Map::Normal, "(n + 1) / 2 as red, green and blue"),
    (Map::Object, "one colour per object"),
    (Map::Shadow, "the lights that reach the surface: dark grey for none, white for all"),
    (Map::Cost, "the surfaces and tree nodes that a pixel's rays are tested against: blue 1, green 16, red 256"),
    (Map::Facing, "front sides blue, back sides red"),
    (Map::Contrast, "black and white, with lines between objects"),
    (Map::Wire, "the edges of triangles"),
];

#[derive(Args)]
#[command(next_help_heading = "Picture")]
pub(super) struct MapArgs {
    #[arg(long, value_name = "MAP", value_parser = map_parser(), hide_short_help = true)]
    #[arg(help = defaults::help("map", "The shaded picture, or a map of the scene"))]
    map: Option<Map>,
}

fn map_parser() -> impl TypedValueParser<Value = Map> {
    let maps = MAPS.map(|(map, help)| PossibleValue::new(map.name()).help(capitalized(help)));
    PossibleValuesParser::new(maps).map(|name| Map::named(&name).unwrap_or_default())
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
