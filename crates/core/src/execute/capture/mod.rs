//! Snapshots of what passes write, taken after each pass.

use super::Executed;
use super::record::record;
use crate::capture::{SnapshotTile, TextureSnapshot};
use crate::compile::keeping;
use crate::compiled::Compiled;
use crate::context::Recording;
use crate::declaration::AccessDecl;
use crate::desc::{ResourceDesc, TextureDesc};
use crate::error::Error;
use crate::graph::Graph;
use crate::handle::{PassId, ResourceId};
use crate::plan::Plan;
use crate::read_back::{ReadBack, TexturePart};
use crate::subresource::{Aspect, Subresource};
use crate::texels;
use std::ops::Range;
use std::sync::Arc;

/// Layers of a texture beyond these are not captured.
const MAX_LAYERS: u32 = 16;
/// Larger buffers are not captured.
const MAX_BUFFER_BYTES: u64 = 65_536;

/// A capture of a frame that is on its way to the CPU.
#[must_use = "only `wait` returns the capture"]
pub struct PendingCapture {
    snapshots: Vec<PendingSnapshot>,
    buffers: Vec<(ResourceId, ReadBack)>,
}

/// The contents that the passes of a frame wrote.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct FrameCapture {
    /// Every texture at each of its versions, in the order of the passes. At most 320 texels of a side are kept, evenly
    /// spaced.
    pub textures: Vec<TextureSnapshot>,
    /// The bytes of every buffer of at most 64 KiB after each pass that wrote it, in the order of the passes.
    pub buffers: Vec<(ResourceId, Vec<u8>)>,
}

/// One mip level of a texture after the pass that wrote it.
pub(super) struct PendingSnapshot {
    resource: ResourceId,
    /// The range of versions that it shows.
    since: u32,
    version: u32,
    pass: PassId,
    mip: u32,
    desc: TextureDesc,
    /// The copied layers, or why there are none.
    copied: Result<(Range<u32>, ReadBack), String>,
    tiles: Vec<SnapshotTile>,
}

impl Compiled<'_> {
    /// Records the frame and captures every texture at each of its versions. Nothing is submitted.
    ///
    /// It records a variant of the plan that draws the same: no passes are merged, everything is stored, nothing is
    /// aliased, and copies follow each pass. It needs memory for all versions of all textures. [`Executed::plan`] is the
    /// frame's own plan.
    ///
    /// One snapshot shows consecutive passes that draw into separate rectangles, with the names of the passes.
    ///
    /// ```
    /// use shadowgraph_core::{Contents, Format, Graph, TextureDesc};
    /// # use shadowgraph_core::wgpu;
    /// # let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    /// let mut graph = Graph::new();
    /// let mut frame = graph.frame();
    /// let mut color = frame.create_texture("color", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    /// frame.render_pass("clear").color(&mut color, Contents::clear_color([1.0; 4]));
    /// frame.export_texture(&color);
    /// let mut encoder = device.create_command_encoder(&Default::default());
    /// let (_executed, capture) = graph.compile(frame)?.execute_captured(&mut graph, &device, &mut encoder)?;
    /// queue.submit([encoder.finish()]);
    /// let captured = capture.wait(&device)?;
    /// assert_eq!(captured.textures.len(), 1);
    /// # Ok::<(), shadowgraph_core::Error>(())
    /// ```
    ///
    /// # Errors
    /// As [`execute`](Self::execute).
    pub fn execute_captured(
        mut self,
        graph: &mut Graph,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(Executed, PendingCapture), Error> {
        let plan = self.plan.clone();
        self.plan = Arc::new(keeping(&plan, wgpu::TextureUsages::COPY_SRC));
        let mut capture = PendingCapture { snapshots: Vec::new(), buffers: Vec::new() };
        let mut hook = |recording: &Recording<'_>, pass: PassId, encoder: &mut wgpu::CommandEncoder| {
            capture.after_pass(recording, pass, encoder)
        };
        let executed = record(self, &mut graph.device, device, encoder, None, Some(&mut hook))?;
        Ok((executed.with_plan(plan), capture))
    }
}

