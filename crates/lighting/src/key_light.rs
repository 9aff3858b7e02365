//! The illuminance of a scene by its lights.

use glam::DVec3;
use shadowgraph_scene::{Aabb, Light, LightKind};

/// The illuminance of a scene by its light sources, lux.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct KeyLight {
    /// The sum of the directional lights.
    pub directional_lx: f32,
    /// The sum of the spot and point lights, at the median of the objects that they light.
    pub local_lx: f32,
}

/// The minimum illuminance for which exposure is computed, lux.
pub(crate) const MIN_LX: f32 = 1e-6;
/// The fraction of the light of spot and point lights that becomes ambient light.
const LOCAL_AMBIENT_FRACTION: f32 = 0.2;
/// The maximum number of objects that are sampled.
const MAX_OBJECTS: usize = 4_096;
/// The maximum number of pairs of a sampled object and a spot or point light.
const MAX_PAIRS: usize = 131_072;

impl KeyLight {
    /// Estimates the key light of objects with these bounds, ignoring shadows.
    pub fn estimate(lights: &[Light], objects: &[Aabb]) -> Self {
        KeyLightEstimate::default().update(lights, objects)
    }

    /// Returns the illuminance by ambient light that the lights cause, lux: spot and point lights contribute little to it.
    pub fn ambient_lx(&self) -> f32 {
        (self.directional_lx + LOCAL_AMBIENT_FRACTION * self.local_lx).max(MIN_LX)
    }
}

/// An estimate of the [`KeyLight`] of a scene that changes from frame to frame: only what changed is estimated again.
#[derive(Clone, Debug, Default)]
pub struct KeyLightEstimate {
    /// All lights of the last update.
    lights: Vec<Light>,
    directional_lx: f32,
    local: Vec<LocalLight>,
    /// The bounds of the sampled objects, and their illuminance.
    samples: Vec<(Aabb, f64)>,
    local_lx: f32,
}

impl KeyLightEstimate {
    /// Estimates the key light of objects with these bounds, ignoring shadows.
    pub fn update(&mut self, lights: &[Light], objects: &[Aabb]) -> KeyLight {
        let has_lights_changed = self.lights != lights;
        if has_lights_changed {
            self.set_lights(lights);
        }
        if self.follow(objects) || has_lights_changed {
            self.local_lx = self.median() as f32;
        }
        KeyLight { directional_lx: self.directional_lx, local_lx: self.local_lx }
    }

    fn set_lights(&mut self, lights: &[Light]) {
        let usable = || lights.iter().filter(|light| light.is_usable());
        let suns = usable().filter(|light| matches!(light.kind, LightKind::Directional { .. }));
        self.directional_lx = suns.map(strength).sum::<f64>() as f32;
        self.local = usable().filter_map(LocalLight::new).collect();
        self.samples.clear();
        self.lights = lights.to_vec();
    }

    /// Estimates the illuminance of sampled objects that changed, and returns whether any did.
    fn follow(&mut self, objects: &[Aabb]) -> bool {
        let objects = if self.local.is_empty() { &[] } else { objects };
        let count = MAX_OBJECTS.min(MAX_PAIRS / self.local.len().max(1)).max(1);
        let sampled = objects.iter().step_by(objects.len().div_ceil(count).max(1));
        let mut is_changed = sampled.len() != self.samples.len();
        self.samples.resize(sampled.len(), (Aabb::EMPTY, 0.0));
        for (known, object) in self.samples.iter_mut().zip(sampled) {
            if known.0 != *object {
                let illuminance = self.local.iter().map(|light| light.illuminance(object)).sum();
                *known = (*object, if object.is_empty() { 0.0 } else { illuminance });
                is_changed = true;
            }
        }
        is_changed
    }

    /// Returns the median illuminance of the sampled objects that are lit.
    fn median(&self) -> f64 {
        let mut lit: Vec<f64> = self.samples.iter().map(|sample| sample.1).filter(|lx| *lx > 0.0).collect();
        let middle = lit.len() / 2;
        if lit.is_empty() { 0.0 } else { *lit.select_nth_unstable_by(middle, f64::total_cmp).1 }
    }
}

