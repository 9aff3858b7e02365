//! A frame of the size of a real one: 65 passes with 350 accesses to textures and buffers, in nodes, with several
//! attachments, tiles, mips, imports and histories.

use shadowgraph_core::{
    Buffer, BufferDesc, BufferUsages, Compute, Contents, Extent, Format, Frame, Pass, Rect, Rendering,
    Resize, Subresource, Texture, TextureDesc, TextureUsages,
};

pub(crate) const PASSES: usize = 65;

const WIDTH: u32 = 1920;
const HEIGHT: u32 = 1080;
const CASCADES: usize = 4;
const BLOOM: [&str; 6] = ["bloom 0", "bloom 1", "bloom 2", "bloom 3", "bloom 4", "bloom 5"];
const CULL: [&str; CASCADES + 1] = ["main", "cascade 0", "cascade 1", "cascade 2", "cascade 3"];
const VISIBLE: [&str; CASCADES + 1] =
    ["visible", "visible in 0", "visible in 1", "visible in 2", "visible in 3"];
const DRAWS: [&str; CASCADES + 1] = ["draws", "draws in 0", "draws in 1", "draws in 2", "draws in 3"];
const HI_Z: [&str; 6] = ["mip 0", "mip 1", "mip 2", "mip 3", "mip 4", "mip 5"];
const BLACK: Contents = Contents::Clear(shadowgraph_core::ClearValue::Color([0.0; 4]));

/// Resources that most passes read.
struct Scene {
    view: Buffer,
    settings: Buffer,
    lights: Buffer,
    vertices: Buffer,
    indices: Buffer,
    instances: Buffer,
    materials: Buffer,
    environment: Texture,
    noise: Texture,
    visible: [Buffer; CASCADES + 1],
    draws: [Buffer; CASCADES + 1],
}

struct Surfaces {
    albedo: Texture,
    normals: Texture,
    roughness: Texture,
    velocity: Texture,
    depth: Texture,
}

/// Declares the frame. `red` is part of one clear value, `bytes` are uploaded.
pub(crate) fn declare<'f>(frame: &mut Frame<'f>, bytes: &'f [u8], red: f64) {
    let mut surface = frame.declare_import_texture(
        "surface",
        TextureDesc::d2(WIDTH, HEIGHT, Format::Bgra8UnormSrgb),
        TextureUsages::RENDER_ATTACHMENT,
        false,
    );
    let scene = scene(frame, bytes);
    let shadows = frame.node("shadows", |frame| shadows(frame, &scene));
    let surfaces = frame.node("surfaces", |frame| surfaces(frame, &scene, red));
    let hi_z = frame.node("hi-z", |frame| hi_z(frame, &scene, &surfaces.depth));
    let occlusion = frame.node("occlusion", |frame| occlusion(frame, &scene, &surfaces));
    let clusters = frame.node("clusters", |frame| clusters(frame, &scene, &surfaces.depth));
    let reflections = frame.node("reflections", |frame| reflections(frame, &scene, &surfaces, &hi_z));
    let fog = frame.node("fog", |frame| fog(frame, &scene, &shadows, &clusters));
    let seen = [&shadows, &occlusion, &reflections, &fog];
    let mut color = frame.node("lighting", |frame| lighting(frame, &scene, &surfaces, &clusters, seen));
    frame.node("particles", |frame| particles(frame, &scene, &surfaces.depth, &mut color));
    let color = frame.node("antialiasing", |frame| antialiasing(frame, &scene, &surfaces, &color));
    let exposure = frame.node("exposure", |frame| exposure(frame, &scene, &color));
    let color = frame.node("focus", |frame| focus(frame, &scene, &surfaces.depth, &color));
    let color = frame.node("motion blur", |frame| motion_blur(frame, &scene, &surfaces, &color));
    let glow = frame.node("bloom", |frame| bloom(frame, &scene, &color));
    frame.node("output", |frame| output(frame, &scene, [&color, &glow], &exposure, &mut surface));
}

