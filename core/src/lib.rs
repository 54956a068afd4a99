//! The ray tracer of [termtrace](https://docs.rs/termtrace).
//!
//! Scene file -> scene -> camera -> eye ray -> closest hit -> shade -> framebuffer (linear light) -> tone -> picture.
//!
//! Programs depend on `termtrace`, which re-exports the promised items of this crate. The modules below are for
//! `termtrace` itself, and may change in any release; `termtrace` asks for exactly this version. The two are apart so
//! that they compile at the same time, and that changes to one need no build of the other.
//!
//! The guide to these modules, their laws and the other terms are in the documentation of `termtrace`, which has the
//! modules `app`, `viewer`, `cell`, `encode` and `export`.
//!
//! # What is not here
//!
//! - No trait objects in the tracer: a `Shape` is an enum, and rays are tested against its primitives. A new
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
//!
//! # One eye ray
//!
//! The rays of a tile are traced together: eye rays, hits, shadow rays and shading are steps over arrays of rays, in
//! groups of eight lanes (`EightRays`) with a mask of the active ones.
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
//! # One scene with a typo
//!
//! `scene::load` reads the bytes (`named_file`) -> `scene_text` parses them to a syntax tree, in which every node has
//! its span -> `scene_file` reads the fields; those of a `shape`, `material` or `light` are read in its own file. An
//! unknown name is a fault there, with the name that was probably meant (`text`) -> `scene::checked` does not report
//! what is missing because of that fault -> `scene_text::fault` sorts all faults and adds lines and carets -> the error
//! returns to the caller: the command line prints it, and the live view shows its first fault (`viewer::error_panel`).
//!
//! # Glossary
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

pub mod color;
pub mod lanes;
pub mod simd;
pub mod ray;
pub mod bounds;
pub mod text;
pub mod memory;
pub mod progress;
pub mod threads;
pub mod checks;
#[cfg(feature = "ron")]
pub mod named_file;
pub mod scene_text;
pub mod mesh_file;
#[cfg_attr(not(feature = "ron"), allow(dead_code, unused_imports, reason = "only files have written values"))]
pub mod written;
pub mod formula;
pub mod bvh;
pub mod shape;
pub mod accel;
pub mod material;
pub mod light;
pub mod finish;
pub mod fog;
pub mod camera;
pub mod camera_path;
#[cfg(feature = "ron")]
pub mod scene_file;
pub mod scene;
pub mod hit;
pub mod shade;
pub mod framebuffer;
pub mod render;
pub mod rasterize;
pub mod tone;
pub mod maps;
pub mod describe;
pub mod explain;
#[cfg(feature = "serde")]
mod serialized;
