//! A scene's instances as shadow casters.

use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use shadowgraph_core::{Buffer, Error as GraphError, Frame, RenderContext};
use shadowgraph_lighting::{CullPass, CullView, LayerCullPass, LayerQuery, draw_culled, draw_layers};
use shadowgraph_scene::gpu::{CasterPipelines, CullFlags, DepthTarget, Draw, GpuScene, LayerPipelines};
use shadowgraph_scene::{Aabb, CasterMode, CullVolume};
use shadowgraph_shadows::rays::GpuRayScene;
use shadowgraph_shadows::{
    CasterPass, CasterQuery, CasterTarget, CasterView, CulledInstances, CulledTokens, DepthFormat,
    GpuCasters, LayerTokens, LayeredCasters, LayeredInstances, Mobility, ShadowCasters, TINT_FORMAT,
    TintTokens,
};

use crate::culling::{CullChoice, Culling};
use crate::error::Error;
use crate::scene_rays::UploadedRays;

/// Number of biases whose pipelines are kept: those of the lights that have their own, and more while a bias is adjusted.
const MAX_BIASED: usize = 16;

/// The instances of a scene on the GPU as casters, by the same numbers. Their flags and materials decide how they cast shadows.
pub struct SceneCasters {
    /// The scene.
    pub scene: GpuScene,
    device: wgpu::Device,
    target: DepthTarget,
    /// Pipelines by map format.
    pipelines: Vec<(wgpu::TextureFormat, CasterPipelines)>,
    /// Pipelines with a slope-scaled bias, by format and bias; the last created ones.
    biased: Mutex<Vec<BiasedPipelines>>,
    /// Culls casters on the GPU.
    cull: CullPass,
    /// Culls casters for views that the GPU writes.
    layer_cull: LayerCullPass,
    /// Draws casters into layers; created on first use.
    layers: OnceLock<Option<LayerPipelines>>,
    /// What culls the instances of this frame.
    pub(crate) culling: CullChoice,
    /// The triangles, if the technique traces rays.
    pub(crate) rays: Option<UploadedRays>,
    /// The bounds of the shadows on the ground; empty without one.
    pub(crate) ground_shadows: Aabb,
}

/// Pipelines with a slope-scaled bias, and the format and the bias.
type BiasedPipelines = ((wgpu::TextureFormat, u32), Arc<CasterPipelines>);

impl SceneCasters {
    /// Creates the pipelines that draw the casters.
    ///
    /// # Errors
    /// For a shader that does not compose.
    pub fn new(device: &wgpu::Device, scene: GpuScene) -> Result<Self, Error> {
        let target = DepthTarget { clamp_near: true, ..DepthTarget::default() };
        Self::with_target(device, scene, &target)
    }

    /// Creates pipelines with another depth target than the default; the formats of `target` are ignored.
    ///
    /// # Errors
    /// For a shader that does not compose.
    pub fn with_target(device: &wgpu::Device, scene: GpuScene, target: &DepthTarget) -> Result<Self, Error> {
        let target = DepthTarget { tint_format: TINT_FORMAT, ..*target };
        let pipelines = |depth: DepthFormat| {
            let format = depth.texture_format();
            let target = DepthTarget { format, ..target };
            Ok((format, CasterPipelines::new(device, scene.layouts(), &target)?))
        };
        let pipelines = DepthFormat::ALL.into_iter().map(pipelines).collect::<Result<_, Error>>()?;
        let (rays, ground_shadows) = (None, Aabb::EMPTY);
        let (cull, culling) = (CullPass::new(device)?, Culling::Cpu.choose(&scene));
        Ok(Self {
            scene,
            device: device.clone(),
            target,
            pipelines,
            biased: Mutex::default(),
            cull,
            layer_cull: LayerCullPass::new(device)?,
            layers: OnceLock::new(),
            culling,
            rays,
            ground_shadows,
        })
    }