fn scene<'f>(frame: &mut Frame<'f>, bytes: &'f [u8]) -> Scene {
    let usage = BufferUsages::STORAGE | BufferUsages::UNIFORM | BufferUsages::VERTEX | BufferUsages::INDEX;
    let mut import = |name: &str| frame.declare_import_buffer(name, BufferDesc::new(1 << 20), usage, true);
    let (vertices, indices) = (import("vertices"), import("indices"));
    let (instances, materials, settings) = (import("instances"), import("materials"), import("settings"));
    let mut import = |name: &str| {
        let desc = TextureDesc::d2(512, 512, Format::Rgba16Float);
        frame.declare_import_texture(name, desc, TextureUsages::TEXTURE_BINDING, true)
    };
    let (environment, noise) = (import("environment"), import("noise"));
    let view = frame.upload_buffer("view", bytes);
    let lights = frame.upload_buffer("lights", bytes);
    let mut count = frame.create_buffer("count", BufferDesc::new(64));
    let (visible, draws) = frame.node("culling", |frame| {
        frame.compute_pass("reset").storage_buffer_mut(&mut count, Contents::Overwrite);
        let mut visible = VISIBLE.map(|name| frame.create_buffer(name, BufferDesc::new(1 << 16)));
        let mut draws = DRAWS.map(|name| frame.create_buffer(name, BufferDesc::new(1 << 14)));
        for (name, (visible, draws)) in CULL.into_iter().zip(visible.iter_mut().zip(&mut draws)) {
            let mut pass = frame.compute_pass(name);
            pass.uniform_buffer(&view);
            pass.storage_buffer(&instances);
            pass.storage_buffer_mut(&mut count, Contents::Preserve);
            pass.storage_buffer_mut(visible, Contents::Overwrite);
            pass.storage_buffer_mut(draws, Contents::Overwrite);
        }
        (visible, draws)
    });
    Scene {
        view,
        settings,
        lights,
        vertices,
        indices,
        instances,
        materials,
        environment,
        noise,
        visible,
        draws,
    }
}

impl Scene {
    /// Reads the arguments of an indirect draw of the view `index`.
    fn geometry(&self, pass: &mut Pass<'_, '_, Rendering>, index: usize) {
        pass.uniform_buffer(&self.view);
        pass.storage_buffer(&self.instances);
        pass.storage_buffer(&self.materials);
        pass.storage_buffer(&self.visible[index]);
        pass.vertex_buffer(&self.vertices);
        pass.index_buffer(&self.indices);
        pass.indirect_buffer(&self.draws[index]);
    }

    /// Draws a new texture from others.
    fn filter(&self, frame: &mut Frame<'_>, name: &str, inputs: &[&Texture], desc: TextureDesc) -> Texture {
        let mut output = frame.create_texture(name, desc);
        let mut pass = frame.render_pass(name);
        self.inputs(&mut pass, inputs);
        pass.color(&mut output, Contents::Overwrite);
        output
    }

    /// Computes a new texture from others.
    fn compute(&self, frame: &mut Frame<'_>, name: &str, inputs: &[&Texture], desc: TextureDesc) -> Texture {
        let mut output = frame.create_texture(name, desc);
        let mut pass = frame.compute_pass(name);
        self.compute_inputs(&mut pass, inputs);
        pass.storage_texture_mut(&mut output, Contents::Overwrite);
        output
    }

    fn inputs(&self, pass: &mut Pass<'_, '_, Rendering>, inputs: &[&Texture]) {
        pass.uniform_buffer(&self.view);
        pass.uniform_buffer(&self.settings);
        for input in inputs {
            pass.sample(input);
        }
    }

    fn compute_inputs(&self, pass: &mut Pass<'_, '_, Compute>, inputs: &[&Texture]) {
        pass.uniform_buffer(&self.view);
        pass.uniform_buffer(&self.settings);
        for input in inputs {
            pass.sample(input);
        }
    }
}

fn screen(format: Format) -> TextureDesc {
    TextureDesc::d2(WIDTH, HEIGHT, format)
}

fn half(format: Format) -> TextureDesc {
    TextureDesc::d2(WIDTH / 2, HEIGHT / 2, format)
}

/// One tile of an atlas for each cascade.
fn shadows(frame: &mut Frame<'_>, scene: &Scene) -> Texture {
    let mut atlas = frame.create_texture("atlas", TextureDesc::d2(4096, 4096, Format::Depth32Float));
    for (index, name) in CULL.into_iter().enumerate().skip(1) {
        let (x, y) = ((index as u32 - 1) % 2 * 2048, (index as u32 - 1) / 2 * 2048);
        let mut pass = frame.render_pass(name);
        scene.geometry(&mut pass, index);
        pass.subresource(Subresource::FULL.rect(Rect::new(x, y, 2048, 2048)))
            .depth(&mut atlas, Contents::clear_depth(0.0));
    }
    atlas
}

