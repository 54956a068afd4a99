//! The user's options for the view.

use crate::capabilities::Hints;
use crate::control::{KeySpeed, Keymap};
use crate::encode::{Order, Quality};
use crate::maps::Map;
use crate::render::Sampling;
use std::path::PathBuf;

/// Options of the live view. Start from [`Options::default`] and change fields.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Options {
    /// The user's choices for the terminal, and the environment variables about it.
    #[doc(hidden)]
    pub hints: Hints,
    /// The order in which changed cells are sent.
    ///
    /// `None`: raster order, which takes the least time, or while the link is slow order by colour, which takes the
    /// fewest bytes.
    pub order: Option<Order>,
    /// How exactly the colours of a moving picture are sent.
    ///
    /// `None`: `Exact`, or while the link is slow `Equal`.
    pub quality: Option<Quality>,
    /// Limit on the average number of bytes sent per second. `None`: as many as the link takes.
    pub max_rate: Option<u32>,
    /// Limit on the frames per second, greater than 0. `None`: 60.
    pub max_frames: Option<f32>,
    /// The sampling of all pictures.
    ///
    /// `None`: in motion as many samples as fit the time of a frame, at rest up to [`Sampling::BEST`].
    pub sampling: Option<Sampling>,
    /// Whether a picture at rest is traced again for finer glyphs, if the terminal shows them well.
    #[doc(hidden)]
    pub finer_at_rest: bool,
    /// The number of tracing threads. `None`: one per core.
    pub threads: Option<usize>,
    /// The speed of moving and turning by keys.
    #[doc(hidden)]
    pub key_speed: KeySpeed,
    /// Whether motion is reduced: each key press moves one step at once, and nothing
    /// moves by itself.
    pub reduced_motion: bool,
    /// The folder that exported pictures are written to. `None`: the user may not export.
    pub exports: Option<PathBuf>,
    /// A note that is shown in the lowest row until the first key press.
    pub welcome: Option<String>,
    /// The number of scenes of a tour, whose captions are shown. `None`: no tour.
    #[doc(hidden)]
    pub tour: Option<usize>,
    /// The note that is shown once if 256 colours were detected, not chosen by the user.
    #[doc(hidden)]
    pub few_colors: Option<String>,
    /// The first map to show.
    pub map: Map,
    /// The commands that keys are bound to.
    #[doc(hidden)]
    pub keymap: Keymap,
}

/// The default options, for a terminal about which nothing is known.
impl Default for Options {
    fn default() -> Self {
        Self::new(Hints::default())
    }
}

impl Options {
    /// Returns the default options for a terminal described by `hints`.
    #[doc(hidden)]
    pub fn new(hints: Hints) -> Self {
        Self {
            hints,
            order: None,
            quality: None,
            max_rate: None,
            max_frames: None,
            sampling: None,
            finer_at_rest: true,
            threads: None,
            key_speed: KeySpeed::default(),
            reduced_motion: false,
            exports: None,
            welcome: None,
            tour: None,
            few_colors: None,
            map: Map::Shaded,
            keymap: Keymap::default(),
        }
    }
}
