//! Shadows in an engine of one's own: its scene is a list of boxes, its lit shader is its own, and the graph and the shadow
//! technique are Shadowgraph's. Another technique of maps is another value in one line; those that read the surfaces of the
//! picture want a [`Screen`](shadowgraph::shadows::Screen) too.
//!
//! `cargo run -p shadowgraph-examples --example custom_engine` writes out/custom_engine.png.

use std::borrow::Cow;

use glam::{DVec3, Mat4, Vec3, Vec4};
use shadowgraph::Gpu;
use shadowgraph::core::{Bind, Contents, Format, Graph, Part, TextureDesc, wgpu};
use shadowgraph::options::AdapterChoice;
use shadowgraph::output::{Pixels, write_png};
use shadowgraph::scene::{Aabb, Camera, CullVolume, Light, LightKind, Projection};
use shadowgraph::shaders::{ModuleSource, compose_source};
use shadowgraph::shadows::{
    CasterPass, CasterTarget, CasterView, PCF, ShadowCasters, ShadowInputs, ShadowSettings, ShadowTechnique,
    Technique, TechniqueContext, add_shadows, caster_view_layout, shadow_layout,
};

const SIZE_PX: [u32; 2] = [640, 360];
const WGSL: &str = include_str!("custom_engine.wgsl");

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let gpu = Gpu::open(&AdapterChoice::Auto)?;
    let device = &gpu.device;

    // The line that chooses the technique.
    let technique = Technique::from(PCF).make(&TechniqueContext::new(device))?;
    let engine = Engine::new(device, &gpu.queue, technique.as_ref(), tower())?;

    let projection = Projection::Perspective { fov_y: 0.7, near: 0.1, far: Some(100.0) };
    let camera = Camera::look_at(DVec3::new(7.0, 5.0, 9.0), DVec3::new(0.0, 1.2, 0.0), DVec3::Y, projection);
    let direction = DVec3::new(-0.6, -1.0, -0.25).normalize();
    let lights = [Light {
        name: None,
        kind: LightKind::Directional { direction },
        color: Vec3::ONE,
        intensity: 100_000.0,
        casts_shadow: true,
    }];
    let aspect = f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]);
    let settings = ShadowSettings { distance_m: 40.0, ..ShadowSettings::default() };

    let mut graph = Graph::new();
    let mut frame = graph.frame();
    let inputs = ShadowInputs {
        view: 0,
        camera: &camera,
        aspect,
        lights: &lights,
        casters: &engine,
        origin_world: DVec3::ZERO,
        settings: &settings,
    };
    let shadows = add_shadows(technique.as_ref(), &mut frame, &inputs, None)?;

    let clip_from_world = (camera.clip_from_view(aspect) * camera.view_from_world()).as_mat4();
    let view = View {
        clip_from_world,
        eye: camera.position_world().as_vec3().extend(1.0),
        to_light: -direction.as_vec3().extend(0.0),
    };
    let view = frame.uniform(bytemuck::bytes_of(&view));
    let [width, height] = SIZE_PX;
    let mut color = frame.create_texture("color", TextureDesc::d2(width, height, Format::Rgba8UnormSrgb));
    let mut depth = frame.create_texture("depth", TextureDesc::d2(width, height, Format::Depth32Float));
    let mut pass = frame.render_pass("lit");
    let shadows = shadows.read_in(&mut pass);
    pass.color(&mut color, Contents::clear_color([0.25, 0.4, 0.7, 1.0]));
    // Depth is reversed: far is 0.
    pass.depth(&mut depth, Contents::clear_depth(0.0));
    let engine = &engine;
    pass.body(move |ctx| {
        let own =
            ctx.bind_group(&engine.view_layout, &[Bind::Uniform(view), Bind::OwnBuffer(&engine.buffer)])?;
        let shadows = shadows.bind_group(ctx, &engine.shadow_layout)?;
        ctx.pass.set_pipeline(&engine.lit);
        ctx.pass.set_bind_group(0, &own, &[]);
        ctx.pass.set_bind_group(1, &shadows, &[]);
        ctx.pass.draw(0..36, 0..engine.boxes.len() as u32);
        Ok(())
    });

    let request = frame.read_back_texture(&color, Part::WHOLE);
    let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
    let mut executed = graph.compile(frame)?.execute(&mut graph, device, &mut encoder)?;
    gpu.queue.submit([encoder.finish()]);
    let texels = executed.read_back(request).ok_or("nothing was read back")?.wait(device)?;
    write_png("out/custom_engine.png".as_ref(), width, height, Pixels::Rgba, &texels)?;
    Ok(())
}

/// The engine's scene: boxes, by their middles and half sides.
fn tower() -> Vec<[Vec4; 2]> {
    let ground = [Vec4::new(0.0, -0.5, 0.0, 0.0), Vec4::new(12.0, 0.5, 12.0, 0.0)];
    let step = |i: u32| {
        let (sin, cos) = (i as f32 * 0.5).sin_cos();
        [Vec4::new(2.0 * cos, 0.15 + 0.22 * i as f32, 2.0 * sin, 0.0), Vec4::new(0.45, 0.08, 0.45, 0.0)]
    };
    let pillar = [Vec4::new(0.0, 1.9, 0.0, 0.0), Vec4::new(0.5, 1.9, 0.5, 0.0)];
    [ground, pillar].into_iter().chain((0..16).map(step)).collect()
}

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct View {
    clip_from_world: Mat4,
    eye: Vec4,
    to_light: Vec4,
}

