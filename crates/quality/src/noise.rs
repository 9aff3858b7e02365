//! Noise that is averaged over frames: what is left of it.

use std::f64;

use shadowgraph::lighting::post::{Jitter, Temporal};
use shadowgraph::lighting::{Forward, Geometry, LitOutput, LitTarget, Prepass, Velocity};
use shadowgraph::{Gpu, RenderView, Renderer, SurfaceDrawer, ViewOptions};
use shadowgraph_core::{Format, FullscreenShader, Graph, Subresource};
use shadowgraph_shadows::{
    CascadeBlend, ContactSettings, PCF, PCSS, PcssSettings, RAYTRACED, RaytracedSettings, ScreenSettings,
    ShadowSettings, Technique,
};

use super::metrics::RECEIVER_N_DOT_L;
use super::{Comparator, Reference};
use crate::Error;

/// The weight of a frame in the averages: the default of the node `taa`.
const CURRENT_WEIGHT: f32 = 0.1;

/// The lengths of a measurement of noise.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct NoiseTask {
    /// Number of frames of temporal anti-aliasing, at least 1.
    pub frames: u32,
    /// Number of frames of the technique's own mean, at least `frames`.
    pub mean_frames: u32,
    /// Rays per pixel of the soft reference.
    pub soft_rays: u32,
    /// Whether sample positions are jittered. If not, nothing but noise changes from frame to frame.
    pub jitters: bool,
}

impl Default for NoiseTask {
    fn default() -> Self {
        Self { frames: 16, mean_frames: 256, soft_rays: 64, jitters: false }
    }
}

/// A technique with noise, and the settings that it is measured with.
#[derive(Clone, Debug)]
pub struct Noisy {
    /// Name in tables.
    pub name: &'static str,
    /// The technique.
    pub technique: Technique,
    /// The settings.
    pub settings: ShadowSettings,
}

/// Returns everything that draws noise, with these settings and directional lights of an angular radius.
///
/// # Errors
/// For a radius out of range.
pub fn noisy_techniques(settings: &ShadowSettings, sun_radius_rad: f32) -> Result<Vec<Noisy>, Error> {
    let mut soft = settings.clone();
    (soft.cascades.cache, soft.atlas.cache) = (true, true);
    soft.techniques.set(&PcssSettings { sun_radius_rad, ..PcssSettings::default() })?;
    soft.techniques.set(&RaytracedSettings { sun_radius_rad, ..RaytracedSettings::default() })?;
    let mut dithered = soft.clone();
    dithered.cascades.blend = CascadeBlend::Dither(0.5);
    let mut blurred = soft.clone();
    blurred.techniques.set(&ScreenSettings { blur_m: 0.1, ..ScreenSettings::default() })?;
    // Fewer samples than pixels.
    let mut sparse = soft.clone();
    sparse.techniques.set(&ContactSettings { max_steps: 4, ..ContactSettings::default() })?;
    let noisy =
        |name, technique, settings: &ShadowSettings| Noisy { name, technique, settings: settings.clone() };
    let pcf = Technique::from(PCF);
    Ok(vec![
        noisy("pcf, dithered blend", pcf, &dithered),
        noisy("pcf+screen, blurred", pcf.with_screen(), &blurred),
        noisy("pcf+contact", pcf.with_contact(), &sparse),
        noisy("pcss", PCSS.into(), &soft),
        noisy("raytraced", RAYTRACED.into(), &soft),
    ])
}

/// Errors of the visibility of a light at receivers, 0 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct NoiseErrors {
    /// One frame against the mean of many frames of the same technique.
    pub one_frame: RootMeanSquare,
    /// Frames averaged by temporal anti-aliasing against the same mean.
    pub averaged: RootMeanSquare,
    /// Frames averaged by temporal anti-aliasing against the soft reference.
    pub averaged_to_soft: RootMeanSquare,
    /// The same, with noise that is the same in every frame.
    pub fixed_to_soft: RootMeanSquare,
}

