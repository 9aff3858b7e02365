//! Compares the shadow of a cube on a floor with its computed outline.

use crate::stage::{
    CUBE_MAX, CUBE_MIN, SIZE_PX, camera, cube_on_floor, draw, gpu, light, pixel_ray, plan, ray_box, sun,
    sun_direction, view,
};
use glam::{DVec2, DVec3, Vec3};
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, LightKind, Scene, origin_near};
use shadowgraph::shadows::ShadowView;
use shadowgraph::{Gpu, ViewOptions};

/// The largest distance between the computed and the rendered outline, shadow texels.
const OUTLINE_TEXELS: f64 = 1.5;
/// The distance from which the filter does not reach the outline, shadow texels: visibility is 1.
const CLEAR_TEXELS: f64 = 4.5;

/// The visible surface at a pixel.
struct Hit {
    position: DVec3,
    normal: DVec3,
    on_floor: bool,
}

fn hit(options: &ViewOptions, x: u32, y: u32, offset: DVec3) -> Option<Hit> {
    let (origin, direction) = pixel_ray(options, x, y);
    let origin = origin - offset;
    let cube = ray_box(origin, direction, CUBE_MIN, CUBE_MAX).filter(|(distance, _)| *distance > 0.0);
    let floor = (direction.y < 0.0).then(|| -origin.y / direction.y).filter(|distance| {
        let at = origin + direction * distance;
        at.x.abs() < 20.0 && at.z.abs() < 20.0
    });
    let found = |distance: f64, normal, on_floor| {
        Some(Hit { position: origin + direction * distance, normal, on_floor })
    };
    match (cube, floor) {
        (Some((near, normal)), Some(far)) if near < far => found(near, normal, false),
        (Some((near, normal)), None) => found(near, normal, false),
        (_, Some(distance)) => found(distance, DVec3::Y, true),
        (None, None) => None,
    }
}

fn cube_corner(index: usize) -> DVec3 {
    DVec3::from_array(std::array::from_fn(|a| if index >> a & 1 == 0 { CUBE_MIN[a] } else { CUBE_MAX[a] }))
}

/// Projects points onto the plane perpendicular to the light.
fn across(to_light: DVec3) -> impl Fn(DVec3) -> DVec2 {
    let right = to_light.any_orthonormal_vector();
    let up = to_light.cross(right);
    move |p: DVec3| DVec2::new(p.dot(right), p.dot(up))
}

/// Returns the distance of a point from the cube's silhouette as the light sees it, metres in that plane.
fn outline_distance(position: DVec3, to_light: DVec3) -> f64 {
    let flat = across(to_light);
    let hull = convex_hull((0..8).map(|i| flat(cube_corner(i))).collect());
    let edges = hull.iter().zip(hull.iter().cycle().skip(1));
    edges.map(|(&a, &b)| segment_distance(flat(position), a, b)).fold(f64::MAX, f64::min)
}

/// Returns the distance of a point from the nearest edge of the cube as the light sees it, metres in that plane.
fn edge_distance(position: DVec3, to_light: DVec3) -> f64 {
    let flat = across(to_light);
    let edges = (0..8).flat_map(|a| [1, 2, 4].map(|bit| (a, a ^ bit)));
    edges
        .map(|(a, b)| segment_distance(flat(position), flat(cube_corner(a)), flat(cube_corner(b))))
        .fold(f64::MAX, f64::min)
}

/// Andrew's monotone chain.
fn convex_hull(mut points: Vec<DVec2>) -> Vec<DVec2> {
    points.sort_by(|a, b| a.x.total_cmp(&b.x).then(a.y.total_cmp(&b.y)));
    let mut hull: Vec<DVec2> = Vec::new();
    for pass in 0..2 {
        let start = hull.len();
        let ordered: Box<dyn Iterator<Item = &DVec2>> =
            if pass == 0 { Box::new(points.iter()) } else { Box::new(points.iter().rev()) };
        for &point in ordered {
            while hull.len() >= start + 2 {
                let (a, b) = (hull[hull.len() - 2], hull[hull.len() - 1]);
                if (b - a).perp_dot(point - b) > 0.0 {
                    break;
                }
                hull.pop();
            }
            hull.push(point);
        }
        hull.pop();
    }
    hull
}

fn segment_distance(p: DVec2, a: DVec2, b: DVec2) -> f64 {
    let along = ((p - a).dot(b - a) / (b - a).length_squared()).clamp(0.0, 1.0);
    p.distance(a + (b - a) * along)
}

