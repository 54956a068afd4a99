//! Pictures, and the texts about them.

mod cell_quality;
mod ascii;
mod cells;
mod closed_forms;
mod describe;
mod explain;
mod goldens;
mod hashes;
mod images;
mod instances;
mod maps;
mod motion;
mod odd;
mod povray;
mod properties;
mod rasterized;
mod sampling;
mod shapes;
mod solids;
mod staging;
mod tilted;
mod triangles;
