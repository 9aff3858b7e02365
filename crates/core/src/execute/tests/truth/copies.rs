//! Results of graphs on the device, compared with the expected ones.

use super::declare::Exports;
use super::gpu::{Gpu, Imports};
use super::graph::{Graph, Plane};
use super::interpret::{State, Word};
use super::run::{Failure, Kind};
use crate::Executed;

/// Alignment of a row of texels in words, as copies require.
const ROW: usize = wgpu::COPY_BYTES_PER_ROW_ALIGNMENT as usize / 4;

/// Copies of everything that is compared, of many frames.
pub(super) struct Copies<'g> {
    gpu: &'g Gpu,
    buffer: wgpu::Buffer,
    end: u64,
    expected: Vec<Expected>,
}

/// A plane or buffer in the copies.
struct Expected {
    graph: usize,
    what: String,
    /// Start in words.
    start: usize,
    /// Texels in a row of a plane, each row at a multiple of [`ROW`].
    width: usize,
    words: Vec<Word>,
}

/// The results of a frame.
pub(super) struct Held<'e> {
    pub(super) executed: &'e Executed,
    pub(super) exports: &'e Exports,
    pub(super) imports: &'e Imports,
}

/// Bytes that a graph may need in the copies for each frame.
pub(super) fn copied_bytes(graph: &Graph) -> u64 {
    let planes = graph.all_planes().map(|plane| graph.size(plane).1 * 4 * ROW as u32);
    // Imports that are exported are copied twice.
    planes.chain(graph.buffers.iter().map(|buffer| buffer.words * 4)).map(u64::from).sum::<u64>() * 2
}

impl<'g> Copies<'g> {
    pub(super) fn new(gpu: &'g Gpu, size: u64) -> Self {
        let usage = wgpu::BufferUsages::MAP_READ | wgpu::BufferUsages::COPY_DST;
        let desc = wgpu::BufferDescriptor { label: Some("copies"), size, usage, mapped_at_creation: false };
        Self { gpu, buffer: gpu.device.create_buffer(&desc), end: 0, expected: Vec::new() }
    }

    /// Records copies of all that a frame exported, and of all imports.
    pub(super) fn copy(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        graph: &Graph,
        held: &Held<'_>,
        state: &State,
        (index, place): (usize, String),
    ) {
        let Held { executed, exports, imports } = held;
        let exported = exports.textures.iter().map(|&(at, export)| (at, executed.texture(export)));
        let imported = imports.textures.iter().map(Option::as_ref).enumerate();
        for (at, texture) in exported.chain(imported.filter(|(_, texture)| texture.is_some())) {
            for plane in graph.planes(at) {
                let what = format!("{place}, {plane:?}");
                let expected = (index, what, state.plane(plane));
                match texture {
                    Some(texture) => self.plane(encoder, texture, plane, expected),
                    None => self.missing(expected),
                }
            }
        }
        let exported = exports.buffers.iter().map(|&(at, export)| (at, executed.buffer(export)));
        let imported = imports.buffers.iter().map(Option::as_ref).enumerate();
        for (at, buffer) in exported.chain(imported.filter(|(_, buffer)| buffer.is_some())) {
            let expected = (index, format!("{place}, buffer {at}"), state.buffer(at));
            match buffer {
                Some(buffer) => self.words(encoder, buffer, expected),
                None => self.missing(expected),
            }
        }
    }

    fn plane(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        texture: &wgpu::Texture,
        plane: Plane,
        (graph, what, words): (usize, String, &[Word]),
    ) {
        let size = texture.size().mip_level_size(plane.mip, texture.dimension());
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..size };
        let origin = wgpu::Origin3d { x: 0, y: 0, z: plane.layer };
        let from = wgpu::TexelCopyTextureInfo { mip_level: plane.mip, origin, ..texture.as_image_copy() };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: self.end,
            bytes_per_row: Some(4 * ROW as u32),
            rows_per_image: None,
        };
        encoder.copy_texture_to_buffer(
            from,
            wgpu::TexelCopyBufferInfo { buffer: &self.buffer, layout },
            size,
        );
        let width = size.width as usize;
        self.expected.push(Expected {
            graph,
            what,
            start: self.end as usize / 4,
            width,
            words: words.to_vec(),
        });
        self.end += u64::from(size.height) * 4 * ROW as u64;
    }

    fn words(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        buffer: &wgpu::Buffer,
        (graph, what, words): (usize, String, &[Word]),
    ) {
        encoder.copy_buffer_to_buffer(buffer, 0, &self.buffer, self.end, buffer.size());
        let start = self.end as usize / 4;
        self.expected.push(Expected { graph, what, start, width: ROW, words: words.to_vec() });
        self.end += buffer.size().next_multiple_of(4 * ROW as u64);
    }

    /// Records a missing export, which fails the comparison.
    fn missing(&mut self, (graph, what, _): (usize, String, &[Word])) {
        let what = format!("{what}, which was not exported");
        self.expected.push(Expected { graph, what, start: usize::MAX, width: ROW, words: Vec::new() });
    }

    /// Waits for the copies and compares every word that is known.
    pub(super) fn compare(self, graphs: &[Graph]) -> Result<usize, Failure> {
        let Self { gpu, buffer, expected, .. } = self;
        buffer.map_async(wgpu::MapMode::Read, .., |_| ());
        let unreadable =
            |error: &dyn std::fmt::Display| Failure { kind: Kind::Invalid, text: error.to_string() };
        gpu.device.poll(wgpu::PollType::wait_indefinitely()).map_err(|error| unreadable(&error))?;
        let bytes = buffer.get_mapped_range(..).map_err(|error| unreadable(&error))?;
        let mut compared = 0;
        for own in &expected {
            let word = |index: usize| {
                let at = (own.start + index / own.width * ROW + index % own.width) * 4;
                u32::from_le_bytes([0, 1, 2, 3].map(|byte| bytes[at + byte]))
            };
            if own.start == usize::MAX {
                return Err(Failure { kind: Kind::Wrong, text: own.what.clone() });
            }
            for (index, expected) in own.words.iter().enumerate() {
                let Word::Is(expected) = *expected else { continue };
                compared += 1;
                if word(index) != expected {
                    let (what, seen) = (&own.what, word(index));
                    let seed = graphs[own.graph].seed;
                    let text =
                        format!("seed {seed}: {what}, word {index}: {seen:#x} instead of {expected:#x}");
                    return Err(Failure { kind: Kind::Wrong, text });
                }
            }
        }
        Ok(compared)
    }
}