fn surfaces(frame: &mut Frame<'_>, scene: &Scene, red: f64) -> Surfaces {
    let mut depth = frame.create_texture("depth", screen(Format::Depth32Float));
    let mut pass = frame.render_pass("depth");
    scene.geometry(&mut pass, 0);
    pass.depth(&mut depth, Contents::clear_depth(0.0));
    let mut albedo = frame.create_texture("albedo", screen(Format::Rgba8UnormSrgb));
    let mut normals = frame.create_texture("normals", screen(Format::Rgb10a2Unorm));
    let mut roughness = frame.create_texture("roughness", screen(Format::Rgba8Unorm));
    let mut velocity = frame.create_texture("velocity", screen(Format::Rg16Float));
    let mut pass = frame.render_pass("materials");
    scene.geometry(&mut pass, 0);
    pass.color(&mut albedo, Contents::clear_color([red, 0.0, 0.0, 1.0]));
    pass.color(&mut normals, BLACK);
    pass.color(&mut roughness, BLACK);
    pass.color(&mut velocity, BLACK);
    pass.depth(&mut depth, Contents::Preserve);
    let mut pass = frame.render_pass("decals");
    scene.inputs(&mut pass, &[&depth, &normals]);
    pass.storage_buffer(&scene.materials);
    pass.vertex_buffer(&scene.vertices);
    pass.index_buffer(&scene.indices);
    pass.color(&mut albedo, Contents::Preserve);
    pass.color(&mut roughness, Contents::Preserve);
    Surfaces { albedo, normals, roughness, velocity, depth }
}

/// A depth pyramid: the nearest depth, mip by mip.
fn hi_z(frame: &mut Frame<'_>, scene: &Scene, depth: &Texture) -> Texture {
    let desc = TextureDesc { mip_levels: HI_Z.len() as u32, ..half(Format::R32Float) };
    let mut pyramid = frame.create_texture("pyramid", desc);
    for (mip, name) in (0..).zip(HI_Z) {
        let mut pass = frame.compute_pass(name);
        pass.uniform_buffer(&scene.view);
        if mip == 0 {
            pass.sample(depth);
        } else {
            pass.subresource(Subresource::FULL.mip(mip - 1)).sample(&pyramid);
        }
        pass.subresource(Subresource::FULL.mip(mip)).storage_texture_mut(&mut pyramid, Contents::Overwrite);
    }
    pyramid
}

fn occlusion(frame: &mut Frame<'_>, scene: &Scene, surfaces: &Surfaces) -> Texture {
    let desc = half(Format::R8Unorm);
    let Surfaces { depth, normals, .. } = surfaces;
    let rough = scene.filter(frame, "trace", &[depth, normals, &scene.noise], desc);
    let smooth = scene.filter(frame, "blur across", &[&rough, depth], desc);
    scene.filter(frame, "blur down", &[&smooth, depth], desc)
}

fn clusters(frame: &mut Frame<'_>, scene: &Scene, depth: &Texture) -> Buffer {
    let mut boxes = frame.create_buffer("boxes", BufferDesc::new(1 << 18));
    let mut pass = frame.compute_pass("boxes");
    scene.compute_inputs(&mut pass, &[depth]);
    pass.storage_buffer_mut(&mut boxes, Contents::Overwrite);
    let mut list = frame.create_buffer("list", BufferDesc::new(1 << 20));
    let mut pass = frame.compute_pass("list");
    scene.compute_inputs(&mut pass, &[depth]);
    pass.storage_buffer(&boxes);
    pass.storage_buffer(&scene.lights);
    pass.storage_buffer_mut(&mut list, Contents::Overwrite);
    list
}

