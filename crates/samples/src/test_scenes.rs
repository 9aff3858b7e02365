//! Small procedural scenes whose shadows are difficult for shadow maps, for measurements.

mod stained_glass;

pub use stained_glass::stained_glass;

use glam::{DAffine3, DQuat, DVec2, DVec3, Vec3, Vec4};

use crate::insert::{insert_instance, insert_material};
use crate::mesh_builder::{MeshBuilder, box_on_ground, cuboid};
use crate::round::{lathe, sphere};
use shadowgraph_scene::{Light, LightKind, Material, Scene};

/// The names of all test scenes.
pub const TEST_SCENES: [&str; 9] =
    ["cube", "slats", "stairs", "columns", "eaves", "spheres", "tower", "interior", "cornell"];

/// The heading of the sunlight at which the tower's shadow falls on the boxes, from east towards north, degrees.
pub const TOWER_SUN_HEADING_DEG: f64 = 40.0;

/// Creates a test scene by its name; `None` if there is none. It has neither lights nor cameras.
///
/// - `cube`: a box of 2 m, turned by 20 degrees, on a plane.
/// - `slats`: a fence of upright slats, 2 cm wide and 8 cm apart.
/// - `stairs`: nine steps between two walls.
/// - `columns`: two rows of round columns over 150 m.
/// - `eaves`: a house with an overhanging roof, 5 cm above its walls.
/// - `spheres`: balls of 10 cm to 1 m that touch the ground, and one that does not.
/// - `tower`: boxes of 30 cm at the edge of the shadow of a tower of 60 m, 90 m away towards the sun.
/// - `interior`: a room with walls of 5 cm, two windows and a doorway.
/// - `cornell`: a Cornell box of planes without thickness, open to the front, with two boxes of planes in it.
///
/// ```
/// use shadowgraph_samples::test_scenes::{TEST_SCENES, test_scene};
/// assert!(TEST_SCENES.iter().all(|name| test_scene(name).is_some_and(|scene| scene.triangle_count() > 0)));
/// assert!(test_scene("castle").is_none());
/// ```
#[must_use]
pub fn test_scene(name: &str) -> Option<Scene> {
    let objects = match name {
        "cube" => cube(),
        "slats" => slats(),
        "stairs" => stairs(),
        "columns" => columns(),
        "eaves" => eaves(),
        "spheres" => spheres(),
        "tower" => tower(),
        "interior" => interior(),
        "cornell" => cornell(),
        _ => return None,
    };
    let base_color = Vec4::new(0.6, 0.6, 0.6, 1.0);
    let grey = Material { name: "grey".into(), base_color, metallic: 0.0, ..Material::default() };
    let mut scene = Scene::default();
    let grey = insert_material(&mut scene, grey);
    for (name, shape) in objects {
        let mesh = scene.insert_mesh(shape.finish(name));
        insert_instance(&mut scene, name, mesh, grey, DAffine3::IDENTITY);
    }
    Some(scene)
}

/// Creates a sun that casts shadows from its elevation above the horizon and the heading of its light, from east (+X)
/// towards north (-Z), both in degrees.
#[must_use]
pub fn sun(elevation_deg: f64, heading_deg: f64) -> Light {
    let (sin, cos) = elevation_deg.to_radians().sin_cos();
    let travel = heading(heading_deg);
    Light {
        name: Some("sun".to_owned()),
        kind: LightKind::Directional { direction: travel * cos - DVec3::Y * sin },
        color: Vec3::ONE,
        intensity: 20_000.0,
        casts_shadow: true,
    }
}

fn heading(degrees: f64) -> DVec3 {
    let (north, east) = degrees.to_radians().sin_cos();
    DVec3::new(east, 0.0, -north)
}

