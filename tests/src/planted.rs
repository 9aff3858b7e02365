//! Random frames with one planted defect, to find out whether the tools for debugging name the pass that has it.

use shadowgraph::core::{Bind, Contents, Format, Frame, Rect, Texture, TextureDesc, TextureToken, wgpu};

use crate::random::Random;

/// What is wrong with a pass.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Defect {
    /// It writes NaN to a texel.
    Nan,
    /// It clears to another value.
    Clear,
    /// It copies from a texture of the frame before, which it has kept, in place of the declared one.
    StaleRead,
    /// Two of its bindings are swapped.
    SwappedBindings,
    /// Its rectangle is off by one.
    Rectangle,
}

impl Defect {
    /// All of them.
    pub const ALL: [Self; 5] =
        [Self::Nan, Self::Clear, Self::StaleRead, Self::SwappedBindings, Self::Rectangle];
}

/// How a pass fills its target.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    /// A clear, and a draw into a rectangle.
    Clear,
    /// A draw over all, from the inputs.
    Draw,
    /// A draw into a declared rectangle, over earlier contents.
    Tile,
    /// A copy through the raw encoder.
    Copy,
}

/// A pass of a random frame.
#[derive(Clone, Debug)]
struct Step {
    kind: Kind,
    /// The texture that it writes, and those that it reads.
    target: usize,
    inputs: [usize; 2],
    /// The value of all channels after the clear.
    color: f64,
    rect: Rect,
    /// A number for each input, and one that is added.
    weights: [f32; 3],
}

/// A random frame: textures, and passes that draw into them.
#[derive(Clone, Debug)]
pub struct RandomFrame {
    formats: Vec<Format>,
    steps: Vec<Step>,
}

/// A place for a defect: the pass, and what is wrong with it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Planted {
    /// The index of the pass, whose name is `pass INDEX`.
    pub pass: usize,
    /// What is wrong.
    pub defect: Defect,
    /// The texel of [`Defect::Nan`].
    pub texel: [u32; 2],
}

/// The size of all textures, texels.
pub const SIZE: [u32; 2] = [40, 24];

const FORMATS: [Format; 3] = [Format::Rgba16Float, Format::Rgba32Float, Format::R32Float];

impl RandomFrame {
    /// Creates a frame of 6 to 24 passes.
    #[must_use]
    pub fn new(random: &mut Random) -> Self {
        let count = 6 + below(random, 19);
        let (mut formats, mut steps): (Vec<Format>, Vec<Step>) = (Vec::new(), Vec::new());
        for _ in 0..count {
            let texture_count = formats.len();
            let kind = match below(random, 8) {
                _ if texture_count < 2 => Kind::Clear,
                0 => Kind::Clear,
                1 | 2 => Kind::Tile,
                3 | 4 => Kind::Copy,
                _ => Kind::Draw,
            };
            // Later textures are read more often, so that most passes matter.
            let near_end = |random: &mut Random| texture_count - 1 - below(random, texture_count.min(3));
            let inputs = match kind {
                Kind::Clear => [0, 0],
                _ => {
                    let first = near_end(random);
                    let second = (first + 1 + below(random, texture_count - 1)) % texture_count;
                    [first, second]
                }
            };
            let target = match kind {
                // It draws over its first input.
                Kind::Tile => inputs[0],
                _ => {
                    formats.push(if kind == Kind::Copy {
                        formats[inputs[0]]
                    } else {
                        FORMATS[below(random, 3)]
                    });
                    texture_count
                }
            };
            let mut side = |least: u32, end: usize| least + below(random, end) as u32;
            let (x, y) = (side(1, 16), side(1, 8));
            let rect = Rect::new(x, y, side(4, 16), side(4, 8));
            let mut number = || 0.1 + 0.4 * random.unit() as f32;
            let weights = [number(), -number(), number()];
            let color = 0.2 + 0.5 * random.unit();
            steps.push(Step { kind, target, inputs, color, rect, weights });
        }
        Self { formats, steps }
    }

    /// Chooses a pass that can have a defect; `None` if none can.
    #[must_use]
    pub fn plant(&self, defect: Defect, random: &mut Random) -> Option<Planted> {
        let can_have = |step: &Step| match defect {
            Defect::Nan => step.kind != Kind::Copy,
            Defect::Clear => step.kind == Kind::Clear,
            Defect::StaleRead => step.kind == Kind::Copy,
            Defect::SwappedBindings => step.kind == Kind::Draw,
            Defect::Rectangle => step.kind == Kind::Tile,
        };
        let places: Vec<usize> = (0..self.steps.len()).filter(|&pass| can_have(&self.steps[pass])).collect();
        let pass = *places.get(below(random, places.len()))?;
        let Rect { x, y, width, height } = match self.steps[pass].kind {
            Kind::Draw | Kind::Copy => Rect::new(0, 0, SIZE[0], SIZE[1]),
            Kind::Clear | Kind::Tile => self.steps[pass].rect,
        };
        let texel = [x + below(random, width as usize) as u32, y + below(random, height as usize) as u32];
        Some(Planted { pass, defect, texel })
    }

