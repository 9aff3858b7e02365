//! Recording pass by pass, with all contents that passes write and that a frame begins with.

use super::Executed;
use super::record::prepare;
use crate::capture::Contained;
use crate::compile::keeping;
use crate::compiled::Compiled;
use crate::context::{Bodies, Recording};
use crate::declaration::{AccessDecl, Origin};
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::graph::Graph;
use crate::handle::{PassId, ResourceId};
use crate::read_back::{ReadBack, TexturePart};
use crate::subresource::{Aspect, Rect, Subresource};
use std::num::NonZeroU32;
use std::ops::ControlFlow;
use std::sync::Arc;
use wgpu_types::TextureUsages;

impl Compiled<'_> {
    /// Records, submits and waits for the frame pass by pass, and calls `visit` with all that each pass has written, and first with what
    /// imports and histories contain that passes read. Memory is needed for the contents of one pass at a time. Where `visit` breaks, the passes
    /// that follow do not run.
    ///
    /// It draws the same as [`execute`](Self::execute), like a [capture](Self::execute_captured). Textures with several samples and
    /// 24 bit depth cannot be copied.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, TextureDesc};
    /// use std::ops::ControlFlow;
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// let mut graph = Graph::new();
    /// let mut frame = graph.frame();
    /// let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    /// frame.render_pass("clear").color(&mut color, Contents::clear_color([1.0; 4]));
    /// frame.export_texture(&color);
    /// let mut sizes = Vec::new();
    /// graph.compile(frame)?.execute_visited(&mut graph, &device, &queue, &mut |contained| {
    ///     sizes.extend(contained.bytes.map(|bytes| bytes.len()));
    ///     ControlFlow::Continue(())
    /// })?;
    /// assert_eq!(sizes, [64 * 64 * 4]);
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    ///
    /// # Errors
    /// As `execute`, and when the device is lost.
    pub fn execute_visited(
        self,
        graph: &mut Graph,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        visit: &mut dyn FnMut(Contained) -> ControlFlow<()>,
    ) -> Result<Executed, Error> {
        record(self, graph, device, queue, visit).map_err(|error| graph.device.classify_error(device, error))
    }
}

fn record(
    mut compiled: Compiled<'_>,
    graph: &mut Graph,
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    visit: &mut dyn FnMut(Contained) -> ControlFlow<()>,
) -> Result<Executed, Error> {
    let plan = compiled.plan.clone();
    compiled.plan = Arc::new(keeping(&plan, TextureUsages::COPY_SRC));
    let pool = &mut graph.device;
    let encoder = || device.create_command_encoder(&Default::default());
    let (mut first, mut last) = (encoder(), encoder());
    let mut bodies = std::mem::take(&mut compiled.frame.work.bodies);
    let prepared = prepare(&compiled, pool, device, &mut first, Some(&last))?;
    let recording = prepared.recording(&compiled, pool, device, None);
    let mut show = |encoder: wgpu::CommandEncoder, pending: Vec<Pending>| -> Result<ControlFlow<()>, Error> {
        queue.submit([encoder.finish()]);
        for pending in pending {
            if visit(pending.wait(device)?).is_break() {
                return Ok(ControlFlow::Break(()));
            }
        }
        Ok(ControlFlow::Continue(()))
    };
    let initial = initial(&recording, &mut first);
    let mut flow = show(first, initial)?;
    for (index, step) in compiled.plan.steps().enumerate() {
        if flow.is_break() {
            break;
        }
        let mut encoder = encoder();
        recording.steps(index..index + 1, &mut encoder, Bodies::OfFrame(&mut bodies))?;
        let written = step.passes.iter().flat_map(|&pass| {
            let accesses = compiled.plan.decl.accesses(pass).iter();
            let writes = accesses.filter(|access| access.contents.writes());
            writes.map(move |access| (Some(pass), access, access.version + 1))
        });
        let written: Vec<_> = written.collect();
        let pending = written.into_iter().flat_map(|(pass, access, version)| {
            let part = compiled.plan.decl.subresource(access);
            copies(&recording, (pass, access.resource, version), part, &mut encoder)
        });
        let pending = pending.collect();
        flow = show(encoder, pending)?;
    }
    let read_backs = recording.read_backs(&compiled.frame.work.read_backs, &mut last)?;
    compiled.frame.work.bodies = bodies;
    queue.submit([last.finish()]);
    Ok(prepared.finish(compiled, pool, read_backs).with_plan(plan))
}

/// Records copies of all imports and histories whose first contents passes read.
fn initial(recording: &Recording<'_>, encoder: &mut wgpu::CommandEncoder) -> Vec<Pending> {
    let decl = &recording.plan.decl;
    let reads_first = |access: &&AccessDecl| access.version == 0 && access.contents.needs();
    let accesses = recording.plan.order.iter().flat_map(|&pass| decl.accesses(pass)).filter(reads_first);
    let mut resources: Vec<ResourceId> = accesses
        .map(|access| access.resource)
        .filter(|&resource| decl.resource(resource).origin != Origin::Transient)
        .collect();
    resources.sort_unstable();
    resources.dedup();
    let copied = resources
        .into_iter()
        .flat_map(|resource| copies(recording, (None, resource, 0), Subresource::FULL, encoder));
    copied.collect()
}

/// Contents on their way to the CPU.
struct Pending {
    contained: Contained,
    copied: Option<ReadBack>,
    kept: Kept,
}

