#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use glam::{DAffine3, DVec3, Vec3};

use super::*;
use crate::light::LightKind;
use crate::material::TextureRef;
use crate::mesh::{Influence, MeshPose, SkinWeights, Vertex};

const SUN: LightKind = LightKind::Directional { direction: DVec3::NEG_Y };
const POINT: LightKind = LightKind::Point { position_world: DVec3::ZERO, range: None };
const SPOT: LightKind = LightKind::Spot {
    position_world: DVec3::ZERO,
    direction: DVec3::NEG_Y,
    range: None,
    inner_angle: 0.0,
    outer_angle: 0.5,
};

fn light(name: &str, kind: LightKind) -> Light {
    Light { name: Some(name.into()), kind, color: Vec3::ONE, intensity: 1.0, casts_shadow: true }
}

/// Returns the names of the lights in their order, and asserts that keys and indices agree with it.
fn light_names(scene: &Scene) -> String {
    assert_eq!(scene.light_keys().len(), scene.lights().len());
    for (index, key) in scene.light_keys().iter().enumerate() {
        assert_eq!(scene.light_index(*key), Some(index));
    }
    scene.lights().iter().filter_map(|light| light.name.as_deref()).collect()
}

fn triangle() -> Mesh {
    let corner = |x, y| Vertex { position: [x, y, 0.0], ..Vertex::default() };
    let vertices = vec![corner(0.0, 0.0), corner(1.0, 0.0), corner(0.0, 1.0)];
    Mesh::new("triangle", vertices, vec![0, 1, 2])
}

fn translated(translation: DVec3) -> DAffine3 {
    DAffine3::from_translation(translation)
}

fn pixel(name: &str) -> Image {
    Image::new(name, 1, 1, vec![255; 4])
}

fn textured(name: &str, image: ImageKey) -> Material {
    Material { name: name.into(), base_color_texture: Some(TextureRef::new(image)), ..Material::default() }
}

/// A scene with one of everything that has a key.
struct One {
    scene: Scene,
    mesh: MeshKey,
    material: MaterialKey,
    image: ImageKey,
    instance: InstanceKey,
    light: LightKey,
}

fn one() -> One {
    let mut scene = Scene::default();
    let image = scene.insert_image(pixel("bark")).unwrap();
    let material = scene.insert_material(textured("wood", image)).unwrap();
    let mesh = scene.insert_mesh(triangle());
    let instance = Instance::new(mesh, material, DAffine3::IDENTITY).with_name("tree");
    let instance = scene.insert_instance(instance).unwrap();
    let light = scene.insert_light(light("sun", SUN));
    One { scene, mesh, material, image, instance, light }
}

fn stale<T>(kind: &'static str) -> Result<T, EditError> {
    Err(EditError::StaleKey { kind })
}

#[test]
fn lights_are_ordered_by_kind_and_then_as_inserted() {
    let mut scene = Scene::default();
    for (name, kind) in [("a", POINT), ("b", SPOT), ("c", POINT), ("d", SUN), ("e", SPOT), ("f", SUN)] {
        let key = scene.insert_light(light(name, kind));
        assert_eq!(scene.lights()[scene.light_index(key).unwrap()].name.as_deref(), Some(name));
    }
    assert_eq!(light_names(&scene), "dfbeac");
}

#[test]
fn lights_stay_in_order_when_they_are_replaced_and_removed() {
    let mut scene = Scene::default();
    let [a, b, c, d] = [("a", SUN), ("b", SPOT), ("c", POINT), ("d", POINT)]
        .map(|(name, kind)| scene.insert_light(light(name, kind)));
    // Of the same kind: it keeps its place.
    assert_eq!(scene.replace_light(c, light("C", POINT)), Ok(light("c", POINT)));
    assert_eq!(light_names(&scene), "abCd");
    // Of another kind: it moves after the others of that kind, and keeps its key.
    assert_eq!(scene.replace_light(a, light("A", POINT)), Ok(light("a", SUN)));
    assert_eq!(light_names(&scene), "bCdA");
    assert_eq!(scene.light_index(a), Some(3));
    assert_eq!(scene.replace_light(d, light("D", SUN)), Ok(light("d", POINT)));
    assert_eq!(scene.replace_light(a, light("a", SUN)), Ok(light("A", POINT)));
    assert_eq!(light_names(&scene), "DabC");
    assert_eq!(scene.remove_light(a), Ok(light("a", SUN)));
    assert_eq!(light_names(&scene), "DbC");
    assert_eq!([a, b, c, d].map(|key| scene.light_index(key)), [None, Some(1), Some(2), Some(0)]);
}