struct Engine {
    boxes: Vec<[Vec4; 2]>,
    buffer: wgpu::Buffer,
    view_layout: wgpu::BindGroupLayout,
    shadow_layout: wgpu::BindGroupLayout,
    lit: wgpu::RenderPipeline,
    caster_boxes: wgpu::BindGroup,
    caster: wgpu::RenderPipeline,
}

impl Engine {
    fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        technique: &dyn ShadowTechnique,
        boxes: Vec<[Vec4; 2]>,
    ) -> Result<Self, Box<dyn std::error::Error>> {
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("boxes"),
            size: size_of_val(&boxes[..]) as u64,
            usage: wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
            mapped_at_creation: false,
        });
        queue.write_buffer(&buffer, 0, bytemuck::cast_slice(&boxes));
        // The engine's shader imports the technique's function, whatever the technique.
        let source = ModuleSource::new("custom_engine.wgsl", WGSL);
        let shader = device.create_shader_module(wgpu::ShaderModuleDescriptor {
            label: None,
            source: wgpu::ShaderSource::Naga(Cow::Owned(compose_source(&source, &technique.modules(0))?)),
        });
        let (uniform, storage) =
            (wgpu::BufferBindingType::Uniform, wgpu::BufferBindingType::Storage { read_only: true });
        let (view_layout, boxes_layout) = (layout(device, &[uniform, storage]), layout(device, &[storage]));
        let shadow_layout = shadow_layout(device, technique);
        let lit = pipeline(device, &shader, "vs_lit", Some("fs_lit"), [&view_layout, &shadow_layout]);
        let caster =
            pipeline(device, &shader, "vs_caster", None, [&caster_view_layout(device), &boxes_layout]);
        let caster_boxes = device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: None,
            layout: &boxes_layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: buffer.as_entire_binding() }],
        });
        Ok(Self { boxes, buffer, view_layout, shadow_layout, lit, caster_boxes, caster })
    }
}

/// What shadow passes ask the engine for.
impl ShadowCasters for Engine {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        casters.extend((0..self.boxes.len() as u32).filter(|&i| volume.intersects(&self.bounds_of(i))));
    }

    fn bounds(&self) -> Aabb {
        (0..self.boxes.len() as u32).fold(Aabb::EMPTY, |all, i| all.union(&self.bounds_of(i)))
    }

    fn bounds_of(&self, caster: u32) -> Aabb {
        let [middle, half] = self.boxes[caster as usize].map(|at| at.truncate().as_dvec3());
        Aabb { min: middle - half, max: middle + half }
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32 {
        // A sun is all that this engine has: one format, one kind of view.
        debug_assert_eq!(
            view.target,
            CasterTarget { pass: CasterPass::Depth, format: Format::Depth32Float, perspective: false }
        );
        pass.set_pipeline(&self.caster);
        pass.set_bind_group(1, &self.caster_boxes, &[]);
        casters.iter().for_each(|&caster| pass.draw(0..36, caster..caster + 1));
        casters.len() as u32
    }
}

fn layout(device: &wgpu::Device, types: &[wgpu::BufferBindingType]) -> wgpu::BindGroupLayout {
    let entry = |(binding, &ty): (u32, &wgpu::BufferBindingType)| wgpu::BindGroupLayoutEntry {
        binding,
        visibility: wgpu::ShaderStages::VERTEX_FRAGMENT,
        ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
        count: None,
    };
    let entries: Vec<_> = (0..).zip(types).map(entry).collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: None, entries: &entries })
}

/// Draws boxes, with colours or with depth alone.
fn pipeline(
    device: &wgpu::Device,
    module: &wgpu::ShaderModule,
    vertex: &str,
    fragment: Option<&str>,
    groups: [&wgpu::BindGroupLayout; 2],
) -> wgpu::RenderPipeline {
    let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
        label: None,
        bind_group_layouts: &groups.map(Some),
        immediate_size: 0,
    });
    let compilation_options = wgpu::PipelineCompilationOptions::default;
    let targets = [Some(Format::Rgba8UnormSrgb.into())];
    device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
        label: Some(vertex),
        layout: Some(&layout),
        vertex: wgpu::VertexState {
            module,
            entry_point: Some(vertex),
            compilation_options: compilation_options(),
            buffers: &[],
        },
        primitive: wgpu::PrimitiveState::default(),
        depth_stencil: Some(wgpu::DepthStencilState {
            format: Format::Depth32Float,
            depth_write_enabled: Some(true),
            depth_compare: Some(wgpu::CompareFunction::GreaterEqual),
            stencil: wgpu::StencilState::default(),
            bias: wgpu::DepthBiasState::default(),
        }),
        multisample: wgpu::MultisampleState::default(),
        fragment: fragment.map(|entry| wgpu::FragmentState {
            module,
            entry_point: Some(entry),
            compilation_options: compilation_options(),
            targets: &targets,
        }),
        multiview_mask: None,
        cache: None,
    })
}
