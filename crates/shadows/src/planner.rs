//! Construction of a [`ShadowPlan`]: pure, no device.

mod atlas;
mod cascades;
mod culling;

use glam::DVec3;
use shadowgraph_scene::{Aabb, Camera, CullVolume, Plane};

use culling::VisibleReceivers;

use crate::atlas::TileRect;
use crate::cascades::{Slice, late_begins, slice_sphere};
use crate::error::Error;
use crate::light_params::LightShadowParams;
use crate::plan::{PlanState, ShadowInputs, ShadowPlan};
use crate::receivers::ReceiverRange;
use crate::requirements::Requirements;
use crate::select::{Candidate, ShadowRange, Shape, candidate};
use crate::select::{Unshadowed, UnshadowedReason};
use crate::settings::{CascadeSelection, LightShadows};
use crate::views::{ShadowLight, TilePlacement};

/// Plans the shadows of a frame.
///
/// ```
/// use glam::{DVec3, Vec3};
/// use shadowgraph_scene::{Aabb, Camera, CullVolume, Light, LightKind, Projection, origin_near};
/// use shadowgraph_shadows::{CasterView, ShadowCasters, ShadowInputs, ShadowSettings, plan_shadows};
///
/// struct OneBox(Aabb);
/// impl ShadowCasters for OneBox {
///     fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
///         casters.extend(volume.intersects(&self.0).then_some(0));
///     }
///     fn bounds(&self) -> Aabb {
///         self.0
///     }
///     fn draw(&self, _: &mut wgpu::RenderPass<'_>, _: &CasterView, _: &[u32]) -> u32 { 0 }
/// }
///
/// let projection = Projection::Perspective { fov_y: 1.0, near: 0.1, far: None };
/// let camera = Camera::look_at(DVec3::new(0.0, 2.0, 5.0), DVec3::ZERO, DVec3::Y, projection);
/// let sun = Light {
///     name: None,
///     kind: LightKind::Directional { direction: DVec3::new(0.5, -1.0, 0.2) },
///     color: Vec3::ONE,
///     intensity: 100_000.0,
///     casts_shadow: true,
/// };
/// let plan = plan_shadows(&ShadowInputs {
///     view: 0,
///     camera: &camera,
///     aspect: 16.0 / 9.0,
///     lights: &[sun],
///     casters: &OneBox(Aabb { min: DVec3::splat(-100.0), max: DVec3::new(100.0, 0.0, 100.0) }),
///     origin_world: origin_near(camera.position_world()),
///     settings: &ShadowSettings::default(),
/// })?;
/// assert_eq!(plan.cascades.map(|map| map.size_px), Some([4096, 4096]));
/// assert_eq!(plan.lights[0].view_count, 4);
/// assert!(plan.atlas.is_none());
/// # Ok::<(), shadowgraph_shadows::Error>(())
/// ```
///
/// # Errors
///
/// [`Error::Setting`] for a setting out of range, [`Error::Camera`] for an invalid
/// view. Lights that cannot have shadows are not an error: see [`ShadowPlan::unshadowed`].
pub fn plan_shadows(inputs: &ShadowInputs<'_>) -> Result<ShadowPlan, Error> {
    plan_shadows_after(inputs, None, &Requirements::NONE)
}

/// Plans the shadows of a frame that follows another one of the same view, of which `previous` is the [`ShadowPlan::state`]: lights keep
/// the size and the position of their tiles where possible, and cascades their ends. `requirements` are the technique's, beyond those of the settings' filters.
///
/// # Errors
///
/// The errors of [`plan_shadows`].
pub fn plan_shadows_after(
    inputs: &ShadowInputs<'_>,
    previous: Option<&PlanState>,
    requirements: &Requirements,
) -> Result<ShadowPlan, Error> {
    Ok(Planner::new(inputs, previous, requirements)?.plan())
}

/// The lights that can have shadows in a frame.
pub(crate) struct ShadowedLights<'a> {
    /// The lights, the most important first.
    pub(crate) candidates: Vec<Candidate<'a>>,
    /// The lights that cannot.
    pub(crate) unshadowed: Vec<Unshadowed>,
    /// The range of the view in which there are shadows.
    pub(crate) range: ShadowRange<'a>,
}

