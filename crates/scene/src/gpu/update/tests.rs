#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use std::collections::BTreeMap;

use glam::{DAffine3, DVec3, Vec4};
use proptest::prelude::*;

use super::*;
use crate::bounds::{ConvexVolume, Plane};
use crate::cull::CullVolume;
use crate::material::{AlphaMode, CasterMode, Image, Material, TextureRef};
use crate::mesh::Mesh;
use crate::scene::ShadowCasting;

/// A scene and its GPU copy on a device that does nothing.
struct Copied {
    device: wgpu::Device,
    queue: wgpu::Queue,
    scene: Scene,
    gpu: GpuScene,
}

impl Copied {
    fn new(scene: Scene) -> Self {
        let (device, queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
        let gpu = GpuScene::new(&device, &queue, &scene, DVec3::ZERO).unwrap();
        let mut copied = Self { device, queue, scene, gpu };
        let _ = copied.scene.take_changes();
        copied
    }

    fn follow(&mut self) {
        let changes = self.scene.take_changes();
        self.gpu.update(&self.device, &self.queue, &self.scene, &changes).unwrap();
    }

    fn number(&self, key: InstanceKey) -> u32 {
        self.gpu.number(key).unwrap()
    }

    /// Returns what is known of each instance, without the numbers.
    fn instances(&self) -> BTreeMap<InstanceKey, String> {
        let describe = |(key, instance): (InstanceKey, &Instance)| {
            let number = self.number(key);
            let draw = self.gpu.draw_for(number).unwrap();
            assert_eq!((draw.instance, self.gpu.instance(number)), (number, Some(key)));
            let ranges = self.gpu.geometry.ranges(draw.mesh).unwrap();
            let mesh = self.scene.mesh(instance.mesh).unwrap();
            assert_eq!(ranges.triangle_count() as usize, mesh.indices.len() / 3);
            assert!(self.gpu.materials.group(draw.material).is_some());
            let bounds = (self.gpu.bounds()[number as usize], self.gpu.caster_bounds(number));
            let text = format!("{:?} {:?} {bounds:?}", draw.key, draw.casts);
            (key, text)
        };
        self.scene.instances().map(describe).collect()
    }

    /// Returns what each instance draws by its number and version.
    fn versions(&self) -> Vec<((u32, u64), String)> {
        let describe = |(key, instance): (InstanceKey, &Instance)| {
            let (number, mesh) = (self.number(key), self.scene.mesh(instance.mesh).unwrap());
            let material = self.scene.material(instance.material).unwrap();
            let images = material.textures().into_iter().flatten().map(|used| self.scene.image(used.image));
            let images: Vec<_> = images.collect();
            let corner = mesh.vertices.last().map(|vertex| vertex.position);
            let version = self.gpu.version(number).unwrap();
            ((number, version), format!("{key:?} {instance:?} {corner:?} {material:?} {images:?}"))
        };
        self.scene.instances().map(describe).collect()
    }

    fn count_static_casters(&self) -> usize {
        let numbers = self.scene.instances().map(|(key, _)| self.number(key));
        let is_static =
            |number: &u32| !self.gpu.caster_bounds(*number).is_empty() && !self.gpu.is_moving(*number);
        numbers.filter(is_static).count()
    }

    fn cull(&self, volume: &CullVolume) -> [Vec<InstanceKey>; 2] {
        let (mut seen, mut casters) = (Vec::new(), Vec::new());
        self.gpu.cull(volume, &mut seen);
        self.gpu.cull_casters(volume, &mut casters);
        [seen, casters].map(|numbers| {
            let mut keys: Vec<_> = numbers.iter().map(|&number| self.gpu.instance(number).unwrap()).collect();
            keys.sort_unstable();
            keys
        })
    }
}

fn translated(x: f64) -> DAffine3 {
    DAffine3::from_translation(DVec3::X * x)
}

fn cube(size: f64) -> Mesh {
    Mesh::cuboid(DVec3::ZERO, DVec3::splat(size))
}

fn dot(value: u8) -> Image {
    Image::new("dot", 1, 1, vec![value; 4])
}

/// Returns `count` cubes in a row, with one mesh and one material.
fn row(count: usize) -> (Scene, Vec<InstanceKey>) {
    let mut scene = Scene::default();
    let mesh = scene.insert_mesh(cube(1.0));
    let material = scene.insert_material(Material::default()).unwrap();
    let insert = |x| scene.insert_instance(Instance::new(mesh, material, translated(f64::from(x)))).unwrap();
    let keys = (0..count as u32).map(insert).collect();
    (scene, keys)
}

#[test]
fn moving_one_of_ten_thousand_instances_changes_one_and_uploads_as_much() {
    let (scene, keys) = row(10_000);
    let mut copied = Copied::new(scene);
    let versions = |copied: &Copied| -> Vec<_> {
        keys.iter().map(|&key| copied.gpu.version(copied.number(key))).collect()
    };
    let before = versions(&copied);
    copied.scene.move_instance(keys[77], translated(-5.0)).unwrap();
    let changes = copied.scene.take_changes();
    assert_eq!((changes.instances.as_slice(), changes.meshes.len()), (&keys[77..78], 0));
    copied.gpu.frame += 1;
    let gpu = (&copied.device, &copied.queue);
    let mut edits = Edits::default();
    copied.gpu.update_instance(gpu, &copied.scene, keys[77], &mut edits).unwrap();
    assert_eq!((edits.bounds.len(), copied.gpu.instances.pending()), (1, 1));
    copied.gpu.follow_bounds(edits);
    copied.gpu.instances.flush(gpu, &copied.gpu.layouts.draw).unwrap();
    let after = versions(&copied);
    let changed: Vec<_> = (0..keys.len()).filter(|&index| before[index] != after[index]).collect();
    assert_eq!(changed, [77]);
    assert!(copied.gpu.is_moving(copied.number(keys[77])) && !copied.gpu.is_moving(copied.number(keys[78])));
    for _ in 0..60 {
        copied.follow();
    }
    assert!(!copied.gpu.is_moving(copied.number(keys[77])));
    assert_eq!(versions(&copied), after);
}

#[test]
fn flags_decide_what_cameras_see_and_what_casts() {
    let (scene, keys) = row(4);
    let mut copied = Copied::new(scene);
    let mut edit = |index: usize, edit: &dyn Fn(&mut Instance)| {
        copied.scene.edit_instance(keys[index], edit).unwrap();
    };
    edit(0, &|instance| instance.visible = false);
    edit(1, &|instance| instance.casts = ShadowCasting::Off);
    edit(2, &|instance| instance.casts = ShadowCasting::ShadowOnly);
    edit(3, &|instance| instance.receives_shadows = false);
    copied.follow();
    let everywhere = CullVolume::from(ConvexVolume { planes: vec![] });
    assert_eq!(copied.cull(&everywhere), [vec![keys[1], keys[3]], vec![keys[2], keys[3]]]);
    assert_eq!((copied.gpu.all_bounds().min.x, copied.gpu.all_bounds().max.x), (1.0, 4.0));
    assert_eq!((copied.gpu.all_caster_bounds().min.x, copied.gpu.all_caster_bounds().max.x), (2.0, 4.0));
    let all: Vec<u32> = (0..4).collect();
    let draws = copied.gpu.draw_list(&all, DVec3::ZERO);
    let seen: Vec<_> = draws.iter().map(|draw| copied.gpu.instance(draw.instance).unwrap()).collect();
    assert_eq!(seen.len(), 2);
    let material = |index: usize| copied.gpu.draw_for(copied.number(keys[index])).unwrap().material;
    assert_ne!(material(3), material(1));
    assert_eq!(material(0), material(1));
}

#[test]
fn a_replaced_material_or_mesh_changes_the_versions_of_its_instances_alone() {
    let (mut scene, keys) = row(3);
    let other = scene.add(cube(2.0), Material::default(), translated(9.0)).unwrap();
    let (mesh, material) = (scene.instance(keys[0]).unwrap().mesh, scene.instance(keys[0]).unwrap().material);
    let mut copied = Copied::new(scene);
    let versions = |copied: &Copied| {
        [keys[0], keys[2], other].map(|key| copied.gpu.version(copied.number(key)).unwrap())
    };
    let first = versions(&copied);
    copied
        .scene
        .edit_material(material, |material| material.alpha = AlphaMode::Mask { cutoff: 0.5 })
        .unwrap();
    copied.follow();
    let second = versions(&copied);
    assert!(first[0] < second[0] && first[1] < second[1] && first[2] == second[2]);
    assert_eq!(copied.gpu.draw_for(copied.number(keys[1])).unwrap().casts, CasterMode::Clip);
    copied.scene.replace_mesh(mesh, cube(3.0)).unwrap();
    copied.follow();
    let third = versions(&copied);
    assert!(second[0] < third[0] && second[1] < third[1] && second[2] == third[2]);
    assert_eq!(copied.gpu.caster_bounds(copied.number(keys[0])).max, DVec3::splat(3.0));
}

#[test]
fn textures_are_shared_replaced_with_their_image_and_freed_with_their_last_material() {
    let mut scene = Scene::default();
    let image = scene.insert_image(dot(255)).unwrap();
    let textured = Material { base_color_texture: Some(TextureRef::new(image)), ..Material::default() };
    let keys = [0.0, 2.0].map(|x| scene.add(cube(1.0), textured.clone(), translated(x)).unwrap());
    let materials = keys.map(|key| scene.instance(key).unwrap().material);
    let mut copied = Copied::new(scene);
    assert_eq!(copied.gpu.materials.texture_count(), 1);
    let version = |copied: &Copied| copied.gpu.version(copied.number(keys[0]));
    let before = version(&copied);
    copied.scene.replace_image(image, dot(0)).unwrap();
    copied.follow();
    assert!(version(&copied) > before);
    // One of the colour, and as it is translucent, one of the alpha.
    assert_eq!(copied.gpu.materials.texture_count(), 2);
    for key in materials {
        copied.scene.edit_material(key, |material| material.base_color_texture = None).unwrap();
    }
    copied.follow();
    assert_eq!(copied.gpu.materials.texture_count(), 0);
    copied.scene.remove_image(image).unwrap();
    copied.follow();
}

#[test]
fn a_scene_that_exceeds_a_limit_is_refused_until_the_edit_is_undone() {
    let limits = wgpu::Limits { max_buffer_size: 16_384, ..wgpu::Limits::default() };
    let descriptor = wgpu::DeviceDescriptor { required_limits: limits, ..Default::default() };
    let (device, queue) = wgpu::Device::noop(&descriptor);
    let (mut scene, keys) = row(1);
    let mut gpu = GpuScene::new(&device, &queue, &scene, DVec3::ZERO).unwrap();
    let _ = scene.take_changes();
    let large = Mesh::new("large", vec![crate::Vertex::default(); 300], vec![0, 1, 2]);
    let small = scene.replace_mesh(scene.instance(keys[0]).unwrap().mesh, large).unwrap();
    for _ in 0..2 {
        let changes = scene.take_changes();
        let error = gpu.update(&device, &queue, &scene, &changes).unwrap_err().to_string();
        assert!(error.contains("vertices (bytes)") && error.contains("max_buffer_size"), "{error}");
        scene.restore_changes(changes);
    }
    scene.replace_mesh(scene.instance(keys[0]).unwrap().mesh, small).unwrap();
    let changes = scene.take_changes();
    gpu.update(&device, &queue, &scene, &changes).unwrap();
    assert_eq!(gpu.triangle_count(gpu.draw_for(0).unwrap()), 12);
}

/// An edit of a random scene; numbers select one of what there is.
#[derive(Clone, Debug)]
enum Edit {
    Insert(u8, u8, f64),
    Remove(u8),
    Move(u8, f64),
    Mirror(u8),
    Visible(u8, bool),
    Casts(u8, u8),
    Receives(u8, bool),
    Use(u8, u8, u8),
    InsertMesh(u8),
    ReplaceMesh(u8, u8),
    RemoveMesh(u8),
    InsertMaterial(u8, u8),
    ReplaceMaterial(u8, u8, u8),
    RemoveMaterial(u8),
    ReplaceImage(u8, u8),
    Frame,
}

fn edit() -> impl Strategy<Value = Edit> {
    let (n, x) = (any::<u8>(), -50.0..50.0);
    prop_oneof![
        6 => (n, n, x.clone()).prop_map(|(a, b, x)| Edit::Insert(a, b, x)),
        3 => n.prop_map(Edit::Remove),
        6 => (n, x).prop_map(|(a, x)| Edit::Move(a, x)),
        1 => n.prop_map(Edit::Mirror),
        1 => (n, any::<bool>()).prop_map(|(a, on)| Edit::Visible(a, on)),
        1 => (n, n).prop_map(|(a, b)| Edit::Casts(a, b)),
        1 => (n, any::<bool>()).prop_map(|(a, on)| Edit::Receives(a, on)),
        2 => (n, n, n).prop_map(|(a, b, c)| Edit::Use(a, b, c)),
        1 => n.prop_map(Edit::InsertMesh),
        1 => (n, n).prop_map(|(a, b)| Edit::ReplaceMesh(a, b)),
        1 => n.prop_map(Edit::RemoveMesh),
        1 => (n, n).prop_map(|(a, b)| Edit::InsertMaterial(a, b)),
        1 => (n, n, n).prop_map(|(a, b, c)| Edit::ReplaceMaterial(a, b, c)),
        1 => n.prop_map(Edit::RemoveMaterial),
        1 => (n, n).prop_map(|(a, b)| Edit::ReplaceImage(a, b)),
        4 => Just(Edit::Frame),
    ]
}

fn nth<K: Copy, T>(all: impl Iterator<Item = (K, T)>, number: u8) -> Option<K> {
    let keys: Vec<K> = all.map(|(key, _)| key).collect();
    (!keys.is_empty()).then(|| keys[usize::from(number) % keys.len()])
}

fn some_material(scene: &Scene, alpha: u8, image: u8) -> Material {
    let alpha = match alpha % 4 {
        0 | 1 => AlphaMode::Opaque,
        2 => AlphaMode::Mask { cutoff: f32::from(alpha) / 256.0 },
        _ => AlphaMode::Blend,
    };
    let texture = nth(scene.images(), image).filter(|_| !image.is_multiple_of(3)).map(TextureRef::new);
    Material { alpha, base_color_texture: texture, base_color: Vec4::ONE, ..Material::default() }
}

/// Applies an edit. Edits of what there is not, and removals of what is used, are refused and change nothing.
fn apply(scene: &mut Scene, edit: &Edit) -> Option<()> {
    let instance = |scene: &Scene, number: u8| nth(scene.instances(), number);
    match *edit {
        Edit::Insert(mesh, material, x) => {
            let (mesh, material) = (nth(scene.meshes(), mesh)?, nth(scene.materials(), material)?);
            scene.insert_instance(Instance::new(mesh, material, translated(x))).unwrap();
        }
        Edit::Remove(number) => drop(scene.remove_instance(instance(scene, number)?).unwrap()),
        Edit::Move(number, x) => scene.move_instance(instance(scene, number)?, translated(x)).unwrap(),
        Edit::Mirror(number) => {
            let mirror = DAffine3::from_scale(DVec3::new(-1.0, 1.0, 1.0));
            scene.edit_instance(instance(scene, number)?, |i| i.world_from_local *= mirror).unwrap();
        }
        Edit::Visible(number, on) => {
            scene.edit_instance(instance(scene, number)?, |i| i.visible = on).unwrap()
        }
        Edit::Casts(number, casts) => {
            let casts =
                [ShadowCasting::On, ShadowCasting::Off, ShadowCasting::ShadowOnly][usize::from(casts) % 3];
            scene.edit_instance(instance(scene, number)?, |i| i.casts = casts).unwrap();
        }
        Edit::Receives(number, on) => {
            scene.edit_instance(instance(scene, number)?, |i| i.receives_shadows = on).unwrap();
        }
        Edit::Use(number, mesh, material) => {
            let (mesh, material) = (nth(scene.meshes(), mesh)?, nth(scene.materials(), material)?);
            let used = |i: &mut Instance| (i.mesh, i.material) = (mesh, material);
            scene.edit_instance(instance(scene, number)?, used).unwrap();
        }
        Edit::InsertMesh(size) => {
            scene.insert_mesh(cube(f64::from(size) / 64.0 + 0.1));
        }
        Edit::ReplaceMesh(mesh, size) => {
            let mesh = nth(scene.meshes(), mesh)?;
            scene.replace_mesh(mesh, cube(f64::from(size) / 64.0 + 0.1)).unwrap();
        }
        Edit::RemoveMesh(mesh) => drop(scene.remove_mesh(nth(scene.meshes(), mesh)?)),
        Edit::InsertMaterial(alpha, image) => {
            scene.insert_material(some_material(scene, alpha, image)).unwrap();
        }
        Edit::ReplaceMaterial(material, alpha, image) => {
            let replacement = some_material(scene, alpha, image);
            scene.replace_material(nth(scene.materials(), material)?, replacement).unwrap();
        }
        Edit::RemoveMaterial(material) => drop(scene.remove_material(nth(scene.materials(), material)?)),
        Edit::ReplaceImage(image, value) => {
            scene.replace_image(nth(scene.images(), image)?, dot(value)).unwrap();
        }
        Edit::Frame => {}
    }
    Some(())
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60.max(ProptestConfig::default().cases / 4)))]

    #[test]
    fn a_copy_that_follows_edits_equals_a_fresh_one(edits in prop::collection::vec(edit(), 1..160)) {
        let mut scene = row(6).0;
        for value in [0, 255] {
            scene.insert_image(dot(value)).unwrap();
        }
        let mut copied = Copied::new(scene);
        let mut known = BTreeMap::new();
        for edit in edits {
            apply(&mut copied.scene, &edit);
            if !matches!(edit, Edit::Frame) {
                continue;
            }
            copied.follow();
            for (version, drawn) in copied.versions() {
                let known = known.entry(version).or_insert_with(|| drawn.clone());
                prop_assert_eq!(&*known, &drawn, "a version that was never used");
            }
            let fresh = Copied::new(copied.scene.clone());
            prop_assert_eq!(copied.instances(), fresh.instances());
            prop_assert_eq!(copied.gpu.all_bounds(), fresh.gpu.all_bounds());
            prop_assert_eq!(copied.gpu.static_caster_count(), copied.count_static_casters());
            prop_assert_eq!(copied.gpu.all_caster_bounds(), fresh.gpu.all_caster_bounds());
            // A copy keeps the textures of materials that instances used once.
            prop_assert!(copied.gpu.materials.texture_count() >= fresh.gpu.materials.texture_count());
            let planes = vec![Plane::through(DVec3::X * 4.0, DVec3::X)];
            let volume = CullVolume::from(ConvexVolume { planes });
            prop_assert_eq!(copied.cull(&volume), fresh.cull(&volume));
        }
    }
}

#[test]
fn ten_thousand_random_edits_leave_buffers_of_bounded_size() {
    let (mut scene, _) = row(0);
    let image = scene.insert_image(dot(1)).unwrap();
    let mut copied = Copied::new(scene);
    let mut sizes = Vec::new();
    let mut state = 1u64;
    let mut random = |below: u64| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) % below
    };
    for frame in 0..10_000 {
        let material = Material { base_color_texture: Some(TextureRef::new(image)), ..Material::default() };
        copied.scene.add(cube(random(9) as f64 + 1.0), material, translated(random(99) as f64)).unwrap();
        if copied.scene.instances().len() > 40 {
            let key = nth(copied.scene.instances(), random(40) as u8).unwrap();
            let removed = copied.scene.remove_instance(key).unwrap();
            copied.scene.remove_mesh(removed.mesh).unwrap();
            copied.scene.remove_material(removed.material).unwrap();
        }
        copied.follow();
        if frame % 2500 == 2499 {
            sizes.push((copied.gpu.geometry.bytes(), copied.gpu.slots.len(), copied.gpu.tree.len()));
        }
    }
    assert_eq!(sizes[1], sizes[3], "{sizes:?}");
    assert!(sizes[3].1 <= 60, "{sizes:?}");
}
