//! A scene that is edited while it is drawn: every few frames a box appears, boxes fly around, the oldest is removed, one casts only its
//! shadow, and the colour of another changes.
//!
//! `cargo run -p shadowgraph-examples --example edit_scene` writes out/edit_scene/00.png to 71.png; `-- --window` goes on.

use glam::{DAffine3, DVec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::scene::{
    Camera, EditError, Instance, InstanceKey, Light, Material, MaterialKey, Mesh, MeshKey, Projection, Scene,
    ShadowCasting,
};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use std::collections::VecDeque;
use std::process::ExitCode;

/// The number of boxes at a time.
const BOXES: usize = 7;
/// Frames between two boxes that appear.
const FRAMES_PER_BOX: u32 = 10;

struct EditScene {
    renderer: Renderer,
    options: ViewOptions,
    cube: MeshKey,
    white: MaterialKey,
    changing: MaterialKey,
    /// The boxes and the frames in which they appeared, the oldest first.
    boxes: VecDeque<(InstanceKey, u32)>,
}

/// Returns the transform of a box some frames after it appeared.
fn transform(age: u32) -> DAffine3 {
    let angle = f64::from(age) * 0.05;
    let position = DVec3::new(angle.cos() * 3.0, 0.9 + 0.5 * (angle * 2.0).sin(), angle.sin() * 3.0);
    DAffine3::from_translation(position) * DAffine3::from_rotation_y(-angle * 3.0)
}

impl EditScene {
    /// Edits the scene for a frame.
    fn edit(&mut self, frame: u32) -> Result<(), EditError> {
        let scene = self.renderer.scene_mut();
        for (key, born) in &self.boxes {
            scene.move_instance(*key, transform(frame - born))?;
        }
        if frame.is_multiple_of(FRAMES_PER_BOX) {
            let material = if self.boxes.len().is_multiple_of(2) { self.white } else { self.changing };
            let mut instance = Instance::new(self.cube, material, transform(0));
            if frame.is_multiple_of(4 * FRAMES_PER_BOX) {
                instance.casts = ShadowCasting::ShadowOnly;
            }
            self.boxes.push_back((scene.insert_instance(instance)?, frame));
        }
        if self.boxes.len() > BOXES
            && let Some((oldest, _)) = self.boxes.pop_front()
        {
            scene.remove_instance(oldest)?;
        }
        let red = 0.5 + 0.5 * (frame as f32 * 0.2).sin();
        scene.edit_material(self.changing, |material| {
            material.base_color = Vec4::new(red, 0.15, 1.0 - red, 1.0);
        })
    }
}

impl Example for EditScene {
    const NAME: &'static str = "edit_scene";
    const SIZE_PX: [u32; 2] = [320, 180];
    const FRAMES: u32 = 72;
    const SEQUENCE: bool = true;

    fn new(gpu: &Gpu, _argument: Option<&str>) -> Result<Self, Failure> {
        let matte = |value: f32| Material {
            base_color: Vec4::new(value, value, value, 1.0),
            metallic: 0.0,
            ..Material::default()
        };
        let mut scene = Scene::default();
        let floor = Mesh::cuboid(DVec3::new(-8.0, -0.2, -8.0), DVec3::new(8.0, 0.0, 8.0));
        scene.add(floor, matte(0.6), DAffine3::IDENTITY)?;
        let cube = scene.insert_mesh(Mesh::cuboid(DVec3::splat(-0.5), DVec3::splat(0.5)));
        let (white, changing) = (scene.insert_material(matte(0.85))?, scene.insert_material(matte(0.5))?);
        scene.insert_light(Light::sun(DVec3::new(0.6, -1.0, -0.4), 60_000.0));
        let projection = Projection::Perspective { fov_y: 0.75, near: 0.1, far: None };
        let camera = Camera::look_at(DVec3::new(0.0, 6.5, 9.5), DVec3::Y * 0.2, DVec3::Y, projection);
        let options = ViewOptions { camera, size_px: Self::SIZE_PX, shadows: Default::default() };
        let renderer = Renderer::new(gpu, scene, &options.camera, Aov::Color)?;
        Ok(Self { renderer, options, cube, white, changing, boxes: VecDeque::new() })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, number, .. }: Canvas<'_>) -> Result<(), Failure> {
        self.edit(number)?;
        self.renderer.record(gpu, encoder, target, &self.options)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<EditScene>()
}
