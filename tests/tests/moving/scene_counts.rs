//! What a frame of the library's own scene costs with default settings, counted. Nothing is drawn: the device does nothing.

use crate::counts::redrawn;
use crate::maps::{camera, notes};
use glam::{DAffine3, DVec3};
use shadowgraph::core::{Plan, Timer};
use shadowgraph::options::{Aov, ShadowDistance};
use shadowgraph::scene::{
    AnimationSelection, Instance, InstanceKey, Light, LightKind, Material, Mesh, Scene,
};
use shadowgraph::shadows::{EVSM, MSM, PCF, PCSS, TechniqueKind};
use shadowgraph::{Gpu, Renderer, ViewOptions};
use shadowgraph_tests::animated::SKINNED;
use shadowgraph_tests::random::Random;

/// Returns a floor with boxes, each with its own mesh so that they share no draw calls, in a sun, a spot light and a point light.
/// The first box stands in front of the camera.
fn field(count: usize, half_m: f64) -> (Scene, InstanceKey) {
    let mut scene = Scene::default();
    let mut random = Random::new(1);
    let material = scene.insert_material(Material::default()).unwrap();
    let floor = DVec3::new(half_m, 0.0, half_m);
    let floor = scene.insert_mesh(Mesh::cuboid(-floor - DVec3::Y, floor));
    scene.insert_instance(Instance::new(floor, material, DAffine3::IDENTITY)).unwrap();
    let mut first = None;
    for index in 0..count {
        let size = DVec3::new(0.5, random.between(0.5, 3.0), 0.5);
        let mesh = scene.insert_mesh(Mesh::cuboid(DVec3::ZERO, size));
        let at = DVec3::new(random.between(-half_m, half_m), 0.0, random.between(-half_m, half_m));
        let at = DAffine3::from_translation(if index == 0 { DVec3::ZERO } else { at });
        let key = scene.insert_instance(Instance::new(mesh, material, at).with_name("Fox")).unwrap();
        first.get_or_insert(key);
    }
    let light =
        |kind, intensity| Light { name: None, kind, color: glam::Vec3::ONE, intensity, casts_shadow: true };
    let (position_world, range) = (DVec3::new(3.0, 5.0, 0.0), Some(20.0));
    let direction = DVec3::new(0.4, -1.0, 0.3).normalize();
    let spot = LightKind::Spot { position_world, direction, inner_angle: 0.4, outer_angle: 0.8, range };
    scene.set_lights([
        light(LightKind::Directional { direction }, 20_000.0),
        light(spot, 10_000.0),
        light(LightKind::Point { position_world, range }, 10_000.0),
    ]);
    (scene, first.unwrap())
}

fn view(eye: DVec3, heading: f64) -> ViewOptions {
    let ahead = DVec3::new(heading.sin(), -0.1, -heading.cos());
    ViewOptions { camera: camera(eye, eye + ahead), size_px: [320, 180], shadows: Default::default() }
}

fn renderer(gpu: &Gpu, scene: Scene, technique: TechniqueKind) -> Renderer {
    Renderer::with_config(gpu, scene, &view(DVec3::Y, 0.0).camera, Aov::Color, technique).unwrap()
}

/// Returns the draw calls of the passes that draw casters into maps.
fn shadow_draws(gpu: &Gpu, renderer: &mut Renderer, options: &ViewOptions) -> u32 {
    let mut timer = Timer::new();
    let drawn = renderer.draw_timed(gpu, options, Some(&mut timer)).unwrap();
    drawn.times.iter().filter(|time| is_of_map(&time.pass)).map(|time| time.draws.unwrap_or(0)).sum()
}

fn is_of_map(path: &str) -> bool {
    ["/cascades/", "/atlas/", "moments/"].iter().any(|node| path.contains(node))
}

/// Returns the number of passes that draw into maps or compute their moments.
fn map_passes(plan: &Plan) -> usize {
    plan.order().iter().filter(|&&pass| is_of_map(&plan.pass_path(pass).to_string())).count()
}

