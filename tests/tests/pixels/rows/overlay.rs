//! Lines that show what shadow maps cover.

use super::{pillar_view, pillars, plan, spot};
use crate::stage::{camera, gpu, sun, sun_direction};
use glam::{DVec3, Vec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::pipelines::Parameters;
use shadowgraph::scene::Camera;
use shadowgraph::shadows::{NONE, PCF, SDSM, ShadowPlan, ShadowView, TechniqueKind};
use shadowgraph::{Gpu, Pipeline, Registry, RenderedImage, Renderer, ShadowLines, ViewOptions};

const SIZE_PX: [u32; 2] = [640, 360];

/// Returns the camera that looks at the pillars, and one that sees it from the side.
fn cameras() -> [Camera; 2] {
    let inside = pillar_view(|_| ()).camera;
    let outside = camera(DVec3::new(45.0, 30.0, 30.0), DVec3::new(0.0, 0.0, -18.0));
    [inside, outside]
}

/// Draws the pillars in a sun and a spot light from outside, with shadows for the camera inside, and with lines.
fn draw(gpu: &Gpu, technique: TechniqueKind, lines: Option<ShadowLines>) -> RenderedImage {
    let [inside, outside] = cameras();
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    scene.insert_light(spot(DVec3::new(-3.0, 6.0, -8.0), DVec3::new(0.0, 0.0, -8.0), 0.5));
    let mut renderer = Renderer::with_config(gpu, scene, &outside, Aov::Cascade, technique).unwrap();
    renderer.set_shadow_camera(Some(inside));
    renderer.set_overlay(gpu, lines).unwrap();
    renderer.draw(gpu, &options(outside)).unwrap().image
}

fn options(camera: Camera) -> ViewOptions {
    let mut options = ViewOptions { camera, size_px: SIZE_PX, ..pillar_view(|_| ()) };
    options.shadows.distance_m = 30.0;
    options
}

/// Returns the plan of the camera inside.
fn planned() -> ShadowPlan {
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    scene.insert_light(spot(DVec3::new(-3.0, 6.0, -8.0), DVec3::new(0.0, 0.0, -8.0), 0.5));
    plan(&scene, &options(cameras()[0].clone()))
}

/// Asserts that the lines changed the image around each point of the world that the image shows.
fn assert_drawn([without, with]: [&RenderedImage; 2], points: &[DVec3], what: &str) {
    let outside = &cameras()[1];
    let aspect = f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]);
    let clip_from_world = outside.clip_from_view(aspect) * outside.view_from_world();
    let mut seen = 0;
    for point in points {
        let clip = clip_from_world * point.extend(1.0);
        let ndc = clip.truncate() / clip.w;
        if clip.w <= 0.0 || ndc.truncate().abs().max_element() > 0.98 {
            continue;
        }
        seen += 1;
        let px = [(0.5 + 0.5 * ndc.x) * f64::from(SIZE_PX[0]), (0.5 - 0.5 * ndc.y) * f64::from(SIZE_PX[1])];
        let [x, y] = px.map(|at| at as i64);
        let changed = (-1..=1).any(|dx| {
            (-1..=1).any(|dy| {
                let index = (((y + dy) * i64::from(SIZE_PX[0]) + x + dx) * 4) as usize;
                without.rgba8.get(index..index + 4) != with.rgba8.get(index..index + 4)
            })
        });
        assert!(changed, "{what}: no line at {point}, pixel {x}, {y}");
    }
    assert!(seen >= points.len() / 3, "{what}: {seen} of {} points are in the image", points.len());
}

