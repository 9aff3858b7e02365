//! Clearing a rectangle inside an open render pass. `LoadOp::Clear` ignores the scissor, so it would clear the rest of the
//! attachment too.

use super::{module, scalar, section, uniform, vertex};
use crate::desc::Format;
use crate::device::MAX_COLOR_ATTACHMENTS;
use crate::subresource::Rect;
use std::collections::HashMap;

/// The attachments of the open pass. Depth and stencil may be read-only unless they are cleared.
#[derive(Clone, Debug, PartialEq, Eq, Hash)]
pub(crate) struct Targets {
    /// Formats in the order of the attachments; `None` for an empty index.
    pub(crate) colors: Vec<Option<Format>>,
    pub(crate) depth_stencil: Option<Format>,
    pub(crate) samples: u32,
}

/// Clear values and the rectangle to clear. Attachments with `None`, or beyond the end of `colors`, are unchanged; a value
/// for an attachment or aspect that the pass does not have is ignored.
#[derive(Clone, Copy, Debug)]
pub(crate) struct RegionClear<'v> {
    /// Converted to the attachment's format like `wgpu::Color`, but a value between two representable ones may be rounded
    /// differently than by `LoadOp::Clear`.
    pub(crate) colors: &'v [Option<[f64; 4]>],
    /// Value from 0 to 1.
    pub(crate) depth: Option<f32>,
    pub(crate) stencil: Option<u32>,
    /// The rectangle to clear, inside the attachments.
    pub(crate) rect: Rect,
}

/// The attachments and aspects that a pipeline clears.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct ClearMask {
    colors: [bool; MAX_COLOR_ATTACHMENTS],
    depth: bool,
    stencil: bool,
}

impl ClearMask {
    fn new(
        targets: &Targets,
        clear: &RegionClear<'_>,
        bits: &[Option<[u32; 4]>; MAX_COLOR_ATTACHMENTS],
    ) -> Self {
        let has = |aspect: fn(&Format) -> bool| targets.depth_stencil.as_ref().is_some_and(aspect);
        Self {
            colors: bits.map(|bits| bits.is_some()),
            depth: clear.depth.is_some() && has(Format::has_depth_aspect),
            stencil: clear.stencil.is_some() && has(Format::has_stencil_aspect),
        }
    }

    fn is_empty(&self) -> bool {
        !self.depth && !self.stencil && !self.colors.contains(&true)
    }
}

/// The bits of the clear values as the shader reads them, 0 for unchanged attachments.
type Bits = [[u32; 4]; MAX_COLOR_ATTACHMENTS];

struct Values {
    group: wgpu::BindGroup,
    used: u64,
}

/// Clears rectangles on one device, with a pipeline for each combination of targets and cleared attachments, and a small
/// buffer for each set of colours.
#[derive(Default)]
pub(crate) struct RegionClears {
    frame: u64,
    layout: Option<wgpu::BindGroupLayout>,
    pipelines: HashMap<(Targets, ClearMask), wgpu::RenderPipeline>,
    values: HashMap<Bits, Values>,
}

impl RegionClears {
    /// Starts a frame and drops colours last used before frame `oldest`.
    pub(crate) fn begin_frame(&mut self, frame: u64, oldest: u64) {
        self.frame = frame;
        self.values.retain(|_, values| values.used >= oldest);
    }

    /// Records a clear into an open pass whose attachments are `targets`.
    ///
    /// The pass keeps this draw's pipeline, viewport and scissor: set others before the next draw. Afterwards the stencil
    /// reference is 0 and bind group 0 is unset.
    pub(crate) fn record(
        &mut self,
        device: &wgpu::Device,
        pass: &mut wgpu::RenderPass<'_>,
        targets: &Targets,
        clear: &RegionClear<'_>,
    ) {
        let bits = bits(targets, clear);
        let cleared = ClearMask::new(targets, clear, &bits);
        let Rect { x, y, width, height } = clear.rect;
        if cleared.is_empty() || width == 0 || height == 0 {
            return;
        }
        let layout = self.layout.get_or_insert_with(|| layout(device));
        let pipeline = self.pipelines.entry((targets.clone(), cleared));
        let bits = bits.map(Option::unwrap_or_default);
        let values = self.values.entry(bits);
        let values = values.or_insert_with(|| Values { group: group(device, layout, &bits), used: 0 });
        values.used = self.frame;
        pass.set_pipeline(pipeline.or_insert_with(|| create_pipeline(device, layout, targets, cleared)));
        pass.set_bind_group(0, &values.group, &[]);
        // A depth range of a single value stores exactly that value, without interpolation or rounding.
        let depth = clear.depth.filter(|_| cleared.depth).unwrap_or_default();
        pass.set_viewport(x as f32, y as f32, width as f32, height as f32, depth, depth);
        pass.set_scissor_rect(x, y, width, height);
        pass.set_stencil_reference(clear.stencil.unwrap_or_default());
        pass.draw(0..3, 0..1);
        pass.set_stencil_reference(0);
        pass.set_bind_group(0, None, &[]);
    }