#[test]
fn one_moving_instance_among_10_000_costs_at_most_a_fiftieth_of_the_draws_of_a_redraw() {
    let gpu = Gpu::noop().unwrap();
    let (scene, fox) = field(10_000, 40.0);
    let mut renderer = renderer(&gpu, scene, PCF);
    let options = view(DVec3::new(0.0, 3.0, 8.0), 0.0);
    let redraw = shadow_draws(&gpu, &mut renderer, &options);
    assert!(redraw > 3_000, "{redraw} draws");
    for step in 1..5 {
        let at = DAffine3::from_translation(DVec3::X * 0.1 * f64::from(step));
        renderer.scene_mut().move_instance(fox, at).unwrap();
        let draws = shadow_draws(&gpu, &mut renderer, &options);
        // The first step draws the static casters apart.
        if step > 1 {
            println!("{draws} of {redraw} draws");
            assert!(draws > 0 && draws * 50 <= redraw, "{draws} of {redraw} draws");
        }
    }
}

#[test]
fn a_still_scene_draws_no_shadow_pass() {
    let gpu = Gpu::noop().unwrap();
    let (scene, _) = field(200, 20.0);
    let mut options = view(DVec3::new(0.0, 3.0, 8.0), 0.0);
    for (distance, technique) in [
        (ShadowDistance::Metres(150.0), PCF),
        (ShadowDistance::Auto, PCF),
        (ShadowDistance::Auto, PCSS),
        (ShadowDistance::Auto, EVSM),
        (ShadowDistance::Auto, MSM),
    ] {
        options = options.with_shadow_distance(distance, &scene);
        let mut renderer = renderer(&gpu, scene.clone(), technique);
        let passes: Vec<_> =
            (0..70).map(|_| map_passes(&renderer.draw(&gpu, &options).unwrap().plan)).collect();
        assert!(passes[0] > 0 && passes[1..] == [0; 69], "{}: {passes:?}", technique.name);
    }
}

#[test]
fn a_mesh_is_deformed_only_in_frames_in_which_its_pose_changes() {
    let gpu = Gpu::noop().unwrap();
    let mut renderer = renderer(&gpu, (SKINNED.file)().load(), PCF);
    let options = view(DVec3::new(0.0, 1.0, 5.0), 0.0);
    let mut poses = |time_s: f64| {
        renderer.scene_mut().set_time(AnimationSelection::All, time_s).unwrap();
        let plan = renderer.draw(&gpu, &options).unwrap().plan;
        plan.order().iter().filter(|&&pass| plan.pass_path(pass).to_string().ends_with("pose/pose")).count()
    };
    // The frame after a move still has one: positions in the previous frame change.
    assert_eq!([0.0, 0.0, 0.5, 0.5, 0.5, 0.6, 0.6, 0.6].map(&mut poses), [1, 0, 1, 1, 0, 1, 1, 0]);
}

/// Walks for ten seconds, 60 frames each, along a bend, with the head going up and down, and returns the mean fraction of the
/// cascades' texels into which static casters are drawn.
fn walk(distance: ShadowDistance) -> f64 {
    let gpu = Gpu::noop().unwrap();
    let mut renderer = renderer(&gpu, field(400, 100.0).0, PCF);
    let (mut options, mut sum) = (view(DVec3::Y, 0.0), 0.0);
    let count = 600;
    for frame in 0..count {
        let seconds = f64::from(frame) / 60.0;
        let bob_m = 0.03 * (12.0 * seconds).sin();
        let eye = DVec3::new(2.0 * (0.3 * seconds).sin(), 1.7 + bob_m, 8.0 - 1.4 * seconds);
        options.camera = view(eye, 0.6 * (0.5 * seconds).sin()).camera;
        options = options.with_shadow_distance(distance, renderer.scene());
        let plan = renderer.draw(&gpu, &options).unwrap().plan;
        let said = notes(&plan, "cascades");
        assert!((3..=4).contains(&said.len()), "{said:?}");
        let tile_px = options.shadows.cascades.map_size_px / 2;
        sum += said.iter().map(|note| redrawn(note, tile_px)).sum::<f64>() / 4.0;
    }
    sum / f64::from(count)
}

#[test]
fn a_walk_through_a_scene_redraws_at_most_a_tenth_of_the_texels_of_the_cascades() {
    for distance in [ShadowDistance::Metres(150.0), ShadowDistance::Auto] {
        let fraction = walk(distance);
        println!("{:.2} % of the texels redrawn, {distance:?}", 100.0 * fraction);
        assert!(fraction > 0.0 && fraction <= 0.1, "{fraction}, {distance:?}");
    }
}
