// What a frame's shadows need of the shader: here everything. A frame that needs less puts another module in its place.
#define_import_path shadowgraph::shadows::variant

// Comparisons along each axis that the filters of all lights make, 1 to 4; 0: those of some lights are different ones.
const FILTER_TAPS: u32 = 0u;
// Whether there are shadows at all.
const SHADOWED: bool = true;
