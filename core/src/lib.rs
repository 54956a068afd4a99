//! The ray tracer of [termtrace](https://docs.rs/termtrace).
//!
//! Scene file -> scene -> camera -> eye ray -> closest hit -> shade -> framebuffer (linear light) -> tone -> picture.
//!
//! Programs depend on `termtrace`, which re-exports the promised items of this crate. The modules below are for
//! `termtrace` itself, and may change in any release; `termtrace` asks for exactly this version. The two are apart so
//! that they compile at the same time, and that changes to one need no build of the other.
//!
//! The guide to these modules, their laws and a glossary are in the documentation of `termtrace`.

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
