//! The visible surfaces of a view: position and normal of each pixel.

use glam::{Vec2, Vec3};
use shadowgraph_core::Subresource;
use shadowgraph_lighting::{Geometry, ViewUniforms};

use shadowgraph::SurfaceDrawer;
use shadowgraph::{Gpu, Renderer, ViewOptions};

use crate::Error;

/// The surfaces of a view, row by row from the top.
#[derive(Clone, Debug, PartialEq)]
pub struct Surfaces {
    /// Width and height, pixels.
    pub size_px: [u32; 2],
    /// Positions, metres relative to the frame's origin; zero where there is no geometry.
    pub positions: Vec<Vec3>,
    /// Geometric normals, facing the viewer, unit length, accurate to 0.06 degrees; zero where there is no geometry.
    pub normals: Vec<Vec3>,
    /// View depths, metres; 0 where there is no geometry.
    pub view_depths_m: Vec<f32>,
    /// The texels, encoded as in `shadowgraph::surface` of the shaders.
    texels: Vec<u8>,
}

/// Reads back the surfaces of views.
pub struct SurfaceReader {
    drawer: SurfaceDrawer,
}

impl SurfaceReader {
    /// Creates the pipelines for a renderer's scene.
    ///
    /// # Errors
    /// A failure of the GPU.
    pub fn new(gpu: &Gpu, renderer: &Renderer) -> Result<Self, Error> {
        let layouts = renderer.casters().scene.layouts();
        gpu.checked(|| Ok(Self { drawer: SurfaceDrawer::new(&gpu.device, layouts)? }))
    }

    /// Draws the surfaces of a view, without blended geometry, and reads them back.
    ///
    /// # Errors
    /// An image over the adapter's limits, or a failure of the GPU.
    pub fn read(&self, gpu: &Gpu, renderer: &mut Renderer, options: &ViewOptions) -> Result<Surfaces, Error> {
        renderer.begin_frame(gpu, options)?;
        let view = renderer.view(options, None);
        let draws = view.list_draws();
        let bytes = gpu.checked(|| -> Result<_, Error> {
            let scene = &renderer.casters().scene;
            let (lights, origin_world) = (renderer.scene().lights(), scene.origin_world());
            let mut graph = renderer.graph();
            let mut frame = graph.frame();
            view.add_pose(&mut frame);
            let uniforms = ViewUniforms::new(
                &options.camera,
                options.size_px,
                lights,
                origin_world,
                &view.ambient_light,
            );
            let buffers = uniforms.upload(&mut frame);
            let geometry = Geometry { scene, draws: &draws, culled: None, size_px: options.size_px };
            let screen = self.drawer.surface_buffers_with_prepass(&mut frame, &buffers, &geometry)?;
            let request = frame.read_back_texture(&screen.surfaces, Subresource::FULL);
            let mut encoder = gpu.device.create_command_encoder(&Default::default());
            let mut executed = graph.compile(frame)?.execute(&mut graph, &gpu.device, &mut encoder)?;
            gpu.queue.submit([encoder.finish()]);
            let texels = executed.read_back(request).ok_or(Error::MissingReadback)?;
            Ok(texels.wait(&gpu.device)?)
        })?;
        Ok(Surfaces::decode(bytes, options, renderer))
    }
}

impl Surfaces {
    fn decode(bytes: Vec<u8>, options: &ViewOptions, renderer: &Renderer) -> Self {
        let origin_world = renderer.casters().scene.origin_world();
        let view_from_world = options.camera.view_from_world();
        let texels = bytes.chunks_exact(16).map(|texel| {
            let float = |at: usize| texel[at..at + 4].try_into().map_or(0.0, f32::from_le_bytes);
            (Vec3::new(float(0), float(4), float(8)), float(12))
        });
        let count = bytes.len() / 16;
        let mut surfaces = Self {
            size_px: options.size_px,
            positions: Vec::with_capacity(count),
            normals: Vec::with_capacity(count),
            view_depths_m: Vec::with_capacity(count),
            texels: Vec::new(),
        };
        for (position, packed) in texels {
            let normal = normal(packed);
            let view = view_from_world.transform_point3(origin_world + position.as_dvec3());
            surfaces.positions.push(position);
            surfaces.normals.push(normal.unwrap_or(Vec3::ZERO));
            surfaces.view_depths_m.push(if normal.is_some() { -view.z as f32 } else { 0.0 });
        }
        surfaces.texels = bytes;
        surfaces
    }

    /// Returns the texels as they were read back.
    pub(super) fn texels(&self) -> &[u8] {
        &self.texels
    }

    /// Returns whether a pixel has geometry.
    #[must_use]
    pub fn is_drawn(&self, pixel: usize) -> bool {
        self.view_depths_m.get(pixel).is_some_and(|depth| *depth > 0.0)
    }
}

/// Decodes a packed normal; `None` for 0, where there is no geometry.
fn normal(packed: f32) -> Option<Vec3> {
    let packed = (packed as u32).checked_sub(1)?;
    let flat = Vec2::new((packed / 4096) as f32, (packed % 4096) as f32) / 4095.0 * 2.0 - 1.0;
    let z = 1.0 - flat.x.abs() - flat.y.abs();
    let folded = (Vec2::ONE - Vec2::new(flat.y, flat.x).abs()) * Vec2::ONE.copysign(flat);
    let xy = if z >= 0.0 { flat } else { folded };
    Some(xy.extend(z).normalize_or(Vec3::Y))
}

#[cfg(test)]
mod tests {
    use super::normal;
    use glam::Vec3;

    /// Packs a normal as the shader does.
    fn packed(n: Vec3) -> f32 {
        let flat = n.truncate() / (n.x.abs() + n.y.abs() + n.z.abs());
        let sign = |v: f32| if v >= 0.0 { 1.0 } else { -1.0 };
        let folded =
            glam::Vec2::new((1.0 - flat.y.abs()) * sign(flat.x), (1.0 - flat.x.abs()) * sign(flat.y));
        let square = (if n.z >= 0.0 { flat } else { folded }) * 0.5 + 0.5;
        let [x, y] = (square * 4095.0).round().to_array();
        1.0 + x * 4096.0 + y
    }

    #[test]
    fn packed_normals_are_decoded_to_six_hundredths_of_a_degree() {
        assert_eq!(normal(0.0), None);
        for i in 0..5_000 {
            let (turn, height) = (i as f32 * 2.399_963, i as f32 / 2_500.0 - 0.999_8);
            let flat = (1.0 - height * height).max(0.0).sqrt();
            let n = Vec3::new(turn.cos() * flat, turn.sin() * flat, height).normalize();
            let back = normal(packed(n)).unwrap_or(Vec3::ZERO);
            assert!(back.angle_between(n) < 0.06f32.to_radians(), "{n} became {back}");
        }
    }
}
