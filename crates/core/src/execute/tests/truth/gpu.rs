//! The pipelines that all graphs use.

use super::graph::{Graph, Inputs, Role};
use super::interpret::{State, Word};
use crate::{Bind, BufferToken, Error, Format, Rect, Resources, TextureToken, Uniform};
use std::sync::{Arc, Mutex};

const FORMAT: Format = Format::R32Uint;

pub(super) struct Gpu {
    pub(super) device: wgpu::Device,
    pub(super) queue: wgpu::Queue,
    pub(super) one_target: Draw,
    pub(super) two_targets: Draw,
    pub(super) target_and_words: Draw,
    pub(super) words: Compute,
    pub(super) texels: Compute,
    no_texture: wgpu::TextureView,
    no_buffer: wgpu::Buffer,
    /// Validation errors on the graph's threads, which error scopes of this thread do not catch.
    pub(super) objections: Arc<Mutex<Vec<String>>>,
}

pub(super) struct Draw {
    pipeline: wgpu::RenderPipeline,
    pub(super) layout: wgpu::BindGroupLayout,
}

impl Draw {
    /// Draws over the scissor that the graph has set, or over less.
    pub(super) fn record(
        &self,
        pass: &mut wgpu::RenderPass<'_>,
        group: &wgpu::BindGroup,
        scissor: Option<Rect>,
    ) {
        if let Some(Rect { x, y, width, height }) = scissor {
            pass.set_scissor_rect(x, y, width, height);
        }
        pass.set_pipeline(&self.pipeline);
        pass.set_bind_group(0, group, &[]);
        pass.draw(0..3, 0..1);
    }
}

pub(super) struct Compute {
    pub(super) pipeline: wgpu::ComputePipeline,
    pub(super) layout: wgpu::BindGroupLayout,
}

/// The tokens of what a pass reads.
#[derive(Clone)]
pub(super) struct Tokens {
    pub(super) params: Uniform,
    pub(super) textures: Vec<TextureToken>,
    pub(super) buffers: Vec<BufferToken>,
}

impl Gpu {
    pub(super) fn new((device, queue): (wgpu::Device, wgpu::Queue)) -> Self {
        let module = device.create_shader_module(wgpu::include_wgsl!("../../../../tests/truth.wgsl"));
        let objections = Arc::new(Mutex::new(Vec::new()));
        let noted = objections.clone();
        device.on_uncaptured_error(Arc::new(move |error| noted.lock().unwrap().push(error.to_string())));
        let no_texture = device.create_texture(&description((1, 1), 1, 1)).create_view(&Default::default());
        let no_buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: None,
            size: 256,
            usage: wgpu::BufferUsages::STORAGE,
            mapped_at_creation: false,
        });
        Self {
            one_target: draw(&device, &module, "one_target", 1),
            two_targets: draw(&device, &module, "two_targets", 2),
            target_and_words: draw(&device, &module, "target_and_words", 1),
            words: compute(&device, &module, "words"),
            texels: compute(&device, &module, "texels"),
            no_texture,
            no_buffer,
            objections,
            device,
            queue,
        }
    }

    /// A bind group of the inputs, and what is written at the end.
    pub(super) fn group(
        &self,
        resources: &Resources<'_>,
        layout: &wgpu::BindGroupLayout,
        tokens: &Tokens,
        written: Option<Bind<'_>>,
    ) -> Result<wgpu::BindGroup, Error> {
        let texture = |index| match tokens.textures.get(index) {
            Some(&token) => Bind::Texture(token),
            None => Bind::ExternalView(&self.no_texture),
        };
        let buffer = |index| match tokens.buffers.get(index) {
            Some(&token) => Bind::Buffer(token),
            None => Bind::ExternalBuffer(&self.no_buffer),
        };
        let mut entries = vec![Bind::Uniform(tokens.params), texture(0), texture(1), buffer(0), buffer(1)];
        entries.extend(written);
        resources.bind_group(layout, &entries)
    }

    /// The caller's textures and buffers, filled.
    pub(super) fn imports(&self, graph: &Graph) -> Imports {
        let state = State::new(graph);
        let textures = graph.textures.iter().enumerate().map(|(index, own)| {
            matches!(own.role, Role::Imported(_)).then(|| {
                let texture = self.device.create_texture(&description(own.size, own.mips, own.layers));
                for plane in graph.planes(index) {
                    self.write_plane(&texture, (plane.mip, plane.layer), state.plane(plane));
                }
                texture
            })
        });
        let textures = textures.collect();
        let buffers = graph.buffers.iter().enumerate().map(|(index, own)| {
            matches!(own.role, Role::Imported(_)).then(|| {
                use wgpu::BufferUsages as Usage;
                let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
                    label: None,
                    size: u64::from(own.words) * 4,
                    usage: Usage::STORAGE | Usage::COPY_SRC | Usage::COPY_DST,
                    mapped_at_creation: false,
                });
                self.queue.write_buffer(&buffer, 0, &bytes(state.buffer(index)));
                buffer
            })
        });
        Imports { textures, buffers: buffers.collect() }
    }

    fn write_plane(&self, texture: &wgpu::Texture, (mip_level, layer): (u32, u32), words: &[Word]) {
        let size = texture.size().mip_level_size(mip_level, texture.dimension());
        let size = wgpu::Extent3d { depth_or_array_layers: 1, ..size };
        let origin = wgpu::Origin3d { x: 0, y: 0, z: layer };
        let target = wgpu::TexelCopyTextureInfo { mip_level, origin, ..texture.as_image_copy() };
        let layout = wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(size.width * 4),
            rows_per_image: None,
        };
        self.queue.write_texture(target, &bytes(words), layout, size);
    }
}

