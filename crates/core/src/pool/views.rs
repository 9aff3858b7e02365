//! Views of textures by the part that they show.

use crate::subresource::{Aspect, Subresource};
use rustc_hash::FxHashMap;
use wgpu::{TextureAspect, TextureViewDescriptor, TextureViewDimension};

/// How a view will be used.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum Purpose {
    /// Bound to shaders: of a depth-stencil format one aspect, of an array all chosen layers.
    Binding,
    /// The same as an array, of one layer too.
    ArrayBinding,
    /// Drawn into: one layer of one mip, all aspects.
    Attachment,
}

struct Cached {
    view: wgpu::TextureView,
    used: u64,
}

/// Views that are used from frame to frame.
#[derive(Default)]
pub(crate) struct Views {
    frame: u64,
    views: FxHashMap<(wgpu::Texture, Subresource, Purpose), Cached>,
}

impl Views {
    /// Starts a frame and drops what was last used before frame `oldest`.
    pub(super) fn begin_frame(&mut self, frame: u64, oldest: u64) {
        self.frame = frame;
        self.views.retain(|_, cached| cached.used >= oldest);
    }

    /// Returns the view of a part.
    pub(crate) fn get(
        &mut self,
        texture: &wgpu::Texture,
        part: Subresource,
        purpose: Purpose,
    ) -> wgpu::TextureView {
        let key = (texture.clone(), Subresource { rect: None, ..part }, purpose);
        let new = || Cached { view: view(texture, part, purpose), used: 0 };
        let cached = self.views.entry(key).or_insert_with(new);
        cached.used = self.frame;
        cached.view.clone()
    }
}

/// Creates a view of a part; a rectangle cannot be told from its mip.
pub(crate) fn view(texture: &wgpu::Texture, part: Subresource, purpose: Purpose) -> wgpu::TextureView {
    let format = texture.format();
    let aspect = match (purpose, part.aspect) {
        (Purpose::Attachment, _) => TextureAspect::All,
        (_, Aspect::Stencil) => TextureAspect::StencilOnly,
        _ if format.is_combined_depth_stencil_format() => TextureAspect::DepthOnly,
        _ => TextureAspect::All,
    };
    let volume = texture.dimension() == wgpu::TextureDimension::D3;
    let layers = part.layers.filter(|_| !volume);
    let dimension = match purpose {
        _ if volume => None,
        Purpose::ArrayBinding => Some(TextureViewDimension::D2Array),
        Purpose::Attachment => Some(TextureViewDimension::D2),
        // One layer is flat even if the texture has several.
        Purpose::Binding => {
            layers.is_some_and(|(first, end)| end - first == 1).then_some(TextureViewDimension::D2)
        }
    };
    texture.create_view(&TextureViewDescriptor {
        aspect,
        dimension,
        base_mip_level: part.mips.map_or(0, |(first, _)| first),
        mip_level_count: part.mips.map(|(first, end)| end - first),
        base_array_layer: layers.map_or(0, |(first, _)| first),
        array_layer_count: layers.map(|(first, end)| end - first),
        ..Default::default()
    })
}
