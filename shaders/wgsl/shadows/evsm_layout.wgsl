// The storage of `evsm` moments: the most common form. Frames with another form replace this module.
#define_import_path shadowgraph::shadows::evsm_layout

// Four moments, or only the two of the warp that grows away from the light.
const FOUR: bool = true;
// 16 bits each, or 32.
const HALF: bool = false;
