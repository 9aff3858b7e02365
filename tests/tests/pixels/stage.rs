//! The shared device and simple scenes to render.

use glam::{DAffine3, DVec3, Vec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::scene::gpu::GpuScene;
use shadowgraph::scene::{
    AlphaMode, Camera, Instance, InstanceKey, Light, LightKind, Material, MaterialKey, Mesh, MeshKey,
    Projection, Scene, Vertex, origin_near,
};
use shadowgraph::shadows::{PCF, RaytracedSettings, ShadowInputs, ShadowPlan, ShadowSettings, plan_shadows};
use shadowgraph::{Gpu, RenderConfig, RenderedFrame, Renderer, SceneCasters, ViewOptions};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{LazyLock, Mutex, OnceLock};

pub(crate) const SIZE_PX: [u32; 2] = [320, 180];

/// The devices that the tests share. A device of a software driver compiles its shaders on one thread, so several compile at once.
const DEVICES: usize = 4;
static USERS: [AtomicUsize; DEVICES] = [const { AtomicUsize::new(0) }; DEVICES];

/// The use of a device by the thread of a test, until the thread ends.
struct DeviceUse(usize);

impl DeviceUse {
    /// Takes the device that the fewest threads use.
    fn new() -> Self {
        let index = (0..DEVICES).min_by_key(|index| USERS[*index].load(Ordering::Relaxed)).unwrap_or(0);
        USERS[index].fetch_add(1, Ordering::Relaxed);
        Self(index)
    }
}

impl Drop for DeviceUse {
    fn drop(&mut self) {
        USERS[self.0].fetch_sub(1, Ordering::Relaxed);
    }
}

/// Returns the device of this test, or `None` after reporting a skip.
pub(crate) fn gpu() -> Option<&'static Gpu> {
    static GPUS: [OnceLock<Result<Gpu, String>>; DEVICES] = [const { OnceLock::new() }; DEVICES];
    thread_local! {
        static USE: DeviceUse = DeviceUse::new();
    }
    let open = || Gpu::open(&shadowgraph_tests::adapter()).map_err(|error| error.to_string());
    match GPUS[USE.with(|device| device.0)].get_or_init(open) {
        Ok(gpu) => Some(gpu),
        Err(reason) => {
            shadowgraph_tests::skip("pixels", reason);
            None
        }
    }
}

/// Returns the options with one ray per pixel for traced shadows: the reference for hard shadows.
pub(crate) fn hard(options: &ViewOptions) -> ViewOptions {
    let mut options = options.clone();
    options.shadows.techniques.set(&RaytracedSettings::hard()).unwrap();
    options
}

/// Returns a box from `min` to `max` with faces outwards.
pub(crate) fn box_mesh(min: DVec3, max: DVec3) -> Mesh {
    let (mut vertices, mut indices) = (Vec::new(), Vec::new());
    for axis in 0..3 {
        for side in [0, 1] {
            let (u, v) = ((axis + 1) % 3, (axis + 2) % 3);
            let base = vertices.len() as u32;
            for (cu, cv) in [(0, 0), (1, 0), (1, 1), (0, 1)] {
                let mut corner = [0; 3];
                (corner[axis], corner[u], corner[v]) = (side, cu, cv);
                let at = |i: usize| if corner[i] == 0 { min[i] } else { max[i] };
                let mut normal = [0.0; 3];
                normal[axis] = if side == 0 { -1.0 } else { 1.0 };
                vertices.push(vertex(DVec3::new(at(0), at(1), at(2)), normal));
            }
            let quad = if side == 1 { [0, 1, 2, 0, 2, 3] } else { [0, 2, 1, 0, 3, 2] };
            indices.extend(quad.map(|i| base + i));
        }
    }
    Mesh::new("box", vertices, indices)
}

/// Returns a square of half width `half` in the plane y = 0, facing up.
pub(crate) fn floor_mesh(half: f64) -> Mesh {
    let corners = [(-1.0, -1.0), (-1.0, 1.0), (1.0, 1.0), (1.0, -1.0)];
    let vertices = corners.map(|(x, z)| vertex(DVec3::new(x * half, 0.0, z * half), [0.0, 1.0, 0.0]));
    Mesh::new("floor", vertices.to_vec(), vec![0, 1, 2, 0, 2, 3])
}

pub(crate) fn vertex(position: DVec3, normal: [f32; 3]) -> Vertex {
    Vertex {
        position: position.as_vec3().to_array(),
        normal,
        tangent: [1.0, 0.0, 0.0, 1.0],
        uv0: [position.x as f32, position.z as f32],
        uv1: [0.0; 2],
        color: Vertex::WHITE,
    }
}