    /// Returns the pipelines with the bias of a target, which are created as they are first used; `None` if that fails.
    fn biased(&self, target: &CasterTarget) -> Option<Arc<CasterPipelines>> {
        let key = (target.format, target.slope_bias_milli);
        let mut biased = self.biased.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, pipelines)) = biased.iter().find(|(known, _)| *known == key) {
            return Some(pipelines.clone());
        }
        let slope_bias = self.target.slope_bias + target.slope_scale();
        let target = DepthTarget { format: target.format, slope_bias, ..self.target };
        let pipelines = Arc::new(CasterPipelines::new(&self.device, self.scene.layouts(), &target).ok()?);
        if biased.len() == MAX_BIASED {
            biased.remove(0);
        }
        biased.push((key, pipelines.clone()));
        Some(pipelines)
    }

    /// Returns a sentence for plans: what culls the instances of this frame, and why.
    pub(crate) fn culling(&self) -> String {
        self.culling.to_string()
    }

    /// Returns whether the GPU culls the instances of this frame.
    pub fn culls_on_gpu(&self) -> bool {
        self.culling.on_gpu
    }

    /// Returns the pass that culls instances on the GPU.
    pub(crate) fn cull_pass(&self) -> &CullPass {
        &self.cull
    }

    /// Adds the pass that culls instances on the GPU.
    pub(crate) fn cull<'f>(&'f self, frame: &mut Frame<'f>, views: &[CullView]) -> CulledInstances {
        self.cull.add_to(frame, &self.scene, views, self.culling)
    }

    /// Returns the pipelines that draw into layers; `None` if a shader does not compose.
    fn layer_pipelines(&self) -> Option<&LayerPipelines> {
        let create = || LayerPipelines::new(&self.device, self.scene.layouts()).ok();
        self.layers.get_or_init(create).as_ref()
    }

    /// Returns the pipelines without a bias; maps have no other formats.
    fn unbiased(&self, target: &CasterTarget) -> Option<&CasterPipelines> {
        self.pipelines.iter().find(|(format, _)| *format == target.format).map(|(_, pipelines)| pipelines)
    }

    /// Returns the number of triangles of some casters.
    pub fn triangle_count(&self, casters: &[u32]) -> u64 {
        let draws = casters.iter().filter_map(|&number| self.scene.draw_for(number));
        draws.map(|draw| u64::from(self.scene.triangle_count(draw))).sum()
    }
}

impl ShadowCasters for SceneCasters {
    fn cull(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        self.scene.cull_casters(volume, casters);
    }

    fn bounds(&self) -> Aabb {
        self.scene.all_caster_bounds()
    }

    fn version(&self, caster: u32) -> Option<u64> {
        self.scene.version(caster)
    }

    fn mobility(&self, caster: u32) -> Mobility {
        if self.scene.is_moving(caster) { Mobility::Moving } else { Mobility::Static }
    }

    fn caster_name(&self, caster: u32) -> Option<&str> {
        self.scene.name(caster)
    }

    fn tints(&self, caster: u32) -> bool {
        self.scene.draw_for(caster).is_some_and(|draw| draw.casts == CasterMode::Tint)
    }

    fn receivers(&self) -> Aabb {
        self.scene.all_bounds().union(&self.ground_shadows)
    }

    fn has_receiver_in(&self, volume: &CullVolume) -> bool {
        self.scene.any_in(volume) || volume.intersects(&self.ground_shadows)
    }

    fn caster_bounds(&self, caster: u32) -> Aabb {
        self.scene.caster_bounds(caster)
    }

    fn rays(&self) -> Option<&GpuRayScene> {
        self.rays.as_ref().map(UploadedRays::gpu)
    }

    fn gpu(&self) -> Option<&dyn GpuCasters> {
        self.culls_on_gpu().then_some(self)
    }

    fn layered(&self) -> Option<&dyn LayeredCasters> {
        Some(self)
    }

    fn draw(&self, pass: &mut wgpu::RenderPass<'_>, view: &CasterView, casters: &[u32]) -> u32 {
        let biased = (view.target.slope_bias_milli > 0).then(|| self.biased(&view.target)).flatten();
        let Some(pipelines) = biased.as_deref().or_else(|| self.unbiased(&view.target)) else { return 0 };
        let draws = casters.iter().filter_map(|&number| self.scene.draw_for(number));
        self.scene.draw(pass, draws, &|draw| match view.target.pass {
            CasterPass::Depth => pipelines.get(draw.casts),
            CasterPass::TintDepth => Some(pipelines.solid()),
            CasterPass::Tint => Some(pipelines.tint()),
        })
    }
}

