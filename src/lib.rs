//! termtrace: a real-time ray tracer that runs in the terminal, as a library.
//!
//! Scene file -> scene -> camera -> eye ray -> closest hit -> shade -> framebuffer (linear light) -> tone -> cells ->
//! bytes -> a terminal or a file; and back: bytes -> events -> camera.
//!
//! ```
//! use termtrace::{Render, Resolution, Scene, tone};
//!
//! let scene = Scene::from_ron("ball.ron", r##"(
//!     camera: (eye: (0, 1, 4), target: (0, 1, 0)),
//!     lights: [Point(position: (3, 4, 5), intensity: 40)],
//!     objects: [Sphere(center: (0, 1, 0), radius: 1, material: Diffuse("#e04030"))],
//! )"##)?;
//! let light = Render::new(&scene).resolution(Resolution::new(80, 48)?).run()?;
//! let picture = tone(&light, &scene);
//! assert_eq!(picture.pixels().len(), 80 * 48);
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! The same scene in code. If a value is not allowed in a scene, its constructor returns an error with the message that
//! a scene file would get:
//!
//! ```
//! use termtrace::glam::Vec3;
//! use termtrace::{Camera, LinearRgb, Material, PointLight, Render, Resolution, Scene, Sphere, tone};
//!
//! let camera = Camera::look_at(Vec3::new(0.0, 1.0, 4.0), Vec3::Y)?;
//! let scene = Scene::builder(camera)
//!     .light(PointLight::new(Vec3::new(3.0, 4.0, 5.0), LinearRgb::grey(40.0))?)
//!     .object(Sphere::new(Vec3::Y, 1.0)?, Material::diffuse(LinearRgb::new(0.74, 0.05, 0.03))?)
//!     .build()?;
//! let light = Render::new(&scene).resolution(Resolution::new(80, 48)?).run()?;
//! assert_eq!(light.pixels().len(), tone(&light, &scene).pixels().len());
//!
//! let error = Sphere::new(Vec3::Y, 0.0).unwrap_err();
//! assert_eq!(error.to_string(), "radius is 0: the radius must be greater than 0");
//! # Ok::<(), Box<dyn std::error::Error>>(())
//! ```
//!
//! Start with [`Scene`]: the checked values of a scene and the trees that rays are traced in. Loading a scene, or
//! building one in code, builds the trees once; clones share them, and functions that take a scene build none.
//!
//! # The surface
//!
//! Promised items are at the root, in [`export`] and in [`live`]; all other modules are private.
//! - Scene files: [`Scene`], its errors [`LoadError`] and [`SceneError`], and [`Progress`] of reading
//! - Scenes in code: [`Scene::builder`], [`Camera`], [`Object`], [`Shape`], [`Material`], [`Light`], [`Background`],
//!   [`ToneCurve`], [`LinearRgb`]
//! - Cameras over time: [`CameraPath`]
//! - Pictures: [`Render`] with [`Resolution`] and [`Sampling`] -> [`Framebuffer`], [`tone()`] -> [`Picture`]; [`Map`]
//! - Pictures in words: [`describe()`], [`explain()`]
//! - Cells and text: [`Grid`], [`CellMode`], [`Painter`], [`text_frame`], [`frame_grid`], [`export`]
//! - ratatui: [`SceneView`] and its [`SceneState`], a scene as a widget; `EncoderBackend` (feature `backend`) and its
//!   [`Encoder`]; [`lay_over`]
//! - Films: [`Cast`], [`Gif`]
//! - The live view: [`live`]
//!
//! # Features
//!
//! Without features there are scenes in code, pictures and maps, descriptions and explanations, cells, the encoder, and
//! text, ANSI, SVG and HTML. This table shows what each feature adds, and the number of crates that are compiled with
//! it, this one included:
//!
//! | features | additions | crates |
//! |---|---|--:|
//! | (none) | | 5 |
//! | `ron` | scene files and camera paths, and the plain files beside them | 5 |
//! | `parallel` | tracing, toning and building trees on all threads of the current rayon pool; the same bits | 11 |
//! | `ron`, `parallel` | both: the minimum for tracing a scene file on all cores | 11 |
//! | `mesh` | OBJ, STL, PLY and glTF files with their textures; includes `ron` | 38 |
//! | `png` | PNG files | 15 |
//! | `gif` | films as GIF | 8 |
//! | `cast` | films as asciicast | 10 |
//! | `ratatui` | ratatui's buffers laid over cells, on `ratatui-core` alone | 34 |
//! | `underline-color` | the colours of their underlines; turn it on with that of all other ratatui backends | 34 |
//! | `backend` | the encoder as a backend of ratatui; includes `ratatui` | 34 |
//! | `scrolling-regions` | the same beside ratatui's feature of this name; includes `backend` | 34 |
//! | `serde` | cameras, colours, sizes, maps and samplings in the formats of serde, checked when they are read | 12 |
//! | `live` | the live view, on Linux and macOS; includes all of the above but `gif` and the last four | 103 |
//! | `serve` | the server of the live view over SSH, for the program; includes `live`; needs Rust 1.89 | 212 |
//! | `draco` | Draco compression in glTF files; includes `mesh` | 42 |
//! | `cli` | the program `termtrace`, by default; includes `live`, `gif` and `draco` | 120 |
//!
//! A program that uses only the library turns the default features off:
//! `termtrace = { version = "0.1", default-features = false, features = ["ron", "parallel"] }`.
//!
//! # The route
//!
//! The guide of [`termtrace-core`](https://docs.rs/termtrace-core) follows one eye ray and one scene with a typo, and
//! has the tracer's terms.
//!
//! One file per stage, in the order in which the data travels. A stage that outgrows its file has a folder of the same
//! name. The stages down to `explain`, which trace light, are the crate `termtrace-core` in the folder `core`: both
//! crates compile at the same time, and a change of the live view compiles no tracer. This crate uses the modules of
//! that one by the same paths as its own, and re-exports what is promised of them.
//!
//! Foundations for all stages:
//! - `color`: linear RGB, 8-bit sRGB, and the transfer function between them
//! - `lanes`: formulas for one number or for eight lanes
//! - `simd`: eight lanes in one register, on CPUs that have such registers
//! - `ray`: origin + t * direction, and intervals of t
//! - `bounds`: axis-aligned boxes
//! - `text`: text for messages: printable text, lists, spelling suggestions
//! - `memory`: checks that memory is available before it is used
//! - `progress`: progress reports, and the token that cancels work
//! - `threads`: parallel work, on rayon's threads or on the calling thread
//! - `checks`: the rules for the numbers of a scene, from a file or from code
//! - `named_file`: the bytes of a file that the user names, within limits
//!
//! Files as written:
//! - `scene_text`: RON -> a syntax tree with spans; faults with line, column and caret
//! - `mesh_file`: OBJ, STL, PLY or glTF -> checked triangles
//! - `written`: values as the author wrote them, with spans: read from the tree, and checked
//!
//! The scene, checked once, in radians, linear light and unit vectors:
//! - `formula`: f(x, y, z) as text -> a tape; values, gradients, enclosures, and the first root along a ray
//! - `bvh`: the bounding volume hierarchy, eight boxes to a node
//! - `shape`: surfaces f(p) = 0, their intersections with rays, their normals
//! - `accel`: the trees over all shapes of a scene, built once
//! - `material`: diffuse reflectance: one colour, patterns, pictures
//! - `light`: point lights, spots, suns, luminous balls and panels
//! - `finish`: highlights, mirrors, glass and glowing surfaces: Snell's law and Fresnel's equations
//! - `fog`: the light that air absorbs and adds
//! - `camera`: eye, target, up, field of view -> basis u, v, w -> eye rays
//! - `camera_path`: the camera over time: an orbit, or a path through keyframes
//! - `scene_file`: a whole file as the author wrote it, typed
//! - `scene`: the whole scene, and the one conversion from written to checked values
//!
//! From the eye to the light:
//! - `hit`: the closest hit, any hit
//! - `shade`: the light that a surface sends to the eye
//! - `framebuffer`: linear light per pixel
//! - `render`: tile by tile, eye rays -> hits -> shadow rays -> shade
//! - `rasterize`: object by object, projection -> depth buffer, for comparison
//!
//! From light to the screen:
//! - `tone`: exposure, tone curve, transfer function, 8 bits
//! - `maps`: the shaded picture, or a map: depths, normals, objects, shadows
//! - `describe`: the picture in words
//! - `explain`: one pixel, and how its light is computed
//! - `serialized`: plain values in the formats of serde
//! - `table`: an enum with a row of constants for each of its values
//! - `grid`: the cell grid
//! - `cell`: picture -> grid, as half blocks or characters, in the terminal's colours
//! - `capabilities`: the colours, glyphs and sizes that a terminal supports
//! - `overlay`: any ratatui buffer laid over the grid, and the grid as such a buffer
//! - `widget`: a scene in a ratatui program
//! - `encode`: wanted grid, shown grid, pen -> bytes
//! - `export`: grid or picture -> text, ANSI, SVG, HTML, PNG
//! - `record`: frames over time -> asciicast, GIF
//! - `output_file`: bytes -> a file that is replaced atomically
//!
//! The live view:
//! - `input`: bytes -> events and replies
//! - `protocol`: modes and queries -> bytes; replies -> outstanding queries
//! - `pace`: congestion control: how many bytes may be in flight, and when to send
//! - `control`: keys, mouse + camera -> camera
//! - `viewer`: one user's view: bytes, scenes, frames and time in; bytes and requests for frames out
//! - `terminal`: the only owner of the terminal
//! - `app`: a viewer on the terminal
//! - `serve`: any number of viewers over SSH
//!
//! For programs that use the crate:
//! - [`live`]: the promised part of `app` and `terminal`
//! - [`prelude`]: the imports of a typical program
//! - `internals`: every module of the route, without any promise, for this project's own program, tests and benches
//!
//! # Laws
//!
//! 1. A module uses only modules above it in this list. The files of one folder form no cycle of imports, and of a file
//!    and those in its folder one side takes only types from the other (`tests/laws.rs` reads the imports).
//! 2. Written, then checked: `scene_file` holds the author's values with their spans; `scene` converts them once into a
//!    value that is always valid. Units and colour spaces change there and nowhere else.
//! 3. The value between two layers has a name: [`Scene`], [`Camera`],
//!    [`Hit`], [`Framebuffer`], [`Picture`], [`Grid`],
//!    bytes. A test can construct each directly.
//! 4. The picture is a pure function of scene, camera, resolution and samples. It depends on no clock, no random number
//!    and no number of threads, and has the same bits on any CPU, because its path uses only + - * / and the square
//!    root, and libm in Rust at set-up (clippy bans the rest; `tests/hashes.txt` has the bits).
//! 5. Only `terminal` touches the operating system's terminal and signals, and it owns every mode that is switched on.
//!    Everything above bytes runs without a terminal. With the feature `test-hooks`, which only this crate's tests turn
//!    on (a dev-dependency of the crate on itself), tests inject faults. `input`, `protocol`, `pace`, `control` and
//!    `viewer` use no file, thread or clock: time is a parameter.
//! 6. The newest picture wins: nothing stale is queued. When nothing changes, nothing is computed or sent, and no timer
//!    runs. One function of one snapshot of facts (`viewer::schedule`) decides *when* to trace, refine, draw and wait.
//!    Each piece of state has one owner: a field is assigned only in the file that defines its type.
//! 7. The library neither prints nor exits, and installs nothing by itself.
//! 8. Only `output_file` writes files, for the library and the program.
//!
//! # What is not here
//!
//! - No flag that marks a picture as stale: the wanted shot is compared with the one that was begun.
//! - No list of cell kinds, formats or panels outside their tables: a cell kind is a file under `cell/` and a row of
//!   the table of [`Glyphs`]; an export format is a file under `export/` and a row of the table of
//!   `export::Format`s. Flags, keys, commands, panels and the check against a golden file follow from these.
//!   A panel is one file with a type that implements `viewer::layers::Layer`, and the line that opens it.
//!
//! # Cells in motion
//!
//! What [`Quality::Equal`] and a limit on the bytes of a frame mean is decided cell by cell (`encode::halves`):
//! - A half block of two truecolors, or a space on one, is a part of a picture: all cells of `half` and `spaces` in
//!   truecolor, and the flat and half cells of `blocks`, `octants`, `sextants`, `braille`, `shape`, `ascii`, `ramp`.
//!   `Equal` lets each half be within 0.01 of its colour. Under a limit it may be coarser, or wait: the longer a cell
//!   is visibly wrong (`encode::wrong_cells`), the more its error weighs (`encode::capped`).
//! - All other cells are text: those of panels, all cells in 256, 16 or no colours, and all other glyphs. They are
//!   exact at every quality and sent whole under every limit; `pace` then sends fewer frames.
//!
//! # One key press
//!
//! `app::live` reads the terminal's bytes -> `viewer::events`: the receiver of `protocol` parses them to inputs
//! (`input`), the keymap of `control` maps a key to a command, and the command moves the eye (`viewer::eye`) ->
//! `viewer::schedule` decides to trace a frame -> `app::renderer` traces it (`render`) -> `viewer::screen` receives the
//! frame, and the schedule decides to draw it: cells (`cell`), layers over them, bytes (`encode`) -> `terminal`.
//!
//! # Glossary
//!
//! The terms from cells on, in the order of the route.
//!
//! Cells:
//! - **cell**: one character position; **grid**: the cells of a screen; **cell aspect**: cell height over width.
//! - **glyph**: the character in a cell; **ink**: its foreground or background colour.
//! - **half block**: `▀` or `▄`, which makes two pixels of a cell. **ramp**: characters by lightness.
//! - **cell mode**: the kind of glyphs and the number of colours that a picture is drawn with.
//! - **pen**: the colours and attributes that a terminal uses for the next character.
//! - **encoder**: turns the difference of two grids into bytes; **quality**: how exactly it does so in motion.
//! - **shift**: shown cells that the terminal moves itself (`--moves`); the cells left behind are **vacated**.
//! - **golden frame**: a frame in a file that later frames are compared with.
//!
//! Terminal and live view:
//! - **query**: bytes that ask the terminal something; **reply**: its answer. **fence**: the query after all others.
//! - **capability**: something that the terminal supports, and the source that says so.
//! - **in flight**: bytes that were sent and not yet confirmed by a reply.
//! - **round trip**: the time from a query to its reply; **rate**: the bytes per second of the link.
//! - **congestion window**: the limit on the bytes in flight: rate times shortest round trip, and one frame.
//! - **shot**: what a frame shows: scene, camera, size, map and sampling.
//! - **refinement**: tracing the same shot with more samples while nothing moves.
//! - **keymap**: which key runs which **command**, for each mode. **layer**: a panel over the picture.

