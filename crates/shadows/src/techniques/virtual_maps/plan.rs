//! What the CPU knows of a frame's virtual shadow maps: projections, lights, and the pages that are always needed.

use glam::{DMat3, DVec2, DVec3};
use shadowgraph_scene::Aabb;

use super::projections::{
    DIRECTIONAL_LEVELS, DirectionalLevel, GpuLevel, GpuProjection, LOCAL_LEVELS, LOCAL_TEXELS, PAGE_PX,
    Projection, Viewpoint, coarsest_texel_m, local_levels, map_position,
};
use super::settings::VirtualSettings;
use super::slots::{Group, Slots};
use super::variant::USUAL_TAPS;
use crate::error::Error;
use crate::light_params::LightShadowParams;
use crate::plan::ShadowInputs;
use crate::planner::{ShadowedLights, shadowed_lights};
use crate::select::{Candidate, ShadowRange, Shape, Unshadowed, UnshadowedReason, point_face};
use crate::spot::SpotFit;
use crate::techniques::PcssSettings;
use crate::views::{MAP_ATLAS, ShadowLight};

/// The most pages that are always needed: `MAX_COARSE` of `pages_state.wgsl`.
pub(super) const MAX_COARSE: usize = 512;
/// The part of the pool that these pages of all directional lights take.
const COARSE_PART: u32 = 16;
/// Their least number for a directional light: four pages contain any view.
const MIN_COARSE: u32 = 4;
/// The bias along the normal, relative to that of the settings. It moves the shadows of thin casters, which are hardly wider than a pixel, by
/// up to some texels where the light comes in at a low angle.
const NORMAL_BIAS_PART: f32 = 0.25;
/// The radius of the search for blockers: `SEARCH_TEXELS` of `page_penumbra.wgsl`.
const SEARCH_TEXELS: f32 = 3.0;
/// Texels between the cone of a spot light, or the edge of a face, and the edge of the map.
const LOCAL_MARGIN_TEXELS: f64 = 8.0;

/// The sizes of lights.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Radii {
    /// The tangent of the angular radius of directional lights.
    sun_tangent: f32,
    /// The radius of other lights.
    light_m: f32,
    /// The largest radius of penumbrae that are filtered as wide as they are, if they are.
    penumbra_m: Option<f32>,
}

impl Radii {
    fn new(own: &VirtualSettings, lights: &PcssSettings) -> Self {
        Self {
            sun_tangent: lights.sun_radius_rad.tan(),
            light_m: lights.light_radius_m,
            penumbra_m: own.penumbrae.then_some(own.max_penumbra_m),
        }
    }
}

/// A frame's virtual shadow maps.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct VirtualPlan {
    pub(super) projections: Vec<GpuProjection>,
    pub(super) levels: Vec<GpuLevel>,
    /// One for each light of the scene.
    pub(super) lights: Vec<ShadowLight>,
    /// Projection, level and place of each page that is always needed.
    pub(super) coarse: Vec<[i32; 4]>,
    pub(super) unshadowed: Vec<Unshadowed>,
    pub(super) slots: Slots,
    /// The most important light.
    pub(super) main_light: u32,
}

