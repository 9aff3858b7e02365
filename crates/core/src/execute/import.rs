//! Imports of the caller's textures and buffers.

use crate::desc::{BufferDesc, TextureDesc};
use crate::frame::Frame;
use crate::handle::{Buffer, Texture};
use crate::name::Name;
use crate::pool::PhysicalResource;

impl TextureDesc {
    /// Returns the shape of a texture.
    pub(crate) fn from_texture(texture: &wgpu::Texture) -> Self {
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
    /// Imports a texture that belongs to the caller, such as a surface's; `defined` says whether its contents
    /// are defined when the frame begins. Its shape and usages are those of the texture. Writing an import is an effect
    /// outside the frame, so passes that do so are never culled.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Graph, wgpu};
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// # let usage = wgpu::TextureUsages::RENDER_ATTACHMENT;
    /// # let yours = device.create_texture(&wgpu::TextureDescriptor {
    /// #     label: None, size: wgpu::Extent3d { width: 64, height: 64, depth_or_array_layers: 1 },
    /// #     mip_level_count: 1, sample_count: 1, dimension: wgpu::TextureDimension::D2,
    /// #     format: wgpu::TextureFormat::Rgba8Unorm, usage, view_formats: &[],
    /// # });
    /// let mut graph = Graph::new();
    /// let mut frame = graph.frame();
    /// let mut screen = frame.import_texture("screen", &yours, false);
    /// frame.render_pass("draw").color(&mut screen, Contents::clear_color([0.0; 4]));
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// graph.compile(frame)?.execute(&mut graph, &device, &mut encoder)?;
    /// queue.submit([encoder.finish()]);
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    pub fn import_texture(&mut self, name: impl Name, texture: &wgpu::Texture, defined: bool) -> Texture {
        let handle =
            self.declare_import_texture(name, TextureDesc::from_texture(texture), texture.usage(), defined);
        self.work.imports[handle.id().index()] = Some(PhysicalResource::Texture(texture.clone()));
        handle
    }

    /// Imports a buffer that belongs to the caller. See [`import_texture`](Self::import_texture).
    pub fn import_buffer(&mut self, name: impl Name, buffer: &wgpu::Buffer, defined: bool) -> Buffer {
        let desc = BufferDesc { bytes: buffer.size(), element_bytes: None };
        let handle = self.declare_import_buffer(name, desc, buffer.usage(), defined);
        self.work.imports[handle.id().index()] = Some(PhysicalResource::Buffer(buffer.clone()));
        handle
    }
}