/// Returns the lights that can have shadows in a frame, for techniques that plan no tiles.
///
/// # Errors
///
/// The errors of [`plan_shadows`].
pub(crate) fn shadowed_lights<'a>(inputs: &ShadowInputs<'a>) -> Result<ShadowedLights<'a>, Error> {
    let mut planner = Planner::new(inputs, None, &Requirements::NONE)?;
    let mut candidates = planner.candidates();
    candidates.sort_by(Candidate::order);
    let (unshadowed, range) = (planner.plan.unshadowed, planner.range);
    Ok(ShadowedLights { candidates, unshadowed, range })
}

/// The latest begin of the first cascade, as a fraction of the way to the end of the last.
const LATEST_BEGIN: f64 = 0.9;

/// A plan under construction.
struct Planner<'a> {
    inputs: ShadowInputs<'a>,
    range: ShadowRange<'a>,
    visible: VisibleReceivers,
    /// The individual settings of each light of the scene.
    own: Vec<Option<&'a LightShadows>>,
    /// The previous frame's state.
    previous: Option<&'a PlanState>,
    /// The technique's requirements.
    requirements: Requirements,
    plan: ShadowPlan,
}

impl<'a> Planner<'a> {
    /// Validates the inputs.
    fn new(
        inputs: &ShadowInputs<'a>,
        previous: Option<&'a PlanState>,
        requirements: &Requirements,
    ) -> Result<Self, Error> {
        let ShadowInputs { camera, aspect, settings, .. } = *inputs;
        settings.validate()?;
        let own = settings.individual_settings(inputs.lights)?;
        camera.check(aspect)?;
        let distance_m = f64::from(settings.distance_m);
        let distance_m = camera.far().map_or(distance_m, |far| far.min(distance_m));
        let near_m = camera.near();
        let receivers = previous.map_or_else(ReceiverRange::default, |previous| previous.receivers);
        let receivers = receivers.next(inputs.casters.receivers(), camera);
        // Never in front of the near plane, however small the scene.
        let fit_m = receivers.end.distance_m.max(near_m * 1.01 + 1e-3).min(distance_m);
        let nearest_m = receivers.begin_m(camera, aspect).min(0.5 * (near_m + fit_m));
        let latest_m = nearest_m + LATEST_BEGIN * (fit_m - nearest_m).max(0.0);
        let begins_m = || late_begins(&settings.cascades, [nearest_m, latest_m], fit_m);
        let selects_by_depth =
            settings.cascades.select == CascadeSelection::Depth && !requirements.fits_on_gpu;
        let mut slice_begin_m = nearest_m;
        let serves_nothing = |&end_m: &f64| {
            let slice = Slice { camera, aspect, near_m: slice_begin_m, far_m: end_m };
            slice_begin_m = end_m;
            // By map and sphere, a cascade also serves what its sphere has beyond the slice.
            let reach_m = if selects_by_depth { end_m } else { sphere_end_m(&slice) };
            !inputs.casters.has_receiver_in(&view_volume(camera, aspect, reach_m))
        };
        // Ends that the user chose stay.
        let is_free = settings.cascades.split.is_relative_to_near() && near_m < fit_m;
        let skippable = if is_free { begins_m().take_while(serves_nothing).count() } else { 0 };
        let receivers = receivers.skipping(skippable, camera);
        let skipped = receivers.skipped.map_or(0, |skipped| skipped.count);
        let visible_m = begins_m().take(skipped).last().unwrap_or(nearest_m);
        let range = ShadowRange {
            camera,
            aspect,
            near_m,
            distance_m,
            measure: settings.measure,
            nearest_m,
            visible_m,
            begin_m: visible_m.max(f64::from(settings.cascades.begin_m)).min(latest_m),
            fit_m,
            receivers: receivers.sphere(),
        };
        let mut plan = ShadowPlan::all_lit(inputs.lights.len(), settings);
        plan.state.receivers = receivers;
        let visible = VisibleReceivers::new(inputs, &range);
        Ok(Self { inputs: *inputs, range, visible, own, previous, requirements: *requirements, plan })
    }