// Makes docs.rs show which feature each item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(all(feature = "live", not(any(target_os = "linux", target_os = "macos"))))]
compile_error!("the feature `live` of termtrace is for Linux and macOS: it needs POSIX termios, poll and signals");

// The tracer is a crate of its own, whose modules are used by the same paths as those below.
use termtrace_core::{
    bounds, bvh, camera, camera_path, color, describe, explain, finish, fog, framebuffer, hit, lanes, light, maps,
    material, memory, mesh_file, progress, rasterize, ray, render, scene, scene_text, shade, shape, simd, text, tone,
    written,
};
#[cfg(feature = "ron")]
use termtrace_core::{named_file, scene_file};

mod table;
mod grid;
mod cell;
mod capabilities;
#[cfg(feature = "ratatui")]
mod overlay;
#[cfg(feature = "ratatui")]
mod widget;
mod encode;
pub mod export;
#[cfg(any(feature = "cast", feature = "gif"))]
mod record;
#[cfg(feature = "live")]
mod output_file;
#[cfg(feature = "live")]
mod input;
#[cfg(feature = "live")]
mod protocol;
#[cfg(feature = "live")]
mod pace;
#[cfg(feature = "live")]
mod control;
#[cfg(feature = "live")]
mod viewer;
#[cfg(feature = "live")]
mod terminal;
#[cfg(feature = "live")]
mod app;
#[cfg(feature = "serve")]
mod serve;
#[cfg(feature = "live")]
pub mod live;
pub mod prelude;
#[doc(hidden)]
pub mod internals;