fn reflections(frame: &mut Frame<'_>, scene: &Scene, surfaces: &Surfaces, hi_z: &Texture) -> Texture {
    let desc = half(Format::Rgba16Float);
    let Surfaces { depth, normals, roughness, velocity, .. } = surfaces;
    let hits = scene.compute(frame, "trace", &[hi_z, depth, normals, roughness, &scene.noise], desc);
    let rays = scene.compute(frame, "resolve", &[&hits, depth, normals, roughness, &scene.environment], desc);
    let mut kept = frame.history("reflections", desc, Resize::Resample);
    let mut pass = frame.render_pass("accumulate");
    scene.inputs(&mut pass, &[&rays, velocity, depth, &kept.previous]);
    pass.color(&mut kept.current, Contents::Overwrite);
    scene.filter(frame, "blur", &[&kept.current, depth, normals, roughness], desc)
}

fn fog(frame: &mut Frame<'_>, scene: &Scene, shadows: &Texture, clusters: &Buffer) -> Texture {
    let size = Extent { width: 160, height: 90, depth_or_array_layers: 64 };
    let dimension = wgpu_types::TextureDimension::D3;
    let desc = TextureDesc { size, dimension, ..half(Format::Rgba16Float) };
    let mut scattered = frame.create_texture("scattered", desc);
    let mut pass = frame.compute_pass("scatter");
    scene.compute_inputs(&mut pass, &[shadows, &scene.noise]);
    pass.storage_buffer(&scene.lights);
    pass.storage_buffer(clusters);
    pass.storage_texture_mut(&mut scattered, Contents::Overwrite);
    let mut kept = frame.history("fog", desc, Resize::Reset);
    let mut pass = frame.compute_pass("accumulate");
    scene.compute_inputs(&mut pass, &[&scattered, &kept.previous]);
    pass.storage_texture_mut(&mut kept.current, Contents::Overwrite);
    scene.compute(frame, "integrate", &[&kept.current], desc)
}

fn lighting(
    frame: &mut Frame<'_>,
    scene: &Scene,
    surfaces: &Surfaces,
    clusters: &Buffer,
    seen: [&Texture; 4],
) -> Texture {
    let Surfaces { albedo, normals, roughness, depth, .. } = surfaces;
    let mut color = frame.create_texture("color", screen(Format::Rgba16Float));
    let mut pass = frame.render_pass("deferred");
    scene.inputs(&mut pass, &[albedo, normals, roughness, depth, &scene.environment]);
    for texture in seen {
        pass.sample(texture);
    }
    pass.storage_buffer(&scene.lights);
    pass.storage_buffer(clusters);
    pass.color(&mut color, BLACK);
    let mut pass = frame.render_pass("sky");
    scene.inputs(&mut pass, &[&scene.environment, seen[3]]);
    pass.color(&mut color, Contents::Preserve);
    pass.depth_read(depth);
    let mut pass = frame.render_pass("transparent");
    scene.geometry(&mut pass, 0);
    for texture in [&scene.environment, seen[0], seen[3]] {
        pass.sample(texture);
    }
    pass.storage_buffer(&scene.lights);
    pass.storage_buffer(clusters);
    pass.color(&mut color, Contents::Preserve);
    pass.depth_read(depth);
    color
}

fn particles(frame: &mut Frame<'_>, scene: &Scene, depth: &Texture, color: &mut Texture) {
    let usage = BufferUsages::STORAGE;
    let mut particles = frame.declare_import_buffer("particles", BufferDesc::new(1 << 20), usage, true);
    let mut sorted = frame.create_buffer("sorted", BufferDesc::new(1 << 16));
    let mut pass = frame.compute_pass("move");
    scene.compute_inputs(&mut pass, &[depth, &scene.noise]);
    pass.storage_buffer_mut(&mut particles, Contents::Preserve);
    let mut pass = frame.compute_pass("sort");
    pass.uniform_buffer(&scene.view);
    pass.storage_buffer(&particles);
    pass.storage_buffer_mut(&mut sorted, Contents::Overwrite);
    let mut pass = frame.render_pass("draw");
    scene.inputs(&mut pass, &[&scene.environment]);
    pass.storage_buffer(&particles);
    pass.storage_buffer(&sorted);
    pass.color(color, Contents::Preserve);
    pass.depth_read(depth);
}