    #[cfg(test)]
    pub(super) fn len(&self) -> (usize, usize) {
        (self.pipelines.len(), self.values.len())
    }
}

/// Returns the clear value of each attachment in the number format of its shader output.
fn bits(targets: &Targets, clear: &RegionClear<'_>) -> [Option<[u32; 4]>; MAX_COLOR_ATTACHMENTS] {
    let mut all = [None; MAX_COLOR_ATTACHMENTS];
    for ((bits, format), color) in all.iter_mut().zip(&targets.colors).zip(clear.colors) {
        let (Some(format), Some(color)) = (format, color) else { continue };
        *bits = Some(color.map(|value| match format.sample_type(None, None) {
            Some(wgpu::TextureSampleType::Uint) => value as u32,
            Some(wgpu::TextureSampleType::Sint) => (value as i32).cast_unsigned(),
            _ => (value as f32).to_bits(),
        }));
    }
    all
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
        label: Some("region clear"),
        entries: &[wgpu::BindGroupLayoutEntry {
            binding: 0,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty: wgpu::BindingType::Buffer {
                ty: wgpu::BufferBindingType::Uniform,
                has_dynamic_offset: false,
                min_binding_size: None,
            },
            count: None,
        }],
    })
}

fn group(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, bits: &Bits) -> wgpu::BindGroup {
    let buffer = uniform(device, "region clear", bits.as_flattened());
    device.create_bind_group(&wgpu::BindGroupDescriptor {
        label: Some("region clear"),
        layout,
        entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
    })
}

fn create_pipeline(
    device: &wgpu::Device,
    layout: &wgpu::BindGroupLayout,
    targets: &Targets,
    cleared: ClearMask,
) -> wgpu::RenderPipeline {
    let module = module(device, "region clear", &fragment_source(targets, cleared));
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: Some("region clear"),
        bind_group_layouts: &[Some(layout)],
        immediate_size: 0,
    });
    let color_states = color_states(targets, cleared);
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("region clear"),
        layout: Some(&layout),
        vertex: vertex(&module),
        primitive: Default::default(),
        depth_stencil: targets.depth_stencil.map(|format| depth_stencil_state(format, cleared)),
        multisample: wgpu::MultisampleState { count: targets.samples, ..Default::default() },
        fragment: (!color_states.is_empty()).then_some(wgpu::FragmentState {
            module: &module,
            entry_point: None,
            compilation_options: Default::default(),
            targets: &color_states,
        }),
        multiview_mask: None,
        cache: None,
    })
}

/// Returns a fragment stage with outputs for the cleared attachments only, each with the scalar type of its format.
fn fragment_source(targets: &Targets, cleared: ClearMask) -> String {
    if !cleared.colors.contains(&true) {
        return section("no-color").to_owned();
    }
    let mut source = String::new();
    for line in section("clear").lines() {
        if !line.ends_with("// each") {
            source.extend([line, "\n"]);
            continue;
        }
        for (index, format) in targets.colors.iter().enumerate() {
            let sample_type = format.and_then(|format| format.sample_type(None, None));
            let (Some(sample_type), Some(true)) = (sample_type, cleared.colors.get(index)) else { continue };
            let line = line.replace("INDEX", &index.to_string()).replace("SCALAR", scalar(sample_type));
            source.extend([&line, "\n"]);
        }
    }
    source
}

fn color_states(targets: &Targets, cleared: ClearMask) -> Vec<Option<wgpu::ColorTargetState>> {
    let state = |(index, format): (usize, &Option<Format>)| {
        let write_mask = match cleared.colors.get(index) {
            Some(true) => wgpu::ColorWrites::ALL,
            _ => wgpu::ColorWrites::empty(),
        };
        format.map(|format| wgpu::ColorTargetState { format, blend: None, write_mask })
    };
    targets.colors.iter().enumerate().map(state).collect()
}

fn depth_stencil_state(format: Format, cleared: ClearMask) -> wgpu::DepthStencilState {
    let face = wgpu::StencilFaceState {
        pass_op: if cleared.stencil { wgpu::StencilOperation::Replace } else { wgpu::StencilOperation::Keep },
        ..wgpu::StencilFaceState::IGNORE
    };
    wgpu::DepthStencilState {
        format,
        depth_write_enabled: format.has_depth_aspect().then_some(cleared.depth),
        depth_compare: format.has_depth_aspect().then_some(wgpu::CompareFunction::Always),
        stencil: wgpu::StencilState { front: face, back: face, read_mask: !0, write_mask: !0 },
        bias: Default::default(),
    }
}
