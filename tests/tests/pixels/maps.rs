//! Reads shadow maps back.

use crate::stage::gpu;
use shadowgraph::core::{Frame, Graph, PassKind};
use shadowgraph::scene::Camera;
use shadowgraph::shadows::{
    Pcf, ShadowCasters, ShadowInputs, ShadowPlan, ShadowSettings, add_shadows, plan_shadows,
};
use shadowgraph::{Gpu, SceneCasters};

/// A map and the plan by which it was rendered.
pub(crate) struct Map {
    pub(crate) plan: ShadowPlan,
    pub(crate) size_px: [u32; 2],
    pub(crate) depth: Vec<f32>,
}

impl Map {
    pub(crate) fn depth_at(&self, x: u32, y: u32) -> f32 {
        self.depth[(y * self.size_px[0] + x) as usize]
    }
}

/// Renders the map `name` and reads it back.
pub(crate) fn draw_map(
    gpu: &Gpu,
    technique: &Pcf,
    casters: &dyn ShadowCasters,
    lights: &[shadowgraph::scene::Light],
    camera: &Camera,
    settings: &ShadowSettings,
    name: &str,
) -> Map {
    let origin_world = glam::DVec3::ZERO;
    let inputs =
        ShadowInputs { view: 0, camera, aspect: 16.0 / 9.0, lights, casters, origin_world, settings };
    let plan = plan_shadows(&inputs).unwrap();
    let mut frame = Frame::new();
    add_shadows(technique, &mut frame, &inputs, None).unwrap();
    let map = &frame.find_texture(name).unwrap();
    let size = frame.texture_desc(map).unwrap().size;
    let size_px = [size.width, size.height];
    let row_bytes = (size.width * 4).next_multiple_of(256);
    let buffer = gpu.device.create_buffer(&shadowgraph::wgpu::BufferDescriptor {
        label: None,
        size: u64::from(row_bytes * size.height),
        usage: shadowgraph::wgpu::BufferUsages::MAP_READ | shadowgraph::wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    });
    let mut target = frame.import_buffer("read back", &buffer, false);
    frame.copy_pass("read back").texture_to_buffer(map, &mut target);
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    frame.compile().unwrap().execute(&mut Graph::new(), &gpu.device, &mut encoder).unwrap();
    gpu.queue.submit([encoder.finish()]);
    buffer.slice(..).map_async(shadowgraph::wgpu::MapMode::Read, |_| ());
    gpu.device.poll(shadowgraph::wgpu::PollType::wait_indefinitely()).unwrap();
    let bytes = buffer.get_mapped_range(..).unwrap();
    let rows = bytes.chunks_exact(row_bytes as usize).map(|row| &row[..size.width as usize * 4]);
    let depth =
        rows.flat_map(|row| row.chunks_exact(4).map(|b| f32::from_le_bytes(b.try_into().unwrap()))).collect();
    Map { plan, size_px, depth }
}

#[test]
fn without_a_caster_in_range_there_is_no_pass_and_a_map_of_one_lit_texel() {
    let Some(gpu) = gpu() else { return };
    let scene = shadowgraph::scene::Scene::default();
    let camera = crate::stage::camera(glam::DVec3::Z, glam::DVec3::ZERO);
    let upload =
        shadowgraph::scene::gpu::GpuScene::new(&gpu.device, &gpu.queue, &scene, glam::DVec3::ZERO).unwrap();
    let casters = SceneCasters::new(&gpu.device, upload).unwrap();
    let technique = Pcf::new(&gpu.device);
    let lights = [crate::stage::sun(glam::DVec3::NEG_Y)];
    let settings = ShadowSettings::default();
    let inputs = ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 1.0,
        lights: &lights,
        casters: &casters,
        origin_world: glam::DVec3::ZERO,
        settings: &settings,
    };
    let mut frame = Frame::new();
    let outputs = add_shadows(&technique, &mut frame, &inputs, None).unwrap();
    for (name, map) in &outputs.debug {
        let size = frame.texture_desc(map).unwrap().size;
        assert_eq!((size.width, size.height), (1, 1), "{name}");
    }
    let plan = frame.compile().unwrap().into_plan();
    assert!(plan.passes().all(|(_, pass)| pass.kind != PassKind::Render), "{}", plan.to_text());
}
