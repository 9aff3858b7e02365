// What the materials of a scene use, here everything. A pass that draws a scene whose materials use less replaces this module.
#define_import_path shadowgraph::material_features

// Bit i: some material has texture i.
const TEXTURES: u32 = 31u;
// Whether some texture has a transform, or reads the second uv set.
const UV_TRANSFORMS: bool = true;