/// Returns the texel size at a position, metres, of the view that the shader samples: the first whose inner tile contains it.
fn texel_at(views: &[ShadowView], position: Vec3) -> Option<f64> {
    views.iter().find_map(|view| {
        let map = view.map_from_world * position.extend(1.0);
        let (u, v, depth) = (map.x / map.w, map.y / map.w, map.z / map.w);
        let inside = u >= view.uv_min.x && v >= view.uv_min.y && u <= view.uv_max.x && v <= view.uv_max.y;
        (map.w > 0.0 && inside && depth > 0.0 && depth < 1.0).then(|| f64::from(view.texel_world * map.w))
    })
}

/// Errors of an image.
#[derive(Debug, Default)]
struct Report {
    lit: u32,
    dark: u32,
    /// Distance from the outline of the misclassified floor pixel that is farthest from it, texels.
    worst_outline_texels: f64,
    /// Pixels of lit faces of the cube that are rendered dark.
    dark_faces: u32,
    /// Lit pixels beyond the filter radius of any edge that are not fully lit.
    acne: Vec<(u32, u32, u8)>,
}

fn examine(
    gpu: &Gpu,
    scene: Scene,
    options: &ViewOptions,
    offset: DVec3,
    to_light: &dyn Fn(DVec3) -> DVec3,
) -> Report {
    let views = plan(&scene, options).views;
    let origin_world = origin_near(options.camera.position_world());
    let image = draw(gpu, scene, Aov::Visibility(0), options).image;
    let mut report = Report::default();
    for (x, y) in (0..SIZE_PX[1]).flat_map(|y| (0..SIZE_PX[0]).map(move |x| (x, y))) {
        let [grey, _, _, alpha] = image.pixel(x, y).unwrap();
        let Some(hit) = hit(options, x, y, offset) else { continue };
        let to_light = to_light(hit.position).normalize();
        if hit.normal.dot(to_light) <= 0.1 {
            continue;
        }
        // Silhouette pixels can show either surface.
        if alpha == 0 {
            continue;
        }
        let relative = (hit.position + offset - origin_world).as_vec3();
        let Some(texel_m) = texel_at(&views, relative) else { continue };
        let blocked =
            hit.on_floor && ray_box(hit.position + DVec3::Y * 1e-9, to_light, CUBE_MIN, CUBE_MAX).is_some();
        let dark = grey < 128;
        if blocked {
            report.dark += 1
        } else {
            report.lit += 1
        }
        if hit.on_floor && dark != blocked {
            let distance = outline_distance(hit.position, to_light) / texel_m;
            report.worst_outline_texels = report.worst_outline_texels.max(distance);
        }
        report.dark_faces += u32::from(!hit.on_floor && dark);
        if !blocked && grey < 250 && edge_distance(hit.position, to_light) / texel_m > CLEAR_TEXELS {
            report.acne.push((x, y, grey));
        }
    }
    report
}

/// Returns the options of a view whose pixels have the shadow of their centre.
fn exact_view(camera: Camera, distance_m: f32) -> ViewOptions {
    let mut options = view(camera, distance_m);
    options.shadows.supersample = false;
    options
}

fn assert_clean(report: &Report, what: &str) {
    println!(
        "{what}: {} lit, {} dark, outline within {:.2} texels, {} lit pixels not fully lit",
        report.lit,
        report.dark,
        report.worst_outline_texels,
        report.acne.len()
    );
    assert!(report.dark > 50 && report.lit > 10_000, "{what}: the shadow is in the image: {report:?}");
    assert!(report.worst_outline_texels <= OUTLINE_TEXELS, "{what}: {report:?}");
    assert_eq!(report.dark_faces, 0, "{what}: {report:?}");
    assert!(report.acne.is_empty(), "{what}: {report:?}");
}

#[test]
fn the_outline_of_a_cubes_shadow_is_where_geometry_says_at_every_height_of_the_sun() {
    let Some(gpu) = gpu() else { return };
    for elevation_deg in [15.0, 30.0, 52.0, 75.0] {
        for (azimuth_deg, distance_m) in [(110.0, 30.0), (200.0, 12.0), (-75.0, 60.0)] {
            let direction = sun_direction(elevation_deg, azimuth_deg);
            let mut scene = cube_on_floor(DVec3::ZERO);
            scene.insert_light(sun(direction));
            let options =
                exact_view(camera(DVec3::new(2.5, 3.0, 4.0), DVec3::new(0.0, 0.3, 0.0)), distance_m);
            let report = examine(gpu, scene, &options, DVec3::ZERO, &|_| -direction);
            assert_clean(
                &report,
                &format!("sun at {elevation_deg} deg, azimuth {azimuth_deg}, {distance_m} m"),
            );
        }
    }
}

