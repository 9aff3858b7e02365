// The kinds of surfaces that rays can hit besides opaque ones: here all. A scene with fewer replaces this module.
#define_import_path shadowgraph::ray_surfaces

// Surfaces with holes, and surfaces that tint light.
const CUTOUTS: bool = true;
const TINTS: bool = true;
