//! The shape of a screen mask.

use shadowgraph_core::Format;
use shadowgraph_scene::Light;

/// The format of a screen mask: visibility in red, green and blue.
pub(crate) const MASK_FORMAT: Format = Format::Rgba8Unorm;

/// Largest number of lights with a layer in a screen mask; shadows of further lights are evaluated at each lookup.
pub const MAX_MASK_LAYERS: usize = 16;

/// Returns the lights that have a layer, in the order of the layers: the first [`MAX_MASK_LAYERS`] that cast shadows, in the
/// scene's order (directional lights come first).
#[must_use]
pub fn masked_lights(lights: &[Light]) -> Vec<u32> {
    let casting = (0u32..).zip(lights).filter(|(_, light)| light.casts_shadow);
    casting.map(|(index, _)| index).take(MAX_MASK_LAYERS).collect()
}