fn antialiasing(frame: &mut Frame<'_>, scene: &Scene, surfaces: &Surfaces, color: &Texture) -> Texture {
    let mut kept = frame.history("color", screen(Format::Rgba16Float), Resize::Resample);
    let mut pass = frame.render_pass("accumulate");
    scene.inputs(&mut pass, &[color, &surfaces.velocity, &surfaces.depth, &kept.previous]);
    pass.color(&mut kept.current, Contents::Overwrite);
    scene.filter(frame, "sharpen", &[&kept.current], screen(Format::Rgba16Float))
}

fn exposure(frame: &mut Frame<'_>, scene: &Scene, color: &Texture) -> Buffer {
    let usage = BufferUsages::STORAGE | BufferUsages::UNIFORM;
    let mut exposure = frame.declare_import_buffer("exposure", BufferDesc::new(16), usage, true);
    let mut histogram = frame.create_buffer("histogram", BufferDesc::new(1024));
    let mut pass = frame.compute_pass("histogram");
    scene.compute_inputs(&mut pass, &[color]);
    pass.storage_buffer_mut(&mut histogram, Contents::Overwrite);
    let mut pass = frame.compute_pass("average");
    pass.uniform_buffer(&scene.view);
    pass.storage_buffer(&histogram);
    pass.storage_buffer_mut(&mut exposure, Contents::Preserve);
    exposure
}

fn focus(frame: &mut Frame<'_>, scene: &Scene, depth: &Texture, color: &Texture) -> Texture {
    let small = half(Format::Rgba16Float);
    let blur = scene.filter(frame, "circle of confusion", &[depth], screen(Format::R16Float));
    let half = scene.filter(frame, "shrink", &[color, &blur], small);
    let near = scene.filter(frame, "near", &[&half, &blur], small);
    let far = scene.filter(frame, "far", &[&half, &blur], small);
    scene.filter(frame, "combine", &[color, &blur, &near, &far], screen(Format::Rgba16Float))
}

fn motion_blur(frame: &mut Frame<'_>, scene: &Scene, surfaces: &Surfaces, color: &Texture) -> Texture {
    let tiles = TextureDesc::d2(WIDTH / 20, HEIGHT / 20, Format::Rg16Float);
    let Surfaces { velocity, depth, .. } = surfaces;
    let fastest = scene.compute(frame, "tiles", &[velocity], tiles);
    let spread = scene.compute(frame, "neighbours", &[&fastest], tiles);
    let inputs = [color, velocity, &spread, depth, &scene.noise];
    scene.filter(frame, "blur", &inputs, screen(Format::Rgba16Float))
}

/// Downsamples the image six times, then upsamples and adds from the smallest.
fn bloom(frame: &mut Frame<'_>, scene: &Scene, color: &Texture) -> Texture {
    let mut shrunk = color.clone();
    let mut size = (WIDTH, HEIGHT);
    let mut levels = BLOOM.map(|name| {
        size = (size.0 / 2, size.1 / 2);
        let desc = TextureDesc::d2(size.0, size.1, Format::Rg11b10Ufloat);
        shrunk = scene.filter(frame, name, &[&shrunk], desc);
        shrunk.clone()
    });
    for level in (1..BLOOM.len()).rev() {
        let (larger, smaller) = levels.split_at_mut(level);
        let mut pass = frame.render_pass(BLOOM[level - 1]);
        scene.inputs(&mut pass, &[&smaller[0]]);
        pass.color(&mut larger[level - 1], Contents::Preserve);
    }
    let [glow, ..] = levels;
    glow
}

fn output(
    frame: &mut Frame<'_>,
    scene: &Scene,
    inputs: [&Texture; 2],
    exposure: &Buffer,
    surface: &mut Texture,
) {
    let mut mapped = frame.create_texture("mapped", screen(Format::Rgba8UnormSrgb));
    let mut pass = frame.render_pass("tone map");
    scene.inputs(&mut pass, &inputs);
    pass.sample(&scene.noise);
    pass.uniform_buffer(exposure);
    pass.color(&mut mapped, Contents::Overwrite);
    let mut pass = frame.render_pass("smooth edges");
    scene.inputs(&mut pass, &[&mapped]);
    pass.color(surface, Contents::Overwrite);
    let mut pass = frame.render_pass("interface");
    scene.inputs(&mut pass, &[&scene.noise]);
    pass.vertex_buffer(&scene.vertices);
    pass.index_buffer(&scene.indices);
    pass.storage_buffer(&scene.instances);
    pass.color(surface, Contents::Preserve);
}