    /// Declares the frame, whose output is `output`.
    pub fn declare<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        shaders: &'f Shaders,
        planted: Option<Planted>,
    ) -> Texture {
        let [width, height] = SIZE;
        let mut textures: Vec<Texture> = self
            .formats
            .iter()
            .enumerate()
            .map(|(index, &format)| {
                frame.create_texture(format_args!("texture {index}"), TextureDesc::d2(width, height, format))
            })
            .collect();
        for (index, step) in self.steps.iter().enumerate() {
            let defect = planted.filter(|planted| planted.pass == index);
            step.declare(frame, &mut textures, (index, shaders), defect);
        }
        // All that has been written adds to the output.
        let mut output = frame.create_texture("output", TextureDesc::d2(width, height, Format::Rgba16Float));
        let mut uniforms = Vec::new();
        for _ in &textures {
            uniforms.push(frame.uniform(&block([1.0, 0.0, 0.0], None)));
        }
        let mut pass = frame.render_pass("output");
        let inputs: Vec<TextureToken> = textures.iter().map(|texture| pass.sample(texture)).collect();
        pass.color(&mut output, Contents::clear_color([0.0; 4]));
        pass.body(move |ctx| {
            ctx.pass.set_pipeline(&shaders.add);
            for (&input, uniform) in inputs.iter().zip(uniforms) {
                let bindings = [Bind::Uniform(uniform), Bind::Texture(input), Bind::Texture(input)];
                let group = ctx.bind_group(&shaders.layout, &bindings)?;
                ctx.pass.set_bind_group(0, &group, &[]);
                ctx.pass.draw(0..3, 0..1);
            }
            Ok(())
        });
        output
    }
}

impl Step {
    fn declare<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        textures: &mut [Texture],
        (index, shaders): (usize, &'f Shaders),
        planted: Option<Planted>,
    ) {
        let defect = planted.map(|planted| planted.defect);
        let nan = planted.filter(|planted| planted.defect == Defect::Nan).map(|planted| planted.texel);
        let uniform = frame.uniform(&block(self.weights, nan));
        let [first, second] = self.inputs.map(|input| textures[input].clone());
        let format = frame.texture_desc(&textures[self.target]).map(|desc| desc.format);
        let pipeline = shaders.pipeline(format.unwrap_or(FORMATS[0]));
        let target = &mut textures[self.target];
        if self.kind == Kind::Copy {
            return Self::copy(frame, index, (&first, target), shaders, defect == Some(Defect::StaleRead));
        }
        let black = frame.import_texture("black", &shaders.black, true);
        let mut pass = frame.render_pass(format_args!("pass {index}"));
        let inputs = match self.kind {
            Kind::Draw => [pass.sample(&first), pass.sample(&second)],
            // It cannot read what it draws into.
            Kind::Tile => [pass.sample(&second), pass.sample(&black)],
            _ => [pass.sample(&black); 2],
        };
        let mut scissor = Rect::new(0, 0, SIZE[0], SIZE[1]);
        match self.kind {
            Kind::Clear => {
                let color = if defect == Some(Defect::Clear) { self.color + 0.125 } else { self.color };
                pass.color(target, Contents::clear_color([color; 4]));
                scissor = self.rect;
            }
            Kind::Tile => {
                pass.color(target, Contents::Preserve);
                scissor = self.rect;
                if defect == Some(Defect::Rectangle) {
                    scissor.x -= 1;
                }
            }
            _ => {
                pass.color(target, Contents::Overwrite);
            }
        }
        let swapped = defect == Some(Defect::SwappedBindings);
        pass.body(move |ctx| {
            let [first, second] = if swapped { [inputs[1], inputs[0]] } else { inputs };
            let bindings = [Bind::Uniform(uniform), Bind::Texture(first), Bind::Texture(second)];
            let group = ctx.bind_group(&shaders.layout, &bindings)?;
            let Rect { x, y, width, height } = scissor;
            ctx.pass.set_scissor_rect(x, y, width, height);
            ctx.pass.set_pipeline(pipeline);
            ctx.pass.set_bind_group(0, &group, &[]);
            ctx.pass.draw(0..3, 0..1);
            Ok(())
        });
    }

    /// Declares a copy of a texture through the encoder. A stale one copies another texture, which the graph knows nothing of.
    fn copy<'f>(
        frame: &mut Frame<'f>,
        index: usize,
        (source, target): (&Texture, &mut Texture),
        shaders: &'f Shaders,
        is_stale: bool,
    ) {
        let format = frame.texture_desc(source).map(|desc| desc.format);
        let stale = shaders.stale(format.unwrap_or(FORMATS[0]));
        let mut pass = frame.encoder_pass(format_args!("pass {index}"));
        let source = pass.copy_source(source);
        let target = pass.copy_target(target, Contents::Overwrite);
        pass.body(move |ctx| {
            let source = if is_stale { stale } else { ctx.texture(source)? };
            let target = ctx.texture(target)?;
            let [width, height] = SIZE;
            let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
            ctx.encoder.copy_texture_to_texture(source.as_image_copy(), target.as_image_copy(), size);
            Ok(())
        });
    }
}

