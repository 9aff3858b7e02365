//! Culling of casters.

use super::{greys, pillar_view, pillars, plan};
use crate::stage::{
    SIZE_PX, add_instance, add_mesh, box_mesh, camera, floor_mesh, gpu, material, nth_instance, sun, view,
};
use glam::{DAffine3, DVec3};
use shadowgraph::ViewOptions;
use shadowgraph::scene::{Instance, LightKind, Scene};
use shadowgraph::shadows::{
    CascadeBlend, CascadeFitting, CascadeSelection, CullSettings, MapPlan, PCF, ShadowPlan, SplitScheme,
};

/// Pseudo-random numbers from 0 to 1.
struct Random(u64);

impl Random {
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }
}

/// Returns boxes of all sizes, floating and standing, near the borders of cascades and occluding each other, a camera among them,
/// and lights at grazing angles.
fn adversarial(seed: u64) -> (Scene, ViewOptions) {
    let mut random = Random(seed.wrapping_mul(0x9e37_79b9_7f4a_7c15));
    let mut scene = Scene::default();
    let material = scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(60.0), DVec3::ZERO);
    for _ in 1..7 {
        let half = DVec3::new(
            random.between(0.02, 2.5) * random.next(),
            random.between(0.02, 6.0) * random.next(),
            random.between(0.02, 2.5),
        );
        let mesh = scene.insert_mesh(box_mesh(-half, half));
        for _ in 0..14 {
            let reach = random.between(2.0, 50.0);
            let at = DVec3::new(
                random.between(-reach, reach),
                random.between(-0.5, 9.0) * random.next(),
                random.between(-reach, reach),
            );
            add_instance(&mut scene, mesh, material, at);
        }
    }
    let way = DVec3::new(random.between(-1.0, 1.0), random.between(-1.2, -0.05), random.between(-1.0, 1.0));
    scene.insert_light(sun(way.normalize()));
    let position_world = DVec3::new(random.between(-6.0, 6.0), 4.0, random.between(-6.0, 6.0));
    scene.insert_light(super::spot(position_world, DVec3::new(0.0, -1.0, 0.0), 0.7));
    let kind = LightKind::Point { position_world: position_world * 1.4, range: Some(25.0) };
    scene.insert_light(crate::stage::light(kind, 3000.0));
    let eye = DVec3::new(random.between(-5.0, 5.0), random.between(0.3, 5.0), random.between(-5.0, 5.0));
    let target = DVec3::new(random.between(-9.0, 9.0), random.between(-1.0, 3.0), random.between(-9.0, 9.0));
    let mut options = view(camera(eye, target), 45.0);
    let cascades = &mut options.shadows.cascades;
    cascades.map_size_px = 512;
    options.shadows.atlas.map_size_px = 512;
    cascades.count = 2 + seed as u32 % 4;
    cascades.split = SplitScheme::Logarithmic;
    cascades.select =
        [CascadeSelection::Map, CascadeSelection::Sphere, CascadeSelection::Depth][seed as usize % 3];
    cascades.blend =
        [CascadeBlend::Hard, CascadeBlend::Soft(0.3), CascadeBlend::Dither(0.2)][seed as usize / 3 % 3];
    cascades.fit = [CascadeFitting::Stable, CascadeFitting::Tight][seed as usize / 9 % 2];
    (scene, options)
}

fn casters(plan: &ShadowPlan) -> usize {
    let count = |map: &Option<MapPlan>| {
        map.as_ref().map_or(0, |map| map.tiles.iter().map(|tile| tile.casters.len()).sum::<usize>())
    };
    count(&plan.cascades) + count(&plan.atlas)
}

#[test]
fn row_23_and_33_culling_casters_changes_no_pixel() {
    let Some(gpu) = gpu() else { return };
    let (mut drawn, mut kept) = (0, 0);
    for seed in 0..18 {
        let (scene, options) = adversarial(seed);
        let mut without = options.clone();
        without.shadows.cull = CullSettings::NONE;
        let (fewer, all) = (casters(&plan(&scene, &options)), casters(&plan(&scene, &without)));
        assert!(fewer <= all, "seed {seed}");
        (drawn, kept) = (drawn + all, kept + fewer);
        for light in [0, 1 + seed as u32 % 2] {
            let differ = super::different(
                &greys(gpu, &scene, light, &options),
                &greys(gpu, &scene, light, &without),
                0,
            );
            assert_eq!(differ, 0, "seed {seed} light {light}: pixels of {SIZE_PX:?}");
        }
    }
    // At least a fifth of all draws is saved.
    assert!(kept * 10 < drawn * 8, "{kept} of {drawn}");
}

#[test]
fn row_23_casters_covered_by_finer_cascades_are_culled_from_coarser_ones() {
    let mut scene = pillars(40);
    scene.insert_light(sun(crate::stage::sun_direction(60.0, 60.0)));
    let with = |unseen, covered| {
        let options = pillar_view(|settings| settings.cull = CullSettings { unseen, covered });
        let tiles = plan(&scene, &options).cascades.unwrap().tiles;
        tiles.iter().map(|tile| tile.casters.len()).collect::<Vec<_>>()
    };
    let (none, unseen, all) = (with(false, false), with(true, false), with(true, true));
    assert_eq!(unseen[0], all[0], "the finest cascade is not culled");
    assert!(all[1..].iter().sum::<usize>() * 4 < unseen[1..].iter().sum::<usize>() * 3, "{unseen:?} {all:?}");
    assert!(unseen.iter().sum::<usize>() < none.iter().sum(), "{none:?} {unseen:?}");
}

#[test]
fn row_33_a_cascade_without_receivers_has_no_pass() {
    let mut scene = pillars(3);
    scene.insert_light(sun(crate::stage::sun_direction(60.0, 60.0)));
    scene.remove_instance(nth_instance(&scene, 0)).unwrap();
    let behind = scene.instance(nth_instance(&scene, 0)).unwrap().clone();
    let at = DAffine3::from_translation(DVec3::Z * 8.0);
    scene.insert_instance(Instance { world_from_local: at, ..behind }).unwrap();
    let options = pillar_view(|settings| settings.cascades.split = SplitScheme::Standard);
    let tiles = plan(&scene, &options).cascades.unwrap().tiles;
    // The first 6 m of the view are empty.
    assert!(tiles[0].casters.is_empty() && !tiles[2].casters.is_empty(), "{tiles:?}");
    let gpu = shadowgraph::Gpu::noop().unwrap();
    let aov = shadowgraph::options::Aov::Color;
    let renderer = shadowgraph::Renderer::with_config(&gpu, scene, &options.camera, aov, PCF).unwrap();
    let text = renderer.plan(&options).unwrap().0.to_text();
    assert!(text.contains("cascade 2") && !text.contains("cascade 0"), "{text}");
}
