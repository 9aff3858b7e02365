//! Edits of a scene, and what they upload.

use glam::{DAffine3, DQuat, DVec3, Vec3};
use proptest::prelude::*;
use shadowgraph_shadows::rays::{
    Cutout, Filter, GpuRayScene, Instance, Ray, RayInstanceKey, RayMeshKey, RayScene, RaySurfacesKey,
    Surface, Wrap,
};

use crate::common::{sphere, texture};
use crate::levels::transform;

/// An edit, with numbers that choose what is edited.
#[derive(Clone, Debug)]
enum Edit {
    Insert(usize, bool, DAffine3),
    Move(usize, DAffine3),
    Remove(usize),
    Pose(usize, f32),
    Replace(usize, u32),
    Origin(DVec3),
    Rebuild,
}

fn edit() -> impl Strategy<Value = Edit> {
    let origin = prop::array::uniform3(-2..3).prop_map(|at| DVec3::from(at.map(f64::from)) * 4.0);
    prop_oneof![
        4 => (any::<usize>(), any::<bool>(), transform()).prop_map(|(mesh, cut, at)| Edit::Insert(mesh, cut, at)),
        4 => (any::<usize>(), transform()).prop_map(|(instance, at)| Edit::Move(instance, at)),
        2 => any::<usize>().prop_map(Edit::Remove),
        2 => (any::<usize>(), -0.5f32..9.0).prop_map(|(mesh, bend)| Edit::Pose(mesh, bend)),
        1 => (any::<usize>(), 0u32..3).prop_map(|(mesh, times)| Edit::Replace(mesh, times)),
        1 => origin.prop_map(Edit::Origin),
        1 => Just(Edit::Rebuild),
    ]
}

/// A scene that is edited, and what it should contain.
struct World {
    scene: RayScene,
    meshes: Vec<(RayMeshKey, Vec<[Vec3; 3]>)>,
    instances: Vec<(RayInstanceKey, usize, bool, DAffine3)>,
}

/// Returns surfaces with holes where v is below 0.5.
fn holes(scene: &mut RayScene, count: usize) -> RaySurfacesKey {
    let alpha = texture([1, 2], &[0, 255], Wrap::Repeat, Filter::Nearest);
    let texture = Some(scene.insert_texture(&[alpha]).unwrap());
    let uv = [[0.0, 0.0], [0.0, 0.0], [0.0, 0.9]].map(Into::into);
    let cutout = Cutout { texture, uv, alpha: [1.0; 3], cutoff: 0.5 };
    scene.insert_surfaces(&vec![Surface::Cutout(cutout); count]).unwrap()
}

impl World {
    fn new() -> Self {
        let mut scene = RayScene::default();
        let meshes = [0, 1].map(|times| (scene.insert_mesh(&sphere(times)).unwrap(), sphere(times)));
        Self { scene, meshes: meshes.into(), instances: Vec::new() }
    }

    fn apply(&mut self, edit: &Edit) {
        let placed = self.instances.len().max(1);
        match *edit {
            Edit::Insert(mesh, cut, at) => {
                let mesh = mesh % 2;
                let count = self.meshes[mesh].1.len();
                let surfaces = cut.then(|| holes(&mut self.scene, count));
                let instance = Instance { mesh: self.meshes[mesh].0, surfaces, world_from_mesh: at };
                self.instances.push((self.scene.insert_instance(instance).unwrap(), mesh, cut, at));
            }
            Edit::Move(index, at) => {
                if let Some(instance) = self.instances.get_mut(index % placed) {
                    instance.3 = at;
                    self.scene.set_transform(instance.0, at).unwrap();
                }
            }
            Edit::Remove(index) if !self.instances.is_empty() => {
                let (key, ..) = self.instances.swap_remove(index % placed);
                self.scene.remove_instance(key).unwrap();
            }
            Edit::Remove(_) => {}
            Edit::Pose(mesh, bend) => {
                let (key, corners) = &mut self.meshes[mesh % 2];
                let bent = |corner: &mut Vec3| corner.x += corner.y.abs() * bend;
                corners.as_flattened_mut().iter_mut().for_each(bent);
                self.scene.replace_mesh(*key, corners).unwrap();
            }
            Edit::Replace(mesh, times) => {
                let mesh = mesh % 2;
                if !self.instances.iter().any(|instance| instance.1 == mesh && instance.2) {
                    self.meshes[mesh].1 = sphere(times);
                    self.scene.replace_mesh(self.meshes[mesh].0, &self.meshes[mesh].1).unwrap();
                }
            }
            Edit::Origin(origin_world) => self.scene.set_origin(origin_world).unwrap(),
            Edit::Rebuild => drop(self.scene.rebuild_if_degraded().unwrap()),
        }
    }

