#![allow(clippy::print_stdout, reason = "prints measured shares and times")]

use glam::DMat3;
use proptest::prelude::*;

use super::super::random::{Random, View, cases, randoms};
use super::super::{LightSpaceView, ReceiverHull};
use super::*;

mod street;

/// The kinds of covered volumes in a scene.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Boxes,
    Spheres,
    Depths,
    Mixed,
}

/// A view, a light and some cascades. The last one covers everything that no other does.
struct Scene {
    view: View,
    rotation: DMat3,
    prepared: LightSpaceView,
    bounds: Option<Aabb>,
    finer: Vec<CoveredByFinerCascade>,
    /// The end of each cascade, metres of view depth.
    ends_m: Vec<f64>,
    radii_m: Vec<f64>,
}

impl Scene {
    fn random(random: &mut Random, kind: Kind) -> Self {
        let distance_m = random.magnitude(0.0, 6.0);
        let view = random.view(distance_m);
        let to_light = random.light_direction(&view);
        let rotation = random.axes(to_light);
        let mut prepared = LightSpaceView::new(&view.hull(), rotation);
        let mut bounds = None;
        if random.below(2) == 0 {
            let half = DVec3::from_array([0; 3].map(|_| view.far_m * random.magnitude(-2.0, 0.5)));
            let middle = random.visible(&view);
            let within = Aabb { min: middle - half, max: middle + half };
            prepared = prepared.intersect(&LightSpaceView::new(&ReceiverHull::from_box(&within), rotation));
            bounds = Some(within);
        }
        let count = 1 + random.below(3) as usize;
        let mut scene =
            Self { view, rotation, prepared, bounds, finer: vec![], ends_m: vec![], radii_m: vec![] };
        let mut near_m = scene.view.near_m;
        for i in 0..count {
            let part = ((i + 1) as f64 / (count + 1) as f64).powf(random.range(1.0, 3.0));
            let far_m = (scene.view.far_m * part).max(near_m * 1.01);
            scene.add_cascade(random, kind, near_m, far_m);
            near_m = far_m;
        }
        scene.radii_m = (0..=count)
            .map(|_| random.fraction_or_end() * scene.view.far_m * random.magnitude(-5.0, -1.0))
            .collect();
        scene
    }

    /// Adds a sphere around the slice, sometimes too small or shifted, or a box around the sphere.
    fn add_cascade(&mut self, random: &mut Random, kind: Kind, near_m: f64, far_m: f64) {
        let Self { view: View { camera, aspect, far_m: end_m, .. }, rotation, .. } = &*self;
        let corners = *ReceiverHull::from_view(camera, *aspect, near_m, far_m).corners();
        let middle = corners.iter().sum::<DVec3>() / 8.0;
        let radius = corners.iter().fold(0.0, |most: f64, corner| most.max(corner.distance(middle)));
        let radius_m = radius * random.range(0.5, 1.5);
        let center_light = *rotation * (middle + random.unit() * radius * random.magnitude(-3.0, -0.5));
        let half = DVec3::splat(radius_m);
        let tall = if random.below(2) == 0 { DVec3::Z * 2.0 * radius_m } else { DVec3::ZERO };
        let covered = match (kind, random.below(3)) {
            (Kind::Boxes, _) | (Kind::Mixed, 0) => {
                CoveredByFinerCascade::Box(Aabb { min: center_light - half, max: center_light + half + tall })
            }
            (Kind::Spheres, _) | (Kind::Mixed, 1) => CoveredByFinerCascade::Sphere { center_light, radius_m },
            _ => {
                let rest = ReceiverHull::from_view(camera, *aspect, far_m, *end_m);
                let mut beyond = LightSpaceView::new(&rest, *rotation);
                if let Some(bounds) = &self.bounds {
                    beyond =
                        beyond.intersect(&LightSpaceView::new(&ReceiverHull::from_box(bounds), *rotation));
                }
                CoveredByFinerCascade::Depth { beyond }
            }
        };
        self.finer.push(covered);
        self.ends_m.push(far_m);
    }

