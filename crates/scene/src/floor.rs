//! Whether a scene has a floor.

use glam::DVec3;

use crate::bounds::Aabb;
use crate::framing::triangles;
use crate::ground::GroundPlane;
use crate::material::AlphaMode;
use crate::scene::Scene;

/// Number of cells per side of the grid over the scene.
const CELLS: usize = 32;
/// The share of the cells that must have a floor.
const COVERED: f64 = 0.5;
/// The height below which a surface that faces up is a floor, as a share of the scene's height.
const LOW: f64 = 0.25;
/// The height of a floor at the edge of the scene, as a share of the scene's size.
const BOTTOM: f64 = 0.03;
/// The least cosine of the slope of a floor.
const FLAT: f64 = 0.7;
/// A scene of less height over its width is a flat thing, which needs ground below it.
const THIN: f64 = 0.02;
/// The distance of the ground below a flat thing, relative to its width.
const BELOW_THIN: f64 = 0.1;

impl Scene {
    /// Returns the ground that the scene needs: a plane under everything that [`framing_camera`](Self::framing_camera) shows, or
    /// `None` if the scene has a floor, or nothing at all. A floor is an opaque surface that faces up, at the bottom of at least half of
    /// the scene; along at least half of its outline, it is the bottom of the scene and nothing stands on it. Under a flat thing, such as a single sheet, the plane is a tenth of its width lower.
    #[must_use]
    pub fn missing_ground(&self) -> Option<GroundPlane> {
        let framed = self.framed();
        let bounds = framed.bounds;
        if bounds.is_empty() {
            return None;
        }
        let size = bounds.max - bounds.min;
        let width = size.x.max(size.z);
        if size.y < THIN * width {
            return Some(GroundPlane { height_world: bounds.min.y - BELOW_THIN * width });
        }
        let mut grid = Grid::new(bounds);
        for instance in &framed.instances {
            let material = self.material(instance.material);
            let is_opaque = material.is_some_and(|material| material.alpha == AlphaMode::Opaque);
            let Some(mesh) = self.mesh(instance.mesh) else { continue };
            triangles(mesh, &instance.world_from_local).for_each(|triangle| grid.add(triangle, is_opaque));
        }
        (!grid.has_floor()).then_some(GroundPlane { height_world: bounds.min.y })
    }
}

/// The surfaces over the cells of a horizontal grid.
struct Grid {
    bounds: Aabb,
    cells: Vec<Cell>,
}

/// The surfaces at the centre of a cell, metres above the bottom.
#[derive(Clone, Copy)]
struct Cell {
    /// The lowest that is opaque and faces up.
    floor: f64,
    /// The lowest of any kind.
    lowest: f64,
    /// The highest of any kind.
    highest: f64,
}

impl Cell {
    const EMPTY: Self = Self { floor: f64::INFINITY, lowest: f64::INFINITY, highest: f64::NEG_INFINITY };
}

impl Grid {
    fn new(bounds: Aabb) -> Self {
        Self { bounds, cells: vec![Cell::EMPTY; CELLS * CELLS] }
    }

