//! What the camera that frames a scene shows, and whether there is a floor under it.

use std::collections::BTreeMap;

use glam::{DAffine3, DMat3, DVec3};

use crate::bounds::Aabb;
use crate::camera::Camera;
use crate::mesh::Mesh;
use crate::scene::{Instance, Scene};

/// The share of the surface area that small things far away from the rest may have to be left out.
const STRAY_AREA: f64 = 0.02;
/// The radius of the rest over that of everything, from which on nothing is left out.
const WORTH_IT: f64 = 0.8;

/// The part of a scene that a camera frames.
pub(crate) struct Framed<'s> {
    /// The instances.
    pub(crate) instances: Vec<&'s Instance>,
    /// Their bounds, metres.
    pub(crate) bounds: Aabb,
}

/// An instance with its bounds and its surface area.
struct Candidate<'s> {
    instance: &'s Instance,
    bounds: Aabb,
    area: f64,
}

impl Scene {
    /// Returns a camera that frames the scene from the front, the right and above, as near as possible with every vertex in the
    /// image. Small things far away from the rest, together at most 2 % of the surface area, may be outside.
    ///
    /// `aspect` is the image's width over its height, above 0.
    #[must_use]
    pub fn framing_camera(&self, aspect: f64) -> Camera {
        let framed = self.framed();
        let points = framed.instances.iter().flat_map(|instance| self.points_of(instance));
        Camera::framing_points(points, &framed.bounds, aspect)
    }

    /// Returns what a camera frames: everything that is seen but small things far away.
    pub(crate) fn framed(&self) -> Framed<'_> {
        let mut local_areas = BTreeMap::new();
        let candidates =
            self.instances().filter(|(_, instance)| instance.is_seen()).map(|(key, instance)| {
                let mut area_of = |mesh: &Mesh| match similarity(&instance.world_from_local) {
                    Some(scale) => {
                        let local_area = *local_areas
                            .entry(instance.mesh)
                            .or_insert_with(|| area(mesh, &DAffine3::IDENTITY));
                        scale * scale * local_area
                    }
                    None => area(mesh, &instance.world_from_local),
                };
                let area = self.mesh(instance.mesh).map_or(0.0, &mut area_of);
                Candidate { instance, bounds: self.instance_bounds(key), area }
            });
        let all: Vec<_> = candidates.filter(|candidate| !candidate.bounds.is_empty()).collect();
        let bounds = union_of(&all);
        let kept = without_strays(&all);
        let kept_bounds = union_of(kept.iter().copied());
        if !kept.is_empty() && kept_bounds.radius() < WORTH_IT * bounds.radius() {
            let instances = kept.into_iter().map(|candidate| candidate.instance).collect();
            return Framed { instances, bounds: kept_bounds };
        }
        Framed { instances: all.iter().map(|candidate| candidate.instance).collect(), bounds }
    }

    /// Returns the vertices of an instance, or the corners of its bounds if its mesh is deformed.
    fn points_of(&self, instance: &Instance) -> Vec<DVec3> {
        let Some(mesh) = self.mesh(instance.mesh) else { return Vec::new() };
        match &instance.pose {
            Some(pose) => mesh.posed_bounds(pose).transformed(&instance.world_from_local).corners().to_vec(),
            None => mesh
                .vertices
                .iter()
                .map(|vertex| world(&instance.world_from_local, vertex.position))
                .collect(),
        }
    }
}

fn union_of<'a, 's: 'a>(candidates: impl IntoIterator<Item = &'a Candidate<'s>>) -> Aabb {
    candidates.into_iter().fold(Aabb::EMPTY, |bounds, candidate| bounds.union(&candidate.bounds))
}

/// Returns the candidates without those that are farthest from the middle and have little area together.
fn without_strays<'a, 's>(all: &'a [Candidate<'s>]) -> Vec<&'a Candidate<'s>> {
    let total: f64 = all.iter().map(|candidate| candidate.area).sum();
    let weighted: DVec3 = all.iter().map(|candidate| candidate.bounds.center() * candidate.area).sum();
    let Some(middle) = (total > 0.0).then(|| weighted / total) else { return all.iter().collect() };
    let farthest = |candidate: &Candidate<'_>| {
        candidate.bounds.corners().into_iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max)
    };
    let mut by_distance: Vec<_> = all.iter().map(|candidate| (farthest(candidate), candidate)).collect();
    by_distance.sort_by(|a, b| b.0.total_cmp(&a.0));
    let mut left_out = 0.0;
    let kept = by_distance.into_iter().filter(|(_, candidate)| {
        let is_stray = left_out + candidate.area <= STRAY_AREA * total;
        left_out += if is_stray { candidate.area } else { 0.0 };
        !is_stray
    });
    kept.map(|(_, candidate)| candidate).collect()
}

fn world(world_from_local: &DAffine3, position: [f32; 3]) -> DVec3 {
    world_from_local.transform_point3(DVec3::from(position.map(f64::from)))
}