// Scene files.
pub use progress::{Progress, Unfinished, Work};
#[cfg(feature = "ron")]
pub use scene::LoadError;
pub use scene::Scene;
pub use scene_text::SceneError;

// Scenes in code.
pub use bounds::Bounds;
pub use camera::{Camera, CameraError, Pose, ViewRectangle};
pub use color::{LinearRgb, Srgb8};
pub use light::{Falloff, Light, PointLight};
pub use material::Material;
pub use mesh_file::MeshError;
pub use scene::{Background, Object, SceneBuilder, SceneFault, ToneCurve};
pub use shape::{Mesh, Plane, Shape, Sphere, Triangle};

// Cameras over time.
pub use camera_path::CameraPath;

// Pictures.
pub use framebuffer::{Framebuffer, Resolution, ResolutionError};
pub use hit::Hit;
pub use maps::Map;
pub use progress::Cancelled;
pub use render::{Render, Sampling, render};
pub use tone::{Picture, tone};

// Pictures in words.
pub use describe::describe;
pub use explain::{Explanation, explain};

// Cells and text.
pub use cell::{CellMode, Colors, Glyphs, Painter};
pub use export::{Difference, compare, frame_grid, text_frame};
pub use grid::{Cell, Glyph, Grid, HalfBlocks, Ink, Size};

// For programs that use ratatui.
#[cfg(feature = "ratatui")]
pub use camera::Grip;
#[cfg(feature = "ratatui")]
pub use capabilities::cell_aspect as cell_aspect_of;
#[cfg(feature = "backend")]
pub use encode::EncoderBackend;
pub use encode::{Encoder, Order, Quality};
#[cfg(feature = "ratatui")]
pub use overlay::lay_over;
#[cfg(feature = "ratatui")]
pub use widget::{SceneState, SceneView};

// Recordings of films.
#[cfg(feature = "cast")]
pub use record::Cast;
#[cfg(feature = "gif")]
pub use record::Gif;

// The error of all `FromStr` implementations.
pub use text::ParseError;

// The crates whose types occur in signatures of this crate.
pub use glam;
#[cfg(feature = "ratatui")]
pub use ratatui_core;

/// The examples in the pages of the documentation, compiled and run as doctests.
// The published package lacks these pages and the larger unit tests, so `unit_tests` is not set there.
#[cfg(all(doctest, unit_tests))]
#[doc = include_str!("../docs/library.md")]
#[doc = include_str!("../docs/snapshots.md")]
mod pages {}
