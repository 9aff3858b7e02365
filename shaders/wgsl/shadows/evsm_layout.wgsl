// How the moments of `evsm` are stored: here in the form of most. Frames that ask for another put a module in its place.
#define_import_path shadowgraph::shadows::evsm_layout

// Four moments, or only those of the warp that grows away from the light.
const FOUR: bool = true;
// Each in 16 bits, or in 32.
const HALF: bool = false;