/// Returns the corners of each triangle in world space, in the mesh's rest pose.
pub(crate) fn triangles<'m>(
    mesh: &'m Mesh,
    world_from_local: &DAffine3,
) -> impl Iterator<Item = [DVec3; 3]> + 'm {
    let world_from_local = *world_from_local;
    mesh.indices.as_chunks::<3>().0.iter().filter_map(move |triangle| {
        let corner = |index: u32| Some(world(&world_from_local, mesh.vertices.get(index as usize)?.position));
        let [a, b, c] = *triangle;
        Some([corner(a)?, corner(b)?, corner(c)?])
    })
}

/// Returns the scale of a transform that scales all directions alike.
fn similarity(world_from_local: &DAffine3) -> Option<f64> {
    let axes = world_from_local.matrix3;
    let squares = DMat3::from_diagonal(DVec3::splat(axes.x_axis.length_squared()));
    let tolerance = 1e-9 * squares.x_axis.x;
    (axes.transpose() * axes).abs_diff_eq(squares, tolerance).then(|| axes.x_axis.length())
}

/// Returns the surface area of an instance, square metres.
fn area(mesh: &Mesh, world_from_local: &DAffine3) -> f64 {
    triangles(mesh, world_from_local).map(|[a, b, c]| (b - a).cross(c - a).length() * 0.5).sum()
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use crate::material::Material;
    use glam::DQuat;

    fn scene(boxes: &[[DVec3; 2]]) -> Scene {
        let mut scene = Scene::default();
        let material = scene.insert_material(Material::default()).unwrap();
        for [min, max] in boxes {
            let mesh = scene.insert_mesh(Mesh::cuboid(*min, *max));
            scene.insert_instance(Instance::new(mesh, material, DAffine3::IDENTITY)).unwrap();
        }
        scene
    }

    /// Returns the extents of some points in the image, each 2 for the whole width or height.
    fn extents(camera: &Camera, points: &[DVec3], aspect: f64) -> [f64; 2] {
        let clip_from_world = camera.clip_from_view(aspect) * camera.view_from_world();
        let points: Vec<_> = points.iter().map(|point| clip_from_world.project_point3(*point)).collect();
        let bounds = Aabb::from_points(points);
        assert!(bounds.max.abs().max_element() < 1.0 && bounds.min.abs().max_element() < 1.0, "{bounds:?}");
        [bounds.max.x - bounds.min.x, bounds.max.y - bounds.min.y]
    }

    #[test]
    fn only_transforms_that_keep_angles_have_one_scale() {
        let turn = DQuat::from_scaled_axis(DVec3::new(0.3, -1.0, 2.0));
        let transform = |scale| DAffine3::from_scale_rotation_translation(scale, turn, DVec3::X);
        let scale = similarity(&transform(DVec3::new(3.0, -3.0, 3.0)));
        assert!(scale.is_some_and(|scale| (scale - 3.0).abs() < 1e-9), "{scale:?}");
        assert_eq!(similarity(&transform(DVec3::new(3.0, 3.0, 3.001))), None);
        let sheared = DAffine3::from_mat3(DMat3::from_cols(DVec3::X, DVec3::new(0.6, 0.8, 0.0), DVec3::Z));
        assert_eq!(similarity(&sheared), None);
    }

    #[test]
    fn a_small_thing_far_away_does_not_loosen_the_frame() {
        let hut = [DVec3::ZERO, DVec3::new(10.0, 4.0, 8.0)];
        let figure = [DVec3::new(80.0, 0.0, 60.0), DVec3::new(80.4, 1.8, 60.4)];
        let scene = scene(&[hut, figure]);
        for aspect in [0.5, 1.0, 16.0 / 9.0] {
            let corners = Aabb { min: hut[0], max: hut[1] }.corners();
            let [width, height] = extents(&scene.framing_camera(aspect), &corners, aspect);
            assert!(width.max(height) > 1.6, "{width} x {height}");
        }
    }

    #[test]
    fn small_things_at_the_edge_and_large_things_far_away_stay_in_the_frame() {
        let hut = [DVec3::ZERO, DVec3::new(10.0, 4.0, 8.0)];
        let antenna = [DVec3::new(5.0, 4.0, 4.0), DVec3::new(5.1, 4.9, 4.1)];
        assert_eq!(scene(&[hut, antenna]).framed().instances.len(), 2);
        let other = hut.map(|corner| corner + DVec3::X * 100.0);
        assert_eq!(scene(&[hut, other]).framed().instances.len(), 2);
    }

    #[test]
    fn the_vertices_fill_the_frame_and_not_the_corners_of_their_box() {
        // A thin diagonal: its box has corners far from it.
        let along = DVec3::new(1.0, 1.0, -1.0);
        let steps: Vec<_> =
            (0..20).map(|i| [0.0, 1.0].map(|end| along * f64::from(i) + DVec3::splat(end))).collect();
        let scene = scene(&steps);
        let points: Vec<_> =
            steps.iter().flat_map(|[min, max]| Aabb { min: *min, max: *max }.corners()).collect();
        let [width, height] = extents(&scene.framing_camera(1.0), &points, 1.0);
        assert!(width.max(height) > 1.8, "{width} x {height}");
    }
}