impl NoiseErrors {
    /// Adds the errors of another view.
    pub fn add(&mut self, other: &Self) {
        self.one_frame.add(other.one_frame);
        self.averaged.add(other.averaged);
        self.averaged_to_soft.add(other.averaged_to_soft);
        self.fixed_to_soft.add(other.fixed_to_soft);
    }
}

/// A root mean square that grows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct RootMeanSquare {
    sum: f64,
    count: f64,
}

impl RootMeanSquare {
    fn of_differences(differences: impl Iterator<Item = f32>) -> Self {
        let square = |all: Self, difference: f32| Self {
            sum: all.sum + f64::from(difference).powi(2),
            count: all.count + 1.0,
        };
        differences.fold(Self::default(), square)
    }

    fn add(&mut self, other: Self) {
        self.sum += other.sum;
        self.count += other.count;
    }

    /// Returns the value; 0 without differences.
    #[must_use]
    pub fn value(self) -> f64 {
        if self.count > 0.0 { (self.sum / self.count).sqrt() } else { 0.0 }
    }
}

/// Measures the noise of a renderer's technique in a view, for a light. The camera stands.
///
/// # Errors
/// Settings out of range, or a failure of the GPU.
pub fn measure_noise(
    gpu: &Gpu,
    renderer: &mut Renderer,
    options: &ViewOptions,
    (light, sun_radius_rad): (usize, f32),
    task: NoiseTask,
) -> Result<NoiseErrors, Error> {
    let mut comparator = Comparator::new(gpu, renderer, light)?.with_sun_radius(sun_radius_rad);
    let reference = comparator.reference(renderer, options, task.soft_rays)?;
    let passes = Passes::new(gpu, renderer, light)?;
    let view = renderer.view(options, None);
    let mut changing = Sequence::new(&passes, task.jitters)?;
    let (mut sums, mut squares) = (vec![0.0; reference.truth.hard.len()], RootMeanSquare::default());
    let mut averaged = Vec::new();
    let mut drawn = Vec::new();
    for number in 0..task.mean_frames {
        let noisy = RenderView { noise_frame: Some(number), ..renderer.view(options, None) };
        let [frame, mixed] = changing.draw(&noisy, number)?;
        sums.iter_mut().zip(&frame).for_each(|(sum, value)| *sum += f64::from(*value));
        if number + 1 == task.frames {
            averaged = mixed;
        }
        drawn.push(frame);
    }
    let mean: Vec<f32> = sums.iter().map(|sum| (sum / f64::from(task.mean_frames)) as f32).collect();
    for frame in &drawn {
        squares.add(difference(&reference, frame, &mean));
    }
    let mut fixed = Sequence::new(&passes, task.jitters)?;
    let mut still = Vec::new();
    for number in 0..task.frames {
        [_, still] = fixed.draw(&view, number)?;
    }
    let soft = reference.soft.as_ref().unwrap_or(&reference.truth.hard);
    Ok(NoiseErrors {
        one_frame: squares,
        averaged: difference(&reference, &averaged, &mean),
        averaged_to_soft: difference(&reference, &averaged, soft),
        fixed_to_soft: difference(&reference, &still, soft),
    })
}

/// Returns the difference of two images at receivers.
fn difference(reference: &Reference, a: &[f32], b: &[f32]) -> RootMeanSquare {
    let is_receiver = |pixel: &usize| {
        reference.surfaces.is_drawn(*pixel) && reference.truth.n_dot_l[*pixel] > RECEIVER_N_DOT_L
    };
    let pixels = (0..a.len().min(b.len())).filter(is_receiver);
    RootMeanSquare::of_differences(pixels.map(|pixel| a[pixel] - b[pixel]))
}

/// The passes of a frame.
struct Passes<'g> {
    gpu: &'g Gpu,
    prepass: Prepass,
    velocity: Velocity,
    surfaces: SurfaceDrawer,
    lighting: Forward,
    /// Copies visibility to a format that is read back.
    copy: FullscreenShader,
}