impl PendingCapture {
    /// Waits for the submitted frame and returns its capture.
    ///
    /// # Errors
    /// When the device is lost, or the encoder was not submitted.
    pub fn wait(self, device: &wgpu::Device) -> Result<FrameCapture, Error> {
        let mut captured = FrameCapture::default();
        for snapshot in self.snapshots {
            snapshot.decode(device, &mut captured.textures)?;
        }
        for (buffer, bytes) in self.buffers {
            captured.buffers.push((buffer, bytes.wait(device)?));
        }
        Ok(captured)
    }

    /// Records copies of everything that a pass wrote.
    fn after_pass(
        &mut self,
        recording: &Recording<'_>,
        pass: PassId,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Result<(), Error> {
        let decl = &recording.plan.decl;
        for access in decl.accesses(pass).iter().filter(|access| access.contents.writes()) {
            match decl.resource(access.resource).desc {
                ResourceDesc::Texture(desc) => self.take(recording, pass, access, &desc, encoder),
                ResourceDesc::Buffer(desc) if desc.bytes <= MAX_BUFFER_BYTES => {
                    let (id, name) = (access.resource, decl.resource_name(access.resource));
                    let buffer = recording.buffer(id)?;
                    if buffer.usage().contains(wgpu::BufferUsages::COPY_SRC) {
                        let bytes = ReadBack::buffer(recording.device, encoder, name, buffer, 0..desc.bytes)?;
                        self.buffers.push((id, bytes));
                    }
                }
                ResourceDesc::Buffer(_) => {}
            }
        }
        Ok(())
    }

    /// Records snapshots of a texture that a pass wrote.
    fn take(
        &mut self,
        recording: &Recording<'_>,
        pass: PassId,
        access: &AccessDecl,
        desc: &TextureDesc,
        encoder: &mut wgpu::CommandEncoder,
    ) {
        let plan = recording.plan;
        if continues(plan, pass, access) {
            return;
        }
        let part = plan.decl.subresource(access);
        let (first, end) = part.mips.unwrap_or((0, desc.mip_levels));
        for mip in first..end {
            let copied =
                TexturePart { mip, layers: layers(desc, part, mip), aspect: aspect(desc, part), rect: None };
            self.snapshots.push(PendingSnapshot::new(recording, (pass, access, desc), copied, encoder));
        }
    }
}

/// Returns whether the next pass that touches what the access wrote draws into another rectangle of it.
fn continues(plan: &Plan, pass: PassId, access: &AccessDecl) -> bool {
    let part = plan.decl.subresource(access);
    let later = plan.order.iter().skip_while(|&&other| other != pass).skip(1);
    let mut touching =
        later.flat_map(|&other| plan.decl.accesses(other)).filter(|other| same_layer(plan, access, other));
    part.rect.is_some()
        && touching
            .next()
            .is_some_and(|next| next.contents.writes() && plan.decl.subresource(next).rect.is_some())
}

fn same_layer(plan: &Plan, a: &AccessDecl, b: &AccessDecl) -> bool {
    let layer = |access| Subresource { rect: None, ..plan.decl.subresource(access) };
    a.resource == b.resource && layer(a) == layer(b)
}

/// Returns the first of the consecutive versions that were drawn into separate rectangles up to this one.
fn since(plan: &Plan, pass: PassId, access: &AccessDecl) -> u32 {
    let before = plan.order.iter().rev().skip_while(|&&other| other != pass).skip(1);
    let mut first = access.version + 1;
    for &other in before {
        for earlier in plan.decl.accesses(other).iter().filter(|other| same_layer(plan, access, other)) {
            if !earlier.contents.writes() || !continues(plan, other, earlier) {
                return first;
            }
            first = earlier.version + 1;
        }
    }
    first
}

/// Returns the rectangles that passes have drawn into up to this one, each with the name of the last such pass.
fn tiles(plan: &Plan, pass: PassId, access: &AccessDecl) -> Vec<SnapshotTile> {
    let mut tiles: Vec<SnapshotTile> = Vec::new();
    for &earlier in &plan.order {
        for other in plan.decl.accesses(earlier) {
            if !other.contents.writes() || !same_layer(plan, access, other) {
                continue;
            }
            let Some(rect) = plan.decl.subresource(other).rect else { continue };
            tiles.retain(|tile| tile.rect != rect);
            tiles.push(SnapshotTile { rect, name: plan.pass(earlier).name.into() });
        }
        if earlier == pass {
            break;
        }
    }
    tiles
}

fn layers(desc: &TextureDesc, part: Subresource, mip: u32) -> Range<u32> {
    let Range { start, end } = part.layer_range(desc, mip);
    start..end.min(start + MAX_LAYERS)
}

/// Returns the captured aspect: depth of a combined depth-stencil format, unless the pass writes only the stencil.
pub(super) fn aspect(desc: &TextureDesc, part: Subresource) -> wgpu::TextureAspect {
    match part.aspect {
        Aspect::Stencil => wgpu::TextureAspect::StencilOnly,
        _ if desc.format.is_combined_depth_stencil_format() => wgpu::TextureAspect::DepthOnly,
        _ => wgpu::TextureAspect::All,
    }
}

fn problem(error: Error) -> String {
    match error {
        Error::ReadBack { problem, .. } => problem,
        other => other.to_string(),
    }
}

impl PendingSnapshot {
    /// Records the copy of a part of a texture after a pass that wrote it.
    pub(super) fn new(
        recording: &Recording<'_>,
        (pass, access, desc): (PassId, &AccessDecl, &TextureDesc),
        part: TexturePart,
        encoder: &mut wgpu::CommandEncoder,
    ) -> Self {
        let plan = recording.plan;
        let name = plan.decl.resource_name(access.resource);
        let copied = recording
            .texture(access.resource)
            .and_then(|texture| ReadBack::texture(recording.device, encoder, name, texture, &part));
        Self {
            resource: access.resource,
            since: since(plan, pass, access),
            version: access.version + 1,
            pass,
            mip: part.mip,
            desc: *desc,
            copied: copied.map(|texels| (part.layers, texels)).map_err(problem),
            tiles: tiles(plan, pass, access),
        }
    }