impl GpuCasters for SceneCasters {
    fn cull<'f>(&'f self, frame: &mut Frame<'f>, queries: &[CasterQuery]) -> CulledInstances {
        let view = |query: &CasterQuery| CullView {
            name: query.name.clone(),
            volume: query.volume.clone(),
            required: CullFlags::OPAQUE_CASTERS.union(CullFlags::CASTER),
            excluded: if query.only_static { CullFlags::MOVING } else { CullFlags::default() },
        };
        Self::cull(self, frame, &queries.iter().map(view).collect::<Vec<_>>())
    }

    fn draw(
        &self,
        ctx: &mut RenderContext<'_>,
        view: &CasterView,
        culled: CulledTokens,
    ) -> Result<u32, GraphError> {
        let biased = (view.target.slope_bias_milli > 0).then(|| self.biased(&view.target)).flatten();
        let Some(pipelines) = biased.as_deref().or_else(|| self.unbiased(&view.target)) else { return Ok(0) };
        let pipeline_for = |draw: &Draw| pipelines.get(draw.casts).filter(|_| draw.casts != CasterMode::Tint);
        draw_culled(ctx, &self.scene, culled, &pipeline_for)
    }

    fn any(&self, volume: &CullVolume) -> bool {
        self.scene.any_caster_in(volume)
    }

    fn tinting(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        self.scene.cull_tinting(volume, casters);
    }

    fn moving(&self, volume: &CullVolume, casters: &mut Vec<u32>) {
        let first = casters.len();
        self.scene.cull_moving_casters(volume, casters);
        let opaque: Vec<u32> = casters.drain(first..).filter(|&caster| !self.tints(caster)).collect();
        casters.extend(opaque);
    }

    fn static_count(&self) -> usize {
        self.scene.static_caster_count()
    }

    fn static_version(&self) -> u64 {
        self.scene.static_version()
    }

    fn has_changed(&self, since: u64, volume: &CullVolume) -> bool {
        self.scene.statics_changed(since, volume)
    }
}

impl LayeredCasters for SceneCasters {
    fn cull_layers<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        views: &mut Buffer,
        capacity: u32,
    ) -> LayeredInstances {
        let query = LayerQuery { capacity, required: CullFlags::CASTER, excluded: CullFlags::default() };
        self.layer_cull.add_to(frame, &self.scene, views, query)
    }

    fn draw_layers(&self, ctx: &mut RenderContext<'_>, tokens: LayerTokens) -> Result<u32, GraphError> {
        let Some(pipelines) = self.layer_pipelines() else { return Ok(0) };
        let pipeline_for = |draw: &Draw| pipelines.get(draw.casts);
        draw_layers(ctx, &self.scene, pipelines.view_layout(), (tokens, None), &pipeline_for)
    }

    fn any_tints(&self) -> bool {
        self.scene.any_tints()
    }

    fn draw_layer_tints(
        &self,
        ctx: &mut RenderContext<'_>,
        tokens: LayerTokens,
        tints: TintTokens,
    ) -> Result<u32, GraphError> {
        let Some(pipelines) = self.layer_pipelines() else { return Ok(0) };
        let pipeline_for = |draw: &Draw| pipelines.get_tint(draw.casts);
        draw_layers(ctx, &self.scene, pipelines.tint_layout(), (tokens, Some(tints)), &pipeline_for)
    }

    fn all_moving(&self, casters: &mut Vec<u32>) {
        self.scene.cull_moving_casters(&CullVolume::default(), casters);
    }

    fn static_version(&self) -> u64 {
        self.scene.static_version()
    }

    fn static_changes(&self, since: u64, bounds: &mut Vec<Aabb>) -> bool {
        self.scene.static_changes(since, bounds)
    }
}

#[cfg(test)]
mod tests {
    #![allow(clippy::unwrap_used, reason = "tests")]
    use super::*;
    use glam::{DAffine3, DVec3};
    use shadowgraph_scene::{AlphaMode, Image, Instance, InstanceKey, Material, Mesh, Scene, TextureRef};

