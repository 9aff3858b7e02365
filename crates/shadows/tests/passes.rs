//! The passes that `pcf` adds to a frame, and what the graph makes of them.
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, reason = "tests")]

use glam::{DVec3, Vec3};
use shadowgraph_core::{
    Contents, DependencyKind, Format, Frame, LoadAction, PassId, PassKind, Plan, StoreAction, TextureDesc,
};
use shadowgraph_scene::{Aabb, Camera, CullVolume, Light, LightKind, Projection, origin_near};
use shadowgraph_shadows::{
    CasterView, CullSettings, Pcf, ShadowCasters, ShadowInputs, ShadowSettings, add_shadows,
};

/// Boxes as casters.
struct Boxes(Vec<Aabb>);

impl ShadowCasters for Boxes {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        let touching = (0u32..).zip(&self.0).filter(|(_, bounds)| volume.intersects(bounds));
        casters.extend(touching.map(|(index, _)| index));
    }

    fn bounds(&self) -> Aabb {
        self.0.iter().fold(Aabb::EMPTY, |all, bounds| all.union(bounds))
    }

    fn receivers(&self) -> Aabb {
        // A wide ground that casts no shadow: cascades extend as far as the settings say.
        Aabb { min: DVec3::splat(-500.0), max: DVec3::splat(500.0) }
    }

    fn draw(&self, _: &mut wgpu::RenderPass<'_>, _: &CasterView, _: &[u32]) -> u32 {
        0
    }
}

fn cube(center: DVec3) -> Aabb {
    Aabb { min: center - 0.5, max: center + 0.5 }
}

fn light(kind: LightKind) -> Light {
    Light { name: None, kind, color: Vec3::ONE, intensity: 1000.0, casts_shadow: true }
}

fn sun() -> Light {
    light(LightKind::Directional { direction: DVec3::new(0.3, -1.0, 0.2) })
}

fn spot(index: usize) -> Light {
    let position_world = DVec3::new(index as f64 * 0.1, 4.0, 0.0);
    let direction = -position_world;
    let kind =
        LightKind::Spot { position_world, direction, range: Some(12.0), inner_angle: 0.3, outer_angle: 0.6 };
    light(kind)
}

/// Plans a frame that keeps no maps.
fn plan(lights: &[Light], casters: Vec<Aabb>, cascades: u32) -> Plan {
    plan_with(lights, casters, cascades, false)
}

/// Plans a frame with a pass that reads all outputs of the technique, as a lit pass does.
fn plan_with(lights: &[Light], casters: Vec<Aabb>, cascades: u32, cache: bool) -> Plan {
    let (device, _queue) = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
    let technique = Pcf::new(&device);
    let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: Some(1000.0) };
    let camera = Camera::look_at(DVec3::new(0.0, 2.0, 8.0), DVec3::ZERO, DVec3::Y, projection);
    let mut settings = ShadowSettings::default();
    settings.cascades.count = cascades;
    (settings.cascades.cache, settings.atlas.cache) = (cache, cache);
    // Every cascade has its casters, even those that finer cascades cover.
    settings.cull = CullSettings::NONE;
    let origin_world = origin_near(camera.position_world());
    let (casters, settings) = (Boxes(casters), &settings);
    let inputs = ShadowInputs {
        view: 0,
        camera: &camera,
        aspect: 1.5,
        lights,
        casters: &casters,
        origin_world,
        settings,
    };
    let mut frame = Frame::new();
    let shadows = add_shadows(&technique, &mut frame, &inputs, None).unwrap();
    let mut lit = frame.create_texture("lit", TextureDesc::d2(64, 64, Format::Rgba8Unorm));
    let mut pass = frame.render_pass("lit");
    shadows.read_in(&mut pass);
    pass.color(&mut lit, Contents::clear_color([0.0; 4]));
    frame.export_texture(&lit);
    frame.compile().unwrap().into_plan()
}

/// Returns the steps that draw, each as the names of its passes.
fn drawn(plan: &Plan) -> Vec<Vec<&str>> {
    let steps = plan.steps().filter(|step| plan.pass(step.passes[0]).kind == PassKind::Render);
    steps.map(|step| step.passes.iter().map(|&pass| plan.pass(pass).name).collect()).collect()
}