#[test]
fn row_44_lines_show_what_the_shadows_of_a_frozen_camera_cover() {
    let Some(gpu) = gpu() else { return };
    let without = draw(gpu, PCF, None);
    let planned = planned();
    let origin = shadowgraph::scene::origin_near(cameras()[0].position_world());
    let world = |point: Vec3| point.as_dvec3() + origin;
    let cascades: Vec<_> = planned.views.iter().filter(|view| view.cascade < 8).collect();
    assert_eq!(cascades.len(), 4);
    let [inside, _] = cameras();
    let aspect = f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]);
    let corners: Vec<DVec3> = cascades
        .iter()
        .flat_map(|view| inside.slice_corners_view(aspect, view.begin_m.into(), view.end_m.into()))
        .map(|corner| inside.world_from_view.transform_point3(corner))
        .collect();
    // A point of a tile, by its coordinates in the clip space of the tile.
    let tile_point = |view: &ShadowView, at: [f32; 3]| {
        let point = view.clip_from_world.inverse() * Vec4::new(at[0], at[1], at[2], 1.0);
        world(point.truncate() / point.w)
    };
    let boxes: Vec<DVec3> =
        cascades.iter().flat_map(|view| [-1.0, 0.0, 1.0].map(|x| tile_point(view, [x, 1.0, 0.0]))).collect();
    let frusta = draw(gpu, PCF, Some(ShadowLines::Frusta));
    assert_drawn([&without, &frusta], &corners, "slices");
    assert_drawn([&without, &frusta], &boxes, "boxes");
    let around: Vec<DVec3> = cascades
        .iter()
        .flat_map(|view| {
            [Vec3::X, Vec3::Y, Vec3::NEG_X, Vec3::Z].map(|axis| world(view.center + view.radius * axis))
        })
        .collect();
    let spheres = draw(gpu, PCF, Some(ShadowLines::Spheres));
    assert_drawn([&without, &spheres], &around, "spheres");
    let outlines: Vec<DVec3> = cascades
        .iter()
        .flat_map(|view| [[-1.0, -1.0], [1.0, 0.3], [0.0, 1.0]].map(|[x, y]| tile_point(view, [x, y, 0.5])))
        .collect();
    let tiles = draw(gpu, PCF, Some(ShadowLines::Tiles));
    assert_drawn([&without, &tiles], &outlines, "tiles");
    // The pyramid of the spot light ends at its range.
    let spot = planned.views.iter().find(|view| view.light.w == 1.0).unwrap();
    let apex = world(spot.light.truncate());
    assert_drawn([&without, &frusta], &[tile_point(spot, [1.0, 1.0, 0.5]).lerp(apex, 0.0)], "pyramid");
}

#[test]
fn row_44_cascades_fitted_on_the_gpu_have_lines_and_techniques_without_maps_have_none() {
    let Some(gpu) = gpu() else { return };
    for (technique, has_lines) in [(SDSM, true), (NONE, false)] {
        let [without, with] =
            [None, Some(ShadowLines::Spheres)].map(|lines| draw(gpu, technique, lines).rgba8);
        assert_eq!(without != with, has_lines, "{technique:?}");
    }
}

#[test]
fn row_44_the_node_draws_the_lines_of_the_overlay() {
    let Some(gpu) = gpu() else { return };
    let [inside, outside] = cameras();
    let mut scene = pillars(12);
    scene.insert_light(sun(sun_direction(35.0, 60.0)));
    let Registry { nodes, techniques } = Registry::built_in();
    let file = shadowgraph_tests::repository().join("docs/everything.ron");
    let [with_node, with_overlay] = [true, false].map(|is_node| {
        let parameters = Parameters(vec![("lines".into(), is_node.into())]);
        let pipeline = Pipeline::load(&file, &nodes, &techniques, &parameters).unwrap();
        let mut renderer = Renderer::with_config(gpu, scene.clone(), &outside, Aov::Color, pipeline).unwrap();
        renderer.set_shadow_camera(Some(inside.clone()));
        renderer.set_overlay(gpu, (!is_node).then_some(ShadowLines::Frusta)).unwrap();
        renderer.draw(gpu, &options(outside.clone())).unwrap().image.rgba8
    });
    let differ = with_node.iter().zip(&with_overlay).filter(|(a, b)| a.abs_diff(**b) > 1).count();
    assert_eq!(differ, 0);
}