/// What is kept of a copy.
enum Kept {
    All,
    /// The part, if the copy is larger.
    Crop(Crop),
    /// All, with the elements of this size sorted.
    Sorted(NonZeroU32),
}

/// A rectangle of layers whose texels have some bytes.
struct Crop {
    rect: Rect,
    /// Size of the layers, texels.
    size: [u32; 2],
    texel_bytes: u32,
}

impl Crop {
    fn apply(&self, bytes: &[u8]) -> Vec<u8> {
        let [width, height] = self.size.map(|side| side as usize);
        let Rect { x, y, width: columns, height: rows } = self.rect;
        let texel = self.texel_bytes as usize;
        let first = x as usize * texel;
        let layers = bytes.chunks_exact((width * height * texel).max(1));
        let kept =
            layers.flat_map(|layer| layer.chunks_exact(width * texel).skip(y as usize).take(rows as usize));
        kept.flat_map(|row| &row[first..first + columns as usize * texel]).copied().collect()
    }
}

impl Pending {
    fn wait(mut self, device: &wgpu::Device) -> Result<Contained, Error> {
        if let Some(copied) = self.copied {
            let bytes = copied.wait(device)?;
            self.contained.bytes = Ok(match self.kept {
                Kept::All => bytes,
                Kept::Crop(crop) => crop.apply(&bytes),
                Kept::Sorted(size) => sorted_elements(&bytes, size),
            });
        }
        Ok(self.contained)
    }
}

/// Records copies of a part: of each mip level and aspect.
fn copies(
    recording: &Recording<'_>,
    (pass, resource, version): (Option<PassId>, ResourceId, u32),
    part: Subresource,
    encoder: &mut wgpu::CommandEncoder,
) -> Vec<Pending> {
    let decl = &recording.plan.decl;
    let (device, name) = (recording.device, decl.resource_name(resource));
    let mut pending = Vec::new();
    let mut add = |part, copied: Result<ReadBack, Error>, kept| {
        let (copied, bytes) = match copied {
            Ok(copied) => (Some(copied), Ok(Vec::new())),
            Err(Error::ReadBack { problem, .. }) => (None, Err(problem)),
            Err(error) => (None, Err(error.to_string())),
        };
        pending.push(Pending { contained: Contained { pass, resource, version, part, bytes }, copied, kept });
    };
    match decl.resource(resource).desc {
        ResourceDesc::Texture(desc) => {
            for part in mips_and_aspects(&desc, part) {
                // Depth and stencil can only be copied whole.
                let is_depth = desc.format.is_depth_stencil_format();
                let crop = part.rect.filter(|_| is_depth).and_then(|rect| crop(&desc, part, rect));
                let whole = if crop.is_some() { Subresource { rect: None, ..part } } else { part };
                let copied = TexturePart::from_part(name, &desc, &whole).and_then(|copied_part| {
                    ReadBack::texture(device, encoder, name, recording.texture(resource)?, &copied_part)
                });
                add(part, copied, crop.map_or(Kept::All, Kept::Crop));
            }
        }
        ResourceDesc::Buffer(desc) => {
            let (start, end) = part.bytes.unwrap_or((0, desc.bytes));
            let copied = recording
                .buffer(resource)
                .and_then(|buffer| ReadBack::buffer(device, encoder, name, buffer, start..end));
            let is_whole = start == 0 && end == desc.bytes;
            let element_bytes = desc.element_bytes.filter(|_| is_whole);
            add(part, copied, element_bytes.map_or(Kept::All, Kept::Sorted));
        }
    }
    pending
}

/// Returns elements in the order of their bytes; what is left after the last one stays at the end.
fn sorted_elements(bytes: &[u8], element_bytes: NonZeroU32) -> Vec<u8> {
    let (elements, rest) = bytes.split_at(bytes.len() - bytes.len() % element_bytes.get() as usize);
    let mut elements: Vec<&[u8]> = elements.chunks_exact(element_bytes.get() as usize).collect();
    elements.sort_unstable();
    elements.push(rest);
    elements.concat()
}

/// Returns what a rectangle keeps of the copy of a mip level of an aspect.
fn crop(desc: &TextureDesc, part: Subresource, rect: Rect) -> Option<Crop> {
    let aspect = match part.aspect {
        Aspect::All => wgpu::TextureAspect::All,
        Aspect::Depth => wgpu::TextureAspect::DepthOnly,
        Aspect::Stencil => wgpu::TextureAspect::StencilOnly,
    };
    let size = desc.size.mip_level_size(part.first_mip(), desc.dimension);
    let texel_bytes = desc.format.block_copy_size(Some(aspect))?;
    Some(Crop { rect, size: [size.width, size.height], texel_bytes })
}

/// Splits a part into its mip levels and aspects.
fn mips_and_aspects(desc: &TextureDesc, part: Subresource) -> Vec<Subresource> {
    let aspects: &[Aspect] = match part.aspect {
        Aspect::All if desc.format.is_combined_depth_stencil_format() => &[Aspect::Depth, Aspect::Stencil],
        Aspect::All => &[Aspect::All],
        Aspect::Depth => &[Aspect::Depth],
        Aspect::Stencil => &[Aspect::Stencil],
    };
    let (first, end) = part.mips.unwrap_or((0, desc.mip_levels));
    let mips = (first..end).map(|mip| match desc.mip_levels {
        1 => part,
        _ => Subresource { mips: Some((mip, mip + 1)), ..part },
    });
    mips.flat_map(|part| aspects.iter().map(move |&aspect| Subresource { aspect, ..part })).collect()
}