#[test]
fn the_outline_is_exact_ten_kilometres_from_the_origin() {
    let Some(gpu) = gpu() else { return };
    let offset = DVec3::new(10_000.0, 0.0, -10_000.0);
    let direction = sun_direction(40.0, 60.0);
    let mut scene = cube_on_floor(offset);
    scene.insert_light(sun(direction));
    let eye = DVec3::new(2.5, 3.0, 4.0) + offset;
    let options = exact_view(camera(eye, DVec3::new(0.0, 0.3, 0.0) + offset), 30.0);
    let report = examine(gpu, scene, &options, offset, &|_| -direction);
    assert_clean(&report, "10 km away");
}

#[test]
fn the_outline_of_a_spot_lights_shadow_is_where_geometry_says() {
    let Some(gpu) = gpu() else { return };
    for position_world in [DVec3::new(1.5, 3.0, 0.5), DVec3::new(-3.0, 2.0, 2.0)] {
        let mut scene = cube_on_floor(DVec3::ZERO);
        let direction = (DVec3::new(0.0, 0.2, 0.0) - position_world).normalize();
        let kind = LightKind::Spot {
            position_world,
            direction,
            range: Some(15.0),
            inner_angle: 0.7,
            outer_angle: 0.8,
        };
        scene.insert_light(light(kind, 1_000.0));
        let options = exact_view(camera(DVec3::new(2.5, 3.0, 4.0), DVec3::new(0.0, 0.3, 0.0)), 30.0);
        let views = plan(&scene, &options).views;
        let image = draw(gpu, scene, Aov::Visibility(0), &options).image;
        let (mut wrong, mut dark, mut acne) = (0, 0, 0);
        for (x, y) in (0..SIZE_PX[1]).flat_map(|y| (0..SIZE_PX[0]).map(move |x| (x, y))) {
            let [grey, _, _, alpha] = image.pixel(x, y).unwrap();
            let Some(hit) = hit(&options, x, y, DVec3::ZERO) else { continue };
            let to_light = (position_world - hit.position).normalize();
            if alpha == 0
                || hit.normal.dot(to_light) <= 0.1
                || texel_at(&views, hit.position.as_vec3()).is_none()
            {
                continue;
            }
            let blocked = |point: DVec3| {
                let way = position_world - point;
                hit.on_floor
                    && ray_box(point + DVec3::Y * 1e-9, way.normalize(), CUBE_MIN, CUBE_MAX)
                        .is_some_and(|(distance, _)| distance < way.length())
            };
            // Within that many texels around the outline, both results are allowed.
            let texel_m = texel_at(&views, hit.position.as_vec3()).unwrap();
            let reach = |texels: f64| {
                let stretch = texels * texel_m / hit.normal.dot(to_light);
                let ring = (0..16).map(|i| f64::from(i) / 16.0 * std::f64::consts::TAU);
                let mut ring =
                    ring.map(|a| blocked(hit.position + DVec3::new(a.cos(), 0.0, a.sin()) * stretch));
                let centre = blocked(hit.position);
                ring.all(|b| b == centre).then_some(centre)
            };
            dark += u32::from(blocked(hit.position));
            wrong += u32::from(reach(OUTLINE_TEXELS).is_some_and(|truth| truth != (grey < 128)));
            acne +=
                u32::from(reach(CLEAR_TEXELS) == Some(false) && grey < if hit.on_floor { 250 } else { 128 });
        }
        println!("spot at {position_world}: {dark} dark, {wrong} wrong, {acne} lit pixels not fully lit");
        assert!(dark > 100);
        assert_eq!((wrong, acne), (0, 0));
    }
}

#[test]
fn visibility_is_full_where_no_caster_is_in_range() {
    let Some(gpu) = gpu() else { return };
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(sun(DVec3::new(0.2, -1.0, 0.1).normalize()));
    // Next to the cube and its shadow, looking away.
    let options = view(camera(DVec3::new(8.0, 1.0, 8.0), DVec3::new(12.0, 0.0, 12.0)), 5.0);
    let image = draw(gpu, scene, Aov::Visibility(0), &options).image;
    assert!(image.rgba8.chunks_exact(4).all(|p| p[3] == 0 || p[0] == 255));
}
