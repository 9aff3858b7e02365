//! The rows of `docs/shadows.md`, each with its setting on and off: its effect is there with it and missing without.

mod atlas;
mod bias;
mod budget;
mod caching;
mod cascades;
mod creases;
mod culling;
mod day;
mod distance;
mod figures;
mod filters;
mod materials;
mod modes;
mod overlay;
mod own_casters;
mod points;
mod screen;
mod supersampling;
mod tracks;
mod views;

use crate::stage::{
    add_instance, add_mesh, box_mesh, camera, cube_on_floor, draw_with, floor_mesh, hard, material, plan,
    view,
};
use glam::DVec3;
use shadowgraph::options::Aov;
use shadowgraph::scene::{Camera, Light, LightKind, Scene};
use shadowgraph::shadows::{PCF, RAYTRACED, ShadowSettings, TechniqueKind};
use shadowgraph::{Gpu, ViewOptions};

/// The visibility of a light in each pixel, 255 lit; `None` in the background and where the surface faces away.
type Greys = Vec<Option<u8>>;

fn greys_with(
    gpu: &Gpu,
    scene: &Scene,
    light: u32,
    options: &ViewOptions,
    technique: TechniqueKind,
) -> Greys {
    let aov = Aov::Visibility(light);
    let image = draw_with(gpu, scene, aov, &hard(options), technique).image;
    image.rgba8.chunks_exact(4).map(|rgba| (rgba[3] == 255).then_some(rgba[0])).collect()
}

fn greys(gpu: &Gpu, scene: &Scene, light: u32, options: &ViewOptions) -> Greys {
    greys_with(gpu, scene, light, options, PCF)
}

/// Counts the pixels that differ from rays by more than one half.
fn wrong(gpu: &Gpu, scene: &Scene, light: u32, options: &ViewOptions) -> usize {
    let truth = greys_with(gpu, scene, light, options, RAYTRACED);
    different(&greys(gpu, scene, light, options), &truth, 127)
}

/// Counts the pixels that differ by more than `by`.
fn different(a: &Greys, b: &Greys, by: u8) -> usize {
    a.iter().zip(b).filter(|(a, b)| a.zip(**b).is_some_and(|(a, b)| a.abs_diff(b) > by)).count()
}

fn count(greys: &Greys, is: impl Fn(u8) -> bool) -> usize {
    greys.iter().flatten().filter(|grey| is(**grey)).count()
}

/// Counts the pixels in shadow, and those in penumbra.
fn dark_and_between(greys: &Greys) -> (usize, usize) {
    (count(greys, |grey| grey < 3), count(greys, |grey| (3..253).contains(&grey)))
}

/// Returns a camera that looks down at the cube on its floor from 5 m away.
fn at_cube() -> Camera {
    camera(DVec3::new(2.0, 3.0, 4.0), DVec3::new(0.0, 0.3, 0.0))
}

fn cube_view(change: impl FnOnce(&mut ShadowSettings)) -> ViewOptions {
    let mut options = view(at_cube(), 20.0);
    change(&mut options.shadows);
    options
}

fn spot(position_world: DVec3, target: DVec3, half_angle: f64) -> Light {
    let direction = (target - position_world).normalize();
    let kind = LightKind::Spot {
        position_world,
        direction,
        range: Some(20.0),
        inner_angle: half_angle * 0.9,
        outer_angle: half_angle,
    };
    crate::stage::light(kind, 4000.0)
}

/// Returns the cube on its floor under a spot light from the side.
fn cube_under_spot() -> Scene {
    let mut scene = cube_on_floor(DVec3::ZERO);
    scene.insert_light(spot(DVec3::new(-3.0, 3.5, 1.0), DVec3::ZERO, 0.6));
    scene
}

/// Returns two rows of pillars that lead away from the camera, 2 m apart, on a floor 200 m long.
fn pillars(count: usize) -> Scene {
    let mut scene = Scene::default();
    let material = scene.insert_material(material()).unwrap();
    add_mesh(&mut scene, floor_mesh(200.0), DVec3::ZERO);
    let pillar = box_mesh(DVec3::new(-0.3, 0.0, -0.3), DVec3::new(0.3, 2.5, 0.3));
    let pillar = scene.insert_mesh(pillar);
    for i in 0..count {
        for side in [-2.0, 2.0] {
            add_instance(&mut scene, pillar, material, DVec3::new(side, 0.0, -2.0 * i as f64));
        }
    }
    scene
}

/// Returns a view along the pillars.
fn pillar_view(change: impl FnOnce(&mut ShadowSettings)) -> ViewOptions {
    let mut options = view(camera(DVec3::new(0.3, 2.5, 5.0), DVec3::new(0.0, 0.5, -15.0)), 60.0);
    change(&mut options.shadows);
    options
}
