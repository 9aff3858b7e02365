// What rays can meet beside what is opaque: here everything. A scene that has less puts another module in its place.
#define_import_path shadowgraph::ray_surfaces

// Surfaces with holes, and those that colour light.
const CUTOUTS: bool = true;
const TINTS: bool = true;
