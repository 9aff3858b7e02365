//! The technique `raytraced` on a GPU: equal to rays of the CPU and to a brute-force test of all triangles.

use crate::scenes::{RealScene, real_scenes};
use crate::stage::{
    SIZE_PX, add_instance, add_mesh, box_mesh, floor_mesh, gpu, light, material, move_instances, nth_instance,
};
use glam::{DAffine3, DQuat, DVec3, EulerRot, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::scene::{
    AlphaMode, Camera, Image, Instance, InstanceKey, LightKind, Mesh, Projection, Scene, TextureRef,
};
use shadowgraph::shadows::RAYTRACED;
use shadowgraph::shadows::rays::{LightShape, ReceiverPoint};
use shadowgraph::{Gpu, Renderer, SceneRays, ViewOptions};
use shadowgraph_quality::{GroundTruth, RayLight, SurfaceReader, Surfaces, built_in_cases};
use shadowgraph_samples::test_scenes::test_scene;

/// The mask and the image have 8 bits each.
const ROUNDING: f32 = 1.2 / 255.0;

/// A light's visibility in a view by the technique: the mean of the colours, `None` where no surface can be lit.
pub(crate) struct Traced {
    pub(crate) visibility: Vec<Option<f32>>,
    surfaces: Surfaces,
    light: RayLight,
    rays: SceneRays,
    eye: glam::Vec3,
}

fn traced(gpu: &Gpu, scene: &Scene, camera: &Camera, light: usize) -> Traced {
    let options = ViewOptions { camera: camera.clone(), size_px: SIZE_PX, shadows: Default::default() };
    let aov = Aov::Visibility(light as u32);
    let mut renderer = Renderer::with_config(gpu, scene.clone(), camera, aov, RAYTRACED).unwrap();
    traced_by(gpu, &mut renderer, &options, light)
}

/// Draws with a renderer whose output is the visibility of the light.
pub(crate) fn traced_by(gpu: &Gpu, renderer: &mut Renderer, options: &ViewOptions, light: usize) -> Traced {
    let image = renderer.draw(gpu, &crate::stage::hard(options)).unwrap().image;
    let surfaces = SurfaceReader::new(gpu, renderer).unwrap().read(gpu, renderer, options).unwrap();
    let origin_world = renderer.casters().scene.origin_world();
    let drawn = image.rgba8.chunks_exact(4);
    Traced {
        visibility: drawn.map(|texel| (texel[3] > 0).then_some(f32::from(texel[0]) / 255.0)).collect(),
        surfaces,
        light: RayLight::new(&renderer.scene().lights()[light], 0.0, origin_world),
        rays: SceneRays::new(renderer.scene(), origin_world).unwrap(),
        eye: (options.camera.position_world() - origin_world).as_vec3(),
    }
}

impl Traced {
    /// Returns the number of pixels that differ from `truth`, and the number of pixels.
    fn unlike(&self, truth: &[f32], reached: &[f32]) -> (usize, usize) {
        // Outside of a spot light's cone the CPU traces no ray.
        let pairs = self.visibility.iter().zip(truth).zip(reached).filter(|(_, n_dot_l)| **n_dot_l > 0.0);
        let known = pairs.filter_map(|((seen, truth), _)| Some(((*seen)? - truth).abs() < ROUNDING));
        known.fold((0, 0), |(unlike, all), same| (unlike + usize::from(!same), all + 1))
    }

    /// Returns the number of pixels that differ from rays of the CPU through new trees, and the number of pixels.
    pub(crate) fn unlike_the_cpu(&self) -> (usize, usize) {
        let truth = GroundTruth::trace(self.rays.rays(), &self.surfaces, &self.light, self.eye);
        self.unlike(&truth.hard, &truth.n_dot_l)
    }

    /// Tests every triangle.
    fn unlike_brute_force(&self) -> (usize, usize) {
        let n_dot_l = GroundTruth::trace(self.rays.rays(), &self.surfaces, &self.light, self.eye).n_dot_l;
        let truth = (0..n_dot_l.len()).map(|pixel| {
            let position = self.surfaces.positions[pixel];
            let receiver = ReceiverPoint {
                position,
                geometric_normal: self.surfaces.normals[pixel],
                view_distance_m: position.distance(self.eye),
            };
            let ray = self.light.shape.ray(self.rays.rays(), &receiver, glam::Vec2::ZERO);
            ray.map_or(0.0, |ray| self.rays.rays().transmittance_brute_force(&ray).element_sum() / 3.0)
        });
        let truth: Vec<f32> = truth.collect();
        self.unlike(&truth, &n_dot_l)
    }
}

/// Asserts that at most 0.01 % of the image's pixels differ.
fn assert_agree(name: &str, (unlike, compared): (usize, usize)) {
    println!("{name}: {unlike} of {compared} pixels differ");
    let most = (SIZE_PX[0] * SIZE_PX[1]) as usize / 10_000;
    assert!(unlike <= most, "{name}: {unlike} of {compared} pixels differ; allowed are {most}");
}

#[test]
fn in_every_test_scene_gpu_rays_match_cpu_rays_and_brute_force() {
    let Some(gpu) = gpu() else { return };
    for case in built_in_cases().unwrap().cases {
        let mut scene = test_scene(&case.name()).unwrap();
        scene.insert_light(case.sun(30.0));
        let traced = traced(gpu, &scene, &case.views[0].camera(), 0);
        let (unlike, compared) = traced.unlike_the_cpu();
        assert!(compared > 5_000, "{}: {compared} pixels", case.name());
        assert_agree(&case.name(), (unlike, compared));
        if scene.triangle_count() < 1_000 {
            assert_agree(&format!("{}, by brute force", case.name()), traced.unlike_brute_force());
        }
    }
}

#[test]
fn gpu_and_cpu_rays_agree_for_spot_and_point_lights_and_alpha_masks() {
    let Some(gpu) = gpu() else { return };
    let scene = leaf_scene();
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
    let camera = Camera::look_at(DVec3::new(2.0, 3.0, 4.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y, projection);
    for light in 0..scene.lights().len() {
        let traced = traced(gpu, &scene, &camera, light);
        let dark = traced.visibility.iter().filter(|seen| **seen == Some(0.0)).count();
        assert!(dark > 500, "light {light} casts a shadow of {dark} pixels");
        assert_agree(&format!("light {light}"), traced.unlike_the_cpu());
        assert_agree(&format!("light {light}, by brute force"), traced.unlike_brute_force());
        let shape = traced.light.shape;
        assert_eq!(matches!(shape, LightShape::Directional { .. }), light == 0);
    }
}

/// A plate with a checkered alpha texture over a floor, under a sun, a spot and a point light.
fn leaf_scene() -> Scene {
    let texel =
        |index: u32| [255, 255, 255, if (index % 8 + index / 8).is_multiple_of(2) { 255 } else { 30 }];
    let rgba8 = (0..64).flat_map(texel).collect();
    let checkered = Image::new("", 8, 8, rgba8);
    let mut scene = Scene::default();
    scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(6.0), DVec3::ZERO);
    let checkered = scene.insert_image(checkered).unwrap();
    let holes = shadowgraph::scene::Material {
        base_color: Vec4::ONE,
        base_color_texture: Some(TextureRef::new(checkered)),
        alpha: AlphaMode::Mask { cutoff: 0.5 },
        double_sided: true,
        ..material()
    };
    let holes = scene.insert_material(holes).unwrap();
    let plate = scene.insert_mesh(box_mesh(DVec3::new(-1.0, 1.0, -1.0), DVec3::new(1.0, 1.02, 1.0)));
    add_instance(&mut scene, plate, holes, DVec3::ZERO);
    let position_world = DVec3::new(0.7, 3.0, 0.4);
    let direction = -position_world.normalize();
    let spot = LightKind::Spot { position_world, direction, range: None, inner_angle: 0.4, outer_angle: 0.6 };
    let sun = LightKind::Directional { direction: DVec3::new(0.3, -1.0, -0.2).normalize() };
    let point = LightKind::Point { position_world: DVec3::new(-0.5, 2.4, 0.3), range: None };
    for kind in [sun, spot, point] {
        scene.insert_light(light(kind, 100.0));
    }
    scene
}

/// A number from 0 to 1 that looks random.
fn random(seed: &mut u32) -> f64 {
    *seed = seed.wrapping_mul(0x9e37_79b9).wrapping_add(0x85eb_ca6b);
    f64::from((*seed ^ *seed >> 15).wrapping_mul(0x2c1b_3c6d) >> 8) / f64::from(1 << 24)
}

/// Returns any turn, a scale from a third to three along each axis, and a place above the floor around `center`.
fn random_transform(seed: &mut u32, center: DVec3) -> DAffine3 {
    let turn = DQuat::from_euler(EulerRot::YXZ, 6.0 * random(seed), 6.0 * random(seed), 0.0);
    let scale = DVec3::from([(); 3].map(|()| 3f64.powf(2.0 * random(seed) - 1.0)));
    let at = DVec3::new(4.0 * random(seed) - 2.0, 0.5 + 1.5 * random(seed), 4.0 * random(seed) - 2.0);
    DAffine3::from_scale_rotation_translation(scale, turn, center + at)
}

/// Makes a random edit of everything but the floor. `boxes` are the keys of the rest.
fn random_edit(scene: &mut Scene, boxes: &mut Vec<InstanceKey>, seed: &mut u32, center: DVec3) {
    let chosen = boxes[(random(seed) * boxes.len() as f64) as usize];
    let Instance { mesh, material, .. } = scene.instance(chosen).unwrap().clone();
    match (random(seed) * 8.0) as u32 {
        0 => boxes.push(
            scene.insert_instance(Instance::new(mesh, material, random_transform(seed, center))).unwrap(),
        ),
        1 if boxes.len() > 2 => {
            boxes.retain(|key| *key != chosen);
            scene.remove_instance(chosen).unwrap();
        }
        2 => scene.edit_instance(chosen, |instance| instance.visible = !instance.visible).unwrap(),
        3 => {
            // A pose: the same triangles, bent.
            let mut bent = scene.mesh(mesh).unwrap().clone();
            bent.vertices.iter_mut().for_each(|vertex| vertex.position[0] += 0.3 * vertex.position[1]);
            scene.replace_mesh(mesh, Mesh::new("bent", bent.vertices, bent.indices)).unwrap();
        }
        4 => drop(
            scene.replace_mesh(mesh, box_mesh(DVec3::splat(-0.5 * random(seed)), DVec3::splat(0.5))).unwrap(),
        ),
        5 => scene
            .edit_material(material, |material| {
                let mask = AlphaMode::Mask { cutoff: 0.5 };
                material.alpha = if material.alpha == mask { AlphaMode::Opaque } else { mask };
            })
            .unwrap(),
        _ => scene.move_instance(chosen, random_transform(seed, center)).unwrap(),
    }
}

#[test]
fn gpu_rays_through_a_randomly_edited_scene_match_cpu_rays_through_new_trees() {
    let Some(gpu) = gpu() else { return };
    let mut scene = leaf_scene();
    let cube = scene.insert_mesh(box_mesh(DVec3::splat(-0.4), DVec3::splat(0.4)));
    let plain = scene.insert_material(material()).unwrap();
    let mut boxes = vec![nth_instance(&scene, 1)];
    let (mut seed, mut center) = (7, DVec3::ZERO);
    for _ in 0..4 {
        let placed = Instance::new(cube, plain, random_transform(&mut seed, DVec3::ZERO));
        boxes.push(scene.insert_instance(placed).unwrap());
    }
    let projection = Projection::Perspective { fov_y: 0.9, near: 0.1, far: None };
    let camera = Camera::look_at(DVec3::new(2.0, 3.0, 4.0), DVec3::new(0.0, 0.5, 0.0), DVec3::Y, projection);
    let mut options = ViewOptions { camera, size_px: [160, 90], shadows: Default::default() };
    let mut renderer =
        Renderer::with_config(gpu, scene, &options.camera, Aov::Visibility(0), RAYTRACED).unwrap();
    let (mut unlike, mut compared, mut dark) = (0, 0, Vec::new());
    for frame in 0..40 {
        for _ in 0..frame % 4 {
            random_edit(renderer.scene_mut(), &mut boxes, &mut seed, center);
        }
        if frame == 20 {
            // Into another cell of the origin's grid, with everything else.
            center = DVec3::new(3000.0, 0.0, -5000.0);
            move_instances(renderer.scene_mut(), center);
            options.camera.world_from_view.translation += center;
        }
        let traced = traced_by(gpu, &mut renderer, &options, 0);
        let (differ, of) = traced.unlike_the_cpu();
        (unlike, compared) = (unlike + differ, compared + of);
        dark.push(traced.visibility.iter().filter(|seen| **seen == Some(0.0)).count());
    }
    dark.dedup();
    println!("{unlike} of {compared} pixels differ over 40 frames, with {} different shadows", dark.len());
    assert!(compared > 200_000 && dark.len() > 10, "{compared} pixels compared, shadows of {dark:?} pixels");
    assert!(unlike * 10_000 <= compared, "{unlike} of {compared} pixels differ");
}

#[test]
fn in_every_real_scene_gpu_rays_match_cpu_rays() {
    let Some(gpu) = gpu() else { return };
    for RealScene { name, scene, camera } in real_scenes().unwrap_or_default() {
        let Some(casts) = scene.lights().iter().position(|light| light.casts_shadow) else { continue };
        assert_agree(name, traced(gpu, scene, camera, casts).unlike_the_cpu());
    }
}
