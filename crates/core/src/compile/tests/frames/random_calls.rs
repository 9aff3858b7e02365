//! Frames that make no sense: any call with any argument.

use super::Source;
use crate::{
    Aspect, Buffer, BufferDesc, BufferUsages, ClearValue, Contents, Format, Frame, PassId, Rect, Resize,
    Subresource, Texture, TextureDesc, TextureUsages,
};
use wgpu_types::TextureDimension;

const FORMATS: [Format; 10] = [
    Format::Rgba8Unorm,
    Format::Rgba8Unorm,
    Format::Rgba8Unorm,
    Format::R32Uint,
    Format::Rgba16Float,
    Format::Depth32Float,
    Format::Depth24PlusStencil8,
    Format::Stencil8,
    Format::Bc1RgbaUnorm,
    Format::NV12,
];

/// Declares a frame at random. Only a panic is a fault here.
pub(in super::super) fn random_calls_from_bytes(bytes: &[u8]) -> Frame<'static> {
    let mut calls = RandomCalls {
        source: Source::new(bytes),
        textures: Vec::new(),
        buffers: Vec::new(),
        passes: Vec::new(),
    };
    let mut frame = Frame::new();
    while !calls.source.is_empty() {
        calls.call(&mut frame);
    }
    frame
}

struct RandomCalls<'b> {
    source: Source<'b>,
    textures: Vec<Texture>,
    buffers: Vec<Buffer>,
    passes: Vec<PassId>,
}