impl VirtualPlan {
    /// Plans a frame after that with these slots. The pool has `page_count` pages, the image is `height_px` high.
    ///
    /// # Errors
    /// For settings or a camera that are out of range.
    pub(super) fn new(
        inputs: &ShadowInputs<'_>,
        own: &VirtualSettings,
        previous: &Slots,
        page_count: u32,
        height_px: u32,
    ) -> Result<Self, Error> {
        let ShadowedLights { mut candidates, mut unshadowed, range } = shadowed_lights(inputs)?;
        let view = ViewBounds::new(inputs, &range);
        let is_directional =
            |candidate: &&Candidate<'_>| matches!(candidate.shape, Shape::Directional { .. });
        let suns = candidates.iter().filter(is_directional).count().max(1) as u32;
        let budget = (page_count / COARSE_PART / suns).max(MIN_COARSE);
        let coarsest_m = coarsest_texel_m(range.distance_m, view.diameter_m(), budget);
        let viewpoint =
            Viewpoint::new(inputs.camera, height_px, own.level_bias, coarsest_m, inputs.origin_world);

        let mut coarse = Vec::new();
        let mut groups = Vec::new();
        candidates.retain(|candidate| {
            let projections = projections(inputs, own, candidate);
            let pages = coarse_pages(&projections, &viewpoint, &view, budget);
            let fits = coarse.len() + pages.len() <= MAX_COARSE.min(page_count as usize / 2);
            if fits {
                let keeps = match candidate.shape {
                    Shape::Directional { .. } => inputs.settings.cascades.cache,
                    Shape::Spot { .. } | Shape::Point { .. } => inputs.settings.atlas.cache,
                };
                coarse.extend(pages.into_iter().map(|page| (groups.len(), page)));
                groups.push(Group { projections, keeps });
            } else {
                let reason = UnshadowedReason::PoolFull;
                unshadowed.push(Unshadowed { light: candidate.light, reason });
            }
            fits
        });
        unshadowed.sort_by_key(|unshadowed| unshadowed.light);
        let (slots, firsts) = previous.next(&groups);
        let mut lights = vec![ShadowLight::default(); inputs.lights.len()];
        for ((candidate, group), first) in candidates.iter().zip(&groups).zip(&firsts) {
            lights[candidate.light as usize] =
                light(inputs, own, candidate, &range, *first, group.projections.len());
        }
        let coarse = coarse.into_iter().map(|(group, Coarse { face, level, page: [x, y] })| {
            [(firsts[group] + face) as i32, level as i32, x, y]
        });
        let radii = Radii::new(own, &inputs.settings.techniques.get()?);
        let (mut projections, levels) = gpu_projections(&slots, &viewpoint);
        projections.iter_mut().for_each(|projection| set_radii(projection, &radii));
        if radii.penumbra_m.is_some() {
            lights.iter_mut().for_each(|light| light.filter_taps = USUAL_TAPS);
        }
        let coarse = coarse.collect();
        let main_light = candidates.first().map_or(0, |candidate| candidate.light);
        Ok(Self { projections, levels, lights, coarse, unshadowed, slots, main_light })
    }

    /// Returns whether no light has shadows.
    pub(super) fn is_empty(&self) -> bool {
        self.lights.iter().all(|light| light.view_count == 0)
    }
}

/// The bounds of the visible receivers, and their corners.
struct ViewBounds {
    bounds: Aabb,
    corners: [DVec3; 8],
    receivers: [DVec3; 8],
}

impl ViewBounds {
    fn new(inputs: &ShadowInputs<'_>, range: &ShadowRange<'_>) -> Self {
        let corners = range.corners(range.near_m, range.distance_m);
        let receivers = inputs.casters.receivers();
        Self { bounds: Aabb::from_points(corners), corners, receivers: receivers.corners() }
    }

    /// Returns a length that all distances between visible receivers are within, metres; it stays the same where the camera moves.
    fn diameter_m(&self) -> f64 {
        let diameter = |corners: &[DVec3; 8]| {
            let pairs = corners.iter().flat_map(|from| corners.iter().map(|to| from.distance(*to)));
            pairs.fold(0.0, f64::max)
        };
        diameter(&self.corners).min(diameter(&self.receivers))
    }

    /// Returns the rectangle of the visible receivers on the axes of a directional light's maps.
    fn on_map(&self, light_from_world: &DMat3) -> [DVec2; 2] {
        let rect = |corners: &[DVec3; 8]| {
            let points = corners.map(|corner| map_position(light_from_world, corner));
            let all = points.into_iter();
            [all.clone().fold(DVec2::MAX, DVec2::min), all.fold(DVec2::MIN, DVec2::max)]
        };
        let [view, receivers] = [rect(&self.corners), rect(&self.receivers)];
        let first = view[0].max(receivers[0]).min(view[1]);
        [first, view[1].min(receivers[1]).max(first)]
    }
}

/// Returns the projections of a light.
fn projections(
    inputs: &ShadowInputs<'_>,
    own: &VirtualSettings,
    candidate: &Candidate<'_>,
) -> Vec<Projection> {
    let params = LightShadowParams::new(inputs.settings, candidate.own, own.filter);
    let slope_bias_milli = params.slope_bias_milli(1.0);
    let near_m = params.near_m.unwrap_or(f64::from(inputs.settings.atlas.spot_near_m));
    let local = |cone, rotation| {
        let fit = SpotFit::new(cone, rotation, near_m, LOCAL_TEXELS, LOCAL_MARGIN_TEXELS);
        Projection::Local { fit, slope_bias_milli }
    };
    match candidate.shape {
        Shape::Directional { light_from_world } => {
            vec![Projection::Directional { light_from_world, slope_bias_milli }]
        }
        Shape::Spot { cone, light_from_world } => vec![local(cone, light_from_world)],
        Shape::Point { position_world, range_m } => {
            let face = |face| point_face(position_world, range_m, face);
            (0..6).map(face).map(|(cone, rotation)| local(cone, rotation)).collect()
        }
    }
}