    fn add(&mut self, corners: [DVec3; 3], is_opaque: bool) {
        let size = (self.bounds.max - self.bounds.min).max(DVec3::splat(1e-12));
        // The grid is CELLS wide; y is metres above the bottom.
        let scale = DVec3::new(CELLS as f64 / size.x, 1.0, CELLS as f64 / size.z);
        let normal = (corners[1] - corners[0]).cross(corners[2] - corners[0]).normalize_or_zero();
        let is_floor = is_opaque && normal.y > FLAT;
        let [a, b, c] = corners.map(|corner| (corner - self.bounds.min) * scale);
        let doubled_area = (b - a).z * (c - a).x - (b - a).x * (c - a).z;
        if doubled_area.abs() < 1e-12 {
            return;
        }
        let cells = |low: f64, high: f64| {
            let first = (low - 0.5).ceil().max(0.0) as usize;
            first..((high + 0.5).floor().max(0.0) as usize).min(CELLS)
        };
        for z in cells(a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z)) {
            for x in cells(a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x)) {
                let center = DVec3::new(x as f64 + 0.5, 0.0, z as f64 + 0.5);
                let weight = |from: DVec3, to: DVec3| {
                    ((to - from).z * (center - from).x - (to - from).x * (center - from).z) / doubled_area
                };
                let weights = [weight(b, c), weight(c, a), weight(a, b)];
                if weights.iter().all(|weight| *weight >= 0.0) {
                    let height = weights[0] * a.y + weights[1] * b.y + weights[2] * c.y;
                    let cell = &mut self.cells[z * CELLS + x];
                    cell.lowest = cell.lowest.min(height);
                    cell.highest = cell.highest.max(height);
                    cell.floor = if is_floor { cell.floor.min(height) } else { cell.floor };
                }
            }
        }
    }

    /// Returns whether enough cells have a floor, and enough at the edge nothing but a floor at the bottom. A cell has a floor if a
    /// surface that faces up is low, or has nothing below it.
    fn has_floor(&self) -> bool {
        let low = LOW * (self.bounds.max.y - self.bounds.min.y);
        let has_floor =
            |cell: &Cell| cell.floor.is_finite() && (cell.floor <= low || cell.floor <= cell.lowest);
        let at_bottom = BOTTOM * (self.bounds.max - self.bounds.min).max_element();
        let is_bare = |cell: &Cell| cell.floor <= at_bottom && cell.highest - cell.floor <= low;
        let at_edge =
            |index: usize| [index % CELLS, index / CELLS].iter().any(|at| [0, CELLS - 1].contains(at));
        let (edge, all): (Vec<_>, Vec<_>) = {
            let numbered = || self.cells.iter().enumerate();
            let edge = numbered().filter(|(index, _)| at_edge(*index)).map(|(_, cell)| is_bare(cell));
            (edge.collect(), numbered().map(|(_, cell)| has_floor(cell)).collect())
        };
        let share = |cells: &[bool]| cells.iter().filter(|has| **has).count() as f64 / cells.len() as f64;
        share(&edge) >= COVERED && share(&all) >= COVERED
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use glam::DAffine3;

    use super::*;
    use crate::material::Material;
    use crate::mesh::{Mesh, Vertex};
    use crate::scene::Instance;

    fn scene(meshes: Vec<Mesh>) -> Scene {
        let mut scene = Scene::default();
        let material = scene.insert_material(Material::default()).unwrap();
        for mesh in meshes {
            let mesh = scene.insert_mesh(mesh);
            scene.insert_instance(Instance::new(mesh, material, DAffine3::IDENTITY)).unwrap();
        }
        scene
    }

    /// A hill on 20 x 20 m of flat land.
    fn hill() -> Mesh {
        let height = |x: f32, z: f32| (6.0 - (x * x + z * z) * 0.1).max(0.0);
        let corner = |i: u32| {
            let [x, z] = [i % 21, i / 21].map(|step| step as f32 - 10.0);
            Vertex { position: [x, height(x, z), z], ..Vertex::default() }
        };
        let quad = |i: u32| [i, i + 21, i + 1, i + 1, i + 21, i + 22];
        let indices = (0..20).flat_map(|row| (0..20).map(move |column| row * 21 + column)).flat_map(quad);
        Mesh::new("hill", (0..21 * 21).map(corner).collect(), indices.collect())
    }

    #[test]
    fn a_slab_and_a_hill_are_floors() {
        let slab = || Mesh::cuboid(DVec3::new(-5.0, -0.2, -5.0), DVec3::new(5.0, 0.0, 5.0));
        let chair = || Mesh::cuboid(DVec3::ZERO, DVec3::new(1.0, 2.0, 1.0));
        assert_eq!(scene(vec![slab(), chair()]).missing_ground(), None);
        assert_eq!(scene(vec![hill()]).missing_ground(), None);
        assert_eq!(Scene::default().missing_ground(), None);
    }

    #[test]
    fn a_box_and_a_table_stand_on_missing_ground() {
        let cube = Mesh::cuboid(DVec3::new(0.0, 1.0, 0.0), DVec3::new(1.0, 2.0, 1.0));
        assert_eq!(scene(vec![cube]).missing_ground(), Some(GroundPlane { height_world: 1.0 }));
        let top = Mesh::cuboid(DVec3::new(-1.0, 0.7, -1.0), DVec3::new(1.0, 0.8, 1.0));
        let leg = Mesh::cuboid(DVec3::new(-0.1, 0.0, -0.1), DVec3::new(0.1, 0.7, 0.1));
        assert_eq!(scene(vec![top, leg]).missing_ground(), Some(GroundPlane { height_world: 0.0 }));
    }

    #[test]
    fn a_hut_stands_on_missing_ground_though_it_has_a_floor() {
        let floor = Mesh::cuboid(DVec3::new(-5.0, -0.1, -5.0), DVec3::new(5.0, 0.0, 5.0));
        let wall = |min, max| Mesh::cuboid(min, max);
        let walls = [
            wall(DVec3::new(-5.0, 0.0, -5.0), DVec3::new(5.0, 3.0, -4.6)),
            wall(DVec3::new(-5.0, 0.0, 4.6), DVec3::new(5.0, 3.0, 5.0)),
            wall(DVec3::new(-5.0, 0.0, -5.0), DVec3::new(-4.6, 3.0, 5.0)),
        ];
        let hut = [vec![floor], walls.to_vec()].concat();
        assert_eq!(scene(hut).missing_ground(), Some(GroundPlane { height_world: f64::from(-0.1f32) }));
    }

    #[test]
    fn a_sheet_hovers_above_the_ground() {
        let sheet = Mesh::cuboid(DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 0.001, 1.0));
        let ground = scene(vec![sheet]).missing_ground().unwrap();
        assert!((ground.height_world + 0.2).abs() < 1e-9);
    }
}
