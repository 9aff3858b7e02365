//! Shadows in a custom engine: it has its own scene, a list of boxes, and its own lit shader, and uses the graph and a shadow technique of
//! Shadowgraph. Another technique with shadow maps is a change of one line; techniques that read positions and normals need
//! [`SurfaceBuffers`](shadowgraph::shadows::SurfaceBuffers) too.
//!
//! `cargo run -p shadowgraph-examples --example custom_engine` writes out/custom_engine.png; `-- --window` shows it, and `-- --serve 9000`
//! prints the address of a page about its frames.

mod engine;
mod pipelines;

use engine::Engine;
use glam::{DVec3, Mat4, Vec3, Vec4};
use shadowgraph::Gpu;
use shadowgraph::core::{Bind, Contents, Format, Graph, TextureDesc};
use shadowgraph::scene::{Camera, Light, LightKind, Projection};
use shadowgraph::shadows::{
    PCF, ShadowInputs, ShadowSettings, ShadowTechnique, Technique, TechniqueContext, add_shadows,
};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use std::process::ExitCode;

#[repr(C)]
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
struct View {
    clip_from_world: Mat4,
    eye: Vec4,
    to_light: Vec4,
}

struct Tower {
    technique: Box<dyn ShadowTechnique>,
    engine: Engine,
    graph: Graph,
}

impl Example for Tower {
    const NAME: &'static str = "custom_engine";
    const SERVES: bool = true;

    fn new(gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        // The line that chooses the technique.
        let technique = Technique::from(PCF).make(&TechniqueContext::new(&gpu.device))?;
        let engine = Engine::new(&gpu.device, &gpu.queue, technique.as_ref())?;
        Ok(Self { technique, engine, graph: Graph::new() })
    }

    fn draw(&mut self, canvas: Canvas<'_>) -> Result<(), Failure> {
        let Canvas { target, number, .. } = canvas;
        let (width, height) = (target.width(), target.height());
        let aspect = f64::from(width) / f64::from(height);
        let eye = glam::DQuat::from_rotation_y(f64::from(number) * 0.02) * DVec3::new(7.0, 5.0, 9.0);
        let projection = Projection::Perspective { fov_y: 0.7, near: 0.1, far: Some(100.0) };
        let camera = Camera::look_at(eye, DVec3::new(0.0, 1.2, 0.0), DVec3::Y, projection);
        let direction = DVec3::new(-0.6, -1.0, -0.25).normalize();
        let lights = [Light {
            name: None,
            kind: LightKind::Directional { direction },
            color: Vec3::ONE,
            intensity: 100_000.0,
            casts_shadow: true,
        }];
        let settings = ShadowSettings { distance_m: 40.0, ..ShadowSettings::default() };
        let engine = &self.engine;

        let mut frame = self.graph.frame();
        let inputs = ShadowInputs {
            view: 0,
            camera: &camera,
            aspect,
            lights: &lights,
            casters: engine,
            origin_world: DVec3::ZERO,
            settings: &settings,
        };
        let shadows = add_shadows(self.technique.as_ref(), &mut frame, &inputs, None)?;

        let view = frame.uniform(bytemuck::bytes_of(&View {
            clip_from_world: (camera.clip_from_view(aspect) * camera.view_from_world()).as_mat4(),
            eye: camera.position_world().as_vec3().extend(1.0),
            to_light: -direction.as_vec3().extend(0.0),
        }));
        let mut color = frame.import_texture("color", target, false);
        let mut depth = frame.create_texture("depth", TextureDesc::d2(width, height, Format::Depth32Float));
        let mut pass = frame.render_pass("lit");
        let shadows = shadows.read_in(&mut pass);
        pass.color(&mut color, Contents::clear_color([0.25, 0.4, 0.7, 1.0]));
        // Depth is reversed: far is 0.
        pass.depth(&mut depth, Contents::clear_depth(0.0));
        pass.body(move |ctx| {
            let boxes = Bind::ExternalBuffer(&engine.buffer);
            let own = ctx.bind_group(&engine.view_layout, &[Bind::Uniform(view), boxes])?;
            let shadows = shadows.bind_group(ctx, &engine.shadow_layout)?;
            ctx.pass.set_pipeline(&engine.lit);
            ctx.pass.set_bind_group(0, &own, &[]);
            ctx.pass.set_bind_group(1, &shadows, &[]);
            ctx.pass.draw(0..36, 0..engine.boxes.len() as u32);
            Ok(())
        });
        let compiled = self.graph.compile(frame)?;
        canvas.execute(compiled, &mut self.graph)
    }
}

fn main() -> ExitCode {
    run_example::<Tower>()
}