pub(crate) fn material() -> Material {
    Material { base_color: Vec4::new(0.8, 0.8, 0.8, 1.0), alpha: AlphaMode::Opaque, ..Material::default() }
}

/// Returns a floor at y = 0 and a cube of 1 m on it, moved by `offset`.
pub(crate) fn cube_on_floor(offset: DVec3) -> Scene {
    let mut scene = Scene::default();
    scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(20.0), offset);
    add_mesh(&mut scene, box_mesh(CUBE_MIN, CUBE_MAX), offset);
    scene
}

pub(crate) const CUBE_MIN: DVec3 = DVec3::new(-0.5, 0.0, -0.5);
pub(crate) const CUBE_MAX: DVec3 = DVec3::new(0.5, 1.0, 0.5);

/// Adds an instance of a mesh.
pub(crate) fn add_instance(
    scene: &mut Scene,
    mesh: MeshKey,
    material: MaterialKey,
    at: DVec3,
) -> InstanceKey {
    scene.insert_instance(Instance::new(mesh, material, DAffine3::from_translation(at))).unwrap()
}

/// Adds a mesh and an instance of it, with the scene's only material.
pub(crate) fn add_mesh(scene: &mut Scene, mesh: Mesh, at: DVec3) -> MeshKey {
    let (mesh, material) = (scene.insert_mesh(mesh), only_material(scene));
    add_instance(scene, mesh, material, at);
    mesh
}

/// Adds another instance of the cube of [`cube_on_floor`].
pub(crate) fn add_cube(scene: &mut Scene, at: DVec3) -> InstanceKey {
    let (mesh, material) = (nth_mesh(scene, 1), only_material(scene));
    add_instance(scene, mesh, material, at)
}

/// Moves all instances, and nothing else.
pub(crate) fn move_instances(scene: &mut Scene, offset: DVec3) {
    let keys: Vec<_> = scene.instances().map(|(key, _)| key).collect();
    for key in keys {
        scene.edit_instance(key, |instance| instance.world_from_local.translation += offset).unwrap();
    }
}

/// Returns the mesh that was inserted after `n` others.
pub(crate) fn nth_mesh(scene: &Scene, n: usize) -> MeshKey {
    scene.meshes().nth(n).unwrap().0
}

/// Returns the material that was inserted after `n` others.
pub(crate) fn nth_material(scene: &Scene, n: usize) -> MaterialKey {
    scene.materials().nth(n).unwrap().0
}

/// Returns the instance that was inserted after `n` others.
pub(crate) fn nth_instance(scene: &Scene, n: usize) -> InstanceKey {
    scene.instances().nth(n).unwrap().0
}

/// Returns the material of a scene that has no other.
pub(crate) fn only_material(scene: &Scene) -> MaterialKey {
    assert_eq!(scene.materials().len(), 1);
    nth_material(scene, 0)
}

/// Returns the direction in which the light of a sun at `elevation_deg` above the horizon travels.
pub(crate) fn sun_direction(elevation_deg: f64, azimuth_deg: f64) -> DVec3 {
    let (elevation, azimuth) = (elevation_deg.to_radians(), azimuth_deg.to_radians());
    -DVec3::new(azimuth.sin() * elevation.cos(), elevation.sin(), azimuth.cos() * elevation.cos())
}

pub(crate) fn sun(direction: DVec3) -> Light {
    light(LightKind::Directional { direction }, 20_000.0)
}

pub(crate) fn light(kind: LightKind, intensity: f32) -> Light {
    Light { name: None, kind, color: Vec3::ONE, intensity, casts_shadow: true }
}

pub(crate) fn camera(eye: DVec3, target: DVec3) -> Camera {
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: Some(100.0) };
    Camera::look_at(eye, target, DVec3::Y, projection)
}

pub(crate) fn view(camera: Camera, distance_m: f32) -> ViewOptions {
    let shadows = ShadowSettings { distance_m, ..ShadowSettings::default() };
    ViewOptions { camera, size_px: SIZE_PX, shadows }
}

/// Makes shadow maps small, for images that are compared with one another.
pub(crate) fn with_coarse_maps(mut options: ViewOptions) -> ViewOptions {
    (options.shadows.cascades.map_size_px, options.shadows.atlas.map_size_px) = (512, 1024);
    options
}

pub(crate) fn draw(gpu: &Gpu, scene: Scene, aov: Aov, options: &ViewOptions) -> RenderedFrame {
    draw_with(gpu, &scene, aov, options, PCF)
}