/// Returns a number from 0 to below `end`, or 0.
fn below(random: &mut Random, end: usize) -> usize {
    random.below(end.max(1) as u64) as usize
}

/// Returns the bytes of `Step` of the shader.
fn block(weights: [f32; 3], nan: Option<[u32; 2]>) -> Vec<u8> {
    let [x, y] = nan.unwrap_or([u32::MAX; 2]);
    let words = [weights[0].to_bits(), weights[1].to_bits(), weights[2].to_bits(), 0, x, y, 0, 0];
    words.iter().flat_map(|word| word.to_le_bytes()).collect()
}

const SOURCE: &str = "
struct Step { weights: vec4f, nan: vec4u }
@group(0) @binding(0) var<uniform> step: Step;
@group(0) @binding(1) var first: texture_2d<f32>;
@group(0) @binding(2) var second: texture_2d<f32>;

@vertex
fn corner(@builtin(vertex_index) vertex: u32) -> @builtin(position) vec4f {
    return vec4f(vec2f(vec2u(vertex & 2u, (vertex << 1u) & 2u)) * 2.0 - 1.0, 0.0, 1.0);
}

@fragment
fn mixed(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let at = vec2i(position.xy);
    if all(vec2u(at) == step.nan.xy) {
        return vec4f(bitcast<f32>(0x7fc00000u | step.nan.z));
    }
    let from_first = textureLoad(first, min(at, vec2i(textureDimensions(first)) - 1), 0).x;
    let from_second = textureLoad(second, min(at, vec2i(textureDimensions(second)) - 1), 0).x;
    let place = 0.01 * f32(at.x) + 0.02 * f32(at.y);
    return vec4f(step.weights.x * from_first + step.weights.y * from_second + step.weights.z * place);
}

@fragment
fn added(@builtin(position) position: vec4f) -> @location(0) vec4f {
    return textureLoad(first, vec2i(position.xy), 0);
}
";

/// What random frames are drawn with.
pub struct Shaders {
    layout: wgpu::BindGroupLayout,
    pipelines: Vec<wgpu::RenderPipeline>,
    /// Adds to the output.
    add: wgpu::RenderPipeline,
    black: wgpu::Texture,
    /// Textures of other contents, one for each format.
    stale: Vec<wgpu::Texture>,
}

impl Shaders {
    /// Creates the pipelines.
    #[must_use]
    pub fn new(device: &wgpu::Device) -> Self {
        let entry = |binding, ty| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT,
            ty,
            count: None,
        };
        let image = wgpu::BindingType::Texture {
            sample_type: wgpu::TextureSampleType::Float { filterable: false },
            view_dimension: wgpu::TextureViewDimension::D2,
            multisampled: false,
        };
        let uniform = wgpu::BindingType::Buffer {
            ty: wgpu::BufferBindingType::Uniform,
            has_dynamic_offset: false,
            min_binding_size: None,
        };
        let layout = device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: None,
            entries: &[entry(0, uniform), entry(1, image), entry(2, image)],
        });
        let pipeline_layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: None,
            bind_group_layouts: &[Some(&layout)],
            immediate_size: 0,
        });
        let module = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: Some("random frame"),
            source: wgpu::ShaderSource::Wgsl(SOURCE.into()),
        });
        let pipeline = |entry_point, format, blend| {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: None,
                layout: Some(&pipeline_layout),
                vertex: wgpu::VertexState {
                    module: &module,
                    entry_point: Some("corner"),
                    compilation_options: Default::default(),
                    buffers: &[],
                },
                primitive: Default::default(),
                depth_stencil: None,
                multisample: Default::default(),
                fragment: Some(wgpu::FragmentState {
                    module: &module,
                    entry_point: Some(entry_point),
                    compilation_options: Default::default(),
                    targets: &[Some(wgpu::ColorTargetState {
                        format,
                        blend,
                        write_mask: wgpu::ColorWrites::ALL,
                    })],
                }),
                multiview_mask: None,
                cache: None,
            })
        };
        let texture = |format, usage| {
            let [width, height] = SIZE;
            device.create_texture(&wgpu::TextureDescriptor {
                label: None,
                size: wgpu::Extent3d { width, height, depth_or_array_layers: 1 },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage,
                view_formats: &[],
            })
        };
        let part = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::One,
            dst_factor: wgpu::BlendFactor::One,
            operation: wgpu::BlendOperation::Add,
        };
        let sum = wgpu::BlendState { color: part, alpha: part };
        let bound = wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_SRC;
        Self {
            pipelines: FORMATS.map(|format| pipeline("mixed", format, None)).into(),
            add: pipeline("added", Format::Rgba16Float, Some(sum)),
            black: texture(Format::R32Float, bound),
            stale: FORMATS.map(|format| texture(format, bound)).into(),
            layout,
        }
    }

    fn pipeline(&self, format: Format) -> &wgpu::RenderPipeline {
        &self.pipelines[FORMATS.iter().position(|&known| known == format).unwrap_or(0)]
    }

    fn stale(&self, format: Format) -> &wgpu::Texture {
        &self.stale[FORMATS.iter().position(|&known| known == format).unwrap_or(0)]
    }
}