#[test]
fn a_list_of_lights_replaces_all_of_them_in_order() {
    let One { mut scene, light: previous, .. } = one();
    scene.set_lights([light("a", POINT), light("b", SUN), light("c", SPOT), light("d", SUN)]);
    assert_eq!(light_names(&scene), "bdca");
    assert_eq!(scene.light_index(previous), None);
    assert_eq!(scene.remove_light(previous), stale("light"));
    scene.set_lights([]);
    assert!(scene.lights().is_empty() && scene.light_keys().is_empty());
}

#[test]
fn bounds_and_triangles_count_every_instance() {
    let mut scene = Scene::default();
    let mesh = scene.insert_mesh(triangle());
    let material = scene.insert_material(Material::default()).unwrap();
    let [_, far, removed] = [0.0, 1e7, -1e7].map(|x| {
        let instance = Instance::new(mesh, material, translated(DVec3::X * x));
        scene.insert_instance(instance).unwrap()
    });
    scene.remove_instance(removed).unwrap();
    assert_eq!(scene.bounds(), Aabb { min: DVec3::ZERO, max: DVec3::new(1e7 + 1.0, 1.0, 0.0) });
    assert_eq!(scene.triangle_count(), 2);
    assert!(scene.instance_bounds(removed).is_empty());
    assert!(scene.instance_bounds(InstanceKey::default()).is_empty());
    scene.edit_instance(far, |instance| instance.visible = false).unwrap();
    assert!(scene.instance_bounds(far).is_empty());
    assert_eq!(scene.bounds(), Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 0.0) });
}

#[test]
fn culling_keeps_what_the_framing_camera_shows_and_drops_what_is_behind_it() {
    let mut scene = Scene::default();
    let mesh = scene.insert_mesh(triangle());
    let material = scene.insert_material(Material::default()).unwrap();
    let instance = |translation| Instance::new(mesh, material, translated(translation));
    let first = scene.insert_instance(instance(DVec3::ZERO)).unwrap();
    let moved = scene.insert_instance(instance(DVec3::ZERO)).unwrap();
    let third = scene.insert_instance(instance(DVec3::X * 3.0)).unwrap();
    let camera = scene.framing_camera(1.5);
    let visible = |scene: &Scene| scene.visible_instances(&camera.frustum(1.5)).collect::<Vec<_>>();
    assert_eq!(visible(&scene), [first, moved, third]);
    scene.move_instance(moved, translated(camera.position_world() * 3.0)).unwrap();
    assert_eq!(visible(&scene), [first, third]);
}

