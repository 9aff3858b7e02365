//! Copies of a copy pass.

use super::{Copying, Pass};
use crate::access::{Access, Contents};
use crate::declaration::CopyOp;
use crate::handle::{Buffer, Texture};
use crate::subresource::Subresource;

impl Pass<'_, '_, Copying> {
    /// Copies the bytes of a texture to another, or only mip 0 if they have several; one of the formats may be sRGB. For
    /// regions of the same size see [`texture_region`](Self::texture_region).
    pub fn texture(&mut self, source: &Texture, target: &mut Texture) -> &mut Self {
        let (from, to) = (self.mip_0(source), self.mip_0(target));
        self.texture_region(source, from, target, to)
    }

    /// Copies a region of one mip of a texture to a region of another texture, of the same size and format.
    pub fn texture_region(
        &mut self,
        source: &Texture,
        from: Subresource,
        target: &mut Texture,
        to: Subresource,
    ) -> &mut Self {
        self.subresource(from).read_texture(source, Access::CopySource);
        self.subresource(to).write_texture(target, Access::CopyTarget, Contents::Overwrite);
        self.op(CopyOp::TextureToTexture { source: source.id(), target: target.id() })
    }

    /// Copies a whole buffer to another of the same size.
    pub fn buffer(&mut self, source: &Buffer, target: &mut Buffer) -> &mut Self {
        self.buffer_range(source, Subresource::FULL, target, Subresource::FULL)
    }

    /// Copies a range of a buffer to a range of another buffer, of the same size. Ranges begin and end at multiples
    /// of 4.
    pub fn buffer_range(
        &mut self,
        source: &Buffer,
        from: Subresource,
        target: &mut Buffer,
        to: Subresource,
    ) -> &mut Self {
        self.subresource(from).read_buffer(source, Access::CopySource);
        self.subresource(to).write_buffer(target, Access::CopyTarget, Contents::Overwrite);
        self.op(CopyOp::BufferToBuffer { source: source.id(), target: target.id() })
    }

    /// Copies mip 0 of a single-layer texture to a buffer, each row padded to a multiple of 256 bytes. To read a
    /// texture on the CPU, use `Frame::read_back_texture`.
    pub fn texture_to_buffer(&mut self, source: &Texture, target: &mut Buffer) -> &mut Self {
        let from = self.mip_0(source);
        self.subresource(from).read_texture(source, Access::CopySource);
        self.write_buffer(target, Access::CopyTarget, Contents::Overwrite);
        self.op(CopyOp::TextureToBuffer { source: source.id(), target: target.id() })
    }

    fn mip_0(&self, texture: &Texture) -> Subresource {
        match self.frame.texture_desc(texture) {
            Some(desc) if desc.mip_levels > 1 => Subresource::FULL.mip(0),
            _ => Subresource::FULL,
        }
    }

    fn op(&mut self, op: CopyOp) -> &mut Self {
        self.frame.add_copy(self.id, op);
        self
    }
}
