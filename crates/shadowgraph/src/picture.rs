//! Pictures on their way back from the GPU.

use std::sync::Arc;

use shadowgraph_core::{Frame, PassTime, Plan, Texture};
use shadowgraph_shadows::Unshadowed;

use crate::Error;

/// A picture: 8 bit red, green, blue and alpha, rows from the top without padding.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Picture {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Four bytes a pixel.
    pub rgba8: Vec<u8>,
}

impl Picture {
    /// Returns the pixel at `x` from the left and `y` from the top; `None` outside.
    pub fn pixel(&self, x: u32, y: u32) -> Option<[u8; 4]> {
        let [width, height] = self.size_px;
        let at = (x < width && y < height).then(|| (y as usize * width as usize + x as usize) * 4)?;
        self.rgba8.get(at..at + 4)?.try_into().ok()
    }
}

/// A drawn view.
#[derive(Debug)]
pub struct Drawn {
    /// What was drawn.
    pub picture: Picture,
    /// How; equal frames share it.
    pub plan: Arc<Plan>,
    /// How long each pass took, if it was measured.
    pub times: Vec<PassTime>,
    /// The lights that are to cast shadows but have none, and why.
    pub unshadowed: Vec<Unshadowed>,
}

/// A buffer that a frame copies its picture into.
pub(crate) struct ReadBack {
    buffer: wgpu::Buffer,
    size_px: [u32; 2],
}

impl ReadBack {
    pub(crate) fn new(device: &wgpu::Device, size_px: [u32; 2]) -> Self {
        let size = u64::from(Self::row_bytes(size_px)) * u64::from(size_px[1]);
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let label = Some("picture");
        let buffer =
            device.create_buffer(&wgpu::BufferDescriptor { label, size, usage, mapped_at_creation: false });
        Self { buffer, size_px }
    }

    /// Rows of a copy are padded.
    fn row_bytes([width, _]: [u32; 2]) -> u32 {
        (width * 4).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT)
    }

    /// Adds the pass that copies `picture`, a texture of four bytes a pixel.
    pub(crate) fn add_to(&self, frame: &mut Frame<'_>, picture: &Texture) {
        let mut buffer = frame.import_buffer("read back", &self.buffer, false);
        frame.copy_pass("read back").texture_to_buffer(picture, &mut buffer);
    }

    /// Waits for the submitted frame.
    pub(crate) fn read(&self, device: &wgpu::Device) -> Result<Picture, Error> {
        let failed = |error: &dyn std::fmt::Display| Error::Gpu(error.to_string());
        self.buffer.slice(..).map_async(wgpu::MapMode::Read, |_| ());
        device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| failed(&error))?;
        let padded = self.buffer.get_mapped_range(..).map_err(|error| failed(&error))?;
        let rows = padded.chunks_exact(Self::row_bytes(self.size_px) as usize);
        let rgba8 = rows.flat_map(|row| &row[..self.size_px[0] as usize * 4]).copied().collect();
        Ok(Picture { size_px: self.size_px, rgba8 })
    }
}