#[test]
fn stale_keys_are_errors_and_change_nothing() {
    let One { mut scene, mesh, material, image, instance, light: sun } = one();
    let kept = scene.instance(instance).unwrap().clone();
    scene.remove_instance(instance).unwrap();
    scene.remove_mesh(mesh).unwrap();
    scene.remove_material(material).unwrap();
    scene.remove_image(image).unwrap();
    scene.remove_light(sun).unwrap();
    // The next values have keys of their own.
    let other_mesh = scene.insert_mesh(triangle());
    let other_material = scene.insert_material(Material::default()).unwrap();
    let other_image = scene.insert_image(pixel("other")).unwrap();
    let other = scene.insert_instance(Instance::new(other_mesh, other_material, DAffine3::IDENTITY)).unwrap();
    let other_light = scene.insert_light(light("other", SUN));
    assert!(mesh != other_mesh && material != other_material && image != other_image);
    assert!(instance != other && sun != other_light);
    assert!(scene.mesh(mesh).is_none() && scene.material(material).is_none() && scene.image(image).is_none());
    assert!(scene.instance(instance).is_none() && scene.light_index(sun).is_none());

    let _ = scene.take_changes();
    let before = scene.clone();
    assert_eq!(scene.replace_mesh(mesh, triangle()), stale("mesh"));
    assert_eq!(scene.remove_mesh(mesh), stale("mesh"));
    assert_eq!(scene.replace_material(material, Material::default()), stale("material"));
    assert_eq!(scene.edit_material(material, |material| material.unlit = true), stale("material"));
    assert_eq!(scene.remove_material(material), stale("material"));
    assert_eq!(scene.replace_image(image, pixel("new")), stale("image"));
    assert_eq!(scene.remove_image(image), stale("image"));
    assert_eq!(scene.move_instance(instance, DAffine3::IDENTITY), stale("instance"));
    assert_eq!(scene.edit_instance(instance, |instance| instance.visible = false), stale("instance"));
    assert_eq!(scene.remove_instance(instance), stale("instance"));
    assert_eq!(scene.replace_light(sun, light("new", SUN)), stale("light"));
    assert_eq!(scene.remove_light(sun), stale("light"));
    // References to what was removed.
    let good = scene.instance(other).unwrap().clone();
    assert_eq!(scene.replace_instance(instance, good.clone()), stale("instance"));
    assert_eq!(scene.insert_instance(kept.clone()), stale("mesh"));
    assert_eq!(scene.replace_instance(other, kept), stale("mesh"));
    assert_eq!(scene.insert_instance(Instance { material, ..good.clone() }), stale("material"));
    assert_eq!(scene.edit_instance(other, |instance| instance.mesh = mesh), stale("mesh"));
    assert_eq!(scene.edit_instance(other, |instance| instance.material = material), stale("material"));
    assert_eq!(scene.insert_material(textured("new", image)), stale("image"));
    assert_eq!(scene.replace_material(other_material, textured("new", image)), stale("image"));
    let edit = |material: &mut Material| material.emissive_texture = Some(TextureRef::new(image));
    assert_eq!(scene.edit_material(other_material, edit), stale("image"));
    assert_eq!(scene.add(triangle(), textured("new", image), DAffine3::IDENTITY), stale("image"));
    assert_eq!(scene, before);
    assert!(scene.take_changes().is_empty());
    // Refused edits count no users.
    assert!(scene.remove_instance(other).is_ok() && scene.remove_image(other_image).is_ok());
    assert!(scene.remove_mesh(other_mesh).is_ok() && scene.remove_material(other_material).is_ok());
}

#[test]
fn what_others_refer_to_cannot_be_removed() {
    let One { mut scene, mesh, material, image, instance, .. } = one();
    let copy = scene.instance(instance).unwrap().clone();
    let second = scene.insert_instance(copy).unwrap();
    let before = scene.clone();
    let texts = [
        scene.remove_mesh(mesh).unwrap_err(),
        scene.remove_material(material).unwrap_err(),
        scene.remove_image(image).unwrap_err(),
    ]
    .map(|error| error.to_string());
    let rest = "; remove them first, or let them use another";
    assert_eq!(texts[0], format!("mesh \"triangle\" is used by 2 instances{rest}"));
    assert_eq!(texts[1], format!("material \"wood\" is used by 2 instances{rest}"));
    assert_eq!(texts[2], format!("image \"bark\" is used by 1 textures of materials{rest}"));
    assert_eq!(scene, before);
    scene.remove_instance(second).unwrap();
    assert!(matches!(scene.remove_mesh(mesh), Err(EditError::InUse { users: 1, .. })));
    scene.remove_instance(instance).unwrap();
    assert_eq!(scene.remove_mesh(mesh), Ok(triangle()));
    assert!(scene.remove_image(image).is_err());
    assert_eq!(scene.remove_material(material), Ok(textured("wood", image)));
    assert_eq!(scene.remove_image(image), Ok(pixel("bark")));
}