/// Returns the load and store operations of a pass that draws depth.
fn operations(plan: &Plan, pass: PassId) -> (LoadAction, bool, StoreAction) {
    let ops = plan.accesses(pass).find_map(|access| access.ops).unwrap();
    (ops.load, ops.clear_drawn, ops.store)
}

#[test]
fn row_01_tiles_of_a_map_share_one_render_pass_that_begins_with_one_clear() {
    // Three cascades and three spot lights leave a quarter of each map without a tile.
    let lights = [sun(), spot(1), spot(2), spot(3)];
    let plan = plan(&lights, vec![cube(DVec3::ZERO)], 3);
    let cascades = ["clear", "cascade 0", "cascade 1", "cascade 2"];
    let atlas = ["clear", "light 1", "light 2", "light 3"];
    let steps = drawn(&plan);
    assert_eq!(steps.len(), 3, "{}", plan.to_text());
    assert!([&cascades[..], &atlas[..]].iter().all(|map| steps.iter().any(|step| step == map)), "{steps:?}");
    for step in plan.steps().filter(|step| step.passes.len() > 1) {
        let own: Vec<_> = step.passes.iter().map(|&pass| operations(&plan, pass)).collect();
        assert!(matches!(own[0], (LoadAction::Clear(_), false, StoreAction::Continue)), "{own:?}");
        let (last, between) = own[1..].split_last().unwrap();
        assert_eq!(*last, (LoadAction::Continue, false, StoreAction::Store));
        let continues = (LoadAction::Continue, false, StoreAction::Continue);
        assert!(between.iter().all(|ops| *ops == continues), "{own:?}");
    }
}

#[test]
fn tiles_of_a_kept_map_share_one_render_pass_too() {
    let plan = plan_with(&[sun(), spot(1), spot(2)], vec![cube(DVec3::ZERO)], 3, true);
    let steps = drawn(&plan);
    assert!(steps.contains(&vec!["cascade 0", "cascade 1", "cascade 2"]), "{steps:?}");
    assert!(steps.contains(&vec!["light 1", "light 2"]), "{steps:?}");
    assert_eq!(steps.len(), 3, "{}", plan.to_text());
}

#[test]
fn tiles_depend_on_the_clear_of_their_map_and_not_on_each_other() {
    let plan = plan(&[sun(), spot(1), spot(2)], vec![cube(DVec3::ZERO)], 4);
    let is_tile = |pass| ["cascade ", "light "].iter().any(|tile| plan.pass(pass).name.starts_with(tile));
    let tiles: Vec<_> = plan.order().iter().copied().filter(|&pass| is_tile(pass)).collect();
    assert_eq!(tiles.len(), 6);
    for tile in tiles {
        let waits: Vec<_> = plan.dependencies().iter().filter(|wait| wait.after == tile).collect();
        let names: Vec<_> = waits.iter().map(|wait| plan.pass(wait.before).name).collect();
        assert_eq!(names, ["upload shadow views", "clear"], "{}", plan.pass_path(tile));
        assert!(waits.iter().all(|wait| wait.kind == DependencyKind::ReadAfterWrite));
    }
}

#[test]
fn with_every_number_of_tiles_the_whole_map_is_defined() {
    for cascades in 1..=4 {
        let plan = plan(&[sun()], vec![cube(DVec3::ZERO)], cascades);
        assert_eq!(drawn(&plan)[0].len(), 1 + cascades as usize);
    }
    for spots in 1..=16 {
        let lights: Vec<_> = (0..spots).map(spot).collect();
        let plan = plan(&lights, vec![cube(DVec3::ZERO)], 4);
        assert_eq!(drawn(&plan)[0].len(), 1 + spots);
    }
}

#[test]
fn a_tile_without_casters_is_cleared_and_has_no_pass() {
    // Far away: the nearer cascades miss it.
    let plan = plan(&[sun()], vec![cube(DVec3::new(0.0, 0.0, -110.0))], 4);
    let steps = drawn(&plan);
    assert_eq!((steps[0][0], steps[0].last()), ("clear", Some(&"cascade 3")));
    assert!(!steps[0].contains(&"cascade 0"), "{steps:?}");
}

#[test]
fn row_01_without_casters_nothing_is_drawn_for_shadows() {
    assert_eq!(drawn(&plan(&[sun(), spot(1)], vec![], 4)), [["lit"]]);
}