/// A page of the projections of a light.
struct Coarse {
    face: u32,
    level: u32,
    page: [i32; 2],
}

/// Returns the pages that cover all that a light has in the view: at most `budget` for a directional light, and the coarsest page of each
/// face of others.
fn coarse_pages(
    projections: &[Projection],
    viewpoint: &Viewpoint,
    view: &ViewBounds,
    budget: u32,
) -> Vec<Coarse> {
    let mut pages = Vec::new();
    for (face, projection) in (0..).zip(projections) {
        match projection {
            Projection::Directional { light_from_world, .. } => {
                let [first_m, last_m] = view.on_map(light_from_world);
                let span = |level| {
                    let level = DirectionalLevel::new(light_from_world, viewpoint, level);
                    [level.page(first_m), level.page(last_m)]
                };
                let count = |[first, last]: [[i32; 2]; 2]| {
                    let sides = [0, 1].map(|axis| f64::from(last[axis]) - f64::from(first[axis]) + 1.0);
                    sides[0] * sides[1]
                };
                let fits = |level: &u32| count(span(*level)) <= f64::from(budget);
                let level = (0..DIRECTIONAL_LEVELS).find(fits).unwrap_or(DIRECTIONAL_LEVELS - 1);
                let [first, last] = span(level);
                let rows = first[1]..=last[1];
                pages.extend(
                    rows.flat_map(|y| {
                        (first[0]..=last[0]).map(move |x| Coarse { face, level, page: [x, y] })
                    }),
                );
            }
            Projection::Local { fit, .. } => {
                if fit.cull_volume().intersects(&view.bounds) {
                    pages.push(Coarse { face, level: LOCAL_LEVELS - 1, page: [0, 0] });
                }
            }
        }
    }
    pages
}

fn light(
    inputs: &ShadowInputs<'_>,
    own: &VirtualSettings,
    candidate: &Candidate<'_>,
    range: &ShadowRange<'_>,
    first: u32,
    count: usize,
) -> ShadowLight {
    let params = LightShadowParams::new(inputs.settings, candidate.own, own.filter);
    let light = ShadowLight::with_params(&params, range.distance_m);
    let eye = (range.camera.position_world() - inputs.origin_world).as_vec3().to_array();
    let texel_uv = [1.0 / PAGE_PX as f32; 2];
    ShadowLight {
        map: MAP_ATLAS,
        first_view: first,
        view_count: count as u32,
        normal_bias_texels: NORMAL_BIAS_PART * light.normal_bias_texels,
        eye,
        texel_uv,
        ..light
    }
}

/// Gives a projection what penumbrae depend on.
fn set_radii(projection: &mut GpuProjection, radii: &Radii) {
    let is_directional = projection.is_perspective == 0;
    projection.light_radius = if is_directional { radii.sun_tangent } else { radii.light_m };
    let Some(penumbra_m) = radii.penumbra_m else { return };
    projection.max_radius_m = penumbra_m;
    let last = projection.level_count.saturating_sub(1);
    projection.soft_level = if is_directional {
        let levels = (penumbra_m / (SEARCH_TEXELS * projection.texel_m)).log2().ceil();
        // The coarser one of two levels that are blended.
        (levels.clamp(0.0, 30.0) as u32 + 1).min(last)
    } else {
        last
    };
}

/// Returns the projections and levels that shaders read.
fn gpu_projections(slots: &Slots, viewpoint: &Viewpoint) -> (Vec<GpuProjection>, Vec<GpuLevel>) {
    let mut levels: Vec<GpuLevel> = local_levels().collect();
    let projections = slots.placed().map(|placed| {
        let Some(placed) = placed else { return bytemuck::Zeroable::zeroed() };
        let projection = placed.projection;
        let mut gpu = projection.gpu(viewpoint);
        if let Projection::Directional { light_from_world, .. } = &projection {
            gpu.first_level = levels.len() as u32;
            let all = 0..projection.level_count();
            levels.extend(all.map(|level| {
                DirectionalLevel::new(light_from_world, viewpoint, level).gpu(light_from_world, viewpoint)
            }));
        }
        GpuProjection { first_entry: placed.first_entry, version: placed.version, ..gpu }
    });
    (projections.collect(), levels)
}
