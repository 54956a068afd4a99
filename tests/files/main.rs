//! The meaning of files of scenes, meshes and keys, and their errors.

#[path = "../corpus/mod.rs"]
mod corpus;
mod in_code;
mod invalid;
mod invalid_mesh_files;
mod keys;
mod mesh_corpus;
mod mesh_files;
mod mesh_pieces;
#[path = "../mesh_laws/mod.rs"]
mod mesh_laws;
mod mesh_properties;
mod odd_meshes;
#[path = "../mesh_writers/mod.rs"]
mod mesh_writers;
mod progress;
mod scene_syntax;
mod scene_values;
mod scenes;
mod text_corpus;
#[path = "../text_laws/mod.rs"]
mod text_laws;