    /// Returns whether the texels have arrived, or never will.
    pub(super) fn is_ready(&self) -> bool {
        self.copied.as_ref().map_or(true, |(_, texels)| texels.is_ready())
    }

    /// Waits for the texels and decodes them.
    pub(super) fn decode(
        self,
        device: &wgpu::Device,
        snapshots: &mut Vec<TextureSnapshot>,
    ) -> Result<(), Error> {
        let size = self.desc.size.mip_level_size(self.mip, self.desc.dimension);
        let full_px = [size.width, size.height];
        let snapshot = |part: Subresource, texels| TextureSnapshot {
            resource: self.resource,
            version: self.version,
            since: self.since,
            pass: Some(self.pass),
            subresource: part,
            full_px,
            texels,
            tiles: self.tiles.clone(),
        };
        let part = if self.desc.mip_levels > 1 { Subresource::FULL.mip(self.mip) } else { Subresource::FULL };
        let (layers, texels) = match self.copied {
            Ok((layers, texels)) => (layers, texels.wait(device)?),
            Err(problem) => {
                snapshots.push(snapshot(part, Err(problem)));
                return Ok(());
            }
        };
        let layered = self.desc.size.depth_or_array_layers > 1;
        let layer_bytes = texels.len() / layers.len().max(1);
        for (layer, bytes) in layers.zip(texels.chunks_exact(layer_bytes.max(1))) {
            let part = if layered { part.layer(layer) } else { part };
            snapshots.push(snapshot(part, texels::decode(self.desc.format, full_px, bytes)));
        }
        Ok(())
    }
}