impl<'g> Passes<'g> {
    fn new(gpu: &'g Gpu, renderer: &Renderer, light: usize) -> Result<Self, Error> {
        let (device, layouts) = (&gpu.device, renderer.casters().scene.layouts());
        let output = LitOutput::Visibility(light as u32);
        let target = LitTarget { format: Format::Rgba16Float, output, samples: 1 };
        gpu.checked(|| {
            Ok(Self {
                gpu,
                prepass: Prepass::new(device, layouts, 1)?,
                velocity: Velocity::new(device, layouts)?,
                surfaces: SurfaceDrawer::new(device, layouts)?,
                lighting: Forward::new(device, layouts, renderer.technique(), target)?,
                copy: FullscreenShader::wgsl("copy", COPY),
            })
        })
    }
}

const COPY: &str = "
    @group(0) @binding(0) var visibility: texture_2d<f32>;
    @fragment fn copy(@builtin(position) position: vec4f, @location(0) uv: vec2f) -> @location(0) vec4f {
        return textureLoad(visibility, vec2u(position.xy), 0);
    }";

/// Frames that follow each other.
struct Sequence<'p> {
    passes: &'p Passes<'p>,
    temporal: Temporal,
    graph: Graph,
    jitters: bool,
}

impl<'p> Sequence<'p> {
    fn new(passes: &'p Passes<'p>, jitters: bool) -> Result<Self, Error> {
        let temporal = Temporal::new(&passes.gpu.device)?;
        Ok(Self { passes, temporal, graph: Graph::default(), jitters })
    }

    /// Draws a frame, and returns its visibility and that averaged with earlier frames.
    fn draw(&mut self, view: &RenderView<'_>, number: u32) -> Result<[Vec<f32>; 2], Error> {
        let Self { passes, temporal, graph, jitters } = self;
        let draws = view.list_draws();
        passes.gpu.checked(|| {
            let mut frame = graph.frame();
            let uniforms = view.uniforms();
            let uniforms = if *jitters { uniforms.jittered(Jitter::for_frame(number)) } else { uniforms };
            let buffers = uniforms.upload(&mut frame);
            let (scene, size_px) = (&view.casters.scene, view.options.size_px);
            let geometry = &Geometry { scene, draws: &draws, culled: None, size_px };
            let depth = passes.prepass.add_to(&mut frame, &buffers, geometry);
            let surfaces = view
                .technique
                .reads_surface_buffers()
                .then(|| passes.surfaces.surface_buffers_with_prepass(&mut frame, &buffers, geometry));
            let shadows = view.add_shadows(&mut frame, surfaces.transpose()?.as_ref())?;
            let lit = passes.lighting.lit(&mut frame, &buffers, &shadows, &depth, geometry, [0.0; 4])?;
            let velocity = passes.velocity.add_to(&mut frame, &buffers, &depth, geometry);
            let averaged =
                temporal.add_to(&mut frame, [&lit, &depth], Some(&velocity), &buffers, CURRENT_WEIGHT);
            let requests = [lit, averaged].map(|image| {
                let mut copied = frame.create_texture("visibility", view.texture_desc(Format::R32Float));
                frame.fullscreen("copy", &passes.copy).sample(&image).draw(&mut copied);
                frame.read_back_texture(&copied, Subresource::FULL)
            });
            let device = &passes.gpu.device;
            let mut encoder = device.create_command_encoder(&Default::default());
            let mut executed = graph.compile(frame)?.execute(graph, device, &mut encoder)?;
            let texels = requests.map(|request| executed.read_back(request).ok_or(Error::MissingReadback));
            passes.gpu.queue.submit([encoder.finish()]);
            let [lit, averaged] = texels;
            Ok([floats(&lit?.wait(device)?), floats(&averaged?.wait(device)?)])
        })
    }
}

fn floats(bytes: &[u8]) -> Vec<f32> {
    bytes.as_chunks::<4>().0.iter().map(|&bytes| f32::from_le_bytes(bytes)).collect()
}
