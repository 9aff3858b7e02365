//! Images with kept maps are those with maps that are drawn every frame.

use crate::maps::notes;
use crate::worlds::{
    Pair, SIZE_PX, camera, different_pixels, edit_lights, edit_material, move_some, scene, settings,
};
use crate::{frames, gpu, seed};
use glam::DVec3;
use shadowgraph::ViewOptions;
use shadowgraph::core::Plan;
use shadowgraph::scene::Scene;
use shadowgraph::shadows::{AtlasTiles, EVSM, PCF, PCSS, TechniqueKind};
use shadowgraph_tests::edits;
use shadowgraph_tests::random::Random;
use shadowgraph_tests::shares::in_shares;

/// The number of frames after which renderers start afresh with another scene.
const SCENE: u64 = 40;

/// The largest number of frames of one process.
const SHARE: u64 = 120;

/// The techniques of the scenes, in turn.
const TECHNIQUES: [TechniqueKind; 4] = [PCF, PCF, EVSM, PCSS];

/// Returns the technique of a scene.
fn technique(number: u64) -> TechniqueKind {
    TECHNIQUES[(u64::from(seed() / 100) + number) as usize % TECHNIQUES.len()]
}

/// Counts what the plans of frames say about their tiles.
#[derive(Debug, Default)]
struct Counts {
    kept: usize,
    moved: usize,
    scrolled: usize,
    drawn: usize,
}

impl Counts {
    fn add(&mut self, plan: &Plan) {
        for name in ["cascades", "atlas", "cascade tints", "atlas tints"] {
            for note in notes(plan, name) {
                self.kept += usize::from(note.contains(" kept: "));
                self.moved += usize::from(note.contains("; drawn: "));
                self.scrolled += usize::from(note.contains("came in"));
                self.drawn += usize::from(note.contains(" drawn: ") && !note.contains(" kept: "));
            }
        }
    }
}

/// Changes a scene as a game and its editor would: some objects move all the time.
fn change(scene: &mut Scene, random: &mut Random) {
    move_some(scene, random);
    match random.below(12) {
        0 | 1 => edit_material(scene, random),
        2 | 3 => edit_lights(scene, random),
        4..7 => edits::edit(scene, random).unwrap(),
        _ => {}
    }
}

#[test]
fn images_are_equal_to_the_bit_over_random_motions_of_casters_lights_materials_and_settings() {
    let Some(gpu) = gpu() else { return };
    if frames() > SHARE {
        let test = "images::images_are_equal_to_the_bit_over_random_motions_of_casters_lights_materials_and_settings";
        return in_shares(test, frames() as u32, SHARE as u32);
    }
    let mut pairs: Vec<(TechniqueKind, Pair)> = Vec::new();
    let (mut counts, mut images) = (Counts::default(), Vec::new());
    for number in 0..frames().div_ceil(SCENE) {
        let technique = technique(number);
        let index = pairs.iter().position(|(of, _)| of.name == technique.name).unwrap_or_else(|| {
            pairs.push((technique, Pair::new(gpu, technique)));
            pairs.len() - 1
        });
        let pair = &mut pairs[index].1;
        let random = &mut Random::new(seed() + number as u32);
        pair.restart(gpu, &scene(random));
        let eye = DVec3::new(random.between(-7.0, 7.0), random.between(1.5, 5.0), random.between(4.0, 8.0));
        let mut options = ViewOptions {
            camera: camera(eye, DVec3::Y * 0.5, 0.9),
            size_px: SIZE_PX,
            shadows: settings(random),
        };
        for frame in 0..SCENE {
            match random.below(20) {
                0 => options.shadows = settings(random),
                1 => {
                    let fov_y = [0.6, 0.9, 1.3][random.below(3) as usize];
                    options.camera = camera(eye, DVec3::Y * 0.5, fov_y);
                }
                2 => options.shadows.cascades.cache = !options.shadows.cascades.cache,
                3 => options.shadows.atlas.cache = !options.shadows.atlas.cache,
                // What is only planned is not drawn.
                4 => drop(pair.kept.plan(&options).unwrap()),
                5..8 => {}
                _ => pair.edit(random, change),
            }
            let [with, without] = pair.draw(gpu, &options);
            counts.add(&with.plan);
            let differ = different_pixels(&with, &without, 0);
            let said = ["cascades", "atlas"].map(|name| notes(&with.plan, name));
            let name = technique.name;
            assert_eq!(
                differ, 0,
                "{name}, frame {frame} of scene {number}: {said:#?}, {:#?}",
                options.shadows
            );
            images.push(with.image);
        }
    }
    let count = images.len();
    images.dedup();
    println!("soak: {count} equal frames, {} of them unlike the one before; tiles: {counts:?}", images.len());
    assert!(images.len() * 2 > count, "the changes are visible");
    assert!(counts.kept > count && counts.moved > count / 4 && counts.drawn > count / 4, "{counts:?}");
}

