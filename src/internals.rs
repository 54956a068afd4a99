//! No promise: every module of the route, for this project's own program, tests, benches and fuzz targets. Anything here may
//! change in any release.

/// Re-exports what is `pub` in each module.
macro_rules! modules {
    ($($module:ident)*) => {
        $(pub mod $module {
            pub use crate::$module::*;
        })*
    };
}

modules! {
    color
    lanes
    simd
    ray
    bounds
    text
    memory
    progress
    named_file
    scene_text
    mesh_file
    written
    bvh
    shape
    material
    light
    camera
    camera_path
    scene_file
    scene
    hit
    shade
    framebuffer
    render
    tone
    maps
    describe
    grid
    cell
    capabilities
    explain
    overlay
    encode
    export
    record
    output_file
    input
    protocol
    pace
    control
    viewer
    terminal
    app
}
