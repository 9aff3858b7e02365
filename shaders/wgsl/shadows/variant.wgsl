// Shader features that a frame's shadows need: here all. A frame that needs fewer replaces this module.
#define_import_path shadowgraph::shadows::variant

// Comparisons along each axis in the filters of all lights, 1 to 4; 0: lights differ.
const FILTER_TAPS: u32 = 0u;
// Whether the frame has shadows.
const SHADOWED: bool = true;
