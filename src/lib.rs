//! termtrace: a live ray tracer whose screen is the terminal, as a library.
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
//! The same scene without a file. What no scene may hold is an error of its constructor, in the words of a scene file's
//! error:
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
//! A library user meets [`Scene`]: all that was checked, together with the trees that rays go through. Loading one, or
//! building one in code, builds the trees once; copies share them, and no function that takes a scene builds any.
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
//! Without any there are scenes in code, pictures and maps, descriptions and explanations, cells, the encoder, and
//! text, ANSI, SVG and HTML. What more there is with a feature, and how many crates are compiled in all, this one
//! included:
//!
//! | features | what they bring | crates |
//! |---|---|--:|
//! | (none) | | 4 |
//! | `ron` | scene files and camera paths, and the plain files beside them | 4 |
//! | `parallel` | tracing, toning and building trees on all threads of the current rayon pool; the same bits | 10 |
//! | `ron`, `parallel` | the least that traces a scene file on all cores | 10 |
//! | `mesh` | OBJ, STL, PLY and glTF files with their textures; includes `ron` | 23 |
//! | `png` | PNG files | 14 |
//! | `gif` | films as GIF | 7 |
//! | `cast` | films as asciicast | 9 |
//! | `ratatui` | ratatui's buffers laid over cells, on `ratatui-core` alone | 33 |
//! | `underline-color` | the colours of their underlines; all of the program's ratatui backends must have theirs on | 33 |
//! | `backend` | the encoder as a backend of ratatui; includes `ratatui` | 33 |
//! | `scrolling-regions` | the same beside ratatui's feature of this name; includes `backend` | 33 |
//! | `serde` | cameras, colours, sizes, maps and samplings in the formats of serde, checked when they are read | 11 |
//! | `live` | the live view, on Linux and macOS; includes all of the above but `gif`, `cast` and the last four | 92 |
//! | `cli` | the program `termtrace`, by default | 107 |
//!
//! A program that only uses the library turns the default off:
//! `termtrace = { version = "0.1", default-features = false, features = ["ron", "parallel"] }`.
//!
//! # The route
//!
//! One file per stage, in the order in which the data travels; a stage that outgrows its file has a folder of the same
//! name.
//!
//! Words that all stages speak:
//! - `table`: a type with a row for each of its values
//! - `color`: linear RGB, 8-bit sRGB, and the transfer function between them
//! - `lanes`: a number, or eight side by side
//! - `simd`: eight numbers in one register, where the CPU has such
//! - `ray`: origin + t * direction, and intervals of t
//! - `bounds`: boxes along the axes
//! - `text`: text for messages: printable, lists, the word that was meant
//! - `memory`: asked for before it is used
//! - `progress`: progress reports, and the token by which work is cancelled
//! - `threads`: work in parallel, on the threads of rayon or without
//! - `checks`: the rules for the numbers of a scene, from a file or from code
//! - `named_file`: the bytes of a file that a person names, within bounds
//!
//! What was written:
//! - `scene_text`: RON -> a syntax tree with places; faults with line, column and caret
//! - `mesh_file`: OBJ, STL, PLY or glTF -> triangles, checked
//! - `written`: values as the author wrote them, with places: read from the tree, and checked
//!
//! What is drawn, checked once, in radians, linear light and unit vectors:
//! - `bvh`: which of many boxes a ray may meet
//! - `shape`: surfaces f(p) = 0, where a ray crosses them, their normals
//! - `accel`: the trees over all shapes of a scene, built once
//! - `material`: diffuse reflectance
//! - `light`: point lights
//! - `camera`: eye, target, up, field of view -> basis u, v, w -> eye rays
//! - `camera_path`: the camera over time: an orbit, or through keyframes
//! - `scene_file`: a whole file as the author wrote it, typed
//! - `scene`: all of it, and the one conversion from what was written
//!
//! From the eye to the light:
//! - `hit`: the closest hit, any hit
//! - `shade`: light from a surface to the eye
//! - `framebuffer`: linear light per pixel
//! - `render`: tile by tile, eye rays -> hits -> shadow rays -> shade
//!
//! From light to the screen:
//! - `tone`: exposure, tone curve, transfer function, 8 bits
//! - `maps`: the shaded picture, or a map: depths, normals, objects, shadows
//! - `describe`: the picture in words
//! - `grid`: the cell grid
//! - `cell`: picture -> grid, by half blocks or characters, in the colours that there are
//! - `capabilities`: what a terminal's cells can be made of
//! - `explain`: one pixel, and all that its light came from
//! - `overlay`: any ratatui buffer laid over the grid, and the grid as such a buffer
//! - `widget`: a scene in a ratatui program
//! - `encode`: wanted grid, shown grid, pen -> bytes
//! - `export`: grid or picture -> text, ANSI, SVG, HTML, PNG
//! - `record`: frames over time -> asciicast, GIF
//! - `serialized`: plain values in the formats of serde
//! - `output_file`: bytes -> a file that is replaced whole, or not at all
//!
//! With a person:
//! - `input`: bytes -> events and replies
//! - `protocol`: modes and queries -> bytes; replies -> what is still outstanding
//! - `pace`: what may be in flight, and when
//! - `control`: keys, mouse + camera -> camera
//! - `viewer`: one person's view: bytes, scenes, frames and time in; bytes and frames to be traced out
//! - `terminal`: the one owner of the terminal
//! - `app`: a viewer on the terminal
//!
//! For programs that use the crate:
//! - [`live`]: what of `app` and `terminal` is promised
//! - [`prelude`]: what a first program imports
//! - `internals`: every module of the route, without any promise, for this project's own program, tests and benches
//!
//! # Laws
//!
//! 1. A module uses only what stands above it here. Within a module the files of one folder form no cycle, and between
//!    a file and those in its folder only types go one of the ways (`tests/laws.rs` reads the imports).
//! 2. Written, then checked: `scene_file` holds what the author wrote and where, of surfaces in the terms of `shape`;
//!    `scene` has it converted once into a value that cannot be wrong. Units and colour spaces change there and nowhere
//!    else.
//! 3. The value between two layers has a name: [`Scene`], [`Camera`],
//!    [`Hit`], [`Framebuffer`], [`Picture`], [`Grid`],
//!    bytes. Each can be made by hand in a test.
//! 4. The picture is a pure function of scene, camera, resolution and samples: no clock, no randomness, no number of
//!    threads, and the same bits on any CPU, because only + - * / and the square root are on its path, with libm in
//!    Rust at set-up (clippy bans the rest; `tests/hashes.txt` has the bits).
//! 5. Only `terminal` touches the operating system's terminal and signals, and it is the one owner of what is turned
//!    on. Everything above bytes runs without a terminal. The feature `test-hooks`, which this crate's tests turn on
//!    for themselves (a dev-dependency of the crate on itself), lets them say where it is to fail; no other build has
//!    it. `input`, `protocol`, `pace`, `control` and `viewer` know no file, thread or clock: they are told the time.
//! 6. The newest picture wins: nothing stale is queued; when nothing changes, nothing is computed or sent, and no timer
//!    runs. *When* to trace, refine, draw and wait is decided by one function of one snapshot of facts
//!    (`viewer::schedule`). Each piece of state has one owner: no field is assigned but in the file that defines its
//!    type.
//! 7. The library neither prints nor exits, and installs nothing by itself.
//! 8. What crosses a tile goes together: eye rays, hits, shadow rays and shading are steps over arrays of its rays, in
//!    which eight rays stand side by side all the way (`EightRays`), each with a bit for whether it is asked about.
//! 9. Only `output_file` writes files, for the library and the program.
//!
//! # What is not here
//!
//! No trait objects in the tracer: a [`Shape`] is an enum, its `Primitive`s are what rays are tested against. A new surface
//! is one file under `shape/`, where it implements `Surface`, `Described`, `InSceneFile` and `CheckedShape`, and one
//! line in the table of `shape`, from which the enums, the lists and trees of `accel`, and what reads, describes and
//! explains it are made (`shape::cube` is such a surface, for tests). In the same way a material is a file under
//! `material/` with a type that is `Reflecting` and a line in the table of `material`, and a light a file under
//! `light/` with a `LightSource` and a line in the table of `light` (`material::stripes` and `light::sun`, for tests).
//! No crate reads scenes or meshes: `scene_text` and `mesh_file` say which were tried, and at which file each failed.
//! No fixed epsilon: see `SurfacePoint::ray_origin`. No order of the tree that could show: see `Bounds::crossed`. No
//! flag says that a picture is out of date: the shot that is wanted is compared with the one that was begun. A kind of
//! cells is a file under `cell/` with all that is particular to it, and a row of the table of [`Glyphs`]; an export
//! format is a file under `export/` and a row of the table of [`Format`](export::Format)s: flags, keys, commands,
//! panels and the check against a golden file follow from these. No list of panels: a panel is a layer of the viewer,
//! one file with a type that implements `viewer::layers::Layer`, and the line that opens it.
//!
//! # One eye ray
//!
//! `render` goes over a picture for `maps` or `app::renderer`: `render::uniform` with the same number of samples for
//! each pixel, `render::adaptive` with more where there are edges. `render::schedule` gives each thread its tiles and
//! cuts their samples into batches; `render::steps` takes a batch through the five steps. `render::tiles` makes the eye
//! rays (by `camera`) -> `hit` finds the closest hits: among the objects that stand alone, then in the trees (`accel`,
//! over `bvh`), whose leaves are parts of `shape`s -> `shade` works out the points that were met (`shade::points`)
//! -> it sends shadow rays (`hit` again) and adds up what arrives from the `light`s -> it has the
//! `material` reflect that. `render::tiles` puts a tile's light into the `framebuffer` -> `tone` -> `cell` ->
//! `encode` or `export`.
//!
//! # One scene with a typo
//!
//! `scene::load` has the bytes read (`named_file`) -> `scene_text` makes a tree of them, in which every node has its
//! place -> `scene_file` reads the fields, those of a `shape`, `material` or `light` in its own file; a name that is
//! not known is a fault there, with the word that was meant (`text`) -> `scene::checked` is silent about what is
//! missing only because of that -> `scene_text::fault` puts all faults in order, each with its line and carets -> the
//! error goes back to who loaded the scene: the command line prints it, and the live view shows the first fault of it
//! (`viewer::error_panel`).
//!
//! # One key press
//!
//! `app::live` reads the terminal's bytes -> `viewer::events`: the receiver of `protocol` cuts them into inputs
//! (`input`), the keymap of `control` into a command, and that moves the eye (`viewer::eye`) -> `viewer::schedule`
//! decides that a frame is to be traced -> `app::renderer` traces it (`render`) -> the frame comes to `viewer::screen`,
//! and the schedule decides that it is to be drawn: cells (`cell`), layers over them, bytes (`encode`) ->
//! `terminal`.