    /// Builds the same from nothing.
    fn fresh(&self) -> RayScene {
        let mut scene = RayScene::new(self.scene.origin_world());
        for &(_, mesh, cut, world_from_mesh) in &self.instances {
            let corners = &self.meshes[mesh].1;
            let surfaces = cut.then(|| holes(&mut scene, corners.len()));
            let mesh = scene.insert_mesh(corners).unwrap();
            scene.insert_instance(Instance { mesh, surfaces, world_from_mesh }).unwrap();
        }
        scene
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(96))]

    #[test]
    fn after_any_edits_a_scene_is_as_if_built_from_nothing(
        edits in prop::collection::vec(edit(), 1..60),
        rays in prop::collection::vec(prop::array::uniform3(-1f32..1.0), 40),
    ) {
        let mut world = World::new();
        for edit in &edits {
            world.apply(edit);
        }
        let fresh = world.fresh();
        prop_assert_eq!(world.scene.max_coordinate_m(), fresh.max_coordinate_m());
        prop_assert_eq!(world.scene.triangle_count(), fresh.triangle_count());
        for towards in rays {
            let ray = Ray::new(Vec3::new(0.1, 0.2, 0.3), Vec3::from(towards).normalize_or(Vec3::Y), 0.0, f32::INFINITY);
            prop_assert_eq!(world.scene.nearest_distance(&ray), fresh.nearest_distance(&ray));
            prop_assert_eq!(fresh.nearest_distance(&ray), fresh.nearest_distance_brute_force(&ray));
        }
    }
}

/// Returns `count` spheres on a square grid, and their keys.
fn grid(count: usize) -> (RayScene, Vec<RayInstanceKey>) {
    let mut scene = RayScene::default();
    let mesh = scene.insert_mesh(&sphere(2)).unwrap();
    let at = |index: usize| DVec3::new((index % 100) as f64, 0.0, (index / 100) as f64) * 3.0;
    let place =
        |index| Instance { mesh, surfaces: None, world_from_mesh: DAffine3::from_translation(at(index)) };
    let keys = (0..count).map(|index| scene.insert_instance(place(index)).unwrap()).collect();
    (scene, keys)
}

#[test]
fn moving_one_of_10_000_instances_uploads_its_transform_and_the_boxes_above_it() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let (mut scene, keys) = grid(10_000);
    let mut gpu = GpuRayScene::new(&device);
    let all = gpu.update(&queue, &mut scene).unwrap();
    // An instance and two nodes each; the triangles once.
    assert!((10_000 * (128 + 64)..10_000 * 200 + 320 * 112).contains(&all), "{all}");
    assert_eq!(gpu.update(&queue, &mut scene), Ok(0));
    let mut step = |count: usize, time: f64| {
        for (index, &key) in keys.iter().enumerate().take(count) {
            let at = DVec3::new((index % 100) as f64, 0.0, (index / 100) as f64) * 3.0;
            let turn = DQuat::from_rotation_x(time);
            scene
                .set_transform(key, DAffine3::from_rotation_translation(turn, at + turn * DVec3::X))
                .unwrap();
        }
        gpu.update(&queue, &mut scene).unwrap()
    };
    let [one, hundred, every] = [1, 100, 10_000].map(|count| step(count, 0.1 * count as f64));
    println!("bytes: {all} at first; {one} for 1 moved instance, {hundred} for 100, {every} for all");
    assert!(one <= 128 + 32 * 32, "{one}");
    assert!(hundred <= 100 * one && every < all, "{hundred} {every}");
}

