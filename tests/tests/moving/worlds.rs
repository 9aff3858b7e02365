//! Scenes of the library that change at random, and pairs of renderers that draw them: one keeps maps, one does not.

use glam::{DVec3, Vec4};
use shadowgraph::options::Aov;
use shadowgraph::scene::{
    AlphaMode, Camera, CasterMode, Image, Instance, Light, LightKind, Material, Mesh, Projection, Scene,
    TextureRef,
};
use shadowgraph::shadows::{
    CascadeBlend, CascadeSelection, CullSettings, DepthFormat, ShadowFilter, ShadowSettings, TechniqueKind,
};
use shadowgraph::{Gpu, RenderedFrame, Renderer, ViewOptions};
use shadowgraph_tests::edits;
use shadowgraph_tests::random::Random;

pub(crate) const SIZE_PX: [u32; 2] = [96, 54];

/// Returns a floor with boxes of several materials: opaque, with holes, dithered and of coloured glass.
pub(crate) fn scene(random: &mut Random) -> Scene {
    let mut scene = Scene::default();
    let grey = Material { base_color: Vec4::new(0.8, 0.8, 0.8, 1.0), metallic: 0.0, ..Material::default() };
    let rgba8 = (0..64).flat_map(|i| [255, 255, 255, if (i / 2 + i / 16) % 2 == 0 { 255 } else { 0 }]);
    let image = Image::new("checks", 8, 8, rgba8.collect());
    let base_color_texture = Some(TextureRef::new(scene.insert_image(image).unwrap()));
    let holes = Material { alpha: AlphaMode::Mask { cutoff: 0.5 }, base_color_texture, ..grey.clone() };
    let glass =
        Material { alpha: AlphaMode::Blend, base_color: Vec4::new(0.2, 0.7, 0.9, 0.5), ..grey.clone() };
    let hair = Material {
        casts: Some(CasterMode::Dither),
        base_color: Vec4::new(0.5, 0.4, 0.3, 0.6),
        ..grey.clone()
    };
    let materials = [grey, holes, glass, hair].map(|material| scene.insert_material(material).unwrap());
    let floor = Mesh::cuboid(DVec3::new(-30.0, -0.5, -30.0), DVec3::new(30.0, 0.0, 30.0));
    let cube = Mesh::cuboid(DVec3::new(-0.5, 0.0, -0.5), DVec3::new(0.5, 1.0, 0.5));
    let [floor, cube] = [floor, cube].map(|mesh| scene.insert_mesh(mesh));
    scene.insert_instance(Instance::new(floor, materials[0], glam::DAffine3::IDENTITY)).unwrap();
    for index in 0..16 {
        // Eight are far away: an edit brings them near.
        let mut at = edits::transform(random);
        at.translation *= if index < 8 { 1.0 } else { 3.0 };
        at.translation.y = at.translation.y.min(2.0);
        scene.insert_instance(Instance::new(cube, materials[index % 4], at)).unwrap();
    }
    scene.set_lights(lights(random));
    scene
}

fn light(kind: LightKind, intensity: f32) -> Light {
    Light { name: None, kind, color: glam::Vec3::ONE, intensity, casts_shadow: true }
}

/// Returns a sun, a spot light and a point light.
fn lights(random: &mut Random) -> Vec<Light> {
    let down = |random: &mut Random| {
        DVec3::new(random.between(-0.8, 0.8), -1.0, random.between(-0.8, 0.8)).normalize()
    };
    let above = |random: &mut Random| DVec3::new(random.between(-5.0, 5.0), 4.0, random.between(-5.0, 5.0));
    let range = Some(random.between(6.0, 15.0));
    let (position_world, direction) = (above(random), down(random));
    let spot = LightKind::Spot { position_world, direction, inner_angle: 0.4, outer_angle: 0.8, range };
    let point = LightKind::Point { position_world: above(random), range };
    vec![
        light(LightKind::Directional { direction: down(random) }, 20_000.0),
        light(spot, 200_000.0),
        light(point, 100_000.0),
    ]
}

/// Moves a light a little, switches its shadows, or replaces all lights.
pub(crate) fn edit_lights(scene: &mut Scene, random: &mut Random) {
    let mut changed = scene.lights().to_vec();
    let index = random.below(changed.len() as u64) as usize;
    let by = DVec3::new(random.between(-0.2, 0.2), random.between(-0.1, 0.1), random.between(-0.2, 0.2));
    match (random.below(6), &mut changed[index].kind) {
        (0, _) => changed = lights(random),
        (1, _) => changed[index].casts_shadow = !changed[index].casts_shadow,
        (2, LightKind::Spot { range, .. } | LightKind::Point { range, .. }) => {
            *range = Some(random.between(5.0, 15.0))
        }
        (_, LightKind::Directional { direction }) => *direction = (*direction + 0.1 * by).normalize(),
        (3, LightKind::Spot { direction, .. }) => *direction = (*direction + by).normalize(),
        (_, LightKind::Spot { position_world, .. } | LightKind::Point { position_world, .. }) => {
            *position_world += by
        }
    }
    scene.set_lights(changed);
}