#[test]
fn users_are_counted_through_every_edit() {
    let One { mut scene, mesh, material, image, instance, .. } = one();
    let cube = scene.insert_mesh(Mesh::cuboid(DVec3::ZERO, DVec3::ONE));
    let plain = scene.insert_material(Material::default()).unwrap();
    // Edits that keep the references.
    scene.edit_instance(instance, |instance| instance.receives_shadows = false).unwrap();
    scene.edit_material(material, |material| material.roughness = 0.5).unwrap();
    assert!(matches!(scene.remove_mesh(mesh), Err(EditError::InUse { users: 1, .. })));
    assert!(matches!(scene.remove_image(image), Err(EditError::InUse { users: 1, .. })));
    // Edits that change them.
    scene.edit_instance(instance, |instance| (instance.mesh, instance.material) = (cube, plain)).unwrap();
    assert!(matches!(scene.remove_mesh(cube), Err(EditError::InUse { users: 1, .. })));
    assert!(matches!(scene.remove_material(plain), Err(EditError::InUse { users: 1, .. })));
    assert!(scene.remove_mesh(mesh).is_ok());
    let fill = |plain: &mut Material| {
        plain.textures_mut().into_iter().for_each(|texture| *texture = Some(TextureRef::new(image)));
    };
    scene.edit_material(plain, fill).unwrap();
    assert!(matches!(scene.remove_image(image), Err(EditError::InUse { users: 6, .. })));
    assert!(scene.remove_material(material).is_ok());
    assert!(matches!(scene.remove_image(image), Err(EditError::InUse { users: 5, .. })));
    scene.replace_material(plain, Material::default()).unwrap();
    assert!(scene.remove_image(image).is_ok());
}

#[test]
fn transforms_that_are_not_finite_are_errors_and_change_nothing() {
    let One { mut scene, mesh, material, instance, .. } = one();
    let _ = scene.take_changes();
    let before = scene.clone();
    let name = |name: &str| EditError::NotFinite { what: format!("instance \"{name}\"") };
    for wrong in [translated(DVec3::X * f64::NAN), DAffine3::from_scale(DVec3::INFINITY)] {
        assert_eq!(scene.move_instance(instance, wrong), Err(name("tree")));
        assert_eq!(scene.edit_instance(instance, |tree| tree.world_from_local = wrong), Err(name("tree")));
        let new = Instance::new(mesh, material, wrong).with_name("new");
        assert_eq!(scene.replace_instance(instance, new.clone()), Err(name("new")));
        assert_eq!(scene.insert_instance(new), Err(name("new")));
        assert_eq!(scene.add(triangle(), Material::default(), wrong), Err(name("triangle")));
    }
    assert_eq!(scene, before);
    assert!(scene.take_changes().is_empty());
    let text = name("tree").to_string();
    assert_eq!(
        text,
        "instance \"tree\": its transform has a value that is not finite (allowed: finite numbers)"
    );
}

#[test]
fn poses_with_too_few_joints_are_errors_and_change_nothing() {
    let One { mut scene, material, .. } = one();
    let mut skinned = triangle();
    let influence = |joint| Influence { joint, weight: 1.0 };
    let weights = SkinWeights::new([0, 2, 1].map(influence).to_vec(), 1, &skinned.vertices).unwrap();
    skinned.skin = Some(weights);
    let mesh = scene.insert_mesh(skinned);
    let pose = |joints| MeshPose { joints: vec![DAffine3::IDENTITY; joints].into(), weights: Vec::new() };
    let new = |joints| Instance {
        pose: Some(pose(joints)),
        ..Instance::new(mesh, material, DAffine3::IDENTITY).with_name("fox")
    };
    let key = scene.insert_instance(new(3)).unwrap();
    let _ = scene.take_changes();
    let before = scene.clone();
    for joints in [1, 2] {
        let error = EditError::TooFewJoints { what: "instance \"fox\"".into(), joints, needed: 3 };
        assert_eq!(scene.insert_instance(new(joints)), Err(error.clone()));
        assert_eq!(scene.replace_instance(key, new(joints)), Err(error.clone()));
        assert_eq!(scene.pose_instance(key, DAffine3::IDENTITY, Some(pose(joints))), Err(error));
    }
    assert_eq!(scene, before);
    assert!(scene.take_changes().is_empty());
    // More than are needed, and none, which is at rest.
    for pose in [Some(pose(65_536)), Some(pose(0)), None] {
        assert_eq!(scene.pose_instance(key, DAffine3::IDENTITY, pose), Ok(()));
    }
}