    /// Returns the cascade that the receiver reads: the first that covers it.
    fn cascade_of(&self, world: DVec3) -> usize {
        let light = self.rotation * world;
        let covers = |(covered, end_m): (&CoveredByFinerCascade, &f64)| match covered {
            CoveredByFinerCascade::Box(bounds) => bounds.contains_point(light),
            CoveredByFinerCascade::Sphere { center_light, radius_m } => {
                center_light.distance(light) <= *radius_m
            }
            CoveredByFinerCascade::Depth { .. } => {
                -self.view.camera.world_from_view.inverse().transform_point3(world).z < *end_m
            }
        };
        self.finer.iter().zip(&self.ends_m).position(covers).unwrap_or(self.finer.len())
    }

    fn is_visible(&self, world: DVec3) -> bool {
        self.view.contains(world) && self.bounds.is_none_or(|bounds| bounds.contains_point(world))
    }

    fn redundant_casters(&self, cascade: usize) -> RedundantCasters<'_> {
        RedundantCasters::new(&self.prepared, &self.finer[..cascade], self.radii_m[cascade])
    }

    /// Returns whether culling the caster from its cascade could change the receiver's shadow.
    fn darkens(&self, caster: &Aabb, cascade: usize, light: DVec3) -> bool {
        let radius_m = self.radii_m[cascade];
        let grown = Aabb { min: caster.min - radius_m, max: caster.max + radius_m };
        grown.contains_point(light.with_z(grown.min.z)) && light.z <= grown.max.z
    }

    /// Returns a caster between the light and a receiver: tiny, huge, long along the light, or near the end of the radius.
    fn caster_above(&self, random: &mut Random, receiver_light: DVec3) -> Aabb {
        let far_m = self.view.far_m;
        let up = if random.below(3) == 0 { 0.0 } else { far_m * random.magnitude(-4.0, 0.5) };
        let aside = random.cube() * far_m * random.magnitude(-5.0, -1.0) * random.below(2) as f64;
        let size = random.magnitude(-4.0, 0.5) * far_m;
        let mut sides = || DVec3::from_array([0; 3].map(|_| size * random.fraction_or_end()));
        let (low, high) = (sides(), sides());
        let long = if random.below(4) == 0 { DVec3::Z * far_m } else { DVec3::ZERO };
        let middle = receiver_light + aside + DVec3::Z * up;
        Aabb { min: middle - low - long, max: middle + high + long }
    }

    /// Returns receivers in the column below the caster, most of them near the end of a cascade's volume.
    fn receivers_below(&self, random: &mut Random, caster: &Aabb) -> Vec<DVec3> {
        let world_from_light = self.rotation.transpose();
        let mut receivers = Vec::new();
        for _ in 0..12 {
            let any = self.rotation * random.visible(&self.view);
            let part =
                DVec3::new(random.fraction_or_end(), random.fraction_or_end(), random.fraction_or_end());
            let in_caster = caster.min + (caster.max - caster.min) * part;
            let z = match &self.finer[random.below(self.finer.len() as u64) as usize] {
                CoveredByFinerCascade::Box(bounds) if random.below(2) == 0 => {
                    let end = if random.below(2) == 0 { bounds.min.z } else { bounds.max.z };
                    end + self.view.far_m * random.magnitude(-8.0, -2.0) * random.range(-1.0, 1.0)
                }
                _ => any.z,
            };
            receivers.push(world_from_light * in_caster.with_z(z));
        }
        receivers.retain(|world| self.is_visible(*world));
        receivers
    }
}

/// Number of casters that were redundant, needed, or neither.
#[derive(Clone, Copy, Debug, Default)]
struct Counts {
    redundant: u32,
    needed: u32,
    neither: u32,
}

