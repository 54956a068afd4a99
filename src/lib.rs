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
//! 8. The rays of a tile are traced together: eye rays, hits, shadow rays and shading are steps over arrays of rays, in
//!    groups of eight lanes (`EightRays`) with a mask of the active ones.
//! 9. Only `output_file` writes files, for the library and the program.
//!
//! # What is not here
//!
//! - No trait objects in the tracer: a [`Shape`] is an enum, and rays are tested against its primitives. A new
//!   surface is one file under `shape/`, which implements `Surface` and `Place` (or `Exact`, in f64), `Described`,
//!   `InSceneFile` and `CheckedShape`, and one line in the table of `shape`. The enums, the lists and trees of `accel`,
//!   and the code that reads, describes and explains it are generated from the table (`shape::cube` is such a surface,
//!   for tests).
//!   Surfaces whose Rust form may still change are hidden: scenes with them are files. A new material is a file under
//!   `material/` with a `Reflecting` type and a line in the table of `material`, and a new light a file under `light/`
//!   with a `LightSource` and a line in the table of `light` (`material::stripes` and `light::sun` are short ones).
//! - No crate reads scenes or meshes: `scene_text` and `mesh_file` list those that were tried, and where each failed.
//! - No fixed epsilon: see `SurfacePoint::ray_origin`.
//! - No effect of the tree's order on the picture: see `Bounds::crossed`.
//! - No flag that marks a picture as stale: the wanted shot is compared with the one that was begun.
//! - No list of cell kinds, formats or panels outside their tables: a cell kind is a file under `cell/` and a row of
//!   the table of [`Glyphs`]; an export format is a file under `export/` and a row of the table of
//!   `export::Format`s. Flags, keys, commands, panels and the check against a golden file follow from these.
//!   A panel is one file with a type that implements `viewer::layers::Layer`, and the line that opens it.
//!
//! # One eye ray
//!
//! `maps` or `app::renderer` calls `render`: `render::uniform` traces the same number of samples for each pixel,
//! `render::adaptive` more at edges. `render::schedule` gives each thread its tiles and cuts their samples into
//! batches; `render::steps` takes a batch through the five steps. `render::tiles` makes the eye rays (by `camera`) ->
//! `hit` finds the closest hits: among the unbounded objects, then in the trees (`accel`, over `bvh`), whose leaves
//! hold primitives of `shape`s -> `shade` computes the surface points (`shade::points`) -> it traces shadow rays (`hit`
//! again) and adds up the light of the `light`s that reach the points (`shade::arriving`) -> the `material` reflects
//! it -> the `finish` adds highlights and glows and mirrors rays (`shade::finishes`), and bounced rays are traced and
//! shaded (`shade::bounces`). `render::tiles` writes a tile's light into the `framebuffer` -> `tone` -> `cell` ->
//! `encode` or `export`.
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
//! # One scene with a typo
//!
//! `scene::load` reads the bytes (`named_file`) -> `scene_text` parses them to a syntax tree, in which every node has
//! its span -> `scene_file` reads the fields; those of a `shape`, `material` or `light` are read in its own file. An
//! unknown name is a fault there, with the name that was probably meant (`text`) -> `scene::checked` does not report
//! what is missing because of that fault -> `scene_text::fault` sorts all faults and adds lines and carets -> the error
//! returns to the caller: the command line prints it, and the live view shows its first fault (`viewer::error_panel`).
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
//! The terms of the code, its comments, the help and `docs/`, in the order of the route.
//!
//! Files and scenes:
//! - **RON**: Rusty Object Notation, the syntax of scenes, camera paths, `config.ron` and `keys.ron`.
//! - **span**: a range of bytes in a text. Lines and columns are computed from it for messages.
//! - **fault**: something wrong in a file, with its position. An error holds one or more faults.
//! - **written value**: a value in the author's units, with its span; **checked value**: a valid one in scene units.
//! - **scene**: the checked values and the trees over its primitives; **draft**: a scene without trees yet.
//! - **sketch**: a scene with decimated meshes, shown while the trees of the draft are built.
//! - **side file**: a file that a mesh file names: materials, textures, buffers.
//! - **view**: a camera that a scene file stores besides the scene's own.
//! - **camera path**: the camera as a function of time, an orbit or through **keyframes**.
//! - **pose**: eye point, target point and up vector; **view rectangle**: the lecture's rectangle that pixels divide.
//! - **basis** u, v, w: unit vectors to the right of the picture, up in it, and from the target to the eye.
//!
//! Surfaces and trees:
//! - **shape**: a surface f(p) = 0 of an object: sphere, plane, triangle or mesh.
//! - **primitive**: a single sphere, triangle or plane that rays are tested against; a mesh has one for each triangle.
//! - **placement**: scale, rotation and translation of a shape; **map**: the affine map that they make, in f64.
//! - **instance**: a mesh that shares the triangles of its file; rays are mapped to the coordinates of the file.
//! - **primitive index**: the number of a primitive among all of its kind in the scene.
//! - **BVH**: bounding volume hierarchy, a tree of axis-aligned boxes over primitives; a **node** has eight children.
//! - **leaf**: a node's child with up to eight primitives, stored as **SoA** (structure of arrays), one lane each.
//! - **unbounded**: without a box around it, as a plane is. Such primitives are in a list, not in a tree.
//!
//! Rays:
//! - **eye ray**: from the eye through a pixel; **shadow ray**: from a surface point to a light.
//! - **interval**: the range of t in which a hit counts; **t**: the ray's parameter in origin + t * direction.
//! - **closest hit**: the hit with the least t in the interval; **any hit**: whether there is one, for shadow rays.
//! - **lane**: one of the eight numbers of a SIMD register; **mask**: one bit per lane.
//! - **active mask**: the lanes whose result is used. **hit mask**: the lanes whose ray hits.
//! - **packet**: up to 64 rays that are traced together; **single ray**: one ray against eight boxes at once.
//! - **projection center**: the eye or light in which all rays of a packet meet, which allows cheaper culling.
//! - **culling**: excluding a box or primitive for a whole group of rays by one conservative test.
//! - **error bound**: a bound on the rounding error of a computed value, by which conservative tests are widened.
//! - **edge function**: the sign of a ray's side of a triangle's edge.
//! - **observer**: a receiver of every test of a traversal, for the cost map and explanations.
//!
//! Light:
//! - **surface point**: the position p of a hit with its normals, texture coordinates and material.
//! - **geometric normal**: the normal of the primitive; **shading normal**: the one interpolated over a smooth mesh.
//! - **footprint**: the size of a pixel on the surface, by which patterns and textures are averaged.
//! - **reflectance**: the reflected share of the arriving light, per **channel** (red, green, blue).
//! - **finish**: how a surface sends light on besides diffusely; **bounce**: one reflection or refraction of a ray.
//! - **falloff**: the decrease of a light with distance. **ambient light**: light that arrives from everywhere.
//!
//! Rendering:
//! - **sampling**: the samples (eye rays) per pixel: a fixed number, or adaptively more at edges (`best`).
//! - **tile**: a square of pixels that one thread traces; **sample batch**: some of its samples, traced in one go.
//! - **executor**: what runs tiles: the current thread, or rayon's pool.
//! - **G-buffer**: the hit of each pixel, from which maps are drawn without light.
//! - **accumulator**: the sum and variance of a pixel's samples so far.
//! - **framebuffer**: the picture in linear light; **picture**: the picture in 8-bit sRGB.
//! - **exposure**, **tone curve**: the factor on all light and the mapping into the screen's range before 8 bits.
//! - **map**: a picture of something other than light: depth, normals, objects, cost.
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
