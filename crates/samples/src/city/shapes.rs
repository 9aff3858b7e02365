//! The meshes of the city, each with the material that it has by itself.

use std::f64::consts::{PI, TAU};

use glam::{DAffine3, DQuat, DVec2, DVec3};

use super::materials::Materials;
use super::random::Random;
use crate::mesh_builder::{MeshBuilder, SurfacePoint, box_on_ground, cuboid};
use crate::round::lathe;
use shadowgraph_scene::{MaterialKey, MeshKey, Scene};

/// A mesh, its material, and the name of its instances.
#[derive(Clone, Copy)]
pub(super) struct CityMesh {
    pub(super) name: &'static str,
    pub(super) mesh: MeshKey,
    pub(super) material: MaterialKey,
}

/// The meshes of the city.
pub(super) struct Shapes {
    /// A box of 1 m on the ground.
    pub(super) block: CityMesh,
    /// A square of 1 m that faces up.
    pub(super) plane: CityMesh,
    /// A window of 1 m by 1 m that looks along +Z, without a back.
    pub(super) window: CityMesh,
    /// Trunk and crown of a tree of 7 m with many leaves.
    pub(super) tree: [CityMesh; 2],
    /// Trunk and crown of a tree of the same size with few leaves.
    pub(super) far_tree: [CityMesh; 2],
    /// Mast and lens of a street light; its arm reaches out along +Z.
    pub(super) street_light: [CityMesh; 2],
    /// The body of a car that drives along +Z; it is painted.
    pub(super) car: CityMesh,
    /// The windows of the car and its wheels.
    pub(super) car_fittings: [CityMesh; 2],
    /// A water tank on a roof.
    pub(super) tank: CityMesh,
}

/// Distance of the lens of a street light from its mast, and its height above the foot, metres.
pub(super) const LENS: DVec2 = DVec2::new(1.5, 6.0);

impl Shapes {
    pub(super) fn new(scene: &mut Scene, materials: &Materials) -> Self {
        let mut part = |name: &'static str, shape: MeshBuilder, material| CityMesh {
            name,
            mesh: scene.insert_mesh(shape.finish(name)),
            material,
        };
        let mut plane = MeshBuilder::default();
        plane.parallelogram(DVec3::new(-0.5, 0.0, 0.5), DVec3::X, DVec3::NEG_Z);
        Self {
            block: part("block", box_on_ground(1.0, 1.0, 1.0), materials.walls[0]),
            plane: part("plane", plane, materials.asphalt),
            window: part("window", window(), materials.windows[0]),
            tree: [
                part("trunk", trunk(10), materials.bark),
                part("crown", crown(1_150, 0.55), materials.leaves),
            ],
            far_tree: [
                part("trunk", trunk(4), materials.bark),
                part("crown", crown(24, 2.4), materials.leaves),
            ],
            street_light: [part("mast", mast(), materials.steel), part("lens", lens(), materials.lens)],
            car: part("car", car_body(), materials.paints[0]),
            car_fittings: [
                part("car windows", car_windows(), materials.windows[0]),
                part("wheels", wheels(), materials.tyre),
            ],
            tank: part("tank", tank(), materials.bark),
        }
    }
}

fn window() -> MeshBuilder {
    let (min, max) = (DVec3::new(-0.5, 0.0, 0.0), DVec3::new(0.5, 1.0, 1.0));
    let size = max - min;
    let (x, y, z) = (DVec3::X * size.x, DVec3::Y * size.y, DVec3::Z * size.z);
    let mut shape = MeshBuilder::default();
    shape.parallelogram(min + z, x, y);
    shape.parallelogram(min + x + z, -z, y);
    shape.parallelogram(min, z, y);
    shape.parallelogram(min + y + z, x, -z);
    shape.parallelogram(min, x, z);
    shape
}

/// Returns a trunk of 2.6 m with branches inside of the crown.
fn trunk(segments: u32) -> MeshBuilder {
    let profile = [(0.20, 0.0), (0.14, 2.6), (0.05, 5.2)].map(|(radius, height)| DVec2::new(radius, height));
    lathe(&[profile.to_vec()], segments)
}