/// Checks random casters of one scene against random receivers; the error describes the failure.
fn check(random: &mut Random, kind: Kind) -> Result<Counts, String> {
    let scene = Scene::random(random, kind);
    let mut counts = Counts::default();
    for _ in 0..8 {
        let mut receivers = vec![random.visible(&scene.view), random.visible(&scene.view)];
        receivers.retain(|world| scene.is_visible(*world));
        let above = receivers.first().copied().unwrap_or(scene.view.point(DVec3::splat(0.5)));
        let caster = scene.caster_above(random, scene.rotation * above);
        receivers.extend(scene.receivers_below(random, &caster));
        for cascade in 0..=scene.finer.len() {
            let needs = |world: &&DVec3| {
                scene.cascade_of(**world) == cascade
                    && scene.darkens(&caster, cascade, scene.rotation * **world)
            };
            let needing = receivers.iter().find(needs);
            match (scene.redundant_casters(cascade).is_redundant(&caster), needing) {
                (true, Some(world)) => {
                    return Err(format!("{caster:?} is missing in {cascade} at {world}: {:?}", scene.finer));
                }
                (true, None) => counts.redundant += 1,
                (false, Some(_)) => counts.needed += 1,
                (false, None) => counts.neither += 1,
            }
        }
    }
    Ok(counts)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(cases()))]

    #[test]
    fn no_receiver_misses_a_caster_that_is_redundant_by_boxes(mut random in randoms()) {
        check(&mut random, Kind::Boxes).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn no_receiver_misses_a_caster_that_is_redundant_by_spheres(mut random in randoms()) {
        check(&mut random, Kind::Spheres).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn no_receiver_misses_a_caster_that_is_redundant_by_depths(mut random in randoms()) {
        check(&mut random, Kind::Depths).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn no_receiver_misses_a_caster_that_is_redundant_by_mixed_kinds(mut random in randoms()) {
        check(&mut random, Kind::Mixed).map_err(TestCaseError::fail)?;
    }

    #[test]
    fn pieces_fill_the_box_without_the_inner_box(mut random in randoms()) {
        let mut random_box = || {
            let (a, b) = (random.cube(), random.cube());
            Aabb { min: a.min(b), max: a.max(b) }
        };
        let (part, other) = (random_box(), random_box());
        let Some(inner) = common(&part, &other) else { return Ok(()) };
        let pieces: Vec<Aabb> = outside(&part, &inner).collect();
        let volume = |piece: &Aabb| (piece.max - piece.min).element_product();
        let all = pieces.iter().map(volume).sum::<f64>() + volume(&inner);
        prop_assert!((all - volume(&part)).abs() < 1e-12);
        for piece in pieces {
            prop_assert!(!piece.is_empty() && piece.union(&part) == part);
            prop_assert!(common(&piece, &inner).is_none_or(|both| volume(&both) == 0.0));
        }
    }
}

#[test]
fn random_scenes_have_redundant_and_needed_casters() {
    for kind in [Kind::Boxes, Kind::Spheres, Kind::Depths] {
        let mut random = Random(11);
        let mut sum = Counts::default();
        for _ in 0..1000 {
            let counts = check(&mut random, kind).unwrap_or_default();
            sum.redundant += counts.redundant;
            sum.needed += counts.needed;
            sum.neither += counts.neither;
        }
        println!("{kind:?}: {sum:?}");
        assert!(sum.redundant > 2000 && sum.needed > 2000, "{kind:?}: {sum:?}");
    }
}

fn cube(half: f64) -> Aabb {
    Aabb { min: DVec3::splat(-half), max: DVec3::splat(half) }
}

#[test]
fn two_cascades_cover_together_what_neither_covers_alone() {
    let view = LightSpaceView::new(&ReceiverHull::from_box(&cube(10.0)), DMat3::IDENTITY);
    let left =
        CoveredByFinerCascade::Box(Aabb { min: DVec3::splat(-20.0), max: DVec3::new(0.5, 20.0, 20.0) });
    let right =
        CoveredByFinerCascade::Box(Aabb { min: DVec3::new(-0.5, -20.0, -20.0), max: DVec3::splat(20.0) });
    for finer in [[left.clone(), right.clone()], [right, left]] {
        assert!(RedundantCasters::new(&view, &finer, 0.1).is_redundant(&cube(3.0)));
        assert!(!RedundantCasters::new(&view, &finer[..1], 0.1).is_redundant(&cube(3.0)));
    }
}

#[test]
fn a_cascade_elsewhere_does_not_affect_the_finer_ones() {
    let view = LightSpaceView::new(&ReceiverHull::from_box(&cube(10.0)), DMat3::IDENTITY);
    let here = CoveredByFinerCascade::Box(Aabb { min: DVec3::splat(-20.0), max: DVec3::splat(20.0) });
    let elsewhere = CoveredByFinerCascade::Box(Aabb { min: DVec3::splat(5.0), max: DVec3::splat(20.0) });
    assert!(RedundantCasters::new(&view, &[here, elsewhere], 0.1).is_redundant(&cube(3.0)));
}

#[test]
fn casters_of_receivers_nearer_to_the_light_than_the_box_are_kept() {
    let view = LightSpaceView::new(&ReceiverHull::from_box(&cube(10.0)), DMat3::IDENTITY);
    let low =
        [CoveredByFinerCascade::Box(Aabb { min: DVec3::splat(-20.0), max: DVec3::new(20.0, 20.0, 5.0) })];
    let casters = RedundantCasters::new(&view, &low, 0.5);
    assert!(casters.is_redundant(&Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 4.4) }));
    assert!(!casters.is_redundant(&Aabb { min: DVec3::ZERO, max: DVec3::new(1.0, 1.0, 4.6) }));
}

