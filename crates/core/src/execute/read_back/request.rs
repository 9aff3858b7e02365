//! Asking for a read-back while a frame is declared, and recording it at the frame's end.

#[cfg(test)]
mod tests;

use super::ReadBack;
use super::source::{self, TexturePart};
use crate::declaration::Origin;
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::execute::record::Recording;
use crate::frame::Frame;
use crate::handle::{Buffer, ResourceId, Texture, Version};
use crate::subresource::Subresource;
use wgpu_types::{BufferUsages, TextureUsages};

/// The right to take a [`ReadBack`] out of an executed frame.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadBackRequest {
    pub(crate) frame: u64,
    /// Which of the frame's requests.
    pub(crate) index: u32,
}

/// What is to be copied at the end of the frame.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Requested {
    resource: ResourceId,
    part: Subresource,
}

impl Frame<'_> {
    /// Brings texels of the texture's present contents to the CPU: one mip level, any layers, one aspect, and of
    /// colours a rectangle if need be, such as the one texel under the pointer.
    ///
    /// It is an export: passes that write the texture stay, all of it must have been written, and a later write to
    /// it is an error. The copy is recorded after the frame's passes; [`Executed::read_back`] gives the future.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, Subresource, TextureDesc};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// let mut graph = Graph::new();
    /// let mut frame = graph.frame();
    /// let mut picture = frame.create_texture("picture", TextureDesc::d2(3, 2, Format::Rgba8Unorm));
    /// frame.render_pass("clear").color(&mut picture, Contents::clear_color([1.0; 4]));
    /// let request = frame.read_back_texture(&picture, Subresource::FULL);
    ///
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    /// let texels = executed.read_back(request).ok_or("asked for once")?;
    /// queue.submit([encoder.finish()]);
    /// // Here the program waits; one that draws on awaits, or looks at `is_ready` in later frames.
    /// let texels: Vec<u8> = texels.wait(&device)?;
    /// assert_eq!(texels.len(), 3 * 2 * 4, "rows follow each other without padding");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// `compile` returns [`Error::ReadBack`] where the part is not within the texture or is more than one copy can
    /// take, or the texture is multisampled, has a format that no copy can read, or is an import without `COPY_SRC`.
    ///
    /// [`Executed::read_back`]: crate::Executed::read_back
    pub fn read_back_texture(&mut self, texture: &Texture, part: Subresource) -> ReadBackRequest {
        if let Some(desc) = self.texture_desc(texture) {
            self.check_read_back(texture.0, |name| {
                source::texture(name, &desc, &TexturePart::of(name, &desc, &part)?).map(drop)
            });
        }
        self.export(texture.0, TextureUsages::COPY_SRC, BufferUsages::empty());
        self.request(texture.id(), part)
    }

    /// Brings bytes of the buffer's present contents to the CPU: all, or the range of `part`, which need not be
    /// aligned. See [`read_back_texture`](Self::read_back_texture).
    ///
    /// ```
    /// use shadowgraph_core::{Graph, Subresource};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// let mut graph = Graph::new();
    /// let mut frame = graph.frame();
    /// let numbers = frame.upload_buffer("numbers", &[1u8, 2, 3, 4, 5, 6, 7, 8][..]);
    /// let request = frame.read_back_buffer(&numbers, Subresource::FULL.bytes(2..5));
    ///
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    /// queue.submit([encoder.finish()]);
    /// let bytes = executed.read_back(request).ok_or("asked for once")?.wait(&device)?;
    /// assert_eq!(bytes, [3, 4, 5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// `compile` returns [`Error::ReadBack`] where the range is empty or not within the buffer, or the buffer is an
    /// import without `COPY_SRC`.
    pub fn read_back_buffer(&mut self, buffer: &Buffer, part: Subresource) -> ReadBackRequest {
        if let Some(desc) = self.buffer_desc(buffer) {
            self.check_read_back(buffer.0, |name| match part.problem(&ResourceDesc::Buffer(desc)) {
                None => Ok(()),
                Some(problem) => {
                    Err(Error::ReadBack { resource: name.to_owned(), problem: source::asked(&part, problem) })
                }
            });
        }
        self.export(buffer.0, TextureUsages::empty(), BufferUsages::COPY_SRC);
        self.request(buffer.id(), part)
    }

    fn check_read_back(&mut self, version: Version, check: impl FnOnce(&str) -> Result<(), Error>) {
        let resource = self.decl.resource(version.resource);
        let name = self.decl.resource_name(version.resource);
        let import = matches!(resource.origin, Origin::Imported { .. });
        let usable = match resource.desc {
            ResourceDesc::Texture(_) => resource.texture_usage.contains(TextureUsages::COPY_SRC),
            ResourceDesc::Buffer(_) => resource.buffer_usage.contains(BufferUsages::COPY_SRC),
        };
        let checked = match import && !usable {
            true => Err(Error::ReadBack { resource: name.to_owned(), problem: source::no_usage() }),
            false => check(name),
        };
        if let Err(error) = checked {
            self.report_error(error);
        }
    }

    fn request(&mut self, resource: ResourceId, part: Subresource) -> ReadBackRequest {
        let index = self.work.read_backs.len() as u32;
        self.work.read_backs.push(Requested { resource, part });
        ReadBackRequest { frame: self.id(), index }
    }
}

impl Recording<'_> {
    /// Records the copies that the frame asked for.
    pub(in crate::execute) fn read_backs(
        &self,
        requests: &[Requested],
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<Vec<Option<ReadBack>>, Error> {
        if !requests.is_empty() {
            encoder.push_debug_group("read back");
        }
        let all: Result<Vec<_>, _> =
            requests.iter().map(|request| self.read_back(request, encoder).map(Some)).collect();
        if !requests.is_empty() {
            encoder.pop_debug_group();
        }
        all
    }

    fn read_back(&self, request: &Requested, encoder: &mut wgpu::CommandEncoder) -> Result<ReadBack, Error> {
        let Requested { resource, part } = *request;
        let name = self.plan.decl.resource_name(resource);
        match self.plan.decl.resource(resource).desc {
            ResourceDesc::Texture(_) => {
                let texture = self.texture(resource)?;
                let part = TexturePart::of(name, &TextureDesc::of(texture), &part)?;
                ReadBack::texture(self.device, encoder, name, texture, &part)
            }
            ResourceDesc::Buffer(desc) => {
                let (start, end) = part.bytes.unwrap_or((0, desc.bytes));
                ReadBack::buffer(self.device, encoder, name, self.buffer(resource)?, start..end)
            }
        }
    }
}
