//! A world of boxes that an engine draws itself.

use glam::DVec3;
use shadowgraph::scene::{Aabb, CullVolume};
use shadowgraph::shadows::{CasterView, DepthFormat, Mobility, ShadowCasters, caster_view_layout};
use shadowgraph::wgpu;
use std::sync::atomic::{AtomicU64, Ordering};

/// Boxes; every other one has holes of noise that is fixed to the texels of the world.
const SHADER: &str = "
struct View {
    clip_from_world: mat4x4f,
    @size(168) of_shadows: vec4f,
    noise_px: vec2u,
}
struct Box { lowest: vec4f, highest: vec4f }
@group(0) @binding(0) var<storage, read> view: View;
@group(1) @binding(0) var<storage, read> boxes: array<Box>;
struct Corner {
    @builtin(position) position: vec4f,
    @location(0) @interpolate(flat) holes: u32,
}
@vertex
fn vs_box(@builtin(vertex_index) vertex: u32, @builtin(instance_index) instance: u32) -> Corner {
    let face = vertex / 6u;
    let quad = array(vec2f(0, 0), vec2f(1, 0), vec2f(1, 1), vec2f(0, 0), vec2f(1, 1), vec2f(0, 1))[vertex % 6u];
    var corner = vec3f(quad, f32(face % 2u));
    if face / 2u == 1u { corner = corner.zxy; }
    if face / 2u == 2u { corner = corner.yzx; }
    let b = boxes[instance];
    let position = mix(b.lowest.xyz, b.highest.xyz, corner);
    return Corner(view.clip_from_world * vec4f(position, 1.0), instance % 2u);
}
@fragment
fn fs_box(in: Corner) {
    let texel = (vec2u(in.position.xy) + view.noise_px) & vec2u(1023u);
    if in.holes == 1u && ((texel.x * 7u + texel.y * 13u) % 5u) < 2u {
        discard;
    }
}";

/// A box, and what is known about it.
#[derive(Clone, Debug)]
pub(crate) struct Block {
    pub(crate) bounds: Aabb,
    pub(crate) version: Option<u64>,
    pub(crate) mobility: Mobility,
    pub(crate) is_there: bool,
}

/// The boxes on the GPU.
pub(crate) struct Boxes {
    pub(crate) blocks: Vec<Block>,
    pub(crate) drawn: AtomicU64,
    pub(crate) receivers: Aabb,
    next_version: u64,
    pipelines: Vec<(wgpu::TextureFormat, wgpu::RenderPipeline)>,
    buffer: wgpu::Buffer,
    group: wgpu::BindGroup,
}

impl Boxes {
    pub(crate) fn new(device: &wgpu::Device, capacity: usize) -> Self {
        let source = wgpu::ShaderSource::Wgsl(SHADER.into());
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor { label: None, source });
        let boxes_layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::VERTEX,
                ty: wgpu::BindingType::Buffer {
                    ty: wgpu::BufferBindingType::Storage { read_only: true },
                    has_dynamic_offset: false,
                    min_binding_size: None,
                },
                count: None,
            }],
        });
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&caster_view_layout(device)), Some(&boxes_layout)],
            immediate_size: 0,
        });
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 32 * capacity as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        let group = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &boxes_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        let pipeline = |depth: DepthFormat| {
            let format = depth.texture_format();
            (format, pipeline(device, &module, &layout, format))
        };
        let pipelines = DepthFormat::ALL.into_iter().map(pipeline).collect();
        let receivers = Aabb { min: DVec3::splat(-500.0), max: DVec3::splat(500.0) };
        Self {
            blocks: Vec::new(),
            drawn: AtomicU64::new(0),
            receivers,
            next_version: 0,
            pipelines,
            buffer,
            group,
        }
    }

    /// Returns a version that was never used.
    pub(crate) fn version(&mut self) -> u64 {
        self.next_version += 1;
        self.next_version
    }

    pub(crate) fn add(&mut self, bounds: Aabb, mobility: Mobility) -> usize {
        let version = Some(self.version());
        self.blocks.push(Block { bounds, version, mobility, is_there: true });
        self.blocks.len() - 1
    }

    /// Moves a box.
    pub(crate) fn shift(&mut self, index: usize, by: DVec3) {
        let version = self.version();
        let block = &mut self.blocks[index];
        block.bounds = Aabb { min: block.bounds.min + by, max: block.bounds.max + by };
        block.version = block.version.map(|_| version);
    }

    /// Copies the boxes to the GPU.
    pub(crate) fn upload(&self, queue: &wgpu::Queue, origin_world: DVec3) {
        let corner = |corner: DVec3| (corner - origin_world).as_vec3().extend(0.0).to_array();
        let boxes = self.blocks.iter().flat_map(|block| [corner(block.bounds.min), corner(block.bounds.max)]);
        let bytes: Vec<u8> = boxes.flatten().flat_map(f32::to_le_bytes).collect();
        queue.write_buffer(&self.buffer, 0, &bytes);
    }

    /// Returns the number of boxes drawn since the last call.
    pub(crate) fn take_drawn(&self) -> u64 {
        self.drawn.swap(0, Ordering::Relaxed)
    }
}

fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    layout: &wgpu::PipelineLayout,
    format: wgpu::TextureFormat,
) -> wgpu::RenderPipeline {
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some("boxes"),
        layout: Some(layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("vs_box"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: Default::default(),
            bias: Default::default(),
        }),
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some("fs_box"),
            compilation_options: Default::default(),
            targets: &[],
        }),
        multiview_mask: None,
        cache: None,
    })
}

impl ShadowCasters for Boxes {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        let is_in = |block: &Block| block.is_there && volume.intersects(&block.bounds);
        casters.extend((0..).zip(&self.blocks).filter(|(_, block)| is_in(block)).map(|(index, _)| index));
    }

    fn bounds(&self) -> Aabb {
        let there = self.blocks.iter().filter(|block| block.is_there);
        there.fold(Aabb::EMPTY, |all, block| all.union(&block.bounds))
    }

    /// Returns bounds that do not follow the boxes: the cascades stay as they are.
    fn receivers(&self) -> Aabb {
        self.receivers
    }

    fn caster_bounds(&self, caster: u32) -> Aabb {
        self.blocks[caster as usize].bounds
    }

    fn version(&self, caster: u32) -> Option<u64> {
        self.blocks[caster as usize].version
    }

    fn mobility(&self, caster: u32) -> Mobility {
        self.blocks[caster as usize].mobility
    }

    fn caster_name(&self, caster: u32) -> Option<&str> {
        (caster == 0).then_some("Fox")
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32 {
        let pipeline = self.pipelines.iter().find(|(format, _)| *format == view.target.format);
        let Some((_, pipeline)) = pipeline else { return 0 };
        pass.set_pipeline(pipeline);
        pass.set_bind_group(1, &self.group, &[]);
        for &caster in casters {
            pass.draw(0..36, caster..caster + 1);
        }
        self.drawn.fetch_add(casters.len() as u64, Ordering::Relaxed);
        casters.len() as u32
    }
}