type Objects = Vec<(&'static str, MeshBuilder)>;

/// Returns a floor that extends `half_m` to each side, divided into cells to avoid huge triangles.
fn ground(half_m: f64) -> (&'static str, MeshBuilder) {
    let mut shape = MeshBuilder::default();
    let cells = (half_m / 10.0).ceil().max(1.0);
    let (cell, count) = (2.0 * half_m / cells, cells as u32);
    for row in 0..count {
        for column in 0..count {
            let corner = DVec3::new(f64::from(column), 0.0, f64::from(row) + 1.0) * cell;
            let corner = corner - DVec3::new(half_m, 0.0, half_m);
            shape.parallelogram(corner, DVec3::X * cell, DVec3::NEG_Z * cell);
        }
    }
    ("ground", shape)
}

fn cube() -> Objects {
    let mut turned = MeshBuilder::default();
    turned.append(&box_on_ground(2.0, 2.0, 2.0), DAffine3::from_rotation_y(20f64.to_radians()));
    vec![ground(40.0), ("cube", turned)]
}

fn slats() -> Objects {
    let slat = box_on_ground(0.02, 1.6, 0.02);
    let mut fence = MeshBuilder::default();
    for i in 0..60 {
        fence.append_translated(&slat, DVec3::new(0.1 * f64::from(i) - 2.95, 0.0, 0.0));
    }
    for height in [0.25, 1.3] {
        let (min, max) = (DVec3::new(-3.0, height, -0.02), DVec3::new(3.0, height + 0.05, -0.01));
        fence.append_translated(&cuboid(min, max), DVec3::ZERO);
    }
    vec![ground(40.0), ("slats", fence)]
}

fn stairs() -> Objects {
    const STEPS: u32 = 9;
    let (rise, tread) = (0.17, 0.3);
    let mut steps = MeshBuilder::default();
    for i in 0..STEPS {
        let top = rise * f64::from(i + 1);
        let front = -tread * f64::from(i);
        let step = cuboid(DVec3::new(-1.6, top - rise, front - tread), DVec3::new(1.6, top, front));
        steps.append_translated(&step, DVec3::ZERO);
    }
    let length = tread * f64::from(STEPS);
    for side in [-1.75, 1.75] {
        steps.append_translated(&box_on_ground(0.3, 2.2, length + 0.6), DVec3::new(side, 0.0, -length * 0.5));
    }
    vec![ground(40.0), ("stairs", steps)]
}

fn columns() -> Objects {
    let profile = |points: &[(f64, f64)]| points.iter().map(|&(r, y)| DVec2::new(r, y)).collect();
    let shaft = lathe(&[profile(&[(0.3, 0.0), (0.26, 4.0)]), profile(&[(0.26, 4.0), (0.0, 4.0)])], 24);
    let mut rows = MeshBuilder::default();
    for i in 0..36 {
        for side in [-2.5, 2.5] {
            rows.append_translated(&shaft, DVec3::new(side, 0.0, -4.2 * f64::from(i)));
        }
    }
    vec![ground(180.0), ("columns", rows)]
}

fn eaves() -> Objects {
    let mut house = cuboid(DVec3::new(-4.0, 0.0, -3.0), DVec3::new(4.0, 3.0, 3.0));
    let (min, max) = (DVec3::new(-4.6, 3.05, -3.6), DVec3::new(4.6, 3.17, 3.6));
    house.append_translated(&cuboid(min, max), DVec3::ZERO);
    vec![ground(40.0), ("house", house)]
}

fn spheres() -> Objects {
    let mut balls = MeshBuilder::default();
    for (radius, x, gap) in
        [(0.1, -1.6, 0.0), (0.25, -1.0, 0.0), (0.5, 0.0, 0.0), (1.0, 2.0, 0.0), (0.3, -2.6, 0.5)]
    {
        balls.append_translated(&sphere(radius, 48), DVec3::new(x, radius + gap, 0.0));
    }
    vec![ground(40.0), ("balls", balls)]
}

fn tower() -> Objects {
    let towards_sun = -heading(TOWER_SUN_HEADING_DEG);
    // Offset sideways, so that one edge of the shadow crosses the boxes.
    let aside = towards_sun.cross(DVec3::Y) * 5.0;
    let mut tower = MeshBuilder::default();
    tower.append_translated(&box_on_ground(8.0, 60.0, 8.0), towards_sun * 90.0 + aside);
    let mut boxes = MeshBuilder::default();
    for i in 0..25 {
        let (column, row) = (f64::from(i % 5), f64::from(i / 5));
        boxes
            .append_translated(&box_on_ground(0.3, 0.3, 0.3), DVec3::new(column - 2.0, 0.0, row - 2.0) * 1.5);
    }
    vec![ground(140.0), ("tower", tower), ("boxes", boxes)]
}

fn interior() -> Objects {
    const WALL: f64 = 0.05;
    let (width, depth, height) = (6.0, 5.0, 2.8);
    let (x, z) = (width * 0.5, depth * 0.5);
    let mut room = MeshBuilder::default();
    let mut wall =
        |min: [f64; 3], max: [f64; 3]| room.append_translated(&cuboid(min.into(), max.into()), DVec3::ZERO);
    wall([-x - WALL, height, -z - WALL], [x + WALL, height + WALL, z + WALL]);
    wall([-x, 0.0, -z - WALL], [x, height, -z]);
    wall([x, 0.0, -z - WALL], [x + WALL, height, z + WALL]);
    // A doorway in the front and two windows in the west.
    wall([-x, 0.0, z], [1.0, height, z + WALL]);
    wall([2.0, 0.0, z], [x, height, z + WALL]);
    wall([1.0, 2.1, z], [2.0, height, z + WALL]);
    wall([-x - WALL, 0.0, -z - WALL], [-x, 0.9, z + WALL]);
    wall([-x - WALL, 2.2, -z - WALL], [-x, height, z + WALL]);
    for (from, to) in [(-z - WALL, -1.7), (-0.5, 0.5), (1.7, z + WALL)] {
        wall([-x - WALL, 0.9, from], [-x, 2.2, to]);
    }
    room.append_translated(&box_on_ground(1.6, 0.75, 0.9), DVec3::new(-0.8, 0.0, 0.0));
    vec![ground(30.0), ("walls", room)]
}

fn cornell() -> Objects {
    let (width, height, depth) = (DVec3::X * 4.0, DVec3::Y * 3.0, DVec3::Z * 4.0);
    let corner = DVec3::new(-2.0, 0.0, -2.0);
    let mut room = MeshBuilder::default();
    room.parallelogram(corner, depth, width);
    room.parallelogram(corner, width, height);
    room.parallelogram(corner, height, depth);
    room.parallelogram(corner + width, depth, height);
    // The ceiling covers the back half.
    room.parallelogram(corner + height, width, depth * 0.5);
    let mut boxes = MeshBuilder::default();
    boxes.append(&box_on_ground(1.2, 1.2, 1.2), turned_to(DVec3::new(0.75, 0.0, 0.6), -18.0));
    boxes.append(&box_on_ground(1.2, 2.4, 1.2), turned_to(DVec3::new(-0.7, 0.0, -0.7), 20.0));
    vec![("walls", room), ("boxes", boxes)]
}

fn turned_to(position: DVec3, degrees: f64) -> DAffine3 {
    DAffine3::from_rotation_translation(DQuat::from_rotation_y(degrees.to_radians()), position)
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use shadowgraph_scene::{CasterMode, Instance, InstanceKey};

    use super::*;

    #[test]
    fn every_test_scene_stands_on_the_ground_and_is_small_enough_to_trace() {
        for name in TEST_SCENES {
            let scene = test_scene(name).unwrap();
            let bounds = scene.bounds();
            assert!(scene.triangle_count() < 60_000, "{name}: {}", scene.triangle_count());
            assert!(bounds.min.y.abs() < 1e-6 && bounds.max.y > 1.0, "{name}: {bounds:?}");
            assert_eq!(scene.meshes().len(), scene.instances().len());
        }
    }

    #[test]
    fn the_sun_has_the_direction_of_its_angles() {
        let LightKind::Directional { direction } = sun(30.0, 90.0).kind else { unreachable!() };
        assert!((direction - DVec3::new(0.0, -0.5, -(0.75f64.sqrt()))).length() < 1e-12, "{direction}");
        let LightKind::Directional { direction } = sun(90.0, 0.0).kind else { unreachable!() };
        assert!((direction - DVec3::NEG_Y).length() < 1e-12, "{direction}");
    }

    #[test]
    fn stained_glass_casts_coloured_shadows_and_stone_does_not() {
        let scene = stained_glass();
        let tints = |(_, instance): &(InstanceKey, &Instance)| {
            scene.material(instance.material).unwrap().caster_mode() == CasterMode::Tint
        };
        assert_eq!(scene.instances().filter(tints).count(), 8);
        assert_eq!((scene.lights().len(), scene.cameras.len(), scene.instances().len()), (2, 1, 11));
    }
}
