//! Animations: a glTF file's, or without one those of a scene made here, in which skinned stalks sway around a point light.
//!
//! `cargo run -p shadowgraph-examples --example animate` writes out/animate/00.png to 47.png; `-- --window` plays on, and
//! `-- truck.glb` plays a file.

use glam::{DAffine3, DQuat, DVec3, Vec3, Vec4};
use shadowgraph::options::{Aov, ShadowDistance, SunChoice};
use shadowgraph::scene::animation::{Animation, Channel, Curve, Interpolation, LocalTransform};
use shadowgraph::scene::animation::{Node, Property, Skin};
use shadowgraph::scene::{AnimationSelection, Attachment, Influence, Instance, Light, LightKind};
use shadowgraph::scene::{Material, Mesh, Scene, SkinWeights, Vertex, gltf};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_examples::{Canvas, Example, Failure, run_example};
use std::f64::consts::TAU;
use std::process::ExitCode;

/// Length of the animation that is made here.
const PERIOD_S: f64 = 4.0;
const JOINTS: usize = 5;
/// Distance between joints, metres.
const JOINT_M: f64 = 0.5;

/// Animates the rotation of a node by its angle around an axis at each fraction of the period.
fn turn(scene: &mut Scene, node: usize, axis: DVec3, angle: impl Fn(f64) -> f64) -> Result<(), Failure> {
    let keys = (0..=16).map(|key| f64::from(key) / 16.0);
    let rotation = |key| DQuat::from_axis_angle(axis, angle(key)).as_quat().to_array();
    let times_s = keys.clone().map(|key| (key * PERIOD_S) as f32).collect();
    let curve = Curve::new(times_s, keys.flat_map(rotation).collect(), 4, Interpolation::Linear)?;
    scene.hierarchy.animations[0].channels.push(Channel { node, property: Property::Rotation, curve });
    Ok(())
}

/// Adds a node, and returns its index.
fn add_node(scene: &mut Scene, parent: Option<usize>, translation: DVec3) -> usize {
    let local = LocalTransform::Parts { translation, rotation: DQuat::IDENTITY, scale: DVec3::ONE };
    scene.hierarchy.nodes.push(Node { name: String::new(), parent, local, weights: vec![], skin: None });
    scene.hierarchy.nodes.len() - 1
}

/// Returns a pointed stalk along Y whose vertices follow the two joints next to them.
fn stalk() -> Result<Mesh, Failure> {
    const RINGS: u32 = 25;
    const SIDES: u32 = 12;
    let (mut vertices, mut indices, mut influences) = (Vec::new(), Vec::new(), Vec::new());
    for (ring, side) in (0..RINGS).flat_map(|ring| (0..SIDES).map(move |side| (ring, side))) {
        let at = f64::from(ring) / f64::from(RINGS - 1) * JOINTS as f64;
        let normal = DQuat::from_rotation_y(f64::from(side) / f64::from(SIDES) * -TAU) * DVec3::X;
        let radius = 0.17 * (1.0 - at / JOINTS as f64).sqrt();
        let position = (normal * radius + DVec3::Y * at * JOINT_M).as_vec3().to_array();
        vertices.push(Vertex { position, normal: normal.as_vec3().to_array(), ..Vertex::default() });
        let (joint, weight) = (at.floor().min(JOINTS as f64 - 1.0), at.fract() as f32);
        let upper = (joint + 1.0).min(JOINTS as f64 - 1.0);
        influences.push(Influence { joint: joint as u32, weight: 1.0 - weight });
        influences.push(Influence { joint: upper as u32, weight });
        if ring + 1 < RINGS {
            let [a, b] = [side, (side + 1) % SIDES].map(|side| ring * SIDES + side);
            indices.extend([a, a + SIDES, b, b, a + SIDES, b + SIDES]);
        }
    }
    let skin = SkinWeights::new(influences, 2, &vertices)?;
    Ok(Mesh { skin: Some(skin), ..Mesh::new("stalk", vertices, indices) })
}

