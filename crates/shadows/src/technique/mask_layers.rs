//! The layers of a screen mask.

use shadowgraph_core::Format;
use shadowgraph_scene::Light;

/// The format of a screen mask.
pub(crate) const MASK_FORMAT: Format = Format::Rgba8Unorm;

/// Largest number of lights in a screen mask; shadows of further lights are evaluated at each lookup.
pub const MAX_MASK_LIGHTS: usize = 16;

/// Number of lights that can share a layer.
const CHANNELS: usize = 4;

/// The lights of each layer of a screen mask.
///
/// A layer of one light holds its visibility in red, green and blue; a layer of two to four lights holds the visibility of each in one
/// channel: red, green, blue, alpha. Lights whose shadows have colours do not share a layer.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct MaskLayers(Vec<Vec<u32>>);

impl MaskLayers {
    /// Returns the layers of the first [`MAX_MASK_LIGHTS`] lights that cast shadows, in the scene's order (directional lights come first).
    /// `colored`: the lights whose shadows have colours, as in [`ShadowOutputs`](super::ShadowOutputs::colored_lights).
    #[must_use]
    pub fn new(lights: &[Light], colored: &[u32]) -> Self {
        let casting = (0u32..).zip(lights).filter(|(_, light)| light.casts_shadow);
        let mut layers: Vec<Vec<u32>> = Vec::new();
        let mut shared = None;
        for (light, _) in casting.take(MAX_MASK_LIGHTS) {
            let open =
                shared.filter(|layer: &usize| layers[*layer].len() < CHANNELS && !colored.contains(&light));
            match open {
                Some(layer) => layers[layer].push(light),
                None => {
                    if !colored.contains(&light) {
                        shared = Some(layers.len());
                    }
                    layers.push(vec![light]);
                }
            }
        }
        Self(layers)
    }

    /// Returns the lights of each layer.
    pub fn iter(&self) -> impl Iterator<Item = &[u32]> {
        self.0.iter().map(Vec::as_slice)
    }

    /// Returns the number of layers.
    #[must_use]
    pub fn count(&self) -> u32 {
        self.0.len() as u32
    }

    /// Returns the number of lights.
    #[must_use]
    pub fn light_count(&self) -> usize {
        self.0.iter().map(Vec::len).sum()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::{DVec3, Vec3};
    use shadowgraph_scene::LightKind;

    fn light(casts_shadow: bool) -> Light {
        let kind = LightKind::Directional { direction: DVec3::NEG_Y };
        Light { name: None, kind, color: Vec3::ONE, intensity: 1.0, casts_shadow }
    }

    fn layers(lights: &[Light], colored: &[u32]) -> Vec<Vec<u32>> {
        MaskLayers::new(lights, colored).0
    }

    #[test]
    fn row_52_four_lights_share_a_layer_and_those_with_colored_shadows_do_not() {
        let lights = vec![light(true); 7];
        assert_eq!(layers(&lights, &[]), [vec![0, 1, 2, 3], vec![4, 5, 6]]);
        assert_eq!(layers(&lights, &[1, 5]), [vec![0, 2, 3, 4], vec![1], vec![5], vec![6]]);
        assert_eq!(layers(&lights, &[0]), [vec![0], vec![1, 2, 3, 4], vec![5, 6]]);
        let all: Vec<u32> = (0..7).collect();
        assert_eq!(layers(&lights, &all), all.iter().map(|light| vec![*light]).collect::<Vec<_>>());
    }

    #[test]
    fn only_lights_that_cast_shadows_have_a_place_up_to_the_limit() {
        let mut lights = vec![light(true), light(false)];
        assert_eq!(layers(&lights, &[]), [[0]]);
        assert_eq!(layers(&lights[1..], &[]), Vec::<Vec<u32>>::new());
        lights.extend((0..20).map(|_| light(true)));
        let layers = MaskLayers::new(&lights, &[]);
        assert_eq!((layers.count(), layers.light_count()), (4, MAX_MASK_LIGHTS));
        assert_eq!(layers.iter().last(), Some(&[13, 14, 15, 16][..]));
    }
}
