use glam::Vec3;
use proptest::prelude::*;
use shadowgraph_shadows::rays::{Ray, RayScene};

use crate::common::{Occluder, ray, scene, sphere};

fn vector(largest: f32) -> impl Strategy<Value = Vec3> {
    prop::array::uniform3(-largest..largest).prop_map(Vec3::from)
}

fn moved_sphere(scale: f32, center: Vec3) -> (RayScene, Vec<[Vec3; 3]>) {
    let triangles: Vec<_> = sphere(2).into_iter().map(|t| t.map(|p| p * scale + center)).collect();
    (scene(&triangles.iter().map(|&t| Occluder::opaque(t)).collect::<Vec<_>>()), triangles)
}

#[test]
fn the_sphere_is_subdivided() {
    assert_eq!(sphere(0).len(), 20);
    assert_eq!(sphere(2).len(), 320);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_ray_leaves_a_sphere_through_its_edges_and_corners(
        scale in 0.01f32..500.0,
        center in vector(1500.0),
        inside in vector(0.5),
        part in 0f32..1.0,
    ) {
        let (scene, triangles) = moved_sphere(scale, center);
        let origin = center + inside * scale;
        for [a, b, c] in triangles {
            for target in [a, b, c, a.lerp(b, part), b.lerp(c, part), c.lerp(a, part), (a + b) / 2.0] {
                prop_assert!(scene.is_occluded(&ray(origin, target)), "{origin} to {target}");
                prop_assert!(scene.nearest_distance(&ray(origin, target)).is_some());
            }
        }
    }

    #[test]
    fn no_ray_passes_through_a_grid_of_squares(
        step in 0.01f32..50.0,
        corner in vector(1400.0),
        slope in vector(1.0),
        part in 0f32..1.0,
    ) {
        let at = |i: usize, j: usize| corner + Vec3::new(i as f32 * step, 0.0, j as f32 * step);
        let mut occluders = Vec::new();
        for (i, j) in (0..64).map(|n| (n % 8, n / 8)) {
            let [a, b, c, d] = [at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)];
            occluders.extend([Occluder::opaque([a, b, c]), Occluder::opaque([a, c, d])]);
        }
        let scene = scene(&occluders);
        let oblique = Vec3::new(slope.x, -1.0, slope.z).normalize();
        for (i, j) in (0..49).map(|n| (1 + n % 7, 1 + n / 7)) {
            let ends = [at(i, j), at(i - 1, j), at(i, j - 1), at(i - 1, j - 1)];
            for target in ends.into_iter().map(|end| at(i, j).lerp(end, part)) {
                let above = target + Vec3::Y * 100.0;
                prop_assert!(scene.is_occluded(&Ray::new(above, Vec3::NEG_Y, 0.0, f32::INFINITY)));
                let inner = target.midpoint(at(4, 4));
                prop_assert!(scene.is_occluded(&ray(inner - oblique * 100.0, inner)));
            }
        }
    }
}

#[test]
fn rays_along_an_axis_hit_flat_boxes_at_their_edges() {
    let a = Occluder::opaque([Vec3::ZERO, Vec3::X, Vec3::Z]);
    for (x, z) in [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (0.5, 0.5), (0.5, 0.0), (0.0, 0.25)] {
        let down = Ray::new(Vec3::new(x, 1e4, z), Vec3::NEG_Y, 0.0, f32::INFINITY);
        assert_eq!(scene(&[a]).nearest_distance(&down), Some(1e4), "{x} {z}");
    }
}