/// Returns cards with leaves, spread over a ball of 2.4 m around a point 4.6 m above the ground.
fn crown(cards: u32, size_m: f64) -> MeshBuilder {
    let mut random = Random::new(5, cards);
    let mut shape = MeshBuilder::default();
    for _ in 0..cards {
        let (cos, angle) = (random.between(-1.0, 1.0), random.between(0.0, TAU));
        let sin = (1.0 - cos * cos).sqrt();
        let outwards = DVec3::new(sin * angle.cos(), cos, sin * angle.sin());
        // More of them near the surface of the crown.
        let radius = 2.1 * random.between(0.15, 1.0).cbrt();
        let center = DVec3::Y * 4.6 + outwards * radius * DVec3::new(1.0, 1.1, 1.0);
        let tilt = DQuat::from_rotation_y(random.between(0.0, TAU))
            * DQuat::from_rotation_x(random.between(0.0, PI));
        let (edge_u, edge_v) = (tilt * DVec3::X * size_m, tilt * DVec3::Y * size_m);
        let corner = center - (edge_u + edge_v) * 0.5;
        // Lit like the crown as a whole, as usual for leaves on cards.
        shape.grid(1, 1, |u, v| SurfacePoint {
            position: corner + edge_u * u + edge_v * v,
            normal: (outwards + tilt * DVec3::Z * 0.001).normalize(),
            uv: DVec2::new(u, 1.0 - v),
        });
    }
    shape
}

fn mast() -> MeshBuilder {
    let (reach, height) = (LENS.x, LENS.y);
    let pole = [(0.09, 0.0), (0.05, height)].map(|(radius, height)| DVec2::new(radius, height));
    let mut shape = lathe(&[pole.to_vec()], 6);
    shape.append(
        &cuboid(DVec3::new(-0.04, height, -0.04), DVec3::new(0.04, height + 0.08, reach + 0.3)),
        DAffine3::IDENTITY,
    );
    shape.append_translated(&box_on_ground(0.3, 0.3, 0.3), DVec3::ZERO);
    shape
}

fn lens() -> MeshBuilder {
    cuboid(DVec3::new(-0.12, LENS.y - 0.06, LENS.x - 0.3), DVec3::new(0.12, LENS.y, LENS.x + 0.3))
}

/// Returns the body of a car of 4.4 m, without its windows.
fn car_body() -> MeshBuilder {
    let mut shape = cuboid(DVec3::new(-0.9, 0.28, -2.2), DVec3::new(0.9, 0.86, 2.2));
    shape.append_translated(&cuboid(DVec3::new(-0.78, 1.38, -1.3), DVec3::new(0.78, 1.44, 0.6)), DVec3::ZERO);
    for (x, z) in [(-0.74, -1.3), (0.74, -1.3), (-0.74, 0.6), (0.74, 0.6), (-0.74, -0.3), (0.74, -0.3)] {
        shape.append_translated(&box_on_ground(0.08, 0.54, 0.08), DVec3::new(x, 0.86, z));
    }
    shape
}

fn car_windows() -> MeshBuilder {
    cuboid(DVec3::new(-0.73, 0.86, -1.28), DVec3::new(0.73, 1.38, 0.58))
}

fn wheels() -> MeshBuilder {
    let profile =
        |points: [(f64, f64); 2]| points.map(|(radius, height)| DVec2::new(radius, height)).to_vec();
    let runs = [profile([(0.34, 0.0), (0.34, 0.22)]), profile([(0.34, 0.22), (0.0, 0.22)])];
    let wheel = lathe(&runs, 10);
    let mut shape = MeshBuilder::default();
    for (side, z) in [(-1.0, -1.4), (1.0, -1.4), (-1.0, 1.4), (1.0, 1.4)] {
        // The closed end of the wheel looks outwards.
        let turned = DQuat::from_rotation_z(-side * PI * 0.5);
        let at = DVec3::new(side * 0.70, 0.34, z);
        shape.append(&wheel, DAffine3::from_rotation_translation(turned, at));
    }
    shape
}

fn tank() -> MeshBuilder {
    let line = |points: &[(f64, f64)]| points.iter().map(|&(r, y)| DVec2::new(r, y)).collect::<Vec<_>>();
    let mut shape = lathe(&[line(&[(1.2, 1.6), (1.2, 4.0)]), line(&[(1.3, 4.0), (0.0, 4.9)])], 12);
    for (x, z) in [(-0.8, -0.8), (0.8, -0.8), (-0.8, 0.8), (0.8, 0.8)] {
        shape.append_translated(&box_on_ground(0.14, 1.7, 0.14), DVec3::new(x, 0.0, z));
    }
    shape
}