impl RandomCalls<'_> {
    /// Small, or at the limits.
    fn number(&mut self) -> u32 {
        match self.source.below(16) {
            0..=3 => 1 << self.source.below(4),
            4..=11 => self.source.below(9) as u32,
            12 => u32::MAX,
            13 => u32::MAX - self.source.below(4) as u32,
            14 => 1 << 31,
            _ => 1 << self.source.below(31),
        }
    }

    fn desc(&mut self) -> TextureDesc {
        let format = self.source.pick(&FORMATS);
        let mut desc = TextureDesc::d2(8, 8, format);
        if self.source.chance(48) {
            desc = TextureDesc::d2(self.number(), self.number(), format).layers(self.number());
        }
        if self.source.chance(32) {
            desc.mip_levels = self.number();
        }
        if self.source.chance(32) {
            desc.samples = self.number();
        }
        let dimensions =
            [TextureDimension::D2, TextureDimension::D2, TextureDimension::D1, TextureDimension::D3];
        desc.dimension = self.source.pick(&dimensions);
        desc
    }

    fn subresource(&mut self) -> Subresource {
        let mut subresource = Subresource::FULL;
        if !self.source.chance(48) {
            return subresource;
        }
        if self.source.chance(64) {
            subresource = subresource.mips(self.number()..self.number());
        }
        if self.source.chance(64) {
            subresource = subresource.layers(self.number()..self.number());
        }
        if self.source.chance(64) {
            subresource =
                subresource.rect(Rect::new(self.number(), self.number(), self.number(), self.number()));
        }
        if self.source.chance(64) {
            let long = |number: u32| u64::from(number) * u64::from(number);
            subresource = subresource.bytes(long(self.number())..long(self.number()));
        }
        subresource.aspect(self.source.pick(&[Aspect::All, Aspect::All, Aspect::Depth, Aspect::Stencil]))
    }

    fn contents(&mut self) -> Contents {
        match self.source.below(7) {
            0 => Contents::Preserve,
            1..=3 => Contents::Overwrite,
            4 => Contents::Clear(ClearValue::Color([f64::NAN, f64::INFINITY, -1.0, 1e300])),
            5 => Contents::Clear(ClearValue::Depth(f32::NAN)),
            _ => Contents::Clear(ClearValue::DepthStencil(0.5, self.number())),
        }
    }

    /// A known handle, most often the present one.
    fn texture(&mut self, frame: &mut Frame<'static>) -> (usize, Texture) {
        if self.textures.is_empty() || self.source.chance(48) {
            let desc = self.desc();
            let usage = TextureUsages::from_bits_truncate(self.number());
            self.textures.push(match self.source.below(8) {
                0 => frame.declare_import_texture("import", desc, usage, true),
                1 => frame.history("history", desc, Resize::Resample).current,
                2 => Frame::new().create_texture("foreign", desc),
                _ => frame.create_texture("texture", desc),
            });
        }
        let index = self.source.below(self.textures.len());
        (index, self.textures[index].clone())
    }

    fn buffer(&mut self, frame: &mut Frame<'static>) -> (usize, Buffer) {
        if self.buffers.is_empty() || self.source.chance(48) {
            let bytes = u64::from(self.number()) * u64::from(self.number());
            let usage = BufferUsages::from_bits_truncate(self.number());
            self.buffers.push(match self.source.below(8) {
                0 => frame.declare_import_buffer(
                    "import",
                    BufferDesc { bytes, element_bytes: None },
                    usage,
                    false,
                ),
                1 => frame.upload_buffer("upload", vec![0; self.source.below(9)]),
                _ => frame.create_buffer("buffer", BufferDesc { bytes, element_bytes: None }),
            });
        }
        let index = self.source.below(self.buffers.len());
        (index, self.buffers[index].clone())
    }

    fn call(&mut self, frame: &mut Frame<'static>) {
        let (index, mut texture) = self.texture(frame);
        let (position, mut buffer) = self.buffer(frame);
        let (subresource, contents) = (self.subresource(), self.contents());
        match self.source.below(12) {
            0..=4 => self.draw(frame, &mut texture, &buffer, subresource, contents),
            5 | 6 => self.compute(frame, &mut texture, &mut buffer, subresource, contents),
            7 => self.copy(frame, &mut texture, &mut buffer, subresource),
            8 => {
                let mut pass = frame.encoder_pass("encoder");
                pass.subresource(subresource).attachment(&mut texture, contents);
                pass.subresource(subresource).copy_source_buffer(&buffer);
                let other = self.passes.get(self.source.below(9)).copied().unwrap_or(pass.id());
                pass.after(other);
                self.passes.push(pass.id());
            }
            9 => {
                frame.export_texture(&texture);
            }
            10 => {
                frame.export_buffer(&buffer);
            }
            _ => {
                let _missing = frame.published::<u32>();
            }
        }
        // Now and then a handle is left behind.
        if !self.source.chance(16) {
            (self.textures[index], self.buffers[position]) = (texture, buffer);
        }
    }

    fn draw(
        &mut self,
        frame: &mut Frame<'static>,
        texture: &mut Texture,
        buffer: &Buffer,
        subresource: Subresource,
        contents: Contents,
    ) {
        let (_, mut other) = self.texture(frame);
        let mut pass = frame.render_pass("draw");
        match self.source.below(4) {
            0 => pass.subresource(subresource).depth(texture, contents),
            1 => pass.subresource(subresource).resolve(texture),
            2 => pass.subresource(subresource).depth_read(texture),
            _ => pass.subresource(subresource).color(texture, contents),
        };
        if self.source.chance(96) {
            pass.color(&mut other, contents);
            pass.vertex_buffer(buffer);
        }
        if self.source.chance(64) {
            pass.keep();
        }
    }

    fn compute(
        &mut self,
        frame: &mut Frame<'static>,
        texture: &mut Texture,
        buffer: &mut Buffer,
        subresource: Subresource,
        contents: Contents,
    ) {
        let mut pass = frame.compute_pass("compute");
        match self.source.below(4) {
            0 => drop((
                pass.subresource(subresource).storage_texture_mut(texture, contents),
                pass.indirect_buffer(buffer),
            )),
            1 => drop((
                pass.subresource(subresource).sample(texture),
                pass.storage_buffer_mut(buffer, contents),
            )),
            2 => drop((
                pass.sample(texture),
                pass.subresource(subresource).storage_buffer_mut(buffer, contents),
            )),
            _ => drop((pass.storage_texture(texture), pass.subresource(subresource).uniform_buffer(buffer))),
        }
        if self.source.chance(128) {
            pass.keep();
        }
    }

    fn copy(
        &mut self,
        frame: &mut Frame<'static>,
        texture: &mut Texture,
        buffer: &mut Buffer,
        subresource: Subresource,
    ) {
        let (_, source) = self.texture(frame);
        let (_, bytes) = self.buffer(frame);
        let to = self.subresource();
        let mut pass = frame.copy_pass("copy");
        match self.source.below(4) {
            0 => pass.texture(&source, texture),
            1 => pass.texture_region(&source, subresource, texture, to),
            2 => pass.buffer_range(&bytes, subresource, buffer, to),
            _ => pass.texture_to_buffer(&source, buffer),
        };
    }
}
