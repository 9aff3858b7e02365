//! Shares of redundant casters in a typical scene.

use std::hint::black_box;
use std::time::{Duration, Instant};

use glam::DAffine3;
use shadowgraph_scene::{Camera, Projection};

use super::*;

const ENDS_M: [f64; 4] = [10.0, 30.0, 70.0, 150.0];
const TILE_PX: f64 = 2048.0;
/// Radius of filter and bias, texels.
const RADIUS_PX: f64 = 6.0;

/// Many boxes of 1 m on a plane, and a camera 2 m above it.
struct Street {
    camera: Camera,
    rotation: DMat3,
    casters: Vec<Aabb>,
    /// The volume of each cascade's map.
    maps: Vec<Aabb>,
}

impl Street {
    fn new(sun_azimuth: f64) -> Self {
        let projection = Projection::Perspective { fov_y: 60f64.to_radians(), near: 0.1, far: None };
        let camera = Camera::look_at(DVec3::Y * 2.0, DVec3::new(0.0, 1.8, -2.0), DVec3::Y, projection);
        let (sin, cos) = sun_azimuth.sin_cos();
        let to_light = DVec3::new(sin, 1.0, cos).normalize();
        let right = DVec3::Y.cross(to_light).normalize();
        let rotation = DMat3::from_cols(right, to_light.cross(right), to_light).transpose();
        let coordinate = |i: i32| f64::from(i) * 3.0;
        let casters =
            (-50..50).flat_map(|x| (-50..50).map(move |z| DVec3::new(coordinate(x), 0.5, coordinate(z))));
        let casters = casters.map(|at| Aabb { min: at - 0.5, max: at + 0.5 }).collect();
        let mut near_m = 0.1;
        let map = |far_m: f64| {
            let corners = *ReceiverHull::from_view(&camera, 16.0 / 9.0, near_m, far_m).corners();
            near_m = far_m;
            // The sphere with its centre on the view's axis, equidistant from near and far corners.
            let depth = |corner: DVec3| (corner - camera.position_world()).dot(camera.forward_world());
            let squares = corners.map(|corner| corner.distance_squared(camera.position_world()));
            let (near, far) = (depth(corners[0]), depth(corners[4]));
            let middle = (0.5 * (squares[4] - squares[0]) / (far - near)).clamp(near, far);
            let center = camera.position_world() + camera.forward_world() * middle;
            let half = corners[0].distance(center).max(corners[4].distance(center));
            let center = rotation * center;
            Aabb { min: center - half, max: center + half + DVec3::Z * 2.0 * half }
        };
        let maps = ENDS_M.into_iter().map(map).collect();
        Self { camera, rotation, casters, maps }
    }

    fn texel_m(&self, cascade: usize) -> f64 {
        (self.maps[cascade].max.x - self.maps[cascade].min.x) / TILE_PX
    }

    fn view(&self, near_m: f64) -> LightSpaceView {
        let view = ReceiverHull::from_view(&self.camera, 16.0 / 9.0, near_m, ENDS_M[3]);
        LightSpaceView::new(&view, self.rotation)
    }

    fn scene(&self) -> LightSpaceView {
        let bounds = self.casters.iter().fold(Aabb::EMPTY, |all, caster| all.union(caster));
        LightSpaceView::new(&ReceiverHull::from_box(&bounds), self.rotation)
    }

    fn boxes(&self) -> Vec<CoveredByFinerCascade> {
        let shrunk = |(cascade, map): (usize, &Aabb)| {
            let by = self.texel_m(cascade) * 8.0;
            CoveredByFinerCascade::Box(Aabb { min: map.min + by, max: map.max - by })
        };
        self.maps.iter().enumerate().map(shrunk).collect()
    }

    fn spheres(&self) -> Vec<CoveredByFinerCascade> {
        let inside = |(cascade, map): (usize, &Aabb)| {
            let radius_m = (map.max.x - map.min.x) * 0.5 - self.texel_m(cascade) * 8.0;
            CoveredByFinerCascade::Sphere { center_light: map.min + radius_m, radius_m }
        };
        self.maps.iter().enumerate().map(inside).collect()
    }

    fn depths(&self, scene: &LightSpaceView) -> Vec<CoveredByFinerCascade> {
        let rest =
            |end_m: &f64| CoveredByFinerCascade::Depth { beyond: self.view(end_m * 0.95).intersect(scene) };
        ENDS_M.iter().map(rest).collect()
    }

    /// Returns the light-space bounds of the casters that are in a cascade's map, or between it and the light.
    fn casters_in(&self, cascade: usize) -> Vec<Aabb> {
        let transform = DAffine3::from_mat3(self.rotation);
        let map = Aabb { max: self.maps[cascade].max.with_z(f64::INFINITY), ..self.maps[cascade] };
        let in_map = |caster: &Aabb| {
            let both = Aabb { min: caster.min.max(map.min), max: caster.max.min(map.max) };
            !both.is_empty()
        };
        self.casters.iter().map(|caster| caster.transformed(&transform)).filter(in_map).collect()
    }