/// Moves some of three objects a little.
pub(crate) fn move_some(scene: &mut Scene, random: &mut Random) {
    for nth in [2, 3, 4] {
        let Some((key, instance)) = scene.instances().nth(nth) else { continue };
        let mut moved = instance.world_from_local;
        moved.translation += DVec3::new(random.between(-0.1, 0.1), 0.0, random.between(-0.1, 0.1));
        if random.below(3) > 0 {
            scene.move_instance(key, moved).unwrap();
        }
    }
}

/// Changes how a material casts shadows.
pub(crate) fn edit_material(scene: &mut Scene, random: &mut Random) {
    let number = random.below(scene.materials().len() as u64) as usize;
    let Some((key, _)) = scene.materials().nth(number) else { return };
    let cutoff = random.between(0.1, 0.9) as f32;
    let alpha = [AlphaMode::Opaque, AlphaMode::Mask { cutoff }, AlphaMode::Blend][random.below(3) as usize];
    let casts = [None, Some(CasterMode::On), Some(CasterMode::Dither), Some(CasterMode::Off)];
    let casts = casts[random.below(4) as usize];
    let opacity = random.between(0.2, 1.0) as f32;
    let edited = random.below(5);
    scene
        .edit_material(key, |material| match edited {
            0 => material.alpha = alpha,
            1 => material.casts = casts,
            2 => material.double_sided = !material.double_sided,
            3 => material.base_color.w = opacity,
            _ => material.receives_shadows = !material.receives_shadows,
        })
        .unwrap();
}

/// Returns settings of small maps.
pub(crate) fn settings(random: &mut Random) -> ShadowSettings {
    let mut settings =
        ShadowSettings { distance_m: [15.0, 60.0][random.below(2) as usize], ..Default::default() };
    let formats = [DepthFormat::Depth16, DepthFormat::Depth24, DepthFormat::Depth32];
    let mut format = || formats[random.below(3) as usize];
    (settings.cascades.depth, settings.atlas.depth) = (format(), format());
    let cascades = &mut settings.cascades;
    cascades.count = random.below(5) as u32;
    cascades.map_size_px = 256 << random.below(2);
    cascades.filter = ShadowFilter::ALL[random.below(4) as usize];
    cascades.select =
        [CascadeSelection::Map, CascadeSelection::Sphere, CascadeSelection::Depth][random.below(3) as usize];
    cascades.blend =
        [CascadeBlend::Hard, CascadeBlend::Soft(0.2), CascadeBlend::Dither(0.2)][random.below(3) as usize];
    settings.atlas.map_size_px = 256 << random.below(2);
    settings.cull = CullSettings { unseen: random.below(4) > 0, covered: random.below(4) > 0 };
    settings
}

pub(crate) fn camera(eye: DVec3, target: DVec3, fov_y: f64) -> Camera {
    let projection = Projection::Perspective { fov_y, near: 0.1, far: Some(100.0) };
    Camera::look_at(eye, target, DVec3::Y, projection)
}

/// Two renderers of one scene.
pub(crate) struct Pair {
    /// Keeps maps.
    pub(crate) kept: Renderer,
    /// Draws all maps in every frame.
    pub(crate) drawn: Renderer,
}

impl Pair {
    pub(crate) fn new(gpu: &Gpu, technique: TechniqueKind) -> Self {
        let (scene, eye) = (Scene::default(), camera(DVec3::Y, DVec3::ZERO, 1.0));
        let [kept, drawn] =
            [(); 2].map(|()| Renderer::with_config(gpu, scene.clone(), &eye, Aov::Color, technique).unwrap());
        Self { kept, drawn }
    }

    /// Gives both another scene, with nothing kept.
    pub(crate) fn restart(&mut self, gpu: &Gpu, scene: &Scene) {
        self.kept.set_scene(gpu, scene.clone()).unwrap();
        self.drawn.set_scene(gpu, scene.clone()).unwrap();
    }

    /// Makes the same edit in both scenes.
    pub(crate) fn edit(&mut self, random: &mut Random, edit: impl Fn(&mut Scene, &mut Random)) {
        edit(self.drawn.scene_mut(), &mut random.clone());
        edit(self.kept.scene_mut(), random);
    }

    /// Draws a frame with both: with the maps that the options keep, and with none.
    pub(crate) fn draw(&mut self, gpu: &Gpu, options: &ViewOptions) -> [RenderedFrame; 2] {
        let without = ViewOptions { shadows: options.shadows.without_cache(), ..options.clone() };
        [self.kept.draw(gpu, options).unwrap(), self.drawn.draw(gpu, &without).unwrap()]
    }
}

/// Returns the number of pixels that differ by more than `most` of 255 in a channel.
pub(crate) fn different_pixels(a: &RenderedFrame, b: &RenderedFrame, most: u8) -> usize {
    let pixels = a.image.rgba8.chunks_exact(4).zip(b.image.rgba8.chunks_exact(4));
    pixels.filter(|(a, b)| a.iter().zip(*b).any(|(a, b)| a.abs_diff(*b) > most)).count()
}
