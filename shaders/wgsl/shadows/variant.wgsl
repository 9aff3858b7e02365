// What the shadows of a frame need: here everything. A frame that needs less replaces this module.
#define_import_path shadowgraph::shadows::variant

const ANY_MAP: u32 = 0xffffffffu;

// Comparisons along each axis in the filters of all lights, 1 to 4; 0: lights differ.
const FILTER_TAPS: u32 = 0u;
// The map of all lights, MAP_*, or ANY_MAP.
const ONLY_MAP: u32 = ANY_MAP;
// Whether all lights are directional.
const DIRECTIONAL: bool = false;
// Whether all lights have the usual settings: views neither blend nor fade out at their edge and are not selected by spheres or depth, the
// bias is that of the receiver's plane and of the sine, and the distance of the fade is the view depth.
const SIMPLE: bool = false;
// Whether translucent casters are drawn into a map.
const TINTED: bool = true;
// Whether the frame has shadows.
const SHADOWED: bool = true;
// Whether only the first light of the scene has shadows, in cascades, and SIMPLE.
const ONE_LIGHT: bool = false;
