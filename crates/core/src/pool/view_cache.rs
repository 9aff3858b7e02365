//! Views of textures by subresource.

use crate::subresource::{Aspect, Subresource};
use rustc_hash::FxHashMap;
use wgpu::{TextureAspect, TextureViewDescriptor, TextureViewDimension};

/// Intended use of a view.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(crate) enum ViewUsage {
    /// Bound to shaders: one aspect of a depth-stencil format, all selected layers of an array.
    Binding,
    /// Bound to shaders as an array, even for one layer.
    ArrayBinding,
    /// Rendered to: one layer of one mip, all aspects.
    Attachment,
}

struct Cached {
    view: wgpu::TextureView,
    used: u64,
}

/// Views that are reused from frame to frame.
#[derive(Default)]
pub(crate) struct ViewCache {
    frame: u64,
    views: FxHashMap<(wgpu::Texture, Subresource, ViewUsage), Cached>,
}

impl ViewCache {
    /// Starts a frame and drops what was last used before frame `oldest`.
    pub(super) fn begin_frame(&mut self, frame: u64, oldest: u64) {
        self.frame = frame;
        self.views.retain(|_, cached| cached.used >= oldest);
    }

    /// Returns the view of a subresource.
    pub(crate) fn get(
        &mut self,
        texture: &wgpu::Texture,
        part: Subresource,
        usage: ViewUsage,
    ) -> wgpu::TextureView {
        let key = (texture.clone(), Subresource { rect: None, ..part }, usage);
        let new = || Cached { view: create_view(texture, part, usage), used: 0 };
        let cached = self.views.entry(key).or_insert_with(new);
        cached.used = self.frame;
        cached.view.clone()
    }
}

/// Creates a view of a subresource; a rectangle gets the view of its whole mip.
pub(crate) fn create_view(texture: &wgpu::Texture, part: Subresource, usage: ViewUsage) -> wgpu::TextureView {
    let format = texture.format();
    let aspect = match (usage, part.aspect) {
        (ViewUsage::Attachment, _) => TextureAspect::All,
        (_, Aspect::Stencil) => TextureAspect::StencilOnly,
        _ if format.is_combined_depth_stencil_format() => TextureAspect::DepthOnly,
        _ => TextureAspect::All,
    };
    let volume = texture.dimension() == wgpu::TextureDimension::D3;
    let layers = part.layers.filter(|_| !volume);
    let dimension = match usage {
        _ if volume => None,
        ViewUsage::ArrayBinding => Some(TextureViewDimension::D2Array),
        ViewUsage::Attachment => Some(TextureViewDimension::D2),
        // One layer is flat even if the texture has several.
        ViewUsage::Binding => {
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