#[test]
fn spheres_and_depths_that_contain_everything_visible_make_every_caster_redundant() {
    let view = LightSpaceView::new(&ReceiverHull::from_box(&cube(1.0)), DMat3::IDENTITY);
    let sphere = |radius_m: f64| [CoveredByFinerCascade::Sphere { center_light: DVec3::ZERO, radius_m }];
    assert!(RedundantCasters::new(&view, &sphere(1.74), 0.0).is_redundant(&cube(9.0)));
    assert!(!RedundantCasters::new(&view, &sphere(1.72), 0.0).is_redundant(&cube(9.0)));
    assert!(!RedundantCasters::new(&view, &sphere(-1.74), 0.0).is_redundant(&cube(9.0)));
    let rest = Aabb { min: DVec3::new(-1.0, -1.0, -1.0), max: DVec3::new(1.0, -0.5, 1.0) };
    let beyond = LightSpaceView::new(&ReceiverHull::from_box(&rest), DMat3::IDENTITY);
    let depth = [CoveredByFinerCascade::Depth { beyond }];
    let upper = Aabb { min: DVec3::new(0.0, -0.4, 0.0), max: DVec3::ONE };
    assert!(RedundantCasters::new(&view, &depth, 0.05).is_redundant(&upper));
    assert!(!RedundantCasters::new(&view, &depth, 0.15).is_redundant(&upper));
}

#[test]
fn empty_casters_are_redundant_and_invalid_ones_are_kept() {
    let view = LightSpaceView::new(&ReceiverHull::from_box(&cube(10.0)), DMat3::IDENTITY);
    let finer = [CoveredByFinerCascade::Box(cube(9.0))];
    let casters = RedundantCasters::new(&view, &finer, 0.1);
    assert!(casters.is_redundant(&Aabb::EMPTY));
    assert!(!casters.is_redundant(&Aabb { min: DVec3::NAN, max: DVec3::NAN }));
    assert!(!casters.is_redundant(&Aabb { min: DVec3::NEG_INFINITY, max: DVec3::INFINITY }));
    let invalid = [CoveredByFinerCascade::Box(Aabb { min: DVec3::NAN, max: DVec3::splat(20.0) })];
    assert!(!RedundantCasters::new(&view, &invalid, 0.1).is_redundant(&cube(1.0)));
    let all = [CoveredByFinerCascade::Box(cube(f64::INFINITY))];
    assert!(RedundantCasters::new(&view, &all, 0.1).is_redundant(&cube(1.0)));
    let everywhere = LightSpaceView::new(&ReceiverHull::new([DVec3::NAN; 8]), DMat3::IDENTITY);
    assert!(!RedundantCasters::new(&everywhere, &finer, 0.1).is_redundant(&cube(1.0)));
}

#[test]
fn without_finer_cascades_casters_that_darken_nothing_visible_are_redundant() {
    let view = LightSpaceView::new(&ReceiverHull::from_box(&cube(1.0)), DMat3::IDENTITY);
    let casters = RedundantCasters::new(&view, &[], 0.5);
    let moved = |by: DVec3| Aabb { min: by - 0.1, max: by + 0.1 };
    assert!(!casters.is_redundant(&moved(DVec3::Z * 1e6)));
    assert!(casters.is_redundant(&moved(DVec3::Z * -1.7)) && !casters.is_redundant(&moved(DVec3::Z * -1.5)));
    assert!(casters.is_redundant(&moved(DVec3::X * 1.7)) && !casters.is_redundant(&moved(DVec3::X * 1.5)));
}
