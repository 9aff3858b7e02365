//! The history of a pixel: what contributed to it, from the output back through versions and passes.

mod history;
mod place;
mod text;

pub use history::{PixelHistory, PixelPass, PixelRead, PixelWrite, WriteEffect};
pub use place::{PixelPlace, PixelTexel};

use shadowgraph_core::{Contained, Plan, ResourceDesc, ResourceId};

/// Keeps the texels of a frame's textures at the place of a pixel.
///
/// Give [`add`](Self::add) to `Compiled::execute_visited`, with the plan of the frame. Textures with the proportions of the image have a texel at
/// its place, whatever their resolution; shadow maps, tables and buffers have none.
#[derive(Clone, Debug)]
pub struct PixelRecorder {
    place: PixelPlace,
    texels: Vec<KeptTexel>,
}

/// A texel of a version.
#[derive(Clone, Debug)]
struct KeptTexel {
    resource: ResourceId,
    version: u32,
    texel: PixelTexel,
}

impl PixelRecorder {
    /// Keeps the texels at a pixel.
    pub fn new(place: PixelPlace) -> Self {
        Self { place, texels: Vec::new() }
    }

    /// Adds what a pass has written.
    pub fn add(&mut self, plan: &Plan, contained: &Contained) {
        let Contained { resource, version, part, bytes, .. } = contained;
        let ResourceDesc::Texture(desc) = plan.resource(*resource).desc else { return };
        if !self.place.is_in(plan, *resource) {
            return;
        }
        let texels = self.place.texels(&desc, part, bytes);
        let kept = |texel| KeptTexel { resource: *resource, version: *version, texel };
        self.texels.extend(texels.into_iter().map(kept));
    }

    /// Returns the history of the pixel in a texture at the end of the frame.
    pub fn history(&self, plan: &Plan, output: ResourceId) -> PixelHistory {
        history::history(self, plan, output)
    }

    /// Returns the texels of a part of a version, each as the last pass has left it.
    fn texels_in(
        &self,
        resource: ResourceId,
        version: u32,
        contains: impl Fn(&PixelTexel) -> bool,
    ) -> Vec<PixelTexel> {
        let kept = self.texels.iter().filter(|kept| kept.resource == resource && kept.version <= version);
        let mut found: Vec<&KeptTexel> = Vec::new();
        for kept in kept.filter(|kept| contains(&kept.texel)) {
            match found.iter_mut().find(|other| other.texel.is_at(&kept.texel)) {
                Some(other) if other.version <= kept.version => *other = kept,
                Some(_) => {}
                None => found.push(kept),
            }
        }
        found.into_iter().map(|kept| kept.texel.clone()).collect()
    }
}