/// Imports by index in the graph.
pub(super) struct Imports {
    pub(super) textures: Vec<Option<wgpu::Texture>>,
    pub(super) buffers: Vec<Option<wgpu::Buffer>>,
}

fn bytes(words: &[Word]) -> Vec<u8> {
    let value = |word: &Word| if let Word::Is(value) = word { *value } else { 0 };
    words.iter().flat_map(|word| value(word).to_le_bytes()).collect()
}

/// Parameters of a pass for its shader; `truth.wgsl` has the same fields.
#[derive(Default)]
pub(super) struct Params {
    pub(super) preserve: bool,
    pub(super) origin: (u32, u32),
    pub(super) size: (u32, u32),
    pub(super) stride: u32,
}

impl Params {
    pub(super) fn bytes(&self, inputs: &Inputs, salt: u32) -> Vec<u8> {
        let shift = |shift: Option<u32>| shift.unwrap_or_default();
        let plane = |index| shift(inputs.planes.get(index).map(|&(_, shift)| shift));
        let span = |index| shift(inputs.spans.get(index).map(|&(_, shift)| shift));
        let (textures, buffers) = (inputs.planes.len() as u32, inputs.spans.len() as u32);
        let words = [
            [inputs.constant ^ salt, textures, buffers, self.preserve.into()],
            [plane(0), plane(1), 0, 0],
            [span(0), span(1), 0, 0],
            [self.origin.0, self.origin.1, self.size.0, self.size.1],
            [self.stride, 0, 0, 0],
        ];
        words.as_flattened().iter().flat_map(|word| word.to_le_bytes()).collect()
    }
}

fn description((width, height): (u32, u32), mips: u32, layers: u32) -> wgpu::TextureDescriptor<'static> {
    use wgpu::TextureUsages as Usage;
    wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width, height, depth_or_array_layers: layers },
        mip_level_count: mips,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: Usage::RENDER_ATTACHMENT
            | Usage::TEXTURE_BINDING
            | Usage::STORAGE_BINDING
            | Usage::COPY_SRC
            | Usage::COPY_DST,
        view_formats: &[],
    }
}

fn draw(device: &wgpu::Device, module: &wgpu::ShaderModule, entry: &str, targets: usize) -> Draw {
    let pipeline = device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(entry),
        layout: None,
        vertex: wgpu::VertexState {
            module,
            entry_point: Some("everywhere"),
            compilation_options: Default::default(),
            buffers: &[],
        },
        primitive: Default::default(),
        depth_stencil: None,
        multisample: Default::default(),
        fragment: Some(wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: Default::default(),
            targets: &vec![Some(FORMAT.into()); targets],
        }),
        multiview_mask: None,
        cache: None,
    });
    Draw { layout: pipeline.get_bind_group_layout(0), pipeline }
}

fn compute(device: &wgpu::Device, module: &wgpu::ShaderModule, entry: &str) -> Compute {
    let pipeline = device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
        label: Some(entry),
        layout: None,
        module,
        entry_point: Some(entry),
        compilation_options: Default::default(),
        cache: None,
    });
    Compute { layout: pipeline.get_bind_group_layout(0), pipeline }
}