/// Draws an image that does not depend on frames before it. Renderers compile their shaders, so one that a test has created is used
/// again: as it is for the same objects, whatever their lights, else with the other scene.
pub(crate) fn draw_with(
    gpu: &Gpu,
    scene: &Scene,
    aov: Aov,
    options: &ViewOptions,
    config: impl Into<RenderConfig>,
) -> RenderedFrame {
    /// The device, by its address here (those of several instances are equal in wgpu), and the configuration.
    type RendererKey = (usize, RenderConfig);
    /// Renderers that no test uses at the moment, the latest last.
    static IDLE: Mutex<Vec<(RendererKey, Renderer)>> = Mutex::new(Vec::new());
    const MAX_IDLE: usize = 8;

    let key = (std::ptr::from_ref(gpu).addr(), config.into());
    let origin_world = origin_near(options.camera.position_world());
    let fits = |(of, renderer): &(RendererKey, Renderer)| *of == key && *renderer.aov() == aov;
    let is_ready = |renderer: &Renderer| {
        renderer.casters().scene.origin_world() == origin_world && has_same_objects(renderer.scene(), scene)
    };
    let mut idle = IDLE.lock().unwrap();
    let ready = idle.iter().position(|entry| fits(entry) && is_ready(&entry.1));
    let found = ready.or_else(|| idle.iter().rposition(fits)).map(|index| idle.remove(index).1);
    drop(idle);
    let mut renderer = match found {
        Some(mut renderer) if ready.is_some() => {
            renderer.scene_mut().set_lights(scene.lights().to_vec());
            renderer
        }
        Some(mut renderer) => {
            renderer.set_scene(gpu, scene.clone()).unwrap();
            renderer
        }
        None => Renderer::with_config(gpu, scene.clone(), &options.camera, aov, key.1.clone()).unwrap(),
    };
    let drawn = renderer.draw(gpu, options).unwrap();
    let mut idle = IDLE.lock().unwrap();
    if idle.len() == MAX_IDLE {
        idle.remove(0);
    }
    idle.push((key, renderer));
    drawn
}

fn has_same_objects(a: &Scene, b: &Scene) -> bool {
    a.meshes().eq(b.meshes())
        && a.materials().eq(b.materials())
        && a.images().eq(b.images())
        && a.instances().eq(b.instances())
}

/// Plans the shadows of a view, without a driver.
pub(crate) fn plan(scene: &Scene, options: &ViewOptions) -> ShadowPlan {
    static GPU: LazyLock<Gpu> = LazyLock::new(|| Gpu::noop().unwrap());
    let origin_world = origin_near(options.camera.position_world());
    let uploaded = GpuScene::new(&GPU.device, &GPU.queue, scene, origin_world).unwrap();
    plan_shadows(&ShadowInputs {
        view: 0,
        camera: &options.camera,
        aspect: f64::from(options.size_px[0]) / f64::from(options.size_px[1]),
        lights: scene.lights(),
        casters: &SceneCasters::new(&GPU.device, uploaded).unwrap(),
        origin_world,
        settings: &options.shadows,
    })
    .unwrap()
}

/// Returns the origin and the direction of the ray through a pixel's centre, in world space.
pub(crate) fn pixel_ray(options: &ViewOptions, x: u32, y: u32) -> (DVec3, DVec3) {
    let [width, height] = options.size_px.map(f64::from);
    let Projection::Perspective { fov_y, .. } = options.camera.projection else {
        panic!("a perspective view")
    };
    let half = (fov_y * 0.5).tan();
    let right = ((f64::from(x) + 0.5) / width * 2.0 - 1.0) * half * width / height;
    let up = (1.0 - (f64::from(y) + 0.5) / height * 2.0) * half;
    let direction = options.camera.world_from_view.transform_vector3(DVec3::new(right, up, -1.0));
    (options.camera.position_world(), direction.normalize())
}

/// Returns the distance at which a ray enters a box, and the normal of the face.
pub(crate) fn ray_box(origin: DVec3, direction: DVec3, min: DVec3, max: DVec3) -> Option<(f64, DVec3)> {
    let (to_min, to_max) = ((min - origin) / direction, (max - origin) / direction);
    let (near, far) = (to_min.min(to_max), to_min.max(to_max));
    let (enter, leave) = (near.max_element(), far.min_element());
    let axis = (0..3).find(|&i| near[i] == enter)?;
    let mut normal = DVec3::ZERO;
    normal[axis] = -direction[axis].signum();
    (leave > enter && leave > 1e-9).then_some((enter, normal))
}