#[test]
fn images_without_the_bytes_of_their_size_are_errors_and_change_nothing() {
    let One { mut scene, image, .. } = one();
    let _ = scene.take_changes();
    let before = scene.clone();
    for (width, height, bytes) in
        [(0, 1, 0), (1, 0, 0), (0, 0, 4), (1, 1, 3), (2, 2, 17), (2, 1, 4), (1 << 31, 1 << 31, 0)]
    {
        let wrong = Image::new("moss", width, height, vec![0; bytes]);
        let error = EditError::ImageSize { what: "image \"moss\"".into(), width, height, bytes };
        assert_eq!(scene.insert_image(wrong.clone()), Err(error.clone()));
        assert_eq!(scene.replace_image(image, wrong), Err(error));
    }
    assert_eq!(scene, before);
    assert!(scene.take_changes().is_empty());
    let good = Image { width: 2, height: 3, rgba8: vec![7; 24], ..pixel("moss") };
    assert_eq!(scene.replace_image(image, good.clone()), Ok(pixel("bark")));
    assert_eq!(scene.image(image), Some(&good));
}

#[test]
fn each_edited_key_is_logged_once() {
    let One { mut scene, mesh, material, image, instance, light: sun } = one();
    let all = Changes {
        meshes: vec![mesh],
        materials: vec![material],
        images: vec![image],
        instances: vec![instance],
    };
    assert_eq!(Changes::insert_all(&scene), all);
    scene.move_instance(instance, translated(DVec3::X)).unwrap();
    assert_eq!(scene.take_changes(), all);
    assert!(scene.take_changes().is_empty());
    // Every kind of edit, twice.
    for i in 0..2 {
        scene.move_instance(instance, translated(DVec3::X * f64::from(i))).unwrap();
        scene.edit_instance(instance, |tree| tree.casts = ShadowCasting::Off).unwrap();
        scene.edit_material(material, |wood| wood.roughness = 0.5).unwrap();
        scene.replace_material(material, textured("wood", image)).unwrap();
        scene.replace_mesh(mesh, triangle()).unwrap();
        scene.replace_image(image, pixel("bark")).unwrap();
        scene.replace_light(sun, light("moon", SUN)).unwrap();
    }
    assert_eq!(scene.take_changes(), all);
    // A light alone logs nothing.
    scene.replace_light(sun, light("moon", POINT)).unwrap();
    scene.set_lights([light("sun", SUN)]);
    assert!(scene.take_changes().is_empty());
    // Removed after an edit; inserted and removed at once.
    scene.move_instance(instance, DAffine3::IDENTITY).unwrap();
    scene.remove_instance(instance).unwrap();
    let short = scene.insert_instance(Instance::new(mesh, material, DAffine3::IDENTITY)).unwrap();
    scene.remove_instance(short).unwrap();
    scene.remove_material(material).unwrap();
    let changes = scene.take_changes();
    let expected =
        Changes { materials: vec![material], instances: vec![instance, short], ..Changes::default() };
    assert_eq!(changes, expected);
    assert!(scene.instance(instance).is_none() && scene.material(material).is_none());
    // A key that takes the place of a removed one is logged separately.
    let material = scene.insert_material(Material::default()).unwrap();
    let next = scene.insert_instance(Instance::new(mesh, material, DAffine3::IDENTITY)).unwrap();
    assert_eq!(scene.take_changes().instances, [next]);
}

