//! The depth prepass without what is hidden.

use std::fmt::Display;

use shadowgraph_core::{Frame, History, Resize, Texture};
use shadowgraph_scene::ConvexVolume;
use shadowgraph_scene::gpu::CullFlags;

use crate::culling::{CullCounts, CullPass, CullView, SeenHistory, seen_desc};
use crate::error::Error;
use crate::geometry::{CulledGeometry, Geometry};
use crate::occluders::OccluderPyramid;
use crate::prepass::Prepass;
use crate::uniforms::ViewBuffers;

/// Culls on the GPU what other geometry of a view hides, in two steps: what was visible in the last frame is drawn, then what its depth
/// does not hide. So nothing visible is ever missing, however the camera moves (Haar and Aaltonen, "GPU-Driven Rendering Pipelines",
/// SIGGRAPH 2015).
pub struct OcclusionCulling {
    pyramid: OccluderPyramid,
}

impl OcclusionCulling {
    /// Composes the shaders.
    ///
    /// # Errors
    /// Never with the built-in WGSL.
    pub fn new(device: &wgpu::Device) -> Result<Self, Error> {
        Ok(Self { pyramid: OccluderPyramid::new(device)? })
    }

    /// Adds the depth prepass, and returns the depth and the geometry that is not hidden. `view` is the view of all geometry that is not
    /// blended; `note` says why the GPU culls, for plans. The depth has one sample per pixel.
    pub fn add_prepass<'f>(
        &'f self,
        frame: &mut Frame<'f>,
        (prepass, cull): (&'f Prepass, &'f CullPass),
        buffers: &ViewBuffers,
        (geometry, view): (&Geometry<'f>, &CullView),
        note: &dyn Display,
    ) -> (Texture, CulledGeometry) {
        let scene = geometry.scene;
        CullCounts::remove(frame, &view.name);
        let desc = seen_desc(scene.cull_inputs().instance_count);
        let History { previous, mut current, .. } =
            frame.history(format_args!("{} instances", view.name), desc, Resize::Reset);
        let named = |what| CullView { name: format!("{}, {what}", view.name), ..view.clone() };
        let instances = frame
            .node("cull seen", |frame| cull.add_seen(frame, scene, &named("seen before"), &previous, note));
        let culled = |instances, solid| Some(CulledGeometry { instances, solid, moving: None });
        let seen = Geometry { culled: culled(instances, 0), ..geometry.clone() };
        let mut depth = prepass.add_to(frame, buffers, &seen);

        let pyramid = frame.node("depth pyramid", |frame| self.pyramid.add_to(frame, &depth));
        let moving = scene.any_moving().then_some(2);
        let among = |what, required| CullView { volume: ConvexVolume::default(), required, ..named(what) };
        let mut views = vec![view.clone(), among("new", view.required)];
        views.extend(moving.map(|_| among("moving", view.required.union(CullFlags::MOVING))));
        let history = SeenHistory { before: &previous, now: &mut current };
        let instances = frame.node("cull hidden", |frame| {
            cull.add_unhidden(frame, scene, &views, history, (&buffers.view, &pyramid), note)
        });
        let new = Geometry { culled: culled(instances.clone(), CullPass::NEW), ..geometry.clone() };
        prepass.add_more(frame, buffers, &new, &mut depth);
        (depth, CulledGeometry { instances, solid: CullPass::VISIBLE, moving })
    }
}
