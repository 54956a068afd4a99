//! How a person wants the view.

use crate::capabilities::Hints;
use crate::control::{Bindings, Pace};
use crate::encode::{Order, Quality};
use crate::maps::Map;
use crate::render::Sampling;
use std::path::PathBuf;

/// How the user wants the live view: made by [`Options::default`], then changed.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// What is wanted and known of the terminal before it is asked.
    #[doc(hidden)]
    pub hints: Hints,
    /// In which order changed cells are sent; `None`: row by row, which takes the least time, and by colour, which takes
    /// the fewest bytes, while the link is slow.
    pub order: Option<Order>,
    /// How near a moving picture is to the wanted one; `None`: exact, and equal while the link is slow.
    pub quality: Option<Quality>,
    /// The most bytes a second that are sent in the mean; `None`: as many as the link takes.
    pub max_rate: Option<u32>,
    /// The most frames a second; `None`: 60. A number above zero.
    pub max_frames: Option<f32>,
    /// How finely pictures are traced; `None`: in motion as finely as the time allows, and at rest to the end
    /// ([`Sampling::BEST`]).
    pub sampling: Option<Sampling>,
    /// How many threads trace; `None`: as many as there are cores.
    pub threads: Option<usize>,
    /// How fast keys move and turn the view.
    #[doc(hidden)]
    pub pace: Pace,
    /// Whether each press of a key moves one step at once, and nothing glides or moves by itself.
    pub reduced_motion: bool,
    /// The folder that the user may have the picture written into; `None`: he may not.
    pub exports: Option<PathBuf>,
    /// What is said in the lowest row until the first key.
    pub welcome: Option<String>,
    /// What of the scene is shown at first.
    pub map: Map,
    /// What the keys do.
    #[doc(hidden)]
    pub bindings: Bindings,
}

/// The choices of the terminal and the machine.
impl Default for Options {
    fn default() -> Self {
        Self::new(Hints::default())
    }
}

impl Options {
    /// For a terminal of which that is known, on a link that does not compress; the rest as terminal and machine say.
    #[doc(hidden)]
    pub fn new(hints: Hints) -> Self {
        Self {
            hints,
            order: None,
            quality: None,
            max_rate: None,
            max_frames: None,
            sampling: None,
            threads: None,
            pace: Pace::default(),
            reduced_motion: false,
            exports: None,
            welcome: None,
            map: Map::Shaded,
            bindings: Bindings::default(),
        }
    }
}
