//! Textures and buffers of the caller's.

use crate::desc::{BufferDesc, TextureDesc};
use crate::frame::Frame;
use crate::handle::{Buffer, Texture};
use crate::name::Name;
use crate::pool::Physical;

pub(crate) type Imported = Physical;

impl TextureDesc {
    /// The shape of a texture that is there.
    pub(crate) fn of(texture: &wgpu::Texture) -> Self {
        Self {
            size: texture.size(),
            format: texture.format(),
            mip_levels: texture.mip_level_count(),
            samples: texture.sample_count(),
            dimension: texture.dimension(),
        }
    }
}

impl Frame<'_> {
    /// Imports a texture that belongs to the caller, such as a surface's; `defined` tells whether it holds something
    /// when the frame begins. Its shape and usages are taken from the texture itself. Writing an import is an effect
    /// outside the frame, so passes that do are never culled.
    pub fn import_texture(&mut self, name: impl Name, texture: &wgpu::Texture, defined: bool) -> Texture {
        let handle = self.declare_import_texture(name, TextureDesc::of(texture), texture.usage(), defined);
        self.work.imports[handle.id().index()] = Some(Physical::Texture(texture.clone()));
        handle
    }

    /// Imports a buffer that belongs to the caller. See [`import_texture`](Self::import_texture).
    pub fn import_buffer(&mut self, name: impl Name, buffer: &wgpu::Buffer, defined: bool) -> Buffer {
        let desc = BufferDesc { bytes: buffer.size() };
        let handle = self.declare_import_buffer(name, desc, buffer.usage(), defined);
        self.work.imports[handle.id().index()] = Some(Physical::Buffer(buffer.clone()));
        handle
    }
}