/// Adds a stalk with its skin at a point of the floor, and animates its joints.
fn add_stalk(scene: &mut Scene, stalk: Instance, place: DVec3, phase: f64) -> Result<(), Failure> {
    let node = add_node(scene, None, place);
    let mut joints = vec![node];
    for joint in 1..JOINTS {
        joints.push(add_node(scene, Some(node + joint - 1), DVec3::Y * JOINT_M));
    }
    for joint in 0..JOINTS {
        let angle = |key: f64| 0.24 * ((key - phase - joint as f64 * 0.12) * TAU).sin();
        turn(scene, node + joint, place.cross(DVec3::Y).normalize(), angle)?;
    }
    let down = |joint| DAffine3::from_translation(DVec3::NEG_Y * JOINT_M * joint as f64);
    scene.hierarchy.nodes[node].skin = Some(scene.hierarchy.skins.len());
    scene.hierarchy.skins.push(Skin { joints, inverse_bind: (0..JOINTS).map(down).collect() });
    let object = scene.insert_instance(stalk)?;
    scene.hierarchy.instances.push(Attachment { node, object });
    Ok(())
}

/// Returns stalks around a point light that moves between them, under a low sun.
fn stalks() -> Result<Scene, Failure> {
    let mut scene = Scene::default();
    scene.hierarchy.animations.push(Animation::default());
    let centre = add_node(&mut scene, None, DVec3::ZERO);
    turn(&mut scene, centre, DVec3::Y, |key| key * TAU)?;
    let node = add_node(&mut scene, Some(centre), DVec3::new(0.8, 1.1, 0.0));
    let evening = Light::sun(DVec3::new(-0.8, -0.7, -0.5), 2_500.0);
    let kind = LightKind::Point { position_world: DVec3::ZERO, range: Some(12.0) };
    let point = Light { kind, color: Vec3::new(1.0, 0.75, 0.45), intensity: 9_000.0, ..evening.clone() };
    let object = scene.insert_light(point);
    scene.hierarchy.lights.push(Attachment { node, object });
    scene.insert_light(evening);
    let base_color = Vec4::new(0.45, 0.75, 0.25, 1.0);
    let green = scene.insert_material(Material { base_color, metallic: 0.0, ..Material::default() })?;
    let stalk = Instance::new(scene.insert_mesh(stalk()?), green, DAffine3::IDENTITY);
    for phase in (0..6).map(|number| f64::from(number) / 6.0) {
        add_stalk(&mut scene, stalk.clone(), DQuat::from_rotation_y(phase * TAU) * DVec3::X * 1.9, phase)?;
    }
    Ok(scene)
}

struct Animate {
    renderer: Renderer,
    options: ViewOptions,
    /// The time after which the animations start again.
    end_s: f64,
}

impl Example for Animate {
    const NAME: &'static str = "animate";
    const SIZE_PX: [u32; 2] = [320, 180];
    const FRAMES: u32 = 48;
    const SEQUENCE: bool = true;
    const ARGUMENT: &'static str = "a glTF or GLB file";

    fn new(gpu: &Gpu, argument: Option<&str>) -> Result<Self, Failure> {
        let mut scene = argument.map_or_else(stalks, |file| Ok(gltf::load(file.as_ref())?))?;
        scene.set_time(AnimationSelection::All, 0.0)?;
        SunChoice::default().apply(&mut scene);
        let bounds = scene.bounds();
        let middle = bounds.center().with_y(bounds.min.y);
        let half = DVec3::new(3.0, 0.0, 3.0) * bounds.radius();
        let floor = Mesh::cuboid(middle - half - DVec3::Y * 0.1, middle + half);
        let camera = scene.cameras.first().cloned().unwrap_or_else(|| scene.framing_camera(16.0 / 9.0));
        let matte = Material { base_color: Vec4::splat(0.6), metallic: 0.0, ..Material::default() };
        scene.add(floor, matte, DAffine3::IDENTITY)?;
        let end_s = f64::from(scene.hierarchy.end_s(AnimationSelection::All)).max(1.0);
        let options = ViewOptions { camera, size_px: Self::SIZE_PX, shadows: Default::default() }
            .with_shadow_distance(ShadowDistance::Auto, &scene);
        let renderer = Renderer::new(gpu, scene, &options.camera, Aov::Color)?;
        Ok(Self { renderer, options, end_s })
    }

    fn draw(&mut self, Canvas { gpu, encoder, target, number, .. }: Canvas<'_>) -> Result<(), Failure> {
        let time_s = f64::from(number) / 12.0 % self.end_s;
        let scene = self.renderer.scene_mut();
        scene.set_time(AnimationSelection::All, time_s)?;
        // A camera of the file may move too.
        self.options.camera = scene.cameras.first().unwrap_or(&self.options.camera).clone();
        self.renderer.record(gpu, encoder, target, &self.options)?;
        Ok(())
    }
}

fn main() -> ExitCode {
    run_example::<Animate>()
}