    /// A scene and its casters on a device that does nothing.
    struct Followed {
        gpu: (wgpu::Device, wgpu::Queue),
        scene: Scene,
        casters: SceneCasters,
    }

    impl Followed {
        fn new(mut scene: Scene) -> Self {
            let gpu = wgpu::Device::noop(&wgpu::DeviceDescriptor::default());
            let uploaded = GpuScene::new(&gpu.0, &gpu.1, &scene, DVec3::ZERO).unwrap();
            let _ = scene.take_changes();
            Self { casters: SceneCasters::new(&gpu.0, uploaded).unwrap(), gpu, scene }
        }

        /// Draws a frame, and returns for each instance whether its version changed.
        fn follow(&mut self, keys: &[InstanceKey]) -> Vec<bool> {
            let versions = |casters: &SceneCasters| -> Vec<_> {
                keys.iter().map(|key| casters.version(casters.scene.number(*key).unwrap())).collect()
            };
            let before = versions(&self.casters);
            let changes = self.scene.take_changes();
            self.casters.scene.update(&self.gpu.0, &self.gpu.1, &self.scene, &changes).unwrap();
            before.into_iter().zip(versions(&self.casters)).map(|(before, after)| before != after).collect()
        }

        fn mobility(&self, key: InstanceKey) -> Mobility {
            self.casters.mobility(self.casters.scene.number(key).unwrap())
        }
    }

    #[test]
    fn casters_have_names_versions_of_what_they_draw_and_move_for_a_while_after_they_moved() {
        let mut scene = Scene::default();
        let [cube, ball] =
            [1.0, 2.0].map(|size| scene.insert_mesh(Mesh::cuboid(DVec3::ZERO, DVec3::splat(size))));
        let dot = |value| Image::new("dot", 1, 1, vec![value; 4]);
        let image = scene.insert_image(dot(1)).unwrap();
        let texture = Some(TextureRef::new(image));
        let leaf = Material { base_color_texture: texture, ..Material::default() };
        let [leaf, plain] =
            [leaf, Material::default()].map(|material| scene.insert_material(material).unwrap());
        let mut add = |name, mesh, material| {
            scene.insert_instance(Instance::new(mesh, material, DAffine3::IDENTITY).with_name(name)).unwrap()
        };
        let keys = [add("Fox", cube, leaf), add("Rock", ball, plain), add("", cube, plain)];
        let mut followed = Followed::new(scene);
        let numbers = keys.map(|key| followed.casters.scene.number(key).unwrap());
        assert_eq!(
            numbers.map(|number| followed.casters.caster_name(number)),
            [Some("Fox"), Some("Rock"), None]
        );
        assert_eq!(followed.casters.caster_name(99), None);

        let leaf_edits: [fn(&mut Material); 4] = [
            |material| material.alpha = AlphaMode::Mask { cutoff: 0.7 },
            |material| material.double_sided = true,
            |material| material.receives_shadows = false,
            |material| material.base_color.w = 0.5,
        ];
        for edit in leaf_edits {
            followed.scene.edit_material(leaf, edit).unwrap();
            assert_eq!(followed.follow(&keys), [true, false, false]);
        }
        followed.scene.replace_image(image, dot(2)).unwrap();
        assert_eq!(followed.follow(&keys), [true, false, false]);
        followed.scene.replace_mesh(cube, Mesh::cuboid(DVec3::ZERO, DVec3::splat(3.0))).unwrap();
        assert_eq!(followed.follow(&keys), [true, false, true]);
        followed.scene.edit_instance(keys[1], |rock| rock.receives_shadows = false).unwrap();
        assert_eq!(followed.follow(&keys), [false, true, false]);
        assert!(keys.iter().all(|key| followed.mobility(*key) == Mobility::Static));

        followed.scene.move_instance(keys[0], DAffine3::from_translation(DVec3::X)).unwrap();
        assert_eq!(followed.follow(&keys), [true, false, false]);
        let frames = (0..100).take_while(|_| {
            assert_eq!(followed.mobility(keys[1]), Mobility::Static);
            let moves = followed.mobility(keys[0]) == Mobility::Moving;
            assert_eq!(followed.follow(&keys), [false; 3]);
            moves
        });
        assert_eq!(frames.count(), 60);
    }
}
