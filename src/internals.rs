//! Unstable: all modules, for this project's own program, tests, benches and fuzz targets. Anything
//! here may change in any release.

/// Re-exports the `pub` items of each listed module. Modules that need a feature are listed with
/// the feature below.
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
    scene_text
    mesh_file
    written
    bvh
    shape
    material
    light
    finish
    fog
    camera
    camera_path
    scene
    hit
    shade
    framebuffer
    render
    rasterize
    tone
    maps
    describe
    grid
    cell
    capabilities
    explain
    encode
    export
}

#[cfg(feature = "ron")]
modules! {
    named_file
    scene_file
}

#[cfg(feature = "ratatui")]
modules! {
    overlay
    widget
}

#[cfg(feature = "live")]
modules! {
    output_file
    input
    protocol
    pace
    control
    viewer
    terminal
    app
}

#[cfg(any(feature = "cast", feature = "gif"))]
modules! {
    record
}

#[cfg(feature = "serve")]
modules! {
    serve
}