#[test]
fn a_pose_uploads_one_mesh_and_a_moved_origin_only_transforms_and_boxes() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let (mut scene, keys) = grid(500);
    let posed = scene.insert_mesh(&sphere(3)).unwrap();
    let placed =
        Instance { mesh: posed, surfaces: None, world_from_mesh: DAffine3::from_translation(DVec3::Y) };
    scene.insert_instance(placed).unwrap();
    let mut gpu = GpuRayScene::new(&device);
    gpu.update(&queue, &mut scene).unwrap();
    let triangles = sphere(3);
    let bent: Vec<_> = triangles.iter().map(|corners| corners.map(|corner| corner * 1.1)).collect();
    scene.replace_mesh(posed, &bent).unwrap();
    let bytes = gpu.update(&queue, &mut scene).unwrap() as usize;
    assert!((triangles.len() * 48..triangles.len() * 112 + 2048).contains(&bytes), "{bytes}");
    scene.set_origin(DVec3::new(1024.0, 0.0, 0.0)).unwrap();
    let bytes = gpu.update(&queue, &mut scene).unwrap() as usize;
    assert!((501 * 128..501 * (128 + 64)).contains(&bytes), "{bytes}");
    scene.remove_instance(keys[7]).unwrap();
    let bytes = gpu.update(&queue, &mut scene).unwrap();
    assert!(bytes <= 32 * 32, "{bytes}");
}

#[test]
fn a_tree_is_rebuilt_only_when_edits_have_degraded_it() {
    let (mut scene, keys) = grid(1_000);
    scene.rebuild().unwrap();
    assert_eq!(scene.rebuild_if_degraded(), Ok(false));
    let move_all = |scene: &mut RayScene, offset: &dyn Fn(usize) -> DVec3| {
        for (index, &key) in keys.iter().enumerate() {
            scene.set_transform(key, DAffine3::from_translation(offset(index))).unwrap();
        }
    };
    let at = |index: usize| DVec3::new((index % 100) as f64, 0.0, (index / 100) as f64) * 3.0;
    move_all(&mut scene, &|index| at(index) + DVec3::new((index % 7) as f64 * 0.1, 1.0, 0.0));
    assert_eq!(scene.rebuild_if_degraded(), Ok(false));
    // Every instance to the place of another, far away.
    move_all(&mut scene, &|index| at(index * 607 % 1_000));
    assert_eq!(scene.rebuild_if_degraded(), Ok(true));
    assert_eq!(scene.rebuild_if_degraded(), Ok(false));
}

#[test]
fn what_is_inserted_and_removed_leaves_nothing_behind() {
    let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let (mut scene, _) = grid(50);
    let mut gpu = GpuRayScene::new(&device);
    let mut bytes = 0;
    for round in 0..40 {
        let mesh = scene.insert_mesh(&sphere(2)).unwrap();
        let holes = holes(&mut scene, 320);
        let surfaces = Some(holes);
        let key =
            scene.insert_instance(Instance { mesh, surfaces, world_from_mesh: DAffine3::IDENTITY }).unwrap();
        scene.remove_instance(key).unwrap();
        scene.remove_surfaces(holes).unwrap();
        scene.remove_mesh(mesh).unwrap();
        let uploaded = gpu.update(&queue, &mut scene).unwrap();
        if round == 0 {
            bytes = uploaded;
        }
        assert!(round == 0 || uploaded < bytes / 2, "{uploaded} after {bytes}");
    }
}