    /// Returns the number of casters in each cascade's map, the share that darkens nothing visible, and the share of the rest
    /// that is redundant by finer cascades.
    fn shares(&self, view: &LightSpaceView, finer: &[CoveredByFinerCascade]) -> [(usize, f64, f64); 4] {
        std::array::from_fn(|cascade| {
            let casters = self.casters_in(cascade);
            let radius_m = RADIUS_PX * self.texel_m(cascade);
            let (visible, redundant) = (
                RedundantCasters::new(view, &[], radius_m),
                RedundantCasters::new(view, &finer[..cascade], radius_m),
            );
            let unseen = casters.iter().filter(|caster| visible.is_redundant(caster)).count();
            let culled = casters.iter().filter(|caster| redundant.is_redundant(caster)).count();
            let rest = (casters.len() - unseen) as f64;
            (casters.len(), unseen as f64 / casters.len() as f64, (culled - unseen) as f64 / rest)
        })
    }
}

#[test]
fn in_a_street_many_casters_of_coarser_cascades_are_redundant() {
    for (name, azimuth) in [("behind", 0.0f64), ("to the side", 1.5), ("in front", 3.0)] {
        let street = Street::new(azimuth);
        let scene = street.scene();
        let bare = street.view(0.1);
        let view = bare.clone().intersect(&scene);
        let kinds = [
            ("boxes", street.boxes(), &view),
            ("boxes, view without bounds", street.boxes(), &bare),
            ("spheres", street.spheres(), &view),
            ("depths", street.depths(&scene), &view),
        ];
        for (kind, finer, view) in kinds {
            let shares = street.shares(view, &finer);
            let print = |(count, unseen, redundant): (usize, f64, f64)| {
                format!("{count}: {:.0} %, {:.0} %", unseen * 100.0, redundant * 100.0)
            };
            println!("sun {name}, {kind}: {}", shares.map(print).join("; "));
            // The nearest cascades are small: they cover few casters of the next one completely.
            if kind == "boxes" {
                let least = [0.05, 0.15, 0.4];
                assert!(shares[1..].iter().zip(least).all(|(share, least)| share.2 > least), "{shares:?}");
            }
        }
    }
}

#[test]
fn in_a_street_most_of_the_casters_that_are_kept_are_needed() {
    let street = Street::new(0.7);
    let all = street.casters.iter().fold(Aabb::EMPTY, |all, caster| all.union(caster));
    let view = street.view(0.1).intersect(&street.scene());
    let eye = View { camera: street.camera.clone(), aspect: 16.0 / 9.0, near_m: 0.1, far_m: ENDS_M[3] };
    let finer = street.boxes();
    let world_from_light = street.rotation.transpose();
    for cascade in 1..4 {
        let radius_m = RADIUS_PX * street.texel_m(cascade);
        let casters = RedundantCasters::new(&view, &finer[..cascade], radius_m);
        let is_read = |light: DVec3| {
            let world = world_from_light * light;
            let is_covered = finer[..cascade].iter().any(|covered| match covered {
                CoveredByFinerCascade::Box(bounds) => bounds.contains_point(light),
                _ => false,
            });
            !is_covered && all.contains_point(world) && eye.contains(world)
        };
        let kept: Vec<Aabb> =
            street.casters_in(cascade).into_iter().filter(|caster| !casters.is_redundant(caster)).collect();
        let needed = kept.iter().filter(|caster| grid_below(caster, &view, radius_m).any(is_read)).count();
        let share = needed as f64 / kept.len() as f64;
        println!(
            "cascade {cascade}: of {} casters that are kept, {:.1} % are needed",
            kept.len(),
            share * 100.0
        );
        assert!(share > 0.8);
    }
}

/// Returns a grid of points in the column below a caster.
fn grid_below(caster: &Aabb, view: &LightSpaceView, radius_m: f64) -> impl Iterator<Item = DVec3> {
    let column = Aabb { min: (caster.min - radius_m).with_z(f64::NEG_INFINITY), max: caster.max + radius_m };
    let part = view.visible_part(&column).unwrap_or(column);
    let fraction = |i: i32, count: i32| (f64::from(i) + 0.5) / f64::from(count);
    (0..12 * 12 * 40).map(move |i| {
        let fractions = DVec3::new(fraction(i % 12, 12), fraction(i / 12 % 12, 12), fraction(i / 144, 40));
        part.min + (part.max - part.min) * fractions
    })
}

#[test]
fn timing_of_ten_thousand_casters_in_four_cascades() {
    let street = Street::new(0.7);
    let scene = street.scene();
    let view = street.view(0.1).intersect(&scene);
    let transform = DAffine3::from_mat3(street.rotation);
    let start = Instant::now();
    let bounds: Vec<Aabb> = street.casters.iter().map(|caster| caster.transformed(&transform)).collect();
    let transformed = start.elapsed();
    for (kind, finer) in
        [("boxes", street.boxes()), ("spheres", street.spheres()), ("depths", street.depths(&scene))]
    {
        let mut best = Duration::MAX;
        let mut culled = 0;
        for _ in 0..5 {
            let start = Instant::now();
            culled = 0;
            for cascade in 0..4 {
                let radius_m = RADIUS_PX * street.texel_m(cascade);
                let casters = RedundantCasters::new(&view, &finer[..cascade], radius_m);
                culled += bounds.iter().filter(|caster| casters.is_redundant(black_box(caster))).count();
            }
            best = best.min(start.elapsed());
        }
        println!("{kind}: 4 x {} casters in {best:.2?}, {culled} culled", bounds.len());
        assert!(culled > 0 && culled < 4 * bounds.len());
    }
    println!("bounds in light space: {transformed:.2?}");
}