    /// Builds the plan.
    fn plan(mut self) -> ShadowPlan {
        let mut candidates = self.candidates();
        candidates.sort_by(Candidate::order);
        let (count, lights) = (self.inputs.settings.cascades.count, self.inputs.settings.cascades.lights);
        let is_directional = |c: &&Candidate<'_>| matches!(c.shape, Shape::Directional { .. });
        let directional = candidates.iter().take_while(is_directional).count();
        let with_cascades = if count == 0 { 0 } else { directional.min(lights as usize) };
        let others = candidates.split_off(with_cascades);
        self.add_cascades(candidates);
        self.add_atlas(others);
        self.plan.unshadowed.sort_by_key(|unshadowed| unshadowed.light);
        self.plan
    }

    fn reject(&mut self, light: u32, reason: UnshadowedReason) {
        self.plan.unshadowed.push(Unshadowed { light, reason });
    }

    fn candidates(&mut self) -> Vec<Candidate<'a>> {
        let no_caster = self.inputs.casters.bounds().is_empty();
        let mut candidates = Vec::new();
        for (light, source) in (0u32..).zip(self.inputs.lights) {
            let own = self.own[light as usize];
            if !source.casts_shadow || own.is_some_and(|own| !own.casts || own.strength == 0.0) {
                continue;
            }
            match candidate(light, source, own, &self.range) {
                Ok(_) if no_caster => self.reject(light, UnshadowedReason::NoCasterInRange),
                Ok(_) if self.range.is_empty() => self.reject(light, UnshadowedReason::OutOfView),
                Ok(found) => candidates.push(found),
                Err(reason) => self.reject(light, reason),
            }
        }
        candidates
    }

    fn light_params(&self, candidate: &Candidate<'_>, has_cascades: bool) -> LightShadowParams {
        let settings = self.inputs.settings;
        let map_filter = if has_cascades { settings.cascades.filter } else { settings.atlas.filter };
        LightShadowParams::new(settings, candidate.own, map_filter).with_requirements(&self.requirements)
    }

    fn cull(&self, volume: &CullVolume) -> Vec<u32> {
        let mut casters = Vec::new();
        self.inputs.casters.cull(volume, &mut casters);
        casters
    }

    /// Splits casters into opaque and tinting ones.
    fn opaque_and_tints(&self, casters: Vec<u32>) -> (Vec<u32>, Vec<u32>) {
        let tints = |caster: &u32| self.inputs.casters.tints(*caster);
        if !casters.iter().any(tints) {
            return (casters, Vec::new());
        }
        casters.into_iter().partition(|caster| !tints(caster))
    }

    /// Assigns a light its views, and returns its struct for further changes.
    fn set_light(
        &mut self,
        light: u32,
        params: &LightShadowParams,
        (map, first_view, view_count): (u32, u32, u32),
    ) -> &mut ShadowLight {
        let gpu_light = &mut self.plan.lights[light as usize];
        let with_params = ShadowLight::with_params(params, self.range.distance_m);
        let eye = self.range.camera.position_world() - self.inputs.origin_world;
        let eye = if with_params.fades_by_radius == 1 { eye.as_vec3().to_array() } else { [0.0; 3] };
        *gpu_light = ShadowLight { map, first_view, view_count, eye, ..with_params };
        gpu_light
    }
}

/// Returns the view depth at which the sphere of a slice ends, metres.
fn sphere_end_m(slice: &Slice<'_>) -> f64 {
    let sphere = slice_sphere(slice);
    let from_eye = sphere.center_world - slice.camera.position_world();
    from_eye.dot(slice.camera.forward_world()) + sphere.radius_m
}

/// Returns the part of the view up to a view depth. Boxes that intersect it intersect its bounds.
fn view_volume(camera: &Camera, aspect: f64, far_m: f64) -> CullVolume {
    let mut planes = camera.frustum(aspect);
    let corners = camera.slice_corners_view(aspect, camera.near(), far_m);
    let corners = corners.map(|corner| camera.world_from_view.transform_point3(corner));
    let forward = camera.forward_world();
    let end = camera.position_world() + forward * far_m;
    planes.planes.push(Plane::through(end, -forward));
    let bounds = Aabb::from_points(corners);
    for axis in DVec3::AXES {
        planes.planes.push(Plane::through(bounds.min, axis));
        planes.planes.push(Plane::through(bounds.max, -axis));
    }
    planes.into()
}

/// Returns the placement of a tile.
fn placement(
    rect: TileRect,
    map_size_px: [u32; 2],
    params: &LightShadowParams,
    depth_step: f32,
) -> TilePlacement {
    TilePlacement { rect, map_size_px, border_px: params.border_px(), depth_step }
}
