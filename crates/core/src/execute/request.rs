//! Requesting read-backs while a frame is declared, and recording them at its end.

#[cfg(test)]
mod tests;

use crate::context::Recording;
use crate::declaration::Origin;
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::frame::{Frame, ReadBackDecl};
use crate::handle::{Buffer, ResourceId, Texture, Version};
use crate::read_back::source;
use crate::read_back::{ReadBack, TexturePart};
use crate::subresource::Subresource;
use wgpu_types::{BufferUsages, TextureUsages};

/// Identifies a requested [`ReadBack`] of a frame; see [`Executed::read_back`](crate::Executed::read_back).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadBackRequest {
    pub(crate) frame: u64,
    /// The index of the request in the frame.
    pub(crate) index: u32,
}

impl Frame<'_> {
    /// Reads texels of the texture's current contents back to the CPU: one mip level, any layers, one aspect, and for
    /// colours optionally a rectangle, such as the texel under the mouse pointer.
    ///
    /// This exports the texture: passes that write it are not culled, all of it must have been written, and a later write
    /// to it is an error. The copy is recorded after the frame's passes; [`Executed::read_back`] returns the future.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, Subresource, TextureDesc};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// let mut graph = Graph::new();
    /// let mut frame = graph.frame();
    /// let mut image = frame.create_texture("image", TextureDesc::d2(3, 2, Format::Rgba8Unorm));
    /// frame.render_pass("clear").color(&mut image, Contents::clear_color([1.0; 4]));
    /// let request = frame.read_back_texture(&image, Subresource::FULL);
    ///
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// let mut executed = graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    /// let texels = executed.read_back(request).ok_or("taken once")?;
    /// queue.submit([encoder.finish()]);
    /// // This blocks. A program that keeps drawing awaits, or checks `is_ready` in later frames.
    /// let texels: Vec<u8> = texels.wait(&device)?;
    /// assert_eq!(texels.len(), 3 * 2 * 4, "rows follow each other without padding");
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// `compile` returns [`Error::ReadBack`] if the part is not within the texture or is more than one copy can read, or if
    /// the texture is multisampled, has a format that cannot be copied, or is an import without `COPY_SRC`.
    ///
    /// [`Executed::read_back`]: crate::Executed::read_back
    pub fn read_back_texture(&mut self, texture: &Texture, part: Subresource) -> ReadBackRequest {
        if let Some(desc) = self.texture_desc(texture) {
            self.check_read_back(texture.0, |name| {
                source::texture(name, &desc, &TexturePart::from_part(name, &desc, &part)?).map(drop)
            });
        }
        self.export(texture.0, TextureUsages::COPY_SRC, BufferUsages::empty());
        self.request(texture.id(), part)
    }

    /// Reads bytes of the buffer's current contents back to the CPU: all, or the range of `part`, which need not be
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
    /// let bytes = executed.read_back(request).ok_or("taken once")?.wait(&device)?;
    /// assert_eq!(bytes, [3, 4, 5]);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// `compile` returns [`Error::ReadBack`] if the range is empty or not within the buffer, or if the buffer is an import
    /// without `COPY_SRC`.
    pub fn read_back_buffer(&mut self, buffer: &Buffer, part: Subresource) -> ReadBackRequest {
        if let Some(desc) = self.buffer_desc(buffer) {
            self.check_read_back(buffer.0, |name| match part.problem(&ResourceDesc::Buffer(desc)) {
                None => Ok(()),
                Some(problem) => Err(Error::ReadBack {
                    resource: name.to_owned(),
                    problem: source::describe_request(&part, problem),
                }),
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
            true => Err(Error::ReadBack { resource: name.to_owned(), problem: source::missing_copy_src() }),
            false => check(name),
        };
        if let Err(error) = checked {
            self.report_error(error);
        }
    }

    fn request(&mut self, resource: ResourceId, part: Subresource) -> ReadBackRequest {
        let index = self.work.read_backs.len() as u32;
        self.work.read_backs.push(ReadBackDecl { resource, part });
        ReadBackRequest { frame: self.id(), index }
    }
}

impl Recording<'_> {
    /// Records the copies of the frame's read-backs.
    pub(in crate::execute) fn read_backs(
        &self,
        requests: &[ReadBackDecl],
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

    fn read_back(
        &self,
        request: &ReadBackDecl,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<ReadBack, Error> {
        let ReadBackDecl { resource, part } = *request;
        let name = self.plan.decl.resource_name(resource);
        match self.plan.decl.resource(resource).desc {
            ResourceDesc::Texture(_) => {
                let texture = self.texture(resource)?;
                let part = TexturePart::from_part(name, &TextureDesc::from_texture(texture), &part)?;
                ReadBack::texture(self.device, encoder, name, texture, &part)
            }
            ResourceDesc::Buffer(desc) => {
                let (start, end) = part.bytes.unwrap_or((0, desc.bytes));
                ReadBack::buffer(self.device, encoder, name, self.buffer(resource)?, start..end)
            }
        }
    }
}