/// Walks with random turns; now and then it jumps a few metres.
fn walk(eye: &mut DVec3, heading: &mut f64, random: &mut Random) -> ViewOptions {
    *heading += random.between(-0.04, 0.04);
    let ahead = DVec3::new(heading.sin(), 0.0, -heading.cos());
    *eye += ahead * (1.4 / 60.0 * random.between(0.0, 3.0)) + DVec3::Y * random.between(-0.01, 0.01);
    if random.below(40) == 0 {
        *eye += DVec3::new(random.between(-4.0, 4.0), 0.0, random.between(-4.0, 4.0));
        *heading += random.between(-1.0, 1.0);
    }
    let options = camera(*eye, *eye + ahead - DVec3::Y * 0.25, 0.9);
    ViewOptions { camera: options, size_px: SIZE_PX, shadows: Default::default() }
}

#[test]
fn images_are_those_of_a_fresh_start_after_a_walk_but_for_rounding() {
    let Some(gpu) = gpu() else { return };
    if frames() > SHARE {
        let test = "images::images_are_those_of_a_fresh_start_after_a_walk_but_for_rounding";
        return in_shares(test, frames() as u32, SHARE as u32);
    }
    let mut pair = Pair::new(gpu, technique(0));
    let (mut counts, mut differ, mut pixels) = (Counts::default(), 0, 0);
    let random = &mut Random::new(seed());
    pair.restart(gpu, &scene(random));
    let (mut eye, mut heading) = (DVec3::new(0.0, 1.7, 7.0), 0.0);
    let mut shadows = settings(random);
    shadows.cascades.count = 4;
    // Others keep the sizes of their tiles as lights' shares of the image change.
    shadows.atlas.tiles = AtlasTiles::Even;
    for _ in 0..frames() {
        let options = ViewOptions { shadows: shadows.clone(), ..walk(&mut eye, &mut heading, random) };
        if random.below(4) == 0 {
            pair.edit(random, change);
        }
        let [with, without] = pair.draw(gpu, &options);
        counts.add(&with.plan);
        differ += different_pixels(&with, &without, 2);
        pixels += u64::from(SIZE_PX[0] * SIZE_PX[1]);
    }
    let options = ViewOptions { shadows, ..walk(&mut eye, &mut heading, random) };
    // Cascades keep an end that is farther than needed for some frames.
    let mut with = pair.kept.draw(gpu, &options).unwrap();
    for _ in 0..60 {
        with = pair.kept.draw(gpu, &options).unwrap();
    }
    let scene = pair.kept.scene().clone();
    pair.drawn.set_scene(gpu, scene).unwrap();
    let fresh = pair.drawn.draw(gpu, &options).unwrap();
    let differ_at_end = different_pixels(&with, &fresh, 2);
    let ends = u64::from(SIZE_PX[0] * SIZE_PX[1]);
    println!(
        "soak: {differ} of {pixels} pixels differ, {differ_at_end} of {ends} from a fresh start; tiles: {counts:?}"
    );
    assert!(counts.scrolled as u64 > frames() / 2, "{counts:?}");
    assert!(differ as u64 * 100_000 <= pixels, "{differ} of {pixels} pixels differ");
    assert!(differ_at_end as u64 * 100_000 <= ends, "{differ_at_end} of {ends} pixels differ");
}