// Labels on docs.rs: which feature an item needs.
#![cfg_attr(docsrs, feature(doc_cfg))]

#[cfg(all(feature = "live", not(any(target_os = "linux", target_os = "macos"))))]
compile_error!(
    "the feature `live` of termtrace is for Linux and macOS: it talks to the terminal through POSIX termios, poll and signals"
);

mod table;
mod color;
mod lanes;
mod simd;
mod ray;
mod bounds;
mod text;
mod memory;
mod progress;
mod threads;
mod checks;
#[cfg(feature = "ron")]
mod named_file;
mod scene_text;
mod mesh_file;
#[cfg_attr(not(feature = "ron"), allow(dead_code, unused_imports, reason = "only files have written values"))]
mod written;
mod bvh;
mod shape;
mod accel;
mod material;
mod light;
mod camera;
mod camera_path;
#[cfg(feature = "ron")]
mod scene_file;
mod scene;
mod hit;
mod shade;
mod framebuffer;
mod render;
mod tone;
mod maps;
mod describe;
mod grid;
mod cell;
mod capabilities;
mod explain;
#[cfg(feature = "ratatui")]
mod overlay;
#[cfg(feature = "ratatui")]
mod widget;
mod encode;
pub mod export;
#[cfg(any(feature = "cast", feature = "gif"))]
mod record;
#[cfg(feature = "serde")]
mod serialized;
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

// ratatui.
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

// Films.
#[cfg(feature = "cast")]
pub use record::Cast;
#[cfg(feature = "gif")]
pub use record::Gif;

// The error of `FromStr`.
pub use text::ParseError;

// The crates whose types are in signatures.
pub use glam;
#[cfg(feature = "ratatui")]
pub use ratatui_core;

/// The examples of the README are compiled and run with the others.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
mod readme {}