#[test]
fn restored_changes_are_taken_again_once() {
    let One { mut scene, mesh, material, image, instance, .. } = one();
    let gone = scene.add(triangle(), Material::default(), DAffine3::IDENTITY).unwrap();
    let _ = scene.take_changes();
    scene.move_instance(instance, translated(DVec3::X)).unwrap();
    scene.replace_mesh(mesh, triangle()).unwrap();
    scene.edit_material(material, |wood| wood.unlit = true).unwrap();
    scene.replace_image(image, pixel("bark")).unwrap();
    scene.remove_instance(gone).unwrap();
    let changes = scene.take_changes();
    let expected = Changes {
        meshes: vec![mesh],
        materials: vec![material],
        images: vec![image],
        instances: vec![instance, gone],
    };
    assert_eq!(changes, expected);
    scene.restore_changes(changes);
    // Edits of what is in the log already, and of something else.
    scene.move_instance(instance, translated(DVec3::Y)).unwrap();
    scene.replace_mesh(mesh, triangle()).unwrap();
    let added = scene.insert_instance(Instance::new(mesh, material, DAffine3::IDENTITY)).unwrap();
    let changes = scene.take_changes();
    assert_eq!(changes, Changes { instances: vec![instance, gone, added], ..expected });
    // Edited between.
    scene.move_instance(added, translated(DVec3::Z)).unwrap();
    scene.restore_changes(changes);
    let mut instances = scene.take_changes().instances;
    instances.sort_unstable();
    let mut once = vec![instance, gone, added];
    once.sort_unstable();
    assert_eq!(instances, once);
    assert!(scene.take_changes().is_empty());
}

#[test]
fn a_key_that_is_removed_before_its_changes_are_restored_is_logged_once() {
    let One { mut scene, instance, .. } = one();
    let changes = scene.take_changes();
    scene.remove_instance(instance).unwrap();
    scene.restore_changes(changes);
    assert_eq!(scene.take_changes().instances, [instance]);
}

#[test]
fn scenes_are_equal_if_keys_and_values_are() {
    let One { scene, mesh, material, instance, light: sun, .. } = one();
    assert_eq!(scene, one().scene);
    // The log does not count, nor edits that were undone.
    let mut same = scene.clone();
    let _ = same.take_changes();
    same.move_instance(instance, translated(DVec3::X)).unwrap();
    assert_ne!(same, scene);
    same.move_instance(instance, DAffine3::IDENTITY).unwrap();
    assert_eq!(same, scene);
    let short = same.insert_mesh(triangle());
    same.remove_mesh(short).unwrap();
    assert_eq!(same, scene);

    type Edit<'e> = &'e dyn Fn(&mut Scene);
    let edits: [Edit<'_>; 8] = [
        &|scene| scene.edit_instance(instance, |tree| tree.receives_shadows = false).unwrap(),
        &|scene| scene.edit_material(material, |wood| wood.unlit = true).unwrap(),
        &|scene| drop(scene.replace_mesh(mesh, Mesh::cuboid(DVec3::ZERO, DVec3::ONE)).unwrap()),
        &|scene| drop(scene.replace_light(sun, light("moon", SUN)).unwrap()),
        &|scene| assert!(scene.insert_image(pixel("bark")).is_ok()),
        &|scene| drop(scene.remove_instance(instance).unwrap()),
        &|scene| scene.cameras.push(scene.framing_camera(1.0)),
        &|scene| scene.notes.push("a note".into()),
    ];
    for (index, edit) in edits.iter().enumerate() {
        let mut other = scene.clone();
        edit(&mut other);
        assert_ne!(other, scene, "edit {index}");
    }
    // The same value with another key is another scene.
    let mut other = scene.clone();
    let removed = other.remove_instance(instance).unwrap();
    other.insert_instance(removed).unwrap();
    assert_ne!(other, scene);
}