/// Returns the intensity of the strongest colour channel, candela or lux.
fn strength(light: &Light) -> f64 {
    f64::from(light.intensity) * f64::from(light.color.max_element())
}

/// What a spot or point light needs to light objects.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LocalLight {
    position_world: DVec3,
    /// The direction of a spot light, and the cosine of its outer angle.
    cone: Option<(DVec3, f64)>,
    range: Option<f64>,
    candela: f64,
}

impl LocalLight {
    fn new(light: &Light) -> Option<Self> {
        let (position_world, cone) = match light.kind {
            LightKind::Directional { .. } => return None,
            LightKind::Point { position_world, .. } => (position_world, None),
            LightKind::Spot { position_world, direction, outer_angle, .. } => {
                (position_world, Some((direction, outer_angle.cos())))
            }
        };
        Some(Self { position_world, cone, range: light.effective_range(), candela: strength(light) })
    }

    /// Returns the illuminance of an object, lux.
    fn illuminance(&self, object: &Aabb) -> f64 {
        let to_object = object.center() - self.position_world;
        // Large objects are not lit at their centre.
        let distance = to_object.length().max(object.radius()).max(0.05);
        let in_range = self.range.is_none_or(|range| distance < range);
        let in_cone = self.cone.is_none_or(|(direction, cos_outer)| {
            let inside = object.contains_point(self.position_world) || to_object.length() < object.radius();
            inside || to_object.normalize_or_zero().dot(direction) > cos_outer
        });
        if in_range && in_cone { self.candela / (distance * distance) } else { 0.0 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    fn light(kind: LightKind, intensity: f32) -> Light {
        Light { name: None, kind, color: Vec3::ONE, intensity, casts_shadow: true }
    }

    #[test]
    fn directional_lights_add_up_and_point_lights_count_at_the_median_object() {
        let sun = light(LightKind::Directional { direction: DVec3::NEG_Y }, 5_000.0);
        let point =
            |intensity| light(LightKind::Point { position_world: DVec3::ZERO, range: None }, intensity);
        let object = |x: f64| Aabb { min: DVec3::new(x, -0.1, -0.1), max: DVec3::new(x + 0.2, 0.1, 0.1) };
        let key = KeyLight::estimate(
            &[sun.clone(), sun, point(40.0)],
            &[object(0.0), object(1.9), object(9.9), object(9.9), object(900.0)],
        );
        assert_eq!(key.directional_lx, 10_000.0);
        assert!((key.local_lx - 10.0).abs() < 0.1, "{key:?}");
    }

    #[test]
    fn a_point_light_inside_an_object_lights_it_from_at_least_its_radius() {
        let point = light(LightKind::Point { position_world: DVec3::ZERO, range: None }, 100.0);
        let object = Aabb { min: DVec3::splat(-5.0), max: DVec3::splat(5.0) };
        assert!(KeyLight::estimate(&[point], &[object]).local_lx < 2.0);
    }

    #[test]
    fn an_estimate_that_follows_edits_equals_a_new_one() {
        let point =
            |x: f64| light(LightKind::Point { position_world: DVec3::X * x, range: Some(30.0) }, 100.0);
        let object = |x: f64| Aabb { min: DVec3::splat(x), max: DVec3::splat(x + 1.0) };
        let mut lights: Vec<Light> = (0..70).map(|number| point(f64::from(number))).collect();
        let mut objects: Vec<Aabb> = (0..9_000).map(|number| object(f64::from(number % 90))).collect();
        let mut estimate = KeyLightEstimate::default();
        let mut all = Vec::new();
        for edit in 0..6 {
            match edit {
                1 => objects[0] = object(0.5),
                2 => objects.truncate(300),
                3 => lights[3] = point(500.0),
                4 => lights.truncate(1),
                5 => objects.clear(),
                _ => {}
            }
            let key = estimate.update(&lights, &objects);
            assert_eq!(key, KeyLight::estimate(&lights, &objects), "edit {edit}");
            all.push(key.local_lx);
        }
        all.dedup();
        assert_eq!(all.len(), 4, "{all:?}");
    }
}
